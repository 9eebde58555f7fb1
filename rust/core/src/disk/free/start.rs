// SPDX-License-Identifier: MIT OR Apache-2.0
//! A map that is one-to-one to start from.

use super::apart::pushed_apart;
use super::lscm::of_area_one;
use super::outline::Outline;
use super::starts;
use super::surface::{Free, Prepared, QuickStart, Schedule};
use crate::codomain::planar::PlanarMap;
use crate::control::{History, Observer, Rising, Status, Watch};
use crate::disk::certificate;
use crate::disk::holes;
use crate::disk::options::{Boundary, DiskMapOptions};
use crate::disk::run::Run;
use crate::error::Error;
use crate::sparse::Failure;

/// Weight of angles of the map to the disk that takes the place of a start; it keeps the shear low.
const DISK_WEIGHT: f64 = 1.0;

/// Iteration limit of that map.
const DISK_ITERATIONS: usize = 15;

/// A start with an energy above this has collapsed, as conformal maps of long tubes do; the map to the disk is tried
/// too.
const COLLAPSED: f64 = 1e4;

/// Starts are compared with at least this weight of angles.
const LEAST_WEIGHT: f64 = 1e-3;

/// A map to start from.
pub(super) enum Start {
    /// The given one, which is one-to-one, or was made so.
    Given(PlanarMap),
    /// One that is one-to-one.
    Computed(PlanarMap),
    /// The run ends here.
    Ended(PlanarMap, Status),
}

impl Free<'_> {
    /// A one-to-one map to start from.
    pub(super) fn start(&self, prepared: &Prepared<'_>, observer: &mut dyn Observer) -> Result<Start, Error> {
        let outline = (!self.options.overlap).then_some(prepared.outline);
        let observer: &mut dyn Observer = &mut Rising::new(observer);
        let watch = Watch::new(&mut *observer, 0.0, "Start map");
        if let Some(start) = self.given_start(prepared, outline, &watch) {
            return Ok(start);
        }
        let weight = self.options.angle_weight.max(LEAST_WEIGHT);
        let (map, status) =
            match starts::best_start(prepared.energy, prepared.analysis, outline, weight, &watch) {
                Ok(Some((energy, map))) if energy <= COLLAPSED => Ok((map, None)),
                Ok(Some((energy, map))) => self.better_start(prepared, (energy, map), observer),
                Ok(None) | Err(Failure::NotPositiveDefinite) => self.disk_start(prepared, observer),
                Err(Failure::Cancelled) => self.disk_start(prepared, &mut |_: f64, _: &str| false),
            }?;
        Ok(match status {
            Some(status) => Start::Ended(map, status),
            None => Start::Computed(map),
        })
    }

    /// The start that is given, if it can be used.
    fn given_start(
        &self,
        prepared: &Prepared<'_>,
        outline: Option<&Outline>,
        watch: &Watch<'_>,
    ) -> Option<Start> {
        let energy = prepared.energy;
        if let Some(shapes) = self.shapes() {
            return starts::assembled(energy, outline, shapes, watch).map(Start::Computed);
        }
        let initial = of_area_one(energy, self.options.initial_rows()?.to_vec());
        if let Some(map) = starts::allowed(energy, outline, initial.clone()) {
            return Some(Start::Given(map));
        }
        let Schedule::Quick { start: Some(QuickStart::Initial { weight }), .. } = self.schedule else {
            return None;
        };
        let apart = pushed_apart(prepared, initial.clone(), weight, watch);
        Some(apart.map_or(Start::Ended(initial, Status::Stalled), Start::Given))
    }

    /// The given start or the map to the disk, whichever has the lower energy.
    fn better_start(
        &self,
        prepared: &Prepared<'_>,
        start: starts::Start,
        observer: &mut dyn Observer,
    ) -> Result<(PlanarMap, Option<Status>), Error> {
        let (energy, map) = start;
        let weight = self.options.angle_weight.max(LEAST_WEIGHT);
        match self.disk_start(prepared, observer) {
            Ok((disk, status)) if prepared.energy.value(&disk, weight) < energy => Ok((disk, status)),
            Ok((_, status)) => Ok((map, status)),
            Err(_) => Ok((map, None)),
        }
    }

    /// An area-preserving map to the disk with a sliding boundary, the holes filled on the way.
    fn disk_start(
        &self,
        prepared: &Prepared<'_>,
        observer: &mut dyn Observer,
    ) -> Result<(PlanarMap, Option<Status>), Error> {
        let filled = match self.mesh.boundary_loops().len() {
            1 => None,
            _ => Some(holes::fill_holes(self.mesh, self.targets)?),
        };
        let (mesh, targets) =
            filled.as_ref().map_or((self.mesh, self.targets), |fill| (&fill.mesh, &fill.targets));
        let mut evened_out = |angle_weight: f64, max_iterations: Option<usize>| {
            let boundary = Boundary::Sliding;
            let options = DiskMapOptions { boundary, angle_weight, max_iterations, ..Default::default() };
            let run = Run { mesh, targets, options: &options, n_given_faces: self.mesh.n_faces() };
            let (mut map, status) = run.renumbered(&mut History::start(), observer)?;
            map.truncate(self.mesh.n_vertices());
            // Rounding may fold slivers of a scaled map.
            let scaled = of_area_one(prepared.energy, map.clone());
            let map = if certificate::folded(self.mesh, &scaled).is_empty() { scaled } else { map };
            let is_cancelled = status == Status::Cancelled;
            Ok((map, is_cancelled.then_some(Status::Cancelled)))
        };
        let (map, status) = evened_out(DISK_WEIGHT, Some(DISK_ITERATIONS))?;
        if status.is_some() || prepared.energy.value(&map, LEAST_WEIGHT) <= COLLAPSED {
            return Ok((map, status));
        }
        evened_out(0.0, None)
    }
}
