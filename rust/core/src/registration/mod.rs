// SPDX-License-Identifier: MIT OR Apache-2.0
//! Registration of surfaces by landmarks: a one-to-one map g of a source onto a target that takes landmark
//! vertices to landmark vertices and keeps shapes, or areas.
//!
//! [`register_disks`] (Liu & Yueh 2023, section 6) and [`register_spheres`] (Sutti & Yueh 2024, section 6.6)
//! map both surfaces into one domain, carry the landmarks onto each other there without folding a face, and
//! locate each vertex of the source on the target. With [`Energy::Area`] that is g. [`Energy::Surface`], the default,
//! starts from there and descends on the energy of g itself, in space. [`homotopy`] morphs along g,
//! [`follow()`] takes points beside the source along.
//!
//! Input: two [`TriangleMesh`](crate::mesh::TriangleMesh)es, both disks or both spheres, and pairs of [`Landmarks`].
//! Cost: the two maps, and about as much again for carrying the landmarks.

mod between;
mod boundary;
mod coarse_to_fine;
pub(crate) mod correspondence;
mod disk;
mod extremities;
mod feature_start;
mod features;
mod figures;
pub(crate) mod filling;
mod flow;
mod follow;
mod given_faces;
mod inverse;
mod landmark_descent;
mod landmarks;
mod morph;
mod options;
mod record;
pub(super) mod result;
mod sphere;
mod start_grid;
mod starts;
mod strain;
pub(crate) mod surface;
mod transfer;
mod verdict;

pub use correspondence::Correspondence;
pub use disk::register_disks;
pub use features::Features;
pub(crate) use features::Signals;
pub use follow::follow;
pub use landmarks::Landmarks;
pub use morph::homotopy;
pub use options::{Energy, RegistrationOptions};
pub(crate) use options::{check_face_energy, check_weight};
pub use result::{DiskRegistration, Registration, SphereRegistration};
pub(crate) use sphere::inside_out;
pub use sphere::register_spheres;
pub use strain::Strain;
