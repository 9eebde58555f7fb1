// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options of a registration by curves, and their check.

use super::metric::MetricMethod;
use crate::error::Error;
use crate::vector::Vector3;

/// The method that minimizes the harmonic energy.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Solver {
    /// Riemannian Newton: reaches the minimum in a few steps.
    #[default]
    Newton,
    /// The paper's heat diffusion: thousands of small steps towards the minimum.
    Heat,
}

/// Options of [`register_hyperbolic`](super::register_hyperbolic).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HyperbolicOptions<'a> {
    /// The method that computes the hyperbolic metrics.
    pub metric: MetricMethod,
    /// The method that minimizes the harmonic energy.
    pub solver: Solver,
    /// Most steps of the heat diffusion.
    pub heat_steps: usize,
    /// Largest component of the gradient at which the heat diffusion ends.
    pub heat_tolerance: f64,
    /// The vertices of source and target on spheres around the origin, which lay the surfaces over each other; they
    /// need not be aligned. `None`: conformal maps.
    pub spheres: Option<[&'a [Vector3]; 2]>,
}

impl Default for HyperbolicOptions<'_> {
    fn default() -> Self {
        Self {
            metric: MetricMethod::default(),
            solver: Solver::default(),
            heat_steps: 2000,
            heat_tolerance: 1e-6,
            spheres: None,
        }
    }
}

impl HyperbolicOptions<'_> {
    pub(super) fn check(&self) -> Result<(), Error> {
        if !(self.heat_tolerance >= 0.0 && self.heat_tolerance.is_finite()) {
            return Err(Error::InvalidOption {
                name: "tolerance",
                found: self.heat_tolerance.to_string(),
                expected: "a finite number ≥ 0".into(),
            });
        }
        Ok(())
    }
}
