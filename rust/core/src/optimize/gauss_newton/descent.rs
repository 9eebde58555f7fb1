// SPDX-License-Identifier: MIT OR Apache-2.0
//! The iterations: weights, direction, step, and end.

use super::angle_schedule::{AngleSchedule, Progress, SHORT};
use super::problem::{GaussNewtonOptions, Problem, State};
use super::stopping::{MESSAGE, StoppingRule, Trend};
use super::system::{LARGE, Linearized, NEAR, Newton};
use super::trial::{Trial, shrinkage};
use crate::codomain::SpatialMap;
use crate::control::{History, Observer, Status, Watch};
use crate::energy::authalic::{Hessian, Sums, Weights};
use crate::energy::stretch::Profile;
use crate::parallel;
use crate::sparse::Failure;

/// μ, the damping of a face that is wholly off its target.
const DAMPING: f64 = 0.05;

/// Factor of μ after a short step.
const STRAIN: f64 = 3.0;

/// Divisor of μ after a long step; small, so that μ falls slowly.
const RELIEF: f64 = 1.3;

/// Upper bound of the deviation that the damping adds to every face.
const LEAST_DEVIATION: f64 = 1e-3;

/// Lower bound of the deviation that the damping adds to every face.
const LEAST_DAMPING: f64 = 3e-4;

/// Lower bound of the same on more than [`LARGE`] vertices; smaller values break the single-precision factorization.
const SINGLE_PRECISION: f64 = 2e-3;

/// No vertex moves farther than this in one step.
const LONGEST_MOVE: f64 = 0.5;

/// Steps tried along one direction.
const MOST_TRIALS: usize = 30;

/// A step must gain this part of what the slope promises.
const SUFFICIENT: f64 = 1e-4;

/// An energy below this part of the area counts as zero.
const NOTHING: f64 = 1e-12;

/// The more even of two results, each with its unevenness; cancelled where the second run was.
pub(crate) fn more_even(
    first: (f64, SpatialMap, Status),
    second: (f64, SpatialMap, Status),
) -> (SpatialMap, Status) {
    if second.0 < first.0 {
        (second.1, second.2)
    } else if second.2 == Status::Cancelled {
        (first.1, second.2)
    } else {
        (first.1, first.2)
    }
}

/// Lowers the energy from `start` and returns the status with the last map, or with the map of the lowest E_A where the
/// weight of angles is 0 behind the barrier.
pub(crate) fn minimize(
    problem: &Problem,
    start: SpatialMap,
    options: &GaussNewtonOptions,
    history: &mut History,
    observer: &mut dyn Observer,
) -> (SpatialMap, Status) {
    let mut descent = Descent::new(problem, *options);
    let mut state = State::new(problem, start);
    let mut sums = problem.sums(&state);
    let mut trend = Trend::default();
    let mut best = (f64::INFINITY, SpatialMap::new());
    for done in 0.. {
        // 1. Targets on the scale of the image, the next λ
        trend.energies.push(sums.total());
        let was_staged = descent.schedule.is_staged();
        let weights = descent.balance(&sums, &trend);
        if was_staged && !descent.schedule.is_staged() {
            trend = Trend { energies: vec![sums.total()], norms: Vec::new() };
        }
        if sums.total() < best.0 && descent.keeps_the_best() {
            best = (sums.total(), state.map.clone());
        }
        let (schedule, is_flat) = (&descent.schedule, descent.flat);
        if let Some(status) = descent.stopping.verdict(done, &sums, &trend, schedule, is_flat, observer) {
            history.push_start(sums.authalic_energy, 0.0);
            return (descent.best_of(best, &sums, state.map, history), status);
        }
        // 2. One factorization, the direction
        let watch = Watch::new(observer, descent.stopping.fraction(done), MESSAGE);
        let damping = descent.damping_of(&sums);
        let is_near = descent.is_near();
        let newton =
            match descent.linearized.direction(problem, &state.map, &weights, damping, is_near, &watch) {
                Ok(newton) => newton,
                Err(failure) => {
                    history.push_start(sums.authalic_energy, 0.0);
                    let is_cancelled = failure == Failure::Cancelled;
                    let status = if is_cancelled { Status::Cancelled } else { Status::Stalled };
                    return (descent.best_of(best, &sums, state.map, history), status);
                }
            };
        let norm = (-newton.slope).max(0.0).sqrt();
        history.push_start(sums.authalic_energy, norm);
        trend.norms.push(norm);
        // 3. A step along it that lowers the energy and folds nothing
        let Some((next, step)) = descent.step(&state, &newton, &weights) else {
            let status = if descent.flat { Status::Converged } else { Status::Stalled };
            return (descent.best_of(best, &sums, state.map, history), status);
        };
        state = next;
        sums = problem.sums(&state);
        descent.adapt(step);
        history.push(sums.authalic_energy, step, norm);
    }
    unreachable!("the verdict ends the loop")
}

/// The state of the iterations.
struct Descent<'a> {
    problem: &'a Problem,
    options: GaussNewtonOptions,
    linearized: Linearized,
    schedule: AngleSchedule,
    stopping: StoppingRule,
    /// True if the last second-order correction was useless.
    is_straight: bool,
    /// The scale of the targets; NaN before the first iteration.
    scale: f64,
    /// μ.
    damping: f64,
    last_step: f64,
    /// Σ targets.
    total_target: f64,
    /// The part of the energy that the last slope promised.
    promise: f64,
    /// True if that part was almost nothing.
    flat: bool,
}

impl<'a> Descent<'a> {
    fn new(problem: &'a Problem, options: GaussNewtonOptions) -> Self {
        let targets = problem.energy.targets();
        let has_landmarks = !problem.penalty.vertices().is_empty();
        Self {
            problem,
            options,
            linearized: Linearized::new(problem.motions.len() >= LARGE),
            schedule: AngleSchedule::new(
                options.path,
                options.angle_weight,
                problem.motions.len(),
                has_landmarks,
            ),
            stopping: StoppingRule::new(problem, options),
            is_straight: false,
            scale: f64::NAN,
            damping: DAMPING,
            last_step: 1.0,
            total_target: parallel::sum(targets.len(), |face| targets[face]),
            promise: f64::INFINITY,
            flat: false,
        }
    }

    /// True if E_A alone decides which map is the best; it may rise on the way, where a barrier or angles count.
    fn keeps_the_best(&self) -> bool {
        self.options.angle_weight == 0.0 && self.options.profile == Profile::Barrier
    }

    /// The map of the lowest E_A where that decides, otherwise the last map.
    fn best_of(
        &self,
        best: (f64, SpatialMap),
        sums: &Sums,
        last: SpatialMap,
        history: &mut History,
    ) -> SpatialMap {
        if !self.keeps_the_best() || best.0 >= sums.total() {
            return last;
        }
        // the history ends with the map that is returned
        history.push(self.problem.energy.sums(&self.problem.energy.costs(&best.1)).authalic_energy, 0.0, 0.0);
        best.1
    }

    /// The weights of the next iteration.
    fn balance(&mut self, sums: &Sums, trend: &Trend) -> Weights {
        let balance = sums.total() / sums.angle_energy.max(1e-3);
        let deviation = (sums.total() / sums.area).sqrt();
        // a slow descent must go on to the weight asked for
        let is_on_its_way = self.options.angle_weight > 0.0 && !self.schedule.is_staged();
        let is_flat = self.flat || (is_on_its_way && trend.is_slow());
        let progress = Progress { balance, deviation, step: self.last_step, is_flat };
        let before = self.schedule.weight();
        let angle = self.schedule.advance(&progress);
        // with another λ the energy need not be flat
        self.flat &= angle == before;
        self.scale = sums.area / self.total_target;
        Weights { scale: self.scale, angle, profile: self.options.profile }
    }

    /// The next map and the length of the step; `None` where no step lowers the energy.
    fn step(&mut self, state: &State, newton: &Newton, weights: &Weights) -> Option<(State, f64)> {
        let problem = self.problem;
        let value = problem.value(state, weights);
        self.promise = -newton.slope / value;
        self.flat =
            self.promise <= self.schedule.least_slope() || value <= NOTHING * self.scale * self.total_target;
        // 1. The longest step allowed, straight and corrected to second order
        let squares = newton.direction.iter().map(|d| d[0] * d[0] + d[1] * d[1]);
        let longest = squares.fold(0.0, f64::max).sqrt();
        let mut step = (LONGEST_MOVE / longest).min(1.0);
        let mut bend = None;
        let mut trial = Trial::new(problem, self.path(&state.map, newton, None, step), weights);
        // a useless correction is seldom useful in the next iteration
        if step == 1.0 && !std::mem::take(&mut self.is_straight) {
            let correction =
                self.linearized.correction(problem, &state.map, &trial.state.map, newton, weights);
            let corrected =
                Trial::new(problem, self.path(&state.map, newton, Some(&correction), step), weights);
            self.is_straight = corrected.value >= trial.value;
            if !self.is_straight {
                (trial, bend) = (corrected, Some(correction));
            }
        }
        // 2. Shorter steps until the energy falls
        for _ in 0..MOST_TRIALS {
            if trial.value.is_finite() && trial.value <= value + SUFFICIENT * step * newton.slope {
                return Some((trial.state, step));
            }
            step *= shrinkage(trial.value - value, step * newton.slope);
            trial = Trial::new(problem, self.path(&state.map, newton, bend.as_deref(), step), weights);
        }
        None
    }

    /// The map at `step` along the direction, bent by the correction.
    fn path(&self, map: &SpatialMap, newton: &Newton, bend: Option<&[[f64; 2]]>, step: f64) -> SpatialMap {
        let along = |v: usize| match bend {
            None => newton.direction[v].map(|d| step * d),
            Some(bend) => [0, 1].map(|k| step * (newton.direction[v][k] + step * bend[v][k])),
        };
        let direction = parallel::map(map.len(), along);
        self.problem.moved(map, &newton.frames, &direction)
    }

    /// True if λ stays until the map is stationary, and it nearly is.
    fn is_near(&self) -> bool {
        self.schedule.is_thorough() && self.promise < NEAR
    }

    /// The damping at a map.
    fn damping_of(&self, sums: &Sums) -> Hessian {
        // in proportion to the residual near the minimum, so that the damping does not decide how fast it is reached
        let deviation = (sums.total() / sums.area).sqrt();
        let least = deviation.clamp(LEAST_DAMPING, LEAST_DEVIATION);
        let is_large = self.problem.motions.len() >= LARGE;
        let least = if is_large { least.max(SINGLE_PRECISION) } else { least };
        Hessian { damping: self.damping, least, curvature: 0.0 }
    }

    /// A short step asks for more damping, a long one for less.
    fn adapt(&mut self, step: f64) {
        self.last_step = step;
        self.damping =
            if step < SHORT { STRAIN * self.damping } else { (self.damping / RELIEF).max(DAMPING) };
    }
}
