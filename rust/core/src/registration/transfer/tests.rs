// SPDX-License-Identifier: MIT OR Apache-2.0
use super::*;
use crate::location::tests::{Map, number, octasphere, rings};
use crate::mesh::{Corner, Face, Vertex};

fn located(target: &Map, points: &[Vector3]) -> Vec<Location> {
    let locator = Locator::new(&target.0, &target.1);
    points.iter().map(|&x| locator.locate(x)).collect()
}

fn sides(target: &Map, source: &Map, locations: &[Location]) -> Vec<Location> {
    corner_sides(&source.1, &source.0, &target.1, &target.0, locations)
}

fn corners(values: &[f64], width: usize, target: &Map, source: &Map) -> Vec<f64> {
    let locations = located(target, &source.0);
    pull_corners(values, width, &source.1, &source.0, &target.1, &target.0, &locations)
}

/// A source that shares hardly a vertex with `rings`, inside its polygon.
fn turned_rings(n: u32) -> Map {
    let (points, faces) = rings(n);
    let (sine, cosine) = 0.123f64.sin_cos();
    (
        points
            .into_iter()
            .map(|Vector3([u, v, w])| {
                Vector3([0.8 * (cosine * u - sine * v), 0.8 * (sine * u + cosine * v), w])
            })
            .collect(),
        faces,
    )
}

fn by_corner(faces: &[[Vertex; 3]], value: impl Fn(Vertex) -> f64) -> Vec<f64> {
    faces.as_flattened().iter().map(|&vertex| value(vertex)).collect()
}

#[test]
fn linear_functions_are_reproduced() {
    let (target, source) = (rings(7), turned_rings(5));
    let linear = |Vector3([u, v, _]): Vector3| [2.0 * u - v + 0.5, 7.0 * v];
    let values: Vec<f64> = target.0.iter().flat_map(|&x| linear(x)).collect();
    let locations = located(&target, &source.0);
    let pulled = pull_vertices(&values, 2, &target.1, &locations);
    for (vertex, &x) in source.0.iter().enumerate() {
        (0..2).for_each(|k| assert!((pulled[2 * vertex + k] - linear(x)[k]).abs() < 1e-14));
    }
    // data by corner without a seam are the same
    let corners: Vec<f64> = target.1.as_flattened().iter().flat_map(|&v| linear(target.0[v])).collect();
    let pulled_corners = self::corners(&corners, 2, &target, &source);
    for (corner, &vertex) in source.1.as_flattened().iter().enumerate() {
        let at_vertex = &pulled[2 * vertex.index()..][..2];
        (0..2).for_each(|k| assert!((pulled_corners[2 * corner + k] - at_vertex[k]).abs() < 1e-14));
    }
    assert_eq!(
        self::corners(&vec![0.1; 3 * target.1.len()], 1, &target, &source),
        vec![0.1; 3 * source.1.len()]
    );
}

#[test]
fn a_mesh_gets_its_own_data_back_to_the_bit() {
    for map in [rings(4), octasphere(2)] {
        let locations = located(&map, &map.0);
        let sides = sides(&map, &map, &locations);
        // every corner of every face has a value of its own: each edge is a seam
        let values: Vec<f64> = (0..3 * map.1.len()).map(number).collect();
        assert_eq!(corners(&values, 1, &map, &map), values);
        let own: Vec<Corner> = Corner::all(map.1.len()).collect();
        assert_eq!(nearest_corners(&sides), own);
        let vertices: Vec<Vertex> = Vertex::all(map.0.len()).collect();
        assert_eq!(nearest_vertices(&map.1, &locations), vertices);
    }
}

#[test]
fn the_side_of_a_seam_is_that_of_the_face() {
    // the line v = 0 is a chain of edges in both, but of edges of different lengths; above it the data jump by 10
    let (target, source) = (rings(6), rings(4));
    let is_above = |points: &[Vector3], face: [Vertex; 3]| {
        triangle(points, face).iter().map(|x| x[1]).sum::<f64>() > 0.0
    };
    let on_target = |face: usize| if is_above(&target.0, target.1[face]) { 10.0 } else { 0.0 };
    let values: Vec<f64> = (0..3 * target.1.len())
        .map(|corner| on_target(corner / 3) + target.0[target.1.as_flattened()[corner]][0])
        .collect();
    // and a little noise: registrations are not exact
    for noise in [0.0, 1e-9, 1e-7] {
        let shaken: Vec<Vector3> = (0..source.0.len())
            .map(|v| source.0[v] + Vector3([noise * number(2 * v), noise * number(2 * v + 1), 0.0]))
            .collect();
        let source = (shaken, source.1.clone());
        let locations = located(&target, &source.0);
        let sides = sides(&target, &source, &locations);
        let pulled = corners(&values, 1, &target, &source);
        let labels: Vec<u8> = (0..values.len()).map(|corner| u8::from(on_target(corner / 3) > 0.0)).collect();
        let pulled_labels = pull_rows(&labels, 1, &nearest_corners(&sides));
        for (corner, &vertex) in source.1.as_flattened().iter().enumerate() {
            let above = is_above(&source.0, source.1[corner / 3]);
            assert_eq!(pulled_labels[corner], u8::from(above));
            let expected = if above { 10.0 } else { 0.0 } + source.0[vertex][0];
            // beyond the chords the nearest point of the rim counts
            let inside = source.0[vertex].norm() < 1.4;
            assert!((pulled[corner] - expected).abs() < if inside { 1e-6 } else { 1e-2 });
        }
    }
}

#[test]
fn no_face_is_smeared_over_a_seam() {
    // the angle, from 0 to 1 in the rings of the target, jumps where u > 0 = v: amid faces of the source
    let (target, source) = (rings(12), turned_rings(5));
    let angle = |x: Vector3| x[1].atan2(x[0]).rem_euclid(std::f64::consts::TAU) / std::f64::consts::TAU;
    let values: Vec<f64> = target
        .1
        .iter()
        .flat_map(|&face| {
            let corners = triangle(&target.0, face);
            let middle = angle(corners.into_iter().sum::<Vector3>() * (1.0 / 3.0));
            corners.map(|x| if x.norm() == 1.0 { middle } else { angle(x) - (angle(x) - middle).round() })
        })
        .collect();
    let pulled = corners(&values, 1, &target, &source);
    let mut n_across = 0;
    for (face, &vertices) in source.1.iter().enumerate() {
        let corners = triangle(&source.0, vertices);
        let centroid = corners.into_iter().sum::<Vector3>() * (1.0 / 3.0);
        if centroid[0].hypot(centroid[1]) < 0.25 {
            continue;
        }
        n_across += usize::from(corners.iter().any(|&x| (angle(x) - angle(centroid)).abs() > 0.5));
        for (k, &x) in corners.iter().enumerate() {
            // on the other side of the seam, the seam's own value, 0 or 1, instead
            let on_this_side = angle(x) - (angle(x) - angle(centroid)).round();
            let error = (pulled[3 * face + k] - on_this_side.clamp(0.0, 1.0)).abs();
            assert!(error < 0.01, "{error}");
        }
    }
    assert!(n_across > 3);
}

#[test]
fn labels_come_from_the_nearest_corner() {
    let target: Map = (
        vec![Vector3([0., 0., 1.]), Vector3([1., 0., 1.]), Vector3([0., 1., 1.])],
        vec![[0, 1, 2].map(Vertex)],
    );
    let locations =
        located(&target, &[Vector3([0.6, 0.3, 1.0]), Vector3([0.1, 0.7, 1.0]), Vector3([0.5, 0.0, 1.0])]);
    let nearest = nearest_vertices(&target.1, &locations);
    assert_eq!(nearest, [1, 2, 0].map(Vertex));
    assert_eq!(pull_rows(&["a", "b", "c", "d", "e", "f"], 2, &nearest), ["c", "d", "e", "f", "a", "b"]);
}

#[test]
fn a_value_that_is_not_finite_stays_where_it_is() {
    let target = rings(1);
    let mut values = by_corner(&[[0, 1, 2].map(Vertex)], |vertex| f64::from(vertex.0));
    values.extend([4.0, 5.0, 6.0, f64::NAN]);
    let locations = located(&target, &target.0[..6]);
    assert_eq!(pull_vertices(&values, 1, &target.1, &locations), [0.0, 1.0, 2.0, 4.0, 5.0, 6.0]);
}

#[test]
fn a_vertex_takes_the_weighted_mean_of_its_triangle() {
    let middle = Location { triangle: Face(0), barycentric: [0.5, 0.25, 0.25] };
    assert_eq!(pull_vertices(&[1.0, 2.0, 6.0], 1, &[[0, 1, 2].map(Vertex)], &[middle]), [2.5]);
}
