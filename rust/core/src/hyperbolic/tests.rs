// SPDX-License-Identifier: MIT OR Apache-2.0
//! The stages between metric and certificates, each by its own mathematics, on slit spheres.

use super::features::curves::LandmarkCurves;
use super::features::piece::Piece;
use super::features::pieces::pieces;
use super::features::placement::placed;
use super::features::regions::divided;
use super::harmonic::atlas::{Atlas, Random};
use super::harmonic::certificates::{certify, signed_area};
use super::harmonic::chart_map::ChartMap;
use super::harmonic::delaunay::{Net, Weighted, delaunay};
use super::harmonic::heat::diffuse;
use super::harmonic::initial::{initial_map, segment};
use super::harmonic::inverse::inverse;
use super::harmonic::newton::newton;
use super::metric::{Metric, MetricMethod, hyperbolic_metric};
use super::moebius;
use super::moebius::{Complex, Moebius, distance};
use super::sample_meshes::{mesh, path, sphere};
use super::slice::slice_pair;
use super::slice::sliced::{Sliced, SlicedPair};
use crate::control::{Silent, Status, Watch};
use crate::mesh::{Corner, Face};
use crate::vector::Vector3;

/// Ends of four curves on the sphere.
const ENDS: [[Vector3; 2]; 4] = [
    [Vector3([1.0, 0.1, 0.3]), Vector3([0.7, 0.7, 0.1])],
    [Vector3([-0.2, 1.0, 0.2]), Vector3([-0.6, 0.6, 0.6])],
    [Vector3([-1.0, -0.2, -0.3]), Vector3([-0.5, -0.8, 0.1])],
    [Vector3([0.3, -0.7, -0.8]), Vector3([0.6, -0.2, -0.9])],
];

/// Two spheres with four curves each, those of the target a little farther on, cut open.
fn slit_spheres(level: u32) -> SlicedPair {
    let grid = sphere(level);
    let source = mesh(&grid, |x| Vector3([1.2 * x[0], x[1], 0.9 * x[2] + 0.1 * x[0] * x[0]]));
    let target = mesh(&grid, |x| Vector3([x[0], 1.1 * x[1] + 0.1 * x[2], x[2]]));
    let moved = |x: Vector3| Vector3([x[0] + 0.15 * x[1], x[1] - 0.1 * x[2], x[2] + 0.05]);
    let ours = ENDS.map(|[from, to]| path(&grid, from, to)).to_vec();
    let theirs = ENDS.map(|[from, to]| path(&grid, moved(from), moved(to))).to_vec();
    let curves = LandmarkCurves { source: &ours, target: &theirs };
    let pairs = curves.check(&source, &target).unwrap();
    let divided = divided(&source, &target, pairs).unwrap();
    let mut silent = Silent;
    let watch = Watch::new(&mut silent, 0.0, "");
    let placement = placed([&source, &target], &divided, None, &watch).unwrap();
    let pieces: Vec<(Piece, Piece)> = pieces(&source, &target, &divided, &placement);
    let isotopy = super::slice::isotopy::Isotopy::between(&pieces[0].0, &pieces[0].1, &watch);
    let carry = |line: &[Vector3]| isotopy.as_ref().map(|isotopy| isotopy.carry(line));
    slice_pair(&pieces[0].0, &pieces[0].1, &carry, &watch).unwrap()
}

fn metric(sliced: &Sliced) -> Metric {
    let mut silent = Silent;
    let watch = Watch::new(&mut silent, 0.0, "");
    hyperbolic_metric(&sliced.surface_points(), &sliced.surface.faces, -2, MetricMethod::Newton, &watch)
        .unwrap()
}

/// Runs a check on the start of a map.
fn with_map(level: u32, check: impl FnOnce(&SlicedPair, &Metric, ChartMap<'_>)) {
    let sliced = slit_spheres(level);
    let (ours, theirs) = (metric(&sliced.source), metric(&sliced.target));
    let atlas = Atlas::new(&sliced.target.surface, &theirs);
    let mut silent = Silent;
    let watch = Watch::new(&mut silent, 0.0, "");
    let (places, input) = initial_map(&sliced.source, &sliced.target, &atlas, &watch).unwrap();
    let kept = vec![false; sliced.source.faces.len()];
    let map = ChartMap::by_delaunay(&atlas, places, input, &ours.lengths, &kept);
    check(&sliced, &ours, map);
}

fn is_identity(motion: Moebius) -> bool {
    (motion.a.re.abs() - 1.0).abs() + motion.a.im.abs() + motion.b.norm() < 1e-12
}

#[test]
fn charts_have_the_lengths_of_the_metric_and_fit_together() {
    let sliced = slit_spheres(3).target;
    let metric = metric(&sliced);
    let atlas = Atlas::new(&sliced.surface, &metric);
    for (face, chart) in atlas.charts.iter().enumerate() {
        for k in 0..3 {
            let length = distance(chart[(k + 1) % 3], chart[(k + 2) % 3]);
            assert!((length - metric.lengths[face][k]).abs() < 1e-12);
            let corner = Face::new(face).corner(k);
            if let Some(across) = sliced.surface.opposite[corner] {
                let there_and_back = atlas.transitions[across] * atlas.transitions[corner];
                assert!(is_identity(there_and_back));
            }
        }
    }
}

#[test]
fn coordinates_on_a_face_come_back_and_agree_across_edges() {
    let sliced = slit_spheres(3).target;
    let metric = metric(&sliced);
    let atlas = Atlas::new(&sliced.surface, &metric);
    for corner in Corner::all(atlas.charts.len()) {
        let Some(across) = sliced.surface.opposite[corner] else { continue };
        let (face, k) = (corner.face(), corner.place());
        let back = atlas.barycentric(face, atlas.at(face, [0.2, 0.5, 0.3]));
        assert!((back[0] - 0.2).abs() + (back[1] - 0.5).abs() + (back[2] - 0.3).abs() < 1e-9);
        let on_edge = |k: usize, t: f64| {
            let mut weights = [0.0; 3];
            (weights[(k + 1) % 3], weights[(k + 2) % 3]) = (1.0 - t, t);
            weights
        };
        let ours = atlas.transitions[corner].apply(atlas.at(face, on_edge(k, 0.3)));
        let theirs = atlas.at(across.face(), on_edge(across.place(), 0.7));
        assert!(distance(ours, theirs) < 1e-10, "{}", distance(ours, theirs));
    }
}

#[test]
fn walks_end_where_they_should() {
    let sliced = slit_spheres(3).target;
    let metric = metric(&sliced);
    let atlas = Atlas::new(&sliced.surface, &metric);
    // from each face to the middles of its neighbors, as seen from it
    for corner in Corner::all(atlas.charts.len()) {
        let Some(across) = sliced.surface.opposite[corner].map(Corner::face) else { continue };
        let middle = atlas.at(across, [0.3, 0.4, 0.3]);
        let seen = atlas.transitions[corner].inverse().apply(middle);
        let walk = atlas.walk(corner.face(), seen);
        assert!(walk.face == across && distance(walk.x, middle) < 1e-9 && !walk.is_outside);
        assert!(distance(walk.motion.apply(seen), walk.x) < 1e-9);
    }
}

#[test]
fn the_initial_map_closes_up_and_covers_everything() {
    with_map(3, |_, _, map| {
        let certificates = certify(&map, -2);
        assert!(certificates.cocycle_error < 1e-11, "{}", certificates.cocycle_error);
        assert!((certificates.area / certificates.expected_area - 1.0).abs() < 1e-11);
    });
}

#[test]
fn segments_are_the_same_from_both_ends() {
    let parameters = [0.0, 0.2, 0.5, 1.0];
    let backwards = [1.0, 0.5, 0.2, 0.0];
    for s in [0.0, 0.1, 0.2, 0.35, 0.5, 0.7, 1.0] {
        let ((first, t), (back, u)) = (segment(&parameters, s), segment(&backwards, s));
        assert_eq!(first, 2 - back);
        assert!((t + u - 1.0).abs() < 1e-15, "{s}");
    }
}

#[test]
fn flips_end_in_a_delaunay_triangulation_with_the_same_area() {
    let sliced = slit_spheres(3).source;
    let ours = metric(&sliced);
    let net = Net::new(&sliced.surface, vec![Moebius::default(); 3 * sliced.faces.len()]);
    let Weighted { net: flipped, weights, .. } =
        delaunay(net.clone(), &ours.lengths, &vec![false; sliced.faces.len()]);
    assert!(weights.iter().all(|&weight| weight > 0.0));
    assert_ne!(flipped.faces, net.faces, "something was flipped");
    for corner in Corner::all(flipped.faces.len()) {
        let Some(across) = flipped.opposite[corner] else { continue };
        assert_eq!(flipped.opposite[across], Some(corner));
        let [tail, head] = flipped.ends(corner);
        assert_eq!(flipped.ends(across), [head, tail]);
        assert_eq!(weights[corner], weights[across]);
    }
    let kept = delaunay(net.clone(), &ours.lengths, &vec![true; sliced.faces.len()]);
    assert_eq!(kept.net.faces, net.faces, "nothing that is kept was flipped");
}

#[test]
fn transitions_close_up_after_flips() {
    with_map(3, |_, _, map| {
        for face in 0..map.intrinsic.faces.len() {
            let [a, b, c] = [0, 1, 2].map(|k| map.intrinsic.transitions[3 * face + k]);
            assert!(is_identity(c * a * b));
        }
    });
}

#[test]
fn the_gradient_is_that_of_differences() {
    with_map(3, |_, _, map| {
        let gradient = map.gradient_now();
        let free: Vec<usize> = (0..gradient.len()).filter(|&v| map.places.held[v].is_none()).collect();
        let step = 1e-6;
        for &vertex in free.iter().step_by(7) {
            for direction in [Complex::new(1.0, 0.0), Complex::new(0.0, 1.0)] {
                let energy = |t: f64| {
                    let mut positions = map.places.positions.clone();
                    positions[vertex] = moebius::exponential(positions[vertex], t * direction);
                    map.energy_at(&positions)
                };
                let difference = (energy(step) - energy(-step)) / (2.0 * step);
                let exact = gradient[vertex].re * direction.re + gradient[vertex].im * direction.im;
                assert!((difference - exact).abs() < 1e-5 * (1.0 + exact.abs()), "{difference} {exact}");
            }
        }
    });
}

#[test]
fn newton_finds_an_embedding_and_the_same_one_from_anywhere() {
    with_map(3, |sliced, _, mut map| {
        let descent = newton(&mut map, &mut Silent).unwrap();
        assert_eq!(descent.status, Status::Converged);
        assert!(descent.energies.windows(2).all(|pair| pair[1] <= pair[0] * (1.0 + 1e-12)));
        let certificates = certify(&map, -2);
        assert!(certificates.folded.is_empty() && certificates.outside == 0);
        assert!((certificates.area / certificates.expected_area - 1.0).abs() < 1e-11);
        assert!(certificates.cocycle_error < 1e-11);
        // from a random start, folded all over
        let mut random = Random(7);
        let mut number = || random.next() as f64 / (1u64 << 48) as f64 - 0.5;
        let moves: Vec<Complex> =
            (0..map.places.faces.len()).map(|_| Complex::new(2.0 * number(), 2.0 * number())).collect();
        map.recharted(map.moved(&moves, 1.0));
        assert!(map.energy() > 2.0 * certificates.energy);
        newton(&mut map, &mut Silent).unwrap();
        assert!((map.energy() / certificates.energy - 1.0).abs() < 1e-12);
        assert!(certify(&map, -2).folded.is_empty());
        assert_eq!(sliced.source.surface.faces.len(), map.input.faces.len());
    });
}

#[test]
fn heat_lowers_the_energy_at_every_step() {
    with_map(3, |sliced, ours, mut map| {
        let areas = super::harmonic::piece_map::vertex_areas(&sliced.source, ours);
        let descent = diffuse(&mut map, &areas, 50, 0.0, &mut Silent);
        assert_eq!((descent.status, descent.energies.len()), (Status::MaxIterations, 51));
        assert!(descent.energies.windows(2).all(|pair| pair[1] < pair[0]));
    });
}

#[test]
fn the_inverse_finds_every_vertex_where_the_map_has_put_it() {
    with_map(3, |sliced, _, mut map| {
        newton(&mut map, &mut Silent).unwrap();
        let back = inverse(&map, &sliced.source, &sliced.target);
        assert!(back.iter().all(Option::is_some));
        // a vertex of the source goes there and back by the faces that it came from
        for (vertex, location) in back.iter().enumerate() {
            let location = location.unwrap();
            assert!(location.barycentric.iter().all(|&weight| (0.0..=1.0).contains(&weight)));
            let face = location.triangle.index();
            let images = super::harmonic::certificates::image(&map, &map.input, face);
            let first = map.input.faces[face][0].index();
            // the same point of the hyperboloid from the images of the corners
            let weighted = |k: usize| moebius::to_hyperboloid(images[k]) * location.barycentric[k];
            let point = moebius::from_hyperboloid(weighted(0) + (weighted(1) + weighted(2)));
            let walk = map.atlas.walk(map.places.faces[first], point);
            let corners = sliced.target.surface.faces[walk.face];
            let Some(k) = corners.iter().position(|&corner| corner.index() == vertex) else {
                assert!(
                    is_boundary(&sliced.target, vertex),
                    "vertex {vertex} is not in the face that covers it"
                );
                continue;
            };
            let gap = distance(walk.x, map.atlas.charts[walk.face][k]);
            assert!(gap < 1e-7 || is_boundary(&sliced.target, vertex), "{gap}");
        }
    });
}

fn is_boundary(sliced: &Sliced, vertex: usize) -> bool {
    let crate::hyperbolic::slice::Opened { faces, opposite, .. } = &sliced.surface;
    let corners = Corner::all(faces.len()).filter(|&corner| opposite[corner].is_none());
    corners.map(|corner| corner.next().vertex(faces)).any(|v| v.index() == vertex)
}

#[test]
fn areas_of_geodesic_triangles_are_signed_and_bounded() {
    let [a, b, c] = [Complex::new(0.1, 0.2), Complex::new(0.5, -0.1), Complex::new(0.3, 0.6)];
    // Gauss–Bonnet by the angles
    let angle = |p: Complex, q: Complex, r: Complex| {
        let [to_q, to_r] = [q, r].map(|z| moebius::seen_from(p, z));
        (to_q.conj() * to_r).arg().abs()
    };
    let expected = std::f64::consts::PI - angle(a, b, c) - angle(b, c, a) - angle(c, a, b);
    assert!((signed_area([a, b, c]) - expected).abs() < 1e-14);
    assert!((signed_area([a, c, b]) + expected).abs() < 1e-14);
    let far = [0.0, 2.0, 4.0].map(|angle| Complex::from_polar(1.0 - 1e-9, angle));
    assert!((signed_area(far) - std::f64::consts::PI).abs() < 1e-3);
}
