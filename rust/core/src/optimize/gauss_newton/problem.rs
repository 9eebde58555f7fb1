// SPDX-License-Identifier: MIT OR Apache-2.0
//! The problem of a descent: a surface, the motions of its vertices, the energy of its maps, and the options.

use super::angle_schedule::AnglePath;
use crate::codomain::SpatialMap;
use crate::codomain::motion::{Frame, Motion};
use crate::energy::authalic::{AuthalicEnergy, Sums, Weights};
use crate::energy::landmark_penalty::LandmarkPenalty;
use crate::energy::stretch::Profile;
use crate::error::Error;
use crate::parallel;
use crate::sparse::{Analysis, Order};
use crate::vector::Vector3;

/// A surface, the motions of its vertices, and the energy of its maps.
pub(crate) struct Problem {
    pub energy: AuthalicEnergy,
    pub motions: Vec<Motion>,
    /// The penalty on landmarks; empty without landmarks.
    pub penalty: LandmarkPenalty,
    pub analysis: Analysis,
}

/// The options of a descent.
#[derive(Debug, Clone, Copy)]
pub(crate) struct GaussNewtonOptions {
    /// The cost of area ratios, with or without a barrier.
    pub profile: Profile,
    /// λ never falls below this.
    pub angle_weight: f64,
    /// The path on which λ falls.
    pub path: AnglePath,
    /// Iterations after which a deviation below [`EVEN_ENOUGH`](super::descent) suffices; `usize::MAX` where a limit or
    /// a tolerance was asked for.
    pub usual_iterations: usize,
    /// Iteration limit.
    pub most_iterations: usize,
    /// The descent has converged when the area deviation √(E_A/A) is below this.
    pub tolerance: f64,
    /// Iterations after which to end as soon as no face is folded; `None` to go on.
    pub until_open: Option<usize>,
}

/// Limit of the iterations, which no descent reaches, unless another is asked for.
const MOST_ITERATIONS: usize = 1000;

/// The descent has converged when the area deviation is below this, unless another tolerance is asked for.
const TOLERANCE: f64 = 2e-4;

impl GaussNewtonOptions {
    /// A guarded descent by what the caller asked for; after `usual_iterations` nearly even areas are enough for those
    /// who asked for nothing else.
    pub(crate) fn guarded(
        angle_weight: f64,
        max_iterations: Option<usize>,
        tolerance: Option<f64>,
        usual_iterations: usize,
    ) -> Self {
        let is_asked = max_iterations.is_some() || tolerance.is_some();
        Self {
            profile: Profile::Barrier,
            angle_weight,
            path: AnglePath::Balanced,
            usual_iterations: if is_asked { usize::MAX } else { usual_iterations },
            most_iterations: max_iterations.unwrap_or(MOST_ITERATIONS),
            tolerance: tolerance.unwrap_or(TOLERANCE),
            until_open: None,
        }
    }

    /// Unguarded iterations that unfold: until no face is folded, at least and at most so many.
    pub(crate) fn unguarded(self, [least, most]: [usize; 2]) -> Self {
        Self {
            profile: Profile::Stretch,
            until_open: Some(least),
            usual_iterations: most,
            most_iterations: self.most_iterations.min(most),
            ..self
        }
    }
}

impl Problem {
    /// The problem with another energy of the same surface.
    pub(crate) fn with_energy(self, energy: AuthalicEnergy) -> Self {
        Self { energy, ..self }
    }

    /// Analyzes the system of the energy, with its vertices in `order`.
    pub(crate) fn new(energy: AuthalicEnergy, motions: Vec<Motion>, order: Order) -> Result<Self, Error> {
        let unknowns: Vec<u8> = motions.iter().map(|motion| motion.n_unknowns()).collect();
        let analysis = Analysis::new(motions.len(), energy.faces(), &unknowns, order)?;
        Ok(Self { energy, motions, penalty: LandmarkPenalty::default(), analysis })
    }

    /// The problem with a penalty on landmarks.
    pub(crate) fn with_landmarks(self, penalty: LandmarkPenalty) -> Self {
        Self { penalty, ..self }
    }

    /// The energy of a map, including the penalty on landmarks.
    pub(super) fn value(&self, state: &State, weights: &Weights) -> f64 {
        self.energy.value(&state.costs, weights) + state.penalty
    }

    /// The sums of a map, including the penalty on landmarks.
    pub(super) fn sums(&self, state: &State) -> Sums {
        Sums { penalty: state.penalty, ..self.energy.sums(&state.costs) }
    }

    /// The gradient by the unknowns of every vertex, (n, 2).
    pub(super) fn gradient(&self, map: &[Vector3], frames: &[Frame], weights: &Weights) -> Vec<[f64; 2]> {
        let mut gradient = self.energy.gradient(map, frames, weights);
        self.penalty.add_gradient(map, frames, &mut gradient);
        gradient
    }

    /// E_A of a map over the area of its image.
    pub(crate) fn unevenness(&self, map: &[Vector3]) -> f64 {
        let sums = self.energy.sums(&self.energy.costs(map));
        sums.authalic_energy / sums.area
    }

    /// The map reached from `map` by `direction` along the frames.
    pub(super) fn moved(&self, map: &[Vector3], frames: &[Frame], direction: &[[f64; 2]]) -> SpatialMap {
        parallel::map(map.len(), |v| self.motions[v].moved(map[v], &frames[v], direction[v]))
    }

    /// The values at the vertices as unknowns.
    pub(super) fn packed(&self, values: &[[f64; 2]]) -> Vec<f64> {
        let mut unknowns = vec![0.0; self.analysis.n_unknowns()];
        for (vertex, value) in values.iter().enumerate() {
            let (first, n) = (self.analysis.first_unknown(vertex), self.motions[vertex].n_unknowns());
            unknowns[first..first + usize::from(n)].copy_from_slice(&value[..usize::from(n)]);
        }
        unknowns
    }

    /// The unknowns as values at the vertices.
    pub(super) fn unpacked(&self, unknowns: &[f64]) -> Vec<[f64; 2]> {
        parallel::map(self.motions.len(), |vertex| {
            let first = self.analysis.first_unknown(vertex);
            let n = usize::from(self.motions[vertex].n_unknowns());
            std::array::from_fn(|k| if k < n { unknowns[first + k] } else { 0.0 })
        })
    }
}

/// A map with the terms of its energy, for any weights.
pub(super) struct State {
    pub map: SpatialMap,
    costs: Vec<[f64; 2]>,
    /// The penalty on landmarks.
    penalty: f64,
}

impl State {
    pub(super) fn new(problem: &Problem, map: SpatialMap) -> Self {
        let costs = problem.energy.costs(&map);
        let penalty = problem.penalty.value(&map);
        Self { map, costs, penalty }
    }
}
