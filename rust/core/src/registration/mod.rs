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

mod disk;
mod figures;
mod flow;
mod given_faces;
mod inverse;
mod landmark_descent;
mod landmarks;
mod morph;
mod options;
pub(super) mod result;
mod sphere;
mod transfer;
mod verdict;

pub use crate::alignment::similarity::{Similarity, similarity};
pub use crate::location::Location;
pub use disk::register_disks;
pub use figures::{area_ratios, compare, vertex_areas};
pub use given_faces::{GivenFaces, nearest_given_corners, pull_given_corners};
pub use inverse::{DomainPoint, lifted};
pub use landmarks::Landmarks;
pub use morph::{aligned_homotopy, homotopy};
pub use options::RegistrationOptions;
pub use result::{DiskRegistration, Registration, SphereRegistration};
pub(crate) use sphere::inside_out;
pub use sphere::register_spheres;
pub use transfer::{corner_sides, nearest_corners, nearest_vertices, pull_corners, pull_rows, pull_vertices};
pub use verdict::MISSED;
