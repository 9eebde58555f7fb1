// SPDX-License-Identifier: MIT OR Apache-2.0
//! A mesh with numbered edges and what a search for seams reads off it, in units of the surface's size.

use crate::mesh::geometry::{area_vector, triangle};
use crate::mesh::{Corner, Edge, Edges, Face, TriangleMesh};
use crate::vector::Vector3;

/// A mesh whose edges may become seams. Lengths are over the square root of the area, areas over the area.
#[derive(Debug, Clone)]
pub(super) struct EdgeMesh {
    pub mesh: TriangleMesh,
    pub edges: Edges,
    /// The square root of the area: a length of the mesh's points is one of these units times this.
    pub unit: f64,
    /// The length of each edge, (e,).
    pub lengths: Vec<f64>,
    /// The area of each face, (m,); they sum to 1.
    pub areas: Vec<f64>,
    /// Whether an edge is the diagonal of a quad, (e,).
    pub is_diagonal: Vec<bool>,
}

impl EdgeMesh {
    /// Measures a mesh that has no polygons but triangles.
    pub(super) fn new(mesh: TriangleMesh) -> Self {
        let edges = Edges::new(&mesh);
        let total: f64 = mesh.face_areas().iter().sum();
        let unit = total.sqrt();
        let length = |edge| {
            let [a, b] = edges.ends(edge);
            mesh.points()[a].distance(mesh.points()[b]) / unit
        };
        let lengths = edges.all().map(length).collect();
        let areas = mesh.face_areas().iter().map(|area| area / total).collect();
        let is_diagonal = vec![false; edges.len()];
        Self { mesh, edges, unit, lengths, areas, is_diagonal }
    }

    /// The number of vertices.
    pub(super) fn n_vertices(&self) -> usize {
        self.mesh.n_vertices()
    }

    /// The number of faces.
    pub(super) fn n_faces(&self) -> usize {
        self.mesh.n_faces()
    }

    /// The number of edges.
    pub(super) fn n_edges(&self) -> usize {
        self.edges.len()
    }

    /// The edge opposite to corner `k` of a face.
    pub(super) fn edge_of(&self, face: Face, k: usize) -> Edge {
        self.edges.opposite_to(face.corner(k))
    }

    /// The faces beside an edge; the second is `None` on the boundary.
    pub(super) fn faces_at(&self, edge: Edge) -> (Face, Option<Face>) {
        let (first, second) = self.edges.sides(edge);
        (first.face(), second.map(Corner::face))
    }

    /// The lengths of the edges opposite to the corners of a face.
    pub(super) fn side_lengths(&self, face: Face) -> [f64; 3] {
        [0, 1, 2].map(|k| self.lengths[self.edge_of(face, k)])
    }

    /// 2π less the angles at each vertex, (n,).
    pub(super) fn angle_defects(&self) -> Vec<f64> {
        let mut defects = vec![std::f64::consts::TAU; self.n_vertices()];
        for (face, &corners) in self.mesh.faces().iter().enumerate() {
            let angles = angles(self.side_lengths(Face::new(face)));
            corners.iter().zip(angles).for_each(|(&vertex, angle)| defects[vertex] -= angle);
        }
        defects
    }

    /// The unit normal of a face.
    pub(super) fn normal(&self, face: Face) -> Vector3 {
        area_vector(triangle(self.mesh.points(), self.mesh.faces()[face])).normalized()
    }

    /// The angle between the normals beside an edge in radians, positive where the surface is concave; 0 on the
    /// boundary.
    pub(super) fn dihedral_angle(&self, edge: Edge) -> f64 {
        let (first, Some(second)) = self.faces_at(edge) else { return 0.0 };
        let normals = [first, second].map(|face| self.normal(face));
        let angle = normals[0].dot(normals[1]).clamp(-1.0, 1.0).acos();
        let tip = self.tip(self.edges.sides(edge).1.unwrap_or_default());
        let base = self.mesh.points()[self.edges.ends(edge)[0]];
        if (tip - base).dot(normals[0]) > 0.0 { angle } else { -angle }
    }

    fn tip(&self, corner: Corner) -> Vector3 {
        self.mesh.points()[corner.vertex(self.mesh.faces())]
    }

    /// The median length of the edges.
    pub(super) fn median_length(&self) -> f64 {
        self.mesh.median_edge_length() / self.unit
    }

    /// The edges of a path of vertices.
    #[cfg(test)]
    pub(super) fn path_edges(&self, path: &[crate::mesh::Vertex]) -> Vec<Edge> {
        path.windows(2).filter_map(|pair| self.edges.between(pair[0], pair[1])).collect()
    }
}

/// The angles opposite to the sides of a triangle of these lengths.
fn angles(sides: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| {
        let [a, b, c] = [sides[k], sides[(k + 1) % 3], sides[(k + 2) % 3]];
        ((b * b + c * c - a * a) / (2.0 * b * c)).clamp(-1.0, 1.0).acos()
    })
}
