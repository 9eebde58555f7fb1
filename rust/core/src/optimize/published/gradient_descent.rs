// SPDX-License-Identifier: MIT OR Apache-2.0
//! Gradient descent along a retraction.
//!
//! Sutti & Yueh (2024), Algorithm 1: the direction −M⁻¹ grad E (M the identity for the paper's method), a
//! step by one of two line searches, and the retraction. The first trial of an iteration is 2 (E⁽ᵏ⁾ −
//! E⁽ᵏ⁻¹⁾)/φ'(0) (appendix C.1).
//!
//! Cost of one iteration: one gradient and nearly always one evaluation of the objective (interpolation), or
//! about a dozen (bounded).

use super::line_search::Trial;
use super::{Energies, Objective, Stopping, bounded, interpolation};
use crate::control::{History, Observer, Status};
use crate::parallel;

/// The search for the length of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum LineSearch {
    /// Sufficient decrease by safeguarded quadratic and cubic interpolation.
    #[default]
    Interpolation,
    /// Brent's minimizer on a bounded interval, as MATLAB's `fminbnd`.
    Bounded,
}

/// Options of [`minimize`].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DescentOptions {
    /// The end of the descent.
    pub stopping: Stopping,
    /// The search for the length of a step.
    pub line_search: LineSearch,
}

/// The first step moves no coordinate by more than this; maps are of the size of the unit disk or sphere.
const FIRST_MOVE: f64 = 0.01;

/// The interval of the bounded search is this many times as long as the step that interpolation would try
/// first.
const REACH: f64 = 8.0;

/// Relative precision of the bounded search.
const PRECISION: f64 = 1e-3;

/// Lowers the objective from `start` and returns the last map, which has the lowest objective, with the status.
pub fn minimize<D: Objective>(
    objective: &D,
    start: D::Map,
    options: &DescentOptions,
    history: &mut History,
    observer: &mut dyn Observer,
) -> (D::Map, Status) {
    let mut map = start;
    let (mut energies, mut gradient) = objective.gradient(&map);
    let mut last: Option<(f64, f64)> = None;
    for done in 0.. {
        // 1. The direction d = −M⁻¹g and the slope φ'(0) = gᵀd
        let h = objective.precondition(&map, &gradient);
        let slope = -parallel::dot(&gradient, &h);
        let norm = (-slope).max(0.0).sqrt();
        match last {
            None => history.push_start(energies.authalic_energy, norm),
            Some((step, _)) => history.push(energies.authalic_energy, step, norm),
        }
        if let Some(status) = options.stopping.verdict(done, norm, "Minimizing the stretch energy", observer)
        {
            return (map, status);
        }
        // 2. A step along it
        let direction = parallel::map(h.len(), |i| -h[i]);
        let first = first_trial(&direction, energies, slope, last);
        let Some((step, moved)) = line_step(objective, &map, energies, (&direction, slope), first, options)
        else {
            return (map, Status::Stalled);
        };
        // 3. The map there
        last = Some((step, energies.objective));
        map = moved;
        (energies, gradient) = objective.gradient(&map);
    }
    unreachable!("the stopping rule ends the loop")
}

/// 2 (E⁽ᵏ⁾ − E⁽ᵏ⁻¹⁾)/φ'(0), or a step that moves no coordinate far where there is no such decrease.
fn first_trial(direction: &[f64], energies: Energies, slope: f64, last: Option<(f64, f64)>) -> f64 {
    let guess = last.map_or(0.0, |(_, objective)| 2.0 * (energies.objective - objective) / slope);
    if guess.is_finite() && guess > 0.0 {
        return guess;
    }
    let longest = direction.iter().fold(0.0, |most: f64, d| most.max(d.abs()));
    last.map_or(FIRST_MOVE / longest, |(step, _)| step)
}

/// The step and the map there, by the line search asked for; `None` where nothing decreases enough.
fn line_step<D: Objective>(
    objective: &D,
    map: &D::Map,
    energies: Energies,
    (direction, slope): (&[f64], f64),
    first: f64,
    options: &DescentOptions,
) -> Option<(f64, D::Map)> {
    if slope >= 0.0 || !slope.is_finite() || !first.is_finite() {
        return None;
    }
    let start = Trial { step: 0.0, value: energies.objective, slope, data: () };
    let evaluate = |step: f64| {
        let moved = objective.retract(map, direction, step);
        Trial { step, value: objective.value(&moved), slope: 0.0, data: moved }
    };
    let first = match options.line_search {
        LineSearch::Interpolation => first,
        LineSearch::Bounded => {
            let end = REACH * first;
            bounded::minimize(end, PRECISION * end, |step| evaluate(step).value)
        }
    };
    interpolation::backtrack(&start, first, evaluate).map(|trial| (trial.step, trial.data))
}
