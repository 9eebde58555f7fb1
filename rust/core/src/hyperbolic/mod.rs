// SPDX-License-Identifier: MIT OR Apache-2.0
//! Registration of surfaces of genus 0 by landmark curves (Shi et al. 2013): a homeomorphism that takes curve
//! to curve.
//!
//! Both surfaces are sliced along the curves, which leaves spheres with holes. For three and more holes there
//! is one hyperbolic metric in each conformal class with geodesic boundaries, and into such a metric the
//! harmonic map is a diffeomorphism whatever the boundary values (theorem 3.4). [`register_hyperbolic`]
//! computes it:
//!
//! 1. `curves`, `placement`, `pieces`: what the surfaces are cut along, roughly laid over each other;
//! 2. `arcs`, `slice`: a chain of arcs through all features, carried along by an isotopy (`isotopy`), says
//!    which homotopy class is meant;
//! 3. `metric`: the hyperbolic metrics, by Newton or by the paper's Ricci flow (`ricci_flow`);
//! 4. `atlas`, `layout`, `initial`: local charts and a first homeomorphism;
//! 5. `delaunay`, `harmonic`: the harmonic map by Newton, or by the paper's heat diffusion (`heat`);
//! 6. `certificates`: the proof that it is one-to-one; `warnings`: signs that it is not what was meant.
//!
//! Pieces with one or two features are `flat`. [`hyperbolic_structure`] gives the paper's other objects: the
//! Fuchsian group (`fuchsian`), pants and hexagons (`pants`) and closed geodesics (`trace`).
//!
//! Input: two [`TriangleMesh`](crate::mesh::TriangleMesh)es and pairs of [`Curves`]. Cost: some twenty sparse
//! factorisations.

mod features;
mod harmonic;
mod metric;
pub mod moebius;
mod register;
#[cfg(test)]
mod sample_meshes;
mod slice;
mod structure;
#[cfg(test)]
mod tests;
mod warnings;

use crate::error::Error;
use crate::vector::Vector;

pub use features::curves::Curves;
pub use harmonic::certificates::Certificates;
pub use harmonic::newton::Descent;
pub use metric::{FlowOptions, FlowRecord, Metric, MetricMethod};
pub use register::{CurveRegistration, register_hyperbolic};
pub use structure::fuchsian::CoverCopy;
pub use structure::pants::Pants;
pub use structure::{HyperbolicStructure, hyperbolic_structure};
pub use warnings::{Warning, WarningKind};

/// How the harmonic energy is minimised.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Solver {
    /// Riemannian Newton: to the minimum in a few steps.
    #[default]
    Newton,
    /// The paper's heat diffusion: thousands of small steps towards it.
    Heat,
}

/// Options of [`register_hyperbolic`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HyperbolicOptions<'a> {
    /// How the hyperbolic metrics are computed.
    pub metric: MetricMethod,
    /// How the harmonic energy is minimised.
    pub solver: Solver,
    /// Steps of the heat diffusion at the most.
    pub heat_steps: usize,
    /// The heat diffusion ends where no component of the gradient is larger.
    pub heat_tolerance: f64,
    /// The vertices of source and target on spheres around the origin, from which it is told how the surfaces
    /// lie over each other; conformal maps where `None`. They need not be aligned.
    pub spheres: Option<[&'a [Vector]; 2]>,
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
    fn check(&self) -> Result<(), Error> {
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
