// SPDX-License-Identifier: MIT OR Apache-2.0
//! Cheapest paths along edges (E. W. Dijkstra, A note on two problems in connexion with graphs, Numerische Mathematik
//! 1, 1959).
//!
//! Cost: O(e log n). Where two paths cost the same, that with the lower vertices wins.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::edge_mesh::EdgeMesh;
use crate::mesh::{Edge, Vertex};

/// The cheapest paths from some vertices to all others.
#[derive(Debug, Clone)]
pub(super) struct Paths {
    /// The cost of the path to each vertex, (n,); infinite where there is none.
    pub costs: Vec<f64>,
    /// The last edge of the path to each vertex; none at the sources.
    last: Vec<Option<Edge>>,
}

impl Paths {
    /// The cheapest paths from any of `sources`, with `cost` (e,) per edge; edges of infinite cost are closed.
    pub(super) fn from(mesh: &EdgeMesh, sources: &[Vertex], cost: &[f64]) -> Self {
        let mut paths =
            Self { costs: vec![f64::INFINITY; mesh.n_vertices()], last: vec![None; mesh.n_vertices()] };
        // the bits of positive numbers are ordered as the numbers are
        let mut queue = BinaryHeap::new();
        for &source in sources {
            paths.costs[source] = 0.0;
            queue.push(Reverse((0.0_f64.to_bits(), source)));
        }
        while let Some(Reverse((bits, vertex))) = queue.pop() {
            let reached = f64::from_bits(bits);
            if reached > paths.costs[vertex] {
                continue;
            }
            for &(neighbor, edge) in mesh.edges.around(vertex) {
                let through = reached + cost[edge];
                if through < paths.costs[neighbor] {
                    paths.costs[neighbor] = through;
                    paths.last[neighbor] = Some(edge);
                    queue.push(Reverse((through.to_bits(), neighbor)));
                }
            }
        }
        paths
    }

    /// Whether an edge is the last of the path to one of its ends.
    pub(super) fn uses(&self, mesh: &EdgeMesh, edge: Edge) -> bool {
        mesh.edges.ends(edge).iter().any(|&vertex| self.last[vertex] == Some(edge))
    }

    /// The edges of the path to a vertex, from its source on.
    pub(super) fn to(&self, mesh: &EdgeMesh, mut vertex: Vertex) -> Vec<Edge> {
        let mut edges = Vec::new();
        while let Some(edge) = self.last[vertex] {
            edges.push(edge);
            vertex = mesh.edges.other_end(edge, vertex);
        }
        edges.reverse();
        edges
    }
}

/// Vertices far from each other: each is the farthest from all before it, the first the farthest from `start`.
pub(super) fn far_points(mesh: &EdgeMesh, start: Vertex, n: usize, length: &[f64]) -> Vec<Vertex> {
    let mut points = Vec::with_capacity(n);
    let mut sources = vec![start];
    while points.len() < n {
        let distances = Paths::from(mesh, &sources, length).costs;
        let is_farther = |a: f64, b: f64| a.is_finite() && a > b;
        let farthest = Vertex::all(mesh.n_vertices()).fold(start, |best, vertex| {
            if is_farther(distances[vertex], distances[best]) { vertex } else { best }
        });
        points.push(farthest);
        sources = points.clone();
    }
    points
}
