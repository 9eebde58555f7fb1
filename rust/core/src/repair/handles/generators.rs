// SPDX-License-Identifier: MIT OR Apache-2.0
//! Two loops for each handle, which no sum of others makes (D. Eppstein, Dynamic generators of topologically embedded
//! graphs, SODA 2003; J. Erickson, K. Whittlesey, Greedy optimal homotopy and homology generators, SODA 2005).
//!
//! A tree of shortest paths from a root of each piece; a spanning tree of the faces across other edges, which prefers
//! those that close long loops. Each edge in neither tree closes a loop with the paths to its ends. Loops avoid
//! boundaries where they can.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::closed::ClosedMesh;
use super::loops::Loop;
use crate::mesh::{Corner, Vertex};
use crate::sets::Sets;

/// The cost of edges at vertices closed to loops, over their length.
const DETOUR: f64 = 1e3;

/// Two loops for each handle, the shortest first.
pub(super) fn generators(mesh: &ClosedMesh) -> Vec<Loop> {
    // 1. The tree of shortest paths
    let tree = Tree::new(mesh);
    // 2. The cotree
    let edges = Corner::all(mesh.faces.len()).filter_map(|corner| {
        let across = mesh.opposite[corner].filter(|&across| across > corner)?;
        let [a, b] = corner.half_edge(&mesh.faces);
        let in_tree = tree.parent[a] == Some(b) || tree.parent[b] == Some(a);
        (!in_tree).then(|| (tree.reached[a] + tree.reached[b] + cost(mesh, a, b), corner, across))
    });
    let mut edges: Vec<_> = edges.collect();
    edges.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let mut faces = Sets::new(mesh.faces.len());
    edges.retain(|(_, corner, across)| !faces.join(corner.face().index(), across.face().index()));
    // 3. The loops of what is left
    let mut loops: Vec<Loop> =
        edges.iter().map(|(_, corner, _)| tree.closed_by(mesh, corner.half_edge(&mesh.faces))).collect();
    loops.sort_by(|a, b| a.length.total_cmp(&b.length));
    loops
}

fn cost(mesh: &ClosedMesh, from: Vertex, to: Vertex) -> f64 {
    let is_closed = mesh.is_closed_to_loops[from] || mesh.is_closed_to_loops[to];
    mesh.length(from, to) * if is_closed { DETOUR } else { 1.0 }
}

/// The shortest paths from a root of each piece.
struct Tree {
    reached: Vec<f64>,
    parent: Vec<Option<Vertex>>,
}

impl Tree {
    fn new(mesh: &ClosedMesh) -> Self {
        let n = mesh.points.len();
        let mut tree = Self { reached: vec![f64::INFINITY; n], parent: vec![None; n] };
        for root in Vertex::all(n) {
            if tree.reached[root].is_infinite() {
                tree.grow(mesh, root);
            }
        }
        tree
    }

    fn grow(&mut self, mesh: &ClosedMesh, root: Vertex) {
        self.reached[root] = 0.0;
        // the bits of positive numbers are ordered as the numbers are
        let mut queue = BinaryHeap::from([Reverse((0.0_f64.to_bits(), root))]);
        while let Some(Reverse((bits, vertex))) = queue.pop() {
            let reached = f64::from_bits(bits);
            if reached > self.reached[vertex] {
                continue;
            }
            for (_, neighbor) in mesh.neighbors(vertex) {
                let through = reached + cost(mesh, vertex, neighbor);
                if through < self.reached[neighbor] {
                    self.reached[neighbor] = through;
                    self.parent[neighbor] = Some(vertex);
                    queue.push(Reverse((through.to_bits(), neighbor)));
                }
            }
        }
    }

    /// The loop of an edge and the paths to its ends, from where these part.
    fn closed_by(&self, mesh: &ClosedMesh, [a, b]: [Vertex; 2]) -> Loop {
        let [mut to_a, mut to_b] = [a, b].map(|end| self.path_to(end));
        let common = to_a.iter().zip(&to_b).take_while(|(a, b)| a == b).count();
        let mut vertices = to_a.split_off(common - 1);
        vertices.extend(to_b.split_off(common).into_iter().rev());
        Loop::new(mesh, vertices)
    }

    /// The vertices of the path from the root to a vertex.
    fn path_to(&self, mut vertex: Vertex) -> Vec<Vertex> {
        let mut path = vec![vertex];
        while let Some(parent) = self.parent[vertex] {
            path.push(parent);
            vertex = parent;
        }
        path.reverse();
        path
    }
}
