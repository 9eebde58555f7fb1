// SPDX-License-Identifier: MIT OR Apache-2.0
//! Our own method on the sphere: a start without folds and a guarded descent that never folds a face.
//!
//! On most surfaces the spherical conformal map and a few steps of the papers' fixed point lead near the minimum
//! without folds. Where they fold, or nearly collapse long thin parts, the start is the [progressive](crate::embedding)
//! embedding. From there the descent goes on behind a barrier ([`gauss_newton`](crate::optimize::gauss_newton)).
//!
//! Cost: about six factorizations with one unknown per vertex, about twelve with two.

use std::f64::consts::PI;

use super::options::SphereMapOptions;
use super::published::fixed_point::{FixedPointStopping, fixed_point};
use super::published::objective::SphereObjective;
use super::run::Run;
use super::{start, unfold};
use crate::arrays::from_vectors;
use crate::codomain::motion::Motion;
use crate::codomain::spherical::onto_sphere;
use crate::codomain::{Codomain, SpatialMap};
use crate::control::{History, Observer, Phase, Status};
use crate::distortion::folded_on_sphere;
use crate::embedding::{Stop, progressive_sphere};
use crate::error::{Elements, Error, NumericsError};
use crate::mesh::geometry::triangle;
use crate::mesh::renumbering::Renumbered;
use crate::optimize::gauss_newton::angle_schedule::AnglePath;
use crate::optimize::gauss_newton::area_tolerance::descend;
use crate::optimize::gauss_newton::{GaussNewtonOptions, Problem, more_even, target_floors};
use crate::parallel;
use crate::sparse::{Order, elimination_order};

/// Limit of the fixed-point steps.
const FIXED_POINT_STEPS: usize = 5;

/// The fixed-point steps end when the stretch energy falls by no more than this.
const FIXED_POINT_TOLERANCE: f64 = 1e-2;

/// Iterations that suffice where they leave a small area deviation.
const USUAL_ITERATIONS: usize = 20;

/// Surfaces with fewer vertices get twice as many iterations, which are cheap there.
const SMALL: usize = 10_000;

/// Surfaces with this many vertices or more get [`USUAL_WHERE_LARGE`] iterations.
const LARGE: usize = 20_000;

/// Iterations that suffice on large surfaces.
const USUAL_WHERE_LARGE: usize = 17;

/// A cancelled run on more vertices ends at once, even without a map.
const QUICK: usize = 50_000;

/// A start with an E_A above this part of the area is bad; the progressive one is better.
const BAD_START: f64 = 0.1;

/// From a start with an E_A above this part of the area, λ falls by stages.
const FAR: f64 = 0.12;

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
    ) -> Result<(SpatialMap, Status), Error> {
        if !observer.progress(0.0, "Ordering") && self.mesh.n_vertices() > QUICK {
            return Err(Error::CancelledEarly);
        }
        let order = elimination_order(self.mesh.n_vertices(), self.mesh.faces())?;
        let by_order = Renumbered::new(self.mesh, order);
        let (targets, weights) = (by_order.of_faces(self.targets), by_order.of_vertices(self.weights));
        let initial = self.options.initial_map().map(|map| from_vectors(by_order.of_vertices(&map)));
        let options = SphereMapOptions {
            initial: initial.as_ref().map(|map| map.view()),
            density: None,
            ..*self.options
        };
        let run = Run { mesh: &by_order.mesh, targets: &targets, weights: &weights, options: &options };
        let solved = run.gauss_newton(history, observer);
        let (map, status) = solved.map_err(|error| error.with_faces(|face| by_order.given_face(face)))?;
        Ok((by_order.given(&map), status))
    }

    /// An area-preserving map without folds.
    ///
    /// # Errors
    /// [`NumericsError::NoEmbedding`] where every start folds, [`Error::CancelledEarly`] where the observer ended the
    /// run before there was a map without folds.
    fn gauss_newton(
        &self,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> Result<(SpatialMap, Status), Error> {
        // 1. Targets of slivers raised to a floor
        let floor = target_floors::floors(self.targets)[0];
        let energy = target_floors::energy(self.mesh, self.targets, Codomain::Sphere, floor);
        let problem = Problem::new(energy, vec![Motion::Sphere; self.mesh.n_vertices()], Order::AsGiven)?;
        // 2. A start without folds
        let mut phase = Phase { whole: observer, from: 0.0, to: 0.3 };
        let (quick, status) = self.quick_start(&problem, history, &mut phase)?;
        let mut phase = Phase { whole: observer, from: 0.3, to: 0.4 };
        let map = match quick {
            Some(map) => map,
            None => self.progressive_start(&problem, &mut phase)?,
        };
        // 3. A guarded descent
        let mut phase = Phase { whole: observer, from: 0.4, to: 0.9 };
        let path = if problem.unevenness(&map) > FAR { AnglePath::Staged } else { AnglePath::Balanced };
        let (problem, map, status) = self.descend(problem, map, path, status, history, &mut phase);
        // 4. Where the result is uneven, another descent from the progressive embedding, unless an iteration limit is
        //    given, which counts for all descents
        let is_limited = self.options.max_iterations.is_some();
        let is_final = is_limited
            || path == AnglePath::Staged
            || self.options.initial.is_some()
            || self.options.angle_weight > 0.0
            || self.options.area_tolerance.is_some();
        if is_final || status == Status::Cancelled || problem.unevenness(&map) <= UNEVEN {
            return Ok((map, status));
        }
        let mut phase = Phase { whole: observer, from: 0.9, to: 1.0 };
        Ok(self.second_try(problem, map, status, history, &mut phase))
    }

    /// The given start map, or the conformal one and fixed-point steps; `None` where it is of no use.
    fn quick_start(
        &self,
        problem: &Problem,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> Result<(Option<SpatialMap>, Status), Error> {
        let holds = |map: &SpatialMap| problem.energy.is_embedding(map);
        // 1. A given map only needs to be unfolded
        if let Some(initial) = self.options.initial_map() {
            let map: SpatialMap = initial.iter().filter_map(|&x| onto_sphere(x)).collect();
            let map = if holds(&map) { Some(map) } else { unfold::unfold(self.mesh, &map).filter(holds) };
            // a map that covers the sphere twice has no folded faces either
            return Ok((map.filter(|map| self.is_bijective(map)), Status::MaxIterations));
        }
        // 2. The conformal start and fixed-point steps
        let targets = problem.energy.targets();
        let mut phase = Phase { whole: observer, from: 0.0, to: 0.3 };
        let start = match start::start(self.mesh, targets, self.weights, &mut phase) {
            Ok(start) => start,
            Err(Error::CancelledEarly) => return Err(Error::CancelledEarly),
            Err(_) => return Ok((None, Status::Stalled)),
        };
        let objective = SphereObjective::new(self.mesh, targets);
        let stopping =
            FixedPointStopping { max_iterations: FIXED_POINT_STEPS, tolerance: FIXED_POINT_TOLERANCE };
        let mut phase = Phase { whole: observer, from: 0.3, to: 1.0 };
        let (stepped, status) =
            fixed_point(&objective, self.weights, start.clone(), &stopping, history, &mut phase);
        // 3. Either of them, where it is not bad
        let candidates = [stepped, start].into_iter().filter(holds);
        let best = candidates.min_by(|a, b| problem.unevenness(a).total_cmp(&problem.unevenness(b)));
        let is_good = |map: &SpatialMap| status == Status::Cancelled || problem.unevenness(map) <= BAD_START;
        Ok((best.filter(is_good), status))
    }

    fn progressive_start(&self, problem: &Problem, observer: &mut dyn Observer) -> Result<SpatialMap, Error> {
        match progressive_sphere(self.mesh, problem.energy.targets(), observer) {
            Ok(map) if problem.energy.is_embedding(&map) => return Ok(map),
            Err(Stop::Cancelled) => return Err(Error::CancelledEarly),
            _ => {}
        }
        let mut phase = Phase { whole: observer, from: 1.0, to: 1.0 };
        let start = start::start(self.mesh, self.targets, self.weights, &mut phase)?;
        match Elements::collect(folded_on_sphere(self.mesh.faces(), &start)) {
            None => Ok(start),
            Some(folded) => Err(NumericsError::NoEmbedding { folded }.into()),
        }
    }

    /// The guarded descent from a map without folds; a run already cancelled returns the map unchanged.
    fn descend(
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
        let usual = match self.mesh.n_vertices() {
            0..SMALL => 2 * USUAL_ITERATIONS,
            SMALL..LARGE => USUAL_ITERATIONS,
            _ => USUAL_WHERE_LARGE,
        };
        let SphereMapOptions { angle_weight, max_iterations, tolerance, area_tolerance, .. } = *self.options;
        let guarded = GaussNewtonOptions::guarded(angle_weight, max_iterations, tolerance, usual);
        let options = GaussNewtonOptions { path, ..guarded };
        let begun = map.clone();
        let surface = target_floors::MappedSurface {
            mesh: self.mesh,
            targets: self.targets,
            codomain: Codomain::Sphere,
        };
        let (problem, map, status) =
            descend(&surface, problem, map, area_tolerance, &options, history, observer);
        if self.is_bijective(&map) {
            (problem, map, status)
        } else {
            // no step folds a face, so only a one-ring that turned twice around its vertex leads here
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
        let mut phase = Phase { whole: observer, from: 0.0, to: 0.3 };
        let progressive = match self.progressive_start(&problem, &mut phase) {
            Ok(progressive) => progressive,
            Err(Error::CancelledEarly) => return (map, Status::Cancelled),
            Err(_) => return (map, status),
        };
        let mut phase = Phase { whole: observer, from: 0.3, to: 1.0 };
        let (problem, second, second_status) =
            self.descend(problem, progressive, AnglePath::Staged, status, history, &mut phase);
        more_even((first, map, status), (problem.unevenness(&second), second, second_status))
    }

    /// True if no face is folded and the faces cover the sphere once.
    fn is_bijective(&self, map: &SpatialMap) -> bool {
        let covered = parallel::sum(self.mesh.n_faces(), |face| {
            let [a, b, c] = triangle(map, self.mesh.faces()[face]);
            2.0 * a.dot(b.cross(c)).atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a))
        });
        (covered - 4.0 * PI).abs() < 1.0 && folded_on_sphere(self.mesh.faces(), map).is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arrays::vectors;
    use crate::control::Silent;
    use crate::mesh::TriangleMesh;
    use crate::sparse::processor::with_each_width;
    use crate::sphere::map_sphere;
    use crate::vector::{Vector3, coordinates};

    /// An octahedron split five times, with bumps and without symmetry.
    fn bumpy_ball() -> TriangleMesh {
        let [x, y, z] = [0, 1, 2].map(Vector3::unit);
        let mut points = vec![x, -x, y, -y, z, -z];
        let mut faces: Vec<[u32; 3]> =
            vec![[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
        for _ in 0..5 {
            let mut middle_of = std::collections::HashMap::new();
            let mut middle = |points: &mut Vec<Vector3>, a: u32, b: u32| {
                *middle_of.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                    let sum = points[a as usize] + points[b as usize];
                    points.push(sum.normalized());
                    points.len() as u32 - 1
                })
            };
            let mut split = Vec::new();
            for &[a, b, c] in &faces {
                let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(a, b)| middle(&mut points, a, b));
                split.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
            }
            faces = split;
        }
        let bump = |Vector3([x, y, z]): Vector3| {
            1.0 + 0.3 * (5.0 * x + 1.0).sin() * (4.0 * y + 0.4 * z).cos() + 0.2 * z
        };
        points.iter_mut().for_each(|x| *x = *x * bump(*x));
        TriangleMesh::new(&coordinates(points), &faces).unwrap()
    }

    #[test]
    fn every_processor_finds_the_same_map() {
        let mesh = bumpy_ball();
        for angle_weight in [0.0, 1e-3] {
            let options = SphereMapOptions { angle_weight, ..Default::default() };
            let mut maps = with_each_width(|| map_sphere(&mesh, &options, &mut Silent).unwrap().positions);
            maps.push(map_sphere(&mesh, &options, &mut Silent).unwrap().positions);
            for map in &maps[1..] {
                let [map, first] = [map, &maps[0]].map(|map| vectors(map.view()));
                let most = map.iter().zip(&first).map(|(&x, &y)| x.distance(y)).fold(0.0, f64::max);
                assert!(most < 1e-6, "{angle_weight}: {most}");
            }
        }
    }
}
