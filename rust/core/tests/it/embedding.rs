// SPDX-License-Identifier: MIT OR Apache-2.0
//! The progressive embedding by its properties: no fold on any sphere or disk, however bad its shape.

use authalic::testing::{Stop, TriangleMesh, folded_in_plane, progressive_disk, progressive_sphere, relaxed};
use authalic::{Silent, Status};
use std::f64::consts::TAU;

use crate::common::closed::{assert_bijective, capsule, parallels, spheres, spiky_spheres, tetrahedron};
use crate::common::{self, distance, grid};
use proptest::prelude::*;

type Point = [f64; 3];

/// No face folded, and the boundary once around the circle, counter-clockwise.
fn assert_is_disk(mesh: &TriangleMesh, map: &[[f64; 2]], context: &str) {
    assert_eq!(folded_in_plane(mesh.faces(), map), [0usize; 0], "{context}: folded faces");
    let boundary = &mesh.boundary_loops()[0];
    let arc = |k: usize| {
        let [a, b] = [boundary[k], boundary[(k + 1) % boundary.len()]].map(|vertex| map[vertex]);
        assert!((a[0].hypot(a[1]) - 1.0).abs() < 1e-14, "{context}: off the circle");
        let arc = (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1]);
        if arc > 0.0 { arc } else { arc + TAU }
    };
    let turn: f64 = (0..boundary.len()).map(arc).sum();
    assert!((turn - TAU).abs() < 1e-9, "{context}: turns by {turn}");
}

fn check(mesh: &TriangleMesh, targets: &[f64], context: &str) {
    if mesh.require_disk().is_ok() {
        let map = progressive_disk(mesh, targets, &mut Silent);
        assert_is_disk(mesh, &map.unwrap_or_else(|stop| panic!("{context}: {stop:?}")), context);
    } else {
        let map = progressive_sphere(mesh, targets, &mut Silent);
        assert_bijective(mesh, &map.unwrap_or_else(|stop| panic!("{context}: {stop:?}")), context);
    }
}

fn check_areas(mesh: &TriangleMesh, context: &str) {
    check(mesh, mesh.face_areas(), context);
}

fn scaled(vertices: &[Point], by: Point) -> Vec<Point> {
    vertices.iter().map(|x| [0, 1, 2].map(|axis| by[axis] * x[axis])).collect()
}

/// A polygon of n corners on the unit circle.
fn polygon(n: u32) -> Vec<Point> {
    let angle = |i: u32| TAU * f64::from(i) / f64::from(n);
    (0..n).map(|i| [angle(i).cos(), angle(i).sin(), 0.0]).collect()
}

/// A polygon with its apex, a disk, or with two, a sphere.
fn fan(n: u32, height: f64, twice: bool) -> TriangleMesh {
    let mut vertices = polygon(n);
    vertices.push([0.0, 0.0, height]);
    let mut faces: Vec<[u32; 3]> = (0..n).map(|i| [i, (i + 1) % n, n]).collect();
    if twice {
        vertices.push([0.0, 0.0, -height]);
        faces.extend((0..n).map(|i| [(i + 1) % n, i, n + 1]));
    }
    TriangleMesh::new(&vertices, &faces).unwrap()
}

/// A polygon triangulated without another vertex, each part split where `split` says.
fn split_polygon(n: u32, mut split: impl FnMut(u32, u32) -> u32) -> TriangleMesh {
    let (mut faces, mut open) = (Vec::new(), vec![[0, n - 1]]);
    while let Some([from, to]) = open.pop() {
        if to - from > 1 {
            let at = split(from, to);
            faces.push([from, at, to]);
            open.extend([[from, at], [at, to]]);
        }
    }
    TriangleMesh::new(&polygon(n), &faces).unwrap()
}

/// A closed surface without one of its faces.
fn punctured(vertices: &[Point], faces: &[[u32; 3]]) -> TriangleMesh {
    TriangleMesh::new(vertices, &faces[1..]).unwrap()
}

#[test]
fn every_test_mesh_is_embedded() {
    for shape in common::disks().iter().chain(&spheres()).chain(&spiky_spheres()) {
        check_areas(&shape.mesh(), shape.name);
    }
}

#[test]
fn the_smallest_meshes_are_embedded() {
    check_areas(&tetrahedron().mesh(), "four vertices");
    check_areas(&fan(3, 1.0, true), "five vertices");
    check_areas(&split_polygon(3, |from, _| from + 1), "one face");
    check_areas(&split_polygon(4, |from, _| from + 1), "two faces");
    check_areas(&fan(3, 0.0, false), "three faces");
}

#[test]
fn long_thin_surfaces_are_embedded() {
    for aspect in [2.0, 10.0, 30.0, 100.0] {
        let base = parallels(40, 12);
        let vertices = scaled(&base.vertices, [1.0, 1.0, aspect]);
        check_areas(&TriangleMesh::new(&vertices, &base.faces).unwrap(), &format!("ellipsoid {aspect}"));
        check_areas(&punctured(&vertices, &base.faces), &format!("ellipsoid {aspect}, a face open"));
    }
    for (rows, length) in [(360, 9.4), (1440, 37.7)] {
        let tube = capsule(rows, 12);
        let vertices = scaled(&tube.vertices, [1.0, 1.0, length]);
        check_areas(&TriangleMesh::new(&vertices, &tube.faces).unwrap(), &format!("tube of {rows} rows"));
        check_areas(&punctured(&vertices, &tube.faces), &format!("tube of {rows} rows, a face open"));
    }
    let strip = grid(400, 1);
    check_areas(&strip.mesh(), "strip");
    check_areas(&grid(400, 2).mesh(), "strip of two");
}

#[test]
fn hubs_and_ears_are_embedded() {
    for n in [4, 1000] {
        check_areas(&fan(n, 0.0, false), &format!("fan of {n}"));
        check_areas(&fan(n, 5.0, false), &format!("cone of {n}"));
        check_areas(&fan(n, 0.5, true), &format!("bipyramid of {n}"));
    }
    check_areas(&split_polygon(300, |from, _| from + 1), "all from one corner");
    check_areas(&split_polygon(300, |from, to| (from + to) / 2), "halves");
}

#[test]
fn targets_far_apart_are_embedded() {
    for shape in [common::icosphere(3), common::bumpy_disk(12), grid(30, 20)] {
        let mesh = shape.mesh();
        let spread = |face: usize| mesh.face_areas()[face] * 10f64.powi(-((face * 7919) as i32 % 8));
        let targets: Vec<f64> = (0..mesh.n_faces()).map(spread).collect();
        check(&mesh, &targets, shape.name);
    }
}

#[test]
fn a_map_follows_its_targets() {
    // the areas of the start are within a factor of three of the targets on a good mesh
    let mesh = common::icosphere(3).mesh();
    let height = |face: usize| mesh.faces()[face].map(|v| mesh.points()[v][2]).iter().sum::<f64>();
    let targets: Vec<f64> =
        (0..mesh.n_faces()).map(|face| if height(face) > 0.0 { 5.0 } else { 1.0 }).collect();
    let map = progressive_sphere(&mesh, &targets, &mut Silent).unwrap();
    let areas = common::closed::image_areas(&mesh, &map);
    let scale = areas.iter().sum::<f64>() / targets.iter().sum::<f64>();
    let ratios = areas.iter().zip(&targets).map(|(area, target)| area / (scale * target));
    ratios.for_each(|ratio| assert!(ratio > 1.0 / 3.0 && ratio < 3.0, "{ratio}"));
}

#[test]
fn the_scale_of_targets_does_not_matter() {
    let mesh = common::bumpy_disk(9).mesh();
    let times = |factor: f64| mesh.face_areas().iter().map(|area| factor * area).collect::<Vec<_>>();
    let [one, two] = [1.0, 1024.0].map(|factor| progressive_disk(&mesh, &times(factor), &mut Silent));
    assert_eq!(one, two);
}

#[test]
fn relaxing_keeps_a_map_open_and_may_be_cancelled() {
    let mesh = common::closed::bumpy();
    let start = progressive_sphere(&mesh, mesh.face_areas(), &mut Silent).unwrap();
    let (map, status) = relaxed(&mesh, mesh.face_areas(), start.clone(), &mut Silent);
    assert_eq!(status, Status::MaxIterations);
    assert_bijective(&mesh, &map, "relaxed");
    assert!(start.iter().zip(&map).any(|(a, b)| distance(*a, *b) > 1e-6), "nothing moved");
    let (map, status) = relaxed(&mesh, mesh.face_areas(), start.clone(), &mut |_: f64, _: &str| false);
    assert_eq!((map, status), (start, Status::Cancelled));
}

#[test]
fn an_observer_sees_rising_fractions_and_may_cancel_any_time() {
    let sphere = common::icosphere(4).mesh();
    let disk = grid(60, 50).mesh();
    for mesh in [sphere, disk] {
        let run = |allowed: usize| {
            let mut seen = Vec::new();
            let mut observer = |part: f64, _: &str| {
                seen.push(part);
                seen.len() <= allowed
            };
            let stop = match mesh.require_disk() {
                Ok(()) => progressive_disk(&mesh, mesh.face_areas(), &mut observer).err(),
                Err(_) => progressive_sphere(&mesh, mesh.face_areas(), &mut observer).err(),
            };
            (seen, stop)
        };
        let (seen, stop) = run(usize::MAX);
        assert_eq!(stop, None);
        assert!(seen.is_sorted() && seen.iter().all(|part| (0.0..=1.0).contains(part)), "{seen:?}");
        for allowed in 0..seen.len() {
            let (seen, stop) = run(allowed);
            assert_eq!((seen.len(), stop), (allowed + 1, Some(Stop::Cancelled)));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Spheres with vertices anywhere, whatever they look like, are embedded, and so are they with a hole.
    #[test]
    fn random_surfaces_are_embedded(
        noise in prop::collection::vec(-1.0f64..1.0, 3 * 162),
        size in 0.0f64..4.0,
        open in 0usize..3,
    ) {
        let base = common::icosphere(2);
        let moved = |(k, x): (usize, &Point)| [0, 1, 2].map(|axis| x[axis] + size * noise[3 * k + axis]);
        let vertices: Vec<Point> = base.vertices.iter().enumerate().map(moved).collect();
        let mesh = TriangleMesh::new(&vertices, &base.faces[open..]);
        if let Ok(mesh) = mesh {
            prop_assume!(mesh.boundary_loops().len() < 2);
            check_areas(&mesh, "random");
        }
    }

    /// Polygons triangulated at random, nothing but boundary, are embedded.
    #[test]
    fn random_polygons_are_embedded(n in 3u32..200, splits in prop::collection::vec(0.0f64..1.0, 200)) {
        let mut k = 0;
        let mesh = split_polygon(n, |from, to| {
            k += 1;
            from + 1 + (splits[k % 200] * f64::from(to - from - 1)) as u32
        });
        check_areas(&mesh, "polygon");
    }

    /// Targets seven orders of magnitude apart at random.
    #[test]
    fn random_targets_are_met_without_folds(exponents in prop::collection::vec(-7.0f64..0.0, 320)) {
        let targets: Vec<f64> = exponents.iter().map(|&exponent| 10f64.powf(exponent)).collect();
        check(&common::icosphere(2).mesh(), &targets, "sphere");
        let disk = common::bumpy_disk(7).mesh();
        check(&disk, &targets[..disk.n_faces()], "disk");
    }
}
