// SPDX-License-Identifier: MIT OR Apache-2.0
//! Projected Newton steps for a sum of energies of the faces of a patch.
//!
//! The Hessian of every face is exact with its negative eigenvalues set to zero, so that the direction descends; a step
//! is halved until the energy falls. Cost of a step: one sparse Cholesky factorization, a few passes over the faces.

use super::patch::Patch;
use super::triangle::{Corners, Hessian};
use crate::control::Watch;
use crate::error::Error;
use crate::parallel;
use crate::sparse::{Analysis, Factor, Failure, Order};

/// Armijo's constant: the part of the linear decrease that a step must gain.
const SUFFICIENT: f64 = 1e-4;

/// Most steps tried along one direction.
const MOST_TRIALS: usize = 40;

/// Relative increase of the diagonal of the Hessian.
const SHIFT: f64 = 1e-9;

/// An energy of faces.
pub(super) trait FaceEnergy: Sync {
    /// The energy of a face; infinite if the face is not allowed.
    fn value(&self, face: usize, corners: Corners) -> f64;

    /// The gradient and the Hessian of the energy, the latter positive semidefinite.
    fn derivatives(&self, face: usize, corners: Corners) -> ([f64; 6], Hessian);
}

/// Newton's method on one patch.
pub(super) struct Newton<'a> {
    patch: &'a Patch,
    analysis: Analysis,
    factor: Factor<f64>,
}

/// A Newton step.
pub(super) struct Step {
    /// The places after it.
    pub places: Vec<[f64; 2]>,
    /// The energy after it.
    pub value: f64,
    /// Minus the directional derivative.
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

    /// The step from `places`, where the energy is `value`; `None` if no step lowers it.
    ///
    /// # Errors
    /// [`Error::CancelledEarly`] if cancelled.
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

    /// The Newton direction and its decrement; `None` if it does not descend.
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
                let vertex = face[k / 2];
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
