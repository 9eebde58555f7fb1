// SPDX-License-Identifier: MIT OR Apache-2.0
//! A map that is one-to-one to start from.

use super::lscm::of_area_one;
use super::starts;
use super::surface::{Free, Prepared};
use crate::codomain::planar::PlanarMap;
use crate::control::{History, Observer, Status, Watch};
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

impl Free<'_> {
    /// A one-to-one map to start from, and a flag that the observer ended the run.
    pub(super) fn start(
        &self,
        prepared: &Prepared<'_>,
        observer: &mut dyn Observer,
    ) -> Result<(PlanarMap, bool), Error> {
        let outline = (!self.options.overlap).then_some(prepared.outline);
        if let Some(initial) = self.options.initial_rows() {
            let initial = of_area_one(prepared.energy, initial.to_vec());
            if let Some(map) = starts::allowed(prepared.energy, outline, initial) {
                return Ok((map, false));
            }
        }
        let watch = Watch::new(observer, 0.0, "Start map");
        let weight = self.options.angle_weight.max(LEAST_WEIGHT);
        match starts::best_start(prepared.energy, prepared.analysis, outline, weight, &watch) {
            Ok(Some((energy, map))) if energy <= COLLAPSED => Ok((map, false)),
            Ok(Some((energy, map))) => self.better_start(prepared, (energy, map), observer),
            Ok(None) | Err(Failure::NotPositiveDefinite) => self.disk_start(prepared, observer),
            Err(Failure::Cancelled) => self.disk_start(prepared, &mut |_: f64, _: &str| false),
        }
    }

    /// The given start or the map to the disk, whichever has the lower energy.
    fn better_start(
        &self,
        prepared: &Prepared<'_>,
        start: starts::Start,
        observer: &mut dyn Observer,
    ) -> Result<(PlanarMap, bool), Error> {
        let (energy, map) = start;
        let weight = self.options.angle_weight.max(LEAST_WEIGHT);
        match self.disk_start(prepared, observer) {
            Ok((disk, is_cancelled)) if prepared.energy.value(&disk, weight) < energy => {
                Ok((disk, is_cancelled))
            }
            Ok((_, is_cancelled)) => Ok((map, is_cancelled)),
            Err(_) => Ok((map, false)),
        }
    }

    /// An area-preserving map to the disk with a sliding boundary, the holes filled on the way.
    fn disk_start(
        &self,
        prepared: &Prepared<'_>,
        observer: &mut dyn Observer,
    ) -> Result<(PlanarMap, bool), Error> {
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
            Ok((of_area_one(prepared.energy, map), status == Status::Cancelled))
        };
        let (map, is_cancelled) = evened_out(DISK_WEIGHT, Some(DISK_ITERATIONS))?;
        if is_cancelled || prepared.energy.value(&map, LEAST_WEIGHT) <= COLLAPSED {
            return Ok((map, is_cancelled));
        }
        evened_out(0.0, None)
    }
}
