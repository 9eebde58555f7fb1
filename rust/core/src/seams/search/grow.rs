// SPDX-License-Identifier: MIT OR Apache-2.0
//! Slits are added until the predicted shear meets the target.
//!
//! A slit runs from the borders to a tip: a vertex of large deflection far from them. Pinning ψ at a vertex lowers the
//! plate's energy by ψ² / 2C, and C grows as d², the distance to the borders squared; so tips rank by ψ² / (d² √c) with
//! the cheapest cost c to the borders, and near a tip there is no other. For each tip the whole cheapest path is a
//! candidate, and the part of it next to the borders.

use std::collections::HashMap;

use super::state::Trial;
use super::{ISLAND_PRICE, LEAF_PRICE, LEAST_ISLAND, Search, State, coarse};
use crate::control::Observer;
use crate::error::Error;
use crate::mesh::{Edge, Vertex};
use crate::seams::paths::Paths;

/// The number of tips tried at each step.
const TIPS: usize = 8;

/// Tips nearer to a better one than this part of its distance to the borders are left out.
const CROWDED: f64 = 0.6;

/// The part of a path that is a candidate too, where it has more edges than `SHORT`.
const PREFIX: f64 = 0.6;
const SHORT: usize = 5;

/// The most slits that are added in one go.
const MOST_STEPS: usize = 100;

/// The number of candidates that are measured again at once; no number of threads, so that it does not matter.
const BATCH: usize = 2;

/// The value of a slit by its seams; `None` where it must not be.
type Gains = HashMap<Vec<Edge>, Option<Gain>>;

/// What a slit does.
#[derive(Debug, Clone, Copy)]
struct Gain {
    decrease: f64,
    new_islands: usize,
}

/// A slit that may be added next.
struct Candidate {
    edges: Vec<Edge>,
    cost: f64,
    /// The state with it, once it has been measured for this step.
    trial: Option<Trial>,
}

impl Search<'_> {
    /// Adds slits until the mean is at most `goal` and the percentile at most the bound.
    pub(super) fn grow(
        &mut self,
        mut state: State,
        goal: f64,
        observer: &mut dyn Observer,
    ) -> Result<State, Error> {
        let mut gains = Gains::new();
        let first = self.figures(&state.shear).mean;
        for _ in 0..MOST_STEPS {
            let figures = self.figures(&state.shear);
            self.advance((first - figures.mean) / (first - goal).max(f64::MIN_POSITIVE));
            if figures.mean <= goal && figures.percentile <= self.problem.bound {
                break;
            }
            let mut candidates = self.slits(&state);
            let Some(best) = self.best_slit(&state, &mut candidates, &mut gains, observer)? else { break };
            state = best.state;
        }
        Ok(state)
    }

    /// The slits that may be added.
    fn slits(&self, state: &State) -> Vec<Candidate> {
        let mesh = self.problem.mesh;
        let on_border = state.cut.border_vertices(mesh);
        let borders: Vec<_> = Vertex::all(mesh.n_vertices()).filter(|&vertex| on_border[vertex]).collect();
        let cheapest = Paths::from(mesh, &borders, self.problem.cost);
        let distances = Paths::from(mesh, &borders, &mesh.lengths).costs;
        let mut candidates = Vec::new();
        for tip in self.tips(state, &cheapest.costs, &distances) {
            let path = cheapest.to(mesh, tip);
            let prefix = (path.len() as f64 * PREFIX) as usize;
            let prefixes = if path.len() > SHORT { vec![path.len(), prefix] } else { vec![path.len()] };
            for length in prefixes {
                let mut edges = self.with_partners(&path[..length]);
                edges.retain(|&edge| !state.cut.is_seam(edge));
                edges.sort_unstable();
                let cost = edges.iter().map(|&edge| self.problem.cost[edge]).sum();
                candidates.push(Candidate { edges, cost, trial: None });
            }
        }
        candidates
    }

    /// Vertices of large deflection, far from the borders and from each other.
    fn tips(&self, state: &State, costs: &[f64], distances: &[f64]) -> Vec<Vertex> {
        let mesh = self.problem.mesh;
        let score = |vertex: Vertex| match distances[vertex] {
            distance if distance > 0.0 && costs[vertex].is_finite() => {
                coarse((state.psi[vertex] / distance).powi(2) / costs[vertex].sqrt())
            }
            _ => 0.0,
        };
        let mut ranked: Vec<_> =
            Vertex::all(mesh.n_vertices()).map(|vertex| (score(vertex), vertex)).collect();
        ranked.retain(|(score, _)| *score > 0.0);
        ranked.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let points = mesh.mesh.points();
        let mut tips: Vec<Vertex> = Vec::with_capacity(TIPS);
        for (_, vertex) in ranked {
            let is_crowded =
                |&tip: &Vertex| points[tip].distance(points[vertex]) <= CROWDED * distances[tip] * mesh.unit;
            if !tips.iter().any(is_crowded) {
                tips.push(vertex);
            }
            if tips.len() == TIPS {
                break;
            }
        }
        tips
    }

    /// The slit that lowers the distortion most for its price. Values of earlier steps stand until they come first.
    fn best_slit(
        &mut self,
        state: &State,
        candidates: &mut [Candidate],
        gains: &mut Gains,
        observer: &mut dyn Observer,
    ) -> Result<Option<Trial>, Error> {
        loop {
            let mut order: Vec<_> =
                candidates.iter().enumerate().map(|(k, slit)| (rate(slit, gains), k)).collect();
            order.retain(|(rate, _)| *rate > self.problem.least_rate);
            order.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
            let Some(&(best_rate, best)) = order.first() else { return Ok(None) };
            if candidates[best].trial.is_some() {
                return Ok(candidates[best].trial.take());
            }
            let are_new = best_rate == f64::INFINITY;
            let stale = order.iter().filter(|(rate, _)| !are_new || *rate == f64::INFINITY);
            let stale = stale.map(|&(_, k)| k).filter(|&k| candidates[k].trial.is_none());
            let stale: Vec<_> = stale.take(if are_new { usize::MAX } else { BATCH }).collect();
            self.measure_slits(state, candidates, &stale, gains, observer)?;
        }
    }

    fn measure_slits(
        &mut self,
        state: &State,
        candidates: &mut [Candidate],
        which: &[usize],
        gains: &mut Gains,
        observer: &mut dyn Observer,
    ) -> Result<(), Error> {
        let mesh = self.problem.mesh;
        let mut allowed = Vec::new();
        for &k in which {
            let cut = state.cut.with(&candidates[k].edges);
            let islands = cut.islands(mesh);
            let is_small = islands.len() > state.n_islands && islands.least_area() < LEAST_ISLAND;
            let is_allowed = islands.len() <= state.n_islands.max(self.problem.max_islands);
            if islands.are_disks() && is_allowed && !is_small && !candidates[k].edges.is_empty() {
                allowed.push((k, cut, islands.len()));
            } else {
                gains.insert(candidates[k].edges.clone(), None);
            }
        }
        let this = &*self;
        let trials = this.for_each(allowed.len(), observer, |place, workspace, watch| {
            let (_, cut, n_islands) = &allowed[place];
            this.trial(state, cut.clone(), *n_islands, workspace, watch)
        })?;
        for ((k, _, n_islands), trial) in allowed.into_iter().zip(trials) {
            let new_islands = n_islands.saturating_sub(state.n_islands);
            let gain = Gain { decrease: -trial.increase, new_islands };
            gains.insert(candidates[k].edges.clone(), Some(gain));
            candidates[k].trial = Some(trial);
        }
        Ok(())
    }
}

/// The decrease of the distortion over the price; infinite for a slit that was never measured.
fn rate(slit: &Candidate, gains: &Gains) -> f64 {
    match gains.get(&slit.edges) {
        None => f64::INFINITY,
        Some(None) => 0.0,
        Some(Some(gain)) => {
            coarse(gain.decrease / (slit.cost + LEAF_PRICE + ISLAND_PRICE * gain.new_islands as f64))
        }
    }
}
