// SPDX-License-Identifier: MIT OR Apache-2.0
//! The seams that make a surface of any genus, with any number of boundary loops, one disk.
//!
//! Tree–cotree decomposition (D. Eppstein, Dynamic generators of topologically embedded graphs, SODA 2003; J. Erickson,
//! K. Whittlesey, Greedy optimal homotopy and homology generators, SODA 2005):
//!
//! 1. A tree of cheapest paths from a root, along which boundary and given seams are nearly free.
//! 2. A spanning tree of the faces across the edges outside that tree, which prefers edges that close long loops.
//! 3. The edges in neither tree and the tree's own paths to them are a cut graph; dangling branches are trimmed.
//!
//! The cheapest of several roots is taken. A closed surface of genus 0 stays closed. Cost: O(e log e) a root.

use super::cut::Cut;
use super::edge_mesh::EdgeMesh;
use super::paths::Paths;
use crate::mesh::{Edge, Face, Vertex};

/// The number of roots tried.
const ROOTS: usize = 8;

/// The cost of edges of the boundary and of given seams, over the mean cost.
const NEARLY_FREE: f64 = 1e-9;

/// The cheapest cut found that contains `given` and leaves disks only, or closed surfaces of genus 0.
pub(super) fn cut_graph(mesh: &EdgeMesh, cost: &[f64], given: &Cut) -> Cut {
    let cost_of =
        |cut: &Cut| cut.seams().filter(|&edge| !given.is_seam(edge)).map(|edge| cost[edge]).sum::<f64>();
    let cuts = roots(mesh, given).into_iter().map(|root| from_root(mesh, cost, given, root));
    let cheapest = cuts.map(|cut| (cost_of(&cut), cut)).min_by(|a, b| a.0.total_cmp(&b.0));
    cheapest.map_or_else(|| given.clone(), |(_, cut)| cut)
}

/// Vertices of the borders where there are any, else of the whole mesh, evenly by index.
fn roots(mesh: &EdgeMesh, given: &Cut) -> Vec<Vertex> {
    let on_border = given.border_vertices(mesh);
    let mut candidates: Vec<_> = Vertex::all(mesh.n_vertices()).filter(|&vertex| on_border[vertex]).collect();
    if candidates.is_empty() {
        candidates = Vertex::all(mesh.n_vertices()).collect();
    }
    let n = ROOTS.min(candidates.len());
    (0..n).map(|k| candidates[k * (candidates.len() - 1) / (n - 1).max(1)]).collect()
}

fn from_root(mesh: &EdgeMesh, cost: &[f64], given: &Cut, root: Vertex) -> Cut {
    // 1. The tree
    let free = NEARLY_FREE * cost.iter().filter(|cost| cost.is_finite()).sum::<f64>() / cost.len() as f64;
    let cost_of = |edge: Edge| if given.is_border(mesh, edge) { free } else { cost[edge] };
    let costs: Vec<_> = mesh.edges.all().map(cost_of).collect();
    let tree = Paths::from(mesh, &[root], &costs);
    // 2. The cotree
    let mut crossed: Vec<_> = mesh
        .edges
        .all()
        .filter(|&edge| !given.is_border(mesh, edge) && !tree.uses(mesh, edge))
        .map(|edge| {
            let [a, b] = mesh.edges.ends(edge);
            (tree.costs[a] + tree.costs[b] + costs[edge], edge)
        })
        .collect();
    crossed.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let mut faces = Faces::new(mesh.n_faces());
    let in_cotree = crossed.into_iter().map(|(_, edge)| edge).filter(|&edge| {
        let (first, second) = mesh.faces_at(edge);
        second.is_some_and(|second| faces.join(first, second))
    });
    // 3. What is left
    let mut cut = Cut::none(mesh);
    cut.add(&mesh.edges.all().filter(|&edge| !mesh.edges.is_boundary(edge)).collect::<Vec<_>>());
    cut.remove(&in_cotree.collect::<Vec<_>>());
    cut.add(&given.seams().collect::<Vec<_>>());
    trim(mesh, &mut cut, given);
    cut
}

/// Removes seams that end freely, except given ones.
fn trim(mesh: &EdgeMesh, cut: &mut Cut, given: &Cut) {
    let mut degrees = cut.degrees(mesh, true);
    let mut pending: Vec<_> = Vertex::all(mesh.n_vertices()).filter(|&vertex| degrees[vertex] == 1).collect();
    while let Some(vertex) = pending.pop() {
        let around = mesh.edges.around(vertex).iter();
        let dangling = around.copied().find(|&(_, edge)| cut.is_seam(edge) && !given.is_seam(edge));
        let Some((neighbor, edge)) = dangling.filter(|_| degrees[vertex] == 1) else { continue };
        cut.remove(&[edge]);
        degrees[vertex] -= 1;
        degrees[neighbor] -= 1;
        if degrees[neighbor] == 1 {
            pending.push(neighbor);
        }
    }
}

/// Disjoint sets of faces.
struct Faces {
    parent: Vec<Face>,
}

impl Faces {
    fn new(n: usize) -> Self {
        Self { parent: Face::all(n).collect() }
    }

    fn root(&mut self, mut face: Face) -> Face {
        while self.parent[face] != face {
            let grandparent = self.parent[self.parent[face]];
            self.parent[face] = grandparent;
            face = grandparent;
        }
        face
    }

    /// Joins two sets; false where they are one already.
    fn join(&mut self, a: Face, b: Face) -> bool {
        let [a, b] = [self.root(a), self.root(b)];
        self.parent[a.max(b)] = a.min(b);
        a != b
    }
}
