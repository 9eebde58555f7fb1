// SPDX-License-Identifier: MIT OR Apache-2.0
//! Carries the landmarks of an area-preserving map to their places: the map h of Liu & Yueh (2023), section 6, and the
//! maps h₀ and h₁ of Sutti & Yueh (2024), section 6.6, applied to the surface's own map.
//!
//! The papers minimize E_S(h) + λ Σ |h(x_i) − q_i|² from a few fixed-point steps. A landmark is a single vertex, and in
//! two dimensions a single point can be pulled anywhere at next to no cost: such steps pull spikes out of the map and
//! fold the faces around it. So the start is a smooth area-preserving [`flow`](super::flow) that takes the landmarks
//! along, and from there the guarded Gauss–Newton descent lowers the papers' energy without ever folding a face. λ
//! grows tenfold until the landmarks meet or come no nearer; at last they are moved the rest of the way, of the order
//! of rounding.
//!
//! Cost: the flow, and about ten factorizations with two unknowns per vertex.

use super::flow::flow;
use crate::codomain::motion::Motion;
use crate::codomain::planar::{flat, lifted};
use crate::codomain::{CanonicalDomain, Codomain, SpatialMap};
use crate::control::{History, Observer, Phase, Status, Watch};
use crate::energy::landmark_penalty::LandmarkPenalty;
use crate::energy::stretch::Profile;
use crate::error::Error;
use crate::mesh::renumbering::Renumbered;
use crate::mesh::{TriangleMesh, Vertex};
use crate::optimize::gauss_newton::angle_schedule::AnglePath;
use crate::optimize::gauss_newton::{GaussNewtonOptions, Problem, minimize, target_floors};
use crate::sparse::{Order, elimination_order};
use crate::vector::Vector3;
use crate::{disk, sphere};

/// Most rounds of flow and pull in turn.
const ROUNDS: usize = 4;

/// Most landmarks that the flow carries, since it solves dense systems of all; more are pulled from the beginning.
const MOST_IN_FLOW: usize = 1000;

/// Angle energy, relative to the area, above which the flow ends.
const SHEARED: f64 = 5.0;

/// Least angle weight while landmarks are pulled; it grows from round to round.
const BALANCED: f64 = 0.03;

/// Factor on the λ given while landmarks are pulled.
const STIFF: f64 = 1e4;

/// E_A, relative to the area, above which landmarks in place contradict the areas.
const CONTRADICTED: f64 = 0.05;

/// Rings around folded faces that may move to unfold them during the flow.
const RINGS: usize = 4;

const MESSAGE: &str = "Carrying landmarks";

/// Distance to their places below which landmarks need not be carried.
const THERE: f64 = 1e-9;

/// Distance of the farthest landmark to its place at which λ stops growing.
const NEAR: f64 = 1e-6;

/// Distance below which a landmark is finally moved onto its place.
const WITHIN_REACH: f64 = 1e-4;

/// Factor by which λ grows from stage to stage.
const GROWTH: f64 = 10.0;

/// Most stages.
const STAGES: usize = 15;

/// Part of its distance that the farthest landmark keeps in a stage that brings it no nearer.
const NO_NEARER: f64 = 0.9;

/// Successive stages of this kind after which λ stops growing.
const PATIENCE: usize = 2;

/// Usual and most iterations of the first stage.
const FIRST: [usize; 2] = [6, 40];

/// Usual and most iterations of the later stages.
const LATER: [usize; 2] = [3, 15];

/// Area deviation at which a descent has nothing left to gain.
const TOLERANCE: f64 = 2e-4;

/// The weights with which a descent begins: λ, and the angle weight.
#[derive(Debug, Clone, Copy)]
struct Goals {
    weight: f64,
    angle_weight: f64,
}

/// An area-preserving map of a surface whose landmarks are to be carried to places.
pub(super) struct Carrying<'a> {
    pub mesh: &'a TriangleMesh,
    pub domain: CanonicalDomain,
    /// Whether the boundary of a disk stays where it is, as on a polygon, instead of sliding along the circle.
    pub holds_boundary: bool,
    /// The landmarks of this surface, (k,).
    pub landmarks: &'a [usize],
    /// The places to carry them to, (k,).
    pub places: &'a [Vector3],
    /// λ at the beginning.
    pub weight: f64,
    /// The weight of the angle distortion against that of the areas.
    pub angle_weight: f64,
}

impl Carrying<'_> {
    /// The map with its landmarks carried to their places as far as no face folds.
    ///
    /// # Errors
    /// If the system cannot be ordered.
    pub(super) fn carry(
        &self,
        map: SpatialMap,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> Result<(SpatialMap, Status), Error> {
        if !self.holds_boundary && self.farthest(&map) <= THERE {
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
        // 4. The landmarks set down on their places
        Ok((by_order.given(&self.set_down(&problem, map)), status))
    }

    /// The distance of each landmark of a map to its place.
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
        let energy = target_floors::energy(mesh, mesh.face_areas(), self.codomain(), floor);
        let mut number_of = vec![Vertex::default(); mesh.n_vertices()];
        by_order
            .vertices
            .iter()
            .zip(Vertex::all(mesh.n_vertices()))
            .for_each(|(&given, new)| number_of[given] = new);
        let landmarks = self.landmarks.iter().map(|&vertex| number_of[vertex]).collect();
        let penalty = LandmarkPenalty::new(&energy, landmarks, self.places.to_vec(), self.weight);
        let motions = Vertex::all(mesh.n_vertices())
            .map(|vertex| match mesh.is_boundary(vertex) {
                true if self.holds_boundary => Motion::Held,
                on_boundary => self.domain.motion(on_boundary),
            })
            .collect();
        Ok(Problem::new(energy, motions, Order::AsGiven)?.with_landmarks(penalty))
    }

    /// Where the map goes: with its boundary held it goes to a polygon, no circle.
    fn codomain(&self) -> Codomain {
        if self.holds_boundary { Codomain::Plane } else { self.domain.into() }
    }

    /// A map with the landmarks at or near their places, by an area-preserving flow. Where faces too coarse or too thin
    /// to follow hold it up, a descent that pulls at the landmarks and mends shapes takes turns with it.
    fn start(
        &self,
        mesh: &TriangleMesh,
        problem: &mut Problem,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> (SpatialMap, Goals) {
        let given = Goals { weight: self.weight, angle_weight: self.angle_weight };
        let mut pulling = self.stiff();
        let mut map = mesh.points().to_vec();
        for round in 0..ROUNDS {
            let watch = Watch::new(observer, 0.1 * round as f64, MESSAGE);
            let mended = |map: SpatialMap| self.mended(mesh, problem, map);
            if self.landmarks.len() <= MOST_IN_FLOW && !self.holds_boundary {
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
        // landmarks that contradict the areas go before them
        let stiff = self.stiff();
        let is_contradicted = problem.unevenness(&map) > CONTRADICTED;
        (map, if is_contradicted { stiff } else { Goals { weight: stiff.weight, ..given } })
    }

    /// Landmarks before areas.
    fn stiff(&self) -> Goals {
        Goals { weight: STIFF * self.weight, angle_weight: self.angle_weight.max(BALANCED) }
    }

    /// A map with the few faces unfolded that were too thin or too coarse to follow the flow; `None` if some stay so.
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

    /// Whether the angle energy of a map is low enough for the flow to go on.
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
            target_floors::MappedSurface { mesh, targets: mesh.face_areas(), codomain: self.codomain() };
        let (mut no_nearer, mut status) = (0, Status::MaxIterations);
        for stage in 0..STAGES {
            let before = farthest(&problem, &map);
            let options = descent(goals, if stage == 0 { FIRST } else { LATER });
            let from = 1.0 - 0.5f64.powi(stage as i32);
            let mut phase = Phase { whole: observer, from, to: 0.5 * (1.0 + from) };
            (problem, map, status) =
                target_floors::descend(&surface, problem, map, &options, history, &mut phase);
            let now = farthest(&problem, &map);
            // a λ that weighs less than the energy it works against proves nothing yet
            let is_weighty = problem.penalty.weight >= 1.0 + goals.angle_weight;
            no_nearer = if is_weighty && now > NO_NEARER * before { no_nearer + 1 } else { 0 };
            if status == Status::Cancelled || now <= NEAR || no_nearer >= PATIENCE {
                break;
            }
            problem.penalty.weight *= GROWTH;
        }
        (problem, map, status)
    }

    /// The map with the landmarks within reach exactly on their places, unless that folds a face.
    fn set_down(&self, problem: &Problem, map: SpatialMap) -> SpatialMap {
        let mut there = map.clone();
        for (k, gap) in problem.penalty.gaps(&map).into_iter().enumerate() {
            if gap <= WITHIN_REACH {
                there[problem.penalty.vertices()[k]] = self.places[k];
            }
        }
        if problem.energy.is_embedding(&there) { there } else { map }
    }
}

/// The options of a guarded descent with these usual and most iterations.
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
