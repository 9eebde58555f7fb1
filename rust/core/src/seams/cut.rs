// SPDX-License-Identifier: MIT OR Apache-2.0
//! A set of seams on a mesh: its islands, their topology, and its segments.
//!
//! Cost: linear in the mesh.

use super::edge_mesh::EdgeMesh;
use crate::mesh::{Corner, Edge, Face, Vertex};

/// Seams on the edges of a mesh. The boundary is no seam.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Cut {
    is_seam: Vec<bool>,
}

/// The parts of a surface between seams and boundary.
#[derive(Debug, Clone)]
pub(super) struct Islands {
    /// The island of each face, (m,), numbered by their lowest faces.
    pub of_face: Vec<u32>,
    /// The area of each.
    pub areas: Vec<f64>,
    /// Vertices − edges + faces of each after cutting.
    pub euler_characteristics: Vec<i64>,
}

/// A chain of seams between two nodes, or a closed one.
#[derive(Debug, Clone)]
pub(super) struct Segment {
    /// The vertices, one more than edges; the first and the last agree where the segment is closed.
    pub vertices: Vec<Vertex>,
    pub edges: Vec<Edge>,
}

impl Cut {
    /// No seams.
    pub(super) fn none(mesh: &EdgeMesh) -> Self {
        Self { is_seam: vec![false; mesh.n_edges()] }
    }

    pub(super) fn is_seam(&self, edge: Edge) -> bool {
        self.is_seam[edge]
    }

    pub(super) fn is_empty(&self) -> bool {
        !self.is_seam.contains(&true)
    }

    /// The seams, ascending.
    pub(super) fn seams(&self) -> impl Iterator<Item = Edge> + '_ {
        Edge::all(self.is_seam.len()).filter(|&edge| self.is_seam[edge])
    }

    pub(super) fn add(&mut self, edges: &[Edge]) {
        edges.iter().for_each(|&edge| self.is_seam[edge] = true);
    }

    pub(super) fn remove(&mut self, edges: &[Edge]) {
        edges.iter().for_each(|&edge| self.is_seam[edge] = false);
    }

    /// The cut with more seams.
    pub(super) fn with(&self, edges: &[Edge]) -> Self {
        let mut cut = self.clone();
        cut.add(edges);
        cut
    }

    /// The cut with fewer seams.
    pub(super) fn without(&self, edges: &[Edge]) -> Self {
        let mut cut = self.clone();
        cut.remove(edges);
        cut
    }

    /// Whether an edge bounds an island: a seam, or an edge of the boundary.
    pub(super) fn is_border(&self, mesh: &EdgeMesh, edge: Edge) -> bool {
        self.is_seam[edge] || mesh.edges.is_boundary(edge)
    }

    /// The sum of a cost over the seams.
    pub(super) fn sum(&self, cost: &[f64]) -> f64 {
        // the sum of nothing would be −0
        self.seams().fold(0.0, |sum, edge| sum + cost[edge])
    }

    /// The number of seams at each vertex, with the edges of the boundary where `with_boundary`.
    pub(super) fn degrees(&self, mesh: &EdgeMesh, with_boundary: bool) -> Vec<u32> {
        let mut degrees = vec![0; mesh.n_vertices()];
        for edge in mesh.edges.all() {
            if self.is_seam[edge] || (with_boundary && mesh.edges.is_boundary(edge)) {
                mesh.edges.ends(edge).iter().for_each(|&vertex| degrees[vertex] += 1);
            }
        }
        degrees
    }

    /// The number of seams that end freely within an island.
    pub(super) fn n_leaves(&self, mesh: &EdgeMesh) -> usize {
        self.degrees(mesh, true).iter().filter(|&&degree| degree == 1).count()
    }

    /// Whether each vertex lies on a border, (n,).
    pub(super) fn border_vertices(&self, mesh: &EdgeMesh) -> Vec<bool> {
        self.degrees(mesh, true).iter().map(|&degree| degree > 0).collect()
    }

    /// The islands.
    pub(super) fn islands(&self, mesh: &EdgeMesh) -> Islands {
        let (of_face, n) = self.label_faces(mesh);
        let mut areas = vec![0.0; n];
        let mut euler_characteristics = vec![0; n];
        for (face, &island) in of_face.iter().enumerate() {
            areas[island as usize] += mesh.areas[face];
            euler_characteristics[island as usize] += 1;
        }
        let degrees = self.degrees(mesh, true);
        for edge in mesh.edges.all() {
            let (first, second) = mesh.faces_at(edge);
            euler_characteristics[of_face[first] as usize] -= 1;
            // both banks of a single seam keep both of its ends, so that it opens nothing
            let is_open =
                self.is_seam[edge] && mesh.edges.ends(edge).iter().any(|&vertex| degrees[vertex] > 1);
            if let Some(second) = second.filter(|_| is_open) {
                euler_characteristics[of_face[second] as usize] -= 1;
            }
        }
        self.count_vertices(mesh, |face| euler_characteristics[of_face[face] as usize] += 1);
        Islands { of_face, areas, euler_characteristics }
    }

    /// The island of each face, and the number of islands.
    fn label_faces(&self, mesh: &EdgeMesh) -> (Vec<u32>, usize) {
        const UNLABELED: u32 = u32::MAX;
        let mut label = vec![UNLABELED; mesh.n_faces()];
        let mut n_islands = 0;
        let mut pending = Vec::new();
        for seed in Face::all(mesh.n_faces()) {
            if label[seed] != UNLABELED {
                continue;
            }
            label[seed] = n_islands;
            pending.push(seed);
            while let Some(face) = pending.pop() {
                for corner in face.corners() {
                    let across = self.across(mesh, corner).map(Corner::face);
                    if let Some(across) = across.filter(|&across| label[across] == UNLABELED) {
                        label[across] = n_islands;
                        pending.push(across);
                    }
                }
            }
            n_islands += 1;
        }
        (label, n_islands as usize)
    }

    /// The corner across the edge opposite to a corner, unless a border lies between.
    fn across(&self, mesh: &EdgeMesh, corner: Corner) -> Option<Corner> {
        mesh.mesh.opposite(corner).filter(|_| !self.is_seam[mesh.edges.opposite_to(corner)])
    }

    /// Calls `visit` for each vertex of the cut mesh, with a face at it.
    fn count_vertices(&self, mesh: &EdgeMesh, mut visit: impl FnMut(Face)) {
        let n_seams = self.degrees(mesh, false);
        for vertex in Vertex::all(mesh.n_vertices()) {
            let corners = mesh.mesh.vertex_corners(vertex);
            // a fan falls into as many parts as borders leave it, and a circle of faces is one part at least
            if n_seams[vertex] == 0 || (n_seams[vertex] == 1 && !mesh.mesh.is_boundary(vertex)) {
                visit(corners[0].face());
                continue;
            }
            for &corner in corners {
                // the first corner of its part, in the direction of the turn
                if self.across(mesh, corner.next()).is_none() {
                    visit(corner.face());
                }
            }
        }
    }

    /// The segments between nodes: vertices of the boundary and those where other than two seams meet.
    pub(super) fn segments(&self, mesh: &EdgeMesh) -> Vec<Segment> {
        let degrees = self.degrees(mesh, false);
        let is_node =
            |vertex: Vertex| degrees[vertex] > 0 && (degrees[vertex] != 2 || mesh.mesh.is_boundary(vertex));
        let mut is_used = vec![false; mesh.n_edges()];
        let mut segments = Vec::new();
        for vertex in Vertex::all(mesh.n_vertices()).filter(|&vertex| is_node(vertex)) {
            for &(_, edge) in mesh.edges.around(vertex) {
                if self.is_seam[edge] && !is_used[edge] {
                    segments.push(self.walk(mesh, vertex, edge, is_node, &mut is_used));
                }
            }
        }
        for edge in Edge::all(mesh.n_edges()) {
            if self.is_seam[edge] && !is_used[edge] {
                segments.push(self.walk(mesh, mesh.edges.ends(edge)[0], edge, is_node, &mut is_used));
            }
        }
        segments
    }

    /// The segment that leaves a vertex along an edge.
    fn walk(
        &self,
        mesh: &EdgeMesh,
        start: Vertex,
        first: Edge,
        is_node: impl Fn(Vertex) -> bool,
        is_used: &mut [bool],
    ) -> Segment {
        let mut segment = Segment { vertices: vec![start], edges: Vec::new() };
        let (mut vertex, mut next) = (start, Some(first));
        while let Some(edge) = next {
            is_used[edge] = true;
            vertex = mesh.edges.other_end(edge, vertex);
            segment.edges.push(edge);
            segment.vertices.push(vertex);
            let onward = mesh.edges.around(vertex).iter().map(|&(_, edge)| edge);
            let mut onward = onward.filter(|&edge| self.is_seam[edge] && !is_used[edge]);
            next = if is_node(vertex) || vertex == start { None } else { onward.next() };
        }
        segment
    }
}

impl Islands {
    /// The number of islands.
    pub(super) fn len(&self) -> usize {
        self.areas.len()
    }

    /// Whether every island is a topological disk.
    pub(super) fn are_disks(&self) -> bool {
        self.euler_characteristics.iter().all(|&euler| euler == 1)
    }

    /// The smallest area of an island.
    pub(super) fn least_area(&self) -> f64 {
        self.areas.iter().copied().fold(f64::INFINITY, f64::min)
    }
}

impl Segment {
    /// Whether the segment ends where it begins.
    pub(super) fn is_closed(&self) -> bool {
        self.vertices.first() == self.vertices.last()
    }

    /// The segment from its last vertex to its first.
    pub(super) fn reversed(&self) -> Self {
        let (mut vertices, mut edges) = (self.vertices.clone(), self.edges.clone());
        vertices.reverse();
        edges.reverse();
        Self { vertices, edges }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::arrays::from_rows;
    use crate::mesh::{Surface, TriangleMesh};
    use crate::seams::sample_surfaces::{
        flat_grid, perforated_cylinder, plate_with_three_holes, random_numbers, sphere, torus,
    };

    fn surfaces() -> Vec<TriangleMesh> {
        vec![sphere(2), torus(), plate_with_three_holes(), perforated_cylinder(), flat_grid(6, 5)]
    }

    /// A cut along a part of all inner edges.
    fn random_cut(mesh: &EdgeMesh, share: f64, seed: u64) -> Cut {
        let mut random = random_numbers(seed);
        let inner = mesh.edges.all().filter(|&edge| !mesh.edges.is_boundary(edge));
        Cut::none(mesh).with(&inner.filter(|_| random() < share).collect::<Vec<_>>())
    }

    #[test]
    fn islands_are_the_patches_of_the_surface_that_is_cut() {
        for (k, surface) in surfaces().into_iter().enumerate() {
            let mesh = EdgeMesh::new(surface);
            for share in [0.0, 0.02, 0.2, 0.5, 0.9, 1.0] {
                let cut = random_cut(&mesh, share, k as u64);
                let seams = cut.seams().map(|edge| mesh.edges.ends(edge).map(|vertex| vertex.0)).collect();
                let patches = Surface::of_mesh(&mesh.mesh).cut(from_rows(seams)).unwrap();
                let islands = cut.islands(&mesh);
                assert_eq!(islands.len(), patches.len());
                for (island, patch) in patches.iter().enumerate() {
                    let faces: Vec<_> =
                        patch.corner_of.rows().into_iter().map(|row| row[0] as usize / 3).collect();
                    let area: f64 = faces.iter().map(|&face| mesh.areas[face]).sum();
                    assert!(faces.iter().all(|&face| islands.of_face[face] as usize == island));
                    assert!((islands.areas[island] - area).abs() < 1e-12);
                    let expected = euler_characteristic(&patch.surface);
                    assert_eq!(islands.euler_characteristics[island], expected);
                }
                assert_eq!(islands.are_disks(), patches.iter().all(|patch| patch.is_disk()));
            }
        }
    }

    /// Vertices − edges + faces, counted.
    fn euler_characteristic(surface: &Surface) -> i64 {
        let faces = surface.face_rows();
        let vertices: BTreeSet<_> = faces.iter().flatten().collect();
        let half_edges = faces.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let edges: BTreeSet<_> = half_edges.map(|[a, b]| [a.min(b), a.max(b)]).collect();
        vertices.len() as i64 - edges.len() as i64 + faces.len() as i64
    }

    #[test]
    fn segments_cover_every_seam_once_and_end_at_nodes() {
        for (k, surface) in surfaces().into_iter().enumerate() {
            let mesh = EdgeMesh::new(surface);
            for share in [0.02, 0.2, 0.6] {
                let cut = random_cut(&mesh, share, 7 + k as u64);
                let segments = cut.segments(&mesh);
                let mut covered: Vec<_> = segments.iter().flat_map(|segment| segment.edges.clone()).collect();
                covered.sort_unstable();
                assert!(cut.seams().eq(covered));
                let degrees = cut.degrees(&mesh, false);
                let is_node = |&vertex: &Vertex| degrees[vertex] != 2 || mesh.mesh.is_boundary(vertex);
                for segment in &segments {
                    assert_eq!(mesh.path_edges(&segment.vertices), segment.edges);
                    let [first, inner @ .., last] = &segment.vertices[..] else { panic!("no edge") };
                    assert!(!inner.iter().any(is_node));
                    assert!((is_node(first) && is_node(last)) || segment.is_closed());
                }
            }
        }
    }

    #[test]
    fn leaves_are_the_free_ends_of_seams() {
        let mesh = EdgeMesh::new(flat_grid(6, 5));
        let path =
            |vertices: &[u32]| mesh.path_edges(&vertices.iter().copied().map(Vertex).collect::<Vec<_>>());
        let from_boundary = Cut::none(&mesh).with(&path(&[14, 15, 16]));
        assert_eq!(from_boundary.n_leaves(&mesh), 1);
        let inside = from_boundary.with(&path(&[23, 24, 25]));
        assert_eq!(inside.n_leaves(&mesh), 3);
        assert_eq!(inside.without(&path(&[15, 16])).n_leaves(&mesh), 3);
        assert_eq!(inside.with(&path(&[16, 24])).n_leaves(&mesh), 2);
        assert_eq!(Cut::none(&mesh).n_leaves(&mesh), 0);
    }

    #[test]
    fn a_closed_seam_is_one_segment() {
        let mesh = EdgeMesh::new(flat_grid(6, 5));
        let ring = [8, 9, 10, 17, 24, 23, 22, 15, 8].map(Vertex);
        let cut = Cut::none(&mesh).with(&mesh.path_edges(&ring));
        let segments = cut.segments(&mesh);
        assert!(segments.len() == 1 && segments[0].is_closed() && segments[0].edges.len() == 8);
        assert_eq!(segments[0].reversed().reversed().vertices, segments[0].vertices);
        assert_eq!(cut.islands(&mesh).euler_characteristics, [0, 1]);
    }
}
