// SPDX-License-Identifier: MIT OR Apache-2.0
//! Boundary maps onto the unit circle.

use std::f64::consts::TAU;

use crate::mesh::TriangleMesh;
use crate::mesh::geometry::{norm, sub};

/// Places the boundary loop on the unit circle, counter-clockwise, arcs proportional to the edge lengths; the loop's smallest
/// vertex goes to (1, 0). Interior vertices go to the origin.
pub(super) fn arc_length(mesh: &TriangleMesh) -> Vec<[f64; 2]> {
    let boundary = &mesh.boundary_loops()[0];
    let mut map = vec![[0.0; 2]; mesh.n_vertices()];
    let lengths = edge_lengths(mesh, boundary);
    let total: f64 = lengths.iter().sum();
    let mut travelled = 0.0;
    for (&vertex, length) in boundary.iter().zip(lengths) {
        let angle = TAU * travelled / total;
        map[vertex as usize] = [angle.cos(), angle.sin()];
        travelled += length;
    }
    map
}

/// Length of the edge that leaves each vertex of a loop.
pub(super) fn edge_lengths(mesh: &TriangleMesh, boundary: &[u32]) -> Vec<f64> {
    let point = |k: usize| mesh.points()[boundary[k % boundary.len()] as usize];
    (0..boundary.len()).map(|k| norm(sub(point(k + 1), point(k)))).collect()
}

/// Whether the boundary loop runs once around the circle, counter-clockwise, without turning back.
pub(super) fn runs_once_around(boundary: &[u32], map: &[[f64; 2]]) -> bool {
    let mut turned = 0.0;
    for k in 0..boundary.len() {
        let [from, to] = [boundary[k], boundary[(k + 1) % boundary.len()]].map(|v| map[v as usize]);
        let sine = from[0] * to[1] - from[1] * to[0];
        let cosine = from[0] * to[0] + from[1] * to[1];
        let arc = sine.atan2(cosine);
        if arc <= 0.0 {
            return false;
        }
        turned += arc;
    }
    (turned - TAU).abs() < 1e-6
}
