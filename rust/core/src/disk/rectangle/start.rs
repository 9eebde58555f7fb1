// SPDX-License-Identifier: MIT OR Apache-2.0
//! Maps onto a rectangle without folds, from which the guarded descent starts.

use std::f64::consts::PI;

use super::corners::Outline;
use super::problem::Rectangle;
use super::sides::bounds;
use crate::codomain::SpatialMap;
use crate::codomain::planar::{PlanarMap, flat, lifted};
use crate::control::{History, Observer, Phase, Status, Watch};
use crate::disk::options::Boundary;
use crate::disk::published::fixed_point::fixed_point;
use crate::disk::published::objective::DiskObjective;
use crate::disk::run::{QUICK, watched};
use crate::disk::{certificate, start, unfold};
use crate::error::Error;
use crate::optimize::gauss_newton::{GaussNewtonOptions, Problem, minimize};
use crate::optimize::published::Stopping;
use crate::vector::Vector3;

/// Limit of the fixed-point steps, and the √(gᵀM⁻¹g) that ends them.
const FIXED_POINT: Stopping = Stopping { max_iterations: 5, tolerance: 0.15 };

/// Limit of the unguarded iterations that unfold.
const OPEN_ITERATIONS: usize = 12;

const MESSAGE: &str = "Start map";

impl Rectangle<'_> {
    /// A map without folds.
    pub(super) fn start(
        &self,
        problem: &Problem,
        boundary: PlanarMap,
        guarded: GaussNewtonOptions,
        is_cancelled: bool,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> Result<(SpatialMap, Status), Error> {
        // 1. The given map, or some steps of the papers' fixed point from the harmonic map
        let mut phase = Phase { whole: observer, from: 0.0, to: 0.3 };
        let (near, mut status) = match (is_cancelled, self.run.options.initial_rows()) {
            (_, Some(initial)) => (Some(self.given(initial, &boundary)), Status::MaxIterations),
            (true, None) => (None, Status::Cancelled),
            (false, None) => self.near(problem, boundary.clone(), history, &mut phase),
        };
        if is_cancelled {
            status = Status::Cancelled;
        }
        // 2. Folds removed by an unguarded descent, or by mean values
        if let Some(near) = near {
            if problem.energy.is_embedding(&near) {
                return Ok((near, status));
            }
            let mut open = near;
            if status != Status::Cancelled {
                let options = guarded.unguarded([0, OPEN_ITERATIONS]);
                let mut phase = Phase { whole: observer, from: 0.3, to: 0.8 };
                (open, status) = minimize(problem, open, &options, history, &mut phase);
            }
            if problem.energy.is_embedding(&open) {
                return Ok((open, status));
            }
            if status != Status::Cancelled
                && let Some(unfolded) = unfold::unfold(self.run.mesh, &flat(&open)).map(|map| lifted(&map))
                && problem.energy.is_embedding(&unfolded)
            {
                return Ok((unfolded, status));
            }
        }
        // 3. Tutte's embedding
        self.tutte(problem, boundary, status, observer)
    }

    /// The harmonic map and fixed-point steps from it, the boundary held.
    fn near(
        &self,
        problem: &Problem,
        boundary: PlanarMap,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> (Option<SpatialMap>, Status) {
        let Ok(mut objective) =
            DiskObjective::new(self.run.mesh, problem.energy.targets(), Boundary::ArcLength)
        else {
            return (None, Status::Stalled);
        };
        let watch = Watch::new(observer, 0.0, MESSAGE);
        let harmonic = match start::harmonic(self.run.mesh, &mut objective, boundary, &watch) {
            Ok(harmonic) => harmonic,
            Err(Error::CancelledEarly) => return (None, Status::Cancelled),
            Err(_) => return (None, Status::Stalled),
        };
        let (map, status) = fixed_point(&mut objective, harmonic, &FIXED_POINT, history, observer);
        (Some(lifted(&map)), status)
    }

    /// Tutte's embedding.
    fn tutte(
        &self,
        problem: &Problem,
        boundary: PlanarMap,
        status: Status,
        observer: &mut dyn Observer,
    ) -> Result<(SpatialMap, Status), Error> {
        if status == Status::Cancelled && self.run.mesh.n_vertices() > QUICK {
            return Err(Error::CancelledEarly);
        }
        let mesh = self.run.mesh;
        let mut objective = DiskObjective::new(mesh, problem.energy.targets(), Boundary::ArcLength)?;
        let map = watched(status, observer, 0.8, MESSAGE, |watch| {
            start::tutte(mesh, &mut objective, boundary, watch)
        })?;
        certificate::refuse_folds(mesh, &map)?;
        Ok((lifted(&map), status))
    }

    /// The boundary on the sides of the rectangle, at distances in proportion to the lengths of the edges.
    pub(super) fn boundary(&self, aspect: f64, corners: &[usize; 4], outline: &Outline<'_>) -> PlanarMap {
        let [x, y] = half_sides(aspect);
        let places = [[-x, -y], [x, -y], [x, y], [-x, y]];
        let mut map = vec![[0.0; 2]; self.run.mesh.n_vertices()];
        for (k, side) in self.sides.iter().enumerate() {
            let (from, to, whole) =
                (places[k], places[(k + 1) % 4], outline.length(corners[k], corners[(k + 1) % 4]));
            for (step, &vertex) in side.iter().enumerate() {
                let t = match step {
                    0 => 0.0,
                    _ => outline.length(corners[k], (corners[k] + step) % outline.vertices.len()) / whole,
                };
                // both ends share this coordinate exactly
                map[vertex] =
                    [0, 1].map(|c| if from[c] == to[c] { from[c] } else { from[c] + t * (to[c] - from[c]) });
            }
        }
        map
    }

    /// The given start map, on the rectangle of `boundary`.
    fn given(&self, initial: &[[f64; 2]], boundary: &PlanarMap) -> SpatialMap {
        let outline = &self.run.mesh.boundary_loops()[0];
        let ([low, high], [to_low, to_high]) = (bounds(outline, initial), bounds(outline, boundary));
        let along = |x: [f64; 2], k: usize| {
            to_low[k] + (x[k] - low[k]) / (high[k] - low[k]) * (to_high[k] - to_low[k])
        };
        let mut map: SpatialMap = initial.iter().map(|&x| Vector3([along(x, 0), along(x, 1), 1.0])).collect();
        for (k, side) in self.sides.iter().enumerate() {
            let across = (k + 1) % 2;
            side.iter().for_each(|&v| map[v][across] = boundary[side[0]][across]);
            let corner = boundary[side[0]];
            map[side[0]] = Vector3([corner[0], corner[1], 1.0]);
        }
        map
    }
}

/// Half the width and half the height of a rectangle with the area of the unit disk.
fn half_sides(aspect: f64) -> [f64; 2] {
    [0.5 * (PI * aspect).sqrt(), 0.5 * (PI / aspect).sqrt()]
}
