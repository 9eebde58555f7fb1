// SPDX-License-Identifier: MIT OR Apache-2.0
//! One computation from start map to a map without folds.
//!
//! First the papers' method as published, which may fold; then, only where it did or nearly did, unfolding and a
//! descent behind a barrier; last of all the same descent from Tutte's embedding.

use super::fixed_point::fixed_point;
use super::objective::DiskObjective;
use crate::codomain::planar::PlanarMap;
use crate::control::{History, Observer, Phase, Status, Watch};
use crate::disk::boundary::arc_length;
use crate::disk::options::DiskMethod;
use crate::disk::run::Run;
use crate::disk::{certificate, start, unfold};
use crate::error::{Elements, Error, NumericsError};
use crate::optimize::published::nonlinear_cg::{CgOptions, minimize};
use crate::optimize::published::{Objective as _, Stopping};

/// Fixed-point steps before the conjugate gradients, the paper's 5.
const FIXED_POINT_STEPS: usize = 5;

/// Conjugate gradient iterations with one preconditioner, the paper's 50.
const ROUND: usize = 50;

const MESSAGE: &str = "Minimizing the stretch energy";

impl Run<'_> {
    /// The papers' method, then the steps that leave no folded face.
    pub(crate) fn solve(
        &self,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> Result<(PlanarMap, Status), Error> {
        let mut objective = DiskObjective::new(self.mesh, self.targets, self.options.boundary)?;
        // 1. The method as published
        let (map, status) = self.as_published(&mut objective, history, observer)?;
        let bijective = certificate::is_bijective(self.mesh, &map);
        if bijective && (status == Status::Cancelled || !objective.nearly_folds(&map)) {
            return Ok((map, status));
        }
        // 2. Unfold folded faces, then a descent that keeps every face open
        objective.guard();
        let mended = if bijective { Some(map) } else { unfold::unfold(self.mesh, &map) };
        let mut phase = Phase { whole: observer, from: 0.8, to: 0.9 };
        let mended = mended.map(|map| self.descend(&mut objective, map, status, history, &mut phase));
        // 3. Where that fails or leaves a face nearly folded, the same descent from Tutte's embedding
        match mended {
            Some((map, status)) if status == Status::Cancelled || !objective.nearly_folds(&map) => {
                Ok((map, status))
            }
            mended => {
                let mut phase = Phase { whole: observer, from: 0.9, to: 1.0 };
                self.descend_from_tutte(&mut objective, mended, status, history, &mut phase)
            }
        }
    }

    /// Tutte's embedding and the guarded descent from it, or `mended` where that is the better map.
    fn descend_from_tutte(
        &self,
        objective: &mut DiskObjective<'_>,
        mended: Option<(PlanarMap, Status)>,
        status: Status,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> Result<(PlanarMap, Status), Error> {
        let tutte =
            start::tutte(self.mesh, objective, arc_length(self.mesh), &Watch::new(observer, 0.0, MESSAGE))?;
        let folded = certificate::folded(self.mesh, &tutte);
        match (Elements::collect(folded.into_iter().map(|face| self.given_face(face))), mended) {
            (Some(folded), None) => Err(NumericsError::NoEmbedding { folded }.into()),
            (Some(_), Some(mended)) => Ok(mended),
            (None, None) => Ok(self.descend(objective, tutte, status, history, observer)),
            (None, Some(mended)) => {
                let descended = self.descend(objective, tutte, status, history, observer);
                let is_better = objective.value(&descended.0) < objective.value(&mended.0);
                Ok(if is_better { descended } else { mended })
            }
        }
    }

    /// Harmonic start, fixed-point steps, conjugate gradients; may fold.
    fn as_published(
        &self,
        objective: &mut DiskObjective<'_>,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> Result<(PlanarMap, Status), Error> {
        // 1. The start map, fixed-point steps from it
        let (map, status) = match (self.options.initial_rows(), self.options.method) {
            (Some(initial), DiskMethod::ConjugateGradient) => (initial.to_vec(), Status::MaxIterations),
            (initial, method) => {
                let watch = Watch::new(observer, 0.0, MESSAGE);
                let begin = || start::start(self.mesh, objective, &watch);
                let start = initial.map_or_else(begin, |map| Ok(map.to_vec()))?;
                let to = if method == DiskMethod::FixedPoint { 0.8 } else { 0.2 };
                let mut phase = Phase { whole: observer, from: 0.0, to };
                fixed_point(objective, start, &self.fixed_point_stopping(), history, &mut phase)
            }
        };
        if self.options.method == DiskMethod::FixedPoint || status == Status::Cancelled {
            return Ok((map, status));
        }
        // 2. Conjugate gradients
        let mut phase = Phase { whole: observer, from: 0.2, to: 0.8 };
        Ok(self.conjugate_gradients(objective, map, history, &mut phase))
    }

    /// Conjugate gradients in rounds of at most [`ROUND`] iterations, each with the preconditioner of the
    /// map it begins with.
    ///
    /// The first round is the paper's Algorithm 3.1; a preconditioner from far away slows later ones, and a
    /// round that stalls may go on with a new one.
    fn conjugate_gradients(
        &self,
        objective: &mut DiskObjective<'_>,
        mut map: PlanarMap,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> (PlanarMap, Status) {
        let whole = self.stopping();
        let fraction = |done: usize| done as f64 / whole.max_iterations.max(1) as f64;
        let (begun, mut done) = (history.iterations(), 0);
        loop {
            let budget = ROUND.min(whole.max_iterations - done);
            let options =
                CgOptions { stopping: Stopping { max_iterations: budget, ..whole }, ..CgOptions::default() };
            let mut round = Phase { whole: observer, from: fraction(done), to: fraction(done + budget) };
            match objective.set_preconditioner(&map, &Watch::new(&mut round, 0.0, MESSAGE)) {
                Ok(()) => {}
                Err(Error::CancelledEarly) => return (map, Status::Cancelled),
                Err(_) => return (map, Status::Stalled),
            }
            let (reached, status) = minimize(objective, map, &options, history, &mut round);
            let advanced = history.iterations() - begun > done;
            done = history.iterations() - begun;
            match status {
                Status::MaxIterations if done < whole.max_iterations => map = reached,
                Status::Stalled if advanced => map = reached,
                status => return (reached, status),
            }
        }
    }

    /// Conjugate gradients that keep an unfolded map unfolded; a run already cancelled returns the map unchanged.
    fn descend(
        &self,
        objective: &mut DiskObjective<'_>,
        map: PlanarMap,
        status: Status,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> (PlanarMap, Status) {
        if status == Status::Cancelled || !objective.value(&map).is_finite() {
            return (map, if status == Status::Cancelled { status } else { Status::Stalled });
        }
        self.conjugate_gradients(objective, map, history, observer)
    }

    fn stopping(&self) -> Stopping {
        let default = Stopping::default();
        Stopping {
            max_iterations: self.options.max_iterations.unwrap_or(default.max_iterations),
            tolerance: self.options.tolerance.unwrap_or(default.tolerance),
        }
    }

    /// The paper's few steps before conjugate gradients, or all where the fixed point is the method.
    fn fixed_point_stopping(&self) -> Stopping {
        let whole = self.stopping();
        match self.options.method {
            DiskMethod::FixedPoint => whole,
            DiskMethod::ConjugateGradient | DiskMethod::GaussNewton => {
                Stopping { max_iterations: whole.max_iterations.min(FIXED_POINT_STEPS), ..whole }
            }
        }
    }
}
