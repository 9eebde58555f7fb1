// SPDX-License-Identifier: MIT OR Apache-2.0
//! Orients the faces of each piece like most of them, and chooses among the pieces.

use super::draft::Draft;
use super::options::Keep;
use crate::error::{Elements, MeshError};
use crate::mesh::Face;
use crate::mesh::geometry::area;
use crate::mesh::orientation::{Orientation, consistent};
use crate::mesh::ties::first_largest;

/// The pieces of a mesh.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Pieces {
    /// The piece of each face.
    pub of_face: Vec<u32>,
    /// The area of each piece, of the mesh scaled to a unit diagonal.
    pub areas: Vec<f64>,
    /// The lowest face of each piece.
    pub first_faces: Vec<Face>,
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
    Pieces { of_face: component, areas, first_faces, has_one_sided: conflict.is_some() }
}

/// Drops the pieces that are not kept; returns their number.
///
/// # Errors
/// [`MeshError::NoMainPiece`] where the main one is asked for and none is.
pub(super) fn choose(draft: &mut Draft, pieces: Pieces, keep: Keep) -> Result<(Pieces, usize), MeshError> {
    let dropped = pieces.areas.len().saturating_sub(1);
    if keep == Keep::All || dropped == 0 {
        return Ok((pieces, 0));
    }
    let largest = first_largest(&pieces.areas).unwrap_or_default();
    if keep == Keep::Main && 2.0 * pieces.areas[largest] <= pieces.areas.iter().sum() {
        let given = pieces.first_faces.iter().filter_map(|&face| draft.face_of[face]);
        return Err(
            Elements::collect(given).map_or(MeshError::NoFaces, |faces| MeshError::NoMainPiece { faces })
        );
    }
    draft.keep_faces(|_, face| pieces.of_face[face] as usize == largest);
    let kept = Pieces {
        of_face: vec![0; draft.faces.len()],
        areas: vec![pieces.areas[largest]],
        first_faces: vec![Face::default()],
        has_one_sided: consistent(draft.points.len(), &draft.faces).conflict.is_some(),
    };
    Ok((kept, dropped))
}
