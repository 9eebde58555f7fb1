// SPDX-License-Identifier: MIT OR Apache-2.0
//! Registration of surfaces of genus 0 by landmark curves (Shi et al. 2013): a homeomorphism that takes curve
//! to curve.
//!
//! Both surfaces are sliced along the curves, which leaves spheres with holes. With three or more holes each
//! conformal class has one hyperbolic metric with geodesic boundaries, and the harmonic map into such a metric
//! is a diffeomorphism whatever the boundary values (theorem 3.4). [`register_hyperbolic`] computes it:
//!
//! 1. `curves`, `placement`, `pieces`: the features along which the surfaces are cut, and a rough placement of
//!    the surfaces over each other;
//! 2. `arcs`, `slice`: a chain of arcs through all features, carried along by an isotopy (`isotopy`), determines
//!    the homotopy class;
//! 3. `metric`: the hyperbolic metrics, by Newton or by the paper's Ricci flow (`ricci_flow`);
//! 4. `atlas`, `layout`, `initial`: local charts and a first homeomorphism;
//! 5. `delaunay`, `harmonic`: the harmonic map by Newton, or by the paper's heat diffusion (`heat`);
//! 6. `certificates`: the proof that the map is one-to-one; `warnings`: signs of curves that were not meant so.
//!
//! Pieces with one or two features are mapped by `flat`. [`hyperbolic_structure`] has the paper's other objects: the
//! Fuchsian group (`fuchsian`), pants and hexagons (`pants`) and closed geodesics (`trace`).
//!
//! Input: two [`TriangleMesh`](crate::mesh::TriangleMesh)es and [`LandmarkCurves`]. Cost: some twenty sparse
//! factorizations.

mod assembly;
mod between;
mod features;
mod filling;
mod harmonic;
mod metric;
pub(crate) mod moebius;
mod options;
mod record;
mod register;
#[cfg(test)]
mod sample_meshes;
mod slice;
mod structure;
#[cfg(test)]
mod tests;
mod warnings;

pub use assembly::{CurveMap, CurveRegistration, RoughSphere};
pub use features::curves::LandmarkCurves;
pub use harmonic::certificates::Certificates;
pub use harmonic::newton::Descent;
pub use metric::{FlowOptions, MetricMethod};
pub use moebius::{Complex, Moebius};
pub use options::{HarmonicSolver, HyperbolicEnergy, HyperbolicOptions};
pub use register::register_hyperbolic;
pub use structure::fuchsian::{CoverCopy, cover};
pub use structure::pants::Pants;
pub use structure::{HyperbolicStructure, hyperbolic_structure};
pub use warnings::{Warning, WarningKind};
