// SPDX-License-Identifier: MIT OR Apache-2.0
//! Sliced pieces: surfaces cut along features and arcs, with their places on the surface as given.

use super::openings::{BoundaryCorners, Opened};
use crate::hyperbolic::features::piece::Piece;
use crate::location::Location;
use crate::mesh::{Corner, Face, Vertex};
use crate::vector::Vector3;

/// A piece cut along its features, and along a chain of arcs too; edges between two vertices of the cuts are split.
#[derive(Debug, Clone)]
pub(crate) struct Sliced {
    /// (n, 3): the vertices of the piece and the midpoints of split edges, before cutting.
    pub points: Vec<Vector3>,
    /// (m, 3): the faces before cutting.
    pub faces: Vec<[Vertex; 3]>,
    /// (m,): where each face lies in the piece.
    pub places: Vec<Place>,
    /// Cut along the features alone.
    pub surface: Opened,
    /// Cut along features and arcs: a disk.
    pub disk: Opened,
    /// The boundary of the disk, with the disk on the left: left bank of feature 1 of the chain, arc 1, left bank
    /// of feature 2, …, left bank of feature B, right bank of feature B (backwards), arc B − 1 (backwards), …,
    /// right bank of feature 1 (backwards): 2 (2B − 1) sides. Each begins with the last vertex (of the disk) of
    /// the side before.
    pub sides: Vec<Side>,
}

impl Sliced {
    /// The vertex of the surface of each vertex of the disk.
    pub(crate) fn surface_vertices(&self) -> Vec<Vertex> {
        let mut vertices = vec![Vertex::default(); self.disk.vertex_of.len()];
        for (disk, surface) in self.disk.faces.iter().zip(&self.surface.faces) {
            (0..3).for_each(|k| vertices[disk[k]] = surface[k]);
        }
        vertices
    }

    /// The points of the vertices of the sliced surface.
    pub(crate) fn surface_points(&self) -> Vec<Vector3> {
        self.surface.vertex_of.iter().map(|&vertex| self.points[vertex]).collect()
    }

    /// The vertex of the whole surface that a vertex of the sliced surface copies; `None` for midpoints.
    pub(crate) fn given_vertex(&self, piece: &Piece, copy: usize) -> Option<Vertex> {
        piece.vertex_of.get(self.surface.vertex_of[copy].index()).copied()
    }

    /// A location on the sliced surface as a location on the whole surface.
    pub(crate) fn given_place(&self, piece: &Piece, location: &Location) -> Location {
        let place = &self.places[location.triangle];
        let barycentric = [0, 1, 2]
            .map(|k| (0..3).map(|corner| location.barycentric[corner] * place.corners[corner][k]).sum());
        Location { triangle: piece.face_of[place.face], barycentric }
    }
}

/// A part of a face of the piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Place {
    /// The face of the piece.
    pub face: Face,
    /// The barycentric coordinates in that face of each corner of the part; exact, as all splits are at midpoints.
    pub corners: [[f64; 3]; 3],
}

/// A side of the boundary of the disk.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Side {
    /// Whether it is a side of an arc rather than a bank.
    pub is_arc: bool,
    /// The number of the feature in the chain, or of the arc, from 0.
    pub index: usize,
    /// Vertices of the disk in the order of travel, at least two.
    pub vertices: Vec<Vertex>,
    /// The parameters of the vertices, increasing from 0 to 1 on the first 2B − 1 sides, decreasing from 1 to 0
    /// on the others: those of the feature on a bank, shares of the length in space on an arc.
    pub parameters: Vec<f64>,
}

impl Side {
    /// The corners opposite to the edges of the side; `corners` are [`Opened::boundary_corners`] of the disk.
    pub(crate) fn opposite_corners<'a>(
        &'a self,
        corners: &'a BoundaryCorners,
    ) -> impl Iterator<Item = Corner> + 'a {
        self.vertices[..self.vertices.len() - 1].iter().map(|&vertex| corners.after(vertex))
    }
}

/// Source and target cut open, with corresponding sides.
#[derive(Debug, Clone)]
pub(crate) struct SlicedPair {
    /// The source.
    pub source: Sliced,
    /// The target.
    pub target: Sliced,
    /// Whether all arcs on the target follow the carried ones; otherwise the homotopy class may differ.
    pub followed: bool,
}
