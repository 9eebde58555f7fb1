// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options of a registration by curves, and their check.

use ndarray::ArrayView2;

use super::metric::MetricMethod;
use crate::arrays::rows_of;
use crate::error::Error;
use crate::vector::Vector3;

/// The method that minimizes the harmonic energy.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum HarmonicSolver {
    /// Riemannian Newton: reaches the minimum in a few steps.
    #[default]
    Newton,
    /// The paper's heat diffusion: thousands of small steps toward the minimum.
    Heat,
}

/// Options of [`register_hyperbolic`](super::register_hyperbolic).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HyperbolicOptions<'a> {
    /// The method that computes the hyperbolic metrics.
    pub metric: MetricMethod,
    /// The method that minimizes the harmonic energy.
    pub solver: HarmonicSolver,
    /// Most steps of the heat diffusion.
    pub heat_steps: usize,
    /// Largest component of the gradient at which the heat diffusion ends.
    pub heat_tolerance: f64,
    /// The vertices of source and target on spheres around the origin, which lay the surfaces over each other; they
    /// need not be aligned. `None`: conformal maps.
    pub spheres: Option<[ArrayView2<'a, f64>; 2]>,
}

impl Default for HyperbolicOptions<'_> {
    fn default() -> Self {
        Self {
            metric: MetricMethod::default(),
            solver: HarmonicSolver::default(),
            heat_steps: 2000,
            heat_tolerance: 1e-6,
            spheres: None,
        }
    }
}

impl HyperbolicOptions<'_> {
    /// The spheres as vectors.
    pub(super) fn sphere_vectors(&self) -> Result<Option<[Vec<Vector3>; 2]>, Error> {
        let Some([source, target]) = self.spheres else { return Ok(None) };
        let vectors = |name, array| {
            Ok::<_, Error>(rows_of::<3, _>(name, array)?.iter().copied().map(Vector3).collect())
        };
        Ok(Some([vectors("source_sphere", source)?, vectors("target_sphere", target)?]))
    }

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
