// SPDX-License-Identifier: MIT OR Apache-2.0
//! Metrics of spheres with holes, smooth and noisy ones.

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::{PI, TAU};

use super::newton::{hessian, length_derivatives};
use super::*;
use crate::control::Silent;
use crate::mesh::{Vertex, faces_of_indices};
use crate::sparse::solve_positive_definite;

struct Mesh {
    points: Vec<Vector3>,
    faces: Vec<[Vertex; 3]>,
}

/// An icosahedron, each face split into four `times` times, on the unit sphere.
fn icosphere(times: usize) -> Mesh {
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    let signs = [[-1.0, golden], [1.0, golden], [-1.0, -golden], [1.0, -golden]];
    let corner = |axis: usize, [p, q]: [f64; 2]| Vector3::from_fn(|k| [p, q, 0.0][(k + axis) % 3]);
    let points: Vec<Vector3> =
        (0..3).flat_map(|axis| signs.map(|sign| corner(axis, sign).normalized())).collect();
    let edge = (0..12).map(|v| points[0].distance(points[v])).filter(|&d| d > 0.0).fold(4.0, f64::min);
    let mut faces = Vec::new();
    for i in 0..12_u32 {
        for (j, k) in (i + 1..12).flat_map(|j| (j + 1..12).map(move |k| (j, k))) {
            let [a, b, c] = [i, j, k].map(|v| points[v as usize]);
            if [(a, b), (b, c), (c, a)].iter().all(|&(p, q)| p.distance(q) < 1.1 * edge) {
                faces.push(if a.dot(b.cross(c)) > 0.0 { [i, j, k] } else { [i, k, j] });
            }
        }
    }
    (0..times).fold(Mesh { points, faces: faces_of_indices(&faces) }, |mesh, _| split(mesh))
}

fn split(Mesh { mut points, faces }: Mesh) -> Mesh {
    let mut midpoints = BTreeMap::new();
    let mut midpoint = |a: Vertex, b: Vertex| {
        *midpoints.entry([a.min(b), a.max(b)]).or_insert_with(|| {
            points.push((points[a] + points[b]).normalized());
            Vertex::new(points.len() - 1)
        })
    };
    let mut parts = Vec::new();
    for [a, b, c] in faces {
        let [p, q, r] = [midpoint(b, c), midpoint(c, a), midpoint(a, b)];
        parts.extend([[a, r, q], [r, b, p], [q, p, c], [p, q, r]]);
    }
    Mesh { points, faces: parts }
}

/// The icosphere without the faces around its first `holes` vertices.
fn sphere_with_holes(times: usize, holes: u32) -> Mesh {
    without(icosphere(times), holes)
}

fn without(Mesh { points, faces }: Mesh, holes: u32) -> Mesh {
    let faces: Vec<[Vertex; 3]> =
        faces.into_iter().filter(|face| face.iter().all(|&v| v.0 >= holes)).collect();
    // the centers of the holes come first
    let points = points[holes as usize..].to_vec();
    Mesh { points, faces: faces.iter().map(|face| face.map(|v| Vertex(v.0 - holes))).collect() }
}

/// Points moved at random by up to `amount`.
fn noisy(mut mesh: Mesh, amount: f64) -> Mesh {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    for x in mesh.points.iter_mut().flat_map(|point| &mut point.0) {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        *x += amount * (2.0 * (state >> 11) as f64 / (1_u64 << 53) as f64 - 1.0);
    }
    mesh
}

fn solve(mesh: &Mesh, holes: i64, method: MetricMethod) -> Metric {
    let mut silent = Silent;
    let watch = Watch::new(&mut silent, 0.0, "");
    hyperbolic_metric(&mesh.points, &mesh.faces, 2 - holes, method, &watch).unwrap()
}

/// Angle sums, area and agreement of lengths across edges.
fn check(mesh: &Mesh, holes: i64, metric: &Metric) {
    let mut sums = vec![0.0; mesh.points.len()];
    let mut lengths: BTreeMap<[Vertex; 2], Vec<f64>> = BTreeMap::new();
    let mut area = 0.0;
    for (face, (angles, sides)) in mesh.faces.iter().zip(metric.angles.iter().zip(&metric.lengths)) {
        area += PI - angles.iter().sum::<f64>();
        for k in 0..3 {
            sums[face[k]] += angles[k];
            let [a, b] = [face[(k + 1) % 3], face[(k + 2) % 3]];
            lengths.entry([a.min(b), a.max(b)]).or_default().push(sides[k]);
        }
        let cosine = sides[1].cosh() * sides[2].cosh() - sides[1].sinh() * sides[2].sinh() * angles[0].cos();
        assert!((cosine / sides[0].cosh() - 1.0).abs() < 1e-12);
        assert!(angles.iter().all(|&angle| angle > 0.0));
    }
    let on_boundary: BTreeSet<Vertex> =
        lengths.iter().filter(|(_, sides)| sides.len() == 1).flat_map(|(ends, _)| *ends).collect();
    for (v, sum) in sums.iter().enumerate() {
        let wanted = if on_boundary.contains(&Vertex::new(v)) { PI } else { TAU };
        assert!((sum - wanted).abs() < 1e-10, "vertex {v}: {}", sum - wanted);
    }
    assert!(lengths.values().all(|sides| sides.iter().all(|side| side.to_bits() == sides[0].to_bits())));
    let wanted = TAU * (holes - 2) as f64;
    assert!((area / wanted - 1.0).abs() < 1e-11, "{}", area / wanted - 1.0);
    assert!(metric.residual < 1e-10);
    assert_eq!(metric.mu.iter().fold(0.0, |most: f64, &mu| most.max(mu)), 1.0);
}

#[test]
fn spheres_with_holes_become_hyperbolic() {
    for holes in [3, 4, 6, 12] {
        let mesh = sphere_with_holes(3, holes);
        let metric = solve(&mesh, i64::from(holes), MetricMethod::Newton);
        check(&mesh, i64::from(holes), &metric);
        assert_eq!(metric.relaxed_edges, 0);
        assert!(metric.iterations < 15);
        assert_eq!(metric, solve(&mesh, i64::from(holes), MetricMethod::Newton));
    }
}

#[test]
fn slivers_are_relaxed() {
    for amount in [0.03, 0.05, 0.08] {
        let mesh = noisy(sphere_with_holes(4, 6), amount);
        let metric = solve(&mesh, 6, MetricMethod::Newton);
        check(&mesh, 6, &metric);
        assert!((1..200).contains(&metric.relaxed_edges), "{}", metric.relaxed_edges);
        assert!(metric.mu.iter().all(|&mu| mu == 1.0));
    }
}

#[test]
fn the_flow_lowers_curvatures_step_by_step() {
    let mesh = sphere_with_holes(3, 4);
    let residuals = [0, 10, 100, 1000].map(|most_steps| {
        let options = FlowOptions { most_steps, tolerance: 1e-9, ..FlowOptions::default() };
        let metric = solve(&mesh, 4, MetricMethod::RicciFlow(options));
        check(&mesh, 4, &metric);
        let record = metric.flow.unwrap();
        assert_eq!(record.steps, most_steps);
        record.residual
    });
    assert!(residuals.windows(2).all(|pair| pair[1] < 0.5 * pair[0]), "{residuals:?}");
}

#[test]
fn the_flow_ends_near_the_metric_of_newtons_method() {
    let mesh = noisy(sphere_with_holes(3, 4), 0.02);
    let surface = Surface::new(mesh.points.len(), &mesh.faces).unwrap();
    let lengths = surface.edges.lengths(&mesh.points);
    let packing = Packing::new(mesh.points.len(), &surface.edges, &lengths);
    let conformal = Conformal::InversiveDistance(packing.distances.clone());
    let (mut silent, options) = (Silent, FlowOptions { tolerance: 1e-6, ..FlowOptions::default() });
    let watch = Watch::new(&mut silent, 0.0, "");
    let (mut flown, record) = ricci_flow::flow(&surface, &packing, &options, &watch).unwrap();
    assert!(record.residual < 1e-6);
    let by_flow = State::new(&surface, &conformal, &flown);
    let (by_newton, _) = flatten(&surface, &conformal, &mut flown, &watch).unwrap();
    assert!(by_newton.is_solved());
    for (flow, newton) in by_flow.lengths.iter().zip(&by_newton.lengths) {
        assert!((flow / newton - 1.0).abs() < 1e-4);
    }
}

/// The Hessian of all faces as a dense matrix.
fn dense_hessian(surface: &Surface<'_>, conformal: &Conformal, factors: &[f64]) -> Vec<Vec<f64>> {
    let state = State::new(surface, conformal, factors);
    let by_factors = length_derivatives(surface, conformal, factors);
    let mut dense = vec![vec![0.0; factors.len()]; factors.len()];
    for (face, vertices) in surface.faces.iter().enumerate() {
        let element = hessian(surface, &by_factors, &state, face);
        for row in 0..3 {
            (0..3).for_each(|k| dense[vertices[row]][vertices[k]] += element[row][k]);
        }
    }
    dense
}

#[test]
fn the_hessian_is_symmetric_positive_and_that_of_differences() {
    let mesh = noisy(sphere_with_holes(2, 3), 0.03);
    let n = mesh.points.len();
    let surface = Surface::new(n, &mesh.faces).unwrap();
    let lengths = surface.edges.lengths(&mesh.points);
    let packing = Packing::new(n, &surface.edges, &lengths);
    let cases = [
        (Conformal::VertexScaling(lengths), vec![0.3; n]),
        (Conformal::InversiveDistance(packing.distances), packing.factors),
    ];
    for (conformal, factors) in &cases {
        let dense = dense_hessian(&surface, conformal, factors);
        for column in 0..n {
            let moved = |by: f64| {
                let mut moved = factors.clone();
                moved[column] += by;
                State::new(&surface, conformal, &moved).curvatures
            };
            let (more, less) = (moved(1e-5), moved(-1e-5));
            for row in 0..n {
                assert!((dense[row][column] - dense[column][row]).abs() < 1e-12);
                assert!((dense[row][column] - (more[row] - less[row]) / 2e-5).abs() < 1e-7);
            }
        }
        assert!(solve_positive_definite(&mut dense.concat(), &mut vec![1.0; n]));
    }
}

#[test]
fn a_run_can_be_cancelled() {
    let mesh = sphere_with_holes(4, 3);
    for method in [MetricMethod::Newton, MetricMethod::RicciFlow(FlowOptions::default())] {
        let mut refuses = |_: f64, _: &str| false;
        let watch = Watch::new(&mut refuses, 0.0, "");
        std::thread::sleep(std::time::Duration::from_millis(100));
        let verdict = hyperbolic_metric(&mesh.points, &mesh.faces, -1, method, &watch);
        assert_eq!(verdict, Err(Error::CancelledEarly));
    }
}
