// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options of a registration by curves, and their check.

use super::metric::MetricMethod;
use crate::error::Error;
use crate::vector::Vector3;

/// How the harmonic energy is minimized.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Solver {
    /// Riemannian Newton: to the minimum in a few steps.
    #[default]
    Newton,
    /// The paper's heat diffusion: thousands of small steps towards it.
    Heat,
}

/// Options of [`register_hyperbolic`](super::register_hyperbolic).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HyperbolicOptions<'a> {
    /// How the hyperbolic metrics are computed.
    pub metric: MetricMethod,
    /// How the harmonic energy is minimized.
    pub solver: Solver,
    /// Steps of the heat diffusion at the most.
    pub heat_steps: usize,
    /// The heat diffusion ends where no component of the gradient is larger.
    pub heat_tolerance: f64,
    /// The vertices of source and target on spheres around the origin, from which it is told how the surfaces
    /// lie over each other; conformal maps where `None`. They need not be aligned.
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
