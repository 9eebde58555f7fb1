// SPDX-License-Identifier: MIT OR Apache-2.0
//! Our own method on the disk: fixed-point steps, Levenberg–Marquardt steps that unfold, a guarded descent.
//!
//! The few steps of the papers' fixed point bring most disks near the minimum with some faces folded. Signed areas
//! unfold these on the way of an unguarded descent, nearly always all of them. From the first map without folds the
//! descent goes on behind a barrier ([`gauss_newton`](crate::optimize::gauss_newton)) and never folds a face again.
//! Where this leaves folds, the guarded descent starts from Tutte's embedding, or where double precision does not suffice
//! for that, from the [progressive](crate::embedding) one.
//!
//! Cost: about five factorizations of the interior vertices with one unknown each, about fifteen with two.

use super::options::{Boundary, DiskMapOptions};
use super::published::fixed_point::fixed_point;
use super::published::objective::DiskDomain;
use super::run::Run;
use super::{certificate, start, unfold};
use crate::codomain::motion::Motion;
use crate::codomain::planar::{PlanarMap, flat, lifted};
use crate::codomain::{Codomain, SpatialMap};
use crate::control::{History, Observer, Phase, Silent, Status, Watch};
use crate::embedding::{Stop, progressive_disk};
use crate::energy::stretch::Profile;
use crate::error::{Elements, Error, NumericsError};
use crate::mesh::renumbering::Renumbered;
use crate::optimize::gauss_newton::angle_schedule::AnglePath;
use crate::optimize::gauss_newton::area_tolerance::within_tolerance;
use crate::optimize::gauss_newton::{GaussNewtonOptions, Problem, minimize, more_even, target_floors};
use crate::optimize::published::Stopping;
use crate::sparse::{Order, elimination_order};

/// Limit of the fixed-point steps.
const FIXED_POINT_STEPS: usize = 5;

/// The fixed-point steps end when √(gᵀM⁻¹g) is below this, at an E_A of about 0.05: Gauss–Newton gains more from there.
const NEAR: f64 = 0.15;

/// Unguarded iterations, which lose angles: the number on large surfaces without folds, and the limit.
const OPEN_ITERATIONS: [usize; 2] = [8, 12];

/// Guarded iterations: the number that suffices where it leaves a small area deviation, and a limit that no descent reaches.
const GUARDED_ITERATIONS: [usize; 2] = [11, 1000];

/// Surfaces with fewer vertices get three times as many guarded iterations, which are cheap there.
const SMALL: usize = 10_000;

/// On surfaces with more vertices, unguarded iterations, which may be in single precision, replace guarded ones even
/// where nothing is folded.
const LARGE: usize = 500_000;

/// A map with a face below this part of its target has collapsed beyond what a descent can mend.
const COLLAPSED: f64 = 1e-9;

/// A result with an E_A above this part of the area is uneven; another start may do better.
const UNEVEN: f64 = 2e-4;

/// The descent has converged when the area deviation is below this.
const TOLERANCE: f64 = 2e-4;

/// A cancelled run without a map still computes an embedding on surfaces of up to this many vertices.
const QUICK: usize = 50_000;

const MESSAGE: &str = "Start map";

impl Run<'_> {
    /// An area-preserving map without folds, computed on the mesh in elimination order.
    ///
    /// # Errors
    /// As [`Self::gauss_newton`].
    pub(super) fn renumbered(
        &self,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> Result<(PlanarMap, Status), Error> {
        let is_cancelled = !observer.progress(0.0, "Ordering");
        if is_cancelled && self.mesh.n_vertices() > QUICK {
            return Err(Error::CancelledEarly);
        }
        let order = elimination_order(self.mesh.n_vertices(), self.mesh.faces())?;
        let by_order = Renumbered::new(self.mesh, order);
        let targets = by_order.of_faces(self.targets);
        let initial = self.options.initial.map(|map| by_order.of_vertices(map));
        let options = DiskMapOptions { initial: initial.as_deref(), density: None, ..*self.options };
        let run = Run { mesh: &by_order.mesh, targets: &targets, options: &options, ..*self };
        let given_face = |face| self.given_face(by_order.given_face(face));
        let solved = run.gauss_newton(is_cancelled, history, observer);
        let (map, status) = solved.map_err(|error| error.with_faces(given_face))?;
        Ok((by_order.given(&map), status))
    }

    /// An area-preserving map without folds.
    ///
    /// # Errors
    /// [`NumericsError::NoEmbedding`] where every start folds, [`Error::CancelledEarly`] where the observer ended the run
    /// before there was a map without folds.
    fn gauss_newton(
        &self,
        is_cancelled: bool,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> Result<(PlanarMap, Status), Error> {
        // 1. Targets of slivers raised to a floor
        let floor = target_floors::floors(self.targets)[0];
        let energy = target_floors::energy(self.mesh, self.targets, Codomain::Disk, floor);
        let problem = Problem::new(energy, self.motions(), Order::AsGiven)?;
        // 2. The quick start: fixed-point steps, folds removed by an unguarded descent
        let mut phase = Phase { whole: observer, from: 0.0, to: 0.4 };
        let (quick, status) = if is_cancelled {
            (None, Status::Cancelled)
        } else {
            self.quick_start(&problem, history, &mut phase)
        };
        // 3. Where that fails, an embedding that exists for any disk
        let mut phase = Phase { whole: observer, from: 0.4, to: 0.5 };
        let (map, status) = match quick {
            Some(map) => (map, status),
            None => self.safe_start(&problem, status, &mut phase)?,
        };
        // 4. A guarded descent
        let mut phase = Phase { whole: observer, from: 0.5, to: 0.9 };
        let (problem, map, status) =
            self.guarded_descent(problem, map, AnglePath::Balanced, status, history, &mut phase);
        // 5. Where the result is uneven, another descent from the progressive embedding
        let mut phase = Phase { whole: observer, from: 0.9, to: 1.0 };
        let (map, status) = self.second_try(problem, map, status, history, &mut phase);
        Ok((flat(&map), status))
    }

    /// The motions that the vertices are allowed.
    fn motions(&self) -> Vec<Motion> {
        let on_boundary =
            if self.options.boundary == Boundary::Sliding { Motion::Circle } else { Motion::Held };
        let motion = |v: usize| if self.mesh.is_boundary(v) { on_boundary } else { Motion::Plane };
        (0..self.mesh.n_vertices()).map(motion).collect()
    }

    /// A map without folds near the minimum by fixed-point steps and an unguarded descent; `None` where folds remain.
    fn quick_start(
        &self,
        problem: &Problem,
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
        let options = GaussNewtonOptions {
            profile: Profile::Stretch,
            until_open: Some(least),
            usual_iterations: most,
            most_iterations: self.options.max_iterations.map_or(most, |given| given.min(most)),
            ..self.gauss_newton_options()
        };
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
        if let Some(initial) = self.options.initial {
            return Ok((lifted(initial), Status::MaxIterations));
        }
        let mut domain = DiskDomain::new(self.mesh, problem.energy.targets(), self.options.boundary)?;
        let start = start::start(self.mesh, &mut domain, &Watch::new(observer, 0.0, MESSAGE))?;
        let stopping = Stopping { max_iterations: FIXED_POINT_STEPS, tolerance: NEAR };
        let (map, status) = fixed_point(&mut domain, start, &stopping, history, observer);
        Ok((lifted(&map), status))
    }

    /// Tutte's embedding, or the progressive one where that collapses.
    fn safe_start(
        &self,
        problem: &Problem,
        status: Status,
        observer: &mut dyn Observer,
    ) -> Result<(SpatialMap, Status), Error> {
        if status == Status::Cancelled && self.mesh.n_vertices() > QUICK {
            return Err(Error::CancelledEarly);
        }
        let mut domain = DiskDomain::new(self.mesh, problem.energy.targets(), Boundary::ArcLength)?;
        let mut silent = Silent;
        let watch = match status {
            // a run already cancelled has no one to ask
            Status::Cancelled => Watch::new(&mut silent, 0.0, MESSAGE),
            _ => Watch::new(observer, 0.0, MESSAGE),
        };
        let tutte = start::tutte(self.mesh, &mut domain, &watch).map(|map| lifted(&map));
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
        let folded = certificate::folded(self.mesh, &flat(&tutte));
        match Elements::collect(folded) {
            None => Ok(tutte),
            Some(folded) => Err(NumericsError::NoEmbedding { folded }.into()),
        }
    }

    /// The guarded descent from a map without folds; a run already cancelled returns the map unchanged.
    fn guarded_descent(
        &self,
        problem: Problem,
        map: SpatialMap,
        path: AnglePath,
        status: Status,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> (Problem, SpatialMap, Status) {
        if status == Status::Cancelled {
            return (problem, map, status);
        }
        let options = GaussNewtonOptions { path, ..self.gauss_newton_options() };
        let begun = map.clone();
        let surface =
            target_floors::MappedSurface { mesh: self.mesh, targets: self.targets, codomain: Codomain::Disk };
        let (problem, map, status) = match self.options.area_tolerance {
            Some(tolerance) => {
                within_tolerance(&surface, problem, map, tolerance, &options, history, observer)
            }
            None => target_floors::descend(&surface, problem, map, &options, history, observer),
        };
        if certificate::is_bijective(self.mesh, &flat(&map)) {
            (problem, map, status)
        } else {
            // no step folds a face, so only a boundary that turned twice leads here
            (problem, begun, Status::Stalled)
        }
    }

    /// The more even of an uneven map and the descent from the progressive embedding.
    fn second_try(
        &self,
        problem: Problem,
        map: SpatialMap,
        status: Status,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> (SpatialMap, Status) {
        let first = problem.unevenness(&map);
        // the progressive embedding has a boundary of its own
        let is_held = self.options.boundary == Boundary::ArcLength;
        let is_given = is_held
            || self.options.max_iterations.is_some()
            || self.options.initial.is_some()
            || self.options.angle_weight > 0.0
            || self.options.area_tolerance.is_some();
        if status == Status::Cancelled || is_given || first <= UNEVEN {
            return (map, status);
        }
        let mut phase = Phase { whole: observer, from: 0.0, to: 0.3 };
        let progressive = match progressive_disk(self.mesh, problem.energy.targets(), &mut phase) {
            Ok(map) => lifted(&map),
            Err(Stop::Cancelled) => return (map, Status::Cancelled),
            Err(Stop::NoRoom) => return (map, status),
        };
        if !problem.energy.is_embedding(&progressive) {
            // for example an arc of more than half the circle
            return (map, status);
        }
        let mut phase = Phase { whole: observer, from: 0.3, to: 1.0 };
        let (problem, second, second_status) =
            self.guarded_descent(problem, progressive, AnglePath::Staged, status, history, &mut phase);
        more_even((first, map, status), (problem.unevenness(&second), second, second_status))
    }

    fn has_not_collapsed(&self, problem: &Problem, map: &SpatialMap) -> bool {
        let (areas, targets) = (problem.energy.areas(map), problem.energy.targets());
        let least = COLLAPSED * areas.iter().sum::<f64>() / targets.iter().sum::<f64>();
        areas.iter().zip(targets).all(|(area, target)| *area > least * target)
    }

    /// Iterations after which nearly even areas suffice, unless the caller asked for more.
    fn usual_iterations(&self) -> usize {
        let [usual, ..] = GUARDED_ITERATIONS;
        match self.mesh.n_vertices() {
            _ if self.options.max_iterations.is_some() || self.options.tolerance.is_some() => usize::MAX,
            0..SMALL => 3 * usual,
            SMALL..LARGE => usual,
            _ => 0,
        }
    }

    fn gauss_newton_options(&self) -> GaussNewtonOptions {
        GaussNewtonOptions {
            profile: Profile::Barrier,
            angle_weight: self.options.angle_weight,
            path: AnglePath::Balanced,
            usual_iterations: self.usual_iterations(),
            most_iterations: self.options.max_iterations.unwrap_or(GUARDED_ITERATIONS[1]),
            tolerance: self.options.tolerance.unwrap_or(TOLERANCE),
            until_open: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::TriangleMesh;
    use crate::sparse::processor::with_each_width;
    use crate::{Silent, disk_map};

    /// A wavy cap of 41 rings.
    fn cap() -> TriangleMesh {
        let (rings, around) = (40u32, 60u32);
        let point = |ring: u32, k: u32| {
            let (r, angle) =
                (f64::from(ring) / 20.0, f64::from(k) * std::f64::consts::TAU / f64::from(around));
            let wave = 0.2 * (3.0 * r + 1.0).sin() * (2.0 * angle).cos();
            [r.sin() * angle.cos(), r.sin() * angle.sin(), r.cos() + wave * r]
        };
        let mut points = vec![point(0, 0)];
        points.extend((1..=rings).flat_map(|ring| (0..around).map(move |k| point(ring, k))));
        let at = |ring: u32, k: u32| 1 + (ring - 1) * around + k % around;
        let mut faces: Vec<[u32; 3]> = (0..around).map(|k| [0, at(1, k), at(1, k + 1)]).collect();
        for (ring, k) in (1..rings).flat_map(|ring| (0..around).map(move |k| (ring, k))) {
            let [a, b, c, d] = [at(ring, k), at(ring + 1, k), at(ring + 1, k + 1), at(ring, k + 1)];
            faces.extend([[a, b, c], [a, c, d]]);
        }
        TriangleMesh::new(&points, &faces).unwrap()
    }

    #[test]
    fn every_processor_finds_the_same_map() {
        let mesh = cap();
        for (boundary, angle_weight) in [
            (Boundary::Sliding, 0.0),
            (Boundary::Sliding, 1e-3),
            (Boundary::ArcLength, 0.0),
            (Boundary::Free, 1e-3),
            (Boundary::Rectangle, 1e-3),
        ] {
            let options = DiskMapOptions { boundary, angle_weight, ..Default::default() };
            let mut maps = with_each_width(|| disk_map(&mesh, &options, &mut Silent).unwrap().uv);
            maps.push(disk_map(&mesh, &options, &mut Silent).unwrap().uv);
            for map in &maps[1..] {
                let moved = map.iter().zip(&maps[0]).map(|(x, y)| (x[0] - y[0]).hypot(x[1] - y[1]));
                let most = moved.fold(0.0, f64::max);
                assert!(most < 1e-6, "{boundary:?} {angle_weight}: {most}");
            }
        }
    }
}
