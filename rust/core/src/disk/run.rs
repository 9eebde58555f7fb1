// SPDX-License-Identifier: MIT OR Apache-2.0
//! One computation on a surface with one boundary loop.

use super::options::DiskMapOptions;
use crate::mesh::TriangleMesh;

/// One computation on a surface with one boundary loop.
#[derive(Clone, Copy)]
pub(super) struct Run<'a> {
    pub mesh: &'a TriangleMesh,
    pub targets: &'a [f64],
    pub options: &'a DiskMapOptions<'a>,
    /// Later faces fill holes; no message may name them.
    pub n_given_faces: usize,
}

impl Run<'_> {
    /// The given face that stands for `face`: itself, or for a face that fills a hole its neighbor across the hole's edge.
    pub(super) fn given_face(&self, face: usize) -> usize {
        // the third corner of a fan's face is its apex, which faces the edge
        let beside = || self.mesh.opposite(3 * face as u32 + 2).map_or(0, |corner| corner as usize / 3);
        if face < self.n_given_faces { face } else { beside() }
    }
}
