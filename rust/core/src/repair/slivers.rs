// SPDX-License-Identifier: MIT OR Apache-2.0
//! Removes faces without area so that no hole appears.
//!
//! A face without area has either two corners at one place, which become one vertex; or a corner on its longest edge.
//! Then the face beyond that edge is split there, which moves nothing: the edge is flipped. Where that would double an
//! edge, the corner is moved along the longest edge to its nearer end. New faces may again have no area, so this is done
//! in rounds. Cost: a sort of the edges a round; there are few.

use super::draft::Draft;
use crate::mesh::geometry::{edge_lengths, least_height};
use crate::mesh::{Corner, EdgeTable, Face, Vertex};
use crate::sets::Sets;
use crate::vector::Vector3;

/// Height, in roundings of the coordinates, up to which a face counts as flat: more than a mesh may have.
const ROUNDINGS: f64 = 16.0;

/// Height, relative to the bounding box, up to which a face counts as flat in any case.
const SMALLEST_HEIGHT: f64 = 1e-59;

/// Corners are at one place if they are no farther apart than so many times the largest height of a flat face.
const SAME_PLACE: f64 = 4.0;

/// After so many rounds edges are flipped no more, lest flips turn in a circle.
const FLIPPING_ROUNDS: usize = 10;

/// Removes faces whose height is within the rounding of coordinates, of which `largest` is the largest relative to the
/// size of the mesh; returns their number.
pub(super) fn remove_slivers(draft: &mut Draft, largest: f64) -> usize {
    let flat_height = (ROUNDINGS * f64::EPSILON * largest.max(1.0)).max(SMALLEST_HEIGHT);
    let mut removed = draft.drop_collapsed();
    for round in 0.. {
        let flat: Vec<Face> = Face::all(draft.faces.len())
            .filter(|face| is_flat(draft.corners(face.index()), flat_height))
            .collect();
        if flat.is_empty() {
            break;
        }
        removed += Round::new(draft, flat_height, round < FLIPPING_ROUNDS).remove(&flat);
    }
    removed
}

fn is_flat(corners: [Vector3; 3], flat_height: f64) -> bool {
    let height = least_height(corners);
    height.is_nan() || height <= flat_height
}

/// What is done to faces that do not touch each other.
struct Round<'a> {
    draft: &'a mut Draft,
    table: EdgeTable,
    same_place: f64,
    may_flip: bool,
    /// Whether each face has been changed.
    changed: Vec<bool>,
    /// Whether each face is to be dropped.
    dropped: Vec<bool>,
    joined: Sets,
}

impl<'a> Round<'a> {
    fn new(draft: &'a mut Draft, flat_height: f64, may_flip: bool) -> Self {
        let (n_vertices, n_faces) = (draft.points.len(), draft.faces.len());
        Self {
            table: EdgeTable::new(n_vertices, &draft.faces),
            draft,
            same_place: SAME_PLACE * flat_height,
            may_flip,
            changed: vec![false; n_faces],
            dropped: vec![false; n_faces],
            joined: Sets::new(n_vertices),
        }
    }

    /// Removes the faces of a list that it can; returns their number.
    fn remove(mut self, flat: &[Face]) -> usize {
        let mut flipped = 0;
        for &face in flat {
            flipped += usize::from(!self.changed[face] && self.remove_face(face));
        }
        let Self { draft, dropped, mut joined, .. } = self;
        let outer = draft.keep_faces(|_, face| !dropped[face]);
        let roots: Vec<Vertex> = (0..draft.points.len()).map(|v| Vertex::new(joined.root(v))).collect();
        draft.join_vertices(|vertex| roots[vertex]);
        flipped + outer + draft.drop_collapsed()
    }

    /// Removes a face, if need be together with others when vertices are joined; true where its edge is flipped.
    fn remove_face(&mut self, face: Face) -> bool {
        // 1. The corner opposite to the longest edge, and the nearer end of that
        let corners = self.draft.corners(face.index());
        let lengths = edge_lengths(corners);
        let longest = (0..3).max_by(|&j, &k| lengths[j].total_cmp(&lengths[k])).unwrap_or_default();
        let tip = face.corner(longest);
        let near = if lengths[tip.previous().place()] <= lengths[tip.next().place()] {
            tip.next()
        } else {
            tip.previous()
        };
        let distance = corners[tip.place()].distance(corners[near.place()]);
        // 2. Two corners at one place, or a corner on the longest edge
        let [tip_vertex, near_vertex] = [tip, near].map(|corner| corner.vertex(&self.draft.faces));
        let flipped = if distance > self.same_place && self.may_flip { self.flip(tip) } else { None };
        if let Some(flipped) = flipped {
            return flipped;
        }
        self.joined.join(tip_vertex.index(), near_vertex.index());
        false
    }

    /// Flips the edge opposite to a corner, or drops the face where that edge is open; `None` where neither can be.
    fn flip(&mut self, tip: Corner) -> Option<bool> {
        let faces = &self.draft.faces;
        let [from, to] = tip.half_edge(faces);
        let across: Vec<Corner> =
            self.table.corners([from, to]).filter(|corner| corner.face() != tip.face()).collect();
        let beyond = match across[..] {
            [] => {
                self.changed[tip.face()] = true;
                self.dropped[tip.face()] = true;
                return Some(false);
            }
            [beyond] => beyond,
            _ => return None,
        };
        if self.changed[beyond.face()] {
            // another face was flipped with it: again in the next round
            return Some(false);
        }
        let (tip_vertex, far_vertex) = (tip.vertex(faces), beyond.vertex(faces));
        if tip_vertex == far_vertex || self.table.corners([tip_vertex, far_vertex]).next().is_some() {
            return None;
        }
        let halves = [beyond.next(), beyond.previous()].map(|corner| {
            let mut half = faces[beyond.face()];
            half[corner.place()] = tip_vertex;
            half
        });
        let (kept, removed) = (beyond.face(), tip.face());
        [self.draft.faces[kept], self.draft.faces[removed]] = halves;
        self.draft.face_of[removed] = self.draft.face_of[kept];
        self.draft.turned[removed] = self.draft.turned[kept];
        self.changed[kept] = true;
        self.changed[removed] = true;
        Some(true)
    }
}
