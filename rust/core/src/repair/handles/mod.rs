// SPDX-License-Identifier: MIT OR Apache-2.0
//! Closes handles: the surface is cut along a short loop that does not divide it, and both sides are closed.
//!
//! In rounds, since loops that meet are cut one after the other:
//!
//! 1. Two loops for each handle, by a tree and a cotree ([`generators()`]).
//! 2. For each of them the shortest loop that crosses it once, and the shortest that crosses that once ([`crossing`]):
//!    of a tube through a body one runs around the tube and the other along it.
//! 3. The shortest of these loops are cut, as many as do not meet and together do not divide the surface ([`surgery`]).
//!
//! Boundary loops are closed for the time being; no loop touches them. Cost: a round takes O(n log n) and, for each
//! handle, searches among the vertices as near as the loop is long. Most handles are closed in the first round.

mod closed;
mod crossing;
mod generators;
mod loops;
mod surgery;

use super::draft::Draft;
use super::options::CloseHandles;
use super::pieces::Pieces;
use crate::mesh::geometry::edge_lengths;
use closed::ClosedMesh;
use crossing::CrossingSearch;
use generators::generators;
use loops::Loop;
use surgery::{cut_open, shortest_apart};

/// A handle of noise has a loop of at most this length, over the square root of the area of its piece.
const NOISE_OF_SIZE: f64 = 0.1;

/// And of at most this length, over the mean edge of its piece.
const NOISE_OF_EDGES: f64 = 24.0;

/// A loop may be longer than what is asked for by this share, which rounding of lengths may add where edges are no shorter
/// than 3·10⁻⁴ of the diagonal.
const ROUNDING: f64 = 1e-4;

/// Closes the handles that `which` says, on pieces that are oriented; returns their number. `scale` is the length of the
/// unit of the draft in that of the vertices.
pub(super) fn close_handles(draft: &mut Draft, pieces: &Pieces, which: CloseHandles, scale: f64) -> usize {
    if which == CloseHandles::Off || pieces.has_one_sided {
        return 0;
    }
    let limits = limits(draft, pieces, which, scale);
    let mut closed = 0;
    loop {
        // 1. Two loops for each handle
        let mesh = ClosedMesh::new(draft);
        let generators = generators(&mesh);
        // 2. Short loops
        let mut search = CrossingSearch::new(&mesh);
        let candidates = generators.iter().flat_map(|generator| {
            let limit = piece_of(&mesh, pieces, generator).map_or(0.0, |piece| limits[piece]);
            let across = search.shortest(generator, limit);
            let along = across.as_ref().and_then(|across| search.shortest(across, limit));
            [across, along].into_iter().flatten()
        });
        // 3. Cuts
        let loops = shortest_apart(&mesh, candidates.collect());
        if loops.is_empty() {
            return closed;
        }
        closed += loops.len();
        loops.iter().for_each(|each| cut_open(draft, &mesh, &each.vertices));
    }
}

/// The length of the longest loop to cut on each piece, in the unit of the draft.
fn limits(draft: &Draft, pieces: &Pieces, which: CloseHandles, scale: f64) -> Vec<f64> {
    let on_all = |length: f64| vec![length; pieces.areas.len()];
    match which {
        CloseHandles::Off => on_all(0.0),
        CloseHandles::UpTo(length) => on_all(length / scale * (1.0 + ROUNDING)),
        CloseHandles::All => on_all(f64::INFINITY),
        CloseHandles::Noise => {
            let of_piece = pieces.areas.iter().zip(mean_edges(draft, pieces));
            of_piece.map(|(area, edge)| (NOISE_OF_SIZE * area.sqrt()).min(NOISE_OF_EDGES * edge)).collect()
        }
    }
}

/// The mean length of the edges of each piece, as its faces have them.
fn mean_edges(draft: &Draft, pieces: &Pieces) -> Vec<f64> {
    let mut sums = vec![(0.0, 0.0); pieces.areas.len()];
    for (face, &piece) in pieces.of_face.iter().enumerate() {
        let (length, count) = &mut sums[piece as usize];
        *length += edge_lengths(draft.corners(face)).iter().sum::<f64>();
        *count += 3.0;
    }
    sums.into_iter().map(|(length, count)| length / count).collect()
}

/// The piece of a loop; `None` if it runs inside fillings alone.
fn piece_of(mesh: &ClosedMesh, pieces: &Pieces, each: &Loop) -> Option<usize> {
    let faces = each.vertices.iter().map(|&vertex| mesh.corners.of(vertex)[0].face());
    faces.filter_map(|face| pieces.of_face.get(face.index())).map(|&piece| piece as usize).next()
}
