// SPDX-License-Identifier: MIT OR Apache-2.0
use std::f64::consts::TAU;

use super::*;
use crate::distortion::folded_in_plane;
use crate::location::tests::{number, rings};

/// The rings of the unit disk, as a mesh and as its own map.
fn disk(n: u32) -> (TriangleMesh, PlanarMap) {
    let (points, faces) = rings(n);
    let map = flat(&points);
    let flat: Vec<[f64; 3]> = map.iter().map(|&[x, y]| [x, y, 0.3 * x * y]).collect();
    (TriangleMesh::new(&flat, &faces).unwrap(), map)
}

/// A map turned by an angle.
fn turned(map: &[[f64; 2]], angle: f64) -> PlanarMap {
    let (sine, cosine) = angle.sin_cos();
    map.iter().map(|&[x, y]| [cosine * x - sine * y, sine * x + cosine * y]).collect()
}

/// A round disk of two rings around a middle with an ear on every edge of the outer one.
fn toothed(teeth: u32) -> (TriangleMesh, PlanarMap) {
    let on = |radius: f64, turn: f64| {
        let (sine, cosine) = (TAU * turn / f64::from(teeth)).sin_cos();
        [radius * cosine, radius * sine]
    };
    let steps = || (0..teeth).map(f64::from);
    let map: PlanarMap = std::iter::once([0.0, 0.0])
        .chain(steps().map(|k| on(0.5, k)))
        .chain(steps().map(|k| on(1.0, k)))
        .chain(steps().map(|k| on(1.0, k + 0.5)))
        .collect();
    let faces: Vec<[u32; 3]> = (0..teeth)
        .flat_map(|k| {
            let next = (k + 1) % teeth;
            let (inner, outer, tip) = (|k| 1 + k, |k| 1 + teeth + k, 1 + 2 * teeth + k);
            [
                [0, inner(k), inner(next)],
                [inner(k), outer(k), outer(next)],
                [inner(k), outer(next), inner(next)],
                [outer(k), tip, outer(next)],
            ]
        })
        .collect();
    let points: Vec<[f64; 3]> = map.iter().map(|&[x, y]| [x, y, 0.0]).collect();
    (TriangleMesh::new(&points, &faces).unwrap(), map)
}

/// The least distance of a point from the edges of a polygon.
fn off([x, y]: [f64; 2], polygon: &[[f64; 2]]) -> f64 {
    let edges = (0..polygon.len()).map(|k| (polygon[k], polygon[(k + 1) % polygon.len()]));
    let distance = |(p, q): ([f64; 2], [f64; 2])| {
        let [ex, ey] = [q[0] - p[0], q[1] - p[1]];
        let share = (((x - p[0]) * ex + (y - p[1]) * ey) / (ex * ex + ey * ey)).clamp(0.0, 1.0);
        (x - p[0] - share * ex).hypot(y - p[1] - share * ey)
    };
    edges.map(distance).fold(f64::INFINITY, f64::min)
}

/// Checks a map on a rim: no folds, and the boundary on the polygon but for the vertices inside.
fn check(moving: &(TriangleMesh, PlanarMap), rim: &(TriangleMesh, PlanarMap)) -> OnRim {
    let ((mesh, map), (rim_mesh, rim_map)) = (moving, rim);
    let carried = carried_onto(Side { mesh, map }, Side { mesh: rim_mesh, map: rim_map }, None).unwrap();
    assert!(folded_in_plane(mesh.faces(), &carried.map).is_empty());
    let polygon: Vec<[f64; 2]> = rim_mesh.boundary_loops()[0].iter().map(|&v| rim_map[v]).collect();
    for &vertex in &mesh.boundary_loops()[0] {
        let away = off(carried.map[vertex], &polygon);
        assert!(away < if carried.inside.contains(&vertex.index()) { 0.3 } else { 1e-15 }, "{away}");
    }
    for (vertex, location) in &carried.on_edges {
        let [a, b, c] = rim_mesh.faces()[location.triangle].map(|corner| rim_map[corner]);
        let place = [0, 1].map(|axis| {
            location.barycentric[0] * a[axis]
                + location.barycentric[1] * b[axis]
                + location.barycentric[2] * c[axis]
        });
        assert!((place[0] - carried.map[*vertex][0]).hypot(place[1] - carried.map[*vertex][1]) < 1e-15);
        assert!(location.barycentric.contains(&0.0));
    }
    carried
}

#[test]
fn the_boundary_lies_on_the_polygon_and_nothing_folds() {
    for (n, m) in [(8, 2), (2, 8), (5, 1), (1, 5), (4, 4)] {
        for turn in 0..5 {
            let (moving, mut rim) = (disk(n), disk(m));
            rim.1 = turned(&rim.1, number(turn));
            assert!(check(&moving, &rim).inside.is_empty());
        }
    }
}

#[test]
fn a_surface_on_its_own_boundary_stays_bit_for_bit() {
    let disk = disk(5);
    let carried = check(&disk, &disk);
    assert_eq!(carried.map, disk.1);
    assert!(carried.on_edges.is_empty());
}

#[test]
fn ears_get_a_corner_each_or_are_set_inside() {
    // as many corners as ears, all in the wrong places
    let ears = toothed(12);
    let mut rim = disk(2);
    for turn in 0..6 {
        rim.1 = turned(&rim.1, 0.05);
        assert!(check(&ears, &rim).inside.is_empty(), "turn {turn}");
    }
    // twelve ears on six corners
    let carried = check(&ears, &disk(1));
    assert!(!carried.inside.is_empty() && carried.inside.len() < 24);
}
