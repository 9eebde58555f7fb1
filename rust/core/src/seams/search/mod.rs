// SPDX-License-Identifier: MIT OR Apache-2.0
//! The search for the shortest seams under which the plate predicts a wanted shear.
//!
//! From a first cut that leaves disks only (`start`), in rounds:
//!
//! 1. Grow (`grow`): slits are added that lower the predicted distortion most for their cost.
//! 2. Straighten (`straighten`): segments are replaced by cheapest paths.
//! 3. Draw back (`draw_back`): what raises the distortion least for the cost it spares is taken away again.
//!
//! The distortion of a cut is Σ A φ(k), φ(k) = k − 1 + max(0, k − P), over the faces' predicted k = σ₁/σ₂. Candidates
//! are measured by a solve of the plate on the islands that they change. A value measured for an earlier cut stands
//! until the candidate comes first by it; only then is it measured again (M. Minoux, Accelerated greedy algorithms for
//! maximizing submodular set functions, 1978), so that most candidates of a step cost nothing.
//!
//! On a symmetric mesh every move is made together with its mirror image, on a refined one by whole edges of the mesh
//! that was refined.

mod draw_back;
mod grow;
mod start;
mod state;
mod straighten;

use std::sync::Mutex;

use super::cut::Cut;
use super::edge_mesh::EdgeMesh;
use super::plate::{Plate, Workspace};
use super::progress::{MESSAGE, report};
use crate::control::{Observer, Watch};
use crate::error::Error;
use crate::mesh::Edge;
use crate::parallel;
pub(super) use state::{Figures, State};

/// ν, the price of a seam that ends within an island: combs of short slits look bad.
const LEAF_PRICE: f64 = 0.08;

/// μ, the price of an island.
const ISLAND_PRICE: f64 = 0.35;

/// Islands are not made smaller than this share of the area.
const LEAST_ISLAND: f64 = 0.02;

/// The number of rounds.
const ROUNDS: usize = 2;

/// A cut that misses the target by this factor still counts as one that meets it.
const NEARLY: f64 = 1.005;

/// Bits of the mantissa that noise may decide, of quantities that come from solves of the plate and their differences.
const NOISY_BITS: u32 = 38;

/// What a search is given.
#[derive(Debug, Clone, Copy)]
pub(super) struct Problem<'a> {
    pub mesh: &'a EdgeMesh,
    pub plate: &'a Plate,
    /// The cost of a seam along each edge, (e,); infinite where there must be none.
    pub cost: &'a [f64],
    /// The mirror image of each edge, (e,), on a symmetric mesh.
    pub mirror: Option<&'a [Edge]>,
    /// On a refined mesh all parts of the edge of which each edge is a part, (e,).
    pub parts: Option<&'a [Vec<Edge>]>,
    /// What a slit must lower the distortion by over its price.
    pub least_rate: f64,
    /// Seams that stay.
    pub given: &'a Cut,
    /// The most islands.
    pub max_islands: usize,
    /// The mean of σ₁/σ₂ wanted.
    pub target: f64,
    /// P, the largest 99th percentile of σ₁/σ₂.
    pub bound: f64,
}

/// A running search.
pub(super) struct Search<'a> {
    problem: Problem<'a>,
    workspaces: Mutex<Vec<Workspace>>,
    /// The fraction of the run that is done, and the fractions at which its present stage begins and ends.
    done: f64,
    stage: [f64; 2],
}

/// A cut with its price.
#[derive(Debug, Clone)]
pub(super) struct Solution {
    pub state: State,
    pub price: f64,
    pub meets_target: bool,
}

impl<'a> Search<'a> {
    pub(super) fn new(problem: Problem<'a>) -> Self {
        Self { problem, workspaces: Mutex::new(Vec::new()), done: 0.0, stage: [0.0, 1.0] }
    }

    /// The cheapest cut found from a first cut on.
    ///
    /// # Errors
    /// [`Error::CancelledEarly`], or a failed factorization.
    pub(super) fn polish(
        &mut self,
        cut: Cut,
        rounds: usize,
        observer: &mut dyn Observer,
    ) -> Result<Solution, Error> {
        let target = self.problem.target;
        let mut state = self.state(cut, observer)?;
        let mut best: Option<Solution> = None;
        for round in 0..rounds {
            let is_last = round + 1 == rounds;
            let [from, to] = [round, round + 1].map(|round| round as f64 / rounds as f64);
            let fraction = |share: f64| from + share * (to - from);
            self.enter([fraction(0.0), fraction(0.4)]);
            let goal = if is_last { target } else { 1.0 + 0.9 * (target - 1.0) };
            state = self.grow(state, goal, observer)?;
            state = self.straighten(state, observer)?;
            self.enter([fraction(0.4), fraction(0.5)]);
            state = self.grow(state, goal, observer)?;
            self.enter([fraction(0.5), fraction(0.8)]);
            state = self.draw_back(state, target, self.problem.bound, observer)?;
            let solution = self.priced(state.clone());
            if best.as_ref().is_none_or(|best| solution.is_better_than(best)) {
                best = Some(solution);
            }
            self.enter([fraction(0.8), fraction(1.0)]);
            if !is_last {
                let [target, bound] = [1.0 + 1.5 * (target - 1.0), 1.4 * self.problem.bound];
                state = self.draw_back(state, target, bound, observer)?;
                state = self.straighten(state, observer)?;
            }
        }
        match best {
            Some(best) => Ok(best),
            None => Ok(self.priced(state)),
        }
    }

    /// The best of the cuts found from the first cut.
    pub(super) fn run(&mut self, observer: &mut dyn Observer) -> Result<Solution, Error> {
        let cut = self.first_cut(observer)?;
        self.polish(cut, ROUNDS, observer)
    }

    /// The price of a cut: its cost, its leaves, and its islands but one.
    pub(super) fn priced(&self, state: State) -> Solution {
        let Problem { mesh, cost, target, .. } = self.problem;
        let n_leaves = state.cut.n_leaves(mesh) as f64;
        let n_islands = state.n_islands.saturating_sub(1) as f64;
        let price = state.cut.sum(cost) + ISLAND_PRICE * n_islands + LEAF_PRICE * n_leaves;
        let meets_target = self.figures(&state.shear).mean <= NEARLY * target;
        Solution { state, price, meets_target }
    }

    /// What the search is given.
    pub(super) fn problem(&self) -> Problem<'a> {
        self.problem
    }

    /// The edges together with those that are seams only with them.
    pub(super) fn with_partners(&self, edges: &[Edge]) -> Vec<Edge> {
        with_partners(edges, self.problem.mirror, self.problem.parts)
    }

    /// Begins a stage between two fractions of the run.
    fn enter(&mut self, stage: [f64; 2]) {
        self.stage = stage;
        self.done = stage[0];
    }

    /// Notes the share of the present stage that is done.
    fn advance(&mut self, share: f64) {
        let [from, to] = self.stage;
        self.done = self.done.max(from + share.clamp(0.0, 1.0) * (to - from));
    }

    /// Solves for each of `n` candidates on all threads; candidates without a result are left out.
    fn for_each<T: Send>(
        &self,
        n: usize,
        observer: &mut dyn Observer,
        evaluate: impl Fn(usize, &mut Workspace, &Watch<'_>) -> Result<T, Error> + Sync + Send,
    ) -> Result<Vec<T>, Error> {
        report(observer, self.done)?;
        let watch = Watch::new(observer, self.done, MESSAGE);
        let results = parallel::tasks(n, |candidate| {
            let workspace = self.workspaces.lock().ok().and_then(|mut free| free.pop());
            let mut workspace = workspace.unwrap_or_else(|| self.problem.plate.workspace());
            let result = evaluate(candidate, &mut workspace, &watch);
            if let Ok(mut free) = self.workspaces.lock() {
                free.push(workspace);
            }
            result
        });
        results.into_iter().collect()
    }
}

/// A value without the digits that rounding and noise decide, so that mirror images compare equal.
pub(super) fn coarse(value: f64) -> f64 {
    f64::from_bits(value.to_bits() >> NOISY_BITS << NOISY_BITS)
}

/// Edges together with their mirror images, on a symmetric mesh, and with all parts of the edges of which they are parts,
/// on a refined one.
pub(super) fn with_partners(
    edges: &[Edge],
    mirror: Option<&[Edge]>,
    parts: Option<&[Vec<Edge>]>,
) -> Vec<Edge> {
    let mut all = edges.to_vec();
    if let Some(parts) = parts {
        all = edges.iter().flat_map(|&edge| parts[edge].iter().copied()).collect();
    }
    if let Some(mirror) = mirror {
        let images: Vec<_> = all.iter().map(|&edge| mirror[edge]).collect();
        all.extend(images);
    }
    if mirror.is_some() || parts.is_some() {
        all.sort_unstable();
        all.dedup();
    }
    all
}

impl Solution {
    /// Whether the solution meets the target and the other does not, or is cheaper.
    pub(super) fn is_better_than(&self, other: &Self) -> bool {
        match (self.meets_target, other.meets_target) {
            (true, false) => true,
            (false, true) => false,
            _ => self.price < other.price - 1e-9,
        }
    }
}
