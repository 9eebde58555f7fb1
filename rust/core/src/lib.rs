// SPDX-License-Identifier: MIT OR Apache-2.0
//! Area-preserving (authalic) maps of triangle meshes: [`disk_map`] for surfaces with a boundary,
//! [`sphere_map`] for closed ones.
//!
//! ```
//! use authalic::{DiskMapOptions, Silent, disk_map, mesh::TriangleMesh};
//!
//! // a pyramid without its base: one boundary loop, so a disk
//! let vertices = [[0., 0., 1.], [1., 0., 0.], [0., 1., 0.], [-1., 0., 0.], [0., -1., 0.]];
//! let faces = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]];
//! let mesh = TriangleMesh::new(&vertices, &faces)?;
//!
//! let map = disk_map(&mesh, &DiskMapOptions::default(), &mut Silent)?;
//!
//! println!("{} after {} iterations", map.status.as_str(), map.history.iterations());
//! assert!(map.distortion.folded.is_empty());
//! # Ok::<(), authalic::Error>(())
//! ```
//!
//! Rooms and their order are described in `ARCHITECTURE.md`.

mod alignment;
mod arrays;
mod codomain;
mod control;
mod disk;
mod distortion;
pub mod embedding;
pub mod energy;
mod error;
pub mod hyperbolic;
mod location;
pub mod mesh;
pub mod optimize;
mod options;
mod parallel;
pub mod registration;
pub mod sparse;
mod sphere;
mod untangle;
mod vector;

pub use control::{History, Observer, Record, Silent, Status};
pub use disk::{Boundary, DiskMap, DiskMapOptions, Method, disk_map};
pub use distortion::{Distortion, Image, distortion, folded_in_plane, folded_on_sphere, normalized_density};
pub use error::{
    CurveError, Elements, Error, ErrorKind, LandmarkError, MapError, MeshError, NumericsError, Side,
};
pub use mesh::{Patch, Surface, Topology};
pub use sphere::{Refinement, SphereMap, SphereMapOptions, SphereMethod, sphere_map};
pub use untangle::{UntangleOptions, Untangled, UntangledImage, untangle};
pub use vector::Vector3;
