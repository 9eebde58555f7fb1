// SPDX-License-Identifier: MIT OR Apache-2.0
//! Orients the faces of each piece like most of them, and chooses among the pieces.

use super::draft::Draft;
use super::options::Keep;
use crate::mesh::Face;
use crate::mesh::geometry::area;
use crate::mesh::orientation::{Orientation, consistent};

/// The pieces of a mesh.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Pieces {
    /// The piece of each face.
    pub of_face: Vec<u32>,
    /// The area of each piece, of the mesh scaled to a unit diagonal.
    pub areas: Vec<f64>,
    /// Whether a piece is one-sided, so that it cannot be oriented.
    pub has_one_sided: bool,
}

/// Orients each piece like most of its faces.
pub(super) fn orient(draft: &mut Draft) -> Pieces {
    let Orientation { flipped, conflict, component, first_faces } =
        consistent(draft.points.len(), &draft.faces);
    for face in Face::all(flipped.len()).filter(|&face| flipped[face]) {
        draft.turn_over(face);
    }
    let mut areas = vec![0.0; first_faces.len()];
    for (face, &piece) in component.iter().enumerate() {
        areas[piece as usize] += area(draft.corners(face));
    }
    Pieces { of_face: component, areas, has_one_sided: conflict.is_some() }
}

/// Drops the pieces that are not kept; returns their number.
pub(super) fn choose(draft: &mut Draft, pieces: Pieces, keep: Keep) -> (Pieces, usize) {
    let dropped = pieces.areas.len().saturating_sub(1);
    if keep == Keep::All || dropped == 0 {
        return (pieces, 0);
    }
    let largest = (0..pieces.areas.len()).rev().max_by(|&a, &b| pieces.areas[a].total_cmp(&pieces.areas[b]));
    let largest = largest.unwrap_or_default();
    draft.keep_faces(|_, face| pieces.of_face[face] as usize == largest);
    let kept = Pieces {
        of_face: vec![0; draft.faces.len()],
        areas: vec![pieces.areas[largest]],
        has_one_sided: consistent(draft.points.len(), &draft.faces).conflict.is_some(),
    };
    (kept, dropped)
}
