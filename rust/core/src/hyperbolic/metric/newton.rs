// SPDX-License-Identifier: MIT OR Apache-2.0
//! Newton's method for the factors that give every vertex its angle sum.
//!
//! The curvatures K (the required angle sum less that of the corners) are the gradient of a convex function of
//! the factors, for vertex scaling (Bobenko, Pinkall, Springborn 2015) and for inversive distances (F. Luo
//! 2011) alike. So the slope K · d along a Newton direction d suffices for a line search; the function is never
//! evaluated.
//!
//! In each iteration:
//!
//! 1. lengths of the edges, angles of the faces, curvatures of the vertices;
//! 2. the factorization of the Hessian, a matrix like a Laplacian; with a small shift if faces are degenerate;
//! 3. the Newton step, held inside the range of the factors and halved until its end is not beyond the minimum,
//!    or the slope there has at most half its size.
//!
//! Cost of one iteration: one sparse factorization with one unknown per vertex, two or three passes over the
//! faces.

use std::f64::consts::{PI, TAU};

use super::edges::{Conformal, Edges};
use super::triangle::{angle_derivatives, angles, is_degenerate};
use crate::control::Watch;
use crate::error::Error;
use crate::mesh::Vertex;
use crate::parallel;
use crate::sparse::{Analysis, Factor, Failure, Order};

/// Largest curvature of a solution.
const TOLERANCE: f64 = 1e-12;

/// Largest curvature that counts as solved if rounding allows no better.
const ALMOST: f64 = 1e-8;

/// Largest curvature at which degenerate faces are taken to remain degenerate.
const SETTLED: f64 = 1e-3;

/// Most iterations.
const MOST_ITERATIONS: usize = 60;

/// Iterations that together have to halve the curvature; if they do not, rounding allows no better.
const PATIENCE: usize = 3;

/// Most steps tried along one direction.
const MOST_TRIALS: usize = 40;

/// Shifts of the Hessian, tried in turn until it is positive definite.
const SHIFTS: [f64; 5] = [0.0, 1e-8, 1e-6, 1e-4, 1e-2];

/// A surface that is to get a hyperbolic metric.
pub(super) struct Surface<'a> {
    pub faces: &'a [[Vertex; 3]],
    pub edges: Edges,
    /// The required angle sum at each vertex: 2π, and π on the boundary.
    pub angle_sums: Vec<f64>,
    analysis: Analysis,
}

impl<'a> Surface<'a> {
    /// Numbers the edges and analyzes the Hessian's pattern.
    pub(super) fn new(n_vertices: usize, faces: &'a [[Vertex; 3]]) -> Result<Self, Error> {
        let edges = Edges::new(n_vertices, faces);
        let angle_sums = edges.on_boundary.iter().map(|&is| if is { PI } else { TAU }).collect();
        let analysis = Analysis::new(n_vertices, faces, &vec![1; n_vertices], Order::Sparse)?;
        Ok(Self { faces, edges, angle_sums, analysis })
    }

    /// The number of vertices.
    pub(super) fn n_vertices(&self) -> usize {
        self.angle_sums.len()
    }
}

/// The metric of given factors.
pub(super) struct State {
    /// The lengths of the edges.
    pub lengths: Vec<f64>,
    /// The angles of the faces at their corners.
    pub angles: Vec<[f64; 3]>,
    /// The curvatures K of the vertices.
    pub curvatures: Vec<f64>,
}

impl State {
    /// The metric of a surface with these factors.
    pub(super) fn new(surface: &Surface<'_>, conformal: &Conformal, factors: &[f64]) -> Self {
        let edges = &surface.edges;
        let lengths = parallel::map(edges.len(), |edge| conformal.length(edge, edges.at_ends(edge, factors)));
        let angles = parallel::map(surface.faces.len(), |face| angles(edges.around(face, &lengths)));
        let mut curvatures = surface.angle_sums.clone();
        for (face, angles) in surface.faces.iter().zip(&angles) {
            (0..3).for_each(|k| curvatures[face[k]] -= angles[k]);
        }
        Self { lengths, angles, curvatures }
    }

    /// max |K|.
    pub(super) fn residual(&self) -> f64 {
        // f64::max would lose a NaN
        self.curvatures.iter().fold(0.0, |most: f64, k| if k.abs() <= most { most } else { k.abs() })
    }

    /// The faces without area.
    pub(super) fn degenerate(&self) -> impl Iterator<Item = usize> {
        (0..self.angles.len()).filter(|&face| is_degenerate(&self.angles[face]))
    }

    /// Whether this is a hyperbolic metric: every vertex has its angle sum, every face an area.
    pub(super) fn is_solved(&self) -> bool {
        self.residual() < ALMOST && self.degenerate().next().is_none()
    }
}

/// Updates `factors` until the curvatures vanish, or rounding allows no better, or only degenerate faces prevent a
/// solution. Returns the last metric and the number of iterations.
///
/// # Errors
/// [`Error::CancelledEarly`] if cancelled.
pub(super) fn flatten(
    surface: &Surface<'_>,
    conformal: &Conformal,
    factors: &mut Vec<f64>,
    watch: &Watch<'_>,
) -> Result<(State, usize), Error> {
    let mut factor = Factor::new(&surface.analysis);
    // 1. Curvatures
    let mut state = State::new(surface, conformal, factors);
    let mut earlier = [f64::INFINITY; PATIENCE];
    for done in 0..MOST_ITERATIONS {
        if !watch.goes_on() {
            return Err(Error::CancelledEarly);
        }
        let residual = state.residual();
        let is_stuck = residual < ALMOST && residual > 0.5 * earlier[done % PATIENCE];
        let has_degenerate = state.degenerate().next().is_some();
        if residual < TOLERANCE || is_stuck || (has_degenerate && residual < SETTLED) {
            return Ok((state, done));
        }
        earlier[done % PATIENCE] = residual;
        // 2. The Newton direction
        let Some(direction) = direction(surface, conformal, factors, &state, &mut factor, watch)? else {
            return Ok((state, done));
        };
        // 3. A step along it
        let Some(next) = step(surface, conformal, factors, &direction, &state) else {
            return Ok((state, done));
        };
        (*factors, state) = next;
    }
    Ok((state, MOST_ITERATIONS))
}

/// The solution d of H d = −K; `None` if the Hessian is not positive definite with any shift.
fn direction(
    surface: &Surface<'_>,
    conformal: &Conformal,
    factors: &[f64],
    state: &State,
    factor: &mut Factor<f64>,
    watch: &Watch<'_>,
) -> Result<Option<Vec<f64>>, Error> {
    let has_degenerate = state.degenerate().next().is_some();
    let by_factors = length_derivatives(surface, conformal, factors);
    for &shift in &SHIFTS[usize::from(has_degenerate)..] {
        let element = |face: usize| padded(hessian(surface, &by_factors, state, face), shift);
        match factor.refactor(&surface.analysis, &element, watch) {
            Err(Failure::Cancelled) => return Err(Error::CancelledEarly),
            Err(Failure::NotPositiveDefinite) => continue,
            Ok(()) => {}
        }
        let mut direction: Vec<f64> = state.curvatures.iter().map(|k| -k).collect();
        factor.solve(&surface.analysis, &mut direction);
        if parallel::dot(&direction, &state.curvatures) < 0.0 {
            return Ok(Some(direction));
        }
    }
    Ok(None)
}

/// The derivative of the length of every edge by the factors of its ends.
pub(super) fn length_derivatives(
    surface: &Surface<'_>,
    conformal: &Conformal,
    factors: &[f64],
) -> Vec<[f64; 2]> {
    let edges = &surface.edges;
    parallel::map(edges.len(), |edge| conformal.length_derivatives(edge, edges.at_ends(edge, factors)))
}

/// The Hessian of a face: the derivatives of minus its angles by the factors of its vertices.
pub(super) fn hessian(
    surface: &Surface<'_>,
    by_factors: &[[f64; 2]],
    state: &State,
    face: usize,
) -> [[f64; 3]; 3] {
    let edges = &surface.edges;
    let by_sides = angle_derivatives(edges.around(face, &state.lengths), &state.angles[face]);
    let mut hessian = [[0.0; 3]; 3];
    for (side, &edge) in edges.of_face[face].iter().enumerate() {
        for corner in [(side + 1) % 3, (side + 2) % 3] {
            let end = usize::from(surface.faces[face][corner] != edges.ends[edge][0]);
            (0..3).for_each(|row| hessian[row][corner] -= by_sides[row][side] * by_factors[edge][end]);
        }
    }
    hessian
}

/// The matrix with a shifted diagonal in the form of [`Factor::refactor`]: each unknown in the first of two rows.
fn padded(matrix: [[f64; 3]; 3], shift: f64) -> [[f64; 6]; 6] {
    let mut padded = [[0.0; 6]; 6];
    for row in 0..3 {
        (0..3).for_each(|column| padded[2 * row][2 * column] = matrix[row][column]);
        padded[2 * row][2 * row] += shift;
    }
    padded
}

/// Factors and metric after the longest of the halved steps that is not past the minimum along the direction, or past
/// it with at most half the slope; `None` if rounding leaves no such step.
fn step(
    surface: &Surface<'_>,
    conformal: &Conformal,
    factors: &[f64],
    direction: &[f64],
    state: &State,
) -> Option<(Vec<f64>, State)> {
    let slope = parallel::dot(direction, &state.curvatures);
    let mut length = conformal.longest_step(factors, direction);
    for _ in 0..MOST_TRIALS {
        let moved = parallel::map(factors.len(), |v| factors[v] + length * direction[v]);
        let next = State::new(surface, conformal, &moved);
        if parallel::dot(direction, &next.curvatures) <= -0.5 * slope {
            return Some((moved, next));
        }
        length *= 0.5;
    }
    None
}
