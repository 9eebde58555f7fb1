// SPDX-License-Identifier: MIT OR Apache-2.0
//! Corners and half-edges of faces: their opposites across edges, and the corners around a vertex.
//!
//! Corner `3 * face + k` is vertex `k` of a face; it also stands for the edge opposite to that vertex.

use std::ops::Range;

use super::Vertex;

/// The entry of a boundary edge in a table of opposite corners.
pub(crate) const NO_CORNER: u32 = u32::MAX;

/// The next corner of the same face.
pub(crate) fn next_corner(corner: u32) -> u32 {
    if corner % 3 == 2 { corner - 2 } else { corner + 1 }
}

/// The previous corner of the same face.
pub(crate) fn previous_corner(corner: u32) -> u32 {
    if corner.is_multiple_of(3) { corner + 2 } else { corner - 1 }
}

/// The vertex at a corner.
pub(crate) fn vertex_at(faces: &[[Vertex; 3]], corner: u32) -> Vertex {
    faces[corner as usize / 3][corner as usize % 3]
}

/// The directed edge opposite to a corner.
pub(crate) fn half_edge(faces: &[[Vertex; 3]], corner: u32) -> [Vertex; 2] {
    [vertex_at(faces, next_corner(corner)), vertex_at(faces, previous_corner(corner))]
}

/// Every edge with the corners opposite to it.
pub(crate) struct EdgeTable {
    /// The start of each lower vertex's edges in `entries`.
    start: Vec<u32>,
    /// Higher vertex (upper half) and corner (lower half), sorted for each lower vertex.
    entries: Vec<u64>,
}

impl EdgeTable {
    /// Sorts the edges of all faces: by buckets of the lower vertex, then within each.
    pub(crate) fn new(n_vertices: usize, faces: &[[Vertex; 3]]) -> Self {
        let edges = || (0..3 * faces.len() as u32).map(|corner| (corner, sorted(half_edge(faces, corner))));
        let mut start = vec![0u32; n_vertices + 1];
        for (_, [low, _]) in edges() {
            start[low.index() + 1] += 1;
        }
        for v in 0..n_vertices {
            start[v + 1] += start[v];
        }
        let mut free = start.clone();
        let mut entries = vec![0u64; 3 * faces.len()];
        for (corner, [low, high]) in edges() {
            entries[free[low] as usize] = u64::from(high.0) << 32 | u64::from(corner);
            free[low] += 1;
        }
        for v in 0..n_vertices {
            entries[start[v] as usize..start[v + 1] as usize].sort_unstable();
        }
        Self { start, entries }
    }

    /// Every edge with its entries, in ascending order; [`corner_of_entry`] reads an entry.
    pub(crate) fn edges(&self) -> impl Iterator<Item = ([Vertex; 2], &[u64])> {
        Vertex::all(self.start.len() - 1).flat_map(move |low| {
            let same_edge = |a: &u64, b: &u64| a >> 32 == b >> 32;
            self.bucket(low)
                .chunk_by(same_edge)
                .map(move |entries| ([low, Vertex((entries[0] >> 32) as u32)], entries))
        })
    }

    /// The corners opposite to an edge; none if there is no such edge.
    pub(crate) fn corners(&self, edge: [Vertex; 2]) -> impl Iterator<Item = u32> {
        let [low, high] = sorted(edge);
        let bucket = self.bucket(low);
        let begin = bucket.partition_point(|entry| entry >> 32 < u64::from(high.0));
        bucket[begin..].iter().take_while(move |&entry| entry >> 32 == u64::from(high.0)).map(corner_of_entry)
    }

    /// The opposite corner of every corner: [`NO_CORNER`] unless exactly two faces share the edge.
    pub(crate) fn opposites(&self) -> Vec<u32> {
        let mut opposite = vec![NO_CORNER; self.entries.len()];
        for (_, entries) in self.edges() {
            if let [a, b] = entries {
                let [a, b] = [corner_of_entry(a), corner_of_entry(b)];
                // a face that repeats a vertex meets itself; it is no neighbor of its own
                if a / 3 != b / 3 {
                    opposite[a as usize] = b;
                    opposite[b as usize] = a;
                }
            }
        }
        opposite
    }

    fn bucket(&self, low: Vertex) -> &[u64] {
        &self.entries[self.start[low] as usize..self.start[low.index() + 1] as usize]
    }
}

/// The corner in an entry of an [`EdgeTable`].
pub(crate) fn corner_of_entry(entry: &u64) -> u32 {
    *entry as u32
}

/// An edge with its lower vertex first.
fn sorted([a, b]: [Vertex; 2]) -> [Vertex; 2] {
    [a.min(b), a.max(b)]
}

/// The corners at every vertex, in ascending order.
#[derive(Debug, Clone)]
pub(crate) struct VertexCorners {
    start: Vec<u32>,
    corners: Vec<u32>,
}

impl VertexCorners {
    /// Sorts the corners of all faces by vertex.
    pub(crate) fn new(n_vertices: usize, faces: &[[Vertex; 3]]) -> Self {
        let mut start = vec![0u32; n_vertices + 1];
        for &v in faces.as_flattened() {
            start[v.index() + 1] += 1;
        }
        for v in 0..n_vertices {
            start[v + 1] += start[v];
        }
        let mut free = start.clone();
        let mut corners = vec![0u32; 3 * faces.len()];
        for (corner, &v) in faces.as_flattened().iter().enumerate() {
            corners[free[v] as usize] = corner as u32;
            free[v] += 1;
        }
        Self { start, corners }
    }

    /// The number of vertices.
    pub(crate) fn len(&self) -> usize {
        self.start.len() - 1
    }

    /// The corners at a vertex.
    pub(crate) fn of(&self, vertex: Vertex) -> &[u32] {
        &self.corners[self.range(vertex)]
    }

    /// The positions in [`Self::all`] of the corners at a vertex.
    pub(crate) fn range(&self, vertex: Vertex) -> Range<usize> {
        self.start[vertex] as usize..self.start[vertex.index() + 1] as usize
    }

    /// The corners at all vertices, in the order of the vertices.
    pub(crate) fn all(&self) -> &[u32] {
        &self.corners
    }

    /// Whether the corners at a vertex form one fan, for consistently oriented faces.
    pub(crate) fn is_one_fan(&self, vertex: Vertex, opposite: &[u32]) -> bool {
        let corners = self.of(vertex);
        let Some(&first) = corners.first() else {
            return true;
        };
        let (mut count, closed) = fan(first, opposite, next_corner);
        if !closed {
            count += fan(first, opposite, previous_corner).0 - 1;
        }
        count == corners.len()
    }
}

/// Turns about the vertex of a corner; returns the number of corners met, and whether they close a circle.
fn fan(first: u32, opposite: &[u32], turn: fn(u32) -> u32) -> (usize, bool) {
    let mut corner = first;
    let mut count = 1;
    loop {
        let across = opposite[turn(corner) as usize];
        if across == NO_CORNER {
            return (count, false);
        }
        corner = turn(across);
        if corner == first {
            return (count, true);
        }
        count += 1;
    }
}
