// SPDX-License-Identifier: MIT OR Apache-2.0
//! Seams are taken away while the predicted shear keeps the target.
//!
//! A move takes away a free end of a slit, a part of it or all; or a segment between two islands, which merges them. The
//! move that raises the distortion least for the price that it spares comes first. A move that would miss the target
//! would miss it after others too, and is not tried again.

use std::collections::{HashMap, HashSet};

use super::state::Trial;
use super::{ISLAND_PRICE, LEAF_PRICE, Search, State, coarse};
use crate::control::Observer;
use crate::error::Error;
use crate::mesh::{Edge, Vertex};
use crate::seams::cut::{Cut, Segment};

/// The parts of a slit that moves take away.
const PARTS: [f64; 3] = [0.2, 0.5, 1.0];

/// The number of moves that are measured at once; no number of threads, so that it does not matter.
const BATCH: usize = 2;

/// What the moves have been found to do.
#[derive(Default)]
struct Known {
    /// The increase of the distortion by the seams taken away, as last measured.
    increases: HashMap<Vec<Edge>, f64>,
    refused: HashSet<Vec<Edge>>,
}

/// Seams that may be taken away.
struct Move {
    edges: Vec<Edge>,
    /// What the move spares.
    price: f64,
    n_islands: usize,
    /// The state without the seams, once it has been measured for this step.
    trial: Option<Trial>,
}

impl Search<'_> {
    /// Takes seams away while the mean stays at most `limit`, and the percentile at most `bound` or where it is.
    pub(super) fn draw_back(
        &mut self,
        mut state: State,
        limit: f64,
        bound: f64,
        observer: &mut dyn Observer,
    ) -> Result<State, Error> {
        let mut known = Known::default();
        let most = state.cut.sum(self.problem.cost);
        loop {
            self.advance(1.0 - state.cut.sum(self.problem.cost) / most.max(f64::MIN_POSITIVE));
            let mut moves = self.moves(&state, &known.refused);
            match self.best_move(&state, &mut moves, (limit, bound), &mut known, observer)? {
                Some(next) => state = next,
                None => return Ok(state),
            }
        }
    }

    /// The moves that leave disks and spare something.
    fn moves(&self, state: &State, refused: &HashSet<Vec<Edge>>) -> Vec<Move> {
        let mesh = self.problem.mesh;
        let labels = state.cut.islands(mesh).of_face;
        let degrees = state.cut.degrees(mesh, true);
        let separates = |&edge: &Edge| match mesh.faces_at(edge) {
            (first, Some(second)) => labels[first] != labels[second],
            _ => false,
        };
        let mut moves = Vec::new();
        for segment in state.cut.segments(mesh) {
            if segment.edges.iter().any(|&edge| self.problem.given.is_seam(edge)) {
                continue;
            }
            if segment.edges.iter().all(separates) {
                moves.extend(self.movement(state, &segment.edges, refused));
            } else {
                for segment in [segment.reversed(), segment] {
                    moves.extend(
                        retractions(&segment, &degrees)
                            .into_iter()
                            .filter_map(|edges| self.movement(state, edges, refused)),
                    );
                }
            }
        }
        // parts of a slit may reach to the end of one edge of the mesh that was refined
        moves.dedup_by(|a, b| a.edges == b.edges);
        moves
    }

    /// The move that takes edges and their mirror images away, unless it is refused.
    fn movement(&self, state: &State, edges: &[Edge], refused: &HashSet<Vec<Edge>>) -> Option<Move> {
        let mesh = self.problem.mesh;
        let mut edges = self.with_partners(edges);
        edges.retain(|&edge| state.cut.is_seam(edge));
        edges.sort_unstable();
        if edges.is_empty() || refused.contains(&edges) {
            return None;
        }
        let cut = state.cut.without(&edges);
        let islands = cut.islands(mesh);
        // islands that a given chord has parted must not become one again
        let merges = islands.len() < state.n_islands && !self.problem.given.is_empty();
        if merges || !islands.are_disks() {
            return None;
        }
        let price = self.spared(state, &cut, islands.len(), &edges);
        (price > 0.0).then_some(Move { edges, price, n_islands: islands.len(), trial: None })
    }

    /// The price of the cut with some edges less that without them.
    fn spared(&self, state: &State, cut: &Cut, n_islands: usize, edges: &[Edge]) -> f64 {
        let mesh = self.problem.mesh;
        let cost: f64 = edges.iter().map(|&edge| self.problem.cost[edge]).sum();
        let leaves = state.cut.n_leaves(mesh) as f64 - cut.n_leaves(mesh) as f64;
        let islands = state.n_islands as f64 - n_islands as f64;
        cost + ISLAND_PRICE * islands + LEAF_PRICE * leaves
    }

    /// The state after the best move that keeps the limits. Values of earlier steps stand until they come first.
    fn best_move(
        &mut self,
        state: &State,
        moves: &mut [Move],
        (limit, bound): (f64, f64),
        known: &mut Known,
        observer: &mut dyn Observer,
    ) -> Result<Option<State>, Error> {
        let before = self.figures(&state.shear).percentile;
        loop {
            let rate =
                |step: &Move| known.increases.get(&step.edges).map(|increase| coarse(increase / step.price));
            let mut order: Vec<_> = moves.iter().enumerate().map(|(k, step)| (rate(step), k)).collect();
            order.retain(|&(_, k)| !known.refused.contains(&moves[k].edges));
            // moves that were never measured come first
            let by_rate = |rate: Option<f64>| rate.unwrap_or(f64::NEG_INFINITY);
            order.sort_by(|a, b| by_rate(a.0).total_cmp(&by_rate(b.0)).then(a.1.cmp(&b.1)));
            let Some(&(best_rate, best)) = order.first() else { return Ok(None) };
            if let Some(trial) = moves[best].trial.take() {
                let after = self.figures(&trial.state.shear);
                if after.mean <= limit && (after.percentile <= bound || after.percentile <= before) {
                    return Ok(Some(trial.state));
                }
                known.refused.insert(moves[best].edges.clone());
                continue;
            }
            let stale = order.iter().filter(|(rate, _)| best_rate.is_some() || rate.is_none());
            let stale = stale.map(|&(_, k)| k).filter(|&k| moves[k].trial.is_none());
            let stale: Vec<_> = stale.take(if best_rate.is_none() { usize::MAX } else { BATCH }).collect();
            self.measure_moves(state, moves, &stale, known, observer)?;
        }
    }

    fn measure_moves(
        &mut self,
        state: &State,
        moves: &mut [Move],
        which: &[usize],
        known: &mut Known,
        observer: &mut dyn Observer,
    ) -> Result<(), Error> {
        let (this, steps) = (&*self, &*moves);
        let trials = this.for_each(which.len(), observer, |place, workspace, watch| {
            let step = &steps[which[place]];
            this.trial(state, state.cut.without(&step.edges), step.n_islands, workspace, watch)
        })?;
        for (&k, trial) in which.iter().zip(trials) {
            known.increases.insert(moves[k].edges.clone(), trial.increase);
            moves[k].trial = Some(trial);
        }
        Ok(())
    }
}

/// The parts of a segment from its first vertex on, where it ends freely there.
fn retractions<'a>(segment: &'a Segment, degrees: &[u32]) -> Vec<&'a [Edge]> {
    let first: Vertex = segment.vertices[0];
    if degrees[first] != 1 {
        return Vec::new();
    }
    let n = segment.edges.len();
    let mut lengths = PARTS.map(|part| ((n as f64 * part).round() as usize).max(1)).to_vec();
    lengths.dedup();
    lengths.into_iter().map(|length| &segment.edges[..length]).collect()
}
