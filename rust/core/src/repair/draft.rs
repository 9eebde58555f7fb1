// SPDX-License-Identifier: MIT OR Apache-2.0
//! A mesh while it is repaired, with maps between it and the mesh given.

use crate::mesh::{Corner, Face, Vertex};
use crate::vector::Vector3;

/// The mesh as it is so far.
///
/// Vertices and faces that a repair added come from none of those given.
pub(super) struct Draft {
    /// The vertices, centered on their bounding box and scaled to a unit diagonal, (n, 3).
    pub points: Vec<Vector3>,
    /// The given vertex of which each vertex is a copy, (n,).
    pub vertex_of: Vec<Option<Vertex>>,
    /// The faces, (m, 3).
    pub faces: Vec<[Vertex; 3]>,
    /// The given face that each face is, or is a part of, (m,).
    pub face_of: Vec<Option<Face>>,
    /// Whether each face is turned against the given one, (m,).
    pub turned: Vec<bool>,
    /// The vertex that each given vertex became, one of them where it was split.
    pub vertex_to: Vec<Option<Vertex>>,
}

impl Draft {
    /// The given faces that `is_kept`, between the vertices of these.
    pub(super) fn new(n_vertices: usize, faces: &[[Vertex; 3]], is_kept: impl Fn(usize) -> bool) -> Self {
        let kept: Vec<Face> = Face::all(faces.len()).filter(|face| is_kept(face.index())).collect();
        let mut draft = Self {
            points: vec![Vector3::ZERO; n_vertices],
            vertex_of: Vertex::all(n_vertices).map(Some).collect(),
            faces: kept.iter().map(|&face| faces[face]).collect(),
            turned: vec![false; kept.len()],
            face_of: kept.into_iter().map(Some).collect(),
            vertex_to: Vertex::all(n_vertices).map(Some).collect(),
        };
        draft.drop_loose();
        draft
    }

    /// Drops the vertices that have no face; those that stay keep their order. A given vertex whose first copy is dropped
    /// is from then on another of its copies.
    pub(super) fn drop_loose(&mut self) {
        let mut is_used = vec![false; self.points.len()];
        self.faces.as_flattened().iter().for_each(|&vertex| is_used[vertex] = true);
        let mut numbers = vec![None; self.points.len()];
        let used = Vertex::all(self.points.len()).filter(|&vertex| is_used[vertex]);
        used.enumerate().for_each(|(number, vertex)| numbers[vertex] = Some(Vertex::new(number)));
        self.renumber_given(&numbers);
        retain(&mut self.points, |vertex| is_used[vertex]);
        retain(&mut self.vertex_of, |vertex| is_used[vertex]);
        let renumbered = |vertex: Vertex| numbers[vertex].unwrap_or_default();
        self.faces.iter_mut().for_each(|face| *face = face.map(renumbered));
    }

    /// Gives the given vertices new numbers of what they became, or of another copy where that has none.
    fn renumber_given(&mut self, numbers: &[Option<Vertex>]) {
        let mut copies = vec![None; self.vertex_to.len()];
        for (given, number) in self.vertex_of.iter().zip(numbers).rev() {
            if let (Some(given), Some(number)) = (given, number) {
                copies[*given] = Some(*number);
            }
        }
        let vertex_of = &self.vertex_of;
        for became in &mut self.vertex_to {
            *became = became.and_then(|vertex| {
                numbers[vertex].or_else(|| vertex_of[vertex].and_then(|given| copies[given]))
            });
        }
    }

    /// Gives every vertex another vertex in its place.
    pub(super) fn join_vertices(&mut self, in_place_of: impl Fn(Vertex) -> Vertex) {
        self.faces.iter_mut().for_each(|face| *face = face.map(&in_place_of));
        self.vertex_to.iter_mut().for_each(|vertex| *vertex = vertex.map(&in_place_of));
    }

    /// Keeps the faces that `is_kept`; returns the number of those that are dropped.
    pub(super) fn keep_faces(&mut self, is_kept: impl Fn(&Self, usize) -> bool) -> usize {
        let kept: Vec<bool> = (0..self.faces.len()).map(|face| is_kept(self, face)).collect();
        retain(&mut self.faces, |face| kept[face]);
        retain(&mut self.face_of, |face| kept[face]);
        retain(&mut self.turned, |face| kept[face]);
        kept.iter().filter(|kept| !**kept).count()
    }

    /// Drops the faces that have a vertex twice, whose edges are then joined; returns their number.
    pub(super) fn drop_collapsed(&mut self) -> usize {
        self.keep_faces(|draft, face| {
            let [a, b, c] = draft.faces[face];
            a != b && b != c && c != a
        })
    }

    /// Adds a copy of a vertex.
    pub(super) fn copy_vertex(&mut self, vertex: Vertex) -> Vertex {
        self.points.push(self.points[vertex]);
        self.vertex_of.push(self.vertex_of[vertex]);
        Vertex::new(self.points.len() - 1)
    }

    /// Counts points and faces that were added to the arrays as such.
    pub(super) fn admit_added(&mut self) {
        self.vertex_of.resize(self.points.len(), None);
        self.face_of.resize(self.faces.len(), None);
        self.turned.resize(self.faces.len(), false);
    }

    /// Turns faces over: the first corner stays, the other two change places.
    pub(super) fn turn_over(&mut self, face: Face) {
        self.faces[face].swap(1, 2);
        self.turned[face] ^= true;
    }

    /// The corners of a face in space.
    pub(super) fn corners(&self, face: usize) -> [Vector3; 3] {
        self.faces[face].map(|vertex| self.points[vertex])
    }

    /// Replaces the vertex at a corner.
    pub(super) fn set_corner(&mut self, corner: Corner, vertex: Vertex) {
        self.faces[corner.face()][corner.place()] = vertex;
    }
}

/// Keeps the items whose places satisfy a condition.
fn retain<T>(items: &mut Vec<T>, is_kept: impl Fn(usize) -> bool) {
    let mut place = 0;
    items.retain(|_| {
        place += 1;
        is_kept(place - 1)
    });
}
