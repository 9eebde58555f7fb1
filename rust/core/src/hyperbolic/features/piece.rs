// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a surface is cut along: slits along landmark curves and boundary loops, each with two banks.

use crate::mesh::Face;
use crate::vector::Vector3;

/// One bank of a feature: vertices from its start to its end, with their parameters.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Bank {
    /// At least two vertices of the piece.
    pub vertices: Vec<u32>,
    /// As many parameters, strictly increasing from 0 to 1.
    pub parameters: Vec<f64>,
}

/// A slit along a landmark curve, or a boundary loop with a start and an end vertex on it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Feature {
    /// From start to end with the surface on the left of travel.
    pub left: Bank,
    /// From start to end with the surface on the right of travel: of a slit the same vertices, of a loop the
    /// rest of it (start and end belong to both).
    pub right: Bank,
    /// Whether it is a boundary loop of the piece.
    pub is_loop: bool,
    /// The landmark curve that it lies along, `None` for a boundary loop that is none.
    pub curve: Option<usize>,
}

impl Feature {
    /// The same feature from its end to its start.
    pub(crate) fn reversed(&self) -> Self {
        Self { left: self.right.reversed(), right: self.left.reversed(), ..*self }
    }

    /// The first vertex.
    pub(crate) fn start(&self) -> u32 {
        self.left.vertices[0]
    }

    /// The last vertex.
    pub(crate) fn end(&self) -> u32 {
        self.left.vertices[self.left.vertices.len() - 1]
    }
}

impl Bank {
    /// The same bank from its end to its start.
    pub(super) fn reversed(&self) -> Self {
        let vertices = self.vertices.iter().rev().copied().collect();
        Self { vertices, parameters: self.parameters.iter().rev().map(|s| 1.0 - s).collect() }
    }
}

/// A connected part of a surface of genus 0 with its features, those of source and target in the same order.
#[derive(Debug, Clone)]
pub(crate) struct Piece {
    /// (n, 3).
    pub points: Vec<Vector3>,
    /// (m, 3), oriented.
    pub faces: Vec<[u32; 3]>,
    /// (n, 3): the vertices on the unit sphere, those of source and target roughly aligned.
    pub on_sphere: Vec<Vector3>,
    /// (n,): the vertices of the surface.
    pub vertex_of: Vec<u32>,
    /// (m,): the faces of the surface.
    pub face_of: Vec<Face>,
    /// Slits and all boundary loops.
    pub features: Vec<Feature>,
}
