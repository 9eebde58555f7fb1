// SPDX-License-Identifier: MIT OR Apache-2.0
//! A hyperbolic metric in spite of slivers, which prevent an exactly conformal one.
//!
//! Discrete conformal changes with a fixed triangulation need not have a solution: a face with an angle close
//! to π may end up violating the triangle inequality. Packings of tangential circles always have a solution (W.
//! Thurston), and never violate it. So the inversive distances of edges at such faces are moved toward 1, the
//! tangential value, until there is a solution: a third of the way at a time, at the faces themselves first,
//! then around them, in the end everywhere. Conformality is given up only at these edges.
//!
//! Cost: a Newton solve from the last factors for each round, usually one or two.

use super::edges::{Conformal, Packing};
use super::newton::{State, Surface, flatten};
use super::triangle::smallest;
use crate::control::Watch;
use crate::error::Error;

/// Part of the way to the tangential packing by which edges move in one round.
const SHARE: f64 = 0.34;

/// Angle, in radians, below which faces are relaxed along with degenerate ones.
const THIN: f64 = 2e-3;

/// Round from which on the edges of one ring around the faces are relaxed too.
const NEIGHBORS_FROM: usize = 3;

/// Round from which on the rings grow by one each round.
const RINGS_FROM: usize = 10;

/// Round from which on the rings double each round, until no edge is left to relax.
const DOUBLED_FROM: usize = 20;

/// A metric by inversive distances, some of them relaxed.
pub(super) struct Relaxed {
    pub state: State,
    /// The total of Newton iterations.
    pub iterations: usize,
    /// The number of relaxed edges.
    pub edges: usize,
}

/// Solves from `factors`; relaxes the edges of `bad` faces first, then round by round those of faces that become
/// degenerate. Returns the metric of the last round if none is a solution.
///
/// # Errors
/// [`Error::CancelledEarly`] if cancelled.
pub(super) fn relaxed(
    surface: &Surface<'_>,
    packing: &Packing,
    mut factors: Vec<f64>,
    bad: Vec<usize>,
    watch: &Watch<'_>,
) -> Result<Relaxed, Error> {
    let mut levels = vec![0.0; surface.edges.len()];
    let mut bad = bad;
    let mut iterations = 0;
    let mut round = 0;
    loop {
        raise(surface, &bad, rings(round), &mut levels);
        let distances =
            packing.distances.iter().zip(&levels).map(|(i, level)| 1.0 + (1.0 - level) * (i - 1.0)).collect();
        let (state, done) = flatten(surface, &Conformal::InversiveDistance(distances), &mut factors, watch)?;
        iterations += done;
        let edges = levels.iter().filter(|&&level| level > 0.0).count();
        let is_tangential = levels.iter().all(|&level| level == 1.0);
        if state.is_solved() || is_tangential {
            return Ok(Relaxed { state, iterations, edges });
        }
        bad = bad_faces(surface, &state);
        round += 1;
    }
}

/// The faces that are degenerate or almost so; if there are none, those at the largest curvatures.
pub(super) fn bad_faces(surface: &Surface<'_>, state: &State) -> Vec<usize> {
    let all = 0..state.angles.len();
    let thin: Vec<usize> = all.clone().filter(|&face| smallest(&state.angles[face]) < THIN).collect();
    if !thin.is_empty() {
        return thin;
    }
    let large = 0.5 * state.residual();
    let is_curved = |&face: &usize| surface.faces[face].iter().any(|&v| state.curvatures[v].abs() >= large);
    all.filter(is_curved).collect()
}

/// The rings around bad faces that are relaxed in a round.
fn rings(round: usize) -> usize {
    match round {
        0..NEIGHBORS_FROM => 0,
        NEIGHBORS_FROM..RINGS_FROM => 1,
        RINGS_FROM..DOUBLED_FROM => 2 + round - RINGS_FROM,
        _ => (DOUBLED_FROM - RINGS_FROM) << (round - DOUBLED_FROM).min(32),
    }
}

/// Raises the levels of the edges of all faces within `rings` rings around the bad ones.
fn raise(surface: &Surface<'_>, bad: &[usize], rings: usize, levels: &mut [f64]) {
    let mut is_chosen = vec![false; surface.faces.len()];
    bad.iter().for_each(|&face| is_chosen[face] = true);
    for _ in 0..rings {
        if is_chosen.iter().all(|&is| is) {
            break;
        }
        let mut is_touched = vec![false; surface.n_vertices()];
        let chosen = surface.faces.iter().zip(&is_chosen).filter(|&(_, &is)| is);
        chosen.for_each(|(face, _)| face.iter().for_each(|&v| is_touched[v] = true));
        is_chosen = surface.faces.iter().map(|face| face.iter().any(|&v| is_touched[v])).collect();
    }
    let mut is_raised = vec![false; levels.len()];
    for (edges, _) in surface.edges.of_face.iter().zip(&is_chosen).filter(|&(_, &is)| is) {
        edges.iter().for_each(|&edge| is_raised[edge] = true);
    }
    for (level, _) in levels.iter_mut().zip(&is_raised).filter(|&(_, &is)| is) {
        *level = (*level + SHARE).min(1.0);
    }
}
