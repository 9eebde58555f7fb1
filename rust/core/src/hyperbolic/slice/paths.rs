// SPDX-License-Identifier: MIT OR Apache-2.0
//! Shortest paths along the edges of a surface, by Dijkstra's algorithm.
//!
//! Input: nonnegative lengths or costs of edges. Cost: at most O(n log n); a search for one path ends at its
//! target. Of equally near vertices the one of the lower index comes first.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::cutting::Cutting;
use crate::mesh::Vertex;
use crate::mesh::ties::on_cost_grid;

/// Vertices in the order of their distances; the bits of nonnegative floats are ordered like the floats.
type Queue = BinaryHeap<Reverse<(u64, Vertex)>>;

/// Lowers `distances` to the lengths in space of the shortest paths from `sources`, whose distances become 0.
///
/// Vertices that `distances` lacks are added. Distances from earlier sources become distances from these and the
/// new sources; the cost is that of the part that changes.
pub(super) fn lower_distances(surface: &Cutting, distances: &mut Vec<f64>, sources: &[Vertex]) {
    distances.resize(surface.points.len(), f64::INFINITY);
    let mut queue = Queue::new();
    for &source in sources {
        distances[source] = 0.0;
        queue.push(Reverse((0, source)));
    }
    while let Some(Reverse((bits, vertex))) = queue.pop() {
        let distance = f64::from_bits(bits);
        if distance > distances[vertex] {
            continue;
        }
        for neighbor in surface.neighbors(vertex) {
            let through = distance + surface.length(vertex, neighbor);
            if through < distances[neighbor] {
                distances[neighbor] = through;
                queue.push(Reverse((through.to_bits(), neighbor)));
            }
        }
    }
}

/// The cheapest path between two vertices that touches no cut between them, if there is one.
pub(super) fn cheapest_path(
    surface: &Cutting,
    from: Vertex,
    to: Vertex,
    mut cost: impl FnMut(Vertex, Vertex) -> f64,
) -> Option<Vec<Vertex>> {
    let mut best = vec![(f64::INFINITY, from); surface.points.len()];
    best[from].0 = 0.0;
    let mut queue = Queue::from([Reverse((0, from))]);
    while let Some(Reverse((bits, vertex))) = queue.pop() {
        let spent = f64::from_bits(bits);
        if vertex == to {
            return Some(backtrace(&best, from, to));
        }
        if spent > best[vertex].0 {
            continue;
        }
        for neighbor in surface.neighbors(vertex) {
            if surface.is_cut(neighbor) && neighbor != to {
                continue;
            }
            // of symmetric paths rounding must not choose
            let total = spent + on_cost_grid(cost(vertex, neighbor));
            if total < best[neighbor].0 {
                best[neighbor] = (total, vertex);
                queue.push(Reverse((total.to_bits(), neighbor)));
            }
        }
    }
    None
}

/// The path along which the search reached `to`.
fn backtrace(best: &[(f64, Vertex)], from: Vertex, to: Vertex) -> Vec<Vertex> {
    let before = |&vertex: &Vertex| (vertex != from).then(|| best[vertex].1);
    let mut path: Vec<Vertex> = std::iter::successors(Some(to), before).collect();
    path.reverse();
    path
}
