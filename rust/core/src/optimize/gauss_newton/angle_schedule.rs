// SPDX-License-Identifier: MIT OR Apache-2.0
//! The schedule of λ, the weight of angles, during a guarded Gauss–Newton descent.
//!
//! Areas are cheap to even out and angles are not: once λ is small, the shear of a map stays. So λ follows one of two
//! paths down to the weight asked for, 0 or more, or is *held* at that weight from the outset:
//!
//! - *balanced*: λ keeps the energy of angles at a multiple κ of E_A, smaller once areas are nearly even. For starts
//!   near the minimum.
//! - *staged*: λ is held at ten times, once, a tenth of, ... the energy of areas, each time until the map is
//!   stationary, and balanced in the end where areas alone count. For long limbs, whose faces lock each other once they
//!   are sheared. A stationary point forgets how it was reached: noise that a stage has amplified is gone at its end.

/// κ, the angle energy times λ over E_A that a balanced λ aims at. Larger values spare angles and cost iterations.
const BALANCE: f64 = 2.2;

/// Area deviation below which [`LAST_BALANCE`] replaces [`BALANCE`].
const NEARLY_EVEN: f64 = 0.004;

/// κ below [`NEARLY_EVEN`], on surfaces of fewer than [`MANY`] vertices and on others.
const LAST_BALANCE: [f64; 2] = [1.0, 0.3];

/// κ with landmarks, which angles must not hold back.
const WITH_LANDMARKS: f64 = 0.3;

/// Bounds of a balanced λ, which may also fall to the weight asked for.
const BALANCED: [f64; 2] = [1e-6, 1.0];

/// Lower bound of the factor by which a balanced λ falls in one iteration; after a step below [`SHORT`] it does not
/// fall.
const FASTEST_FALL: f64 = 0.1;

/// A step below this is short.
pub(super) const SHORT: f64 = 0.3;

/// The stages of a staged λ.
#[derive(Debug)]
struct Stages {
    weights: &'static [f64],
    /// Iteration limit of a stage, and of the last stage.
    longest: [usize; 2],
    /// A stage ends where the slope promises less than this part of the energy.
    least_slope: f64,
}

/// Stages down to areas alone. The last stage is short, because the energy of areas alone has hardly any curvature to
/// hold the map, and noise would grow.
const TO_AREAS: Stages = Stages {
    weights: &[10.0, 1.0, 0.3, 0.1, 0.03, 0.01, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5],
    longest: [60, 10],
    least_slope: 1e-5,
};

/// Stages down to a weight asked for.
const TO_WEIGHT: Stages = Stages {
    weights: &[10.0, 1.0, 0.3, 0.1, 0.03, 0.01, 3e-3, 1e-3, 3e-4, 1e-4, 1e-5],
    longest: [60, 60],
    least_slope: 1e-5,
};

/// On a balanced path with λ at the weight asked for, the descent ends when the slope promises less than this part of
/// the energy.
const LEAST_SLOPE: f64 = 1e-3;

/// Surfaces of fewer vertices, where iterations are cheap, are mapped as thoroughly as by stages instead.
const SMALL: usize = 1_000;

/// From this weight on angles hold the map, so that [`LEAST_SLOPE`] suffices on small surfaces too.
const HEAVY: f64 = 0.1;

/// Iterations count as costly on surfaces of this many vertices or more.
pub(super) const MANY: usize = 10_000;

/// The path on which λ falls.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum AnglePath {
    Balanced,
    Staged,
    /// λ stays at the weight asked for, until the map is stationary.
    Held,
}

/// The figures of one iteration.
#[derive(Debug, Clone, Copy)]
pub(super) struct Progress {
    /// E_A over the energy of angles.
    pub balance: f64,
    /// The deviation of the area ratio.
    pub deviation: f64,
    /// The length of the last step.
    pub step: f64,
    /// True if the last λ has almost nothing left to gain.
    pub is_flat: bool,
}

/// λ and its path.
#[derive(Debug, Clone, Copy)]
pub(super) struct AngleSchedule {
    /// λ never falls below this.
    least: f64,
    /// κ far from even areas and near them.
    balance: [f64; 2],
    /// λ; NaN before the first iteration.
    weight: f64,
    /// The stages; a balanced λ that has fallen to the weight asked for uses only their precision. `None` without
    /// stages.
    stages: Option<&'static Stages>,
    /// The stage and its iterations so far; `None` where λ is balanced.
    stage: Option<(usize, usize)>,
}

impl AngleSchedule {
    pub(super) fn new(path: AnglePath, least: f64, n_vertices: usize, has_landmarks: bool) -> Self {
        let (is_small, is_large) = (n_vertices < SMALL, n_vertices >= MANY);
        let balance =
            if has_landmarks { [WITH_LANDMARKS; 2] } else { [BALANCE, LAST_BALANCE[usize::from(is_large)]] };
        let stages = match path {
            AnglePath::Balanced if least == 0.0 || least >= HEAVY || !is_small || has_landmarks => None,
            AnglePath::Staged if least == 0.0 => Some(&TO_AREAS),
            AnglePath::Balanced | AnglePath::Staged | AnglePath::Held => Some(&TO_WEIGHT),
        };
        let stage = (path == AnglePath::Staged).then_some((0, 0));
        let weight = if path == AnglePath::Held { least } else { f64::NAN };
        Self { least, balance, weight, stages, stage }
    }

    /// λ of the next iteration.
    pub(super) fn advance(&mut self, progress: &Progress) -> f64 {
        if let (Some(stages), Some((stage, iterations))) = (self.stages, self.stage) {
            let is_last = stage + 1 == stages.weights.len();
            let longest = stages.longest[usize::from(is_last)];
            let ends = !self.weight.is_nan() && (progress.is_flat || iterations >= longest);
            self.stage = match stage + usize::from(ends) {
                next if next == stages.weights.len() || (ends && self.is_held()) => None,
                next if next > stage => Some((next, 1)),
                _ => Some((stage, iterations + 1)),
            };
        }
        self.weight = match (self.stages, self.stage) {
            (Some(stages), Some((stage, _))) => stages.weights[stage].max(self.least),
            _ => self.balanced(progress),
        };
        self.weight
    }

    /// λ; NaN before the first iteration.
    pub(super) fn weight(&self) -> f64 {
        self.weight
    }

    /// True if λ has fallen to a weight asked for that is not 0.
    pub(super) fn is_held(&self) -> bool {
        self.least > 0.0 && self.weight <= self.least
    }

    /// True if stages are still to come.
    pub(super) fn is_staged(&self) -> bool {
        self.stage.is_some()
    }

    /// The part of the energy that the slope must promise for λ to stay.
    pub(super) fn least_slope(&self) -> f64 {
        match self.stages {
            Some(stages) if self.is_thorough() => stages.least_slope,
            _ => LEAST_SLOPE,
        }
    }

    /// True if λ stays until the map is stationary.
    pub(super) fn is_thorough(&self) -> bool {
        self.stages.is_some() && (self.is_staged() || self.is_held())
    }

    fn balanced(&self, progress: &Progress) -> f64 {
        let [lightest, most] = BALANCED;
        let least = if self.least > 0.0 { self.least } else { lightest };
        let ratio = self.balance[usize::from(progress.deviation <= NEARLY_EVEN)];
        let goal = (ratio * progress.balance).min(most).max(least);
        match self.weight {
            weight if weight.is_nan() => goal,
            // where areas become no more even at this λ, the balance would hold it forever
            weight if progress.is_flat => goal.min(FASTEST_FALL * weight).max(least),
            weight if goal < weight && progress.step >= SHORT => goal.max(FASTEST_FALL * weight),
            weight => weight,
        }
    }
}
