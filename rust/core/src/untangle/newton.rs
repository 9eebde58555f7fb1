// SPDX-License-Identifier: MIT OR Apache-2.0
//! Projected Newton steps for a sum of energies of the faces of a patch.
//!
//! The Hessian of every face is exact with its negative eigenvalues set to zero, so that the direction descends; a step is
//! halved until the energy falls. Cost of a step: one sparse Cholesky factorization, a few passes over the faces.

use super::patch::Patch;
use crate::control::Watch;
use crate::error::Error;
use crate::parallel;
use crate::sparse::{Analysis, Factor, Failure, Order};

/// The Hessian of a face by the coordinates of its corners.
pub(super) type Hessian = [[f64; 6]; 6];

/// The corners of a face in the chart of a patch.
pub(super) type Corners = [[f64; 2]; 3];

/// The slope's share that a step must gain.
const SUFFICIENT: f64 = 1e-4;

/// Steps tried along one direction.
const MOST_TRIALS: usize = 40;

/// What is added to the diagonal of the Hessian, in units of itself.
const SHIFT: f64 = 1e-9;

/// What a face costs.
pub(super) trait FaceEnergy: Sync {
    /// The energy of a face; infinite where it is not allowed.
    fn value(&self, face: usize, corners: Corners) -> f64;

    /// Its gradient and Hessian, the latter positive semidefinite.
    fn derivatives(&self, face: usize, corners: Corners) -> ([f64; 6], Hessian);
}

/// Newton's method on one patch.
pub(super) struct Newton<'a> {
    patch: &'a Patch,
    analysis: Analysis,
    factor: Factor<f64>,
}

/// One step.
pub(super) struct Step {
    /// The places after it.
    pub places: Vec<[f64; 2]>,
    /// The energy after it.
    pub value: f64,
    /// What the direction promised: minus the directional derivative.
    pub decrement: f64,
}

impl<'a> Newton<'a> {
    /// Analyzes the systems of a patch.
    pub(super) fn new(patch: &'a Patch) -> Result<Self, Error> {
        let unknowns: Vec<u8> = patch.is_free.iter().map(|&is_free| if is_free { 2 } else { 0 }).collect();
        let analysis = Analysis::new(unknowns.len(), &patch.faces, &unknowns, Order::Sparse)?;
        let factor = Factor::new(&analysis);
        Ok(Self { patch, analysis, factor })
    }

    /// The energy of places.
    pub(super) fn value(&self, energy: &dyn FaceEnergy, places: &[[f64; 2]]) -> f64 {
        parallel::sum(self.patch.faces.len(), |face| energy.value(face, self.patch.corners(places, face)))
    }

    /// The step from `places`, where the energy is `value`; `None` where none lowers it.
    ///
    /// # Errors
    /// [`Error::CancelledEarly`] by the watch.
    pub(super) fn step(
        &mut self,
        energy: &dyn FaceEnergy,
        places: &[[f64; 2]],
        value: f64,
        watch: &Watch<'_>,
    ) -> Result<Option<Step>, Error> {
        // 1. The direction
        let Some((direction, decrement)) = self.direction(energy, places, watch)? else { return Ok(None) };
        // 2. The longest of the halved steps that lowers the energy enough
        let mut length = 1.0;
        for _ in 0..MOST_TRIALS {
            let trial = self.moved(places, &direction, length);
            let reached = self.value(energy, &trial);
            if reached <= value - SUFFICIENT * length * decrement {
                return Ok(Some(Step { places: trial, value: reached, decrement }));
            }
            length *= 0.5;
        }
        Ok(None)
    }

    /// The solution of the Newton system with what it promises.
    fn direction(
        &mut self,
        energy: &dyn FaceEnergy,
        places: &[[f64; 2]],
        watch: &Watch<'_>,
    ) -> Result<Option<(Vec<f64>, f64)>, Error> {
        if !watch.goes_on() {
            return Err(Error::CancelledEarly);
        }
        let derivatives = parallel::map(self.patch.faces.len(), |face| {
            let (gradient, mut hessian) = energy.derivatives(face, self.patch.corners(places, face));
            (0..6).for_each(|k| hessian[k][k] += SHIFT * hessian[k][k] + f64::MIN_POSITIVE);
            (gradient, hessian)
        });
        let mut gradient = vec![0.0; self.analysis.n_unknowns()];
        for (face, (slopes, _)) in self.patch.faces.iter().zip(&derivatives) {
            for (k, &slope) in slopes.iter().enumerate() {
                let vertex = face[k / 2] as usize;
                if self.patch.is_free[vertex] {
                    gradient[self.analysis.first_unknown(vertex) + k % 2] -= slope;
                }
            }
        }
        let element = |face: usize| derivatives[face].1;
        match self.factor.refactor(&self.analysis, &element, watch) {
            Ok(()) => {}
            Err(Failure::Cancelled) => return Err(Error::CancelledEarly),
            Err(Failure::NotPositiveDefinite) => return Ok(None),
        }
        let mut direction = gradient.clone();
        self.factor.solve(&self.analysis, &mut direction);
        let decrement = parallel::dot(&gradient, &direction);
        Ok((decrement >= 0.0 && decrement.is_finite()).then_some((direction, decrement)))
    }

    fn moved(&self, places: &[[f64; 2]], direction: &[f64], length: f64) -> Vec<[f64; 2]> {
        parallel::map(places.len(), |vertex| {
            if !self.patch.is_free[vertex] {
                return places[vertex];
            }
            let first = self.analysis.first_unknown(vertex);
            [0, 1].map(|axis| places[vertex][axis] + length * direction[first + axis])
        })
    }
}

/// Twice the signed area of a face, and its gradient by the coordinates of the corners.
pub(super) fn doubled_area([a, b, c]: Corners) -> (f64, [f64; 6]) {
    let doubled = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    (doubled, [b[1] - c[1], c[0] - b[0], c[1] - a[1], a[0] - c[0], a[1] - b[1], b[0] - a[0]])
}

/// Adds `factor` times the Hessian of twice the signed area of a face.
pub(super) fn add_area_curvature(hessian: &mut Hessian, factor: f64) {
    for corner in 0..3 {
        let next = (corner + 1) % 3;
        for (i, j, sign) in [(0, 1, 1.0), (1, 0, -1.0)] {
            hessian[2 * corner + i][2 * next + j] += sign * factor;
            hessian[2 * next + j][2 * corner + i] += sign * factor;
        }
    }
}

/// Adds the positive semidefinite part of minus `factor` ≥ 0 times the same Hessian.
///
/// In complex coordinates the area of a triangle is diagonal in the Fourier modes of its corners: mode 1, the
/// counter-clockwise equilateral triangle, has the eigenvalue √3, mode 2 has −√3, and translations have 0.
pub(super) fn add_less_area_curvature(hessian: &mut Hessian, factor: f64) {
    let eigenvalue = factor * 3f64.sqrt() / 3.0;
    // cosine and sine of two thirds of a turn times the difference of the corners
    let turns = [[1.0, 0.0], [-0.5, -0.5 * 3f64.sqrt()], [-0.5, 0.5 * 3f64.sqrt()]];
    for a in 0..3 {
        for b in 0..3 {
            let [cosine, sine] = turns[(3 + a - b) % 3].map(|x| eigenvalue * x);
            hessian[2 * a][2 * b] += cosine;
            hessian[2 * a + 1][2 * b + 1] += cosine;
            hessian[2 * a][2 * b + 1] -= sine;
            hessian[2 * a + 1][2 * b] += sine;
        }
    }
}

/// Adds `factor` (u vᵀ + v uᵀ)/2.
pub(super) fn add_symmetric(hessian: &mut Hessian, factor: f64, u: &[f64; 6], v: &[f64; 6]) {
    for row in 0..6 {
        (0..6).for_each(|column| {
            hessian[row][column] += 0.5 * factor * (u[row] * v[column] + v[row] * u[column])
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::clamp_negative_eigenvalues;

    #[test]
    fn the_curvature_of_areas_is_that_of_differences_and_splits_into_two_parts() {
        let mut hessian = [[0.0; 6]; 6];
        add_area_curvature(&mut hessian, 1.0);
        let corners = [[0.1, 0.2], [1.3, 0.1], [0.4, 1.5]];
        let (_, gradient) = doubled_area(corners);
        for k in 0..6 {
            let mut moved = corners;
            moved[k / 2][k % 2] += 1.0;
            let (_, there) = doubled_area(moved);
            (0..6).for_each(|j| assert!((there[j] - gradient[j] - hessian[j][k]).abs() < 1e-14));
        }
        let mut clamped = hessian.map(|row| row.map(|x| -x));
        clamp_negative_eigenvalues(&mut clamped);
        let mut direct = [[0.0; 6]; 6];
        add_less_area_curvature(&mut direct, 1.0);
        for row in 0..6 {
            (0..6).for_each(|column| assert!((clamped[row][column] - direct[row][column]).abs() < 1e-11));
        }
    }
}
