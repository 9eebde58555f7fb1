// SPDX-License-Identifier: MIT OR Apache-2.0
//! Data of a surface on the disk or the sphere that it was mapped to: at points, in pictures, on grids.

mod clipping;
mod conservative;
mod coverage;
mod grids;
mod icosphere;
mod inverse;
mod sampling;

pub use conservative::CellIntegrals;
pub use grids::Grid;
pub use icosphere::Icosphere;
pub use inverse::{InverseMap, Outside, Places, RefinedFaces};
pub use sampling::PerElement;
