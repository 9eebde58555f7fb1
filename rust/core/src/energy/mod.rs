// SPDX-License-Identifier: MIT OR Apache-2.0
//! Energies of a map: values, gradients and the Laplacians that go with them.

pub mod stretch;

pub use stretch::StretchEnergy;
