// SPDX-License-Identifier: MIT OR Apache-2.0
//! Energies of a map: values, gradients and the Laplacians that go with them.

pub(crate) mod mean_value;
pub mod spatial;
pub mod stretch;

pub use spatial::SpatialStretchEnergy;
pub use stretch::StretchEnergy;
