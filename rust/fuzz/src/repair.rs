// SPDX-License-Identifier: MIT OR Apache-2.0
//! Repairs: any triangles become an oriented manifold, with maps back, or are refused.

use authalic::{CloseHandles, CloseHoles, Error, Keep, MeshError, RepairOptions, repair};

use super::Input;

/// One run of the target; whether it came to a result to look at.
pub fn check(bytes: &[u8]) -> bool {
    let mut input = Input::new(bytes);
    let options = RepairOptions {
        merge: input.option([0.0, 0.1, 1.0]),
        close_holes: match input.byte() % 4 {
            0 => CloseHoles::Off,
            1 => CloseHoles::Pinholes,
            2 => CloseHoles::UpTo(input.below(20)),
            _ => CloseHoles::All,
        },
        keep_outline: input.bit(),
        close_handles: match input.byte() % 4 {
            0 => CloseHandles::Off,
            1 => CloseHandles::Noise,
            2 => CloseHandles::UpTo(input.real()),
            _ => CloseHandles::All,
        },
        keep: if input.bit() { Keep::Largest } else { Keep::All },
    };
    let (vertices, faces) = input.arrays();
    let Ok(repaired) = repair(vertices.view(), faces.view(), &options) else { return false };
    match repaired.surface.topology() {
        // A repair leaves one-sided pieces as they are.
        Ok(_) | Err(Error::Mesh(MeshError::NotOrientable { .. })) => {}
        Err(error) => panic!("repaired, and no surface: {error}"),
    }
    let (n, m) = (repaired.surface.n_vertices(), repaired.surface.n_faces());
    assert_eq!((repaired.vertex_of.len(), repaired.face_of.len()), (n, m));
    assert!(repaired.vertex_of.iter().flatten().all(|vertex| vertex.index() < vertices.nrows()));
    assert!(repaired.face_of.iter().flatten().all(|face| face.index() < faces.nrows()));
    assert!(repaired.vertex_to.iter().flatten().all(|vertex| vertex.index() < n));
    assert!(repaired.face_to.iter().flatten().all(|face| face.index() < m));
    for (vertex, given) in repaired.vertex_of.iter().enumerate() {
        if let Some(given) = given {
            assert_eq!(repaired.surface.vertices().row(vertex), vertices.row(given.index()));
        }
    }
    let again = repair(
        repaired.surface.vertices(),
        repaired.surface.faces().view(),
        &RepairOptions {
            merge: Some(0.0),
            close_holes: CloseHoles::Off,
            close_handles: CloseHandles::Off,
            keep: Keep::All,
            ..options
        },
    );
    assert!(again.is_ok(), "what was repaired is refused: {}", again.unwrap_err());
    true
}
