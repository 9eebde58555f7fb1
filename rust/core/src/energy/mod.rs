// SPDX-License-Identifier: MIT OR Apache-2.0
//! Energies of a map: values, gradients and the Laplacians that go with them.

pub(crate) mod authalic;
mod hessian;
pub(crate) mod landmark_penalty;
pub(crate) mod mean_value;
mod psd;
pub mod spatial;
pub mod stretch;

pub(crate) use authalic::rest_cotangents;
pub use hessian::{SparseColumns, stretch_hessian};
pub(crate) use psd::clamp_negative_eigenvalues;
pub use spatial::SpatialStretchEnergy;
pub use stretch::StretchEnergy;
