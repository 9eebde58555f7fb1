// SPDX-License-Identifier: MIT OR Apache-2.0
//! A map without folds from any map with the same held vertices.
//!
//! Garanzha, Kaporin, Kudryavtseva, Protais, Ray & Sokolov, Foldover-free maps in 50 lines of code (2021). With J the
//! linear map of a face from its rest shape, D = det J and
//!
//! ```text
//! f = (½ tr JᵀJ + D² + 1) / χ(D),     χ(D) = ½ (D + √(ε² + D²)),
//! ```
//!
//! the sum over the faces is finite on folded maps as long as ε > 0. The ε falls from step to step by the paper's rule,
//! so that folded faces become ever more expensive.
//!
//! Cost: one factorization of the patch for each of up to [`ITERATIONS`] steps, a dozen as a rule.

use super::newton::{FaceEnergy, Newton};
use super::patch::Patch;
use super::triangle::{Corners, Hessian, add_area_curvature, add_symmetric, doubled_area};
use crate::control::Watch;
use crate::energy::clamp_negative_eigenvalues;
use crate::error::Error;

/// Most steps.
const ITERATIONS: usize = 120;

/// Steps after which the search ends if the faces that miss their goals have not become fewer.
const PATIENCE: usize = 20;

/// [`PATIENCE`] of the last attempt.
const LAST_PATIENCE: usize = 60;

/// Initial ε.
const FIRST_REGULARIZATION: f64 = 1.0;

/// Least relative fall of ε in a step.
const LEAST_FALL: f64 = 0.1;

/// The regularized energy for one ε.
struct Regularized<'a> {
    patch: &'a Patch,
    /// Cotangents of the rest shapes.
    cotangents: &'a [[f64; 3]],
    regularization: f64,
}

/// The energy of springs, whose minimum is Tutte's embedding.
pub(super) struct Springs;

impl FaceEnergy for Springs {
    fn value(&self, _face: usize, corners: Corners) -> f64 {
        quadratic(corners, [0.5; 3]).0
    }

    fn derivatives(&self, _face: usize, corners: Corners) -> ([f64; 6], Hessian) {
        let (_, gradient) = quadratic(corners, [0.5; 3]);
        let mut hessian = [[0.0; 6]; 6];
        add_quadratic(&mut hessian, 1.0, [0.5; 3]);
        (gradient, hessian)
    }
}

/// Moves the vertices from `start` until every face has its least area, or the search ends; returns the last places.
///
/// # Errors
/// [`Error::CancelledEarly`] if cancelled.
pub(super) fn unfold(
    newton: &mut Newton<'_>,
    patch: &Patch,
    cotangents: &[[f64; 3]],
    start: Vec<[f64; 2]>,
    is_last: bool,
    watch: &Watch<'_>,
) -> Result<Vec<[f64; 2]>, Error> {
    let mut energy = Regularized { patch, cotangents, regularization: FIRST_REGULARIZATION };
    let mut places = start;
    let patience = if is_last { LAST_PATIENCE } else { PATIENCE };
    let mut fewest = (usize::MAX, 0);
    for iteration in 0..ITERATIONS {
        let missing = patch.misses(&places);
        if missing < fewest.0 {
            fewest = (missing, iteration);
        }
        if missing == 0 || iteration >= fewest.1 + patience {
            break;
        }
        // 1. A step for this ε
        let value = newton.value(&energy, &places);
        let mut fall = LEAST_FALL;
        if let Some(step) = newton.step(&energy, &places, value, watch)? {
            fall = (1.0 - step.value / value).max(LEAST_FALL);
            places = step.places;
        }
        // 2. The next ε
        let (epsilon, least) = (energy.regularization, patch.least_ratio(&places));
        let root = (least * least + epsilon * epsilon).sqrt();
        let factor = if least < 0.0 { 1.0 - fall * root / (least.abs() + root) } else { 1.0 - fall };
        energy.regularization = (epsilon * factor).max(1e-12);
    }
    Ok(places)
}

impl Regularized<'_> {
    /// χ(D) and its first two derivatives.
    fn chi(&self, d: f64) -> [f64; 3] {
        let epsilon = self.regularization;
        let root = (epsilon * epsilon + d * d).sqrt();
        // without cancellation for negative D
        let chi = if d > 0.0 { 0.5 * (d + root) } else { 0.5 * epsilon * epsilon / (root - d) };
        [chi, chi / root, 0.5 * epsilon * epsilon / (root * root * root)]
    }
}

impl FaceEnergy for Regularized<'_> {
    fn value(&self, face: usize, corners: Corners) -> f64 {
        let share = self.patch.shares[face];
        let stretch = quadratic(corners, self.cotangents[face]).0 / share;
        let d = 0.5 * doubled_area(corners).0 / share;
        share * (0.5 * stretch + d * d + 1.0) / self.chi(d)[0]
    }

    fn derivatives(&self, face: usize, corners: Corners) -> ([f64; 6], Hessian) {
        let share = self.patch.shares[face];
        let (stretch, by_stretch) = quadratic(corners, self.cotangents[face]);
        let (doubled, by_doubled) = doubled_area(corners);
        let d = 0.5 * doubled / share;
        let by_d: [f64; 6] = by_doubled.map(|slope| 0.5 * slope / share);
        let [chi, first, second] = self.chi(d);
        // 1. The outer derivatives of n/χ, n = ½ stretch + D² + 1, by the stretch and by D
        let numerator = 0.5 * stretch / share + d * d + 1.0;
        let outer_stretch = 0.5 / share / chi;
        let outer_d = 2.0 * d / chi - numerator * first / (chi * chi);
        let mixed = -0.5 / share * first / (chi * chi);
        let twice_d = 2.0 / chi - 4.0 * d * first / (chi * chi) - numerator * second / (chi * chi)
            + 2.0 * numerator * first * first / (chi * chi * chi);
        // 2. The chain rule
        let gradient = std::array::from_fn(|k| share * (outer_stretch * by_stretch[k] + outer_d * by_d[k]));
        let mut hessian = [[0.0; 6]; 6];
        add_quadratic(&mut hessian, share * outer_stretch, self.cotangents[face]);
        add_symmetric(&mut hessian, 2.0 * share * mixed, &by_stretch, &by_d);
        add_symmetric(&mut hessian, share * twice_d, &by_d, &by_d);
        add_area_curvature(&mut hessian, 0.5 * outer_d);
        clamp_negative_eigenvalues(&mut hessian);
        (gradient, hessian)
    }
}

/// ½ Σ weight_c |edge opposite to c|² and its gradient.
fn quadratic(corners: Corners, weights: [f64; 3]) -> (f64, [f64; 6]) {
    let (mut value, mut gradient) = (0.0, [0.0; 6]);
    for (c, weight) in weights.into_iter().enumerate() {
        let (from, to) = ((c + 1) % 3, (c + 2) % 3);
        for axis in 0..2 {
            let along = corners[to][axis] - corners[from][axis];
            value += 0.5 * weight * along * along;
            gradient[2 * to + axis] += weight * along;
            gradient[2 * from + axis] -= weight * along;
        }
    }
    (value, gradient)
}

/// Adds `factor` times the Hessian of ½ Σ weight_c |edge opposite to c|².
fn add_quadratic(hessian: &mut Hessian, factor: f64, weights: [f64; 3]) {
    for (c, weight) in weights.into_iter().enumerate() {
        let (from, to) = ((c + 1) % 3, (c + 2) % 3);
        for axis in 0..2 {
            let [i, j] = [2 * from + axis, 2 * to + axis];
            hessian[i][i] += factor * weight;
            hessian[j][j] += factor * weight;
            hessian[i][j] -= factor * weight;
            hessian[j][i] -= factor * weight;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::untangle::patch::tests::one_face;

    #[test]
    fn gradient_and_hessian_are_the_differences_of_the_value_where_the_energy_is_convex() {
        let patch = one_face();
        let cotangents = [[0.4, 0.9, 0.5]];
        let energy = Regularized { patch: &patch, cotangents: &cotangents, regularization: 0.3 };
        for corners in [[[0.1, 0.2], [1.3, 0.1], [0.4, 1.5]], [[0.1, 0.2], [1.3, 0.1], [0.4, -0.2]]] {
            let (gradient, _) = energy.derivatives(0, corners);
            for k in 0..6 {
                let moved = |h: f64| {
                    let mut corners = corners;
                    corners[k / 2][k % 2] += h;
                    corners
                };
                let difference = (energy.value(0, moved(1e-6)) - energy.value(0, moved(-1e-6))) / 2e-6;
                assert!((gradient[k] - difference).abs() < 1e-6 * (1.0 + difference.abs()), "{k}");
            }
        }
    }
}
