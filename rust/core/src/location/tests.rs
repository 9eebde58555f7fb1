// SPDX-License-Identifier: MIT OR Apache-2.0
use std::collections::HashMap;

use super::*;
use crate::control::Silent;
use crate::mesh::{Face, Vertex, faces_of_indices};

/// Positions and faces.
pub(crate) type Map = (Vec<Vector3>, Vec<[Vertex; 3]>);

/// Numbers in [-1, 1) without order.
pub(crate) fn number(i: usize) -> f64 {
    let mixed = (i as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    let mixed = (mixed ^ (mixed >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    (mixed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

fn random_direction(i: usize) -> Vector3 {
    Vector3([number(3 * i), number(3 * i + 1), number(3 * i + 2)]).normalized()
}

/// The octahedron, each face halved along all edges some times, on the sphere.
pub(crate) fn octasphere(level: usize) -> Map {
    let [x, y, z] = [0, 1, 2].map(Vector3::unit);
    let mut points = vec![x, y, -x, -y, z, -z];
    let upper = (0..4u32).map(|i| [i, (i + 1) % 4, 4]);
    let halves = upper.clone().chain(upper.map(|[a, b, _]| [b, a, 5]));
    let mut faces: Vec<_> = halves.map(|face| face.map(Vertex)).collect();
    for _ in 0..level {
        let mut middles = HashMap::new();
        let mut middle = |a: Vertex, b: Vertex| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                points.push((points[a] + points[b]).normalized());
                Vertex::new(points.len() - 1)
            })
        };
        let split = |[a, b, c]: [Vertex; 3]| {
            let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        faces = faces.into_iter().flat_map(split).collect();
    }
    (points, faces)
}

fn tetrahedron() -> Map {
    let corners = [[1., 1., 1.], [1., -1., -1.], [-1., 1., -1.], [-1., -1., 1.]];
    (
        corners.map(|x| Vector3(x).normalized()).to_vec(),
        faces_of_indices(&[[0, 1, 2], [0, 2, 3], [0, 3, 1], [3, 2, 1]]),
    )
}

/// Two poles and slivers from each to the equator, a quarter of the sphere long.
fn spindle(n: u32) -> Map {
    let turn = |i: u32| std::f64::consts::TAU * f64::from(i) / f64::from(n);
    let equator = (0..n).map(|i| [turn(i).cos(), turn(i).sin(), 0.0]);
    let points = equator.chain([[0., 0., 1.], [0., 0., -1.]]).map(Vector3).collect();
    let upper = (0..n).map(|i| [i, (i + 1) % n, n]);
    let halves = upper.clone().chain(upper.map(|[a, b, _]| [b, a, n + 1]));
    (points, halves.map(|face| face.map(Vertex)).collect())
}

/// Rings of the unit disk around its center, `6 j` points in ring j.
pub(crate) fn rings(n: u32) -> Map {
    let first = |ring: u32| if ring == 0 { 0 } else { 1 + 3 * ring * (ring - 1) };
    let mut points = vec![Vector3([0., 0., 1.])];
    let mut faces = Vec::new();
    for ring in 1..=n {
        for i in 0..6 * ring {
            let angle = std::f64::consts::TAU * f64::from(i) / f64::from(6 * ring);
            let radius = f64::from(ring) / f64::from(n);
            points.push(Vector3([radius * angle.cos(), radius * angle.sin(), 1.0]));
            let outer = |i: u32| first(ring) + i % (6 * ring);
            let inner = |i: u32| first(ring - 1) + if ring == 1 { 0 } else { i % (6 * (ring - 1)) };
            let (sector, step) = (i / ring, i % ring);
            let below = sector * (ring - 1) + step;
            faces.push([outer(i), outer(i + 1), inner(below)]);
            if step + 1 < ring {
                faces.push([outer(i + 1), inner(below + 1), inner(below)]);
            }
        }
    }
    (points, faces_of_indices(&faces))
}

/// Whole spheres: fine, coarse, of slivers, and unevenly spread.
fn spheres() -> Vec<Map> {
    let (points, faces) = octasphere(3);
    // most of the sphere's vertices drawn to one side: x ↦ the direction of x + 0.95 e
    let crowded = points.into_iter().map(|x| (x + Vector3([0.0, 0.57, 0.76])).normalized()).collect();
    vec![
        octasphere(0),
        octasphere(1),
        octasphere(3),
        tetrahedron(),
        spindle(5),
        spindle(400),
        (crowded, faces),
    ]
}

/// Disks in the plane z = 1: even, and squeezed to slivers.
fn disks() -> Vec<Map> {
    let squeezed = |by: f64| {
        let (points, faces) = rings(6);
        (points.into_iter().map(|Vector3([u, v, w])| Vector3([u, by * v + 0.3 * u, w])).collect(), faces)
    };
    vec![rings(1), rings(2), rings(9), squeezed(1e-3), squeezed(1e-9)]
}

/// The corners, points of the edges, points next to them, and points inside some faces.
fn hard_points((points, faces): &Map) -> Vec<Vector3> {
    let mut hard = points.clone();
    for (i, &face) in faces.iter().enumerate() {
        let [a, b, c] = triangle(points, face);
        let between = |s: f64| a * (1.0 - s) + b * s;
        let (s, t) = (0.5 + 0.5 * number(i), 0.5 + 0.5 * number(i + 77));
        hard.extend([between(0.5), between(s), between(1e-9), between(s) * (1.0 - 1e-15) + c * 1e-15]);
        hard.push(between(s) * (1.0 - t) + c * t);
    }
    // in the plane the third coordinate is no matter of rounding
    if points.iter().all(|x| x[2] == 1.0) {
        hard.iter_mut().for_each(|x| x[2] = 1.0);
    }
    hard
}

/// All triangles that contain `x`, by exact arithmetic alone.
fn containing((points, faces): &Map, x: Vector3) -> Vec<Face> {
    let coord = |Vector3([x, y, z]): Vector3| Coord3D { x, y, z };
    let sign = |p, q| orient3d(coord(p), coord(q), coord(x), coord(Vector3::ZERO));
    let holds = |&face: &Face| {
        let [a, b, c] = triangle(points, faces[face]);
        sign(a, b) >= 0.0 && sign(b, c) >= 0.0 && sign(c, a) >= 0.0
    };
    Face::all(faces.len()).filter(holds).collect()
}

fn place((points, faces): &Map, location: Location) -> Vector3 {
    let [a, b, c] = triangle(points, faces[location.triangle]);
    let [x, y, z] = location.barycentric;
    a * x + (b * y + c * z)
}

fn is_barycentric(location: Location) -> bool {
    let sum: f64 = location.barycentric.iter().sum();
    location.barycentric.iter().all(|&weight| weight >= 0.0) && (sum - 1.0).abs() < 1e-15
}

#[test]
fn every_direction_is_found_where_exact_arithmetic_puts_it() {
    for map in spheres() {
        let locator = Locator::new(&map.0, &map.1);
        let anywhere = (0..600).map(|i| random_direction(i) * (1.0 + 0.5 * number(i)));
        for x in hard_points(&map).into_iter().chain(anywhere) {
            let location = locator.locate(x);
            assert_eq!(Some(&location.triangle), containing(&map, x).first());
            assert!(is_barycentric(location));
            assert!(place(&map, location).normalized().distance(x.normalized()) < 1e-14);
        }
    }
}

#[test]
fn every_point_of_a_disk_is_found_where_exact_arithmetic_puts_it() {
    // the narrower the triangles, the less their coordinates say where along them a point lies
    for (map, tolerance) in disks().into_iter().zip([1e-15, 1e-15, 1e-15, 1e-14, 1e-8]) {
        let locator = Locator::new(&map.0, &map.1);
        for x in hard_points(&map) {
            let (location, all) = (locator.locate(x), containing(&map, x));
            // a point of a boundary edge may lie outside by rounding
            assert!(all.is_empty() || location.triangle == all[0]);
            assert!(is_barycentric(location));
            assert!(place(&map, location).distance(x) < tolerance);
        }
    }
}

#[test]
fn a_vertex_is_found_exactly() {
    for map in spheres().into_iter().chain(disks()) {
        let locator = Locator::new(&map.0, &map.1);
        for (vertex, &x) in map.0.iter().enumerate() {
            let location = locator.locate(x);
            let corner = map.1[location.triangle].iter().position(|&v| v.index() == vertex);
            let mut exact = [0.0; 3];
            exact[corner.expect("a triangle at the vertex")] = 1.0;
            assert_eq!(location.barycentric, exact);
        }
    }
}

#[test]
fn beyond_a_chord_the_nearest_point_of_the_boundary_is_meant() {
    let map = rings(3);
    let locator = Locator::new(&map.0, &map.1);
    let rim: Vec<Vector3> = map.0[map.0.len() - 18..].to_vec();
    for i in 0..500 {
        let angle = std::f64::consts::TAU * (0.5 + 0.5 * number(i));
        let x = Vector3([angle.cos(), angle.sin(), 1.0]);
        let nearest = place(&map, locator.locate(x));
        // a search along the chords, by steps
        let steps = (0..18).flat_map(|k| (0..=200).map(move |s| (k, f64::from(s) / 200.0)));
        let on_rim = steps.map(|(k, s)| rim[k] * (1.0 - s) + rim[(k + 1) % 18] * s);
        let least = on_rim.map(|y| x.distance(y)).fold(f64::INFINITY, f64::min);
        assert!(nearest.distance(x) <= least && nearest.distance(x) > least - 1e-3);
    }
    // far away, past a corner of the rim: between two triangles, the first
    let beyond = locator.locate(Vector3([30.0, 0.0, 1.0]));
    let corner = Vertex::new(map.0.len() - 18);
    assert_eq!(place(&map, beyond), Vector3([1.0, 0.0, 1.0]));
    assert_eq!(beyond.triangle.index(), map.1.iter().position(|face| face.contains(&corner)).unwrap());
}

#[test]
fn nothing_is_ever_not_a_number() {
    for map in [octasphere(1), rings(2)] {
        let locator = Locator::new(&map.0, &map.1);
        for x in [[0.0; 3], [f64::NAN; 3], [f64::INFINITY, 0.0, 1.0], [1e-300, 0.0, 0.0], [1e200, 1.0, 1.0]] {
            assert!(is_barycentric(locator.locate(Vector3(x))), "{x:?}");
        }
    }
}

#[test]
fn many_points_at_once_are_those_one_by_one_unless_cancelled() {
    let map = octasphere(2);
    let locator = Locator::new(&map.0, &map.1);
    let points: Vec<Vector3> = (0..10_000).map(random_direction).collect();
    let mut silent = Silent;
    let all = locator.locate_all(&points, &Watch::new(&mut silent, 0.0, "locating")).unwrap();
    assert!(points.iter().zip(&all).all(|(&x, &location)| locator.locate(x) == location));
    let mut stop = |_: f64, _: &str| false;
    let watch = Watch::new(&mut stop, 0.0, "locating");
    std::thread::sleep(std::time::Duration::from_millis(100));
    assert!(locator.locate_all(&points, &watch).is_none());
}
