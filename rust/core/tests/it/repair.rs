// SPDX-License-Identifier: MIT OR Apache-2.0
//! Repairs: sound meshes stay as they are, and any triangles become an oriented manifold.

use authalic::{
    CloseHandles, CloseHoles, DiskMapOptions, Error, ErrorKind, Keep, MeshError, RepairOptions, Repaired,
    Silent, Surface, disk_map, repair,
};
use ndarray::{Array2, aview2};
use proptest::prelude::*;

use crate::common;

fn repaired(vertices: &[[f64; 3]], faces: &[[u32; 3]], options: &RepairOptions) -> Result<Repaired, Error> {
    repair(aview2(vertices), aview2(faces), options)
}

#[test]
fn sound_meshes_stay_as_they_are() {
    for test in common::orientable() {
        let options = RepairOptions { close_holes: CloseHoles::Off, ..Default::default() };
        let result = repaired(&test.vertices, &test.faces, &options).unwrap();
        let turned = test.mesh().flipped_faces().len();
        assert_eq!(result.counts.turned_faces, turned, "{}", test.name);
        assert_eq!(result.is_changed(), turned > 0, "{}", test.name);
        assert_eq!(result.surface.vertices(), aview2(&test.vertices), "{}", test.name);
        assert_eq!(result.surface.n_faces(), test.faces.len(), "{}", test.name);
        assert_eq!(result.surface.topology(), Ok(test.mesh().topology()), "{}", test.name);
    }
}

#[test]
fn the_handle_of_a_torus_is_closed_and_its_measure_carried() {
    let test = common::torus(24, 12);
    let options = RepairOptions { close_handles: CloseHandles::All, ..Default::default() };
    let result = repaired(&test.vertices, &test.faces, &options).unwrap();
    assert_eq!((result.counts.closed_handles, result.surface.topology().unwrap().genus), (1, Some(0)));
    assert!(result.surface.topology().unwrap().is_closed());
    // faces that were added have the mean of the measure that all others have
    let measure = result.measure(ndarray::Array1::ones(test.faces.len()).view()).unwrap();
    let added = result.face_of.iter().zip(&measure).filter(|(face, _)| face.is_none());
    assert!(added.clone().count() > 0 && added.clone().all(|(_, &measure)| measure > 0.0));
    let kept = result.face_of.iter().zip(&measure).filter(|(face, _)| face.is_some());
    assert!(kept.clone().all(|(_, &measure)| (measure - 1.0).abs() < 1e-12));
    let short = ndarray::Array1::ones(3);
    assert!(matches!(result.measure(short.view()), Err(Error::InvalidArray { name: "density", .. })));
}

#[test]
fn arrays_that_are_no_mesh_are_refused() {
    let options = RepairOptions::default();
    let vertices = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let refused = |faces: &[[u32; 3]]| repaired(&vertices, faces, &options).unwrap_err();
    assert_eq!(refused(&[]), MeshError::NoFaces.into());
    assert_eq!(refused(&[[0, 1, 1]]), MeshError::NoFaceLeft.into());
    assert!(matches!(refused(&[[0, 1, 3]]), Error::Mesh(MeshError::IndexOutOfRange { value: 3, .. })));
    let flat = repair(Array2::zeros((3, 2)), ndarray::array![[0, 1, 2]], &options);
    assert!(matches!(flat, Err(Error::InvalidArray { name: "vertices", .. })));
}

/// The kind of a fault, and the vertices and faces that have it.
type FaultyMesh = (&'static str, Vec<[f64; 3]>, Vec<[u32; 3]>);

fn faulty_meshes() -> Vec<FaultyMesh> {
    let [a, b, c, d, e] = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.], [1., 1., 1.]];
    let of_elements = [
        ("not_finite", vec![a, b, c, [f64::NAN, 0., 0.]], vec![[0, 1, 2], [1, 3, 2]]),
        ("repeated_vertex", vec![a, b, c], vec![[0, 1, 2], [0, 1, 1]]),
        ("duplicate_face", vec![a, b, c], vec![[0, 1, 2], [2, 0, 1]]),
        ("zero_area", vec![a, b, c, [0.5, 0.5, 0.]], vec![[0, 1, 2], [1, 3, 2]]),
        ("non_manifold_edge", vec![a, b, c, d, e], vec![[0, 1, 2], [1, 0, 3], [0, 1, 4]]),
        ("non_manifold_vertex", vec![a, b, c, d, e], vec![[0, 1, 2], [0, 3, 4]]),
        ("loose_vertex", vec![a, b, c, d], vec![[0, 1, 2]]),
    ];
    let of_the_shape = [
        ("not_orientable", common::moebius_strip(10, 3)),
        ("several_components", common::two_pieces()),
        ("closed_surface", common::icosphere(1)),
        ("several_boundaries", common::annulus(12, 3)),
    ];
    let of_the_shape = of_the_shape.map(|(kind, mesh)| (kind, mesh.vertices, mesh.faces));
    [&of_elements[..], &of_the_shape[..]].concat()
}

#[test]
fn a_repair_mends_the_kinds_that_say_so_and_no_other() {
    let refusal = |surface: &Surface| disk_map(surface, &DiskMapOptions::default(), &mut Silent).err();
    let mut mended = Vec::new();
    for (kind, vertices, faces) in faulty_meshes() {
        let given = Surface::new(aview2(&vertices), aview2(&faces));
        let error = given.map_or_else(Some, |surface| refusal(&surface)).unwrap();
        assert_eq!(error.kind().as_str(), kind);
        let repaired = repaired(&vertices, &faces, &RepairOptions::default()).unwrap();
        if refusal(&repaired.surface).is_none_or(|still| still.kind() != error.kind()) {
            mended.push(error.kind());
        }
    }
    for kind in ErrorKind::ALL {
        assert_eq!(kind.is_mended_by_repair(), mended.contains(kind), "{}", kind.as_str());
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// Points of a small grid, so that many are equal and many faces flat, repeated or no manifold.
    #[test]
    fn any_triangles_become_a_manifold(
        points in prop::collection::vec([0..4u8, 0..4u8, 0..3u8], 3..40),
        corners in prop::collection::vec([0..40usize, 0..40, 0..40], 1..90),
        largest in any::<bool>(),
    ) {
        let vertices: Vec<[f64; 3]> = points.iter().map(|point| point.map(f64::from)).collect();
        let faces: Vec<[u32; 3]> =
            corners.iter().map(|face| face.map(|corner| (corner % vertices.len()) as u32)).collect();
        let keep = if largest { Keep::Largest } else { Keep::All };
        let options =
            RepairOptions { keep, close_handles: CloseHandles::All, close_holes: CloseHoles::All, ..Default::default() };
        let result = match repaired(&vertices, &faces, &options) {
            Ok(result) => result,
            Err(error) => {
                prop_assert_eq!(error, MeshError::NoFaceLeft.into());
                return Ok(());
            }
        };
        match result.surface.topology() {
            Ok(topology) => {
                prop_assert!(topology.is_closed());
                prop_assert_eq!(topology.genus, Some(0));
                prop_assert!(!largest || topology.n_components() == 1);
            }
            Err(error) => prop_assert!(
                matches!(error, Error::Mesh(MeshError::NotOrientable { .. })),
                "{:?}: {}", result.counts, error
            ),
        }
        // the maps agree with each other
        let given = |vertex: &authalic::Vertex| vertices[vertex.index()];
        for (vertex, place) in result.vertex_of.iter().zip(result.surface.vertices().rows()) {
            prop_assert!(vertex.is_none_or(|vertex| given(&vertex)[..] == *place.as_slice().unwrap()));
        }
        for (given, face) in result.face_to.iter().enumerate() {
            prop_assert!(face.is_none_or(|face| result.face_of[face.index()].unwrap().index() == given));
        }
    }
}
