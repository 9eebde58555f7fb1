// SPDX-License-Identifier: MIT OR Apache-2.0
//! The shortest loop that crosses a given loop exactly once; no such loop divides the surface (S. Cabello, B. Mohar,
//! Finding shortest non-separating and non-contractible cycles for topologically embedded graphs, Discrete & Computational
//! Geometry 37, 2007).
//!
//! The surface is cut open along the loop, whose vertices become two, one on either side. The shortest path between the
//! two of one vertex is a loop that crosses there; the shortest over all vertices has no vertex twice. Paths are searched
//! up to a length that doubles until one is found. Cost: for each vertex of the loop Dijkstra's algorithm up to twice the
//! length of the shortest path.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::closed::ClosedMesh;
use super::loops::Loop;
use crate::mesh::{Corner, Vertex};

/// The length of the first search, in mean edges of the loop.
const FIRST_REACH: f64 = 4.0;

/// Where an edge leaves a vertex of a loop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sector {
    Ahead,
    Left,
    Behind,
    Right,
}

/// The edges that leave the vertices of a loop, by their corners.
pub(super) fn sectors(mesh: &ClosedMesh, vertices: &[Vertex]) -> Option<Vec<(Corner, Sector)>> {
    let mut sectors = Vec::new();
    let n = vertices.len();
    for (k, &vertex) in vertices.iter().enumerate() {
        let [ahead, behind] = [vertices[(k + 1) % n], vertices[(k + n - 1) % n]];
        let (first, _) = mesh.neighbors(vertex).find(|&(_, neighbor)| neighbor == ahead)?;
        sectors.push((first, Sector::Ahead));
        // counter-clockwise from the edge ahead: the left, the edge behind, the right
        let mut sector = Sector::Left;
        let mut corner = mesh.turned(first)?;
        while corner != first {
            let is_behind = corner.next().vertex(&mesh.faces) == behind;
            sectors.push((corner, if is_behind { Sector::Behind } else { sector }));
            if is_behind {
                sector = Sector::Right;
            }
            corner = mesh.turned(corner)?;
        }
    }
    Some(sectors)
}

/// Searches on a surface that is cut open along a loop. Nodes are its vertices, those of the loop as seen from the left;
/// then the vertices of the loop as seen from the right, with numbers after those of all vertices.
pub(super) struct CrossingSearch<'a> {
    mesh: &'a ClosedMesh,
    /// Of each corner at the loop.
    sectors: Vec<Option<Sector>>,
    is_on_loop: Vec<bool>,
    /// The length of the path to each node; infinite where none was found.
    reached: Vec<f64>,
    /// The node before each node that was reached.
    before: Vec<usize>,
    /// The nodes that were reached.
    visited: Vec<usize>,
    /// Whether a path was not followed because of its length.
    is_cut_short: bool,
}

impl<'a> CrossingSearch<'a> {
    pub(super) fn new(mesh: &'a ClosedMesh) -> Self {
        let n = mesh.points.len();
        Self {
            mesh,
            sectors: vec![None; 3 * mesh.faces.len()],
            is_on_loop: vec![false; n],
            reached: vec![f64::INFINITY; 2 * n],
            before: vec![0; 2 * n],
            visited: Vec::new(),
            is_cut_short: false,
        }
    }

    /// The shortest loop no longer than `limit` that crosses a loop once.
    pub(super) fn shortest(&mut self, crossed: &Loop, limit: f64) -> Option<Loop> {
        let sectors = sectors(self.mesh, &crossed.vertices)?;
        sectors.iter().for_each(|&(corner, sector)| self.sectors[corner] = Some(sector));
        crossed.vertices.iter().for_each(|&vertex| self.is_on_loop[vertex] = true);
        let shortest = self.shortest_across(crossed, limit);
        sectors.iter().for_each(|&(corner, _)| self.sectors[corner] = None);
        crossed.vertices.iter().for_each(|&vertex| self.is_on_loop[vertex] = false);
        shortest
    }

    fn shortest_across(&mut self, crossed: &Loop, limit: f64) -> Option<Loop> {
        let mut reach = FIRST_REACH * crossed.length / crossed.vertices.len() as f64;
        loop {
            let mut bound = reach.min(limit);
            let mut shortest = None;
            self.is_cut_short = false;
            for &vertex in &crossed.vertices {
                if let Some(path) = self.path_across(vertex, bound) {
                    let found = Loop::new(self.mesh, path);
                    bound = bound.min(found.length);
                    shortest = Some(found);
                }
            }
            if shortest.is_some() || reach >= limit || !self.is_cut_short {
                return shortest;
            }
            reach *= 2.0;
        }
    }

    /// The shortest path, shorter than `bound`, from a vertex of the loop, seen from the left, to itself seen from the
    /// right; without its last vertex, which is the first again.
    fn path_across(&mut self, start: Vertex, bound: f64) -> Option<Vec<Vertex>> {
        if self.mesh.is_closed_to_loops[start] {
            return None;
        }
        let (from, to) = (start.index(), self.mesh.points.len() + start.index());
        self.reach(from, 0.0, from);
        // the bits of positive numbers are ordered as the numbers are
        let mut queue = BinaryHeap::from([Reverse((0.0_f64.to_bits(), from))]);
        let mut path = None;
        while let Some(Reverse((bits, node))) = queue.pop() {
            let length = f64::from_bits(bits);
            if node == to {
                path = Some(self.path_to(to));
                break;
            }
            if length > self.reached[node] {
                continue;
            }
            let (mesh, vertex) = (self.mesh, self.vertex(node));
            for (corner, neighbor) in mesh.neighbors(vertex) {
                let Some(next) = self.node_beyond(node, corner, neighbor) else { continue };
                let through = length + mesh.length(vertex, neighbor);
                if through >= bound {
                    self.is_cut_short = true;
                } else if through < self.reached[next] {
                    self.reach(next, through, node);
                    queue.push(Reverse((through.to_bits(), next)));
                }
            }
        }
        self.visited.drain(..).for_each(|node| self.reached[node] = f64::INFINITY);
        path
    }

    fn reach(&mut self, node: usize, length: f64, before: usize) {
        if self.reached[node].is_infinite() {
            self.visited.push(node);
        }
        self.reached[node] = length;
        self.before[node] = before;
    }

    fn vertex(&self, node: usize) -> Vertex {
        let n = self.mesh.points.len();
        Vertex::new(if node < n { node } else { node - n })
    }

    /// The node that an edge leads to, which leaves a node at a corner; `None` where no path may run.
    fn node_beyond(&self, node: usize, corner: Corner, neighbor: Vertex) -> Option<usize> {
        if self.mesh.is_closed_to_loops[neighbor] {
            return None;
        }
        let n = self.mesh.points.len();
        let is_right = node >= n;
        if self.sectors[corner] == Some(if is_right { Sector::Left } else { Sector::Right }) {
            return None;
        }
        if !self.is_on_loop[neighbor] {
            return Some(neighbor.index());
        }
        let arrives_right = match self.sectors[self.mesh.reversed(corner)?]? {
            Sector::Left => false,
            Sector::Right => true,
            Sector::Ahead | Sector::Behind => is_right,
        };
        Some(if arrives_right { n + neighbor.index() } else { neighbor.index() })
    }

    fn path_to(&self, end: usize) -> Vec<Vertex> {
        let mut path = Vec::new();
        let mut node = end;
        while self.before[node] != node {
            node = self.before[node];
            path.push(self.vertex(node));
        }
        path
    }
}
