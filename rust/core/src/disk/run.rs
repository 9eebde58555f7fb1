// SPDX-License-Identifier: MIT OR Apache-2.0
//! One computation on a surface with one boundary loop.

use ndarray::aview2;

use super::options::DiskMapOptions;
use crate::codomain::planar::PlanarMap;
use crate::control::{Observer, Silent, Status, Watch};
use crate::error::Error;
use crate::mesh::renumbering::Renumbered;
use crate::mesh::{Face, TriangleMesh};
use crate::sparse::elimination_order;

/// A cancelled run without a map still computes one on surfaces of up to this many vertices.
pub(super) const QUICK: usize = 50_000;

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
    /// A map computed on the mesh in elimination order. `compute` is told whether the observer has ended the run
    /// already.
    ///
    /// # Errors
    /// The errors of `compute`, with faces as given; [`Error::CancelledEarly`] where the observer has ended the run
    /// already and the surface is large.
    pub(super) fn in_elimination_order(
        &self,
        observer: &mut dyn Observer,
        compute: impl FnOnce(&Run<'_>, bool, &mut dyn Observer) -> Result<(PlanarMap, Status), Error>,
    ) -> Result<(PlanarMap, Status), Error> {
        let is_cancelled = !observer.progress(0.0, "Ordering");
        if is_cancelled && self.mesh.n_vertices() > QUICK {
            return Err(Error::CancelledEarly);
        }
        let order = elimination_order(self.mesh.n_vertices(), self.mesh.faces())?;
        let by_order = Renumbered::new(self.mesh, order);
        let targets = by_order.of_faces(self.targets);
        let initial = self.options.initial_rows().map(|map| by_order.of_vertices(map));
        let options =
            DiskMapOptions { initial: initial.as_deref().map(aview2), density: None, ..*self.options };
        let run = Run { mesh: &by_order.mesh, targets: &targets, options: &options, ..*self };
        let given_face = |face| self.given_face(by_order.given_face(face));
        let (map, status) =
            compute(&run, is_cancelled, observer).map_err(|error| error.with_faces(given_face))?;
        Ok((by_order.given(&map), status))
    }

    /// The given face that stands for `face`: itself, or for a face that fills a hole its neighbor across the hole's
    /// edge.
    pub(super) fn given_face(&self, face: usize) -> usize {
        // the third corner of a fan's face is its apex, which faces the edge
        let beside =
            || self.mesh.opposite(Face::new(face).corner(2)).map_or(0, |corner| corner.face().index());
        if face < self.n_given_faces { face } else { beside() }
    }
}

/// Calls `compute` with a watch, a silent one where the run is cancelled already, which has no one to ask.
pub(super) fn watched<T>(
    status: Status,
    observer: &mut dyn Observer,
    fraction: f64,
    message: &str,
    compute: impl FnOnce(&Watch<'_>) -> T,
) -> T {
    match status {
        Status::Cancelled => compute(&Watch::new(&mut Silent, fraction, message)),
        _ => compute(&Watch::new(observer, fraction, message)),
    }
}
