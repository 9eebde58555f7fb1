// SPDX-License-Identifier: MIT OR Apache-2.0
//! The papers' optimizers. They know a map only through its [`Objective`], so that the disk and the sphere share them.

mod bounded;
pub mod gradient_descent;
mod interpolation;
pub mod line_search;
pub mod nonlinear_cg;

use crate::control::{Observer, Status};

/// The end of an optimizer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stopping {
    /// Iteration limit; by default the paper's 50.
    pub max_iterations: usize,
    /// The optimizer has converged when √(gᵀM⁻¹g) is below this. 10⁻⁸ is beyond the reach of 50 iterations, so that it
    /// stops only runs that have nothing left to gain.
    pub tolerance: f64,
}

impl Default for Stopping {
    fn default() -> Self {
        Self { max_iterations: 50, tolerance: 1e-8 }
    }
}

impl Stopping {
    /// Reports progress after `done` iterations; the status with which to end, if any.
    pub(crate) fn verdict(
        &self,
        done: usize,
        gradient_norm: f64,
        message: &str,
        observer: &mut dyn Observer,
    ) -> Option<Status> {
        if gradient_norm <= self.tolerance {
            Some(Status::Converged)
        } else if done >= self.max_iterations {
            Some(Status::MaxIterations)
        } else if observer.progress(done as f64 / self.max_iterations as f64, message) {
            None
        } else {
            Some(Status::Cancelled)
        }
    }
}

/// The energies of a map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Energies {
    /// The objective to minimize; +∞ where the map is not allowed.
    pub objective: f64,
    /// E_A, as reported in histories.
    pub authalic_energy: f64,
}

/// What is minimized over a space of maps, as an optimizer sees it.
///
/// Directions, gradients and preconditioned gradients are vectors in coordinates of the space of maps, in which the
/// retraction starts as a straight line: one number per degree of freedom on the disk, three per vertex,
/// tangent to the sphere, on the sphere.
pub trait Objective {
    /// A map.
    type Map: Clone;

    /// The objective at `map`; +∞ where the map is not allowed.
    fn value(&self, map: &Self::Map) -> f64;

    /// The energies at `map` and the gradient of the objective in reduced coordinates.
    fn gradient(&self, map: &Self::Map) -> (Energies, Vec<f64>);

    /// M⁻¹ `gradient` at `map`, M symmetric positive definite.
    fn precondition(&self, map: &Self::Map, gradient: &[f64]) -> Vec<f64>;

    /// The map reached from `map` along `direction` after `step`.
    fn retract(&self, map: &Self::Map, direction: &[f64], step: f64) -> Self::Map;
}
