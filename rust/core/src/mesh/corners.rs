// SPDX-License-Identifier: MIT OR Apache-2.0
//! The corners opposite to each other across edges, and the corners around a vertex.

use std::ops::Range;

use super::{Corner, Vertex};

/// Items at every vertex.
#[derive(Debug, Clone)]
struct ByVertex<T> {
    /// The start of each vertex's items, then the end of the last ones.
    start: Vec<u32>,
    items: Vec<T>,
}

impl<T: Copy + Default> ByVertex<T> {
    /// Sorts items by vertex, in a given order at each vertex.
    fn new(n_vertices: usize, items: impl ExactSizeIterator<Item = (Vertex, T)> + Clone) -> Self {
        let mut start = vec![0u32; n_vertices + 1];
        items.clone().for_each(|(vertex, _)| start[vertex.index() + 1] += 1);
        for v in 0..n_vertices {
            start[v + 1] += start[v];
        }
        let mut free = start.clone();
        let mut sorted = vec![T::default(); items.len()];
        for (vertex, item) in items {
            sorted[free[vertex] as usize] = item;
            free[vertex] += 1;
        }
        Self { start, items: sorted }
    }

    fn n_vertices(&self) -> usize {
        self.start.len() - 1
    }

    fn range(&self, vertex: Vertex) -> Range<usize> {
        self.start[vertex] as usize..self.start[vertex.index() + 1] as usize
    }

    fn of(&self, vertex: Vertex) -> &[T] {
        &self.items[self.range(vertex)]
    }
}

/// Every edge with the corners opposite to it.
pub(crate) struct EdgeTable {
    /// At the lower vertex of each edge, ascending.
    entries: ByVertex<EdgeCorner>,
}

/// A corner with the higher vertex of the edge opposite to it; ordered by that vertex, then by the corner.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub(crate) struct EdgeCorner(
    /// The vertex in the upper half, the corner in the lower: one comparison orders both.
    u64,
);

impl EdgeCorner {
    fn new(high: Vertex, corner: Corner) -> Self {
        Self(u64::from(high.0) << 32 | corner.index() as u64)
    }

    fn high(self) -> Vertex {
        Vertex((self.0 >> 32) as u32)
    }

    /// The corner.
    pub(crate) fn corner(self) -> Corner {
        Corner::new(self.0 as u32 as usize)
    }
}

impl EdgeTable {
    /// Sorts the edges of all faces: by buckets of the lower vertex, then within each.
    pub(crate) fn new(n_vertices: usize, faces: &[[Vertex; 3]]) -> Self {
        let entry = |corner: Corner| {
            let [low, high] = sorted(corner.half_edge(faces));
            (low, EdgeCorner::new(high, corner))
        };
        let mut entries = ByVertex::new(n_vertices, Corner::all(faces.len()).map(entry));
        for low in Vertex::all(n_vertices) {
            let bucket = entries.range(low);
            entries.items[bucket].sort_unstable();
        }
        Self { entries }
    }

    /// Every edge with the corners opposite to it, in ascending order.
    pub(crate) fn edges(&self) -> impl Iterator<Item = ([Vertex; 2], &[EdgeCorner])> {
        Vertex::all(self.entries.n_vertices()).flat_map(move |low| {
            let same_edge = |a: &EdgeCorner, b: &EdgeCorner| a.high() == b.high();
            self.entries.of(low).chunk_by(same_edge).map(move |entries| ([low, entries[0].high()], entries))
        })
    }

    /// The corners opposite to an edge; none if there is no such edge.
    pub(crate) fn corners(&self, edge: [Vertex; 2]) -> impl Iterator<Item = Corner> {
        let [low, high] = sorted(edge);
        let bucket = self.entries.of(low);
        let begin = bucket.partition_point(|entry| entry.high() < high);
        bucket[begin..].iter().take_while(move |entry| entry.high() == high).map(|entry| entry.corner())
    }

    /// The opposite corner of every corner: `None` unless exactly two faces share the edge.
    pub(crate) fn opposites(&self) -> Vec<Option<Corner>> {
        let mut opposite = vec![None; self.entries.items.len()];
        for (_, entries) in self.edges() {
            if let [a, b] = entries {
                let [a, b] = [a.corner(), b.corner()];
                // a face that repeats a vertex meets itself; it is no neighbor of its own
                if a.face() != b.face() {
                    opposite[a] = Some(b);
                    opposite[b] = Some(a);
                }
            }
        }
        opposite
    }
}

/// An edge with its lower vertex first.
fn sorted([a, b]: [Vertex; 2]) -> [Vertex; 2] {
    [a.min(b), a.max(b)]
}

/// The corners at every vertex, in ascending order.
#[derive(Debug, Clone)]
pub(crate) struct VertexCorners(ByVertex<Corner>);

impl VertexCorners {
    /// Sorts the corners of all faces by vertex.
    pub(crate) fn new(n_vertices: usize, faces: &[[Vertex; 3]]) -> Self {
        let vertices = faces.as_flattened().iter().copied();
        Self(ByVertex::new(n_vertices, vertices.zip(Corner::all(faces.len()))))
    }

    /// The number of vertices.
    pub(crate) fn len(&self) -> usize {
        self.0.n_vertices()
    }

    /// The corners at a vertex.
    pub(crate) fn of(&self, vertex: Vertex) -> &[Corner] {
        self.0.of(vertex)
    }

    /// The positions in [`Self::all`] of the corners at a vertex.
    pub(crate) fn range(&self, vertex: Vertex) -> Range<usize> {
        self.0.range(vertex)
    }

    /// The corners at all vertices, in the order of the vertices.
    pub(crate) fn all(&self) -> &[Corner] {
        &self.0.items
    }

    /// Whether the corners at a vertex form one fan, for consistently oriented faces.
    pub(crate) fn is_one_fan(&self, vertex: Vertex, opposite: &[Option<Corner>]) -> bool {
        let corners = self.of(vertex);
        let Some(&first) = corners.first() else {
            return true;
        };
        let (mut count, closed) = fan(first, opposite, Corner::next);
        if !closed {
            count += fan(first, opposite, Corner::previous).0 - 1;
        }
        count == corners.len()
    }
}

/// Turns about the vertex of a corner; returns the number of corners met, and whether they close a circle.
fn fan(first: Corner, opposite: &[Option<Corner>], turn: fn(Corner) -> Corner) -> (usize, bool) {
    let mut corner = first;
    let mut count = 1;
    while let Some(across) = opposite[turn(corner)] {
        corner = turn(across);
        if corner == first {
            return (count, true);
        }
        count += 1;
    }
    (count, false)
}
