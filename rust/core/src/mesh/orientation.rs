// SPDX-License-Identifier: MIT OR Apache-2.0
//! A consistent orientation of the faces of each component, by a walk from face to face.
//!
//! The orientation that most faces of a component already have wins; at a tie that of its lowest face.
//! Edges of three or more faces do not connect. Linear in the number of faces.

use super::corners::EdgeTable;
use super::{Corner, Face, Vertex};

/// The faces to flip, and the components.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Orientation {
    /// Whether each face has to be flipped to agree with its component, (m,).
    pub flipped: Vec<bool>,
    /// An edge at which some component cannot be oriented. Its faces are left as given.
    pub conflict: Option<[Vertex; 2]>,
    /// The edge-connected component of each face, (m,). Components are ordered by lowest face.
    pub component: Vec<u32>,
    /// The lowest face of each component.
    pub first_faces: Vec<Face>,
}

/// Orients faces that have not been validated.
///
/// Every index must be below `n_vertices`. Edges of three or more faces are no connections; components that
/// cannot be oriented are left as they are.
///
/// # Panics
/// If an index is out of range.
pub fn consistent(n_vertices: usize, faces: &[[Vertex; 3]]) -> Orientation {
    let opposite = EdgeTable::new(n_vertices, faces).opposites();
    Orientation::propagate(faces, &opposite)
}

impl Orientation {
    /// Orients faces across the pairs of corners in `opposite`.
    pub(crate) fn propagate(faces: &[[Vertex; 3]], opposite: &[Option<Corner>]) -> Self {
        let mut walk = Self {
            flipped: vec![false; faces.len()],
            conflict: None,
            component: vec![u32::MAX; faces.len()],
            first_faces: Vec::new(),
        };
        let mut conflicts = Vec::new();
        for seed in Face::all(faces.len()) {
            if walk.component[seed] == u32::MAX {
                conflicts.push(walk.flood(faces, opposite, seed));
            }
        }
        walk.settle(&conflicts);
        walk
    }

    /// Orients a component like its seed; returns the first edge that contradicts.
    fn flood(
        &mut self,
        faces: &[[Vertex; 3]],
        opposite: &[Option<Corner>],
        seed: Face,
    ) -> Option<[Vertex; 2]> {
        let label = self.first_faces.len() as u32;
        self.first_faces.push(seed);
        self.component[seed] = label;
        let mut conflict = None;
        let mut pending = vec![seed];
        while let Some(face) = pending.pop() {
            let [a, b, c] = faces[face];
            let flipped = self.flipped[face];
            for (side, [from, to]) in [[b, c], [c, a], [a, b]].into_iter().enumerate() {
                let Some(across) = opposite[face.corner(side)] else { continue };
                let agree = across.half_edge(faces)[0] != from;
                let wanted = flipped ^ !agree;
                let neighbor = across.face();
                if self.component[neighbor] == u32::MAX {
                    self.component[neighbor] = label;
                    self.flipped[neighbor] = wanted;
                    pending.push(neighbor);
                } else if self.flipped[neighbor] != wanted {
                    conflict = conflict.or(Some([from.min(to), from.max(to)]));
                }
            }
        }
        conflict
    }

    /// Takes the orientation of the majority of each component; leaves components that cannot be oriented as given.
    fn settle(&mut self, conflicts: &[Option<[Vertex; 2]>]) {
        self.conflict = conflicts.iter().find_map(|conflict| *conflict);
        if !self.flipped.contains(&true) {
            return;
        }
        // positive if most faces of a component are oriented against its lowest face
        let mut majority = vec![0i64; conflicts.len()];
        for (&flipped, &component) in self.flipped.iter().zip(&self.component) {
            majority[component as usize] += if flipped { 1 } else { -1 };
        }
        for (flipped, &component) in self.flipped.iter_mut().zip(&self.component) {
            let component = component as usize;
            *flipped = conflicts[component].is_none() && (*flipped ^ (majority[component] > 0));
        }
    }

    /// Flips the faces: the first corner stays, the other two change places; `opposite` follows.
    pub(crate) fn apply(&self, faces: &mut [[Vertex; 3]], opposite: &mut [Option<Corner>]) {
        if !self.flipped.contains(&true) {
            return;
        }
        for face in Face::all(faces.len()).filter(|&face| self.flipped[face]) {
            faces[face].swap(1, 2);
            opposite.swap(face.corner(1).index(), face.corner(2).index());
        }
        for corner in opposite.iter_mut().flatten() {
            *corner = self.moved(*corner);
        }
    }

    /// The corner after [`Self::apply`] of a corner of the faces as given.
    fn moved(&self, corner: Corner) -> Corner {
        if self.flipped[corner.face()] { corner.mirrored() } else { corner }
    }
}
