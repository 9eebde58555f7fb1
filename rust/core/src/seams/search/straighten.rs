// SPDX-License-Identifier: MIT OR Apache-2.0
//! Segments are replaced by the cheapest paths between their ends that keep off the other seams.

use super::{Search, State};
use crate::control::Observer;
use crate::error::Error;
use crate::seams::cut::{Cut, Segment};
use crate::seams::paths::Paths;
use crate::seams::progress::report;

/// Segments of fewer edges stay as they are.
const FEWEST: usize = 3;

impl Search<'_> {
    /// The state with every segment as cheap as it can be; islands stay disks and become no more.
    pub(super) fn straighten(&mut self, state: State, observer: &mut dyn Observer) -> Result<State, Error> {
        let mut cut = state.cut;
        for segment in cut.segments(self.problem.mesh) {
            report(observer, self.done)?;
            let stays =
                segment.edges.iter().any(|&edge| self.problem.given.is_seam(edge) || !cut.is_seam(edge));
            if !stays && !segment.is_closed() && segment.edges.len() >= FEWEST {
                cut = self.straightened(&cut, &segment).unwrap_or(cut);
            }
        }
        self.state(cut, observer)
    }

    /// The cut with a cheaper path in place of a segment, if there is one.
    fn straightened(&self, cut: &Cut, segment: &Segment) -> Option<Cut> {
        let (mesh, cost) = (self.problem.mesh, self.problem.cost);
        let [first, last] = [segment.vertices[0], segment.vertices[segment.edges.len()]];
        let rest = cut.without(&self.with_partners(&segment.edges));
        let mut is_taken = rest.border_vertices(mesh);
        is_taken[first] = false;
        is_taken[last] = false;
        let is_closed = |edge| mesh.edges.ends(edge).iter().any(|&vertex| is_taken[vertex]);
        let open_cost: Vec<_> =
            mesh.edges.all().map(|edge| if is_closed(edge) { f64::INFINITY } else { cost[edge] }).collect();
        let path = Paths::from(mesh, &[first], &open_cost).to(mesh, last);
        if path.is_empty() {
            return None;
        }
        let straightened = rest.with(&self.with_partners(&path));
        let islands = straightened.islands(mesh);
        let is_cheaper = straightened.sum(cost) < cut.sum(cost) - 1e-12;
        (is_cheaper && islands.are_disks() && islands.len() <= cut.islands(mesh).len())
            .then_some(straightened)
    }
}
