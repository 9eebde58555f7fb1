// SPDX-License-Identifier: MIT OR Apache-2.0
use std::collections::BTreeMap;
use std::f64::consts::TAU;

use super::*;
use crate::control::Silent;
use crate::distortion::{Distortion, Image, measure};
use crate::mesh::geometry::{face_areas, triangle};
use crate::mesh::{Vertex, faces_of_indices};

type Mesh = (Vec<Vector3>, Vec<[Vertex; 3]>);

/// A sphere of 8 · 4^level faces.
fn octasphere(level: u32) -> Mesh {
    let [x, y, z] = [0, 1, 2].map(Vector3::unit);
    let mut points = vec![x, y, -x, -y, z, -z];
    let quarters = (0..4).flat_map(|i| [[i, (i + 1) % 4, 4], [(i + 1) % 4, i, 5]]);
    let mut faces: Vec<_> = quarters.map(|face| face.map(Vertex)).collect();
    for _ in 0..level {
        let mut middles = BTreeMap::new();
        let mut middle = |a: Vertex, b: Vertex| {
            *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                points.push(CanonicalDomain::Sphere.settled(Vector3::ZERO, points[a] + points[b]));
                Vertex::new(points.len() - 1)
            })
        };
        let split = |&[a, b, c]: &[Vertex; 3]| {
            let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        faces = faces.iter().flat_map(split).collect();
    }
    (points, faces)
}

/// Rings about a center in the plane z = 1, `6 r` vertices on ring `r`, the last on the circle.
fn disk(rings: u32) -> Mesh {
    let first = |ring: u32| if ring == 0 { 0 } else { 1 + 3 * ring * (ring - 1) };
    let on = |ring: u32, i: u32| first(ring) + if ring == 0 { 0 } else { i % (6 * ring) };
    let (mut points, mut faces) = (vec![Vector3([0.0, 0.0, 1.0])], Vec::new());
    for ring in 1..=rings {
        let radius = f64::from(ring) / f64::from(rings);
        let angle = |i: u32| TAU * f64::from(i) / f64::from(6 * ring);
        points
            .extend((0..6 * ring).map(|i| Vector3([radius * angle(i).cos(), radius * angle(i).sin(), 1.0])));
        for (side, k) in (0..6).flat_map(|side| (0..ring).map(move |k| (side, k))) {
            let [outer, inner] = [side * ring + k, side * (ring - 1) + k];
            faces.push([on(ring - 1, inner), on(ring, outer), on(ring, outer + 1)]);
            if k + 1 < ring {
                faces.push([on(ring - 1, inner), on(ring, outer + 1), on(ring - 1, inner + 1)]);
            }
        }
    }
    (points, faces_of_indices(&faces))
}

/// Numbers in [0, 1) that look random.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// `count` landmarks, no two of them very close together, and places about `motion` away.
fn landmarks(
    domain: CanonicalDomain,
    points: &[Vector3],
    count: usize,
    motion: f64,
    seed: u64,
) -> (Vec<Vertex>, Vec<Vector3>) {
    let mut random = Random(seed);
    let apart = 0.8 / (count as f64).sqrt();
    let (mut vertices, mut places): (Vec<Vertex>, Vec<Vector3>) = (Vec::new(), Vec::new());
    while vertices.len() < count {
        let vertex = (random.next() * points.len() as f64) as usize;
        let (x, angle) = (points[vertex], TAU * random.next());
        let frame = domain.motion(false).frame(x);
        let way = frame.axes[0] * (motion * angle.cos()) + frame.axes[1] * (motion * angle.sin());
        let place = domain.on_path(x, way, 1.0).0;
        let inside = |Vector3([u, v, _]): Vector3| domain == CanonicalDomain::Sphere || u * u + v * v < 0.9;
        let far = |from: Vector3, others: &[Vector3]| others.iter().all(|&y| from.distance(y) > apart);
        let starts: Vec<Vector3> = vertices.iter().map(|&v| points[v]).collect();
        if inside(x) && inside(place) && far(x, &starts) && far(place, &places) {
            vertices.push(Vertex::new(vertex));
            places.push(place);
        }
    }
    (vertices, places)
}

fn folded(map: &[Vector3], faces: &[[Vertex; 3]]) -> usize {
    let is_folded = |&face: &[Vertex; 3]| {
        let [a, b, c] = triangle(map, face);
        a.dot((b - a).cross(c - a)) <= 0.0
    };
    faces.iter().filter(|face| is_folded(face)).count()
}

fn gap(map: &[Vector3], landmarks: &[Vertex], places: &[Vector3]) -> f64 {
    landmarks.iter().zip(places).fold(0.0, |most, (&v, &place)| f64::max(most, map[v].distance(place)))
}

fn figures(domain: CanonicalDomain, (points, faces): &Mesh, map: &[Vector3]) -> Distortion {
    let areas = face_areas(points, faces);
    let plane: Vec<[f64; 2]> = map.iter().map(|&Vector3([u, v, _])| [u, v]).collect();
    let image = if domain == CanonicalDomain::Sphere { Image::Sphere(map) } else { Image::Plane(&plane) };
    measure(points, faces, image, &areas).unwrap()
}

/// A mesh that is quick to flow.
fn small(domain: CanonicalDomain) -> Mesh {
    if domain == CanonicalDomain::Sphere { octasphere(4) } else { disk(20) }
}

fn flowed(domain: CanonicalDomain, mesh: &Mesh, landmarks: &[Vertex], places: &[Vector3]) -> Vec<Vector3> {
    let mut silent = Silent;
    let watch = Watch::new(&mut silent, 0.0, "");
    let mended = |map: Vec<Vector3>| (folded(&map, &mesh.1) == 0).then_some(map);
    flow(domain, mesh.0.clone(), landmarks, places, &mended, &watch)
}

#[test]
fn fields_have_the_wanted_velocities_and_no_divergence() {
    for domain in [CanonicalDomain::Sphere, CanonicalDomain::Disk] {
        let (points, _) = small(domain);
        let (vertices, places) = landmarks(domain, &points, 12, 0.2, 3);
        let now: Vec<Vector3> = vertices.iter().map(|&v| points[v]).collect();
        let ways: Vec<Vector3> = now.iter().zip(&places).map(|(&x, &place)| domain.way(x, place)).collect();
        let field = Field::through(domain, domain.reach(), &now, &ways).unwrap();
        for (&x, &way) in now.iter().zip(&ways) {
            assert!(field.velocity(x).distance(way) < 1e-8);
        }
        for &x in points.iter().step_by(5) {
            let slope = |axis: Vector3| {
                let speed = |h: f64| axis.dot(field.velocity(x + axis * h));
                (speed(1e-5) - speed(-1e-5)) / 2e-5
            };
            let [a, b] = domain.motion(false).frame(x).axes.map(slope);
            assert!((a + b).abs() < 1e-7, "{domain:?} at {x:?}: {a} and {b}");
        }
    }
}

#[test]
fn fields_run_along_the_circle() {
    let field =
        Field::through(CanonicalDomain::Disk, 0.6, &[Vector3([0.7, 0.2, 1.0])], &[Vector3([0.5, 0.3, 0.0])])
            .unwrap();
    for angle in [0.0, 0.3, 2.0] {
        let x = Vector3([f64::cos(angle), f64::sin(angle), 1.0]);
        let velocity = field.velocity(x);
        assert!((velocity[0] * x[0] + velocity[1] * x[1]).abs() < 1e-15 && velocity.norm() > 1e-3);
    }
}

#[test]
fn landmarks_arrive_and_nothing_folds() {
    for (domain, count, motion) in [
        (CanonicalDomain::Sphere, 10, 0.2),
        (CanonicalDomain::Sphere, 1, 3.0),
        (CanonicalDomain::Disk, 10, 0.15),
        (CanonicalDomain::Disk, 2, 0.4),
    ] {
        let mesh = small(domain);
        let (vertices, places) = landmarks(domain, &mesh.0, count, motion, 1);
        let map = flowed(domain, &mesh, &vertices, &places);
        assert_eq!(folded(&map, &mesh.1), 0);
        let gap = gap(&map, &vertices, &places);
        assert!(gap < 1e-8, "{domain:?}, {count} by {motion}: {gap}");
    }
}

#[test]
fn ten_landmarks_that_move_far_arrive_on_a_fine_mesh() {
    let mesh = octasphere(6);
    for seed in 0..3 {
        let (vertices, places) = landmarks(CanonicalDomain::Sphere, &mesh.0, 10, 0.3, seed);
        let map = flowed(CanonicalDomain::Sphere, &mesh, &vertices, &places);
        assert_eq!(folded(&map, &mesh.1), 0);
        assert!(gap(&map, &vertices, &places) < 1e-8);
    }
}

#[test]
fn area_distortion_vanishes_under_refinement() {
    for (domain, coarse, fine) in
        [(CanonicalDomain::Sphere, octasphere(4), octasphere(5)), (CanonicalDomain::Disk, disk(16), disk(32))]
    {
        // landmarks of one mesh are vertices of the other
        let (vertices, places) = landmarks(domain, &coarse.0, 4, 0.2, 2);
        let nearest = |x: Vector3| {
            let near = |a: &usize, b: &usize| fine.0[*a].distance(x).total_cmp(&fine.0[*b].distance(x));
            (0..fine.0.len()).min_by(near).map(Vertex::new).unwrap()
        };
        let same: Vec<Vertex> = vertices.iter().map(|&v| nearest(coarse.0[v])).collect();
        let energy = |mesh: &Mesh, vertices: &[Vertex]| {
            figures(domain, mesh, &flowed(domain, mesh, vertices, &places)).authalic_energy
        };
        let [before, after] = [energy(&coarse, &vertices), energy(&fine, &same)];
        assert!(before < 0.05 && after < 0.3 * before, "{domain:?}: {before} and {after}");
    }
}

#[test]
fn the_circle_slides_along_itself() {
    let mesh = disk(24);
    let (vertices, places) = landmarks(CanonicalDomain::Disk, &mesh.0, 4, 0.2, 5);
    let map = flowed(CanonicalDomain::Disk, &mesh, &vertices, &places);
    let rim = &map[map.len() - 6 * 24..];
    let turn = |i: usize| {
        let (Vector3([u, v, _]), Vector3([s, t, _])) = (rim[i], rim[(i + 1) % rim.len()]);
        (u * t - v * s).atan2(u * s + v * t)
    };
    assert!(rim.iter().all(|&Vector3([u, v, w])| (u * u + v * v - 1.0).abs() < 1e-15 && w == 1.0));
    assert!((0..rim.len()).all(|i| turn(i) > 0.0));
    assert!(((0..rim.len()).map(turn).sum::<f64>() - TAU).abs() < 1e-12);
    assert!(map[..map.len() - rim.len()].iter().all(|&Vector3([u, v, w])| u * u + v * v < 1.0 && w == 1.0));
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let mesh = octasphere(5);
    let (vertices, places) = landmarks(CanonicalDomain::Sphere, &mesh.0, 6, 0.2, 4);
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| flowed(CanonicalDomain::Sphere, &mesh, &vertices, &places))
    };
    let bits = |map: Vec<Vector3>| map.into_iter().map(|x| x.0.map(f64::to_bits)).collect::<Vec<_>>();
    assert_eq!(bits(on(1)), bits(on(2)));
}

#[test]
fn landmarks_in_place_leave_the_very_same_map() {
    for domain in [CanonicalDomain::Sphere, CanonicalDomain::Disk] {
        let mesh = small(domain);
        let places = [3, 9, 14].map(|v| mesh.0[v]);
        assert_eq!(flowed(domain, &mesh, &[3, 9, 14].map(Vertex), &places), mesh.0);
        assert_eq!(flowed(domain, &mesh, &[], &[]), mesh.0);
    }
}

#[test]
fn what_cannot_be_followed_ends_at_an_accepted_map() {
    for domain in [CanonicalDomain::Sphere, CanonicalDomain::Disk] {
        // two landmarks that change places meet halfway
        let mesh = small(domain);
        let map = flowed(domain, &mesh, &[1, 4].map(Vertex), &[4, 1].map(|v: usize| mesh.0[v]));
        assert_eq!(folded(&map, &mesh.1), 0);
        assert!(map.iter().all(|x| x.is_finite()));
    }
    let mesh = octasphere(3);
    let map = flowed(CanonicalDomain::Sphere, &mesh, &[Vertex(7)], &[mesh.0[7] * -1.0]);
    assert!(map[7].distance(mesh.0[7] * -1.0) < 1e-8, "antipodes can be reached");
}

#[test]
fn cancelling_returns_the_map_so_far() {
    let mesh = octasphere(3);
    let mut observer = |_: f64, _: &str| false;
    let watch = Watch::new(&mut observer, 0.0, "");
    while watch.goes_on() {}
    let map = flow(CanonicalDomain::Sphere, mesh.0.clone(), &[Vertex(0)], &[mesh.0[5]], &Some, &watch);
    assert_eq!(map, mesh.0);
}
