// SPDX-License-Identifier: MIT OR Apache-2.0
//! Minimization of a function of one variable on an interval, without derivatives.
//!
//! Brent (1973), chapter 5, the method behind MATLAB's `fminbnd`, the first line search of Sutti & Yueh
//! (2024): golden sections, replaced by the minimizer of the parabola through the three best points wherever
//! that falls inside the interval and the steps shrink.
//!
//! The function may be +∞ or NaN; such a point never becomes the best. Cost: about a dozen evaluations for
//! three digits.

/// Limit of the evaluations.
const MAX_EVALUATIONS: usize = 60;

/// Width of the part that a golden section keeps off, (3 − √5)/2.
const GOLDEN: f64 = 0.381_966_011_250_105_1;

/// A point with its value.
#[derive(Clone, Copy)]
struct Point {
    x: f64,
    value: f64,
}

/// The point of `[0, end]` where Brent's method finds the smallest value, to within `tolerance`.
pub(super) fn minimize(end: f64, tolerance: f64, mut function: impl FnMut(f64) -> f64) -> f64 {
    let mut sample = |x: f64| {
        let value = function(x);
        Point { x, value: if value.is_nan() { f64::INFINITY } else { value } }
    };
    let (mut low, mut high) = (0.0, end);
    // 1. The best point and two earlier ones; the interval ends before values that are not finite
    let mut best = sample(GOLDEN * end);
    for _ in 1..MAX_EVALUATIONS {
        if best.value.is_finite() {
            break;
        }
        high = best.x;
        best = sample(GOLDEN * high);
    }
    let (mut second, mut third) = (best, best);
    let (mut last, mut before_last) = (0.0f64, 0.0f64);
    for _ in 1..MAX_EVALUATIONS {
        let middle = 0.5 * (low + high);
        if (best.x - middle).abs() <= 2.0 * tolerance - 0.5 * (high - low) {
            break;
        }
        // 2. A parabolic step where it is inside and less than half the step before the last, else a section
        let parabolic = parabolic_step(best, second, third)
            .filter(|step| step.abs() < 0.5 * before_last.abs())
            .filter(|step| low < best.x + step && best.x + step < high);
        (before_last, last) = match parabolic {
            Some(step) => (last, away_from_ends(step, best.x, low, high, tolerance)),
            None => {
                let span = if best.x < middle { high - best.x } else { low - best.x };
                (span, GOLDEN * span)
            }
        };
        let tried = sample(best.x + last.abs().max(tolerance).copysign(last));
        // 3. Shrink the interval around the best point
        if tried.value <= best.value {
            *(if tried.x < best.x { &mut high } else { &mut low }) = best.x;
            (third, second, best) = (second, best, tried);
        } else {
            *(if tried.x < best.x { &mut low } else { &mut high }) = tried.x;
            if tried.value <= second.value || second.x == best.x {
                (third, second) = (second, tried);
            } else if tried.value <= third.value || third.x == best.x || third.x == second.x {
                third = tried;
            }
        }
    }
    best.x
}

/// The step from the best point to the minimizer of the parabola through all three; `None` where there is none.
fn parabolic_step(best: Point, second: Point, third: Point) -> Option<f64> {
    let [to_second, to_third] = [second, third].map(|point| best.x - point.x);
    let r = to_second * (best.value - third.value);
    let q = to_third * (best.value - second.value);
    let step = -0.5 * (to_third * q - to_second * r) / (q - r);
    step.is_finite().then_some(step)
}

/// A step that lands within two tolerances of an end goes one tolerance toward the middle instead.
fn away_from_ends(step: f64, best: f64, low: f64, high: f64, tolerance: f64) -> f64 {
    let to = best + step;
    if to - low < 2.0 * tolerance || high - to < 2.0 * tolerance {
        tolerance.copysign(0.5 * (low + high) - best)
    } else {
        step
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn minimum(end: f64, function: impl Fn(f64) -> f64) -> (f64, usize) {
        let mut calls = 0;
        let minimizer = minimize(end, 1e-6 * end, |x| {
            calls += 1;
            function(x)
        });
        (minimizer, calls)
    }

    #[test]
    fn finds_minima_inside() {
        let (x, calls) = minimum(10.0, |x| (x - 3.0).powi(2));
        assert!((x - 3.0).abs() < 1e-5 && calls < 15, "{x} after {calls}");
        let (x, calls) = minimum(2.0, |x| x.powi(4) - x);
        assert!((x - 0.25f64.cbrt()).abs() < 1e-5 && calls < 25, "{x} after {calls}");
        let (x, calls) = minimum(3.0, |x| (x - 1.3).abs());
        assert!((x - 1.3).abs() < 1e-5 && calls < 60, "{x} after {calls}");
    }

    #[test]
    fn finds_minima_at_the_ends() {
        assert!(minimum(4.0, |x| x).0 < 1e-4);
        assert!(minimum(4.0, |x| -x).0 > 4.0 - 1e-4);
    }

    #[test]
    fn points_that_are_not_allowed_are_left() {
        let (x, _) = minimum(8.0, |x| if x < 1.0 { -x } else { f64::INFINITY });
        assert!((0.9..1.0).contains(&x), "{x}");
        let (x, _) = minimum(8.0, |x| if x < 1.0 { (x - 0.4).powi(2) } else { f64::NAN });
        assert!((x - 0.4).abs() < 1e-4, "{x}");
    }
}
