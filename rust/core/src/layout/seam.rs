// SPDX-License-Identifier: MIT OR Apache-2.0
//! The points of a layout: one per vertex, or one per image of a vertex on the seam.

use ndarray::Array2;

use super::chart::Point;
use crate::control::Status;
use crate::mesh::Vertex;
use crate::mesh::corners::VertexCorners;

/// A map onto the sphere laid out in the plane, cut open along a seam.
#[derive(Debug, Clone)]
pub struct Layout {
    /// (k, 2): the points, in the order of their vertices. The whole image, with holes, has the area of the sphere. In single
    /// precision all coordinates are numbers of that precision.
    pub points: Array2<f64>,
    /// (m, 3): the faces between points, counter-clockwise, in the order of the faces of the map or of its refinement.
    pub faces: Array2<u32>,
    /// (k,): the vertex of each point, ascending; split points are numbered after the vertices.
    pub vertex_of: Vec<Vertex>,
    /// [`Status::Converged`] where areas are as even as asked for; [`Status::Stalled`] where they hardly get more even;
    /// [`Status::Cancelled`] where the observer ended the relaxation. No face is folded in any case.
    pub status: Status,
    /// Wall time of the whole call.
    pub seconds: f64,
}

/// The points of a layout and the faces between them.
pub(super) struct Split {
    /// (k, 2), in the order of their vertices.
    pub points: Vec<Point>,
    /// (m, 3): the points at their corners.
    pub faces: Vec<[Vertex; 3]>,
    /// (k,): the vertex of each point.
    pub vertex_of: Vec<Vertex>,
}

impl Split {
    /// The part of the first faces, with the points that these have.
    pub(super) fn first_faces(mut self, n_faces: usize) -> Self {
        if n_faces == self.faces.len() {
            return self;
        }
        self.faces.truncate(n_faces);
        let mut is_used = vec![false; self.points.len()];
        self.faces.as_flattened().iter().for_each(|&point| is_used[point] = true);
        let mut numbers = vec![Vertex::default(); self.points.len()];
        let used = Vertex::all(self.points.len()).filter(|&point| is_used[point]);
        let used: Vec<Vertex> = used.collect();
        used.iter().enumerate().for_each(|(number, &point)| numbers[point] = Vertex::new(number));
        Self {
            points: used.iter().map(|&point| self.points[point]).collect(),
            faces: self.faces.iter().map(|face| face.map(|point| numbers[point])).collect(),
            vertex_of: used.iter().map(|&point| self.vertex_of[point]).collect(),
        }
    }
}

/// Joins the corners of each vertex that have the same image.
pub(super) fn split_along_seam(corners: &VertexCorners, images: &[[Point; 3]]) -> Split {
    let mut split = Split {
        points: Vec::new(),
        faces: vec![[Vertex::default(); 3]; images.len()],
        vertex_of: Vec::new(),
    };
    for vertex in Vertex::all(corners.len()) {
        let first = split.points.len();
        for &corner in corners.of(vertex) {
            let (face, corner) = (corner.face(), corner.place());
            let image = images[face][corner];
            let known = split.points[first..].iter().position(|&point| point == image);
            let index = known.map_or(split.points.len(), |k| first + k);
            if known.is_none() {
                split.points.push(image);
                split.vertex_of.push(vertex);
            }
            split.faces[face][corner] = Vertex::new(index);
        }
    }
    split
}
