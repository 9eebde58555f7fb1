// SPDX-License-Identifier: MIT OR Apache-2.0
//! Opening a surface along its cut edges, and walking along the resulting boundary.

use crate::mesh::{Corner, Vertex};

/// The vertex of a corner without one yet.
const UNNUMBERED: Vertex = Vertex(u32::MAX);

/// A surface after cutting: its faces with new vertices.
#[derive(Debug, Clone)]
pub(in crate::hyperbolic) struct Opened {
    /// (m, 3), in the order of [`Sliced::faces`](super::sliced::Sliced::faces).
    pub faces: Vec<[Vertex; 3]>,
    /// (3 m,): the corner (3 × face + k) opposite across the edge opposite to each corner, `None` on the
    /// boundary.
    pub opposite: Vec<Option<Corner>>,
    /// The vertex before cutting of each vertex.
    pub vertex_of: Vec<Vertex>,
}

impl Opened {
    /// Opens `faces` along edges without an opposite corner: the corners of each fan become one vertex.
    ///
    /// The vertices are numbered in the order of their lowest corners.
    pub(super) fn new(faces: &[[Vertex; 3]], opposite: Vec<Option<Corner>>) -> Self {
        let mut opened = Self { faces: vec![[UNNUMBERED; 3]; faces.len()], opposite, vertex_of: Vec::new() };
        for corner in Corner::all(faces.len()) {
            if corner.vertex(&opened.faces) == UNNUMBERED {
                opened.number_fan(corner);
                opened.vertex_of.push(corner.vertex(faces));
            }
        }
        opened
    }

    /// Gives all corners of a fan the next number.
    fn number_fan(&mut self, first: Corner) {
        let number = Vertex::new(self.vertex_of.len());
        for turn in [Corner::next, Corner::previous] {
            let mut corner = first;
            loop {
                self.faces[corner.face()][corner.place()] = number;
                let Some(across) = self.opposite[turn(corner)] else { break };
                corner = turn(across);
                if corner == first {
                    return;
                }
            }
        }
    }

    /// The vertices of the boundary loop that begins with the edge opposite to a corner, the surface on the
    /// left.
    pub(super) fn boundary_from(&self, corner: Corner) -> Vec<Vertex> {
        let step = |&edge: &Corner| Some(self.next_boundary_edge(edge)).filter(|&next| next != corner);
        let edges = std::iter::successors(Some(corner), step);
        edges.map(|edge| edge.next().vertex(&self.faces)).collect()
    }

    /// The boundary edge after a boundary edge, both given by the corners opposite to them.
    pub(super) fn next_boundary_edge(&self, edge: Corner) -> Corner {
        let mut corner = edge.previous();
        while let Some(across) = self.opposite[corner.previous()] {
            corner = across.previous();
        }
        corner.previous()
    }

    /// For each boundary vertex the corner opposite to the edge that leaves it with the surface on the left.
    pub(crate) fn boundary_corners(&self) -> BoundaryCorners {
        let mut corners = vec![None; self.vertex_of.len()];
        for corner in Corner::all(self.faces.len()).filter(|&corner| self.opposite[corner].is_none()) {
            corners[corner.next().vertex(&self.faces)] = Some(corner);
        }
        BoundaryCorners(corners)
    }
}

/// [`Opened::boundary_corners`].
pub(in crate::hyperbolic) struct BoundaryCorners(Vec<Option<Corner>>);

impl BoundaryCorners {
    /// The corner opposite to the edge that leaves a boundary vertex.
    pub(crate) fn after(&self, vertex: Vertex) -> Corner {
        self.0[vertex].expect("the vertex lies on the boundary")
    }
}
