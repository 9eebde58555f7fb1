// SPDX-License-Identifier: MIT OR Apache-2.0
//! Known motions are recovered without folds; slopes are those of the values.

use std::f64::consts::{PI, TAU};

use super::*;
use crate::alignment::rotation::rotation_of;
use crate::control::Silent;
use crate::mesh::TriangleMesh;
use crate::vector::coordinates;

/// A sphere of rings between two poles.
fn ball(rings: usize) -> TriangleMesh {
    let around = 2 * rings;
    let mut points = vec![Vector3::unit(2)];
    for ring in 1..=rings {
        let polar = PI * ring as f64 / (rings + 1) as f64;
        points.extend((0..around).map(|k| {
            let angle = TAU * k as f64 / around as f64;
            Vector3([polar.sin() * angle.cos(), polar.sin() * angle.sin(), polar.cos()])
        }));
    }
    points.push(-Vector3::unit(2));
    let on = |ring: usize, k: usize| (1 + (ring - 1) * around + k % around) as u32;
    let mut faces = Vec::new();
    for k in 0..around {
        faces.push([0, on(1, k), on(1, k + 1)]);
        faces.push([(points.len() - 1) as u32, on(rings, k + 1), on(rings, k)]);
        for ring in 1..rings {
            faces.push([on(ring, k), on(ring + 1, k), on(ring + 1, k + 1)]);
            faces.push([on(ring, k), on(ring + 1, k + 1), on(ring, k + 1)]);
        }
    }
    TriangleMesh::new(&coordinates(points), &faces).unwrap()
}

fn on_unit_sphere(mesh: &TriangleMesh) -> Vec<Vector3> {
    mesh.points().iter().map(|point| point.normalized()).collect()
}

/// Two signals without symmetry, of large and of small shapes.
fn signals_at(Vector3([x, y, z]): Vector3) -> [f64; 2] {
    let large = [(3.0 * x + 1.0).sin() + (2.0 * y - 0.5).cos() * z, x * y + 0.5 * (4.0 * z + x).sin()];
    [large[0] + (8.0 * y).sin() * (7.0 * z).cos(), large[1] + (9.0 * x).sin() * (8.0 * z + 1.0).sin()]
}

fn signals(map: impl IntoIterator<Item = Vector3>) -> Vec<f64> {
    map.into_iter().flat_map(signals_at).collect()
}

/// A smooth warp of the sphere.
fn warped(x: Vector3) -> Vector3 {
    let Vector3([a, b, c]) = x;
    (x + Vector3([0.2 * b * c, -0.15 * a, 0.2 * a * a])).normalized()
}

/// The source laid over the target, which is turned and warped against it, with the place where each vertex belongs.
fn laid(turn: [f64; 4], warp: fn(Vector3) -> Vector3) -> (TriangleMesh, Vec<Vector3>, Vec<Vector3>) {
    let (source, target) = (ball(22), ball(25));
    let [ours, theirs] = [&source, &target].map(on_unit_sphere);
    let rotation = rotation_of(turn);
    let values = Signals {
        width: 2,
        source: signals(ours.iter().map(|&x| rotate(rotation, x)).map(warp)),
        target: signals(theirs.iter().copied()),
    };
    let mut silent = Silent;
    let (map, status) = aligned(
        OnSphere { mesh: &source, map: &ours },
        OnSphere { mesh: &target, map: &theirs },
        &values,
        None,
        &[],
        &Watch::new(&mut silent, 0.0, ""),
    )
    .unwrap();
    assert_eq!(status, Status::Converged);
    let places = ours.iter().map(|&x| warp(rotate(rotation, x))).collect();
    (source, map, places)
}

fn mean_distance(map: &[Vector3], places: &[Vector3]) -> f64 {
    map.iter().zip(places).map(|(x, y)| x.distance(*y)).sum::<f64>() / map.len() as f64
}

#[test]
fn a_rotation_is_recovered() {
    for turn in [[0.5, -0.1, 0.7, 0.5], [0.0, 1.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0, 0.6, 0.0, 0.8]] {
        let (_, map, places) = laid(turn, |x| x);
        assert!(mean_distance(&map, &places) < 5e-3);
    }
}

#[test]
fn a_warp_is_recovered_without_folds() {
    let (source, map, places) = laid([0.5, -0.1, 0.7, 0.5], warped);
    assert!(folded_on_sphere(source.faces(), &map).is_empty());
    let before: Vec<Vector3> = places.iter().map(|&x| x - (warped(x) - x)).collect();
    let [now, then] = [mean_distance(&map, &places), mean_distance(&before, &places)];
    assert!(now < 0.3 * then, "{now} {then}");
}

#[test]
fn gradients_are_slopes_of_values_and_walks_find_the_place() {
    let mesh = ball(12);
    let map = on_unit_sphere(&mesh);
    let values = signals(map.iter().copied());
    let field = SphereSignals::new(OnSphere { mesh: &mesh, map: &map }, &values, 2);
    let mut near = field.place(Vector3::unit(0));
    for k in 0..50 {
        let t = f64::from(k);
        let x = Vector3([(1.3 * t + 0.1).sin(), (2.1 * t).cos(), (0.7 * t + 0.4).sin()]).normalized();
        near = field.place_near(x, near);
        let place = field.place(x);
        for signal in 0..2 {
            assert!((field.value(&near, signal) - field.value(&place, signal)).abs() < 1e-12);
            let along = x.cross(Vector3([0.3, -0.2, 0.9])).normalized();
            let at = |step: f64| field.value(&field.place_near(x + along * step, place), signal);
            let slope = (at(1e-6) - at(-1e-6)) / 2e-6;
            assert!((field.gradient(&place, x, signal).dot(along) - slope).abs() < 1e-6);
        }
    }
}

#[test]
fn smoothing_damps_harmonics_by_their_degree() {
    let mesh = ball(40);
    let map = on_unit_sphere(&mesh);
    let smoothing = Smoothing::new(OnSphere { mesh: &mesh, map: &map }).unwrap();
    // 1, and harmonics of degrees 1 and 2
    let values: Vec<f64> = map.iter().flat_map(|&Vector3([x, y, z])| [1.0, x - z, x * y]).collect();
    let mut silent = Silent;
    let smooth = smoothing.smoothed(&values, 3, 0.5, &Watch::new(&mut silent, 0.0, "")).unwrap();
    for (signal, degree) in [0.0f64, 1.0, 2.0].into_iter().enumerate() {
        let factor = (1.0 + 0.5 * 0.25 / 2.0 * degree * (degree + 1.0)).powi(-2);
        let error = |v: usize| (smooth[3 * v + signal] - factor * values[3 * v + signal]).abs();
        let worst = (0..map.len()).map(error).fold(0.0, f64::max);
        assert!(worst < 0.02, "{degree}: {worst}");
    }
}
