// SPDX-License-Identifier: MIT OR Apache-2.0
//! Energies of a map: values, gradients and the Laplacians that go with them.

pub(crate) mod authalic;
pub(crate) mod landmark_penalty;
pub(crate) mod mean_value;
pub(crate) mod motion;
pub mod spatial;
pub mod stretch;

pub use spatial::SpatialStretchEnergy;
pub use stretch::StretchEnergy;
