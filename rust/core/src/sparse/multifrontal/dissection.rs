// SPDX-License-Identifier: MIT OR Apache-2.0
//! Nested dissection: an order in which the two halves of the graph come before their separator, recursively.
//!
//! A. George, Nested dissection of a regular finite element mesh, SIAM J. Numer. Anal. 10 (1973). METIS (G. Karypis
//! and V. Kumar, 1998) cuts the graph along few edges into 2^k parts by halving it k times; the smallest set of
//! vertices that touches all cut edges of a level (Kőnig's theorem) separates its halves. The parts themselves are
//! ordered by minimum degree. Cost: nearly linear; on large meshes the factorization takes a fraction of the work after
//! minimum degree alone.

use std::sync::{Mutex, PoisonError};

use super::graph::{Graph, NONE};
use crate::error::Error;
use crate::sparse::faer::minimum_degree;

/// Parts of at most this many vertices are not cut.
const PART: usize = 120;

/// An order of the nodes; `None` where METIS cannot partition the graph.
///
/// # Errors
/// As of [`minimum_degree`].
pub(super) fn nested_dissection(graph: &Graph) -> Result<Option<Vec<u32>>, Error> {
    // 1. Parts; the highest bit of a part's number tells the first cut
    let levels = (graph.n_nodes() / PART).max(2).ilog2();
    let Some(parts) = partition(graph, 1 << levels) else { return Ok(None) };
    // 2. Separators, from the first cut to the last
    let mut is_separator = vec![false; graph.n_nodes()];
    let separators: Vec<Vec<u32>> =
        (0..levels).rev().map(|bit| separate(graph, &parts, bit, &mut is_separator)).collect();
    // 3. The other nodes, then the separators from the last cut to the first
    let mut order = order_inside(graph, &is_separator)?;
    separators.iter().rev().for_each(|separator| order.extend_from_slice(separator));
    Ok(Some(order))
}

/// Serializes calls of METIS, whose random numbers, of a fixed seed, come from one generator for the whole process.
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

/// The part of each node, whose bits name the halves it belongs to.
fn partition(graph: &Graph, n_parts: i32) -> Option<Vec<i32>> {
    let _alone = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
    let signed = |all: &[u32]| all.iter().map(|&index| i32::try_from(index)).collect::<Result<Vec<_>, _>>();
    let (starts, neighbors) = graph.compressed();
    let (starts, neighbors) = (signed(starts).ok()?, signed(neighbors).ok()?);
    let mut parts = vec![0; graph.n_nodes()];
    metis::Graph::new(1, n_parts, &starts, &neighbors).ok()?.part_recursive(&mut parts).ok()?;
    Some(parts)
}

/// The smallest set of nodes that touches all edges between parts that differ in `bit` first; nodes that are in a
/// separator already touch theirs.
fn separate(graph: &Graph, parts: &[i32], bit: u32, is_separator: &mut [bool]) -> Vec<u32> {
    let cover = {
        let is_cut = |from: u32, to: u32| {
            let differ = parts[from as usize] ^ parts[to as usize];
            differ >> bit == 1 && !is_separator[from as usize] && !is_separator[to as usize]
        };
        smallest_cover(graph, is_cut, |node| parts[node as usize] >> bit & 1 == 0)
    };
    cover.iter().for_each(|&node| is_separator[node as usize] = true);
    cover
}

/// A smallest vertex cover of the cut edges, which join left nodes to right ones.
fn smallest_cover(
    graph: &Graph,
    is_cut: impl Fn(u32, u32) -> bool,
    is_left: impl Fn(u32) -> bool,
) -> Vec<u32> {
    let (nodes, is_cut) = (0..graph.n_nodes() as u32, &is_cut);
    let cut = |node: u32| graph.neighbors(node).iter().copied().filter(move |&to| is_cut(node, to));
    let left: Vec<u32> = nodes.filter(|&node| is_left(node) && cut(node).next().is_some()).collect();
    let mut matching = Matching::new(graph.n_nodes());
    for &node in &left {
        if let Some(free) = cut(node).find(|&to| matching.mate[to as usize] == NONE) {
            matching.join(node, free);
        }
    }
    for &node in &left {
        if matching.mate[node as usize] == NONE {
            matching.augment(node, &cut);
        }
    }
    // the right nodes cover where alternating paths reach them from left nodes without a mate, elsewhere the left nodes
    matching.reached.iter_mut().for_each(|stamp| *stamp = NONE);
    let mut cover = Vec::new();
    for &node in &left {
        if matching.mate[node as usize] == NONE {
            matching.reach(node, &cut, &mut cover);
        }
    }
    let uncovered = |node: &&u32| {
        let mate = matching.mate[**node as usize];
        mate != NONE && matching.reached[mate as usize] == NONE
    };
    cover.extend(left.iter().filter(uncovered));
    cover
}

/// A matching between left and right nodes along cut edges.
struct Matching {
    mate: Vec<u32>,
    /// The left node from which the last search reached each right node.
    from: Vec<u32>,
    /// The last search that reached each right node.
    reached: Vec<u32>,
}

impl Matching {
    fn new(n: usize) -> Self {
        Self { mate: vec![NONE; n], from: vec![NONE; n], reached: vec![NONE; n] }
    }

    fn join(&mut self, left: u32, right: u32) {
        self.mate[left as usize] = right;
        self.mate[right as usize] = left;
    }

    /// Augments the matching by an alternating path from `start` to a free right node, where there is one.
    fn augment<I: Iterator<Item = u32>>(&mut self, start: u32, cut: &impl Fn(u32) -> I) {
        let mut open = vec![start];
        while let Some(left) = open.pop() {
            for right in cut(left) {
                if std::mem::replace(&mut self.reached[right as usize], start) == start {
                    continue;
                }
                self.from[right as usize] = left;
                match self.mate[right as usize] {
                    NONE => return self.flip(start, right),
                    mate => open.push(mate),
                }
            }
        }
    }

    fn flip(&mut self, start: u32, end: u32) {
        let mut right = end;
        loop {
            let left = self.from[right as usize];
            let next = self.mate[left as usize];
            self.join(left, right);
            if left == start {
                return;
            }
            right = next;
        }
    }

    /// Adds to `cover` all right nodes that alternating paths from `start` reach for the first time.
    fn reach<I: Iterator<Item = u32>>(&mut self, start: u32, cut: &impl Fn(u32) -> I, cover: &mut Vec<u32>) {
        let mut open = vec![start];
        while let Some(left) = open.pop() {
            for right in cut(left) {
                if std::mem::replace(&mut self.reached[right as usize], start) == NONE {
                    cover.push(right);
                    open.push(self.mate[right as usize]);
                }
            }
        }
    }
}

/// The nodes outside all separators by minimum degree.
fn order_inside(graph: &Graph, is_separator: &[bool]) -> Result<Vec<u32>, Error> {
    let nodes: Vec<u32> = (0..graph.n_nodes() as u32).filter(|&node| !is_separator[node as usize]).collect();
    let mut index = vec![NONE; graph.n_nodes()];
    nodes.iter().enumerate().for_each(|(k, &node)| index[node as usize] = k as u32);
    let (mut starts, mut neighbors) = (vec![0], Vec::new());
    for &node in &nodes {
        let inside = graph.neighbors(node).iter().map(|&to| index[to as usize]);
        neighbors.extend(inside.filter(|&to| to != NONE));
        starts.push(neighbors.len() as u32);
    }
    let order = minimum_degree(&starts, &neighbors)?;
    Ok(order.into_iter().map(|k| nodes[k as usize]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The graph of a grid of n × n vertices with one diagonal in each square.
    fn grid(n: u32) -> Graph {
        let squares = (0..(n - 1) * (n - 1)).map(|k| k / (n - 1) * n + k % (n - 1));
        let faces: Vec<[u32; 3]> =
            squares.flat_map(|a| [[a, a + 1, a + n + 1], [a, a + n + 1, a + n]]).collect();
        Graph::of_cliques((n * n) as usize, &faces)
    }

    #[test]
    fn every_node_is_ordered_once_and_twice_the_same() {
        for n in [2, 9, 60] {
            let order = nested_dissection(&grid(n)).unwrap().unwrap();
            let mut sorted = order.clone();
            sorted.sort_unstable();
            assert!(sorted.into_iter().eq(0..n * n));
            assert_eq!(nested_dissection(&grid(n)).unwrap().unwrap(), order);
        }
    }

    #[test]
    fn separators_touch_all_cut_edges_and_are_small() {
        let graph = grid(40);
        let parts: Vec<i32> = (0..1600).map(|node| i32::from(node % 40 >= 20)).collect();
        let mut is_separator = vec![false; 1600];
        assert_eq!(separate(&graph, &parts, 0, &mut is_separator).len(), 40);
        for node in 0..1600_u32 {
            for &to in graph.neighbors(node) {
                let is_cut = parts[node as usize] != parts[to as usize];
                assert!(!is_cut || is_separator[node as usize] || is_separator[to as usize]);
            }
        }
    }
}
