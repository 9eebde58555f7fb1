// SPDX-License-Identifier: MIT OR Apache-2.0
//! The shortest loop that crosses a given loop exactly once; no such loop divides the surface (S. Cabello, B. Mohar,
//! Finding shortest non-separating and non-contractible cycles for topologically embedded graphs, Discrete & Computational
//! Geometry 37, 2007).
//!
//! The surface is cut open along the loop, whose vertices become two, one on either side. The shortest path between the
//! two of one vertex is a loop that crosses there; the shortest over all vertices has no vertex twice. Cost: for each
//! vertex of the loop Dijkstra's algorithm up to the length of the shortest path so far.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap};

use super::closed::ClosedMesh;
use super::loops::Loop;
use crate::mesh::{Corner, Vertex};

/// Where an edge leaves a vertex of the loop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sector {
    Ahead,
    Left,
    Behind,
    Right,
}

/// The edges that leave the vertices of a loop, by their corners.
pub(super) fn sectors(mesh: &ClosedMesh, vertices: &[Vertex]) -> Option<HashMap<Corner, Sector>> {
    let mut sectors = HashMap::new();
    let n = vertices.len();
    for (k, &vertex) in vertices.iter().enumerate() {
        let [ahead, behind] = [vertices[(k + 1) % n], vertices[(k + n - 1) % n]];
        let (first, _) = mesh.neighbors(vertex).find(|&(_, neighbor)| neighbor == ahead)?;
        sectors.insert(first, Sector::Ahead);
        // counter-clockwise from the edge ahead: the left, the edge behind, the right
        let mut sector = Sector::Left;
        let mut corner = mesh.turned(first)?;
        while corner != first {
            let is_behind = corner.next().vertex(&mesh.faces) == behind;
            sectors.insert(corner, if is_behind { Sector::Behind } else { sector });
            if is_behind {
                sector = Sector::Right;
            }
            corner = mesh.turned(corner)?;
        }
    }
    Some(sectors)
}

/// The shortest loop no longer than `limit` that crosses a loop once.
pub(super) fn shortest_crossing(mesh: &ClosedMesh, crossed: &Loop, limit: f64) -> Option<Loop> {
    let mut opened = Opened::new(mesh, &crossed.vertices)?;
    let mut shortest = None;
    let mut bound = limit;
    for place in 0..crossed.vertices.len() {
        if let Some(path) = opened.path_across(place, bound) {
            let found = Loop::new(mesh, path);
            // rounding must not turn the search in a circle
            bound = bound.min(found.length);
            shortest = Some(found);
        }
    }
    shortest
}

/// A surface that is cut open along a loop. Nodes are its vertices, those of the loop as seen from the left; then the
/// vertices of the loop as seen from the right.
struct Opened<'a> {
    mesh: &'a ClosedMesh,
    crossed: &'a [Vertex],
    sectors: HashMap<Corner, Sector>,
    /// The place in the loop of each of its vertices.
    places: HashMap<Vertex, usize>,
    /// The length of the path to each node that was reached, and the node before it.
    reached: HashMap<usize, (f64, usize)>,
}

impl<'a> Opened<'a> {
    fn new(mesh: &'a ClosedMesh, crossed: &'a [Vertex]) -> Option<Self> {
        let sectors = sectors(mesh, crossed)?;
        let places = crossed.iter().enumerate().map(|(place, &vertex)| (vertex, place)).collect();
        Some(Self { mesh, crossed, sectors, places, reached: HashMap::new() })
    }

    /// The shortest path, shorter than `bound`, from a vertex of the loop, seen from the left, to itself seen from the
    /// right; without its last vertex, which is the first again.
    fn path_across(&mut self, place: usize, bound: f64) -> Option<Vec<Vertex>> {
        let start = self.crossed[place];
        if self.mesh.is_closed_to_loops[start] {
            return None;
        }
        let (from, to) = (start.index(), self.mesh.points.len() + place);
        self.reached.clear();
        self.reached.insert(from, (0.0, from));
        // the bits of positive numbers are ordered as the numbers are
        let mut queue = BinaryHeap::from([Reverse((0.0_f64.to_bits(), from))]);
        while let Some(Reverse((bits, node))) = queue.pop() {
            let length = f64::from_bits(bits);
            if node == to {
                return Some(self.path_to(to));
            }
            if length > self.reached[&node].0 {
                continue;
            }
            let vertex = self.vertex(node);
            for (corner, neighbor) in self.mesh.neighbors(vertex) {
                let Some(next) = self.node_beyond(node, corner, neighbor) else { continue };
                let through = length + self.mesh.length(vertex, neighbor);
                if through < bound && self.reached.get(&next).is_none_or(|(known, _)| through < *known) {
                    self.reached.insert(next, (through, node));
                    queue.push(Reverse((through.to_bits(), next)));
                }
            }
        }
        None
    }

    fn vertex(&self, node: usize) -> Vertex {
        let n = self.mesh.points.len();
        if node < n { Vertex::new(node) } else { self.crossed[node - n] }
    }

    /// The node that an edge leads to, which leaves a node at a corner; `None` where no path may run.
    fn node_beyond(&self, node: usize, corner: Corner, neighbor: Vertex) -> Option<usize> {
        if self.mesh.is_closed_to_loops[neighbor] {
            return None;
        }
        let n = self.mesh.points.len();
        let is_right = node >= n;
        let leaves = self.sectors.get(&corner);
        if leaves == Some(if is_right { &Sector::Left } else { &Sector::Right }) {
            return None;
        }
        let Some(&place) = self.places.get(&neighbor) else { return Some(neighbor.index()) };
        let arrives_right = match self.sectors.get(&self.mesh.reversed(corner)?)? {
            Sector::Left => false,
            Sector::Right => true,
            Sector::Ahead | Sector::Behind => is_right,
        };
        Some(if arrives_right { n + place } else { neighbor.index() })
    }

    fn path_to(&self, end: usize) -> Vec<Vertex> {
        let mut path = Vec::new();
        let mut node = end;
        loop {
            let before = self.reached[&node].1;
            if before == node {
                return path;
            }
            path.push(self.vertex(before));
            node = before;
        }
    }
}
