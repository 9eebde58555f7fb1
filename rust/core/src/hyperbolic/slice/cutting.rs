// SPDX-License-Identifier: MIT OR Apache-2.0
//! A surface while it is being cut: its edges can be marked for cutting and split at their midpoints.
//!
//! Cutting a surface open along marked edges makes boundary vertices of all vertices on them. An unmarked edge
//! between two such vertices is a *chord*: a triangle with two sides on the boundary could not have the angle
//! it needs there, and a straight-line map with the boundary fixed would flatten it. So every chord is split.
//! One pass over the neighbors of the vertices that are new on the cuts leaves no chord, as the new edges all
//! end in a midpoint, which lies on no cut. It also leaves a way between any two places of the boundary: every
//! triangle has a vertex off the cuts, and neighboring triangles share one.
//!
//! Input: the oriented faces of a manifold. Cost: O(n) to begin with; a split takes O(1), the chords of a
//! vertex as many steps as it has neighbors.

use super::sliced::Place;
use crate::hyperbolic::features::piece::Piece;
use crate::mesh::{Corner, EdgeTable, Face, Vertex};
use crate::vector::Vector3;

/// The reason for which an edge is cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Seam {
    /// The edge is not cut.
    None,
    /// The edge belongs to a slit or to a boundary loop.
    Feature,
    /// The edge belongs to an arc between two features.
    Arc,
}

/// A surface with its marked edges.
#[derive(Debug, Clone)]
pub(super) struct Cutting {
    /// (n, 3): the vertices, then the midpoints of split edges.
    pub points: Vec<Vector3>,
    /// (n, 3): the vertices and midpoints on the unit sphere.
    pub on_sphere: Vec<Vector3>,
    /// (m, 3): the faces, oriented.
    pub faces: Vec<[Vertex; 3]>,
    /// (3 m,): the opposite corners, `None` on the boundary of the piece.
    pub opposite: Vec<Option<Corner>>,
    /// (3 m,): the seam of the edge opposite to each corner.
    pub seams: Vec<Seam>,
    /// (m,): where each face lies in the piece.
    pub places: Vec<Place>,
    /// (n,): a corner at each vertex from which [`Cutting::corners`] reaches all.
    first_corner: Vec<Option<Corner>>,
    /// (n,): whether each vertex lies on a cut.
    is_cut: Vec<bool>,
}

impl Cutting {
    /// A piece before any cut.
    pub(super) fn new(piece: &Piece) -> Self {
        let opposite = EdgeTable::new(piece.points.len(), &piece.faces).opposites();
        let corners = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        Self {
            first_corner: first_corners(piece.points.len(), &piece.faces, &opposite),
            points: piece.points.clone(),
            on_sphere: piece.on_sphere.clone(),
            faces: piece.faces.clone(),
            seams: vec![Seam::None; opposite.len()],
            opposite,
            places: Face::all(piece.faces.len()).map(|face| Place { face, corners }).collect(),
            is_cut: vec![false; piece.points.len()],
        }
    }

    /// Whether a vertex lies on a cut.
    pub(super) fn is_cut(&self, vertex: Vertex) -> bool {
        self.is_cut[vertex]
    }

    /// The vertices on cuts, in ascending order.
    pub(super) fn cut_vertices(&self) -> Vec<Vertex> {
        Vertex::all(self.points.len()).filter(|&vertex| self.is_cut(vertex)).collect()
    }

    /// The distance of two vertices in space.
    pub(super) fn length(&self, a: Vertex, b: Vertex) -> f64 {
        self.points[a].distance(self.points[b])
    }

    /// The corners at a vertex, in the order in which they lie around it; none at a loose vertex.
    pub(super) fn corners(&self, vertex: Vertex) -> impl Iterator<Item = Corner> + '_ {
        let first = self.first_corner[vertex];
        let turn = move |corner: &Corner| {
            self.opposite[corner.next()].map(Corner::next).filter(|&corner| Some(corner) != first)
        };
        std::iter::successors(first, turn)
    }

    /// The neighbors of a vertex; at a boundary vertex without the one before it on the boundary.
    pub(super) fn neighbors(&self, vertex: Vertex) -> impl Iterator<Item = Vertex> + '_ {
        self.corners(vertex).map(|corner| corner.next().vertex(&self.faces))
    }

    /// The corner opposite to the half-edge from `a` to `b`, if there is a face on its left.
    pub(super) fn half_edge(&self, a: Vertex, b: Vertex) -> Option<Corner> {
        let at_start = self.corners(a).find(|&corner| corner.next().vertex(&self.faces) == b);
        at_start.map(Corner::previous)
    }

    /// Marks the edges of a path for cutting; returns whether it is a path of edges.
    pub(super) fn mark(&mut self, path: &[Vertex], seam: Seam) -> bool {
        let is_path = path.windows(2).all(|edge| self.mark_edge(edge[0], edge[1], seam));
        path.iter().for_each(|&vertex| self.is_cut[vertex] = true);
        is_path
    }

    fn mark_edge(&mut self, a: Vertex, b: Vertex, seam: Seam) -> bool {
        let Some(corner) = self.half_edge(a, b).or_else(|| self.half_edge(b, a)) else { return false };
        self.seams[corner] = seam;
        if let Some(across) = self.opposite[corner] {
            self.seams[across] = seam;
        }
        true
    }

    /// Splits the chords at `vertices`, which all lie on cuts.
    pub(super) fn split_chords(&mut self, vertices: &[Vertex]) {
        for &vertex in vertices {
            // splits keep the corners around the vertex and bring the far ends of its edges nearer
            let corners: Vec<Corner> = self.corners(vertex).collect();
            for edge in corners.into_iter().map(Corner::previous) {
                if self.is_chord(edge) {
                    self.split(edge);
                }
            }
        }
    }

    /// Whether the edge opposite to a corner is not cut but has both ends on cuts.
    fn is_chord(&self, corner: Corner) -> bool {
        let is_inner = self.opposite[corner].is_some() && self.seams[corner] == Seam::None;
        is_inner && corner.half_edge(&self.faces).iter().all(|&end| self.is_cut(end))
    }

    /// Splits the edge opposite to a corner at its midpoint; returns the midpoint.
    ///
    /// The parts at the start of the half-edge keep the numbers of the faces; those at its end are appended.
    pub(super) fn split(&mut self, corner: Corner) -> Vertex {
        let [start, end] = corner.half_edge(&self.faces);
        let across = self.opposite[corner];
        let midpoint = self.add_midpoint(start, end, self.seams[corner] != Seam::None);
        let new = self.halve(corner, true, midpoint);
        self.first_corner[midpoint] = Some(new.next());
        if let Some(across) = across {
            let new_across = self.halve(across, false, midpoint);
            self.link(new, Some(new_across));
        }
        midpoint
    }

    fn add_midpoint(&mut self, a: Vertex, b: Vertex, is_cut: bool) -> Vertex {
        let on_sphere = self.on_sphere[a] + self.on_sphere[b];
        let length = on_sphere.norm();
        let antipodal = length < f64::EPSILON;
        self.on_sphere.push(if antipodal { self.on_sphere[a] } else { on_sphere * (1.0 / length) });
        self.points.push((self.points[a] + self.points[b]) * 0.5);
        self.is_cut.push(is_cut);
        self.first_corner.push(None);
        Vertex::new(self.points.len() - 1)
    }

    /// Divides a face between a corner and the midpoint of the opposite edge. Keeps the half at the start of that
    /// edge, or at its end, and appends the other half; returns the corner of the latter at the dividing corner.
    fn halve(&mut self, corner: Corner, keeps_start: bool, midpoint: Vertex) -> Corner {
        let [next, previous] = [corner.next(), corner.previous()];
        let [kept, given] = if keeps_start { [next, previous] } else { [previous, next] };
        let new = self.append_copy(corner);
        let new_given = if keeps_start { new.previous() } else { new.next() };
        let new_kept = if keeps_start { new.next() } else { new.previous() };
        self.move_corner(given, [kept, given], midpoint);
        self.move_corner(new_kept, [new_kept, new_given], midpoint);
        // the side from the corner to the vertex that went to the new face, then the dividing edge
        let outer = self.opposite[kept];
        self.seams[new_kept] = self.seams[kept];
        self.link(new_kept, outer);
        self.seams[kept] = Seam::None;
        self.seams[new_given] = Seam::None;
        self.link(kept, Some(new_given));
        self.renumber_first(given, new_given);
        if !keeps_start {
            // the side behind the corner is now in the new face
            self.renumber_first(corner, new);
        }
        new
    }

    /// Makes `new` the first corner of its vertex if `old` was.
    fn renumber_first(&mut self, old: Corner, new: Corner) {
        let first = &mut self.first_corner[new.vertex(&self.faces)];
        if *first == Some(old) {
            *first = Some(new);
        }
    }

    /// Appends a copy of the face of a corner, without neighbors, with this corner first; returns its first corner.
    fn append_copy(&mut self, corner: Corner) -> Corner {
        let corners = [corner, corner.next(), corner.previous()];
        let Place { face, corners: weights } = self.places[corner.face()];
        self.places.push(Place { face, corners: corners.map(|corner| weights[corner.place()]) });
        self.faces.push(corners.map(|corner| corner.vertex(&self.faces)));
        self.seams.extend(corners.map(|corner| self.seams[corner]));
        self.opposite.extend([None; 3]);
        Face::new(self.faces.len() - 1).corner(0)
    }

    /// Moves a corner to the midpoint of two corners of its face.
    fn move_corner(&mut self, corner: Corner, [a, b]: [Corner; 2], midpoint: Vertex) {
        let weights = &mut self.places[corner.face()].corners;
        let [a, b] = [a, b].map(|end| weights[end.place()]);
        weights[corner.place()] = std::array::from_fn(|k| 0.5 * (a[k] + b[k]));
        self.faces[corner.face()][corner.place()] = midpoint;
    }

    /// Makes two corners opposite to each other; the second may be none.
    fn link(&mut self, corner: Corner, across: Option<Corner>) {
        self.opposite[corner] = across;
        if let Some(across) = across {
            self.opposite[across] = Some(corner);
        }
    }
}

/// A corner at each vertex; on the boundary the one with a boundary edge behind it.
fn first_corners(
    n_vertices: usize,
    faces: &[[Vertex; 3]],
    opposite: &[Option<Corner>],
) -> Vec<Option<Corner>> {
    let mut first = vec![None; n_vertices];
    for corner in Corner::all(faces.len()) {
        let slot = &mut first[corner.vertex(faces)];
        if slot.is_none() || opposite[corner.previous()].is_none() {
            *slot = Some(corner);
        }
    }
    first
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::faces_of_indices;

    /// Two triangles that share the edge from 0 to 1.
    fn two_triangles() -> Cutting {
        let points =
            [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, 1.0, 0.0], [0.5, -1.0, 0.0]].map(Vector3).to_vec();
        let [x, y, z] = [0, 1, 2].map(Vector3::unit);
        Cutting::new(&Piece {
            on_sphere: vec![x, y, z, -z],
            vertex_of: Vertex::all(4).collect(),
            face_of: vec![Face(0), Face(1)],
            faces: faces_of_indices(&[[0, 1, 2], [1, 0, 3]]),
            points,
            features: Vec::new(),
        })
    }

    fn check(cutting: &Cutting) {
        let table = EdgeTable::new(cutting.points.len(), &cutting.faces).opposites();
        assert_eq!(cutting.opposite, table);
        for vertex in Vertex::all(cutting.points.len()) {
            let around: Vec<Corner> = cutting.corners(vertex).collect();
            assert!(around.iter().all(|&corner| corner.vertex(&cutting.faces) == vertex));
            let all = cutting.faces.as_flattened().iter().filter(|&&corner| corner == vertex);
            assert_eq!(around.len(), all.count());
        }
        for (face, place) in cutting.faces.iter().zip(&cutting.places) {
            for (corner, weights) in face.iter().zip(place.corners) {
                assert_eq!(weights.iter().sum::<f64>(), 1.0);
                let whole = two_triangles().faces[place.face];
                let terms = whole.iter().zip(weights).map(|(&v, w)| cutting.points[v] * w);
                assert_eq!(terms.sum::<Vector3>(), cutting.points[*corner]);
            }
        }
    }

    #[test]
    fn splits_keep_neighbors_rings_and_places() {
        let mut cutting = two_triangles();
        for k in 0..60 {
            cutting.split(Corner::new(7919 * k % cutting.opposite.len()));
            check(&cutting);
        }
        assert_eq!(cutting.points.len(), 64);
    }

    #[test]
    fn splitting_a_cut_edge_cuts_both_halves() {
        let mut cutting = two_triangles();
        assert!(cutting.mark(&[0, 1].map(Vertex), Seam::Feature));
        let [start, end] = [0, 1].map(Vertex);
        let midpoint = cutting.split(cutting.half_edge(start, end).unwrap());
        for [a, b] in [[start, midpoint], [midpoint, end], [end, midpoint], [midpoint, start]] {
            assert_eq!(cutting.seams[cutting.half_edge(a, b).unwrap()], Seam::Feature);
        }
        assert_eq!(cutting.seams.iter().filter(|&&seam| seam == Seam::Feature).count(), 4);
        assert!(cutting.is_cut(midpoint));
    }

    #[test]
    fn an_edge_between_two_cut_vertices_is_split_once() {
        let mut cutting = two_triangles();
        assert!(
            cutting.mark(&[3, 0, 2].map(Vertex), Seam::Feature) && cutting.mark(&[Vertex(1)], Seam::Feature)
        );
        cutting.split_chords(&[0, 1].map(Vertex));
        assert_eq!(cutting.points.len(), 5);
        cutting.split_chords(&[0, 1].map(Vertex));
        assert_eq!(cutting.points.len(), 5);
        assert!(!cutting.mark(&[2, 3].map(Vertex), Seam::Arc));
    }
}
