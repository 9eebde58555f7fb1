// SPDX-License-Identifier: MIT OR Apache-2.0
//! The combinatorics of triangles: corners, edges, boundary loops, Euler characteristic and genus.
//!
//! Corner `3 * face + k` stands for vertex `k` of a face and for the edge opposite to it, which runs from
//! vertex `k + 1` to vertex `k + 2`. Two corners are opposite if their edges are equal. Edges are matched by
//! sorting, never by hashing, so that the order of results never changes from run to run.

use super::corners::EdgeTable;
use super::orientation::Orientation;
use super::ties::largest_first;
use super::{Corner, Face, Vertex, geometry};
use crate::vector::Vector3;

/// The topology of a surface.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Topology {
    /// Vertices − edges + faces.
    pub euler_characteristic: i64,
    /// The number of handles, summed over the components; `None` if a component is not orientable.
    pub genus: Option<usize>,
    /// Whether the faces can be oriented consistently.
    pub orientable: bool,
    /// The boundary loops as vertex lists, the surface on the left of travel. Each starts at its smallest
    /// vertex; the longest (by length in space) comes first, of equals but for rounding that with the smallest vertex.
    pub boundary_loops: Vec<Vec<Vertex>>,
    /// The lowest face of each component.
    pub first_faces: Vec<Face>,
}

impl Topology {
    /// The number of components.
    pub fn n_components(&self) -> usize {
        self.first_faces.len()
    }

    /// Whether the surface is a topological disk: one component, one boundary loop, no handle.
    pub fn is_disk(&self) -> bool {
        self.n_components() == 1 && self.boundary_loops.len() == 1 && self.euler_characteristic == 1
    }

    /// Whether the surface has no boundary.
    pub fn is_closed(&self) -> bool {
        self.boundary_loops.is_empty()
    }

    /// Orients faces without non-manifold edges and vertices and describes their surface.
    ///
    /// Every vertex must be used and no coordinate may overflow when squared.
    pub(crate) fn of_faces(points: &[Vector3], faces: &[[Vertex; 3]]) -> Self {
        let mut opposite = EdgeTable::new(points.len(), faces).opposites();
        let mut oriented = faces.to_vec();
        let orientation = Orientation::propagate(faces, &opposite);
        orientation.apply(&mut oriented, &mut opposite);
        Self::of_oriented(points, &oriented, &opposite, orientation)
    }

    /// Describes the surface of faces to which `orientation` has been applied.
    pub(crate) fn of_oriented(
        points: &[Vector3],
        faces: &[[Vertex; 3]],
        opposite: &[Option<Corner>],
        orientation: Orientation,
    ) -> Self {
        let boundary: Vec<[Vertex; 2]> = Corner::all(faces.len())
            .filter(|&corner| opposite[corner].is_none())
            .map(|corner| corner.half_edge(faces))
            .collect();
        let n_edges = (opposite.len() + boundary.len()) / 2;
        let euler_characteristic = points.len() as i64 - n_edges as i64 + faces.len() as i64;
        let boundary_loops = by_length(points, trace_loops(points.len(), &boundary));
        let orientable = orientation.conflict.is_none();
        // Each component has 2 - 2 genus - loops for its Euler characteristic.
        let components = orientation.first_faces.len() as i64;
        let double_genus = 2 * components - euler_characteristic - boundary_loops.len() as i64;
        Self {
            euler_characteristic,
            genus: orientable.then_some(double_genus.max(0) as usize / 2),
            orientable,
            boundary_loops,
            first_faces: orientation.first_faces,
        }
    }
}

/// Links boundary edges into loops, ordered by smallest vertex, each starting with it.
///
/// At most two edges may meet in a vertex. The loops run along the edges; on a surface that cannot be
/// oriented the edge that leaves the first vertex decides.
fn trace_loops(n_vertices: usize, edges: &[[Vertex; 2]]) -> Vec<Vec<Vertex>> {
    const NONE: Vertex = Vertex(u32::MAX);
    if edges.is_empty() {
        return Vec::new();
    }
    // the next and the previous vertex of each; two edges out of a vertex fill both places
    let mut links = vec![[NONE; 2]; n_vertices];
    for &[from, to] in edges {
        for (vertex, place, neighbor) in [(from, 0, to), (to, 1, from)] {
            let slots = &mut links[vertex];
            slots[if slots[place] == NONE { place } else { 1 - place }] = neighbor;
        }
    }
    let mut visited = vec![false; n_vertices];
    let mut loops = Vec::new();
    for start in Vertex::all(n_vertices) {
        if links[start][0] != NONE && !visited[start] {
            loops.push(trace_loop(start, &links, &mut visited));
        }
    }
    loops
}

/// Follows the links from one vertex until they come back.
fn trace_loop(start: Vertex, links: &[[Vertex; 2]], visited: &mut [bool]) -> Vec<Vertex> {
    let mut vertices = Vec::new();
    let (mut previous, mut vertex) = (links[start][1], start);
    while !visited[vertex] {
        visited[vertex] = true;
        vertices.push(vertex);
        let [ahead, behind] = links[vertex];
        (previous, vertex) = (vertex, if ahead == previous { behind } else { ahead });
    }
    vertices
}

/// Puts the longest loop first and keeps the order of those that are equally long but for rounding.
fn by_length(points: &[Vector3], mut loops: Vec<Vec<Vertex>>) -> Vec<Vec<Vertex>> {
    let lengths: Vec<f64> = loops.iter().map(|vertices| geometry::loop_length(points, vertices)).collect();
    largest_first(&lengths).into_iter().map(|k| std::mem::take(&mut loops[k])).collect()
}
