// SPDX-License-Identifier: MIT OR Apache-2.0
//! Closes holes: one of three edges by a face, larger ones by a smooth membrane.

use super::draft::Draft;
use super::options::{CloseHoles, RepairOptions};
use super::pieces::Pieces;
use crate::filling::{is_fat, membrane, spanned_area};
use crate::mesh::{Topology, Vertex, VertexCorners};

/// A pinhole has at most so many edges.
const PINHOLE_EDGES: usize = 8;

/// A pinhole is at most this part of its piece.
const PINHOLE_SHARE: f64 = 0.1;

/// Closes the holes that the options ask for; returns their number.
pub(super) fn close_holes(draft: &mut Draft, pieces: &Pieces, options: &RepairOptions) -> usize {
    if options.close_holes == CloseHoles::Off {
        return 0;
    }
    let corners = VertexCorners::new(draft.points.len(), &draft.faces);
    let holes = chosen(draft, &corners, pieces, options);
    for hole in &holes {
        // a piece of a single face has its own face as its hole
        let is_face = hole.iter().all(|&vertex| corners.of(vertex).len() == 1);
        close(draft, hole, hole.len() == 3 && !is_face);
    }
    draft.admit_added();
    holes.len()
}

/// The boundary loops to close, the surface on their left.
fn chosen(
    draft: &Draft,
    corners: &VertexCorners,
    pieces: &Pieces,
    options: &RepairOptions,
) -> Vec<Vec<Vertex>> {
    let mut outline_seen = vec![false; pieces.areas.len()];
    let mut loops = Topology::of_faces(&draft.points, &draft.faces).boundary_loops;
    // the longest loop comes first
    loops.retain(|hole| {
        let piece = pieces.of_face[corners.of(hole[0])[0].face()] as usize;
        let is_outline = options.keep_outline && !std::mem::replace(&mut outline_seen[piece], true);
        let is_chosen = match options.close_holes {
            CloseHoles::Off => false,
            CloseHoles::All => true,
            CloseHoles::UpTo(edges) => hole.len() <= edges,
            CloseHoles::Pinholes => {
                let rim: Vec<_> = hole.iter().map(|&vertex| draft.points[vertex]).collect();
                hole.len() <= PINHOLE_EDGES && spanned_area(&rim) <= PINHOLE_SHARE * pieces.areas[piece]
            }
        };
        is_chosen && !is_outline
    });
    loops
}

/// Closes one hole, by a single face where `may_be_face` and that has an area.
pub(super) fn close(draft: &mut Draft, hole: &[Vertex], may_be_face: bool) {
    if let &[a, b, c] = hole
        && may_be_face
        && is_fat([a, b, c].map(|vertex| draft.points[vertex]))
    {
        draft.faces.push([b, a, c]);
        return;
    }
    membrane(hole, &mut draft.points, &mut draft.faces);
}
