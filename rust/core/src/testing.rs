// SPDX-License-Identifier: MIT OR Apache-2.0
//! Items for the integration tests; hidden, not part of the interface, may change at any time.

pub use crate::arrays::{rows, vectors};
pub use crate::distortion::{folded_in_plane, folded_on_sphere};
pub use crate::embedding::{Stop, progressive_disk, progressive_sphere, relaxed};
pub use crate::energy::stretch::{Profile, doubled_area};
pub use crate::energy::{SpatialStretchEnergy, StretchEnergy};
pub use crate::mesh::{TriangleMesh, consistent, geometry};
pub use crate::optimize::published::gradient_descent::{self, DescentOptions};
pub use crate::optimize::published::nonlinear_cg::{self, CgOptions};
pub use crate::optimize::published::{Energies, Objective, Stopping};
pub use crate::sparse::Laplacian;
pub use crate::vector::Vector3;
