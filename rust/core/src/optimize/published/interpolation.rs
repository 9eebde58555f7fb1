// SPDX-License-Identifier: MIT OR Apache-2.0
//! The backtracking line search by safeguarded quadratic and cubic interpolation.
//!
//! Sutti & Yueh (2024), appendix C.1, after Dennis & Schnabel (1996), section 6.3.2: a trial step that does
//! not decrease enough,
//!
//! ```text
//! φ(α) ≤ φ(0) + c₁ α φ'(0),
//! ```
//!
//! is replaced by the minimizer of the quadratic through φ(0), φ'(0), φ(α), and after that by the minimizer
//! of the cubic through φ(0), φ'(0) and the last two values, each kept within [0.1, 0.5] of the step before.
//!
//! The objective may be +∞ (a map that is not allowed); such a step is halved. Cost: one evaluation where
//! the first trial is accepted.

use super::line_search::Trial;

/// c₁ of the sufficient decrease; 10⁻⁴ as is usual.
const DECREASE: f64 = 1e-4;

/// Trials before the search gives up.
const MAX_TRIALS: usize = 40;

/// True if `trial` decreases enough, up to the rounding of the value itself.
pub(super) fn decreases<S, T>(start: &Trial<S>, trial: &Trial<T>) -> bool {
    let rounding = 8.0 * f64::EPSILON * start.value.abs();
    trial.value <= start.value + DECREASE * trial.step * start.slope + rounding
}

/// Finds a step that decreases enough, or `None`.
///
/// `start` is the trial at α = 0 with negative slope, `first` the first step to try, and `evaluate` computes
/// trials, whose slopes are not used.
pub(super) fn backtrack<S, T>(
    start: &Trial<S>,
    first: f64,
    mut evaluate: impl FnMut(f64) -> Trial<T>,
) -> Option<Trial<T>> {
    let mut trial = evaluate(first);
    let mut before: Option<(f64, f64)> = None;
    for _ in 0..MAX_TRIALS {
        if decreases(start, &trial) {
            return Some(trial);
        }
        let wanted = match before {
            _ if !trial.value.is_finite() => 0.5 * trial.step,
            None => quadratic(start, &trial),
            Some(before) => cubic(start, (trial.step, trial.value), before),
        };
        // a step or a value that is no number bisects
        let wanted = if wanted.is_finite() { wanted } else { 0.5 * trial.step };
        before = trial.value.is_finite().then_some((trial.step, trial.value));
        trial = evaluate(wanted.clamp(0.1 * trial.step, 0.5 * trial.step));
    }
    None
}

/// The minimizer of the quadratic through φ(0), φ'(0) and the trial.
fn quadratic<S, T>(start: &Trial<S>, trial: &Trial<T>) -> f64 {
    let bend = trial.value - start.value - start.slope * trial.step;
    -0.5 * start.slope * trial.step * trial.step / bend
}

/// The minimizer of the cubic through φ(0), φ'(0) and the last two trials, each (α, φ(α)).
fn cubic<S>(start: &Trial<S>, (s, value_s): (f64, f64), (t, value_t): (f64, f64)) -> f64 {
    let [rest_s, rest_t] =
        [(s, value_s), (t, value_t)].map(|(step, value)| value - start.value - start.slope * step);
    let [scaled_s, scaled_t] = [rest_s / (s * s), rest_t / (t * t)];
    let a = (scaled_s - scaled_t) / (s - t);
    let b = (s * scaled_t - t * scaled_s) / (s - t);
    if a.abs() * s > 1e-12 * b.abs() {
        (-b + (b * b - 3.0 * a * start.slope).sqrt()) / (3.0 * a)
    } else {
        -0.5 * start.slope / b
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(value: impl Fn(f64) -> f64, step: f64, slope: f64) -> Trial<()> {
        Trial { step, value: value(step), slope, data: () }
    }

    #[test]
    fn the_models_have_the_minimizers_of_a_quadratic_and_a_cubic() {
        let parabola = |x: f64| 3.0 * x * x - 2.0 * x + 1.0;
        let start = at(parabola, 0.0, -2.0);
        assert!((quadratic(&start, &at(parabola, 4.0, 0.0)) - 1.0 / 3.0).abs() < 1e-14);
        let curve = |x: f64| x.powi(3) + x * x - 5.0 * x + 7.0;
        let start = at(curve, 0.0, -5.0);
        let minimizer = cubic(&start, (4.0, curve(4.0)), (6.0, curve(6.0)));
        assert!((minimizer - 1.0).abs() < 1e-12, "{minimizer}");
        let minimizer = cubic(&at(parabola, 0.0, -2.0), (4.0, parabola(4.0)), (6.0, parabola(6.0)));
        assert!((minimizer - 1.0 / 3.0).abs() < 1e-12, "{minimizer}");
    }

    #[test]
    fn backtracks_until_the_decrease_suffices() {
        for (first, barrier) in [(1e3, f64::INFINITY), (1e3, 0.7), (1e-3, f64::INFINITY)] {
            let value =
                |x: f64| if x < barrier { (x - 0.5).powi(2) + 0.1 * (5.0 * x).sin() } else { f64::NAN };
            let start = at(value, 0.0, -0.5);
            let trial = backtrack(&start, first, |step| at(value, step, 0.0)).expect("a step");
            assert!(trial.value < start.value && trial.step <= first);
        }
    }

    #[test]
    fn gives_up_where_nothing_decreases() {
        let start = at(|x| x, 0.0, -1.0);
        assert!(backtrack(&start, 1.0, |step| at(|x| x, step, 0.0)).is_none());
    }
}
