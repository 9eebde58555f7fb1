// SPDX-License-Identifier: MIT OR Apache-2.0
//! Cutting along seams: what comes out, what it remembers of the input, and what is refused.

use authalic::testing::TriangleMesh;
use authalic::{Elements, Error, MeshError, Patch, Vertex};
use std::collections::BTreeSet;

use crate::common::public::{cut, faces_of, triples, vertices_of};
use crate::common::{self, TestMesh};
use proptest::prelude::*;

/// Every corner of the input lies in exactly one patch, at its own vertex and position.
fn assert_round_trip(vertices: &[[f64; 3]], faces: &[[u32; 3]], patches: &[Patch]) {
    let mut rebuilt = vec![[u32::MAX; 3]; faces.len()];
    for patch in patches {
        assert_eq!(vertices_of(patch).len(), patch.vertex_of.len());
        assert_eq!(faces_of(patch).len(), patch.corner_of.nrows());
        assert!(patch.vertex_of.is_sorted() && patch.corner_of.iter().is_sorted());
        for (&v, position) in patch.vertex_of.iter().zip(vertices_of(patch)) {
            assert_eq!(vertices[v], *position);
        }
        for (face, corners) in faces_of(patch).iter().zip(triples(&patch.corner_of)) {
            for (&v, &corner) in face.iter().zip(corners) {
                rebuilt[corner as usize / 3][corner as usize % 3] = patch.vertex_of[v as usize].0;
            }
        }
        let used: BTreeSet<u32> = faces_of(patch).iter().flatten().copied().collect();
        assert!(used.into_iter().eq(0..vertices_of(patch).len() as u32), "every vertex is used");
    }
    assert_eq!(rebuilt, faces);
    let lowest: Vec<u32> = patches.iter().map(|patch| patch.corner_of[[0, 0]]).collect();
    assert!(lowest.is_sorted());
}

fn cut_checked(test: &TestMesh, seams: &[[u32; 2]]) -> Vec<Patch> {
    let patches = cut(&test.vertices, &test.faces, seams).unwrap_or_else(|e| panic!("{}: {e}", test.name));
    assert_round_trip(&test.vertices, &test.faces, &patches);
    patches
}

/// The edges of a path.
fn path(vertices: &[u32]) -> Vec<[u32; 2]> {
    vertices.windows(2).map(|pair| [pair[0], pair[1]]).collect()
}

/// The edges of a closed path.
fn ring(vertices: impl Iterator<Item = u32>) -> Vec<[u32; 2]> {
    let mut closed: Vec<u32> = vertices.collect();
    closed.push(closed[0]);
    path(&closed)
}

fn summary(patch: &Patch) -> (i64, usize, Option<usize>) {
    let topology = &patch.topology;
    (topology.euler_characteristic, topology.boundary_loops.len(), topology.genus)
}

#[test]
fn without_seams_the_components_come_out_unchanged() {
    for test in common::all() {
        let patches = cut_checked(&test, &[]);
        assert_eq!(patches.len(), test.components, "{}", test.name);
        let total: i64 = patches.iter().map(|patch| patch.topology.euler_characteristic).sum();
        assert_eq!(total, test.euler_characteristic, "{}", test.name);
        let loops: usize = patches.iter().map(|patch| patch.topology.boundary_loops.len()).sum();
        assert_eq!(loops, test.n_loops, "{}", test.name);
        assert_eq!(patches.iter().all(|patch| patch.topology.orientable), test.genus.is_some());
        if let [patch] = &patches[..] {
            assert_eq!((vertices_of(patch), &faces_of(patch)[..]), (&test.vertices[..], &test.faces[..]));
            assert_eq!((patch.is_disk(), patch.is_closed()), (test.is_disk(), test.n_loops == 0));
            assert_eq!(patch.topology.genus, test.genus, "{}", test.name);
        }
    }
}

#[test]
fn patches_know_the_same_topology_as_meshes() {
    for test in common::orientable() {
        for patch in cut_checked(&test, &[]) {
            let mesh = TriangleMesh::new(vertices_of(&patch), &faces_of(&patch)).unwrap();
            assert_eq!(*mesh.topology(), patch.topology, "{}", test.name);
        }
    }
}

#[test]
fn a_seam_across_a_grid_parts_it() {
    let test = common::grid(6, 4);
    let across: Vec<u32> = (0..=4).map(|j| 3 * 5 + j).collect();
    let patches = cut_checked(&test, &path(&across));
    assert_eq!(patches.iter().map(summary).collect::<Vec<_>>(), [(1, 1, Some(0)); 2]);
    assert_eq!([faces_of(&patches[0]).len(), faces_of(&patches[1]).len()], [24, 24]);
    assert_eq!([vertices_of(&patches[0]).len(), vertices_of(&patches[1]).len()], [20, 20]);
    // A seam that starts at the boundary and ends inside opens the grid without parting it.
    let patches = cut_checked(&test, &path(&across[..3]));
    assert_eq!(patches.iter().map(summary).collect::<Vec<_>>(), [(1, 1, Some(0))]);
    assert_eq!(vertices_of(&patches[0]).len(), test.vertices.len() + 2);
}

#[test]
fn a_path_of_two_edges_opens_a_sphere_and_one_edge_does_not() {
    let test = common::icosphere(2);
    let [a, b, _] = test.faces[0];
    let next = test
        .faces
        .iter()
        .flatten()
        .copied()
        .find(|&v| v != a && cut(&test.vertices, &test.faces, &[[b, v]]).is_ok() && v != b);
    let seams = path(&[a, b, next.unwrap()]);
    let patches = cut_checked(&test, &seams[..1]);
    assert_eq!(patches.iter().map(summary).collect::<Vec<_>>(), [(2, 0, Some(0))]);
    let patches = cut_checked(&test, &seams);
    assert!(patches.len() == 1 && patches[0].is_disk());
    assert_eq!(patches[0].topology.boundary_loops[0].len(), 4);
    assert_eq!(patches[0].vertex_of.iter().filter(|&&v| v == Vertex(b)).count(), 2);
}

#[test]
fn a_torus_opens_into_an_annulus_and_then_into_a_disk() {
    let test = common::torus(7, 9);
    let around = ring((0..7).map(|i| i * 9));
    let tube = ring(0..9);
    for loops in [&around, &tube] {
        let patches = cut_checked(&test, loops);
        assert_eq!(patches.iter().map(summary).collect::<Vec<_>>(), [(0, 2, Some(0))]);
    }
    let patches = cut_checked(&test, &[around, tube].concat());
    assert!(patches.len() == 1 && patches[0].is_disk());
    assert_eq!(patches[0].topology.boundary_loops[0].len(), 2 * (7 + 9));
    assert_eq!(patches[0].vertex_of[..4], [Vertex(0); 4], "four copies where the loops cross");
    assert!(
        TriangleMesh::new(vertices_of(&patches[0]), &faces_of(&patches[0])).unwrap().require_disk().is_ok()
    );
}

#[test]
fn a_moebius_strip_cut_across_is_a_disk() {
    let test = common::moebius_strip(10, 3);
    let [whole] = &cut_checked(&test, &[])[..] else { panic!("one piece") };
    assert_eq!(summary(whole), (0, 1, None));
    assert_eq!(whole.topology.boundary_loops[0].len(), 20);
    let patches = cut_checked(&test, &path(&[0, 1, 2, 3]));
    assert!(patches.len() == 1 && patches[0].is_disk());
    // Along its middle it stays in one piece and becomes two-sided: the classic. Needs an even width.
    let test = common::moebius_strip(10, 2);
    let patches = cut_checked(&test, &ring((0..10).map(|i| 3 * i + 1)));
    assert_eq!(patches.iter().map(summary).collect::<Vec<_>>(), [(0, 2, Some(0))]);
}

#[test]
fn cut_along_every_edge_each_face_is_a_patch() {
    for test in common::all() {
        let edges: Vec<[u32; 2]> =
            test.faces.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [a, c]]).collect();
        let patches = cut_checked(&test, &edges);
        assert_eq!(patches.len(), test.faces.len());
        assert!(patches.iter().all(Patch::is_disk));
    }
}

#[test]
fn edges_of_three_faces_act_as_seams() {
    // Three pages on one spine.
    let vertices = [[0., 0., 0.], [0., 0., 1.], [1., 0., 0.], [0., 1., 0.], [-1., -1., 0.]];
    let faces = [[0, 1, 2], [1, 0, 3], [0, 1, 4]];
    let patches = cut(&vertices, &faces, &[]).unwrap();
    assert_round_trip(&vertices, &faces, &patches);
    assert_eq!(patches.len(), 3);
    assert!(patches.iter().all(Patch::is_disk));
}

#[test]
fn parts_that_touch_in_a_vertex_come_apart() {
    let vertices = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [-1., 0., 0.], [0., -1., 0.]];
    let faces = [[0, 1, 2], [0, 3, 4]];
    let patches = cut(&vertices, &faces, &[]).unwrap();
    assert_round_trip(&vertices, &faces, &patches);
    assert_eq!(patches.len(), 2);
    assert_eq!([patches[0].vertex_of[0], patches[1].vertex_of[0]], [Vertex(0); 2]);
}

#[test]
fn inconsistent_winding_does_not_cut() {
    for test in common::all() {
        let mut turned = test.clone();
        turned.faces.iter_mut().step_by(3).for_each(|face| face.swap(0, 2));
        let topologies: Vec<_> = cut_checked(&test, &[]).iter().map(summary).collect();
        let found: Vec<_> = cut_checked(&turned, &[]).iter().map(summary).collect();
        assert_eq!(found, topologies, "{}", test.name);
    }
}

#[test]
fn what_an_island_may_be_refused_for_is_accepted_here() {
    // A face without area, a duplicate and a loose vertex.
    let vertices = [[0., 0., 0.], [1., 0., 0.], [2., 0., 0.], [0., 1., 0.], [9., 9., 9.]];
    let faces = [[0, 1, 2], [0, 1, 3], [3, 1, 0]];
    let patches = cut(&vertices, &faces, &[]).unwrap();
    assert_round_trip(&vertices, &faces, &patches);
    assert!(patches.iter().all(|patch| !patch.vertex_of.contains(&Vertex(4))));
}

#[test]
fn refusals_name_the_seams() {
    let TestMesh { vertices, faces, .. } = common::grid(2, 2);
    let seams = |first: &[usize], count| Elements { first: first.to_vec(), count, arity: 2 };
    let error = cut(&vertices, &faces, &[[0, 1], [0, 8], [3, 3]]).unwrap_err();
    assert_eq!(error, MeshError::SeamNotEdge { seams: seams(&[0, 8, 3, 3], 2) }.into());
    assert!(error.to_string().starts_with("2 seams ((0, 8), (3, 3))"), "{error}");
    let error = cut(&vertices, &faces, &[[0, 1], [9, 1]]).unwrap_err();
    assert_eq!(error, MeshError::SeamOutOfRange { seams: seams(&[9, 1], 1), n_vertices: 9 }.into());
}

#[test]
fn broken_arrays_are_refused() {
    let TestMesh { mut vertices, mut faces, .. } = common::grid(2, 2);
    assert_eq!(cut(&[], &[], &[]), Err(MeshError::NoVertices.into()));
    assert_eq!(cut(&vertices, &[], &[]), Err(MeshError::NoFaces.into()));
    faces[3] = [4, 1, 4];
    assert!(matches!(cut(&vertices, &faces, &[]), Err(Error::Mesh(MeshError::RepeatedVertex { .. }))));
    faces[3] = [4, 1, 9];
    assert!(matches!(
        cut(&vertices, &faces, &[]),
        Err(Error::Mesh(MeshError::IndexOutOfRange { value: 9, .. }))
    ));
    vertices[2][1] = f64::INFINITY;
    assert!(matches!(cut(&vertices, &faces, &[]), Err(Error::Mesh(MeshError::NonFinite { .. }))));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 256, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_seams_leave_manifolds_that_add_up(choice in prop::collection::vec(any::<u8>(), 1..400), density in 1..200u8) {
        for test in common::all() {
            let edges: BTreeSet<[u32; 2]> = test.faces.iter()
                .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
                .map(|[a, b]| [a.min(b), a.max(b)])
                .collect();
            let marked = |i: usize| choice[i % choice.len()] < density;
            let seams: Vec<_> = edges.iter().enumerate().filter(|(i, _)| marked(*i)).map(|(_, e)| *e).collect();
            for patch in cut_checked(&test, &seams) {
                match TriangleMesh::new(vertices_of(&patch), &faces_of(&patch)) {
                    Ok(mesh) => {
                        prop_assert_eq!(mesh.topology().euler_characteristic, patch.topology.euler_characteristic);
                        prop_assert_eq!(mesh.boundary_loops().len(), patch.topology.boundary_loops.len());
                    }
                    Err(error) => prop_assert!(!patch.topology.orientable, "{}: {}", test.name, error),
                }
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn hostile_input_never_panics(
        coordinates in prop::collection::vec(prop_oneof![-1.0..1.0f64, Just(1e300), Just(-1e300), Just(1e-300), Just(0.)], 18),
        faces in prop::collection::vec([0..7u32, 0..7u32, 0..7u32], 0..12),
        seams in prop::collection::vec([0..7u32, 0..7u32], 0..3),
    ) {
        let vertices = coordinates.as_chunks::<3>().0;
        let _ = cut(vertices, &faces, &seams);
    }

    #[test]
    fn hostile_combinations_fall_into_manifolds(
        faces in prop::collection::vec(Just([0, 1, 2, 3, 4, 5u32]).prop_shuffle().prop_map(|p| [p[0], p[1], p[2]]), 1..14),
        picks in prop::collection::vec((any::<prop::sample::Index>(), 0..3usize), 0..5),
    ) {
        let vertices: Vec<_> = (0..6).map(|i| [1., 2., 3.].map(|p| f64::from(i).powf(p))).collect();
        let seam = |(face, k): &(prop::sample::Index, usize)| {
            let [a, b, c] = faces[face.index(faces.len())];
            [[a, b], [b, c], [c, a]][*k]
        };
        let patches = cut(&vertices, &faces, &picks.iter().map(seam).collect::<Vec<_>>()).unwrap();
        assert_round_trip(&vertices, &faces, &patches);
        for patch in &patches {
            prop_assert_eq!(patch.topology.n_components(), 1);
            match TriangleMesh::new(vertices_of(patch), &faces_of(patch)) {
                Ok(mesh) => prop_assert_eq!(mesh.topology(), &patch.topology),
                Err(Error::Mesh(MeshError::DuplicateFaces { .. } | MeshError::NotOrientable { .. })) => {}
                // Copies of one vertex coincide, but never within a face.
                Err(error) => prop_assert!(false, "{}", error),
            }
        }
    }
}
