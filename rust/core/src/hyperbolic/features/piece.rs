// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pieces of surfaces with their features: slits along landmark curves and boundary loops, each with two banks.

use crate::mesh::{Face, Vertex};
use crate::vector::Vector3;

/// A bank of a feature: vertices from its start to its end, with their parameters.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Bank {
    /// At least two vertices of the piece.
    pub vertices: Vec<Vertex>,
    /// The parameters of the vertices, strictly increasing from 0 to 1.
    pub parameters: Vec<f64>,
}

/// A slit along a landmark curve, or a boundary loop with a start and an end vertex on it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Feature {
    /// From start to end with the surface on the left of travel.
    pub left: Bank,
    /// From start to end with the surface on the right of travel: the vertices of the left bank for a slit, the rest
    /// of the loop for a loop (start and end belong to both).
    pub right: Bank,
    /// Whether it is a boundary loop of the piece.
    pub is_loop: bool,
    /// The landmark curve along which it lies; `None` for a boundary loop that is no landmark curve.
    pub curve: Option<usize>,
}

impl Feature {
    /// The feature from its end to its start.
    pub(crate) fn reversed(&self) -> Self {
        Self { left: self.right.reversed(), right: self.left.reversed(), ..*self }
    }

    /// The first vertex.
    pub(crate) fn start(&self) -> Vertex {
        self.left.vertices[0]
    }

    /// The last vertex.
    pub(crate) fn end(&self) -> Vertex {
        self.left.vertices[self.left.vertices.len() - 1]
    }
}

impl Bank {
    /// The bank from its end to its start.
    pub(super) fn reversed(&self) -> Self {
        let vertices = self.vertices.iter().rev().copied().collect();
        Self { vertices, parameters: self.parameters.iter().rev().map(|s| 1.0 - s).collect() }
    }
}

/// A connected part of a surface of genus 0 with its features; source and target have theirs in the same order.
#[derive(Debug, Clone)]
pub(crate) struct Piece {
    /// (n, 3): the vertices in space.
    pub points: Vec<Vector3>,
    /// (m, 3): the faces, oriented.
    pub faces: Vec<[Vertex; 3]>,
    /// (n, 3): the vertices on the unit sphere, source and target roughly aligned.
    pub on_sphere: Vec<Vector3>,
    /// (n,): the vertex of the surface that each vertex is.
    pub vertex_of: Vec<Vertex>,
    /// (m,): the face of the surface that each face is.
    pub face_of: Vec<Face>,
    /// The slits and all boundary loops.
    pub features: Vec<Feature>,
}
