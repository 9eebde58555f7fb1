// SPDX-License-Identifier: MIT OR Apache-2.0
//! Boundary maps onto the unit circle, and the barrier that keeps sliding arcs open.

use std::f64::consts::TAU;

use crate::mesh::{TriangleMesh, Vertex};

/// Places the boundary loop on the unit circle, counter-clockwise, arcs proportional to the edge lengths;
/// the loop's smallest vertex goes to (1, 0). Interior vertices go to the origin.
pub(super) fn arc_length(mesh: &TriangleMesh) -> Vec<[f64; 2]> {
    let boundary = &mesh.boundary_loops()[0];
    let mut map = vec![[0.0; 2]; mesh.n_vertices()];
    let lengths = edge_lengths(mesh, boundary);
    let total: f64 = lengths.iter().sum();
    let mut traveled = 0.0;
    for (&vertex, length) in boundary.iter().zip(lengths) {
        let angle = TAU * traveled / total;
        map[vertex] = [angle.cos(), angle.sin()];
        traveled += length;
    }
    map
}

/// Length of the edge that leaves each vertex of a loop.
fn edge_lengths(mesh: &TriangleMesh, boundary: &[Vertex]) -> Vec<f64> {
    let point = |k: usize| mesh.points()[boundary[k % boundary.len()]];
    (0..boundary.len()).map(|k| point(k + 1).distance(point(k))).collect()
}

/// The arc from each vertex of the loop to the next, or `None` where the loop does not run once around the
/// circle, counter-clockwise, without turning back.
pub(super) fn arcs(boundary: &[Vertex], map: &[[f64; 2]]) -> Option<Vec<f64>> {
    let arc = |k: usize| {
        let [from, to] = [boundary[k], boundary[(k + 1) % boundary.len()]].map(|v| map[v]);
        let sine = from[0] * to[1] - from[1] * to[0];
        sine.atan2(from[0] * to[0] + from[1] * to[1])
    };
    let arcs: Vec<f64> = (0..boundary.len()).map(arc).collect();
    let once = (arcs.iter().sum::<f64>() - TAU).abs() < 1e-6;
    (once && arcs.iter().all(|&arc| arc > 0.0)).then_some(arcs)
}

/// True if the loop runs once around the circle, counter-clockwise, without turning back.
pub(super) fn runs_once_around(boundary: &[Vertex], map: &[[f64; 2]]) -> bool {
    arcs(boundary, map).is_some()
}

/// Keeps the arcs of a sliding boundary from closing.
///
/// The stretch energy lets a face lose all its area at the bounded cost |τ|, so an arc could shrink to
/// nothing and lock the descent. An arc t times as long as its share of the boundary's length costs that
/// share times (t₀/t − 1)² where t < t₀ and nothing elsewhere: the energy is the papers' until an arc is
/// fifty times too short.
#[derive(Debug)]
pub(super) struct ArcBarrier {
    shares: Vec<f64>,
}

/// t₀ of [`ArcBarrier`].
const SHORTEST: f64 = 0.02;

impl ArcBarrier {
    pub(super) fn new(mesh: &TriangleMesh) -> Self {
        let mut shares = edge_lengths(mesh, &mesh.boundary_loops()[0]);
        let total: f64 = shares.iter().sum();
        shares.iter_mut().for_each(|share| *share *= TAU / total);
        Self { shares }
    }

    /// The cost of the arcs.
    pub(super) fn value(&self, arcs: &[f64]) -> f64 {
        let excess = |(arc, share): (&f64, &f64)| share * (SHORTEST * share / arc - 1.0).max(0.0).powi(2);
        arcs.iter().zip(&self.shares).map(excess).sum()
    }

    /// The derivative of the cost by the angle of each vertex of the loop.
    pub(super) fn slopes(&self, arcs: &[f64]) -> Vec<f64> {
        let by_arc = |k: usize| {
            let ratio = SHORTEST * self.shares[k] / arcs[k];
            -2.0 * (ratio - 1.0).max(0.0) * ratio * self.shares[k] / arcs[k]
        };
        let n = arcs.len();
        // the arc before a vertex grows with its angle, the arc behind it shrinks
        (0..n).map(|k| by_arc((k + n - 1) % n) - by_arc(k)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_arc_barrier_has_the_slopes_of_finite_differences() {
        let barrier = ArcBarrier { shares: vec![2.0, 2.0, TAU - 4.0] };
        let arcs_of =
            |angles: [f64; 3]| [angles[1] - angles[0], angles[2] - angles[1], TAU + angles[0] - angles[2]];
        let angles = [0.1, 0.12, 1.3];
        let slopes = barrier.slopes(&arcs_of(angles));
        for k in 0..3 {
            let moved = |h: f64| {
                let mut angles = angles;
                angles[k] += h;
                barrier.value(&arcs_of(angles))
            };
            let difference = (moved(1e-7) - moved(-1e-7)) / 2e-7;
            assert!((slopes[k] - difference).abs() < 1e-5 * (1.0 + difference.abs()), "vertex {k}");
        }
        assert_eq!(barrier.value(&arcs_of([0.0, 2.0, 4.0])), 0.0);
        assert!(barrier.value(&arcs_of(angles)) > 0.0);
    }
}
