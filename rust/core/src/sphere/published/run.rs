// SPDX-License-Identifier: MIT OR Apache-2.0
//! One computation from start map to a map without folds.
//!
//! First the papers' method as published, which may fold; then, only where it did, the bijectivity correction
//! and a descent behind a barrier, from the corrected map or else from the start.

use super::fixed_point::{FixedPointStopping, fixed_point};
use super::objective::SphereObjective;
use crate::codomain::SpatialMap;
use crate::codomain::spherical::onto_sphere;
use crate::control::{History, Observer, Phase, Status, Watch};
use crate::distortion::folded_on_sphere;
use crate::embedding::{Stop, progressive_sphere, relaxed};
use crate::error::Error;
use crate::optimize::published::gradient_descent::{DescentOptions, minimize};
use crate::optimize::published::{Objective as _, Stopping};
use crate::parallel;
use crate::sphere::options::SphereMethod;
use crate::sphere::run::Run;
use crate::sphere::{start, unfold};

/// Iteration limit of either method, as in the paper's tables.
const ITERATIONS: usize = 100;

/// Limit of the fixed-point steps before the gradient descent; few meshes gain by more.
const FIXED_POINT_STEPS: usize = 10;

/// ε of Algorithm 2.
const FIXED_POINT_TOLERANCE: f64 = 1e-6;

/// A correction may multiply E_A by at most this; beyond, it has unfolded faces by shrinking them.
const DEAREST_CORRECTION: f64 = 2.0;

/// Iterations of a guarded descent with one preconditioner.
const ROUND: usize = 10;

impl Run<'_> {
    /// The papers' method, then the steps that leave no folded face.
    pub(crate) fn solve(
        &self,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> Result<(SpatialMap, Status), Error> {
        let mut objective = SphereObjective::new(self.mesh, self.targets);
        // 1. Start map and fixed-point steps
        let start = self.start(&mut Phase { whole: observer, from: 0.0, to: 0.05 })?;
        let mut phase = Phase { whole: observer, from: 0.05, to: 0.4 };
        let (stepped, status) = self.fixed_point(&objective, &start, history, &mut phase);
        // 2. The paper's correction
        let stepped = self.corrected(&objective, &stepped, history).unwrap_or(stepped);
        // 3. Gradient descent
        let mut phase = Phase { whole: observer, from: 0.4, to: 0.8 };
        let (map, status) = self.gradient_descent(&objective, stepped.clone(), status, history, &mut phase);
        if !self.options.unfold || self.folded(&map).is_empty() {
            return Ok((map, status));
        }
        // 4. The correction again, or else the best map without folds, and a descent from there that keeps every face open
        let (map, status) = self.mended(&mut objective, map, &start, status, history, observer)?;
        // 5. Never worse than an earlier map without folds
        let energy = energy_share(&objective, &map);
        let better = [start, stepped]
            .into_iter()
            .filter(|earlier| energy_share(&objective, earlier) < energy && self.folded(earlier).is_empty());
        match better.min_by(|a, b| energy_share(&objective, a).total_cmp(&energy_share(&objective, b))) {
            Some(earlier) => Ok((recorded(&objective, earlier, history), status)),
            None => Ok((map, status)),
        }
    }

    /// A map without folds from one with folds; for a run already cancelled the cheapest.
    fn mended(
        &self,
        objective: &mut SphereObjective<'_>,
        map: SpatialMap,
        start: &SpatialMap,
        status: Status,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> Result<(SpatialMap, Status), Error> {
        let corrected = self.corrected(objective, &map, history);
        if status == Status::Cancelled && (corrected.is_some() || self.folded(start).is_empty()) {
            return Ok((corrected.unwrap_or_else(|| start.clone()), status));
        }
        objective.guard();
        let (unfolded, status) = match corrected {
            Some(map) => (map, status),
            None => {
                let mut phase = Phase { whole: observer, from: 0.8, to: 0.9 };
                self.rescued(objective, &map, history, &mut phase)?
            }
        };
        let mut phase = Phase { whole: observer, from: 0.9, to: 1.0 };
        Ok(self.guarded_descent(objective, unfolded, status, history, &mut phase))
    }

    /// The unfolded map; `None` where it raises E_A beyond what a descent can be expected to win back.
    fn corrected(
        &self,
        objective: &SphereObjective<'_>,
        map: &SpatialMap,
        history: &mut History,
    ) -> Option<SpatialMap> {
        if !self.options.unfold || self.folded(map).is_empty() {
            return None;
        }
        let unfolded = unfold::unfold(self.mesh, map)?;
        let is_cheap =
            energy_share(objective, &unfolded) <= DEAREST_CORRECTION * energy_share(objective, map);
        is_cheap.then(|| recorded(objective, unfolded, history))
    }

    /// Of the unfolded map and the progressive one, both relaxed, the one with the lower guarded objective.
    fn rescued(
        &self,
        objective: &SphereObjective<'_>,
        map: &SpatialMap,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> Result<(SpatialMap, Status), Error> {
        let mut phase = Phase { whole: observer, from: 0.0, to: 0.4 };
        let progressive = progressive_sphere(self.mesh, self.targets, &mut phase);
        let is_cancelled = progressive.as_ref().is_err_and(|stop| *stop == Stop::Cancelled);
        let mut status = if is_cancelled { Status::Cancelled } else { Status::MaxIterations };
        let unfolded = [unfold::unfold(self.mesh, map), progressive.ok()];
        let mut best = None;
        for (half, mut map) in unfolded.into_iter().flatten().enumerate() {
            if status != Status::Cancelled {
                let from = 0.4 + 0.3 * half as f64;
                let mut phase = Phase { whole: observer, from, to: from + 0.3 };
                (map, status) = relaxed(self.mesh, self.targets, map, &mut phase);
            }
            let value = objective.value(&map);
            if value.is_finite() && best.as_ref().is_none_or(|(lowest, _)| value < *lowest) {
                best = Some((value, map));
            }
        }
        let map = match best {
            Some((_, map)) => map,
            None if status == Status::Cancelled => return Err(Error::CancelledEarly),
            None => self.conformal(&mut Phase { whole: observer, from: 1.0, to: 1.0 })?,
        };
        Ok((recorded(objective, map, history), status))
    }

    /// Fixed-point steps from the start map; none before a gradient descent from a given map.
    fn fixed_point(
        &self,
        objective: &SphereObjective<'_>,
        start: &SpatialMap,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> (SpatialMap, Status) {
        match (self.options.method, self.options.initial) {
            (SphereMethod::GradientDescent, Some(_)) => (start.clone(), Status::MaxIterations),
            _ => {
                let stopping = self.fixed_point_stopping();
                fixed_point(objective, self.weights, start.clone(), &stopping, history, observer)
            }
        }
    }

    /// Gradient descent, if that is the method and the run is not cancelled.
    fn gradient_descent(
        &self,
        objective: &SphereObjective<'_>,
        map: SpatialMap,
        status: Status,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> (SpatialMap, Status) {
        if self.options.method == SphereMethod::FixedPoint || status == Status::Cancelled {
            return (map, status);
        }
        let line_search = self.options.line_search;
        let options = DescentOptions { stopping: self.stopping(), line_search };
        minimize(objective, map, &options, history, observer)
    }

    /// A descent from a map without folds that keeps every face open, with a new preconditioner every [`ROUND`]
    /// iterations; a run already cancelled returns the map unchanged.
    fn guarded_descent(
        &self,
        objective: &mut SphereObjective<'_>,
        mut map: SpatialMap,
        mut status: Status,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> (SpatialMap, Status) {
        if status == Status::Cancelled || !objective.value(&map).is_finite() {
            return (map, if status == Status::Cancelled { status } else { Status::Stalled });
        }
        let whole = self.stopping();
        let mut done = 0;
        while done < whole.max_iterations {
            let budget = ROUND.min(whole.max_iterations - done);
            let fraction = |done: usize| done as f64 / whole.max_iterations as f64;
            let mut phase = Phase { whole: observer, from: fraction(done), to: fraction(done + budget) };
            match objective.set_preconditioner(&map, &Watch::new(&mut phase, 0.0, "Evening out areas")) {
                Ok(()) => {}
                Err(Error::CancelledEarly) => return (map, Status::Cancelled),
                Err(_) => return (map, Status::Stalled),
            }
            let stopping = Stopping { max_iterations: budget, ..whole };
            let begun = history.iterations();
            let options = DescentOptions { stopping, ..DescentOptions::default() };
            (map, status) = minimize(objective, map, &options, history, &mut phase);
            done += budget;
            let advanced = history.iterations() > begun;
            if matches!(status, Status::Converged | Status::Cancelled) || !advanced {
                break;
            }
        }
        (map, status)
    }

    /// The given start map, or the conformal one.
    fn start(&self, observer: &mut dyn Observer) -> Result<SpatialMap, Error> {
        match self.options.initial_map() {
            Some(initial) => Ok(initial.iter().filter_map(|&x| onto_sphere(x)).collect()),
            None => self.conformal(observer),
        }
    }

    /// A start map without folds.
    fn conformal(&self, observer: &mut dyn Observer) -> Result<SpatialMap, Error> {
        start::start(self.mesh, self.targets, self.weights, observer)
    }

    fn folded(&self, map: &SpatialMap) -> Vec<usize> {
        folded_on_sphere(self.mesh.faces(), map)
    }

    fn stopping(&self) -> Stopping {
        Stopping {
            max_iterations: self.options.max_iterations.unwrap_or(ITERATIONS),
            tolerance: match self.options.method {
                SphereMethod::GradientDescent => self.options.tolerance,
                SphereMethod::FixedPoint | SphereMethod::GaussNewton => None,
            }
            .unwrap_or(Stopping::default().tolerance),
        }
    }

    fn fixed_point_stopping(&self) -> FixedPointStopping {
        let whole = self.options.max_iterations.unwrap_or(ITERATIONS);
        match self.options.method {
            SphereMethod::FixedPoint => FixedPointStopping {
                max_iterations: whole,
                tolerance: self.options.tolerance.unwrap_or(FIXED_POINT_TOLERANCE),
            },
            SphereMethod::GradientDescent | SphereMethod::GaussNewton => FixedPointStopping {
                max_iterations: whole.min(FIXED_POINT_STEPS),
                tolerance: FIXED_POINT_TOLERANCE,
            },
        }
    }
}

/// E_A/A, which does not depend on the size of the image.
pub(crate) fn energy_share(objective: &SphereObjective<'_>, map: &SpatialMap) -> f64 {
    let value = objective.energy().value(map);
    value.authalic_energy / value.area
}

/// The map, with a record of step 0 for it in the history.
fn recorded(objective: &SphereObjective<'_>, map: SpatialMap, history: &mut History) -> SpatialMap {
    let (energies, gradient) = objective.gradient(&map);
    history.push(energies.authalic_energy, 0.0, parallel::dot(&gradient, &gradient).sqrt());
    map
}
