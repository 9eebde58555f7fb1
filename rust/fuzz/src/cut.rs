// SPDX-License-Identifier: MIT OR Apache-2.0
//! Cuts along any seams: the patches are all faces, each once.

use ndarray::aview2;

use super::Input;

/// One run of the target; whether it came to a result to look at.
pub fn check(bytes: &[u8]) -> bool {
    let mut input = Input::new(bytes);
    let Some(surface) = input.surface(6) else { return false };
    let faces = surface.faces();
    let (n, m) = (surface.n_vertices(), surface.n_faces());
    let seams: Vec<[u32; 2]> = (0..input.below(40))
        .map(|_| match input.byte() % 16 {
            0 => [input.below(n + 1) as u32, input.below(n + 1) as u32],
            _ => {
                let (face, corner) = (input.below(m), input.below(3));
                [faces[[face, corner]], faces[[face, (corner + 1) % 3]]]
            }
        })
        .collect();
    let Ok(patches) = surface.cut(aview2(&seams)) else { return false };
    let mut seen = vec![false; m];
    for patch in &patches {
        for (row, corners) in patch.corner_of.rows().into_iter().enumerate() {
            for (place, &corner) in corners.iter().enumerate() {
                let face = corner as usize / 3;
                assert!(place > 0 || !std::mem::replace(&mut seen[face], true), "a face in two patches");
                let vertex = patch.surface.faces()[[row, place]] as usize;
                assert_eq!(patch.vertex_of[vertex].0, faces[[face, corner as usize % 3]]);
            }
        }
    }
    assert!(seen.iter().all(|&is_seen| is_seen), "a face in no patch");
    true
}
