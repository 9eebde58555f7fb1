// SPDX-License-Identifier: MIT OR Apache-2.0
//! Registration of surfaces by landmarks: a one-to-one map g of a source onto a target that takes landmark
//! vertices to landmark vertices and keeps areas.
//!
//! [`register_disks`] (Liu & Yueh 2023, section 6) and [`register_spheres`] (Sutti & Yueh 2024, section 6.6)
//! map both surfaces into one domain, carry the landmarks onto each other there without folding a face, and
//! locate each vertex of the source on the target. [`homotopy`] morphs along g.
//!
//! Input: two [`TriangleMesh`](crate::mesh::TriangleMesh)es, both disks or both spheres, and pairs of [`Landmarks`].
//! Cost: the two maps, and about as much again for carrying the landmarks.

pub(crate) mod correspondence;
mod disk;
mod figures;
mod flow;
mod given_faces;
mod landmark_descent;
mod landmarks;
mod morph;
mod options;
pub(super) mod result;
mod sphere;
mod transfer;
mod verdict;

pub use correspondence::Correspondence;
pub use disk::register_disks;
pub use landmarks::Landmarks;
pub use morph::homotopy;
pub use options::RegistrationOptions;
pub use result::{DiskRegistration, Registration, SphereRegistration};
pub(crate) use sphere::inside_out;
pub use sphere::register_spheres;
