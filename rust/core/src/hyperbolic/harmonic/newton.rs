// SPDX-License-Identifier: MIT OR Apache-2.0
//! The hyperbolic harmonic map by Riemannian Newton.
//!
//! E = ½ Σ w_e d(f_i, T_ij f_j)² over the edges of the source, every image in the chart of its face of the
//! target. For positive weights E is geodesically convex, and its minimum in the homotopy class of a
//! homeomorphism is an embedding (Colin de Verdière 1991; Shi et al. 2013, theorem 3.4), even if iterates
//! have folds.
//!
//! With q = δ_a(b) for the two ends, d = 2 artanh |q| and unit vectors e = q/|q| and n = i e, the second
//! variation of the arc length gives the blocks e eᵀ + (d coth d) n nᵀ for each end, and
//! −(e_i e_jᵀ + (d / sinh d) n_i n_jᵀ) for the pair.
//!
//! Input: a start in the right homotopy class, and the intrinsic Delaunay weights of the source's own
//! hyperbolic metric. Cost: one sparse Cholesky factorization of 2 n unknowns per step, three to six of them.

use super::chart_map::{ChartMap, hessian};
use crate::control::{Observer, Status, Watch};
use crate::error::{Error, NumericsError};
use crate::hyperbolic::moebius::Complex;
use crate::sparse::{Factor, Failure};

/// Largest component of the gradient at a minimum.
const CONVERGED: f64 = 1e-12;
/// Gradient below which a step without gain has reached the limit of double precision.
const STAGNATED: f64 = 1e-8;
/// Most Newton steps.
const MOST_STEPS: usize = 60;
/// Longest move of a vertex in one step.
const LONGEST_MOVE: f64 = 2.0;
/// Armijo's constant.
const SUFFICIENT: f64 = 1e-4;
/// Relative increase of the energy that rounding may cause.
const ROUNDING: f64 = 1e-13;
/// Most halvings of a step.
const HALVINGS: i32 = 40;

/// The record of a descent.
#[derive(Debug, Clone, PartialEq)]
pub struct Descent {
    /// E before the first and after each step.
    pub energies: Vec<f64>,
    /// The largest component of the gradient at the end.
    pub gradient: f64,
    /// Why the descent ended.
    pub status: Status,
}

/// Minimizes E in place.
///
/// # Errors
/// [`NumericsError::FactorizationFailed`] if the weights make the system singular in double precision;
/// [`Error::CancelledEarly`].
pub(crate) fn newton(map: &mut ChartMap<'_>, observer: &mut dyn Observer) -> Result<Descent, Error> {
    let analysis = map.analysis()?;
    let mut factor = Factor::<f64>::new(&analysis);
    let mut energies = vec![map.energy()];
    let mut gradient = f64::INFINITY;
    for step in 0..MOST_STEPS {
        // 1. Gradient and Hessian
        let fraction = 1.0 - 0.5f64.powi(step as i32);
        if !observer.progress(fraction, "Harmonic map") {
            return Err(Error::CancelledEarly);
        }
        let pulls = map.pulls();
        let slopes = map.gradient(&pulls);
        let last = std::mem::replace(&mut gradient, largest(&slopes));
        if gradient < CONVERGED || gradient < STAGNATED && gradient > 0.5 * last {
            break;
        }
        let watch = Watch::new(observer, fraction, "Harmonic map");
        let element = |edge: usize| hessian(&pulls[edge]);
        factor.refactor(&analysis, &element, &watch).map_err(refused)?;
        // 2. Newton's direction
        let moves = map.direction(&analysis, &factor, &slopes);
        // 3. The longest step along geodesics that lowers E enough
        let slope: f64 = slopes.iter().zip(&moves).map(|(g, v)| g.re * v.re + g.im * v.im).sum();
        let longest = LONGEST_MOVE / moves.iter().fold(LONGEST_MOVE, |most, v| most.max(v.norm()));
        let now = energies[energies.len() - 1];
        let slack = ROUNDING * now.abs();
        let taken = (0..HALVINGS).map(|k| longest * 0.5f64.powi(k)).find_map(|t| {
            let moved = map.moved(&moves, t);
            let energy = map.energy_at(&moved);
            (energy <= now + SUFFICIENT * t * slope + slack).then_some((moved, energy))
        });
        let Some((moved, energy)) = taken else { break };
        // 4. Every vertex into the chart of its new face
        map.recharted(moved);
        energies.push(energy);
    }
    let status = if gradient < STAGNATED { Status::Converged } else { Status::Stalled };
    Ok(Descent { energies, gradient, status })
}

fn refused(failure: Failure) -> Error {
    match failure {
        Failure::Cancelled => Error::CancelledEarly,
        Failure::NotPositiveDefinite => {
            NumericsError::FactorizationFailed { what: "the Hessian of the harmonic energy".into() }.into()
        }
    }
}

fn largest(values: &[Complex]) -> f64 {
    values.iter().fold(0.0, |most: f64, g| most.max(g.re.abs()).max(g.im.abs()))
}
