// SPDX-License-Identifier: MIT OR Apache-2.0
//! How λ, the weight of angles, falls during a guarded Gauss–Newton descent.
//!
//! Areas are cheap to even out and angles are not: once λ is small, shear that a map still has stays in it. So λ follows
//! one of two paths down to the weight that was asked for, 0 or more:
//!
//! - *balanced*: λ keeps the energy of angles at a fixed multiple of E_A. For starts near the minimum.
//! - *staged*: λ is held at ten times, once, a third of, ... the energy of areas, each time until the map is all but
//!   stationary, and balanced in the end. For long limbs, whose faces lock each other once they are sheared.

/// κ, the angle energy times λ over E_A that a balanced λ aims at, while the area ratio deviates by more than
/// [`NEARLY_EVEN`]. Larger values spare angles and cost iterations.
const BALANCE: f64 = 2.5;
const NEARLY_EVEN: f64 = 0.004;

/// From then on, where iterations are cheap, and where they are not.
const LAST_BALANCE: [f64; 2] = [1.0, 0.3];

/// And all along where landmarks pull, which angles must not hold back.
const WITH_LANDMARKS: f64 = 0.3;

/// A balanced λ stays between these.
const BALANCED: [f64; 2] = [1e-7, 1.0];

/// It falls to this part of itself at the most in one iteration, and only after a step of [`SHORT`] or more.
const FASTEST_FALL: f64 = 0.1;

/// A step below this is short.
pub(super) const SHORT: f64 = 0.3;

/// λ of the stages.
const STAGES: [f64; 11] = [10.0, 1.0, 0.3, 0.1, 0.03, 0.01, 3e-3, 1e-3, 3e-4, 1e-4, 1e-5];

/// Iterations of one stage at the most.
const LONGEST_STAGE: usize = 10;

/// Which way λ falls.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum AnglePath {
    Balanced,
    Staged,
}

/// What an iteration has shown.
#[derive(Debug, Clone, Copy)]
pub(super) struct Progress {
    /// E_A over the energy of angles.
    pub balance: f64,
    /// The deviation of the area ratio.
    pub deviation: f64,
    /// The length of the last step.
    pub step: f64,
    /// Whether next to nothing is left to gain at the last λ.
    pub is_flat: bool,
}

/// λ now and on its way.
#[derive(Debug, Clone, Copy)]
pub(super) struct AngleSchedule {
    /// λ never falls below this.
    least: f64,
    /// κ at first and in the end.
    balance: [f64; 2],
    /// λ; NaN before the first iteration.
    weight: f64,
    /// The stage and its iterations so far; `None` where λ is balanced.
    stage: Option<(usize, usize)>,
}

impl AngleSchedule {
    pub(super) fn new(path: AnglePath, least: f64, is_large: bool, has_landmarks: bool) -> Self {
        let balance = match has_landmarks {
            true => [WITH_LANDMARKS; 2],
            false => [BALANCE, LAST_BALANCE[usize::from(is_large)]],
        };
        let stage = (path == AnglePath::Staged).then_some((0, 0));
        Self { least, balance, weight: f64::NAN, stage }
    }

    /// λ of the next iteration.
    pub(super) fn advance(&mut self, progress: &Progress) -> f64 {
        if let Some((stage, iterations)) = self.stage {
            let ends = !self.weight.is_nan() && (progress.is_flat || iterations >= LONGEST_STAGE);
            self.stage = match stage + usize::from(ends) {
                next if next == STAGES.len() || (ends && self.is_held()) => None,
                next if next > stage => Some((next, 1)),
                _ => Some((stage, iterations + 1)),
            };
        }
        self.weight = match self.stage {
            Some((stage, _)) => STAGES[stage].max(self.least),
            None => self.balanced(progress),
        };
        self.weight
    }

    /// λ; NaN before the first iteration.
    pub(super) fn weight(&self) -> f64 {
        self.weight
    }

    /// Whether λ has fallen to the weight that was asked for, and that is not 0.
    pub(super) fn is_held(&self) -> bool {
        self.least > 0.0 && self.weight <= self.least
    }

    /// Whether stages are still to come.
    pub(super) fn is_staged(&self) -> bool {
        self.stage.is_some()
    }

    fn balanced(&self, progress: &Progress) -> f64 {
        let [least, most] = BALANCED;
        let ratio = self.balance[usize::from(progress.deviation <= NEARLY_EVEN)];
        let goal = (ratio * progress.balance).clamp(least, most).max(self.least);
        match self.weight {
            weight if weight.is_nan() => goal,
            // where areas become no evener at this λ, the balance would hold it for ever
            weight if progress.is_flat => goal.min(FASTEST_FALL * weight).max(self.least).max(least),
            weight if goal < weight && progress.step >= SHORT => goal.max(FASTEST_FALL * weight),
            weight => weight,
        }
    }
}
