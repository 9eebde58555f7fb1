// SPDX-License-Identifier: MIT OR Apache-2.0
//! Bindings of the registrations by points and by curves.

mod certificates;
mod curves;
mod features;
mod finished;
mod morph;
mod points;
mod result;
mod strain;
mod surfaces;

pub use certificates::Certificates;
pub use curves::register_hyperbolic;
pub use morph::homotopy;
pub use points::{register_disks, register_spheres};
pub use result::Registration;
pub use strain::Strain;
pub(crate) use surfaces::vertex_paths;
