// SPDX-License-Identifier: MIT OR Apache-2.0
//! Carries the landmarks of an area-preserving map to their places: the map h of Liu & Yueh (2023), section 6, and the
//! maps h₀ and h₁ of Sutti & Yueh (2024), section 6.6, applied to the surface's own map.
//!
//! The papers minimise E_S(h) + λ Σ |h(x_i) − q_i|² from a few fixed-point steps. A landmark is a single vertex, and in
//! two dimensions a single point can be pulled anywhere at next to no cost: such steps pull spikes out of the map and fold
//! the faces around it. So the start is a smooth area-preserving [`flow`](super::flow) that takes the landmarks along,
//! and from there the guarded Gauss–Newton descent lowers the papers' energy without ever folding a face. λ grows tenfold
//! until the landmarks meet or do not come any nearer; what rounding leaves of their way they are moved last.
//!
//! Cost: the flow, and about ten factorisations with two unknowns per vertex.

use super::flow::flow;
use super::options::RegistrationOptions;
use crate::codomain::planar::{flat, lifted};
use crate::codomain::{CanonicalDomain, SpatialMap};
use crate::control::{History, Observer, Phase, Status, Watch};
use crate::energy::landmark_penalty::LandmarkPenalty;
use crate::energy::stretch::Profile;
use crate::error::Error;
use crate::mesh::TriangleMesh;
use crate::mesh::renumbering::Renumbered;
use crate::optimize::gauss_newton::angle_schedule::AnglePath;
use crate::optimize::gauss_newton::{GaussNewtonOptions, Problem, minimize, target_floors};
use crate::sparse::{Order, elimination_order};
use crate::vector::Vector3;
use crate::{disk, sphere};

/// How often flow and pull take turns at the most.
const ROUNDS: usize = 4;

/// More landmarks than these are pulled from the beginning: the flow solves dense systems of all of them.
const MOST_IN_FLOW: usize = 1000;

/// The flow ends where the angle energy becomes more than this part of the area.
const SHEARED: f64 = 5.0;

/// While landmarks are pulled, angles have this weight at least, more each time, and λ is so many times the one given.
const BALANCED: f64 = 0.03;
const STIFF: f64 = 1e4;

/// The landmarks contradict the areas where E_A is more than this part of the area with them in place.
const CONTRADICTED: f64 = 0.05;

/// Rings around folded faces that may move to unfold them on the way.
const RINGS: usize = 4;

const MESSAGE: &str = "Carrying landmarks";

/// Landmarks this near to their places need not be carried.
const THERE: f64 = 1e-9;

/// λ grows until the farthest landmark is this near to its place.
const NEAR: f64 = 1e-6;

/// Landmarks this near are moved onto their places in the end.
const WITHIN_REACH: f64 = 1e-4;

/// What λ is multiplied by, and how often at the most.
const GROWTH: f64 = 10.0;
const STAGES: usize = 15;

/// A stage in which the farthest landmark keeps more than this part of its way brings it no nearer,
const NO_NEARER: f64 = 0.9;

/// and after so many of them λ grows no more.
const PATIENCE: usize = 2;

/// Iterations of the first stage and of those that follow, where they suffice and at the most.
const FIRST: [usize; 2] = [6, 40];
const LATER: [usize; 2] = [3, 15];

/// Area deviation of the result below which nothing is left to gain.
const TOLERANCE: f64 = 2e-4;

/// What a descent begins with: λ, and the weight of angles.
#[derive(Debug, Clone, Copy)]
struct Goals {
    weight: f64,
    angle_weight: f64,
}

/// An area-preserving map of a surface whose landmarks are to be carried to places.
pub(super) struct Carrying<'a> {
    pub mesh: &'a TriangleMesh,
    pub domain: CanonicalDomain,
    /// The landmarks of this surface, (k,).
    pub landmarks: &'a [usize],
    /// Where they are wanted, (k,).
    pub places: &'a [Vector3],
    pub options: &'a RegistrationOptions,
}

impl Carrying<'_> {
    /// The map with its landmarks carried to their places as far as no face folds.
    ///
    /// # Errors
    /// Where the system cannot be ordered.
    pub(super) fn carry(
        &self,
        map: SpatialMap,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> Result<(SpatialMap, Status), Error> {
        if self.farthest(&map) <= THERE {
            return Ok((map, Status::Converged));
        }
        // 1. The surface as its map shows it, in elimination order; angles are those of h
        let order = elimination_order(map.len(), self.mesh.faces())?;
        let by_order = Renumbered::new(&self.mesh.at_points(map), order);
        let mut problem = self.problem(&by_order)?;
        // 2. A smooth flow takes the landmarks along
        let mut phase = Phase { whole: observer, from: 0.0, to: 0.6 };
        let (map, goals) = self.start(&by_order.mesh, &mut problem, history, &mut phase);
        // 3. A guarded descent with a penalty that grows
        let mut phase = Phase { whole: observer, from: 0.6, to: 1.0 };
        let (problem, map, status) = self.descend(&by_order.mesh, problem, map, goals, history, &mut phase);
        // 4. What rounding has left of their way
        Ok((by_order.given(&self.set_down(&problem, map)), status))
    }

    /// How far each landmark of a map is from its place.
    fn gaps(&self, map: &[Vector3]) -> Vec<f64> {
        let gap = |(&vertex, &place): (&usize, &Vector3)| map[vertex].distance(place);
        self.landmarks.iter().zip(self.places).map(gap).collect()
    }

    /// The gap of the farthest landmark of a map.
    pub(super) fn farthest(&self, map: &[Vector3]) -> f64 {
        self.gaps(map).into_iter().fold(0.0, f64::max)
    }

    /// The energy of the surface's maps, with the penalty on its landmarks.
    fn problem(&self, by_order: &Renumbered) -> Result<Problem, Error> {
        let mesh = &by_order.mesh;
        let floor = target_floors::floors(mesh.face_areas())[0];
        let energy = target_floors::energy(mesh, mesh.face_areas(), self.domain.into(), floor);
        let mut place_of = vec![0u32; mesh.n_vertices()];
        by_order.vertices.iter().enumerate().for_each(|(new, &given)| place_of[given as usize] = new as u32);
        let landmarks = self.landmarks.iter().map(|&vertex| place_of[vertex]).collect();
        let penalty = LandmarkPenalty::new(&energy, landmarks, self.places.to_vec(), self.options.weight);
        let motions =
            (0..mesh.n_vertices()).map(|vertex| self.domain.motion(mesh.is_boundary(vertex))).collect();
        Ok(Problem::new(energy, motions, Order::AsGiven)?.with_landmarks(penalty))
    }

    /// A map with the landmarks at or near their places, by an area-preserving flow; where that gets stuck, because faces
    /// are too coarse or too thin to follow, by turns with a descent that pulls at the landmarks and mends shapes.
    fn start(
        &self,
        mesh: &TriangleMesh,
        problem: &mut Problem,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> (SpatialMap, Goals) {
        let given = Goals { weight: self.options.weight, angle_weight: self.options.angle_weight };
        let mut pulling = self.stiff();
        let mut map = mesh.points().to_vec();
        for round in 0..ROUNDS {
            let watch = Watch::new(observer, 0.1 * round as f64, MESSAGE);
            let mended = |map: SpatialMap| self.mended(mesh, problem, map);
            if self.landmarks.len() <= MOST_IN_FLOW {
                map = flow(self.domain, map, problem.penalty.vertices(), self.places, &mended, &watch);
            }
            if farthest(problem, &map) <= NEAR {
                return (map, if round == 0 { given } else { Goals { weight: pulling.weight, ..given } });
            }
            let (from, to) = (0.1 * round as f64, 0.1 * (round + 1) as f64);
            let mut phase = Phase { whole: observer, from, to };
            problem.penalty.weight = pulling.weight;
            let options = descent(pulling, FIRST);
            let status;
            (map, status) = minimize(problem, map, &options, history, &mut phase);
            if status == Status::Cancelled || farthest(problem, &map) <= WITHIN_REACH {
                break;
            }
            pulling.angle_weight *= GROWTH;
        }
        // areas are not kept at all costs where landmarks contradict them
        let stiff = self.stiff();
        let is_contradicted = problem.unevenness(&map) > CONTRADICTED;
        (map, if is_contradicted { stiff } else { Goals { weight: stiff.weight, ..given } })
    }

    /// Landmarks before areas.
    fn stiff(&self) -> Goals {
        let RegistrationOptions { weight, angle_weight } = *self.options;
        Goals { weight: STIFF * weight, angle_weight: angle_weight.max(BALANCED) }
    }

    /// A map with the few faces unfolded that were too thin or too coarse to follow the flow; `None` where some stay.
    fn mended(&self, mesh: &TriangleMesh, problem: &Problem, map: SpatialMap) -> Option<SpatialMap> {
        if problem.energy.is_embedding(&map) {
            return self.is_sound(problem, &map).then_some(map);
        }
        let mended = match self.domain {
            CanonicalDomain::Sphere => sphere::unfold::unfold_within(mesh, &map, RINGS),
            CanonicalDomain::Disk => {
                disk::unfold::unfold_within(mesh, &flat(&map), RINGS).map(|map| lifted(&map))
            }
        };
        mended.filter(|map: &SpatialMap| problem.energy.is_embedding(map) && self.is_sound(problem, map))
    }

    /// Whether no part of a map is sheared so much that going on would only make it worse.
    fn is_sound(&self, problem: &Problem, map: &SpatialMap) -> bool {
        let sums = problem.energy.sums(&problem.energy.costs(map));
        sums.angle_energy <= SHEARED * sums.area
    }

    /// Guarded descents with λ growing until the landmarks are near or come no nearer.
    fn descend(
        &self,
        mesh: &TriangleMesh,
        mut problem: Problem,
        mut map: SpatialMap,
        goals: Goals,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> (Problem, SpatialMap, Status) {
        problem.penalty.weight = goals.weight;
        let surface =
            target_floors::Surface { mesh, targets: mesh.face_areas(), codomain: self.domain.into() };
        let (mut no_nearer, mut status) = (0, Status::MaxIterations);
        for stage in 0..STAGES {
            let before = farthest(&problem, &map);
            let options = descent(goals, if stage == 0 { FIRST } else { LATER });
            let from = 1.0 - 0.5f64.powi(stage as i32);
            let mut phase = Phase { whole: observer, from, to: 0.5 * (1.0 + from) };
            (problem, map, status) =
                target_floors::descend(&surface, problem, map, &options, history, &mut phase);
            let now = farthest(&problem, &map);
            // a λ that weighs less than what it works against says nothing yet
            let is_weighty = problem.penalty.weight >= 1.0 + goals.angle_weight;
            no_nearer = if is_weighty && now > NO_NEARER * before { no_nearer + 1 } else { 0 };
            if status == Status::Cancelled || now <= NEAR || no_nearer >= PATIENCE {
                break;
            }
            problem.penalty.weight *= GROWTH;
        }
        (problem, map, status)
    }

    /// The map with its landmarks at their very places, where they are within reach and that folds nothing.
    fn set_down(&self, problem: &Problem, map: SpatialMap) -> SpatialMap {
        let mut there = map.clone();
        for (k, gap) in problem.penalty.gaps(&map).into_iter().enumerate() {
            if gap <= WITHIN_REACH {
                there[problem.penalty.vertices()[k] as usize] = self.places[k];
            }
        }
        if problem.energy.is_embedding(&there) { there } else { map }
    }
}

/// A guarded descent with so many iterations, where they suffice and at the most.
fn descent(goals: Goals, [usual_iterations, most_iterations]: [usize; 2]) -> GaussNewtonOptions {
    GaussNewtonOptions {
        profile: Profile::Barrier,
        angle_weight: goals.angle_weight,
        path: AnglePath::Balanced,
        usual_iterations,
        most_iterations,
        tolerance: TOLERANCE,
        until_open: None,
    }
}

/// The gap of the farthest landmark.
fn farthest(problem: &Problem, map: &[Vector3]) -> f64 {
    problem.penalty.gaps(map).into_iter().fold(0.0, f64::max)
}
