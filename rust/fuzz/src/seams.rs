// SPDX-License-Identifier: MIT OR Apache-2.0
//! Seams and unwraps: disks within the unit square, or an error.

use authalic::{SeamMethod, SeamOptions, Symmetry, UnwrapOptions, UnwrapSeams, unwrap};

use super::Input;

/// One run of the target; whether it came to a result to look at.
pub fn check(bytes: &[u8]) -> bool {
    let mut input = Input::new(bytes);
    let weights: Vec<f64> = (0..input.byte() % 4).map(|_| input.real()).collect();
    let is_weighted = !weights.is_empty();
    let mut seams = SeamOptions {
        target: input.option([1.1, 1.4, 3.0]).unwrap_or(1.3),
        front: input.bit().then(|| std::array::from_fn(|_| input.real())),
        symmetry: if input.bit() { Symmetry::Auto } else { Symmetry::Off },
        max_islands: input.bit().then(|| input.below(6)),
        overlap: input.bit(),
        method: if input.bit() { SeamMethod::Cones } else { SeamMethod::Search },
        ..Default::default()
    };
    let (pack, rotate, margin) = (input.bit(), input.bit(), input.option([0.0, 0.01, 0.4]).unwrap_or(0.005));
    let mut observer = input.patience();
    let Some(surface) = input.surface(5) else { return false };
    let weights: Vec<f64> =
        weights.iter().copied().cycle().take(if is_weighted { surface.n_vertices() } else { 0 }).collect();
    seams.weights = is_weighted.then(|| ndarray::aview1(&weights));
    let overlap = seams.overlap;
    let options = UnwrapOptions { seams: UnwrapSeams::Automatic(seams), overlap, pack, margin, rotate };
    let Ok(unwrapped) = unwrap(&surface, &options, &mut observer) else { return false };
    assert_eq!(unwrapped.faces.shape(), [surface.n_faces(), 3]);
    assert!(unwrapped.uv.iter().all(|x| x.is_finite()), "coordinates that are no numbers");
    if pack {
        assert!(unwrapped.uv.iter().all(|x| (0.0..=1.0).contains(x)), "outside of the square");
    }
    assert!(unwrapped.island_of.iter().all(|&island| (island as usize) < unwrapped.islands));
    true
}
