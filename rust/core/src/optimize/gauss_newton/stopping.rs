// SPDX-License-Identifier: MIT OR Apache-2.0
//! When a descent ends, and with what status.

use super::angle_schedule::{AnglePath, AngleSchedule, MANY};
use super::problem::{GaussNewtonOptions, Problem};
use crate::control::{Observer, Status};
use crate::energy::authalic::Sums;
use crate::energy::stretch::Profile;

/// Area deviation below which a descent ends after the usual iterations: on surfaces of fewer than [`MANY`] vertices,
/// on others, and after stages, which few surfaces need.
const EVEN_ENOUGH: [f64; 3] = [0.002, 0.005, 0.003];

/// Area deviation below which a slow descent ends.
const GOOD_ENOUGH: f64 = 0.005;

/// Area deviation below which a descent ends at once on surfaces of [`MANY`] vertices or more.
const EVEN: f64 = 7e-4;

/// Iterations over which a descent must lower E_A by [`LEAST_GAIN`], or it is slow.
const PATIENCE: usize = 5;

/// The part of E_A that [`PATIENCE`] iterations must gain.
const LEAST_GAIN: f64 = 0.05;

pub(super) const MESSAGE: &str = "Evening out areas";

/// The energies and gradient norms of the iterations so far.
#[derive(Default)]
pub(super) struct Trend {
    pub energies: Vec<f64>,
    pub norms: Vec<f64>,
}

impl Trend {
    /// True if the last iterations gained almost nothing, and were not about to leave a saddle.
    pub(super) fn is_slow(&self) -> bool {
        let Some(before) = self.norms.len().checked_sub(PATIENCE) else { return false };
        let [then, now] = [before, self.norms.len()].map(|k| self.energies[k]);
        let is_leaving = self.norms[self.norms.len() - 1] > self.norms[before];
        now > (1.0 - LEAST_GAIN) * then && !is_leaving
    }
}

/// What decides when a descent ends.
pub(super) struct StoppingRule {
    options: GaussNewtonOptions,
    /// The area deviation below which to end after the usual iterations.
    even_enough: f64,
    /// True if iterations are costly.
    is_large: bool,
}

impl StoppingRule {
    pub(super) fn new(problem: &Problem, options: GaussNewtonOptions) -> Self {
        let is_large = problem.motions.len() >= MANY;
        let has_landmarks = !problem.penalty.vertices().is_empty();
        Self {
            options,
            even_enough: match options.path {
                AnglePath::Staged => EVEN_ENOUGH[2],
                AnglePath::Balanced | AnglePath::Held => EVEN_ENOUGH[usize::from(is_large || has_landmarks)],
            },
            // landmarks must meet, however even areas are
            is_large: is_large && !has_landmarks && options.profile == Profile::Barrier,
        }
    }

    /// The status with which to end, if any.
    pub(super) fn verdict(
        &self,
        done: usize,
        sums: &Sums,
        trend: &Trend,
        schedule: &AngleSchedule,
        is_flat: bool,
        observer: &mut dyn Observer,
    ) -> Option<Status> {
        let options = &self.options;
        let (is_held, is_staged) = (schedule.is_held(), schedule.is_staged());
        let is_slow = options.angle_weight == 0.0 && !is_staged && trend.is_slow();
        let deviation = (sums.total() / sums.area).sqrt();
        let is_asked = options.usual_iterations == usize::MAX;
        let is_even = deviation <= options.tolerance
            || (!is_staged && deviation <= self.even_enough && trend.norms.len() >= options.usual_iterations)
            || (!is_staged && !is_asked && self.is_large && deviation <= EVEN);
        let is_open = options.until_open.is_some_and(|least| done >= least && sums.angle_energy.is_finite());
        if (is_even && !is_held) || is_open || (is_held && is_flat) {
            Some(Status::Converged)
        } else if is_slow {
            // a minimum that is not 0, as coarse surfaces have, is stationary
            let is_at_rest = is_flat || (!is_asked && deviation <= GOOD_ENOUGH);
            Some(if is_at_rest { Status::Converged } else { Status::Stalled })
        } else if done >= options.most_iterations {
            Some(Status::MaxIterations)
        } else if observer.progress(self.fraction(done), MESSAGE) {
            None
        } else {
            Some(Status::Cancelled)
        }
    }

    /// The fraction done after `done` iterations.
    pub(super) fn fraction(&self, done: usize) -> f64 {
        // nearly all runs end after the usual iterations; progress must never go back
        let usual = self.options.usual_iterations.min(self.options.most_iterations).max(1);
        1.0 - 0.1f64.powf(done as f64 / usual as f64)
    }
}
