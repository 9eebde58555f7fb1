// SPDX-License-Identifier: MIT OR Apache-2.0
//! Closed loops of edges.

use super::closed::ClosedMesh;
use crate::mesh::Vertex;

/// A loop on the surface with its length.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Loop {
    pub length: f64,
    pub vertices: Vec<Vertex>,
}

impl Loop {
    /// The loop through vertices that are neighbors one after the other, with its length.
    pub(super) fn new(mesh: &ClosedMesh, vertices: Vec<Vertex>) -> Self {
        let next = |k: usize| vertices[(k + 1) % vertices.len()];
        let length = (0..vertices.len()).map(|k| mesh.length(vertices[k], next(k))).sum();
        Self { length, vertices }
    }
}
