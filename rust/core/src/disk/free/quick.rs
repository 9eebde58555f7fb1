// SPDX-License-Identifier: MIT OR Apache-2.0
//! A map whose areas are even to a tolerance, in few iterations.
//!
//! The minimum for a heavy λ comes first, which a few iterations reach from any start; then that for a lighter one.
//! Between them the deviation √(E_A/A) is close to a power of λ, which tells the λ at which it meets the tolerance.

use super::descent::{Descent, Goal};
use crate::codomain::planar::PlanarMap;
use crate::control::{History, Observer, Status};

/// The first weights of angles.
const WEIGHTS: [f64; 2] = [0.1, 0.01];

/// The decrements in units of the energy at which the minima for these are left, and that for later ones.
const ROUGHLY: [f64; 2] = [1e-2, 4e-3];
const CLOSELY: f64 = 2e-3;

/// The part of the tolerance that is aimed at, and that is enough.
const AIM: f64 = 0.93;
const ENOUGH: f64 = 0.8;

/// The power of λ that the deviation is taken for where two minima tell none, and its bounds.
const POWERS: [f64; 2] = [0.3, 1.2];

/// The power of λ near the tolerance, where there is one minimum only.
const USUAL_POWER: f64 = 0.6;

/// The power grows by about this factor from one minimum to the next.
const STEEPER: f64 = 1.2;

/// The most weights tried after the first.
const MOST: usize = 4;

/// Lowers the energy from `map` for λ that fall until the deviation is within the tolerance; from `weight` if that is
/// given, which met it before.
pub(super) fn quickly(
    descent: &mut Descent<'_>,
    mut map: PlanarMap,
    goal: &mut Goal,
    (tolerance, weight): (f64, Option<f64>),
    history: &mut History,
    observer: &mut dyn Observer,
) -> (PlanarMap, Status) {
    let mut minima: Vec<[f64; 2]> = Vec::new();
    while minima.len() < WEIGHTS.len() + MOST {
        (goal.weight, goal.precision) = match (&minima[..], weight) {
            ([], Some(weight)) => (weight, CLOSELY),
            ([only], Some(_)) => (only[0] * factor(*only, tolerance, USUAL_POWER), CLOSELY),
            ([], None) => (WEIGHTS[0], ROUGHLY[0]),
            ([_], None) => (WEIGHTS[1], ROUGHLY[1]),
            ([.., before, last], _) => (next_weight(*before, *last, tolerance), CLOSELY),
        };
        let status;
        (map, status) = descent.run(map, goal, history, observer);
        if matches!(status, Status::Cancelled | Status::MaxIterations) {
            return (map, status);
        }
        let deviation = descent.deviation(&map);
        // at one place only, a heavier weight may be worth another descent
        let is_sheared = minima.len() == usize::from(weight.is_none()) && deviation < ENOUGH * tolerance;
        if deviation <= tolerance && !is_sheared {
            return (map, Status::Converged);
        }
        minima.push([goal.weight, deviation]);
    }
    (map, Status::Stalled)
}

/// The weight at which the deviation is somewhat below the tolerance, by a power through the last two minima.
fn next_weight([weight, deviation]: [f64; 2], last: [f64; 2], tolerance: f64) -> f64 {
    let power = STEEPER * (last[1] / deviation).ln() / (last[0] / weight).ln();
    let power = if power.is_finite() { power.clamp(POWERS[0], POWERS[1]) } else { POWERS[1] };
    last[0] * factor(last, tolerance, power)
}

/// The factor of λ for which the deviation falls somewhat below the tolerance.
fn factor([_, deviation]: [f64; 2], tolerance: f64, power: f64) -> f64 {
    (AIM * tolerance / deviation).powf(1.0 / power).clamp(0.05, 20.0)
}
