// SPDX-License-Identifier: MIT OR Apache-2.0
use super::*;
use crate::control::{Silent, Watch};
use crate::error::Error;
use crate::hyperbolic::features::curves::{LandmarkCurves, face_on_left};
use crate::hyperbolic::features::placement::placed;
use crate::hyperbolic::features::regions::divided;
use crate::hyperbolic::sample_meshes::{circle, mesh, path, sphere, without};
use crate::mesh::Vertex;
use crate::vector::coordinates;

const Z: Vector3 = Vector3([0.0, 0.0, 1.0]);

fn ellipsoid(Vector3([x, y, z]): Vector3) -> Vector3 {
    Vector3([x, 0.8 * y + 0.1 * x * x, 0.6 * z])
}

fn cut(
    surface: &TriangleMesh,
    ours: &[Vec<usize>],
    theirs: &[Vec<usize>],
) -> Result<Vec<(Piece, Piece)>, Error> {
    let pairs = LandmarkCurves { source: ours, target: theirs }.check(surface, surface)?;
    let divided = divided(surface, surface, pairs)?;
    let placement = placed([surface; 2], &divided, None, &Watch::new(&mut Silent, 0.0, ""))?;
    Ok(pieces(surface, surface, &divided, &placement))
}

/// Parameters ascend, banks have the piece on the right side, and all boundary loops are features.
fn check(piece: &Piece) {
    let mesh = TriangleMesh::new(&coordinates(piece.points.clone()), &piece.faces).unwrap();
    assert!(mesh.flipped_faces().is_empty() && mesh.n_components() == 1);
    assert_eq!(piece.features.iter().filter(|feature| feature.is_loop).count(), mesh.boundary_loops().len());
    for feature in &piece.features {
        for bank in [&feature.left, &feature.right] {
            let parameters = &bank.parameters;
            assert_eq!(parameters.len(), bank.vertices.len());
            assert!(parameters[0] == 0.0 && parameters[parameters.len() - 1] == 1.0);
            assert!(parameters.windows(2).all(|ends| ends[0] < ends[1]));
            assert!(bank.vertices[0] == feature.start() && bank.vertices.last() == Some(&feature.end()));
        }
        let left = |[a, b]: [Vertex; 2]| face_on_left(&mesh, a, b).is_some();
        for ends in feature.left.vertices.windows(2) {
            assert!(left([ends[0], ends[1]]) && left([ends[1], ends[0]]) != feature.is_loop);
        }
        for ends in feature.right.vertices.windows(2) {
            assert!(left([ends[1], ends[0]]) && left([ends[0], ends[1]]) != feature.is_loop);
        }
    }
}

/// Two circles side by side, one within the first, and arcs inside and outside.
fn curves() -> Vec<Vec<usize>> {
    let sphere = sphere(4);
    let closed = |curve: Vec<usize>| [&curve[..], &curve[..1]].concat();
    vec![
        path(&sphere, Vector3([0.7, 0.7, -0.5]), Vector3([-0.7, 0.7, -0.5])),
        closed(circle(&sphere, Z, 0.8)),
        closed(circle(&sphere, Vector3([1.0, -0.5, -0.3]), 0.4)),
        closed(circle(&sphere, Z, 0.2)),
        path(&sphere, Vector3([0.7, 0.0, 1.0]), Vector3([0.5, 0.5, 1.0])),
    ]
}

#[test]
fn without_closed_curves_the_piece_is_the_whole_surface() {
    let surface = mesh(&without(&sphere(3), |x| x[2] > 0.8), ellipsoid);
    let arc =
        path(&without(&sphere(3), |x| x[2] > 0.8), Vector3([1.0, 0.0, -0.3]), Vector3([0.0, 1.0, -0.3]));
    let pieces = cut(&surface, std::slice::from_ref(&arc), std::slice::from_ref(&arc)).unwrap();
    let [(ours, theirs)] = &pieces[..] else { panic!("one piece") };
    check(ours);
    assert_eq!((&ours.points[..], &ours.faces[..]), (surface.points(), surface.faces()));
    assert_eq!(ours.features, theirs.features);
    assert!(!ours.features[0].is_loop && ours.features[1].is_loop);
    assert_eq!(ours.features[0].left.vertices, arc.iter().copied().map(Vertex::new).collect::<Vec<_>>());
}

#[test]
fn nested_and_disjoint_circles_bound_pieces_with_the_same_parameters_on_both_sides() {
    let surface = mesh(&sphere(4), ellipsoid);
    let pieces = cut(&surface, &curves(), &curves()).unwrap();
    assert_eq!(pieces.len(), 4);
    assert_eq!(pieces.iter().map(|(ours, _)| ours.faces.len()).sum::<usize>(), surface.n_faces());
    let mut loops: Vec<Feature> = Vec::new();
    for (ours, theirs) in &pieces {
        check(ours);
        assert_eq!((&ours.vertex_of, &ours.face_of), (&theirs.vertex_of, &theirs.face_of));
        assert_eq!(ours.features, theirs.features);
        let on_surface = ours.features.iter().map(|f| f.clone().with_vertices(|v| ours.vertex_of[v]));
        loops.extend(on_surface.filter(|feature| feature.is_loop));
    }
    assert_eq!(loops.len(), 6);
    let other_side =
        |feature: &Feature| Feature { left: feature.right.clone(), right: feature.left.clone(), ..*feature };
    assert!(loops.iter().all(|feature| loops.contains(&other_side(feature))));
    let counts: Vec<[usize; 2]> = pieces
        .iter()
        .map(|(ours, _)| {
            let loops = ours.features.iter().filter(|feature| feature.is_loop).count();
            [loops, ours.features.len() - loops]
        })
        .collect();
    // outside with an arc, the ring between the nested circles with an arc, and two disks
    let mut sorted = counts.clone();
    sorted.sort_unstable();
    assert_eq!(sorted, [[1, 0], [1, 0], [2, 1], [2, 1]]);
}

#[test]
fn start_and_direction_of_closed_curves_mean_nothing() {
    let surface = mesh(&sphere(4), ellipsoid);
    let mut turned = curves();
    for curve in [1, 2, 3] {
        turned[curve].pop();
        turned[curve].rotate_left(2 * curve);
        turned[curve].reverse();
        let first = turned[curve][0];
        turned[curve].push(first);
    }
    for (ours, theirs) in cut(&surface, &curves(), &turned).unwrap() {
        check(&theirs);
        assert_eq!(ours.face_of, theirs.face_of);
        for (our, their) in ours.features.iter().zip(&theirs.features) {
            assert_eq!(
                (&our.left.vertices, &our.right.vertices),
                (&their.left.vertices, &their.right.vertices)
            );
        }
    }
}

#[test]
fn the_edge_that_closes_a_curve_belongs_to_one_edge() {
    let surface = mesh(&sphere(4), ellipsoid);
    let open: Vec<Vec<usize>> = curves()
        .into_iter()
        .enumerate()
        .map(|(k, mut curve)| {
            if [1, 2, 3].contains(&k) {
                curve.pop();
            }
            curve
        })
        .collect();
    let mut turned = open.clone();
    [1, 2, 3].into_iter().for_each(|curve| turned[curve].reverse());
    for theirs in [open.clone(), turned] {
        let ends: Vec<[Vertex; 2]> = [1, 2, 3]
            .iter()
            .map(|&k| [theirs[k][theirs[k].len() - 1], theirs[k][0]].map(Vertex::new))
            .collect();
        for (our, their) in cut(&surface, &open, &theirs).unwrap() {
            check(&our);
            check(&their);
            for (ours, theirs) in our.features.iter().zip(&their.features).filter(|(_, their)| their.is_loop)
            {
                let inner_ends = |bank: &Bank| [1, 0].map(|k| their.vertex_of[bank.vertices[k]]);
                let bank = [&theirs.left, &theirs.right].map(|bank| ends.contains(&inner_ends(bank)));
                assert!(bank[0] != bank[1], "the gap leads into the start");
                let [of_ours, of_theirs] = [ours, theirs].map(|f| if bank[0] { &f.left } else { &f.right });
                assert_eq!(of_ours.parameters[1], of_theirs.parameters[1]);
            }
        }
    }
}

#[test]
fn curves_on_different_sides_are_refused() {
    let surface = mesh(&sphere(4), ellipsoid);
    let mut moved = curves();
    moved[4] = path(&sphere(4), Vector3([-1.0, 0.0, -0.3]), Vector3([-0.6, -0.3, -1.0]));
    let error = cut(&surface, &curves(), &moved).unwrap_err();
    let expected = "curve 4 lies inside closed curve 1 on the source but outside on the other surface";
    assert!(error.to_string().starts_with(expected), "{error}");
}
