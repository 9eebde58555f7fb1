// SPDX-License-Identifier: MIT OR Apache-2.0
//! The map of least shear whose areas are within a tolerance.
//!
//! The minimum of E_A + λ E_angle has the less shear the larger λ is, and the more even areas the smaller. So λ falls step
//! by step until the minimum is within the tolerance, or rises as long as it is, and is then raised as far as that allows,
//! by the secant rule for the logarithms of λ and of the deviation √(E_A/A), which is close to a power of λ. But where λ
//! rises, each minimum is sought from that of a larger λ: shear that a map once has stays in it.

use super::angle_schedule::AnglePath;
use super::target_floors::{Surface, descend};
use super::{GaussNewtonOptions, Problem, minimize};
use crate::codomain::SpatialMap;
use crate::control::{History, Observer, Phase, Status};

/// λ at first, what it is multiplied by until areas are within the tolerance, and divided by while they are.
const FIRST: f64 = 1.0;
const FALL: f64 = 0.1;

/// λ above this changes nothing any more: the map is as good as conformal.
const MOST: f64 = 1e4;

/// λ below this changes nothing any more; then areas alone count.
const LEAST: f64 = 1e-6;

/// The deviation aimed at, and the least that is good enough, in units of the tolerance.
const AIM: f64 = 0.98;
const GOOD: f64 = 0.95;

/// Secant steps at the most.
const STEPS: usize = 6;

/// A stationary map for one λ.
struct Found {
    /// ln λ.
    weight: f64,
    /// ln √(E_A/A).
    deviation: f64,
    map: SpatialMap,
    status: Status,
}

impl Found {
    /// True if the run has ended before the minimum was reached.
    fn is_final(&self) -> bool {
        matches!(self.status, Status::Cancelled | Status::MaxIterations)
    }
}

/// The map of least shear with √(E_A/A) of `tolerance` or less that is reached from `start`; `problem` has the energy of
/// the first floor, and comes back with that of the last. [`Status::Stalled`] where areas cannot be made that even.
pub(crate) fn within_tolerance(
    surface: &Surface<'_>,
    problem: Problem,
    start: SpatialMap,
    tolerance: f64,
    options: &GaussNewtonOptions,
    history: &mut History,
    observer: &mut dyn Observer,
) -> (Problem, SpatialMap, Status) {
    // 1. λ falls until areas are within the tolerance
    let begun = history.iterations();
    let mut phase = Phase { whole: observer, from: 0.0, to: 0.3 };
    let first = GaussNewtonOptions { angle_weight: FIRST, ..*options };
    let (problem, map, status) = descend(surface, problem, start, &first, history, &mut phase);
    let search = Search { problem: &problem, options: *options, goal: tolerance.ln(), begun };
    let mut found = search.found(FIRST, map, status);
    let (mut coarser, mut round) = (None, 0);
    while found.deviation > search.goal && !found.is_final() {
        let weight = FALL * found.weight.exp();
        if weight < LEAST {
            let even = search.even(found.map, history, &mut part(round, observer));
            return (problem, even.0, even.1);
        }
        let next = search.minimum(weight, found.map.clone(), history, &mut part(round, observer));
        round += 1;
        coarser = Some(std::mem::replace(&mut found, next));
    }
    // 2. Or rises as long as they are
    while coarser.is_none() && found.deviation <= search.goal && !found.is_final() {
        let weight = found.weight.exp() / FALL;
        if weight > MOST {
            break;
        }
        let next = search.minimum(weight, found.map.clone(), history, &mut part(round, observer));
        round += 1;
        match (next.is_final(), next.deviation <= search.goal) {
            (true, _) => return (problem, found.map, next.status),
            (false, true) => found = next,
            (false, false) => coarser = Some(next),
        }
    }
    // 3. And is raised as far as they stay within it
    if let Some(coarser) = coarser {
        found = search.raised(coarser, found, round, history, observer);
    }
    (problem, found.map, found.status)
}

/// The part of the whole that a round takes after the first descent; nobody knows how many will follow.
fn part(round: usize, whole: &mut dyn Observer) -> Phase<'_> {
    let left = |rounds: usize| 0.7f64.powi(rounds as i32 + 1);
    Phase { whole, from: 1.0 - left(round), to: 1.0 - left(round + 1) }
}

/// A search over λ.
struct Search<'a> {
    problem: &'a Problem,
    options: GaussNewtonOptions,
    /// ln of the tolerance.
    goal: f64,
    /// Iterations of the history before the search, which has one limit for all its descents.
    begun: usize,
}

impl Search<'_> {
    fn found(&self, weight: f64, map: SpatialMap, status: Status) -> Found {
        let deviation = 0.5 * self.problem.unevenness(&map).max(f64::MIN_POSITIVE).ln();
        Found { weight: weight.ln(), deviation, map, status }
    }

    /// The options of the next descent.
    fn options(&self, angle_weight: f64, history: &History) -> GaussNewtonOptions {
        let done = history.iterations() - self.begun;
        let most_iterations = self.options.most_iterations.saturating_sub(done);
        GaussNewtonOptions { angle_weight, most_iterations, path: AnglePath::Balanced, ..self.options }
    }

    /// The minimum for one λ.
    fn minimum(
        &self,
        weight: f64,
        map: SpatialMap,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> Found {
        let options = GaussNewtonOptions { path: AnglePath::Held, ..self.options(weight, history) };
        let (map, status) = minimize(self.problem, map, &options, history, observer);
        self.found(weight, map, status)
    }

    /// The most even map, where no λ leads to areas within the tolerance.
    fn even(
        &self,
        map: SpatialMap,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> (SpatialMap, Status) {
        let tolerance = self.goal.exp();
        let options = GaussNewtonOptions { tolerance, ..self.options(0.0, history) };
        let (map, status) = minimize(self.problem, map, &options, history, observer);
        let is_within = self.problem.unevenness(&map).sqrt() <= tolerance;
        (map, if is_within || status != Status::Converged { status } else { Status::Stalled })
    }

    /// The largest λ within the tolerance, between `coarser` beyond it and `finer` within.
    fn raised(
        &self,
        mut coarser: Found,
        mut finer: Found,
        round: usize,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> Found {
        let (aim, good) = (self.goal + AIM.ln(), self.goal + GOOD.ln());
        for step in 0..STEPS {
            if finer.deviation >= good || finer.is_final() {
                break;
            }
            let share = (aim - finer.deviation) / (coarser.deviation - finer.deviation);
            let weight = finer.weight + share.clamp(0.1, 0.9) * (coarser.weight - finer.weight);
            let phase = &mut part(round + step, observer);
            let next = self.minimum(weight.exp(), coarser.map.clone(), history, phase);
            if next.is_final() {
                return Found { status: next.status, ..finer };
            }
            if next.deviation <= self.goal { finer = next } else { coarser = next }
        }
        finer
    }
}
