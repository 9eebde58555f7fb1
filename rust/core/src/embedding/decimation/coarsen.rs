// SPDX-License-Identifier: MIT OR Apache-2.0
//! The order of the collapses: the cheapest vertex next, by the measure of its star, its degree and the
//! shapes and degrees that it leaves.
//!
//! A queue holds all vertices by their last known costs. Most costs only rise, so the cost of a vertex is
//! computed again when it comes to the front; the vertex goes back if the cost has risen. Of costs that are equal but for
//! noise, as on symmetric surfaces, the lowest vertex comes first.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::Decimation;
use crate::control::Observer;
use crate::mesh::ties::{DistinctKeys, are_equal};
use crate::mesh::{Corner, Vertex};
use crate::parallel;
use crate::vector::Vector3;

/// Vertices between two questions to the observer.
pub(super) const BEAT: usize = 1024;

/// Vertices between two questions to the observer at the beginning, on all threads.
const ROUND: usize = 16_384;

/// Factor of the cost of a boundary vertex: behind a coarse boundary there is room for too few vertices.
const BOUNDARY: f64 = 12.0;

/// The shapes around a vertex of higher degree are not computed before it comes to the front of the queue, when its
/// degree is lower.
const MANY_NEIGHBORS: usize = 32;

/// A vertex in the queue, ordered by cost, then by index.
#[derive(PartialEq)]
struct Candidate {
    cost: f64,
    vertex: Vertex,
}

impl Eq for Candidate {}

impl Ord for Candidate {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.cost.total_cmp(&other.cost).then(self.vertex.cmp(&other.vertex))
    }
}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

/// The neighbors of a vertex, counter-clockwise, and the measure of its star.
#[derive(Default)]
struct Ring {
    /// The corners at the vertex whose next corners are the neighbors.
    corners: Vec<Corner>,
    vertices: Vec<Vertex>,
    points: Vec<Vector3>,
    measure: f64,
    /// The position of the apex in the ring.
    apex: Option<usize>,
}

impl Ring {
    /// The cost of the vertex without the shapes that it leaves.
    fn weight(&self) -> f64 {
        let degree = 1.0 + 0.15 * (self.vertices.len() as f64 - 6.0).max(0.0).powi(2);
        let boundary = if self.apex.is_some() { BOUNDARY } else { 1.0 };
        self.measure * degree * boundary
    }

    /// True if a collapse onto the neighbor keeps the boundary loop.
    fn keeps_the_boundary(&self, neighbor: usize) -> bool {
        let n = self.vertices.len();
        self.apex.is_none_or(|apex| (apex + 1) % n == neighbor || (neighbor + 1) % n == apex)
    }

    /// The cost factor of the shapes and the degree after a collapse onto a neighbor of `degree`; 1/1.05 or more.
    fn shape(&self, neighbor: usize, degree: usize) -> f64 {
        let degree = (degree + self.vertices.len()) as f64 - 4.0;
        (1.0 + 0.05 * (degree - 7.0).max(0.0).powi(2)) / (self.worst_shape(neighbor) + 0.05)
    }

    /// 4√3·area/Σ edge² of the worst face that a collapse onto a neighbor makes; 1 is equilateral.
    fn worst_shape(&self, neighbor: usize) -> f64 {
        let n = self.vertices.len();
        let onto = self.points[neighbor];
        let mut worst = 1.0;
        for k in neighbor + 1..neighbor + n - 1 {
            let [next, after] = [k, k + 1].map(|k| if k < n { k } else { k - n });
            if self.apex.is_some_and(|apex| apex == next || apex == after) {
                continue;
            }
            let (edge, spoke) = (self.points[after] - self.points[next], self.points[next] - onto);
            let next_spoke = self.points[after] - onto;
            let squares = edge.dot(edge) + spoke.dot(spoke) + next_spoke.dot(next_spoke);
            let normal = spoke.cross(edge);
            let shape = if squares > 0.0 { normal.dot(normal) / (squares * squares) } else { 0.0 };
            worst = f64::min(worst, 12.0 * shape);
        }
        worst.sqrt()
    }
}

impl Decimation<'_> {
    /// Collapses vertices until four are left, including the apex, or until none can collapse; `None` where the
    /// observer ended the run.
    pub(crate) fn coarsen(&mut self, observer: &mut dyn Observer) -> Option<()> {
        self.coarsen_to(4, |_| false, observer)
    }

    /// Collapses vertices until so many are left, including the apex, or until none can collapse; those that stay never
    /// do. `None` where the observer ended the run.
    pub(crate) fn coarsen_to(
        &mut self,
        n_left: usize,
        stays: impl Fn(Vertex) -> bool,
        observer: &mut dyn Observer,
    ) -> Option<()> {
        let surplus = self.degrees.len().saturating_sub(n_left.max(4));
        let mut distinct = DistinctKeys::default();
        let mut queue = self.candidates(&stays, &mut distinct, observer)?;
        let mut waiting = vec![false; self.degrees.len()];
        let mut ring = Ring::default();
        while self.collapses.len() < surplus {
            let Some(Reverse(Candidate { cost, vertex })) = queue.pop() else { break };
            // 1. Compute the cost again; the vertex goes back if it has risen, while a fallen cost is good enough
            let (now, corner) = self.best_collapse(vertex, &mut ring);
            let now = distinct.one_of_equal_values(now);
            let Some(corner) = corner else {
                waiting[vertex] = true;
                continue;
            };
            if now > cost {
                queue.push(Reverse(Candidate { cost: now, vertex }));
                continue;
            }
            // 2. Collapse the vertex; neighbors that could not collapse go back into the queue
            self.collapse(corner);
            for &vertex in &ring.vertices {
                if std::mem::take(&mut waiting[vertex]) {
                    queue.push(Reverse(Candidate { cost: 0.0, vertex }));
                }
            }
            let fraction = self.collapses.len() as f64 / surplus as f64;
            if self.collapses.len().is_multiple_of(BEAT) && !observer.progress(fraction, "Coarsening") {
                return None;
            }
        }
        Some(())
    }

    /// All vertices with their costs; `None` where the observer ended the run.
    fn candidates(
        &self,
        stays: &impl Fn(Vertex) -> bool,
        distinct: &mut DistinctKeys,
        observer: &mut dyn Observer,
    ) -> Option<BinaryHeap<Reverse<Candidate>>> {
        let n = self.mesh.n_vertices();
        let mut candidates = Vec::with_capacity(n);
        for first in (0..n).step_by(ROUND) {
            let costs = parallel::map(ROUND.min(n - first), |k| self.first_cost(Vertex::new(first + k)));
            let with_cost = |(k, cost)| {
                let cost = distinct.one_of_equal_values(cost);
                Reverse(Candidate { cost, vertex: Vertex::new(first + k) })
            };
            let moves = |(k, _): &(usize, f64)| !stays(Vertex::new(first + k));
            candidates.extend(costs.into_iter().enumerate().filter(moves).map(with_cost));
            if !observer.progress(0.0, "Coarsening") {
                return None;
            }
        }
        Some(BinaryHeap::from(candidates))
    }

    /// A lower bound of the cost of a vertex.
    fn first_cost(&self, vertex: Vertex) -> f64 {
        let mut ring = Ring::default();
        if self.degree(vertex) > MANY_NEIGHBORS {
            self.fill_ring(vertex, &mut ring);
            return self.tie_breakers[vertex] * ring.weight() / 1.05f64.sqrt();
        }
        let cost = self.best_collapse(vertex, &mut ring).0;
        // vertices that cannot collapse come to the front first
        if cost.is_finite() { cost } else { 0.0 }
    }

    /// The cost of a vertex, infinite where it cannot collapse, and the corner at it that is followed by the neighbor
    /// onto which it collapses.
    fn best_collapse(&self, vertex: Vertex, ring: &mut Ring) -> (f64, Option<Corner>) {
        self.fill_ring(vertex, ring);
        let allowed = |&k: &usize| ring.apex != Some(k) && ring.keeps_the_boundary(k);
        let mut rated: Vec<(f64, Vertex, Corner)> = (0..ring.vertices.len())
            .filter(allowed)
            .map(|k| {
                let neighbor = ring.vertices[k];
                let shape = self.tie_breakers[neighbor] * ring.shape(k, self.degree(neighbor));
                (shape, neighbor, ring.corners[k])
            })
            .collect();
        // of ratings that are equal but for noise that of the lowest vertex
        let is_better = |a: &(f64, Vertex, Corner), b: &(f64, Vertex, Corner)| {
            if are_equal(a.0, b.0) { a.1 < b.1 } else { a.0 < b.0 }
        };
        // the link condition is the most expensive, so test the best neighbor first, then the second best
        while let Some(&best) =
            rated.iter().reduce(|best, next| if is_better(next, best) { next } else { best })
        {
            if self.keeps_the_sphere(ring, best.1) {
                let cost = self.tie_breakers[vertex] * ring.weight() * best.0.sqrt();
                return (cost, Some(best.2));
            }
            rated.retain(|candidate| candidate.1 != best.1);
        }
        (f64::INFINITY, None)
    }

    fn fill_ring(&self, vertex: Vertex, ring: &mut Ring) {
        ring.corners.clear();
        ring.vertices.clear();
        ring.points.clear();
        (ring.measure, ring.apex) = (0.0, None);
        for corner in self.around(self.corners[vertex]) {
            let neighbor = self.vertex(corner.next());
            if neighbor == self.apex() {
                ring.apex = Some(ring.vertices.len());
            }
            ring.measure += self.faces[corner.face()].target;
            ring.corners.push(corner);
            ring.vertices.push(neighbor);
            ring.points.push(self.mesh.points().get(neighbor.index()).copied().unwrap_or_default());
        }
    }

    /// The link condition: exactly two common neighbors.
    fn keeps_the_sphere(&self, ring: &Ring, onto: Vertex) -> bool {
        let around = self.around(self.corners[onto]);
        around.filter(|&corner| ring.vertices.contains(&self.vertex(corner.next()))).count() == 2
    }
}
