// SPDX-License-Identifier: MIT OR Apache-2.0
//! Opening a surface along its cut edges, and walking along the resulting boundary.

use crate::mesh::{NO_CORNER, Vertex, next_corner, previous_corner, vertex_at};

/// The vertex of a corner without one yet.
const UNNUMBERED: Vertex = Vertex(u32::MAX);

/// A surface after cutting: its faces with new vertices.
#[derive(Debug, Clone)]
pub(in crate::hyperbolic) struct Opened {
    /// (m, 3), in the order of [`Sliced::faces`](super::sliced::Sliced::faces).
    pub faces: Vec<[Vertex; 3]>,
    /// (3 m,): the corner (3 × face + k) opposite across the edge opposite to each corner, [`NO_CORNER`] on the
    /// boundary.
    pub opposite: Vec<u32>,
    /// The vertex before cutting of each vertex.
    pub vertex_of: Vec<Vertex>,
}

impl Opened {
    /// Opens `faces` along edges without an opposite corner: the corners of each fan become one vertex.
    ///
    /// The vertices are numbered in the order of their lowest corners.
    pub(super) fn new(faces: &[[Vertex; 3]], opposite: Vec<u32>) -> Self {
        let mut opened = Self { faces: vec![[UNNUMBERED; 3]; faces.len()], opposite, vertex_of: Vec::new() };
        for corner in 0..3 * faces.len() as u32 {
            if vertex_at(&opened.faces, corner) == UNNUMBERED {
                opened.number_fan(corner);
                opened.vertex_of.push(vertex_at(faces, corner));
            }
        }
        opened
    }

    /// Gives all corners of a fan the next number.
    fn number_fan(&mut self, first: u32) {
        let number = Vertex::new(self.vertex_of.len());
        for turn in [next_corner, previous_corner] {
            let mut corner = first;
            loop {
                self.faces[corner as usize / 3][corner as usize % 3] = number;
                let across = self.opposite[turn(corner) as usize];
                if across == NO_CORNER {
                    break;
                }
                corner = turn(across);
                if corner == first {
                    return;
                }
            }
        }
    }

    /// The vertices of the boundary loop that begins with the edge opposite to a corner, the surface on the
    /// left.
    pub(super) fn boundary_from(&self, corner: u32) -> Vec<Vertex> {
        let step = |&edge: &u32| Some(self.next_boundary_edge(edge)).filter(|&next| next != corner);
        let edges = std::iter::successors(Some(corner), step);
        edges.map(|edge| vertex_at(&self.faces, next_corner(edge))).collect()
    }

    /// The boundary edge after a boundary edge, both given by the corners opposite to them.
    pub(super) fn next_boundary_edge(&self, edge: u32) -> u32 {
        let mut corner = previous_corner(edge);
        loop {
            let across = self.opposite[previous_corner(corner) as usize];
            if across == NO_CORNER {
                return previous_corner(corner);
            }
            corner = previous_corner(across);
        }
    }

    /// For each boundary vertex the corner opposite to the edge that leaves it with the surface on the left.
    pub(crate) fn boundary_corners(&self) -> Vec<u32> {
        let mut corners = vec![NO_CORNER; self.vertex_of.len()];
        for corner in (0..self.opposite.len()).filter(|&corner| self.opposite[corner] == NO_CORNER) {
            corners[self.faces[corner / 3][(corner + 1) % 3]] = corner as u32;
        }
        corners
    }
}
