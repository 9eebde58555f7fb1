// SPDX-License-Identifier: MIT OR Apache-2.0
//! The discrete hyperbolic Ricci flow: R. Shi, W. Zeng, Z. Su et al., Hyperbolic harmonic mapping for
//! constrained brain surface registration (CVPR 2013), algorithm 2.
//!
//! In each step:
//!
//! 1. edge lengths follow from the radii by the hyperbolic cosine law, angles from the lengths, curvatures K
//!    from the angles;
//! 2. every circle shrinks or grows: r ← r − ε K sinh r.
//!
//! This is the descent u ← u − ε K of u = ln tanh(r/2) along the gradient K of a convex function. The paper
//! fixes ε; a fixed ε either wastes steps or diverges, depending on the worst vertex of the mesh. So here it
//! grows slowly from step to step, and is halved when a step goes past the minimum along its direction.
//!
//! The edge weights of the paper are the angles φ at which circles meet. Here they are inversive distances, see
//! [`edges`](super::edges): with angles the metric would not depend on the surface's shape.
//!
//! The flow converges linearly and ends far from the precision that charts of the hyperbolic plane need to close
//! up around vertices. So Newton's method starts from its result; [`FlowRecord`] holds the result of the flow by
//! itself. Cost of a step: a pass over the faces.

use super::edges::{Conformal, Packing, factor_of_radius, radius_of_factor};
use super::newton::{State, Surface};
use crate::control::Watch;
use crate::error::Error;
use crate::parallel;

/// Options of the Ricci flow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlowOptions {
    /// ε > 0 of the first step.
    pub step: f64,
    /// Most steps.
    pub most_steps: usize,
    /// Largest curvature at which the flow ends.
    pub tolerance: f64,
}

impl Default for FlowOptions {
    fn default() -> Self {
        Self { step: 0.05, most_steps: 3000, tolerance: 1e-2 }
    }
}

/// The result of the Ricci flow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlowRecord {
    /// The largest curvature left.
    pub residual: f64,
    /// Steps done.
    pub steps: usize,
}

/// Factor by which ε grows after every step that was not too long.
const GROWTH: f64 = 1.05;

/// Most halvings of ε in a step; more would be needed only because of rounding.
const MOST_TRIALS: usize = 50;

/// Flows from the circles of a packing; returns the factors of the final circles.
///
/// # Errors
/// [`Error::CancelledEarly`] if cancelled.
pub(super) fn flow(
    surface: &Surface<'_>,
    packing: &Packing,
    options: &FlowOptions,
    watch: &Watch<'_>,
) -> Result<(Vec<f64>, FlowRecord), Error> {
    let conformal = Conformal::InversiveDistance(packing.distances.clone());
    let mut radii: Vec<f64> = packing.factors.iter().map(|&u| radius_of_factor(u)).collect();
    let mut step = options.step;
    let mut state = State::new(surface, &conformal, &packing.factors);
    let mut steps = 0;
    while steps < options.most_steps && state.residual() > options.tolerance {
        if !watch.goes_on() {
            return Err(Error::CancelledEarly);
        }
        let Some(next) = shorten(surface, &conformal, &radii, &state, &mut step) else { break };
        (radii, state) = next;
        step *= GROWTH;
        steps += 1;
    }
    let record = FlowRecord { residual: state.residual(), steps };
    Ok((factors(&radii), record))
}

/// Radii and metric after a step, with ε halved until it does not go past the minimum; `None` if it always does.
fn shorten(
    surface: &Surface<'_>,
    conformal: &Conformal,
    radii: &[f64],
    state: &State,
    step: &mut f64,
) -> Option<(Vec<f64>, State)> {
    for _ in 0..MOST_TRIALS {
        let moved = parallel::map(radii.len(), |v| radii[v] - *step * state.curvatures[v] * radii[v].sinh());
        if moved.iter().all(|&radius| radius > 0.0) {
            let next = State::new(surface, conformal, &factors(&moved));
            if parallel::dot(&state.curvatures, &next.curvatures) >= 0.0 {
                return Some((moved, next));
            }
        }
        *step *= 0.5;
    }
    None
}

fn factors(radii: &[f64]) -> Vec<f64> {
    parallel::map(radii.len(), |v| factor_of_radius(radii[v]))
}
