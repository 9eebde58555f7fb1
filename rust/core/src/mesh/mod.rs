// SPDX-License-Identifier: MIT OR Apache-2.0
//! Triangle meshes: validated once, then trusted.
//!
//! [`TriangleMesh`] is an oriented manifold surface with or without boundary, whose faces all have an area.
//! [`Surface`] holds any set of triangles, and cuts it along seams into [`Patch`]es.

pub(crate) mod bisection;
pub(super) mod corners;
mod cut;
mod edge_distances;
mod edges;
mod fans;
pub mod geometry;
mod indices;
pub mod orientation;
pub(crate) mod own_frame;
pub(crate) mod polygon;
pub(crate) mod renumbering;
mod soup;
mod surface;
pub(crate) mod ties;
pub(crate) mod topology;
mod triangle_mesh;
mod validate;

pub(crate) use corners::{EdgeTable, VertexCorners};
pub use cut::Patch;
pub(crate) use edge_distances::edge_distances;
pub(crate) use edges::Edges;
pub(crate) use fans::fans;
#[cfg(test)]
pub(crate) use indices::faces_of_indices;
pub use indices::{Corner, Face, Vertex};
pub(crate) use indices::{Edge, index_array};
pub use orientation::consistent;
pub use surface::Surface;
pub use topology::Topology;
pub use triangle_mesh::TriangleMesh;
pub(crate) use validate::check_indices;
