// SPDX-License-Identifier: MIT OR Apache-2.0
//! An exactly symmetric mesh near a surface that is symmetric, whatever its triangulation.
//!
//! 1. Vertices near the mirror plane move onto it, so that slicing leaves no slivers.
//! 2. The half on the normal's side is sliced off and decimated. Vertices on the plane stay on it.
//! 3. The half and its mirror image are welded along the plane.
//!
//! Cost: that of the decimation of the half.

use super::decimate::decimate;
use crate::control::Watch;
use crate::mesh::{EdgeTable, Face, TriangleMesh, Vertex};
use crate::seams::symmetry::MirrorPlane;
use crate::vector::Vector3;

/// Vertices nearer to the plane than this part of their shortest edge move onto it.
const SNAP: f64 = 0.2;

/// Parts of an edge, and lengths of diagonals, that differ by less are equal but for noise.
const EQUAL: f64 = 1e-9;

/// A symmetric mesh of which one half was sliced off another mesh.
#[derive(Debug)]
pub(super) struct SymmetricMesh {
    /// The mesh: the vertices of the half, then the mirror images of those off the plane.
    pub mesh: TriangleMesh,
    /// (n,): the mirror image of each vertex.
    pub mirror: Vec<Vertex>,
    /// The vertex of the other mesh at, or nearest along its edge to, each vertex of the half.
    pub nearest: Vec<Vertex>,
}

/// The symmetric mesh of `target` vertices, or one less; `Some(None)` where it has not the topology of the surface, `None`
/// if cancelled.
pub(super) fn symmetric_mesh(
    mesh: &TriangleMesh,
    plane: &MirrorPlane,
    target: usize,
    watch: &Watch<'_>,
) -> Option<Option<SymmetricMesh>> {
    // 1. The half
    let half = Half::slice(mesh, plane);
    let Ok(whole_half) = TriangleMesh::at_given_points(half.points.clone(), half.faces) else {
        return Some(None);
    };
    // 2. Decimated
    let decimated = decimate(&whole_half, Some(&half.on_plane), target, watch)?;
    let points: Vec<Vector3> = decimated.vertices.iter().map(|&vertex| half.points[vertex]).collect();
    let on_plane: Vec<bool> = decimated.vertices.iter().map(|&vertex| half.on_plane[vertex]).collect();
    let nearest = decimated.vertices.iter().map(|&vertex| half.nearest[vertex]).collect();
    // 3. Welded with its mirror image
    let (points, faces, mirror) = weld(points, decimated.faces, &on_plane, plane);
    let welded = TriangleMesh::at_given_points(points, faces).ok();
    let welded = welded.filter(|welded| has_equal_topology(welded, mesh));
    Some(welded.map(|mesh| SymmetricMesh { mesh, mirror, nearest }))
}

fn has_equal_topology(a: &TriangleMesh, b: &TriangleMesh) -> bool {
    let figures =
        |mesh: &TriangleMesh| (mesh.n_components(), mesh.euler_characteristic(), mesh.boundary_loops().len());
    figures(a) == figures(b)
}

/// A half of a mesh, on one side of a plane.
#[derive(Default)]
struct Half {
    points: Vec<Vector3>,
    faces: Vec<[Vertex; 3]>,
    on_plane: Vec<bool>,
    /// The vertex of the mesh at each vertex, or the nearer end of the edge on which it lies.
    nearest: Vec<Vertex>,
}

impl Half {
    /// Slices off the half of a mesh to which the normal of the plane points. The order of its vertices does not depend
    /// on the orientation of the mesh.
    fn slice(mesh: &TriangleMesh, plane: &MirrorPlane) -> Self {
        let heights = snapped_heights(mesh, plane);
        let mut half = Self::default();
        let of_vertex = half.add_vertices(mesh, plane, &heights);
        let of_edge = half.add_crossings(mesh, plane, &heights);
        for face in (0..mesh.n_faces()).map(Face::new).filter(|&face| rises(mesh, face, &heights)) {
            half.add_face(face.corners().into_iter().flat_map(|corner| {
                // the edge to the next vertex follows
                [of_vertex[corner.vertex(mesh.faces())], of_edge[corner.previous()]].into_iter().flatten()
            }));
        }
        half
    }

    /// Adds the vertices of the mesh on the plane and above it; returns their numbers.
    fn add_vertices(
        &mut self,
        mesh: &TriangleMesh,
        plane: &MirrorPlane,
        heights: &[f64],
    ) -> Vec<Option<Vertex>> {
        let above = |vertex: Vertex| {
            let mut corners = mesh.vertex_corners(vertex).iter();
            heights[vertex] >= 0.0 && corners.any(|corner| rises(mesh, corner.face(), heights))
        };
        let mut numbers = vec![None; mesh.n_vertices()];
        for vertex in Vertex::all(mesh.n_vertices()).filter(|&vertex| above(vertex)) {
            let point = mesh.points()[vertex];
            let is_on_plane = heights[vertex] == 0.0;
            let point = if is_on_plane { plane.projection(point) } else { point };
            numbers[vertex] = Some(self.push(point, is_on_plane, vertex));
        }
        numbers
    }

    /// Adds the vertices where edges cross the plane; returns their numbers by the corners opposite to the edges.
    fn add_crossings(
        &mut self,
        mesh: &TriangleMesh,
        plane: &MirrorPlane,
        heights: &[f64],
    ) -> Vec<Option<Vertex>> {
        let mut numbers = vec![None; 3 * mesh.n_faces()];
        for ([a, b], corners) in EdgeTable::new(mesh.n_vertices(), mesh.faces()).edges() {
            if heights[a] * heights[b] < 0.0 {
                let t = heights[a] / (heights[a] - heights[b]);
                let point = mesh.points()[a] * (1.0 - t) + mesh.points()[b] * t;
                let crossing = self.push(plane.projection(point), true, if t < 0.5 - EQUAL { a } else { b });
                corners.iter().for_each(|corner| numbers[corner.corner()] = Some(crossing));
            }
        }
        numbers
    }

    fn push(&mut self, point: Vector3, is_on_plane: bool, nearest: Vertex) -> Vertex {
        self.points.push(point);
        self.on_plane.push(is_on_plane);
        self.nearest.push(nearest);
        Vertex::new(self.points.len() - 1)
    }

    /// Adds a triangle, or a quad split along its shorter diagonal.
    fn add_face(&mut self, polygon: impl Iterator<Item = Vertex>) {
        let polygon: Vec<Vertex> = polygon.collect();
        let length = |a: Vertex, b: Vertex| self.points[a].distance(self.points[b]);
        match *polygon {
            [a, b, c] => self.faces.push([a, b, c]),
            [a, b, c, d] if length(a, c) < (1.0 - EQUAL) * length(b, d) => {
                self.faces.extend([[a, b, c], [a, c, d]])
            }
            [a, b, c, d] => self.faces.extend([[a, b, d], [b, c, d]]),
            _ => {}
        }
    }
}

/// Whether a face has a vertex above the plane.
fn rises(mesh: &TriangleMesh, face: Face, heights: &[f64]) -> bool {
    mesh.faces()[face].iter().any(|&vertex| heights[vertex] > 0.0)
}

/// The heights of vertices over a plane: 0 for those that move onto it.
fn snapped_heights(mesh: &TriangleMesh, plane: &MirrorPlane) -> Vec<f64> {
    let mut shortest = vec![f64::INFINITY; mesh.n_vertices()];
    for corner in mesh.edge_corners() {
        let length = mesh.edge_length(corner);
        corner.half_edge(mesh.faces()).into_iter().for_each(|end| shortest[end] = shortest[end].min(length));
    }
    let snapped = |(&point, shortest): (&Vector3, f64)| {
        let height = plane.height(point);
        if height.abs() <= SNAP * shortest { 0.0 } else { height }
    };
    mesh.points().iter().zip(shortest).map(snapped).collect()
}

/// The points and faces of a half and its mirror image, welded along the plane, and the image of each vertex.
fn weld(
    mut points: Vec<Vector3>,
    mut faces: Vec<[Vertex; 3]>,
    on_plane: &[bool],
    plane: &MirrorPlane,
) -> (Vec<Vector3>, Vec<[Vertex; 3]>, Vec<Vertex>) {
    let n = points.len();
    let mut mirror: Vec<Vertex> = Vertex::all(n).collect();
    for vertex in Vertex::all(n).filter(|&vertex| !on_plane[vertex]) {
        mirror[vertex] = Vertex::new(points.len());
        mirror.push(vertex);
        points.push(plane.image(points[vertex]));
    }
    let mirrored: Vec<_> = faces.iter().map(|&[a, b, c]| [a, c, b].map(|vertex| mirror[vertex])).collect();
    faces.extend(mirrored);
    (points, faces, mirror)
}
