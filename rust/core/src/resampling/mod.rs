// SPDX-License-Identifier: MIT OR Apache-2.0
//! Data of a surface on the disk or the sphere that it was mapped to: at points, in pictures, on grids.

mod inverse;
mod sampling;

pub use inverse::{InverseMap, Outside, Places, RefinedFaces};
pub use sampling::PerElement;
