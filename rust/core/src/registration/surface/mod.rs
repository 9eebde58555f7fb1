// SPDX-License-Identifier: MIT OR Apache-2.0
//! The descent on the energy between two surfaces: each face of the source against its image in space on the target.
//!
//! The unknowns are the places of the source's vertices on the target. Of a map of either surface to a common domain
//! alone, a face cannot tell how it is distorted between the surfaces; here the symmetric Dirichlet energy of the map
//! from surface to surface is lowered, from a registration in the domain, by Newton's method in turn with a search
//! around single vertices. An energy in the domain keeps faces from folding there ([`energy`]). Its weight falls by
//! stages: at first it smooths the way, at last it acts next to folds only.
//!
//! Where the target is much finer, faces are split into parts that see what lies between their corners
//! ([`subdivision`]), anew for each stage.
//!
//! Places are rounded as long as the steps are large, so that nearly the same input gives nearly the same map
//! ([`rounding`]).
//!
//! The map is stationary where neither betters it: target edges are kinks of the energy, at which vertices come to lie
//! with a slope on either side ([`kinks`]).
//!
//! Cost: some fifty factorizations with two unknowns for each vertex of the source.

mod density;
mod energy;
mod kinks;
mod newton;
mod problem;
mod rounding;
#[cfg(test)]
mod sample_maps;
mod subdivision;
mod sweep;
mod target;
mod walk;

pub(crate) use density::FaceEnergy;
pub(crate) use problem::{Pull, Start, SurfaceProblem};

use crate::arrays::from_vectors;
use crate::control::{History, Observer, Status, Watch};
use crate::error::Error;
use crate::location::{Location, points_on};
use crate::mesh::Vertex;
use crate::parallel;
use crate::sparse::{Analysis, Factor, Failure, Order};
use crate::vector::Vector3;
use energy::{Guard, SurfaceEnergy};
use newton::{Motion, Moving, Step};
use sweep::Colors;
use target::{Placed, boundary_edge};

/// A stage of a descent: the guard, the most rounds of steps and a sweep, and the most steps of a round.
#[derive(Debug, Clone, Copy)]
struct Stage {
    guard: Guard,
    rounds: usize,
    steps: usize,
}

impl Stage {
    const fn new(weight: f64, slack: f64, rounds: usize, steps: usize) -> Self {
        Self { guard: Guard { weight, slack }, rounds, steps }
    }
}

/// The stages from a map of the surfaces to their domain.
const STAGES: [Stage; 4] = [
    Stage::new(3.0, 0.0, 1, 20),
    Stage::new(1.0, 0.0, 2, 20),
    Stage::new(0.3, 0.0, 1, 20),
    Stage::new(0.1, 3.0, 12, 20),
];

/// The stages from a map between coarse meshes of the surfaces, which begin with sweeps; and those of large ones, and of
/// meshes that are themselves coarse.
const REFINING: [Stage; 2] = [Stage::new(1.0, 0.0, 1, 6), Stage::new(0.1, 3.0, 24, 20)];
const REFINING_BRIEFLY: [Stage; 2] = [Stage::new(1.0, 0.0, 1, 4), Stage::new(0.1, 3.0, 2, 8)];

/// Sources with more vertices are large.
const LARGE: usize = 30_000;

/// Sweeps over a map that comes from coarse meshes.
const SWEEPS: usize = 2;

/// Mean distortion beyond 1 below which a map is an isometry.
pub(crate) const ISOMETRY: f64 = 1e-6;

/// Relative decrease of the energy by a step or a round above which it is large, so that the places reached may be
/// rounded.
const LARGE_DECREASE: f64 = 1e-3;

/// Relative decrease of the energy by a step below which it is small; two small ones in turn end the steps.
const SMALL_STEP: f64 = 1e-4;

/// Relative decrease of the energy by a round below which the map is stationary; and below which that of coarse meshes
/// is left to the descent that follows.
const SMALL_ROUND: f64 = 1e-4;
const SMALL_COARSE_ROUND: f64 = 1e-3;

const MESSAGE: &str = "Keeping shapes";

/// A map after a descent.
pub(crate) struct Descended {
    pub locations: Vec<Location>,
    /// Its energy, 1 for an isometry.
    pub energy: f64,
    pub status: Status,
}

/// Lowers the energy from a map without folds.
///
/// The boundary of a disk slides along the target's. Faces that are folded in the domain at the start stay as they are
/// and do not count.
///
/// # Errors
/// As [`Analysis::new`].
pub(crate) fn descend(
    problem: &SurfaceProblem<'_>,
    start: Vec<Location>,
    history: &mut History,
    observer: &mut dyn Observer,
) -> Result<Descended, Error> {
    // 1. An isometry is the minimum
    let stages: &[Stage] = match problem.start {
        Start::Domain => &STAGES,
        Start::Coarse if problem.is_coarse || problem.source.n_vertices() > LARGE => &REFINING_BRIEFLY,
        Start::Coarse => &REFINING,
    };
    let mut energy = SurfaceEnergy::new(problem, stages[0].guard);
    let map: Vec<Placed> = parallel::map(start.len(), |vertex| energy.target.placed(start[vertex]));
    let is_pulled = !problem.pulls.is_empty() || problem.signals.width > 0;
    if !is_pulled && energy.mean_distortion(&map) < 1.0 + ISOMETRY {
        return Ok(Descended { locations: start, energy: 1.0, status: Status::Converged });
    }
    // 2. Which vertices may move, and the pattern of their system
    let folded = energy.leave_out_folded(&map);
    let motions = motions(problem, &folded, &map);
    let dofs: Vec<u8> = motions.iter().map(|motion| motion.n_unknowns()).collect();
    let faces = problem.source.faces();
    let analysis = Analysis::new(start.len(), faces, &dofs, Order::Sparse)?;
    let mut factor = Factor::new(&analysis);
    let colors = Colors::new(problem.source, &motions);
    // 3. Stages, from one that smooths the way to one that only keeps folds away
    let mut descent = Descent {
        history,
        observer,
        analysis: &analysis,
        factor: &mut factor,
        colors: &colors,
        done: 0,
        small_round: if problem.is_coarse { SMALL_COARSE_ROUND } else { SMALL_ROUND },
        n_rounds: stages.iter().map(|stage| stage.rounds).sum(),
        target_points: problem.target_points,
    };
    let (mut map, mut status) = (map, Status::MaxIterations);
    for (k, stage) in stages.iter().enumerate() {
        energy.guard = stage.guard;
        energy.subdivide(&map);
        let mut moving = Moving::new(&energy, &motions, map);
        if problem.start != Start::Domain && k == 0 {
            (0..SWEEPS).for_each(|_| moving.sweep(&colors));
        }
        descent.done = stages[..k].iter().map(|stage| stage.rounds).sum();
        status = descent.rounds(&mut moving, stage);
        map = moving.map;
        if status == Status::Cancelled {
            break;
        }
    }
    energy.guard = stages[stages.len() - 1].guard;
    energy.subdivide(&map);
    let value = energy.value(&map);
    let locations = map.into_iter().map(|placed| placed.location).collect();
    Ok(Descended { locations, energy: value, status })
}

/// How each vertex moves: not at all where it is held or belongs to a face folded at the start; along the boundary, if
/// it lies there, on the boundary of the target.
fn motions(problem: &SurfaceProblem<'_>, folded: &[usize], map: &[Placed]) -> Vec<Motion> {
    let source = problem.source;
    let mut motions: Vec<Motion> = Vertex::all(source.n_vertices())
        .map(|vertex| match (problem.held[vertex], source.is_boundary(vertex)) {
            (true, _) => Motion::Held,
            (false, false) => Motion::Free,
            (false, true) if boundary_edge(problem.target, &map[vertex].location).is_some() => Motion::Slides,
            (false, true) => Motion::Held,
        })
        .collect();
    for vertex in folded.iter().flat_map(|&face| source.faces()[face]) {
        motions[vertex] = Motion::Held;
    }
    motions
}

/// A descent with what it reports to.
struct Descent<'a> {
    history: &'a mut History,
    observer: &'a mut dyn Observer,
    analysis: &'a Analysis,
    factor: &'a mut Factor<f64>,
    colors: &'a Colors,
    /// Rounds done, and the most of all stages.
    done: usize,
    n_rounds: usize,
    /// Relative decrease of the energy by a round that ends a stage.
    small_round: f64,
    /// The target's vertices as given.
    target_points: &'a [Vector3],
}

impl Descent<'_> {
    /// Rounds of steps and a sweep, until the energy hardly falls.
    fn rounds(&mut self, moving: &mut Moving<'_, '_>, stage: &Stage) -> Status {
        let mut is_large = true;
        let mut before = moving.energy.value(&moving.map);
        for _ in 0..stage.rounds {
            let start = moving.map.clone();
            if self.steps(moving, stage.steps, is_large).is_err() {
                return Status::Cancelled;
            }
            moving.sweep(self.colors);
            self.done += 1;
            let after = moving.energy.value(&moving.map);
            if after > before {
                moving.map = start;
            }
            if before - after <= self.small_round * before {
                return Status::Converged;
            }
            is_large = before - after > LARGE_DECREASE * before;
            before = after;
        }
        Status::MaxIterations
    }

    /// The fraction of the descent that is done after a share of the present round.
    fn fraction(&self, share: f64) -> f64 {
        (self.done as f64 + share) / self.n_rounds as f64
    }

    /// Newton's steps, until two in turn are small; from rounded places after large ones, and at first if `is_large`.
    fn steps(&mut self, moving: &mut Moving<'_, '_>, most: usize, mut is_large: bool) -> Result<(), Failure> {
        let mut small = 0;
        for step in 0..most {
            let fraction = self.fraction(step as f64 / most as f64);
            if !self.observer.progress(fraction, MESSAGE) {
                return Err(Failure::Cancelled);
            }
            let watch = Watch::new(self.observer, fraction, MESSAGE);
            let given = is_large.then(|| moving.map.clone());
            if is_large {
                moving.round(self.colors);
            }
            let taken = moving.step(self.analysis, self.factor, &watch);
            if let (Some(given), Ok(None) | Err(_)) = (given, &taken) {
                moving.map = given;
            }
            let taken = match taken {
                Err(Failure::Cancelled) => return Err(Failure::Cancelled),
                Err(Failure::NotPositiveDefinite) => None,
                Ok(taken) => taken,
            };
            let Some(Step { energies: [before, after], share, slope }) = taken else { break };
            self.history.push_start(before, slope.abs());
            self.history.push(after, share, slope.abs());
            let positions = || {
                let locations: Vec<Location> = moving.map.iter().map(|placed| placed.location).collect();
                from_vectors(points_on(&locations, self.target_points, moving.energy.target.faces()))
            };
            self.observer.preview(&positions);
            small = if before - after < SMALL_STEP * before { small + 1 } else { 0 };
            if small >= 2 {
                break;
            }
            is_large = before - after > LARGE_DECREASE * before;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::sample_maps::Sample;
    use super::*;
    use crate::control::Silent;
    use crate::mesh::TriangleMesh;
    use crate::mesh::geometry::triangle;

    fn descended(problem: &SurfaceProblem<'_>, start: &[Location]) -> (Vec<Location>, Status) {
        let descended = descend(problem, start.to_vec(), &mut History::start(), &mut Silent).unwrap();
        (descended.locations, descended.status)
    }

    /// The mean over the source's area of (tr G⁻¹H + tr H⁻¹G)/4, where G and H are the inner products of the edges of a
    /// face and of its image, both surfaces at one area.
    fn mean_distortion(sample: &Sample, map: &[Location]) -> f64 {
        let images = points_on(map, sample.target.points(), sample.target.faces());
        let area = |mesh: &TriangleMesh| mesh.face_areas().iter().sum::<f64>();
        let scale = (area(&sample.source) / area(&sample.target)).sqrt();
        let images: Vec<Vector3> = images.into_iter().map(|x| x * scale).collect();
        let products = |points: &[Vector3], face: [Vertex; 3]| {
            let [a, b, c] = triangle(points, face);
            [(b - a).dot(b - a), (b - a).dot(c - a), (c - a).dot(c - a)]
        };
        let of_face = |(&face, area): (&[Vertex; 3], &f64)| {
            let (g, h) = (products(sample.source.points(), face), products(&images, face));
            let determinant = |[xx, xy, yy]: [f64; 3]| xx * yy - xy * xy;
            let mixed = g[2] * h[0] - 2.0 * g[1] * h[1] + g[0] * h[2];
            area * 0.25 * (mixed / determinant(g) + mixed / determinant(h))
        };
        let sum: f64 = sample.source.faces().iter().zip(sample.source.face_areas()).map(of_face).sum();
        sum / area(&sample.source)
    }

    fn n_folded(sample: &Sample, map: &[Location]) -> usize {
        let images = points_on(map, &sample.target_in_domain, sample.target.faces());
        let is_folded = |face: &&[Vertex; 3]| {
            let [a, b, c] = triangle(&images, **face);
            a.dot(b.cross(c)) <= 0.0
        };
        sample.source.faces().iter().filter(is_folded).count()
    }

    #[test]
    fn an_ellipsoid_comes_to_lie_on_a_bumpy_ball_with_little_distortion_and_no_folds() {
        let sample = Sample::spheres();
        let (map, _) = descended(&sample.problem(), &sample.start);
        let [before, after] = [&sample.start, &map].map(|map| mean_distortion(&sample, map));
        assert!(before > 1.5 && after < 1.1, "{before} {after}");
        assert_eq!(n_folded(&sample, &map), 0);
    }

    #[test]
    fn exact_landmarks_stay_where_they_are() {
        let sample = Sample::spheres();
        let mut problem = sample.problem();
        let landmarks = [0, 11, 37];
        landmarks.iter().for_each(|&vertex| problem.held[vertex] = true);
        let (map, _) = descended(&problem, &sample.start);
        assert!(landmarks.iter().all(|&vertex| map[vertex] == sample.start[vertex]));
        assert!(mean_distortion(&sample, &map) < mean_distortion(&sample, &sample.start));
    }

    #[test]
    fn the_boundary_of_a_disk_stays_on_that_of_the_target() {
        let sample = Sample::disks();
        let (map, _) = descended(&sample.problem(), &sample.start);
        assert!(mean_distortion(&sample, &map) < mean_distortion(&sample, &sample.start));
        assert_eq!(n_folded(&sample, &map), 0);
        for vertex in Vertex::all(map.len()).filter(|&vertex| sample.source.is_boundary(vertex)) {
            assert!(boundary_edge(&sample.target, &map[vertex]).is_some());
        }
    }

    #[test]
    fn an_isometry_is_returned_bit_for_bit() {
        let sample = Sample::turned_ball();
        assert!((mean_distortion(&sample, &sample.start) - 1.0).abs() < 1e-12);
        assert_eq!(descended(&sample.problem(), &sample.start), (sample.start.clone(), Status::Converged));
    }

    #[test]
    fn noise_of_the_start_is_forgotten() {
        for sample in [Sample::spheres(), Sample::disks()] {
            let noisy = sample.start_with_noise(1e-10);
            assert!(noisy != sample.start);
            let problem = sample.problem();
            assert!(descended(&problem, &noisy) == descended(&problem, &sample.start));
        }
    }

    #[test]
    fn a_cancelled_descent_returns_its_map_so_far() {
        let sample = Sample::spheres();
        let mut left = 5;
        let mut observer = |_: f64, _: &str| {
            left -= 1;
            left > 0
        };
        let Descended { locations: map, status, .. } =
            descend(&sample.problem(), sample.start.clone(), &mut History::start(), &mut observer).unwrap();
        assert_eq!(status, Status::Cancelled);
        assert_eq!(n_folded(&sample, &map), 0);
        assert!(mean_distortion(&sample, &map) < mean_distortion(&sample, &sample.start));
    }

    #[test]
    fn faces_folded_at_the_start_stay_as_they_are() {
        let sample = Sample::spheres();
        let mut start = sample.start.clone();
        start.swap(0, 40);
        let folded = n_folded(&sample, &start);
        let (map, _) = descended(&sample.problem(), &start);
        assert!(folded > 0 && n_folded(&sample, &map) == folded);
        // the others do not wait for them
        let moved = Vertex::all(map.len()).filter(|&v| map[v] != start[v]).count();
        assert!(moved > map.len() / 2, "{moved}");
    }
}
