// SPDX-License-Identifier: MIT OR Apache-2.0
//! Maps without folds from which the guarded descent starts.

use crate::codomain::SpatialMap;
use crate::codomain::planar::{flat, lifted};
use crate::control::{History, Observer, Phase, Status, Watch};
use crate::disk::boundary::arc_length;
use crate::disk::options::Boundary;
use crate::disk::published::fixed_point::fixed_point;
use crate::disk::published::objective::DiskObjective;
use crate::disk::run::{QUICK, Run, watched};
use crate::disk::{certificate, start, unfold};
use crate::embedding::{Stop, progressive_disk};
use crate::error::Error;
use crate::optimize::gauss_newton::{GaussNewtonOptions, Problem, minimize};
use crate::optimize::published::Stopping;

/// Limit of the fixed-point steps.
const FIXED_POINT_STEPS: usize = 5;

/// The fixed-point steps end when √(gᵀM⁻¹g) is below this, at an E_A of about 0.05: Gauss–Newton gains more from there.
const NEAR: f64 = 0.15;

/// Unguarded iterations, which lose angles: the number on large surfaces without folds, and the limit.
const OPEN_ITERATIONS: [usize; 2] = [8, 12];

/// A map with a face below this part of its target has collapsed beyond what a descent can mend.
const COLLAPSED: f64 = 1e-9;

/// On surfaces with more vertices, unguarded iterations, which may be in single precision, replace guarded ones even
/// where nothing is folded.
pub(super) const LARGE: usize = 500_000;

const MESSAGE: &str = "Start map";

impl Run<'_> {
    /// A map without folds near the minimum by fixed-point steps and an unguarded descent; `None` where folds remain.
    pub(super) fn quick_start(
        &self,
        problem: &Problem,
        guarded: GaussNewtonOptions,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> (Option<SpatialMap>, Status) {
        // 1. Fixed-point steps, or the map given
        let mut phase = Phase { whole: observer, from: 0.0, to: 0.5 };
        let (stepped, status) = match self.fixed_point_steps(problem, history, &mut phase) {
            Ok(reached) => reached,
            Err(Error::CancelledEarly) => return (None, Status::Cancelled),
            Err(_) => return (None, Status::Stalled),
        };
        let is_embedding = problem.energy.is_embedding(&stepped);
        if status == Status::Cancelled || (is_embedding && self.options.initial.is_some()) {
            return (is_embedding.then_some(stepped), status);
        }
        // 2. Unguarded steps until nothing is folded; no further ones where angles count, which they lose
        let [least, most] = OPEN_ITERATIONS;
        let is_done = self.options.angle_weight > 0.0 || self.options.area_tolerance.is_some();
        let least = match self.mesh.n_vertices() {
            _ if is_done => 0,
            LARGE.. => least,
            _ => 0,
        };
        let options = guarded.unguarded([least, most]);
        let mut phase = Phase { whole: observer, from: 0.5, to: 1.0 };
        let (open, status) = minimize(problem, stepped.clone(), &options, history, &mut phase);
        // 3. The best of these maps without folds
        if problem.energy.is_embedding(&open) {
            return (Some(open), status);
        }
        if is_embedding {
            return (Some(stepped), status);
        }
        let unfolded =
            if status == Status::Cancelled { None } else { unfold::unfold(self.mesh, &flat(&open)) };
        let is_good =
            |map: &SpatialMap| problem.energy.is_embedding(map) && self.has_not_collapsed(problem, map);
        (unfolded.map(|map| lifted(&map)).filter(is_good), status)
    }

    /// The harmonic map and fixed-point steps from it, or the map given.
    fn fixed_point_steps(
        &self,
        problem: &Problem,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> Result<(SpatialMap, Status), Error> {
        if let Some(initial) = self.options.initial_rows() {
            return Ok((lifted(initial), Status::MaxIterations));
        }
        let mut objective = DiskObjective::new(self.mesh, problem.energy.targets(), self.options.boundary)?;
        let start = start::start(self.mesh, &mut objective, &Watch::new(observer, 0.0, MESSAGE))?;
        let stopping = Stopping { max_iterations: FIXED_POINT_STEPS, tolerance: NEAR };
        let (map, status) = fixed_point(&mut objective, start, &stopping, history, observer);
        Ok((lifted(&map), status))
    }

    /// Tutte's embedding, or the progressive one where that collapses.
    pub(super) fn safe_start(
        &self,
        problem: &Problem,
        status: Status,
        observer: &mut dyn Observer,
    ) -> Result<(SpatialMap, Status), Error> {
        if status == Status::Cancelled && self.mesh.n_vertices() > QUICK {
            return Err(Error::CancelledEarly);
        }
        let mut objective = DiskObjective::new(self.mesh, problem.energy.targets(), Boundary::ArcLength)?;
        let boundary = arc_length(self.mesh);
        let tutte = watched(status, observer, 0.0, MESSAGE, |watch| {
            start::tutte(self.mesh, &mut objective, boundary, watch).map(|map| lifted(&map))
        });
        let holds = |map: &SpatialMap| problem.energy.is_embedding(map);
        let last_resort = |tutte: Result<SpatialMap, Error>| tutte.and_then(|tutte| self.last_resort(tutte));
        let is_held = self.options.boundary == Boundary::ArcLength;
        let is_good = |map: &&SpatialMap| holds(map) && (is_held || self.has_not_collapsed(problem, map));
        if let Some(tutte) = tutte.iter().find(is_good) {
            return Ok((tutte.clone(), status));
        }
        if is_held {
            // the progressive embedding has a boundary of its own
            return Ok((last_resort(tutte)?, status));
        }
        match progressive_disk(self.mesh, problem.energy.targets(), observer).map(|map| lifted(&map)) {
            Ok(map) if holds(&map) => Ok((map, status)),
            Err(Stop::Cancelled) => {
                let map = last_resort(tutte).map_err(|_| Error::CancelledEarly)?;
                Ok((map, Status::Cancelled))
            }
            _ => Ok((last_resort(tutte)?, status)),
        }
    }

    /// Any map without folds, however small its faces.
    fn last_resort(&self, tutte: SpatialMap) -> Result<SpatialMap, Error> {
        certificate::refuse_folds(self.mesh, &flat(&tutte))?;
        Ok(tutte)
    }

    fn has_not_collapsed(&self, problem: &Problem, map: &SpatialMap) -> bool {
        let (areas, targets) = (problem.energy.areas(map), problem.energy.targets());
        let least = COLLAPSED * areas.iter().sum::<f64>() / targets.iter().sum::<f64>();
        areas.iter().zip(targets).all(|(area, target)| *area > least * target)
    }
}
