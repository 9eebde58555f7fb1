// SPDX-License-Identifier: MIT OR Apache-2.0
//! The faces of a mesh under half-edge collapses. Its boundary loops are closed by apexes, vertices without place that
//! are joined to their whole loop, so that every vertex has a closed ring of neighbors.

use crate::mesh::{Corner, Face, TriangleMesh, Vertex};

/// A face with all data for a turn around a vertex.
#[derive(Debug, Clone, Copy)]
struct Triangle {
    vertices: [Vertex; 3],
    /// The corner across the edge opposite to each corner.
    twins: [Corner; 3],
}

/// A closed mesh that loses vertices by collapses.
#[derive(Debug)]
pub(super) struct Connectivity {
    /// The faces of the mesh, then those at the apexes.
    faces: Vec<Triangle>,
    /// Whether a face is left.
    is_left: Vec<bool>,
    /// A corner at each vertex that is left; those of the apexes follow those of the mesh.
    corners: Vec<Corner>,
    degrees: Vec<u32>,
    /// The vertices of the mesh.
    n_vertices: usize,
    /// The faces of the mesh.
    n_faces: usize,
}

impl Connectivity {
    /// The mesh before any collapse.
    pub(super) fn new(mesh: &TriangleMesh) -> Self {
        let (n_vertices, n_faces) = (mesh.n_vertices(), mesh.n_faces());
        // the corners across boundary edges get a twin when an apex closes the loop
        let twin = |corner| mesh.opposite(corner).unwrap_or_default();
        let triangle =
            |face: Face| Triangle { vertices: mesh.faces()[face], twins: face.corners().map(twin) };
        let degree = |vertex| mesh.vertex_corners(vertex).len() as u32;
        let mut closed = Self {
            faces: Face::all(n_faces).map(triangle).collect(),
            is_left: Vec::new(),
            corners: Vertex::all(n_vertices).map(|vertex| mesh.vertex_corners(vertex)[0]).collect(),
            degrees: Vertex::all(n_vertices).map(degree).collect(),
            n_vertices,
            n_faces,
        };
        mesh.boundary_loops().iter().for_each(|boundary| closed.close(mesh, boundary));
        closed.is_left = vec![true; closed.faces.len()];
        closed
    }

    /// Joins a boundary loop to an apex of its own.
    fn close(&mut self, mesh: &TriangleMesh, boundary: &[Vertex]) {
        let (apex, first, n) = (Vertex::new(self.corners.len()), self.faces.len(), boundary.len());
        let face = |k: usize| Face::new(first + k % n);
        for (k, &vertex) in boundary.iter().enumerate() {
            let next = boundary[(k + 1) % n];
            let along = |corner: &&Corner| {
                self.vertex(corner.next()) == next && mesh.opposite(corner.previous()).is_none()
            };
            let corner = mesh.vertex_corners(vertex).iter().find(along);
            let across = corner.expect("the loop runs along boundary edges").previous();
            let twins = [face(k + n - 1).corner(1), face(k + 1).corner(0), across];
            self.faces.push(Triangle { vertices: [next, vertex, apex], twins });
            self.set_twin(across, face(k).corner(2));
            self.degrees[vertex] += 1;
        }
        self.corners.push(face(0).corner(2));
        self.degrees.push(n as u32);
        // a boundary vertex has one neighbor more than faces, and the apex
        boundary.iter().for_each(|&vertex| self.degrees[vertex] += 1);
    }

    /// Whether a vertex closes a loop.
    pub(super) fn is_apex(&self, vertex: Vertex) -> bool {
        vertex.index() >= self.n_vertices
    }

    /// The number of neighbors of a vertex.
    pub(super) fn degree(&self, vertex: Vertex) -> usize {
        self.degrees[vertex] as usize
    }

    /// The vertex at a corner.
    pub(super) fn vertex(&self, corner: Corner) -> Vertex {
        self.faces[corner.face()].vertices[corner.place()]
    }

    fn twin(&self, corner: Corner) -> Corner {
        self.faces[corner.face()].twins[corner.place()]
    }

    fn set_twin(&mut self, corner: Corner, twin: Corner) {
        self.faces[corner.face()].twins[corner.place()] = twin;
    }

    /// The corners at a vertex, counterclockwise; the neighbors are the vertices at their next corners.
    pub(super) fn around(&self, vertex: Vertex) -> impl Iterator<Item = Corner> {
        let first = self.corners[vertex];
        let turned =
            move |&corner: &Corner| Some(self.twin(corner.next()).next()).filter(|&next| next != first);
        std::iter::successors(Some(first), turned)
    }

    /// The two neighbors beside that at the next corner: the vertices opposite to the edge between.
    pub(super) fn beside(&self, corner: Corner) -> [Vertex; 2] {
        [self.vertex(corner.previous()), self.vertex(self.twin(corner.previous()))]
    }

    /// Moves the vertex at a corner onto that at the next corner.
    pub(super) fn collapse(&mut self, corner: Corner) {
        let [vertex, onto] = [self.vertex(corner), self.vertex(corner.next())];
        let before = self.twin(corner.previous()).next().next();
        debug_assert_eq!(self.vertex(before), vertex);
        // 1. The faces that stay get their new vertex
        let mut current = self.turned(corner);
        while current != before {
            self.faces[current.face()].vertices[current.place()] = onto;
            current = self.turned(current);
        }
        // 2. Their neighbors are joined over the two that vanish
        for (dead, inner, outer) in [(corner, corner.next(), corner), (before, before.previous(), before)] {
            let [inner, outer] = [inner, outer].map(|corner| self.twin(corner));
            self.set_twin(inner, outer);
            self.set_twin(outer, inner);
            self.is_left[dead.face()] = false;
            for corner in [inner.next(), inner.previous()] {
                let end = self.vertex(corner);
                self.corners[end] = corner;
                if end != onto {
                    self.degrees[end] -= 1;
                }
            }
        }
        self.degrees[onto] = self.degrees[onto] + self.degrees[vertex] - 4;
    }

    fn turned(&self, corner: Corner) -> Corner {
        self.twin(corner.next()).next()
    }

    /// The faces of the mesh that are left.
    pub(super) fn faces_left(&self) -> impl Iterator<Item = [Vertex; 3]> {
        (0..self.n_faces).filter(|&face| self.is_left[face]).map(|face| self.faces[face].vertices)
    }
}
