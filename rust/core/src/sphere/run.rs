// SPDX-License-Identifier: MIT OR Apache-2.0
//! One computation from start map to a map without folds.
//!
//! First the papers' method as published, which may fold; then, only where it did, the bijectivity correction
//! and a descent behind a barrier, from the corrected map or else from the start.

use super::domain::SphereDomain;
use super::fixed_point::{FixedPointStopping, fixed_point};
use super::{Map, SphereMapOptions, SphereMethod, normalized, start, unfold};
use crate::control::{History, Observer, Phase, Status};
use crate::distortion::folded_on_sphere;
use crate::error::Error;
use crate::mesh::TriangleMesh;
use crate::optimize::gradient_descent::{DescentOptions, minimize};
use crate::optimize::{Domain as _, Stopping};

/// Iterations of either method, those of the paper's tables.
const ITERATIONS: usize = 100;

/// Fixed-point steps before the gradient descent at the most; few meshes gain more by others.
const FIXED_POINT_STEPS: usize = 10;

/// ε of Algorithm 2.
const FIXED_POINT_TOLERANCE: f64 = 1e-6;

/// Iterations of a guarded descent with one preconditioner.
const ROUND: usize = 10;

/// One computation on a closed surface of genus 0.
#[derive(Clone, Copy)]
pub(super) struct Run<'a> {
    pub mesh: &'a TriangleMesh,
    pub targets: &'a [f64],
    /// The vertices' shares of the targets.
    pub weights: &'a [f64],
    pub options: &'a SphereMapOptions<'a>,
}

impl Run<'_> {
    /// The papers' method, then whatever it takes to have no folded face.
    pub(super) fn solve(
        &self,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> Result<(Map, Status), Error> {
        let mut domain = SphereDomain::new(self.mesh, self.targets);
        // 1. The method as published
        let start = self.start()?;
        let mut phase = Phase { whole: observer, from: 0.0, to: 0.9 };
        let (map, status) = self.as_published(&domain, start.clone(), history, &mut phase);
        if !self.options.unfold || self.folded(&map).is_empty() {
            return Ok((map, status));
        }
        // 2. Unfold what folded; where that fails, the start is the map without folds
        let unfolded = unfold::unfold(self.mesh, &map).or_else(|| unfold::unfold(self.mesh, &start));
        let unfolded = match unfolded {
            Some(map) => map,
            None => start::start(self.mesh, self.weights)?,
        };
        // 3. A descent from there that keeps every face open
        let mut phase = Phase { whole: observer, from: 0.9, to: 1.0 };
        domain.guard();
        Ok(self.guarded_descent(&mut domain, unfolded, status, history, &mut phase))
    }

    /// Start map, fixed-point steps, gradient descent; may fold.
    fn as_published(
        &self,
        domain: &SphereDomain<'_>,
        start: Map,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> (Map, Status) {
        // 1. Fixed-point steps, all of the run where they are the method
        let only = self.options.method == SphereMethod::FixedPoint;
        let (mut map, mut status) = (start, Status::MaxIterations);
        if only || self.options.initial.is_none() {
            let mut phase = Phase { whole: observer, from: 0.0, to: if only { 1.0 } else { 0.4 } };
            let stopping = self.fixed_point_stopping();
            (map, status) = fixed_point(domain, self.weights, map, &stopping, history, &mut phase);
        }
        if only || status == Status::Cancelled {
            return (map, status);
        }
        // 2. The correction that the paper makes between the two
        if self.options.unfold {
            map = unfold::unfold(self.mesh, &map).unwrap_or(map);
        }
        // 3. Gradient descent
        let mut phase = Phase { whole: observer, from: 0.4, to: 1.0 };
        let options =
            DescentOptions { stopping: self.stopping(), line_search: self.options.line_search };
        minimize(domain, map, &options, history, &mut phase)
    }

    /// A descent from a map without folds that keeps every face open, preconditioned anew every few
    /// iterations; a run already cancelled only keeps the map.
    fn guarded_descent(
        &self,
        domain: &mut SphereDomain<'_>,
        mut map: Map,
        mut status: Status,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> (Map, Status) {
        if status == Status::Cancelled || !domain.objective(&map).is_finite() {
            return (map, if status == Status::Cancelled { status } else { Status::Stalled });
        }
        let whole = self.stopping();
        let mut done = 0;
        while done < whole.max_iterations {
            if domain.set_preconditioner(&map).is_err() {
                return (map, Status::Stalled);
            }
            let budget = ROUND.min(whole.max_iterations - done);
            let part = |done: usize| done as f64 / whole.max_iterations as f64;
            let mut phase = Phase { whole: observer, from: part(done), to: part(done + budget) };
            let stopping = Stopping { max_iterations: budget, ..whole };
            let options = DescentOptions { stopping, ..DescentOptions::default() };
            let begun = history.iterations();
            (map, status) = minimize(domain, map, &options, history, &mut phase);
            done += budget;
            let advanced = history.iterations() > begun;
            if matches!(status, Status::Converged | Status::Cancelled) || !advanced {
                break;
            }
        }
        (map, status)
    }

    /// The start map given, or the conformal one.
    fn start(&self) -> Result<Map, Error> {
        match self.options.initial {
            Some(initial) => Ok(initial.iter().filter_map(|&x| normalized(x)).collect()),
            None => start::start(self.mesh, self.weights),
        }
    }

    fn folded(&self, map: &Map) -> Vec<usize> {
        folded_on_sphere(self.mesh.faces(), map)
    }

    fn stopping(&self) -> Stopping {
        Stopping {
            max_iterations: self.options.max_iterations.unwrap_or(ITERATIONS),
            tolerance: match self.options.method {
                SphereMethod::GradientDescent => self.options.tolerance,
                SphereMethod::FixedPoint => None,
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
            SphereMethod::GradientDescent => FixedPointStopping {
                max_iterations: whole.min(FIXED_POINT_STEPS),
                tolerance: FIXED_POINT_TOLERANCE,
            },
        }
    }
}
