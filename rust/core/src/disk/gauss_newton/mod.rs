// SPDX-License-Identifier: MIT OR Apache-2.0
//! Our own method on the disk: fixed-point steps, Levenberg–Marquardt steps that unfold, a guarded descent.
//!
//! The few steps of the papers' fixed point bring most disks near the minimum with some faces folded. Signed areas
//! unfold these on the way of an unguarded descent, nearly always all of them. From the first map without folds the
//! descent goes on behind a barrier ([`gauss_newton`](crate::optimize::gauss_newton)) and never folds a face again.
//! Where this leaves folds, the guarded descent starts from Tutte's embedding, or where double precision does not
//! suffice for that, from the [progressive](crate::embedding) one.
//!
//! Cost: about five factorizations of the interior vertices with one unknown each, about fifteen with two.

mod start;

use super::certificate;
use super::options::{Boundary, DiskMapOptions};
use super::run::Run;
use crate::codomain::motion::Motion;
use crate::codomain::planar::{PlanarMap, flat, lifted};
use crate::codomain::{Codomain, SpatialMap};
use crate::control::{History, Observer, Phase, Status};
use crate::embedding::{Stop, progressive_disk};
use crate::error::Error;
use crate::mesh::Vertex;
use crate::optimize::gauss_newton::angle_schedule::AnglePath;
use crate::optimize::gauss_newton::area_tolerance::descend;
use crate::optimize::gauss_newton::{GaussNewtonOptions, Problem, more_even, target_floors};
use crate::sparse::Order;
use start::LARGE;

/// Guarded iterations that suffice where they leave a small area deviation.
const USUAL_ITERATIONS: usize = 11;

/// Surfaces with fewer vertices get three times as many guarded iterations, which are cheap there.
const SMALL: usize = 10_000;

/// A result with an E_A above this part of the area is uneven; another start may do better.
const UNEVEN: f64 = 2e-4;

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
        self.in_elimination_order(observer, |run, is_cancelled, observer| {
            run.gauss_newton(is_cancelled, history, observer)
        })
    }

    /// An area-preserving map without folds.
    ///
    /// # Errors
    /// [`NumericsError::NoEmbedding`](crate::NumericsError::NoEmbedding) where every start folds,
    /// [`Error::CancelledEarly`] where the observer ended the run before there was a map without folds.
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
            self.quick_start(&problem, self.gauss_newton_options(), history, &mut phase)
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
        let motion = |v: Vertex| if self.mesh.is_boundary(v) { on_boundary } else { Motion::Plane };
        Vertex::all(self.mesh.n_vertices()).map(motion).collect()
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
        let tolerance = self.options.area_tolerance;
        let (problem, map, status) = descend(&surface, problem, map, tolerance, &options, history, observer);
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

    fn gauss_newton_options(&self) -> GaussNewtonOptions {
        let usual = match self.mesh.n_vertices() {
            0..SMALL => 3 * USUAL_ITERATIONS,
            SMALL..LARGE => USUAL_ITERATIONS,
            _ => 0,
        };
        let DiskMapOptions { angle_weight, max_iterations, tolerance, .. } = *self.options;
        GaussNewtonOptions::guarded(angle_weight, max_iterations, tolerance, usual)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arrays::rows;
    use crate::control::Silent;
    use crate::disk::map_disk;
    use crate::mesh::TriangleMesh;
    use crate::sparse::processor::with_each_width;

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
            let mut maps = with_each_width(|| map_disk(&mesh, &options, &mut Silent).unwrap().uv);
            maps.push(map_disk(&mesh, &options, &mut Silent).unwrap().uv);
            for map in &maps[1..] {
                let [map, first]: [&[[f64; 2]]; 2] = [map, &maps[0]].map(|map| rows(map.view()));
                let moved = map.iter().zip(first).map(|(x, y)| (x[0] - y[0]).hypot(x[1] - y[1]));
                let most = moved.fold(0.0, f64::max);
                assert!(most < 1e-6, "{boundary:?} {angle_weight}: {most}");
            }
        }
    }
}
