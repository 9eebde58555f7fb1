// SPDX-License-Identifier: MIT OR Apache-2.0
//! The hyperbolic metric with geodesic boundary in the conformal class of a surface in space.
//!
//! Every surface of negative Euler characteristic has exactly one such metric (uniformization). Here every face
//! becomes a hyperbolic triangle; the angles around a vertex add up to 2π, on the boundary to π. Two methods:
//!
//! - [`MetricMethod::Newton`], the default: discrete conformal changes by vertex scaling (Bobenko, Pinkall,
//!   Springborn 2015), solved by Newton's method; if slivers prevent a solution, circle packings relaxed at
//!   the slivers;
//! - [`MetricMethod::RicciFlow`]: the discrete hyperbolic Ricci flow of the paper (Shi, Zeng, Su et al., CVPR
//!   2013, algorithm 2) on circle packings, completed by Newton's method.
//!
//! Input: points and oriented faces of a connected surface with boundary. Cost: about ten sparse
//! factorizations with one unknown per vertex, twice that with slivers; the flow adds hundreds of passes over
//! the faces.

mod edges;
mod newton;
mod relaxation;
mod ricci_flow;
mod triangle;

use std::f64::consts::TAU;

use crate::control::Watch;
use crate::error::{Elements, Error, NumericsError};
use crate::mesh::Vertex;
use crate::mesh::geometry::face_areas;
use crate::vector::Vector3;
use edges::{Conformal, Packing, factor_of_radius, radius_of_factor};
use newton::{State, Surface, flatten};
use relaxation::{Relaxed, bad_faces, relaxed};

pub use ricci_flow::{FlowOptions, FlowRecord};

/// The method that computes the metric.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum MetricMethod {
    /// Newton's method on vertex scaling: precise and fast.
    #[default]
    Newton,
    /// The paper's Ricci flow on circle packings, then Newton's method from its result.
    RicciFlow(FlowOptions),
}

/// A hyperbolic metric with geodesic boundary.
#[derive(Debug, Clone, PartialEq)]
pub struct Metric {
    /// (m, 3): the length of the edge opposite to each corner.
    pub lengths: Vec<[f64; 3]>,
    /// (m, 3): the angle at each corner, in radians.
    pub angles: Vec<[f64; 3]>,
    /// (n,): weights of the vertices for projective interpolation on faces, the largest 1; with them the points of
    /// an edge agree on both of its faces, as in space. All 1 after circle packing.
    pub mu: Vec<f64>,
    /// The largest difference between the angle sum at a vertex and 2π, π on the boundary.
    pub residual: f64,
    /// The total of Newton iterations.
    pub iterations: usize,
    /// The number of edges that gave up conformality because of slivers.
    pub relaxed_edges: usize,
    /// The result of the Ricci flow by itself, if it was chosen.
    pub flow: Option<FlowRecord>,
}

/// The hyperbolic metric with geodesic boundary of a surface with negative `euler_characteristic`; vertices
/// of edges with one face are on its boundary, and no interior edge may join two of those.
///
/// # Errors
/// [`NumericsError::NoHyperbolicMetric`] if double precision does not suffice,
/// [`NumericsError::FactorizationFailed`] if the mesh is too large, [`Error::CancelledEarly`] if cancelled.
pub(super) fn hyperbolic_metric(
    points: &[Vector3],
    faces: &[[Vertex; 3]],
    euler_characteristic: i64,
    method: MetricMethod,
    watch: &Watch<'_>,
) -> Result<Metric, Error> {
    debug_assert!(euler_characteristic < 0);
    // 1. Lengths on the scale of the hyperbolic area 2π|χ|
    let surface = Surface::new(points.len(), faces)?;
    let area: f64 = face_areas(points, faces).iter().sum();
    let scale = (TAU * euler_characteristic.unsigned_abs() as f64 / area).sqrt();
    let lengths: Vec<f64> = surface.edges.lengths(points).iter().map(|length| scale * length).collect();
    // 2. Factors that yield the angle sums
    match method {
        MetricMethod::Newton => by_newton(&surface, lengths, watch),
        MetricMethod::RicciFlow(options) => by_flow(&surface, &lengths, &options, watch),
    }
}

/// The metric by vertex scaling, or by relaxed circle packing if that has no solution.
fn by_newton(surface: &Surface<'_>, lengths: Vec<f64>, watch: &Watch<'_>) -> Result<Metric, Error> {
    let packing = Packing::new(surface.n_vertices(), &surface.edges, &lengths);
    let mut factors = vec![0.0; surface.n_vertices()];
    let (state, iterations) = flatten(surface, &Conformal::VertexScaling(lengths), &mut factors, watch)?;
    if state.is_solved() {
        return Ok(Metric { iterations, mu: interpolation_weights(&factors), ..metric(surface, &state) });
    }
    let start = if state.residual() < GOOD_START {
        scaled_circles(&packing, &factors)
    } else {
        packing.factors.clone()
    };
    let relaxed = relaxed(surface, &packing, start, bad_faces(surface, &state), watch)?;
    of_relaxed(surface, Relaxed { iterations: iterations + relaxed.iterations, ..relaxed })
}

/// Largest curvature left by vertex scaling at which its factors are a good start for circles.
const GOOD_START: f64 = 1e-2;

/// The factors of the packing's circles with radii scaled by e^u, u the factors of vertex scaling.
fn scaled_circles(packing: &Packing, factors: &[f64]) -> Vec<f64> {
    let scaled = |(&circle, u): (&f64, &f64)| factor_of_radius(radius_of_factor(circle) * u.exp());
    packing.factors.iter().zip(factors).map(scaled).collect()
}

/// The metric by the paper's flow, then by Newton's method from its result.
fn by_flow(
    surface: &Surface<'_>,
    lengths: &[f64],
    options: &FlowOptions,
    watch: &Watch<'_>,
) -> Result<Metric, Error> {
    let packing = Packing::new(surface.n_vertices(), &surface.edges, lengths);
    let (factors, flow) = ricci_flow::flow(surface, &packing, options, watch)?;
    let relaxed = relaxed(surface, &packing, factors, Vec::new(), watch)?;
    Ok(Metric { flow: Some(flow), ..of_relaxed(surface, relaxed)? })
}

/// The metric of a packing, if it has one.
fn of_relaxed(surface: &Surface<'_>, relaxed: Relaxed) -> Result<Metric, Error> {
    let Relaxed { state, iterations, edges } = relaxed;
    match Elements::collect(bad_faces(surface, &state)) {
        Some(faces) if !state.is_solved() => Err(NumericsError::NoHyperbolicMetric { faces }.into()),
        _ => Ok(Metric { iterations, relaxed_edges: edges, ..metric(surface, &state) }),
    }
}

/// The lengths and angles of all faces.
fn metric(surface: &Surface<'_>, state: &State) -> Metric {
    let lengths = (0..surface.faces.len()).map(|face| surface.edges.around(face, &state.lengths)).collect();
    Metric {
        lengths,
        angles: state.angles.clone(),
        mu: vec![1.0; surface.n_vertices()],
        residual: state.residual(),
        iterations: 0,
        relaxed_edges: 0,
        flow: None,
    }
}

/// e^(−u), the largest scaled to 1.
fn interpolation_weights(factors: &[f64]) -> Vec<f64> {
    let least = factors.iter().fold(f64::INFINITY, |least, &u| least.min(u));
    factors.iter().map(|u| (least - u).exp()).collect()
}

#[cfg(test)]
mod tests;
