// SPDX-License-Identifier: MIT OR Apache-2.0
//! Cheapest paths along edges (E. W. Dijkstra, A note on two problems in connexion with graphs, Numerische Mathematik
//! 1, 1959).
//!
//! Cost: O(e log n). Where two paths cost the same, that with the lower vertices wins.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::edge_mesh::EdgeMesh;
use crate::mesh::ties::on_cost_grid;
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

/// Vertices far from each other in the largest part of the mesh that edges of finite `cost` join.
pub(super) fn far_points_within_reach(mesh: &EdgeMesh, n: usize, cost: &[f64]) -> Vec<Vertex> {
    let open =
        |(&length, cost): (&f64, &f64)| if cost.is_finite() { on_cost_grid(length) } else { f64::INFINITY };
    let lengths: Vec<_> = mesh.lengths.iter().zip(cost).map(open).collect();
    far_points(mesh, first_of_largest_part(mesh, cost), n, &lengths)
}

/// The lowest vertex of the largest part of the mesh that edges of finite `cost` join.
pub(super) fn first_of_largest_part(mesh: &EdgeMesh, cost: &[f64]) -> Vertex {
    let mut is_reached = vec![false; mesh.n_vertices()];
    let (mut largest, mut first) = (0, Vertex(0));
    for seed in Vertex::all(mesh.n_vertices()) {
        let mut pending = vec![seed];
        let mut size = 0;
        while let Some(vertex) = pending.pop() {
            if !is_reached[vertex] {
                is_reached[vertex] = true;
                size += 1;
                let open = mesh.edges.around(vertex).iter().filter(|(_, edge)| cost[*edge].is_finite());
                pending.extend(open.map(|(neighbor, _)| *neighbor));
            }
        }
        if size > largest {
            (largest, first) = (size, seed);
        }
    }
    first
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seams::sample_surfaces::{flat_grid, perforated_cylinder, random_numbers, torus};

    /// The costs by as many sweeps over all edges as there are vertices (Bellman and Ford).
    fn swept(mesh: &EdgeMesh, sources: &[Vertex], cost: &[f64]) -> Vec<f64> {
        let mut costs = vec![f64::INFINITY; mesh.n_vertices()];
        sources.iter().for_each(|&source| costs[source] = 0.0);
        for _ in 0..mesh.n_vertices() {
            for edge in mesh.edges.all() {
                let [a, b] = mesh.edges.ends(edge);
                costs[b] = costs[b].min(costs[a] + cost[edge]);
                costs[a] = costs[a].min(costs[b] + cost[edge]);
            }
        }
        costs
    }

    #[test]
    fn no_path_is_cheaper() {
        for (k, surface) in [flat_grid(9, 7), perforated_cylinder(), torus()].into_iter().enumerate() {
            let mesh = EdgeMesh::new(surface);
            let mut random = random_numbers(k as u64);
            // whole numbers, some edges closed: sums are exact
            let mut price = || if random() < 0.3 { f64::INFINITY } else { (20.0 * random()).ceil() };
            let cost: Vec<_> = mesh.edges.all().map(|_| price()).collect();
            let sources = [Vertex(0), Vertex(5)];
            let paths = Paths::from(&mesh, &sources, &cost);
            assert_eq!(paths.costs, swept(&mesh, &sources, &cost));
            for vertex in Vertex::all(mesh.n_vertices()) {
                let path = paths.to(&mesh, vertex);
                let is_reached = paths.costs[vertex].is_finite() && !sources.contains(&vertex);
                assert_eq!(path.is_empty(), !is_reached);
                if is_reached {
                    assert_eq!(path.iter().map(|&edge| cost[edge]).sum::<f64>(), paths.costs[vertex]);
                    assert!(sources.iter().any(|source| mesh.edges.ends(path[0]).contains(source)));
                    assert!(path.iter().all(|&edge| paths.uses(&mesh, edge)));
                }
            }
        }
    }

    #[test]
    fn of_equal_paths_that_with_the_lower_vertices_wins() {
        let mesh = EdgeMesh::new(flat_grid(8, 8));
        let paths = Paths::from(&mesh, &[Vertex(0)], &vec![1.0; mesh.n_edges()]);
        for vertex in Vertex::all(mesh.n_vertices()).skip(1) {
            let last = paths.to(&mesh, vertex).pop().unwrap();
            let is_before =
                |&&(neighbor, _): &&(Vertex, Edge)| paths.costs[neighbor] + 1.0 == paths.costs[vertex];
            let lowest = mesh.edges.around(vertex).iter().find(is_before).unwrap().0;
            assert_eq!(mesh.edges.other_end(last, vertex), lowest);
        }
    }

    #[test]
    fn far_points_within_reach_lie_in_the_largest_part() {
        let mesh = EdgeMesh::new(flat_grid(9, 7));
        // columns 0 to 3, and 4 to 9
        let column = |vertex: Vertex| vertex.0 % 10;
        let is_open = |edge| mesh.edges.ends(edge).map(|v| column(v) > 3).iter().all(|&x| x);
        let is_first = |edge| mesh.edges.ends(edge).map(|v| column(v) < 4).iter().all(|&x| x);
        let price = |edge| if is_open(edge) || is_first(edge) { 1.0 } else { f64::INFINITY };
        let cost: Vec<_> = mesh.edges.all().map(price).collect();
        assert_eq!(first_of_largest_part(&mesh, &cost), Vertex(4));
        let points = far_points_within_reach(&mesh, 4, &cost);
        assert!(points.iter().all(|&vertex| column(vertex) > 3), "{points:?}");
    }

    #[test]
    fn every_far_point_is_the_farthest_from_those_before_it() {
        for surface in [flat_grid(8, 8), torus()] {
            let mesh = EdgeMesh::new(surface);
            let start = Vertex(40);
            let points = far_points(&mesh, start, 5, &mesh.lengths);
            for k in 0..points.len() {
                let before = if k == 0 { &[start] } else { &points[..k] };
                let distances = Paths::from(&mesh, before, &mesh.lengths).costs;
                assert_eq!(distances[points[k]], distances.iter().copied().fold(0.0, f64::max));
            }
        }
    }
}
