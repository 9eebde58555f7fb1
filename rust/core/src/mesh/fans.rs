// SPDX-License-Identifier: MIT OR Apache-2.0
//! The fans of faces around vertices: corners that belong together because faces are joined across edges.

use super::{Corner, Vertex};
use crate::sets::Sets;

/// The corners, as sets of those that are one vertex: the ends of every edge across which two faces are joined.
pub(crate) fn fans(faces: &[[Vertex; 3]], opposite: &[Option<Corner>]) -> Sets {
    let mut joined = Sets::new(3 * faces.len());
    for corner in Corner::all(faces.len()) {
        // each pair once
        let Some(across) = opposite[corner].filter(|&across| across > corner) else { continue };
        let [mut first, mut second] = [across.next(), across.previous()];
        if corner.next().vertex(faces) != first.vertex(faces) {
            [first, second] = [second, first];
        }
        joined.join(corner.next().index(), first.index());
        joined.join(corner.previous().index(), second.index());
    }
    joined
}
