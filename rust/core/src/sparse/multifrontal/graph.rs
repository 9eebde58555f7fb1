// SPDX-License-Identifier: MIT OR Apache-2.0
//! The graph of the unknowns, whose edges join nodes that share an element.

/// No node: a held corner, or an unused place of an element.
pub(in crate::sparse) const NONE: u32 = u32::MAX;

/// The neighbors of every node, ascending, without the node itself.
pub(super) struct Graph {
    starts: Vec<u32>,
    neighbors: Vec<u32>,
}

impl Graph {
    /// The graph in which the nodes of each clique are neighbors of each other; [`NONE`] is no node.
    pub(super) fn of_cliques(n_nodes: usize, cliques: &[[u32; 3]]) -> Self {
        let mut starts = vec![0_u32; n_nodes + 1];
        for_each_pair(cliques, |from, _| starts[from as usize + 1] += 1);
        for node in 0..n_nodes {
            starts[node + 1] += starts[node];
        }
        let mut ends = starts.clone();
        let mut neighbors = vec![0; starts[n_nodes] as usize];
        for_each_pair(cliques, |from, to| {
            neighbors[ends[from as usize] as usize] = to;
            ends[from as usize] += 1;
        });
        let mut graph = Self { starts, neighbors };
        graph.sort_and_drop_repeats();
        graph
    }

    fn sort_and_drop_repeats(&mut self) {
        let mut kept = 0;
        let mut start = 0;
        for node in 0..self.n_nodes() {
            let end = self.starts[node + 1] as usize;
            self.neighbors[start..end].sort_unstable();
            let first = kept;
            for k in start..end {
                if kept == first || self.neighbors[kept - 1] != self.neighbors[k] {
                    self.neighbors[kept] = self.neighbors[k];
                    kept += 1;
                }
            }
            start = end;
            self.starts[node + 1] = kept as u32;
        }
        self.neighbors.truncate(kept);
        self.neighbors.shrink_to_fit();
    }

    pub(super) fn n_nodes(&self) -> usize {
        self.starts.len() - 1
    }

    /// The neighbors of `node`, ascending.
    pub(super) fn neighbors(&self, node: u32) -> &[u32] {
        &self.neighbors[self.starts[node as usize] as usize..self.starts[node as usize + 1] as usize]
    }

    /// All neighbors, those of node v from `starts[v]` to `starts[v + 1]`.
    pub(super) fn compressed(&self) -> (&[u32], &[u32]) {
        (&self.starts, &self.neighbors)
    }
}

/// Calls `visit(from, to)` for all ordered pairs of different nodes of each clique.
fn for_each_pair(cliques: &[[u32; 3]], mut visit: impl FnMut(u32, u32)) {
    for clique in cliques {
        for (k, &from) in clique.iter().enumerate() {
            for to in [clique[(k + 1) % 3], clique[(k + 2) % 3]] {
                if from != NONE && to != NONE {
                    visit(from, to);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbors_are_ascending_and_named_once() {
        let graph = Graph::of_cliques(5, &[[2, 1, 0], [1, 2, 3], [NONE, 3, 0], [4, NONE, NONE]]);
        let all: Vec<&[u32]> = (0..5).map(|node| graph.neighbors(node)).collect();
        assert_eq!(all, [&[1, 2, 3][..], &[0, 2, 3], &[0, 1, 3], &[0, 1, 2], &[]]);
    }

    #[test]
    fn a_graph_may_be_empty() {
        assert_eq!(Graph::of_cliques(0, &[]).n_nodes(), 0);
    }
}
