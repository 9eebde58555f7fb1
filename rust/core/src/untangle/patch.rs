// SPDX-License-Identifier: MIT OR Apache-2.0
//! A patch: vertices that move, the faces at them, and a chart in which these are flat.

use super::positions::{Chart, Positions};
use super::triangle::{Corners, doubled_area};
use crate::energy::rest_cotangents;
use crate::mesh::geometry::triangle;
use crate::mesh::{Face, TriangleMesh, Vertex};

/// Least height of a rest shape relative to its longest edge; flatter faces are fattened.
const FLATTEST: f64 = 0.05;

/// Area of a face, in units of its share, below which it counts as folded while a patch is solved.
pub(super) const CLOSED: f64 = 1e-9;

/// A region of the map whose inner vertices move.
#[derive(Debug)]
pub(super) struct Patch {
    /// The vertices of the mesh, ascending.
    vertices: Vec<Vertex>,
    /// The faces, by indices in `vertices`.
    pub faces: Vec<[Vertex; 3]>,
    /// The indices of the faces in the mesh.
    face_indices: Vec<Face>,
    /// Whether each vertex moves.
    pub is_free: Vec<bool>,
    /// The places of the map given, in the chart.
    pub origin: Vec<[f64; 2]>,
    /// The present places, in the chart.
    pub present: Vec<[f64; 2]>,
    /// The fair share of area of each face; 1 on average.
    pub shares: Vec<f64>,
    /// The least area of each face, in units of its share.
    pub floors: Vec<f64>,
    /// Cotangents of the faces on the surface.
    pub cotangents: Vec<[f64; 3]>,
    chart: Chart,
}

impl Patch {
    /// The patch of the vertices `free` (ascending); `None` if its outline cannot bound a map without folds.
    pub(super) fn new(
        mesh: &TriangleMesh,
        given: &Positions,
        now: &Positions,
        free: &[Vertex],
        tolerance: f64,
    ) -> Option<Self> {
        // 1. The faces at the free vertices, numbered anew
        let corners = free.iter().flat_map(|&vertex| mesh.vertex_corners(vertex));
        let mut face_indices: Vec<Face> = corners.map(|&corner| corner.face()).collect();
        face_indices.sort_unstable();
        face_indices.dedup();
        let mut vertices: Vec<Vertex> = face_indices.iter().flat_map(|&face| mesh.faces()[face]).collect();
        vertices.sort_unstable();
        vertices.dedup();
        let number =
            |vertex: Vertex| Vertex::new(vertices.binary_search(&vertex).expect("it is in the patch"));
        let faces: Vec<[Vertex; 3]> =
            face_indices.iter().map(|&face| mesh.faces()[face].map(number)).collect();
        let is_free: Vec<bool> = vertices.iter().map(|vertex| free.binary_search(vertex).is_ok()).collect();
        // 2. A chart in which the mean share is 1
        let rim: Vec<Vertex> =
            vertices.iter().zip(&is_free).filter(|(_, is_free)| !**is_free).map(|(&v, _)| v).collect();
        let chart = Chart::around(now, &rim)?;
        let flat = |positions: &Positions, chart: &Chart| -> Vec<[f64; 2]> {
            vertices.iter().map(|&vertex| chart.down(positions, vertex)).collect()
        };
        let wide = flat(now, &chart);
        let of_face = |face: &[Vertex; 3]| 0.5 * doubled_area(face.map(|v| wide[v])).0;
        let (area, unsigned) =
            faces.iter().map(of_face).fold((0.0, 0.0), |(sum, all), a: f64| (sum + a, all + a.abs()));
        if !(area > 1e-12 * unsigned && area.is_finite()) {
            return None;
        }
        let chart = chart.scaled((faces.len() as f64 / area).sqrt());
        let (origin, present) = (flat(given, &chart), flat(now, &chart));
        // 3. Shares, rest shapes and floors
        let total: f64 = face_indices.iter().map(|&face| mesh.face_areas()[face]).sum();
        let scale = faces.len() as f64 / total;
        let shares: Vec<f64> = face_indices.iter().map(|&face| scale * mesh.face_areas()[face]).collect();
        let cotangents = face_indices
            .iter()
            .map(|&face| rest_cotangents(triangle(mesh.points(), mesh.faces()[face]), FLATTEST))
            .collect();
        let mut patch = Self {
            vertices,
            faces,
            face_indices,
            is_free,
            origin,
            present,
            shares,
            floors: Vec::new(),
            cotangents,
            chart,
        };
        let least = tolerance.max(10.0 * CLOSED);
        patch.floors = (0..patch.faces.len())
            .map(|face| match patch.ratio(&patch.origin, face) {
                ratio if ratio > 2.0 * CLOSED => least.min(0.5 * ratio),
                _ => least,
            })
            .collect();
        Some(patch)
    }

    /// The number of faces with less than twice their least area.
    pub(super) fn misses(&self, places: &[[f64; 2]]) -> usize {
        (0..self.faces.len()).filter(|&face| self.ratio(places, face) < 2.0 * self.floors[face]).count()
    }

    /// The least area of a face in units of its share.
    pub(super) fn least_ratio(&self, places: &[[f64; 2]]) -> f64 {
        (0..self.faces.len()).map(|face| self.ratio(places, face)).fold(f64::INFINITY, f64::min)
    }

    /// The area of a face in units of its share.
    pub(super) fn ratio(&self, places: &[[f64; 2]], face: usize) -> f64 {
        0.5 * doubled_area(self.corners(places, face)).0 / self.shares[face]
    }

    /// The corners of a face.
    pub(super) fn corners(&self, places: &[[f64; 2]], face: usize) -> Corners {
        self.faces[face].map(|vertex| places[vertex])
    }

    /// The number of faces at each vertex.
    pub(super) fn faces_per_vertex(&self) -> Vec<f64> {
        let mut counts = vec![0.0; self.vertices.len()];
        self.faces.iter().flatten().for_each(|&vertex| counts[vertex] += 1.0);
        counts
    }

    /// The faces of the mesh.
    pub(super) fn faces_of(&self, mesh: &TriangleMesh) -> Vec<[Vertex; 3]> {
        self.face_indices.iter().map(|&face| mesh.faces()[face]).collect()
    }

    /// Writes the free vertices; those at their old places bit for bit as given.
    pub(super) fn write(&self, given: &Positions, places: &[[f64; 2]], positions: &mut Positions) {
        for (k, &vertex) in self.vertices.iter().enumerate().filter(|&(k, _)| self.is_free[k]) {
            if places[k] == self.origin[k] {
                positions.copy(given, vertex)
            } else {
                self.chart.up(places[k], positions, vertex)
            }
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A patch of one face that moves as a whole.
    pub(in crate::untangle) fn one_face() -> Patch {
        Patch {
            vertices: [0, 1, 2].map(Vertex).to_vec(),
            faces: vec![[0, 1, 2].map(Vertex)],
            face_indices: vec![Face(0)],
            is_free: vec![true; 3],
            origin: vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
            present: vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
            shares: vec![0.7],
            floors: vec![0.01],
            cotangents: vec![[0.0, 1.0, 1.0]],
            chart: Chart::identity(),
        }
    }
}
