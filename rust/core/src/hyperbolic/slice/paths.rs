// SPDX-License-Identifier: MIT OR Apache-2.0
//! Shortest paths along the edges of a surface, by Dijkstra's algorithm.
//!
//! Input: nonnegative lengths or costs of edges. Cost: at most O(n log n); a search for one path ends at its
//! target. Of equally near vertices the one of the lower index comes first.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::cutting::Cutting;

/// Vertices in the order of their distances; the bits of nonnegative floats are ordered like the floats.
type Queue = BinaryHeap<Reverse<(u64, u32)>>;

/// Lowers `distances` to the lengths in space of the shortest paths from `sources`, whose distances become 0.
///
/// Vertices that `distances` lacks are added. Distances from earlier sources become distances from these and the
/// new sources; the cost is that of the part that changes.
pub(super) fn lower_distances(surface: &Cutting, distances: &mut Vec<f64>, sources: &[u32]) {
    distances.resize(surface.points.len(), f64::INFINITY);
    let mut queue = Queue::new();
    for &source in sources {
        distances[source as usize] = 0.0;
        queue.push(Reverse((0, source)));
    }
    while let Some(Reverse((bits, vertex))) = queue.pop() {
        let distance = f64::from_bits(bits);
        if distance > distances[vertex as usize] {
            continue;
        }
        for neighbor in surface.neighbors(vertex) {
            let through = distance + surface.length(vertex, neighbor);
            if through < distances[neighbor as usize] {
                distances[neighbor as usize] = through;
                queue.push(Reverse((through.to_bits(), neighbor)));
            }
        }
    }
}

/// The cheapest path between two vertices that touches no cut between them, if there is one.
pub(super) fn cheapest_path(
    surface: &Cutting,
    from: u32,
    to: u32,
    mut cost: impl FnMut(u32, u32) -> f64,
) -> Option<Vec<u32>> {
    let mut best = vec![(f64::INFINITY, from); surface.points.len()];
    best[from as usize].0 = 0.0;
    let mut queue = Queue::from([Reverse((0, from))]);
    while let Some(Reverse((bits, vertex))) = queue.pop() {
        let spent = f64::from_bits(bits);
        if vertex == to {
            return Some(backtrace(&best, from, to));
        }
        if spent > best[vertex as usize].0 {
            continue;
        }
        for neighbor in surface.neighbors(vertex) {
            if surface.is_cut(neighbor) && neighbor != to {
                continue;
            }
            let total = spent + cost(vertex, neighbor);
            if total < best[neighbor as usize].0 {
                best[neighbor as usize] = (total, vertex);
                queue.push(Reverse((total.to_bits(), neighbor)));
            }
        }
    }
    None
}

/// The path along which the search reached `to`.
fn backtrace(best: &[(f64, u32)], from: u32, to: u32) -> Vec<u32> {
    let before = |&vertex: &u32| (vertex != from).then(|| best[vertex as usize].1);
    let mut path: Vec<u32> = std::iter::successors(Some(to), before).collect();
    path.reverse();
    path
}
