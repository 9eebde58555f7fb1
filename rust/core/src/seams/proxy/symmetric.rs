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
use crate::mesh::{Corner, Face, TriangleMesh, Vertex};
use crate::seams::symmetry::MirrorPlane;
use crate::vector::Vector3;

/// Vertices nearer to the plane than this part of their shortest edge move onto it.
const SNAP: f64 = 0.2;

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

/// The symmetric mesh of at most `target` vertices, if it has more than `limit` of them before decimation; `Ok(None)` where
/// it has not the topology of the surface, `None` if cancelled.
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
struct Half {
    points: Vec<Vector3>,
    faces: Vec<[Vertex; 3]>,
    on_plane: Vec<bool>,
    /// The vertex of the mesh at each vertex, or the nearer end of the edge on which it lies.
    nearest: Vec<Vertex>,
}

impl Half {
    /// Slices off the half of a mesh to which the normal of the plane points.
    fn slice(mesh: &TriangleMesh, plane: &MirrorPlane) -> Self {
        let heights = snapped_heights(mesh, plane);
        let mut slicing = Slicing {
            mesh,
            plane,
            heights: &heights,
            of_vertex: vec![None; mesh.n_vertices()],
            of_edge: vec![None; 3 * mesh.n_faces()],
            half: Self { points: Vec::new(), faces: Vec::new(), on_plane: Vec::new(), nearest: Vec::new() },
        };
        for face in Face::all(mesh.n_faces()) {
            if mesh.faces()[face].iter().any(|&vertex| heights[vertex] > 0.0) {
                slicing.add(face);
            }
        }
        slicing.half
    }

    fn push(&mut self, point: Vector3, is_on_plane: bool, nearest: Vertex) -> Vertex {
        self.points.push(point);
        self.on_plane.push(is_on_plane);
        self.nearest.push(nearest);
        Vertex::new(self.points.len() - 1)
    }
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

struct Slicing<'a> {
    mesh: &'a TriangleMesh,
    plane: &'a MirrorPlane,
    heights: &'a [f64],
    /// The vertex of the half at each vertex.
    of_vertex: Vec<Option<Vertex>>,
    /// The vertex of the half on the edge opposite to each corner, known to the lower of both corners.
    of_edge: Vec<Option<Vertex>>,
    half: Half,
}

impl Slicing<'_> {
    /// Adds what is above the plane of a face.
    fn add(&mut self, face: Face) {
        let mut polygon = Vec::with_capacity(4);
        for corner in face.corners() {
            let vertex = corner.vertex(self.mesh.faces());
            if self.heights[vertex] >= 0.0 {
                polygon.push(self.vertex(vertex));
            }
            // the edge to the next vertex
            let opposite = corner.previous();
            let [from, to] = opposite.half_edge(self.mesh.faces());
            if self.heights[from] * self.heights[to] < 0.0 {
                polygon.push(self.crossing(opposite));
            }
        }
        let length = |a: usize, b: usize| self.half.points[polygon[a]].distance(self.half.points[polygon[b]]);
        match *polygon {
            [a, b, c] => self.half.faces.push([a, b, c]),
            [a, b, c, d] if length(0, 2) < length(1, 3) => self.half.faces.extend([[a, b, c], [a, c, d]]),
            [a, b, c, d] => self.half.faces.extend([[a, b, d], [b, c, d]]),
            _ => {}
        }
    }

    fn vertex(&mut self, vertex: Vertex) -> Vertex {
        if let Some(known) = self.of_vertex[vertex] {
            return known;
        }
        let is_on_plane = self.heights[vertex] == 0.0;
        let point = self.mesh.points()[vertex];
        let point = if is_on_plane { self.plane.projection(point) } else { point };
        let added = self.half.push(point, is_on_plane, vertex);
        self.of_vertex[vertex] = Some(added);
        added
    }

    /// The vertex where the edge opposite to a corner crosses the plane.
    fn crossing(&mut self, corner: Corner) -> Vertex {
        let lower = self.mesh.opposite(corner).map_or(corner, |across| across.min(corner));
        if let Some(known) = self.of_edge[lower] {
            return known;
        }
        let [a, b] = lower.half_edge(self.mesh.faces());
        let t = self.heights[a] / (self.heights[a] - self.heights[b]);
        let point = self.mesh.points()[a] * (1.0 - t) + self.mesh.points()[b] * t;
        let nearest = if t < 0.5 { a } else { b };
        let added = self.half.push(self.plane.projection(point), true, nearest);
        self.of_edge[lower] = Some(added);
        added
    }
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
