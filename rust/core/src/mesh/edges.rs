// SPDX-License-Identifier: MIT OR Apache-2.0
//! The edges of a mesh, numbered.
//!
//! Edges ascend by their lower vertex, then by the other one. Cost: linear in the mesh, up to a sort of the edges at
//! each vertex.

use super::corners::EdgeTable;
use super::{Corner, Edge, TriangleMesh, Vertex};

/// The edges of a manifold mesh, each with its vertices and the corners opposite to it.
#[derive(Debug, Clone)]
pub(crate) struct Edges {
    ends: Vec<[Vertex; 2]>,
    sides: Vec<(Corner, Option<Corner>)>,
    of_corner: Vec<Edge>,
    /// The first place of each vertex in `neighbors`, then the end of the last.
    starts: Vec<u32>,
    neighbors: Vec<(Vertex, Edge)>,
}

impl Edges {
    /// Numbers the edges of a mesh.
    pub(crate) fn new(mesh: &TriangleMesh) -> Self {
        let table = EdgeTable::new(mesh.n_vertices(), mesh.faces());
        let mut ends = Vec::with_capacity(3 * mesh.n_faces() / 2 + 2);
        let mut sides = Vec::with_capacity(ends.capacity());
        let mut of_corner = vec![Edge(0); 3 * mesh.n_faces()];
        for (edge, corners) in table.edges() {
            let mut corners = corners.iter().map(|entry| entry.corner());
            let side = (corners.next().unwrap_or_default(), corners.next());
            of_corner[side.0] = Edge::new(ends.len());
            if let Some(second) = side.1 {
                of_corner[second] = Edge::new(ends.len());
            }
            ends.push(edge);
            sides.push(side);
        }
        let (starts, neighbors) = neighbors(mesh.n_vertices(), &ends);
        Self { ends, sides, of_corner, starts, neighbors }
    }

    /// The number of edges.
    pub(crate) fn len(&self) -> usize {
        self.ends.len()
    }

    /// All edges, in order.
    pub(crate) fn all(&self) -> impl DoubleEndedIterator<Item = Edge> + ExactSizeIterator + Clone + use<> {
        Edge::all(self.len())
    }

    /// The vertices of an edge, the lower one first.
    pub(crate) fn ends(&self, edge: Edge) -> [Vertex; 2] {
        self.ends[edge]
    }

    /// The corners opposite to an edge; the second is `None` on the boundary.
    pub(crate) fn sides(&self, edge: Edge) -> (Corner, Option<Corner>) {
        self.sides[edge]
    }

    /// Whether an edge lies on the boundary.
    pub(crate) fn is_boundary(&self, edge: Edge) -> bool {
        self.sides[edge].1.is_none()
    }

    /// The edge opposite to a corner.
    pub(crate) fn opposite_to(&self, corner: Corner) -> Edge {
        self.of_corner[corner]
    }

    /// The neighbors of a vertex, ascending, each with the edge between.
    pub(crate) fn around(&self, vertex: Vertex) -> &[(Vertex, Edge)] {
        let first = self.starts[vertex] as usize;
        &self.neighbors[first..self.starts[vertex.index() + 1] as usize]
    }

    /// The edge between two vertices, if there is one.
    pub(crate) fn between(&self, a: Vertex, b: Vertex) -> Option<Edge> {
        let around = self.around(a);
        around.binary_search_by_key(&b, |&(vertex, _)| vertex).ok().map(|place| around[place].1)
    }

    /// The end of an edge that is not `vertex`.
    pub(crate) fn other_end(&self, edge: Edge, vertex: Vertex) -> Vertex {
        let [low, high] = self.ends[edge];
        if low == vertex { high } else { low }
    }
}

/// The neighbors of all vertices one after another, ascending at each, with the first place of each vertex.
fn neighbors(n_vertices: usize, ends: &[[Vertex; 2]]) -> (Vec<u32>, Vec<(Vertex, Edge)>) {
    let mut starts = vec![0u32; n_vertices + 1];
    ends.as_flattened().iter().for_each(|vertex| starts[vertex.index() + 1] += 1);
    for vertex in 0..n_vertices {
        starts[vertex + 1] += starts[vertex];
    }
    let mut free = starts.clone();
    let mut neighbors = vec![(Vertex(0), Edge(0)); 2 * ends.len()];
    for (edge, &[low, high]) in ends.iter().enumerate() {
        for (vertex, neighbor) in [(low, high), (high, low)] {
            neighbors[free[vertex] as usize] = (neighbor, Edge::new(edge));
            free[vertex] += 1;
        }
    }
    for vertex in 0..n_vertices {
        neighbors[starts[vertex] as usize..starts[vertex + 1] as usize].sort_unstable();
    }
    (starts, neighbors)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_edge_is_numbered_once_and_found_from_its_ends_and_corners() {
        let vertices = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let mesh = TriangleMesh::new(&vertices, &[[0, 1, 2], [0, 2, 3]]).unwrap();
        let edges = Edges::new(&mesh);
        assert_eq!(edges.len(), 5);
        for edge in edges.all() {
            let [low, high] = edges.ends(edge);
            assert!(low < high);
            assert_eq!(edges.between(low, high), Some(edge));
            assert_eq!(edges.between(high, low), Some(edge));
            assert_eq!(edges.other_end(edge, high), low);
            let (first, second) = edges.sides(edge);
            for corner in [Some(first), second].into_iter().flatten() {
                let mut ends = corner.half_edge(mesh.faces());
                ends.sort_unstable();
                assert_eq!((ends, edges.opposite_to(corner)), ([low, high], edge));
            }
            assert_eq!(edges.is_boundary(edge), [low, high] != [Vertex(0), Vertex(2)]);
        }
        assert_eq!(edges.between(Vertex(1), Vertex(3)), None);
        let neighbors: Vec<_> = edges.around(Vertex(0)).iter().map(|&(vertex, _)| vertex.0).collect();
        assert_eq!(neighbors, [1, 2, 3]);
    }
}
