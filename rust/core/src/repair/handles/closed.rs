// SPDX-License-Identifier: MIT OR Apache-2.0
//! A surface whose boundary loops are closed by cones, so that every corner has an opposite one.

use crate::filling::{apex_of, cone};
use crate::mesh::ties::on_cost_grid;
use crate::mesh::{Corner, EdgeTable, Topology, Vertex, VertexCorners};
use crate::repair::draft::Draft;
use crate::vector::Vector3;

/// An oriented surface without boundary; the faces and vertices of the draft come first.
pub(super) struct ClosedMesh {
    pub points: Vec<Vector3>,
    pub faces: Vec<[Vertex; 3]>,
    pub opposite: Vec<Option<Corner>>,
    pub corners: VertexCorners,
    /// Whether loops must not run through each vertex: the tips of the cones, and the boundary loops.
    pub is_closed_to_loops: Vec<bool>,
}

impl ClosedMesh {
    /// The draft with its boundary loops closed.
    pub(super) fn new(draft: &Draft) -> Self {
        let (mut points, mut faces) = (draft.points.clone(), draft.faces.clone());
        let mut is_closed_to_loops = vec![false; points.len()];
        for hole in Topology::of_faces(&draft.points, &draft.faces).boundary_loops {
            let rim: Vec<Vector3> = hole.iter().map(|&vertex| points[vertex]).collect();
            let apex = Vertex::new(points.len());
            points.push(apex_of(&rim));
            is_closed_to_loops.push(true);
            hole.iter().for_each(|&vertex| is_closed_to_loops[vertex] = true);
            faces.extend(cone(&hole, apex));
        }
        let opposite = EdgeTable::new(points.len(), &faces).opposites();
        let corners = VertexCorners::new(points.len(), &faces);
        Self { points, faces, opposite, corners, is_closed_to_loops }
    }

    /// The vertices after those of a vertex in its faces, with their corners: each neighbor once.
    pub(super) fn neighbors(&self, vertex: Vertex) -> impl Iterator<Item = (Corner, Vertex)> + '_ {
        self.corners.of(vertex).iter().map(|&corner| (corner, corner.next().vertex(&self.faces)))
    }

    /// The corner at the same vertex in the next face, counter-clockwise; `None` at a face that could not be joined.
    pub(super) fn turned(&self, corner: Corner) -> Option<Corner> {
        self.opposite[corner.next()].map(Corner::next)
    }

    /// The corner at the other end of the half-edge that leaves a corner, whose half-edge comes back.
    pub(super) fn reversed(&self, corner: Corner) -> Option<Corner> {
        self.opposite[corner.previous()].map(Corner::next)
    }

    /// The length of an edge, never zero, rounded so that symmetric loops are equally long.
    pub(super) fn length(&self, from: Vertex, to: Vertex) -> f64 {
        on_cost_grid(self.points[from].distance(self.points[to]))
    }
}
