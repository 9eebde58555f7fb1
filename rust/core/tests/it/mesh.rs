// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a `TriangleMesh` accepts, repairs, refuses and knows.

use authalic::testing::{TriangleMesh, consistent, geometry};
use authalic::{Corner, Elements, Error, Face, MeshError, Vertex};
use std::collections::BTreeSet;
use std::f64::consts::{PI, TAU};

use crate::common::{self, TestMesh, distance, faces_of_indices};
use proptest::prelude::*;

fn refusal(vertices: &[[f64; 3]], faces: &[[u32; 3]]) -> Error {
    TriangleMesh::new(vertices, faces).expect_err("the mesh should be refused")
}

fn elements(first: &[usize], count: usize) -> Elements {
    Elements { first: first.to_vec(), count, arity: 1 }
}

fn edge(a: usize, b: usize) -> Elements {
    Elements { first: vec![a, b], count: 1, arity: 2 }
}

/// Four points in general position.
const TETRAHEDRON: [[f64; 3]; 4] = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]];

#[test]
fn topology_is_known_on_every_test_mesh() {
    for test in common::orientable() {
        let mesh = test.mesh();
        assert_eq!(mesh.euler_characteristic(), test.euler_characteristic, "{}", test.name);
        assert_eq!(mesh.boundary_loops().len(), test.n_loops, "{}", test.name);
        assert_eq!(mesh.topology().genus, test.genus, "{}", test.name);
        assert_eq!(mesh.n_components(), test.components, "{}", test.name);
        assert_eq!(mesh.topology().is_disk(), test.is_disk(), "{}", test.name);
        assert_eq!(mesh.require_disk().is_ok(), test.is_disk(), "{}", test.name);
        assert_eq!(mesh.topology().is_closed(), test.n_loops == 0, "{}", test.name);
        assert_eq!(mesh.flipped_faces(), [] as [Face; 0], "{}", test.name);
        assert_eq!(mesh.faces(), faces_of_indices(&test.faces), "{}", test.name);
    }
}

#[test]
fn angle_defects_add_up_to_the_euler_characteristic() {
    for test in common::orientable() {
        let mesh = test.mesh();
        let mut angles = vec![0.; mesh.n_vertices()];
        for (face, corner) in mesh.faces().iter().flat_map(|face| (0..3).map(move |k| (face, k))) {
            let [a, b, c] = [0, 1, 2].map(|k| mesh.points()[face[(corner + k) % 3]]);
            // By the law of cosines, a route of its own.
            let [ab, ac, bc] = [distance(a, b), distance(a, c), distance(b, c)];
            let cosine = (ab * ab + ac * ac - bc * bc) / (2. * ab * ac);
            angles[face[corner]] += cosine.clamp(-1., 1.).acos();
        }
        let flat = |v| if mesh.is_boundary(v) { PI } else { TAU };
        let total: f64 = (0..mesh.n_vertices()).map(|v| flat(Vertex::new(v)) - angles[v]).sum();
        approx::assert_abs_diff_eq!(total, TAU * test.euler_characteristic as f64, epsilon = 1e-9);
    }
}

#[test]
fn corners_know_their_neighbors() {
    for test in common::orientable() {
        let mesh = test.mesh();
        let ends = |corner: Corner| {
            let face = mesh.faces()[corner.index() / 3];
            [1, 2].map(|k| face[(corner.index() + k) % 3])
        };
        for corner in Corner::all(mesh.n_faces()) {
            let [a, b] = ends(corner);
            match mesh.opposite(corner) {
                Some(other) => {
                    assert_eq!(mesh.opposite(other), Some(corner));
                    assert_eq!(ends(other), [b, a], "{}", test.name);
                }
                None => assert!(mesh.is_boundary(a) && mesh.is_boundary(b)),
            }
        }
        let listed: Vec<Corner> =
            Vertex::all(mesh.n_vertices()).flat_map(|v| mesh.vertex_corners(v).to_vec()).collect();
        assert_eq!(BTreeSet::from_iter(&listed).len(), 3 * mesh.n_faces());
        for v in Vertex::all(mesh.n_vertices()) {
            let corners = mesh.vertex_corners(v);
            assert!(corners.is_sorted());
            assert!(corners.iter().all(|&c| mesh.faces()[c.index() / 3][c.index() % 3] == v));
        }
    }
}

#[test]
fn boundary_loops_run_along_the_faces_and_start_at_their_smallest_vertex() {
    for test in common::orientable() {
        let mesh = test.mesh();
        let half_edges: BTreeSet<[Vertex; 2]> =
            mesh.faces().iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
        let mut seen = 0;
        for boundary in mesh.boundary_loops() {
            assert_eq!(boundary.iter().min(), boundary.first());
            for (i, &a) in boundary.iter().enumerate() {
                let b = boundary[(i + 1) % boundary.len()];
                assert!(half_edges.contains(&[a, b]) && !half_edges.contains(&[b, a]), "{}", test.name);
            }
            seen += boundary.len();
        }
        let open = half_edges.iter().filter(|[a, b]| !half_edges.contains(&[*b, *a])).count();
        assert_eq!(seen, open, "{}", test.name);
        let marked = Vertex::all(mesh.n_vertices()).filter(|&v| mesh.is_boundary(v)).count();
        assert_eq!(marked, seen, "{}", test.name);
    }
}

#[test]
fn the_longest_loop_comes_first() {
    let mesh = common::holed_grid().mesh();
    let sizes: Vec<usize> = mesh.boundary_loops().iter().map(Vec::len).collect();
    assert_eq!(sizes, [32, 10, 4]);
    // Length counts, not the number of edges: the inner circle of this ring is finer than the outer one.
    let mesh = common::annulus(11, 3).mesh();
    let radius = |v: Vertex| distance(common::annulus(11, 3).vertices[v], [0.; 3]);
    assert!(mesh.boundary_loops()[0].iter().all(|&v| radius(v) > 1.5));
}

#[test]
fn points_fill_a_unit_box_at_any_scale() {
    let reference = common::bumpy_disk(4).mesh();
    for (factor, shift) in [(1e8, 0.), (1e-8, 0.), (1e150, 0.), (1e-150, 0.), (1e300, 0.), (1., 1e3)] {
        let TestMesh { vertices, faces, .. } = common::bumpy_disk(4);
        let moved: Vec<_> = vertices.iter().map(|v| v.map(|x| factor * (x + shift))).collect();
        let mesh = TriangleMesh::new(&moved, &faces).unwrap();
        approx::assert_relative_eq!(mesh.scale() / factor, reference.scale(), max_relative = 1e-12);
        for (p, q) in mesh.points().iter().zip(reference.points()) {
            assert!(distance(*p, *q) < 1e-12);
        }
        for (a, b) in mesh.face_areas().iter().zip(reference.face_areas()) {
            approx::assert_relative_eq!(*a, *b, max_relative = 1e-9);
        }
    }
}

#[test]
fn flat_grids_far_from_the_origin_are_accepted() {
    for factor in [1e8, 1., 1e-8] {
        let TestMesh { vertices, faces, .. } = common::grid(60, 60);
        let moved: Vec<_> = vertices.iter().map(|v| v.map(|x| factor * (x + 60e3))).collect();
        assert!(TriangleMesh::new(&moved, &faces).unwrap().require_disk().is_ok());
    }
}

#[test]
fn slivers_with_area_are_accepted() {
    for height in [1e-6, 1e-9, 1e-12] {
        let vertices = [[0., 0., 0.], [1., 0., 0.], [0.3, height, 0.], [0.5, -1., 0.]];
        assert!(TriangleMesh::new(&vertices, &[[0, 1, 2], [1, 0, 3]]).is_ok());
    }
}

#[test]
fn areas_and_cotangents_agree_with_heron_and_the_law_of_cosines() {
    let mesh = common::ellipsoid(2, [1., 2., 5.]).mesh();
    let cotangents = geometry::corner_cotangents(mesh.points(), mesh.faces());
    for (face, &f) in mesh.faces().iter().enumerate() {
        let [a, b, c] = geometry::edge_lengths(geometry::triangle(mesh.points(), f));
        let s = (a + b + c) / 2.;
        let heron = (s * (s - a) * (s - b) * (s - c)).sqrt();
        approx::assert_relative_eq!(mesh.face_areas()[face], heron, max_relative = 1e-9);
        let cotangent = (b * b + c * c - a * a) / (4. * heron);
        approx::assert_abs_diff_eq!(cotangents[face][0], cotangent, epsilon = 1e-8);
    }
}

#[test]
fn empty_arrays_are_refused() {
    assert_eq!(refusal(&[], &[]), MeshError::NoVertices.into());
    assert_eq!(refusal(&TETRAHEDRON, &[]), MeshError::NoFaces.into());
}

#[test]
fn coordinates_that_are_not_finite_are_refused() {
    let mut vertices = TETRAHEDRON;
    vertices[1][2] = f64::NAN;
    vertices[3][0] = f64::NEG_INFINITY;
    assert_eq!(
        refusal(&vertices, &[[0, 1, 2]]),
        MeshError::NonFinite { vertices: elements(&[1, 3], 2) }.into()
    );
}

#[test]
fn indices_out_of_range_are_refused() {
    let error = refusal(&TETRAHEDRON, &[[0, 1, 2], [0, 4, 1], [u32::MAX, 0, 1]]);
    let expected = MeshError::IndexOutOfRange { faces: elements(&[1, 2], 2), value: 4, n_vertices: 4 }.into();
    assert_eq!(error, expected);
}

#[test]
fn repeated_vertices_are_refused() {
    let error = refusal(&TETRAHEDRON, &[[0, 1, 2], [0, 3, 3], [1, 2, 1]]);
    assert_eq!(error, MeshError::RepeatedVertex { faces: elements(&[1, 2], 2) }.into());
}

#[test]
fn duplicate_faces_are_refused() {
    let faces = [[0, 1, 2], [0, 1, 3], [2, 1, 0], [1, 2, 0], [3, 0, 1], [0, 2, 3]];
    assert_eq!(
        refusal(&TETRAHEDRON, &faces),
        MeshError::DuplicateFaces { faces: elements(&[2, 3, 4], 3) }.into()
    );
}

#[test]
fn faces_without_area_are_refused_at_any_scale() {
    for (factor, shift) in [(1., 0.), (1e8, 0.), (1e-8, 0.), (1e-150, 0.), (1e150, 0.), (0.1, 1e3)] {
        // The first three points lie on a line that no rounding hits exactly.
        let line = |t: f64| [0.1 + t / 3., 0.2 - t / 7., 0.3 + t / 11.];
        let points = [line(0.), line(1.), line(2.7), [1., 1., 0.5]];
        let moved = points.map(|p| p.map(|x| factor * (x + shift)));
        let error = refusal(&moved, &[[0, 2, 3], [0, 1, 2]]);
        assert_eq!(error, MeshError::ZeroArea { faces: elements(&[1], 1) }.into());
    }
    let coinciding = [[0.5; 3]; 3];
    assert_eq!(refusal(&coinciding, &[[0, 1, 2]]), MeshError::ZeroArea { faces: elements(&[0], 1) }.into());
}

#[test]
fn edges_of_three_faces_are_refused() {
    let vertices = [[0., 0., 0.], [0., 0., 1.], [1., 0., 0.], [0., 1., 0.], [-1., -1., 0.]];
    let error = refusal(&vertices, &[[0, 1, 2], [1, 0, 3], [0, 1, 4]]);
    assert_eq!(error, MeshError::NonManifoldEdges { edges: edge(0, 1) }.into());
    assert!(error.to_string().contains("edge (0, 1)"), "{error}");
}

#[test]
fn one_sided_surfaces_are_refused() {
    for test in common::all().iter().filter(|m| m.genus.is_none()) {
        let error = refusal(&test.vertices, &test.faces);
        assert!(matches!(error, Error::Mesh(MeshError::NotOrientable { .. })), "{}: {error}", test.name);
        let named: BTreeSet<usize> = error.elements().unwrap().first.iter().copied().collect();
        let is_corner = |v: &usize| named.contains(v);
        let on_edge = |face: &[u32; 3]| face.map(|v| v as usize).iter().filter(|v| is_corner(v)).count() == 2;
        assert_eq!(test.faces.iter().filter(|face| on_edge(face)).count(), 2, "an inner edge is named");
    }
}

#[test]
fn vertices_in_which_parts_only_touch_are_refused() {
    let vertices = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [-1., 0., 0.], [0., -1., 0.]];
    let error = refusal(&vertices, &[[0, 1, 2], [0, 3, 4]]);
    assert_eq!(error, MeshError::NonManifoldVertices { vertices: elements(&[0], 1) }.into());
}

#[test]
fn loose_vertices_are_refused() {
    let error = refusal(&TETRAHEDRON, &[[0, 1, 3]]);
    assert_eq!(error, MeshError::UnreferencedVertices { vertices: elements(&[2], 1) }.into());
}

#[test]
fn long_lists_name_the_first_and_count_all() {
    let mut vertices = common::grid(1, 1).vertices;
    vertices.extend([[0.5; 3]; 20]);
    let error = refusal(&vertices, &[[0, 1, 2], [1, 3, 2]]);
    assert_eq!(*error.elements().unwrap(), elements(&[4, 5, 6, 7, 8, 9, 10, 11], 20));
    assert!(error.to_string().contains("20 vertices (4, 5, 6, 7, 8, 9, 10, 11, …)"), "{error}");
    assert!(error.is_mesh_error());
}

#[test]
fn what_is_no_disk_is_told_why() {
    let refused = |test: TestMesh| test.mesh().require_disk().unwrap_err();
    assert_eq!(refused(common::icosphere(1)), MeshError::ClosedSurface { genus: 0 }.into());
    assert_eq!(refused(common::torus(5, 5)), MeshError::ClosedSurface { genus: 1 }.into());
    assert_eq!(refused(common::punctured_torus()), MeshError::HasHandles { genus: 1 }.into());
    let first = common::cap(4, 1.).faces.len();
    assert_eq!(
        refused(common::two_pieces()),
        MeshError::SeveralComponents { faces: elements(&[0, first], 2), coincident: 0 }.into()
    );
    let mesh = common::holed_grid().mesh();
    let starts: Vec<usize> = mesh.boundary_loops().iter().map(|l| l[0].index()).collect();
    let expected =
        MeshError::SeveralBoundaries { vertices: elements(&starts, 3), sizes: vec![32, 10, 4] }.into();
    let error = refused(common::holed_grid());
    assert_eq!(error, expected);
    assert!(error.to_string().contains("3 boundary loops of 32, 10, 4 edges"), "{error}");
}

/// Swaps two corners of the faces chosen.
fn flipped(faces: &[[u32; 3]], choice: &[bool]) -> Vec<[u32; 3]> {
    let flip = |(&[a, b, c], &flip): (&[u32; 3], &bool)| if flip { [a, c, b] } else { [a, b, c] };
    faces.iter().zip(choice).map(flip).collect()
}

/// The faces as sets of directed triangles, each starting with its smallest vertex.
fn rotated(faces: &[[Vertex; 3]]) -> Vec<[Vertex; 3]> {
    let smallest_first =
        |&[a, b, c]: &[Vertex; 3]| [[a, b, c], [b, c, a], [c, a, b]].into_iter().min().unwrap();
    faces.iter().map(smallest_first).collect()
}

#[test]
fn faces_turned_against_the_majority_are_flipped_back() {
    for test in common::orientable().iter().filter(|m| m.faces.len() > 8) {
        let choice: Vec<bool> = (0..test.faces.len()).map(|face| face % 7 == 3 || face == 0).collect();
        let mesh = TriangleMesh::new(&test.vertices, &flipped(&test.faces, &choice)).unwrap();
        let expected: Vec<Face> = Face::all(choice.len()).filter(|&face| choice[face]).collect();
        assert_eq!(mesh.flipped_faces(), expected, "{}", test.name);
        assert_eq!(rotated(mesh.faces()), rotated(&faces_of_indices(&test.faces)), "{}", test.name);
        assert_eq!(mesh.boundary_loops(), test.mesh().boundary_loops(), "{}", test.name);
    }
}

#[test]
fn at_a_tie_the_lowest_face_decides() {
    let vertices = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
    for first in [[0, 1, 2], [0, 2, 1]] {
        let second = if first[1] == 1 { [0, 3, 2] } else { [0, 2, 3] };
        let mesh = TriangleMesh::new(&vertices, &[first, second]).unwrap();
        assert_eq!(mesh.faces()[0], first.map(Vertex));
        assert_eq!(mesh.flipped_faces(), [Face(1)]);
    }
}

#[test]
fn unvalidated_faces_are_oriented_where_that_is_possible() {
    // A Moebius strip stays as it is, the grid beside it is repaired.
    let strip = common::moebius_strip(8, 2);
    let shift = strip.vertices.len() as u32;
    let mut faces = strip.faces.clone();
    faces.extend(common::grid(3, 3).faces.iter().map(|face| face.map(|v| v + shift)));
    faces[strip.faces.len() + 5].swap(0, 1);
    let orientation = consistent(shift as usize + 16, &faces_of_indices(&faces));
    assert!(orientation.conflict.is_some());
    let found: Vec<usize> = (0..faces.len()).filter(|&face| orientation.flipped[face]).collect();
    assert_eq!(found, [strip.faces.len() + 5]);
    assert_eq!(orientation.first_faces, [0, strip.faces.len()].map(Face::new));
    // Edges of three faces do not connect, a face that repeats a vertex is no neighbor of itself.
    assert_eq!(
        consistent(5, &faces_of_indices(&[[0, 1, 2], [0, 1, 3], [0, 1, 4]])).first_faces,
        [0, 1, 2].map(Face)
    );
    assert_eq!(consistent(3, &faces_of_indices(&[[1, 1, 2], [0, 0, 0]])).flipped, [false, false]);
}

/// Coordinates as hostile as they come.
fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -2i8..3,
        1 => Just(7i8),
    ]
    .prop_flat_map(|whole| {
        let special = [f64::NAN, f64::INFINITY, 1e300, -1e300, 1e-300, f64::MAX, f64::MIN_POSITIVE, 5e-324];
        match whole {
            7 => prop::sample::select(special.to_vec()).boxed(),
            _ => prop_oneof![Just(f64::from(whole)), -1.0..1.0f64].boxed(),
        }
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_flips_are_repaired(choice in prop::collection::vec(any::<bool>(), 6 * 9 * 9)) {
        let test = common::bumpy_disk(9);
        let mesh = TriangleMesh::new(&test.vertices, &flipped(&test.faces, &choice)).unwrap();
        let inside_out = flipped(&test.faces, &vec![true; test.faces.len()]);
        let repaired = rotated(mesh.faces());
        prop_assert!(repaired == rotated(&faces_of_indices(&test.faces)) || repaired == rotated(&faces_of_indices(&inside_out)));
        prop_assert!(2 * mesh.flipped_faces().len() <= mesh.n_faces());
        prop_assert!(mesh.require_disk().is_ok());
    }

    #[test]
    fn the_order_of_vertices_does_not_matter(order in Just((0..64u32).collect::<Vec<_>>()).prop_shuffle()) {
        for test in common::orientable() {
            // Permute within blocks of 64 vertices.
            let rank = |v: u32| {
                let block = v / 64 * 64;
                let whole = block as usize + 64 <= test.vertices.len();
                if whole { block + order[v as usize % 64] } else { v }
            };
            let mut vertices = test.vertices.clone();
            for (v, &position) in test.vertices.iter().enumerate() {
                vertices[rank(v as u32) as usize] = position;
            }
            let faces: Vec<_> = test.faces.iter().map(|face| face.map(rank)).collect();
            let (mesh, original) = (TriangleMesh::new(&vertices, &faces).unwrap(), test.mesh());
            prop_assert_eq!(mesh.euler_characteristic(), original.euler_characteristic());
            prop_assert_eq!(mesh.genus(), original.genus());
            prop_assert_eq!(mesh.n_components(), original.n_components());
            let loops = |mesh: &TriangleMesh, rank: &dyn Fn(u32) -> u32| -> BTreeSet<BTreeSet<u32>> {
                mesh.boundary_loops().iter().map(|l| l.iter().map(|&v| rank(v.0)).collect()).collect()
            };
            prop_assert_eq!(loops(&mesh, &|v| v), loops(&original, &rank));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn hostile_input_never_panics(
        vertices in prop::collection::vec([coordinate(), coordinate(), coordinate()], 0..9),
        faces in prop::collection::vec([0..9u32, 0..9u32, 0..9u32], 0..12),
    ) {
        match TriangleMesh::new(&vertices, &faces) {
            Ok(mesh) => {
                prop_assert!(mesh.face_areas().iter().all(|&area| area > 0. && area.is_finite()));
                prop_assert!(mesh.points().iter().flat_map(|point| point.0).all(|x| x.abs() <= 0.5 + 1e-12));
                let _ = mesh.require_disk();
            }
            Err(error) => prop_assert!(error.is_mesh_error() && !error.to_string().is_empty()),
        }
    }

    #[test]
    fn hostile_combinations_never_panic(
        faces in prop::collection::vec([0..6u32, 0..6u32, 0..6u32], 1..10),
    ) {
        // Points in general position, so that only the combinatorics is hostile.
        let vertices: Vec<_> = (0..6).map(|i| [1., 2., 3.].map(|p| f64::from(i).powf(p))).collect();
        let result = TriangleMesh::new(&vertices, &faces);
        if let Ok(mesh) = &result {
            let loops = mesh.boundary_loops().len() as i64;
            let euler = 2 * mesh.n_components() as i64 - 2 * mesh.genus() as i64 - loops;
            prop_assert_eq!(mesh.euler_characteristic(), euler);
        }
        let orientation = consistent(6, &faces_of_indices(&faces));
        prop_assert_eq!(orientation.flipped.len(), faces.len());
    }
}
