// SPDX-License-Identifier: MIT OR Apache-2.0
//! A trial of the line search: a map with its energy, and the next step length.

use super::problem::{Problem, State};
use crate::codomain::SpatialMap;
use crate::energy::authalic::Weights;

pub(super) struct Trial {
    pub state: State,
    pub value: f64,
}

impl Trial {
    pub(super) fn new(problem: &Problem, map: SpatialMap, weights: &Weights) -> Self {
        let state = State::new(problem, map);
        Self { value: problem.value(&state, weights), state }
    }
}

/// Factor that shortens a step whose slope promised `promised` and which changed the energy by `change`: to the minimum
/// of the parabola through them, within limits.
pub(super) fn shrinkage(change: f64, promised: f64) -> f64 {
    if change.is_finite() { (-0.5 * promised / (change - promised)).clamp(0.1, 0.6) } else { 0.5 }
}
