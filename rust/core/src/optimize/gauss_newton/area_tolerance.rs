// SPDX-License-Identifier: MIT OR Apache-2.0
//! The map of least shear whose areas are within a tolerance.
//!
//! The minimum of E_A + λ E_angle has less shear for larger λ, and more even areas for smaller λ. So λ falls step by
//! step until the minimum is within the tolerance, or rises while it is, and is then raised as far as the tolerance
//! allows. That last search uses the secant rule for the logarithms of λ and of the deviation √(E_A/A), which is close
//! to a power of λ. It starts each descent from the minimum of a larger λ, because shear stays in a map.

use super::angle_schedule::AnglePath;
use super::target_floors::{self, MappedSurface};
use super::{GaussNewtonOptions, Problem, minimize};
use crate::codomain::SpatialMap;
use crate::control::{History, Observer, Phase, Status};

/// The first λ.
const FIRST: f64 = 1.0;

/// Factor of λ until areas are within the tolerance; divisor while they are.
const FALL: f64 = 0.1;

/// Upper bound of λ, at which the map is conformal for all purposes.
const MOST: f64 = 1e4;

/// Lower bound of λ; below it areas alone count.
const LEAST: f64 = 1e-6;

/// The deviation that the secant steps aim at, in units of the tolerance.
const AIM: f64 = 0.98;

/// The least deviation that ends the secant steps, in units of the tolerance.
const GOOD: f64 = 0.95;

/// Limit of the secant steps.
const STEPS: usize = 6;

/// A stationary map for one λ.
struct Stationary {
    /// ln λ.
    weight: f64,
    /// ln √(E_A/A).
    deviation: f64,
    map: SpatialMap,
    status: Status,
}

impl Stationary {
    /// True if the run ended before the minimum was reached.
    fn is_final(&self) -> bool {
        matches!(self.status, Status::Cancelled | Status::MaxIterations)
    }
}

/// A guarded descent through all floors of the targets, to the map of least shear within a tolerance where one is
/// given; `problem` has the energy of the first floor, and is returned with that of the last.
pub(crate) fn descend(
    surface: &MappedSurface<'_>,
    problem: Problem,
    start: SpatialMap,
    area_tolerance: Option<f64>,
    options: &GaussNewtonOptions,
    history: &mut History,
    observer: &mut dyn Observer,
) -> (Problem, SpatialMap, Status) {
    match area_tolerance {
        Some(tolerance) => within_tolerance(surface, problem, start, tolerance, options, history, observer),
        None => target_floors::descend(surface, problem, start, options, history, observer),
    }
}

/// The map of least shear with √(E_A/A) ≤ `tolerance` that is reached from `start`; [`Status::Stalled`] where areas
/// cannot be made that even. `problem` has the energy of the first floor, and is returned with that of the last.
fn within_tolerance(
    surface: &MappedSurface<'_>,
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
    let (problem, map, status) = target_floors::descend(surface, problem, start, &first, history, &mut phase);
    let search = Search { problem: &problem, options: *options, goal: tolerance.ln(), begun };
    let mut best = search.stationary(FIRST, map, status);
    let (mut coarser, mut round) = (None, 0);
    while best.deviation > search.goal && !best.is_final() {
        let weight = FALL * best.weight.exp();
        if weight < LEAST {
            let even = search.even(best.map, history, &mut phase_of(round, observer));
            return (problem, even.0, even.1);
        }
        let next = search.minimum(weight, best.map.clone(), history, &mut phase_of(round, observer));
        round += 1;
        coarser = Some(std::mem::replace(&mut best, next));
    }
    // 2. Or λ rises while they are
    while coarser.is_none() && best.deviation <= search.goal && !best.is_final() {
        let weight = best.weight.exp() / FALL;
        if weight > MOST {
            break;
        }
        let next = search.minimum(weight, best.map.clone(), history, &mut phase_of(round, observer));
        round += 1;
        match (next.is_final(), next.deviation <= search.goal) {
            (true, _) => return (problem, best.map, next.status),
            (false, true) => best = next,
            (false, false) => coarser = Some(next),
        }
    }
    // 3. λ is raised as far as areas stay within the tolerance
    if let Some(coarser) = coarser {
        best = search.raised(coarser, best, round, history, observer);
    }
    (problem, best.map, best.status)
}

/// The phase of a round after the first descent; later rounds, whose number is unknown, get less and less.
fn phase_of(round: usize, whole: &mut dyn Observer) -> Phase<'_> {
    let left = |rounds: usize| 0.7f64.powi(rounds as i32 + 1);
    Phase { whole, from: 1.0 - left(round), to: 1.0 - left(round + 1) }
}

/// A search over λ.
struct Search<'a> {
    problem: &'a Problem,
    options: GaussNewtonOptions,
    /// ln of the tolerance.
    goal: f64,
    /// Iterations before the search, whose descents share one limit.
    begun: usize,
}

impl Search<'_> {
    fn stationary(&self, weight: f64, map: SpatialMap, status: Status) -> Stationary {
        let deviation = 0.5 * self.problem.unevenness(&map).max(f64::MIN_POSITIVE).ln();
        Stationary { weight: weight.ln(), deviation, map, status }
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
    ) -> Stationary {
        let options = GaussNewtonOptions { path: AnglePath::Held, ..self.options(weight, history) };
        let (map, status) = minimize(self.problem, map, &options, history, observer);
        self.stationary(weight, map, status)
    }

    /// The map of the most even areas, where no λ leads to areas within the tolerance.
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
        mut coarser: Stationary,
        mut finer: Stationary,
        round: usize,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> Stationary {
        let (aim, good) = (self.goal + AIM.ln(), self.goal + GOOD.ln());
        for step in 0..STEPS {
            if finer.deviation >= good || finer.is_final() {
                break;
            }
            let share = (aim - finer.deviation) / (coarser.deviation - finer.deviation);
            let weight = finer.weight + share.clamp(0.1, 0.9) * (coarser.weight - finer.weight);
            let phase = &mut phase_of(round + step, observer);
            let next = self.minimum(weight.exp(), coarser.map.clone(), history, phase);
            if next.is_final() {
                return Stationary { status: next.status, ..finer };
            }
            if next.deviation <= self.goal { finer = next } else { coarser = next }
        }
        finer
    }
}
