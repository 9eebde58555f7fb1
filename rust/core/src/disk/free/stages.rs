// SPDX-License-Identifier: MIT OR Apache-2.0
//! The weight of angles lowered by stages.
//!
//! With a light weight the energy has many minima, and which of them a descent finds depends on its start. With a heavy
//! one almost every start leads to the same minimum in a few iterations. From there a light weight leads to a map whose
//! faces are sheared no more than they must be. Each stage is left as soon as it has found its way. Cost: some three to
//! eight iterations a stage, of which the last stage spares as many.

use super::descent::{Descent, Goal};
use crate::codomain::planar::PlanarMap;
use crate::control::{History, Observer, Status};

/// The weights of angles, as far as they are heavier than the wanted one.
const WEIGHTS: [f64; 4] = [10.0, 1.0, 0.1, 0.01];

/// A stage must be at least this many times as heavy as the wanted weight.
const HEAVIER: f64 = 3.0;

/// The decrement in units of the energy at which a stage is left.
const ROUGHLY: f64 = 1e-2;

/// The map after the stages that lead to the weight of `goal`; [`Status::Converged`] where the descent may go on.
pub(super) fn by_stages(
    descent: &mut Descent<'_>,
    mut map: PlanarMap,
    goal: &Goal,
    history: &mut History,
    observer: &mut dyn Observer,
) -> (PlanarMap, Status) {
    for weight in WEIGHTS.into_iter().filter(|weight| *weight >= HEAVIER * goal.weight) {
        let stage = Goal { weight, precision: ROUGHLY, ..*goal };
        let status;
        (map, status) = descent.run(map, &stage, history, observer);
        if matches!(status, Status::Cancelled | Status::MaxIterations) {
            return (map, status);
        }
    }
    (map, Status::Converged)
}
