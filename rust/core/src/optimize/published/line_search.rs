// SPDX-License-Identifier: MIT OR Apache-2.0
//! A line search for the strong Wolfe conditions.
//!
//! Nocedal & Wright (2006), Algorithms 3.5 and 3.6: bracket an interval that holds an acceptable step, then
//! shrink it by safeguarded interpolation. Conditions (4.1) of Liu & Yueh (2023): for 0 < c₁ < c₂ < ½,
//!
//! ```text
//! φ(α) ≤ φ(0) + c₁ α φ'(0),      |φ'(α)| ≤ c₂ |φ'(0)|.
//! ```
//!
//! The objective may be +∞ (a map that is not allowed); such a step only shortens the bracket.
//! Cost: two or three evaluations where the first trial is not accepted at once.

/// Constants of the strong Wolfe conditions and bounds of the search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WolfeOptions {
    /// c₁ of the sufficient decrease; 10⁻⁴ as is usual.
    pub decrease: f64,
    /// c₂ of the curvature condition; below ½, which makes every conjugate direction one of descent.
    pub curvature: f64,
    /// Evaluations before the search gives up; 30 halvings reach 10⁻⁹ of the first trial.
    pub max_evaluations: usize,
}

impl Default for WolfeOptions {
    fn default() -> Self {
        Self { decrease: 1e-4, curvature: 0.4, max_evaluations: 30 }
    }
}

/// An objective along a curve at one step: φ(α), φ'(α), and data of the caller.
#[derive(Debug, Clone)]
pub struct Trial<T> {
    /// The step α.
    pub step: f64,
    /// φ(α), +∞ where the step is not allowed.
    pub value: f64,
    /// φ'(α); not used where the value is infinite.
    pub slope: f64,
    /// The caller's data at this step.
    pub data: T,
}

impl WolfeOptions {
    /// True if a trial satisfies both conditions.
    pub fn accepts<T>(&self, start: &Trial<T>, trial: &Trial<T>) -> bool {
        self.decreases(start, trial) && trial.slope.abs() <= self.curvature * start.slope.abs()
    }

    fn decreases<T>(&self, start: &Trial<T>, trial: &Trial<T>) -> bool {
        // a decrease below the rounding of the value itself cannot be seen and is not asked for
        let rounding = 8.0 * f64::EPSILON * start.value.abs();
        trial.value <= start.value + self.decrease * trial.step * start.slope + rounding
    }
}

/// Finds a step that satisfies the strong Wolfe conditions.
///
/// `start` is the trial at α = 0 with negative slope, `first` the first trial at α > 0, and `evaluate`
/// computes others. Returns the accepted trial, or the best one that at least decreases enough, or `None`.
pub fn strong_wolfe<T: Clone>(
    start: &Trial<T>,
    first: Trial<T>,
    options: &WolfeOptions,
    mut evaluate: impl FnMut(f64) -> Trial<T>,
) -> Option<Trial<T>> {
    // 1. Bracket: `low` is the best step so far, `high` an upper bound of the search
    let (mut low, mut high) = (start.clone(), None);
    let mut trial = first;
    for _ in 0..options.max_evaluations {
        // 2. Accept, or move one end of the bracket to the trial
        if options.accepts(start, &trial) {
            return Some(trial);
        }
        if !options.decreases(start, &trial) || trial.value >= low.value {
            high = Some(trial);
        } else {
            let width = high.as_ref().map_or(1.0, |end: &Trial<T>| end.step - low.step);
            if trial.slope * width >= 0.0 {
                high = Some(low);
            }
            low = trial;
        }
        // 3. Next trial: doubled while nothing bounds the step, inside the bracket afterwards
        let step = match &high {
            None => 2.0 * low.step,
            Some(end) => inside(&low, end),
        };
        trial = evaluate(step);
    }
    (low.step > 0.0).then_some(low)
}

/// The minimizer of the quadratic through φ(low), φ'(low), φ(high), kept off both ends by a tenth of the
/// bracket.
fn inside<T>(low: &Trial<T>, high: &Trial<T>) -> f64 {
    let width = high.step - low.step;
    let bend = high.value - low.value - low.slope * width;
    let fraction =
        if bend.is_finite() && bend > 0.0 { (-0.5 * low.slope * width / bend).clamp(0.1, 0.9) } else { 0.5 };
    low.step + fraction * width
}

#[cfg(test)]
mod tests {
    use super::*;

    type Function = fn(f64) -> f64;

    fn search(first: f64, value: Function, slope: Function) -> (Trial<()>, Option<Trial<()>>) {
        let at = |step| Trial { step, value: value(step), slope: slope(step), data: () };
        (at(0.0), strong_wolfe(&at(0.0), at(first), &WolfeOptions::default(), at))
    }

    #[test]
    fn finds_a_strong_wolfe_step_from_any_first_trial() {
        // a quartic with its first minimum at 1, and a bumpy descent
        let cases: [(Function, Function); 2] = [
            (|x| x.powi(4) - 4.0 * x, |x| 4.0 * x.powi(3) - 4.0),
            (|x| 0.1 * x * x - x + 0.3 * (3.0 * x).sin(), |x| 0.2 * x - 1.0 + 0.9 * (3.0 * x).cos()),
        ];
        for (value, slope) in cases {
            for first in [1e-6, 1e-2, 0.5, 1.0, 10.0, 1e6] {
                let (start, trial) = search(first, value, slope);
                assert!(
                    WolfeOptions::default().accepts(&start, &trial.expect("a step")),
                    "first trial {first}"
                );
            }
        }
    }

    #[test]
    fn steps_that_are_not_allowed_shorten_the_bracket() {
        // infinite from 0.3 on, still falling there
        let (start, trial) = search(8.0, |x| if x < 0.3 { -x } else { f64::INFINITY }, |_| -1.0);
        let trial = trial.expect("a step that decreases");
        assert!(trial.step < 0.3 && trial.value < start.value);
    }

    #[test]
    fn gives_up_where_nothing_decreases() {
        let (_, trial) = search(1.0, |x| x, |_| -1.0);
        assert!(trial.is_none());
    }
}
