// SPDX-License-Identifier: MIT OR Apache-2.0
//! The mean-value Laplacian of a planar image, which unfolds it.
//!
//! The bijectivity correction of Sutti & Yueh (2024), section 6.2. Around every vertex i the mean-value
//! weights (6.3b) of the image,
//!
//! ```text
//! ω_ij = Σ tan(φ_i / 2) / ‖h_i − h_j‖     over the faces ijk with angle φ_i at h_i,
//! ```
//!
//! are positive and reproduce h_i exactly where its one-ring is unfolded (Floater 2003). Solving Σ_j ω_ij
//! (h̃_i − h̃_j) = 0 with the rest held therefore moves only folded one-rings.
//!
//! Where a part has collapsed, these weights are arbitrary. Weights of 1 (Tutte 1963) unfold it inside a boundary that
//! is nearly convex.
//!
//! Cost: one sparse LU of the freed vertices per correction.

use sprs::TriMat;

use crate::mesh::{TriangleMesh, Vertex};
use crate::sparse::solve_general;

/// Vertices at most `rings` edges away from a vertex of the given faces for which `is_free` holds, ascending.
pub(crate) fn free_within(
    mesh: &TriangleMesh,
    faces: &[usize],
    rings: usize,
    is_free: impl Fn(Vertex) -> bool,
) -> Vec<Vertex> {
    let mut reached = vec![false; mesh.n_vertices()];
    let mut front: Vec<Vertex> = faces.iter().flat_map(|&face| mesh.faces()[face]).collect();
    for ring in 0..=rings {
        front.retain(|&vertex| !std::mem::replace(&mut reached[vertex], true));
        if ring < rings {
            let one_rings = front.iter().flat_map(|&vertex| mesh.vertex_corners(vertex));
            front = one_rings.flat_map(|&corner| mesh.faces()[corner.face()]).collect();
        }
    }
    Vertex::all(mesh.n_vertices()).filter(|&v| reached[v] && is_free(v)).collect()
}

/// The weights of a correction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Weights {
    /// (6.3b), computed from the image.
    MeanValue,
    /// 1, independent of the image.
    Uniform,
}

/// Solves (6.2) for the free vertices of a planar `map` in place; `None` where the system is singular.
pub(crate) fn correct(
    mesh: &TriangleMesh,
    map: &mut [[f64; 2]],
    free: &[Vertex],
    weights: Weights,
) -> Option<()> {
    let one_rings = free.iter().map(|&vertex| match weights {
        Weights::MeanValue => mean_value_weights(mesh, map, vertex),
        Weights::Uniform => uniform_weights(mesh, vertex),
    });
    let one_rings = one_rings.collect();
    solve(map, free, one_rings)
}

/// Carries the free vertices of a planar `map` along with the others, which have moved from where they lie in `before`:
/// each keeps the weights (6.3b) that it has there. `None` where the system is singular.
pub(crate) fn carry(
    mesh: &TriangleMesh,
    before: &[[f64; 2]],
    map: &mut [[f64; 2]],
    free: &[Vertex],
) -> Option<()> {
    let one_rings = free.iter().map(|&vertex| mean_value_weights(mesh, before, vertex)).collect();
    solve(map, free, one_rings)
}

/// Makes each free vertex of a `map` the combination of its neighbors by given weights.
fn solve(map: &mut [[f64; 2]], free: &[Vertex], one_rings: Vec<Vec<(Vertex, f64)>>) -> Option<()> {
    let n = free.len();
    let mut unknown = vec![usize::MAX; map.len()];
    for (i, &vertex) in free.iter().enumerate() {
        unknown[vertex] = i;
    }
    let mut matrix = TriMat::new((n, n));
    let mut rhs = vec![0.0; 2 * n];
    for (i, one_ring) in one_rings.into_iter().enumerate() {
        for (neighbor, weight) in one_ring {
            matrix.add_triplet(i, i, weight);
            match unknown[neighbor] {
                usize::MAX => {
                    rhs[i] += weight * map[neighbor][0];
                    rhs[n + i] += weight * map[neighbor][1];
                }
                j => matrix.add_triplet(i, j, -weight),
            }
        }
    }
    solve_general(&matrix.to_csc(), &mut rhs).ok()?;
    for (i, &vertex) in free.iter().enumerate() {
        map[vertex] = [rhs[i], rhs[n + i]];
    }
    Some(())
}

/// Equal weights of the one-ring of `vertex` that sum to 1; a neighbor appears once per shared face.
fn uniform_weights(mesh: &TriangleMesh, vertex: Vertex) -> Vec<(Vertex, f64)> {
    let corners = mesh.vertex_corners(vertex);
    let weight = 0.5 / corners.len() as f64;
    let neighbors = corners.iter().flat_map(|&corner| {
        let (face, k) = (mesh.faces()[corner.face()], corner.place());
        [1, 2].map(|step| face[(k + step) % 3])
    });
    neighbors.map(|neighbor| (neighbor, weight)).collect()
}

/// The weights (6.3b) of the one-ring of `vertex`, scaled to sum 1; a neighbor appears once per shared face.
fn mean_value_weights(mesh: &TriangleMesh, map: &[[f64; 2]], vertex: Vertex) -> Vec<(Vertex, f64)> {
    let mut weights = Vec::with_capacity(16);
    for &corner in mesh.vertex_corners(vertex) {
        let (face, k) = (mesh.faces()[corner.face()], corner.place());
        let [one, two] = [1, 2].map(|step| face[(k + step) % 3]);
        let [a, b] = [one, two].map(|v| [map[v][0] - map[vertex][0], map[v][1] - map[vertex][1]]);
        // a collapsed edge or an angle of 180° gets a large weight, not an infinite one
        let [length_a, length_b] = [a, b].map(|e| e[0].hypot(e[1]).max(1e-12));
        let cross = (a[0] * b[1] - a[1] * b[0]).abs();
        let dot = a[0] * b[0] + a[1] * b[1];
        let half_tangent = cross.max(1e-12 * length_a * length_b)
            / (length_a * length_b + dot).max(1e-12 * length_a * length_b);
        weights.push((one, half_tangent / length_a));
        weights.push((two, half_tangent / length_b));
    }
    let total: f64 = weights.iter().map(|(_, weight)| weight).sum();
    weights.iter_mut().for_each(|(_, weight)| *weight /= total);
    weights
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_weights_reproduce_a_vertex_inside_its_one_ring() {
        let vertices = [[0.1, 0.2, 0.], [1., 0., 0.], [0.3, 1., 0.], [-1., 0.2, 0.], [-0.2, -1.3, 0.]];
        let faces = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]];
        let mesh = TriangleMesh::new(&vertices, &faces).unwrap();
        let map: Vec<[f64; 2]> = vertices.iter().map(|p| [p[0], p[1]]).collect();
        let average = mean_value_weights(&mesh, &map, Vertex(0))
            .iter()
            .fold([0.0; 2], |sum, &(v, weight)| [sum[0] + weight * map[v][0], sum[1] + weight * map[v][1]]);
        assert!((average[0] - 0.1).hypot(average[1] - 0.2) < 1e-14);
    }

    #[test]
    fn rings_grow_by_one_edge_and_stop_at_held_vertices() {
        let strip: Vec<[f64; 3]> = (0..10).map(|i| [(i / 2) as f64, (i % 2) as f64, 0.]).collect();
        let faces: Vec<[u32; 3]> =
            (0..4).flat_map(|i| [[2 * i, 2 * i + 2, 2 * i + 1], [2 * i + 1, 2 * i + 2, 2 * i + 3]]).collect();
        let mesh = TriangleMesh::new(&strip, &faces).unwrap();
        assert_eq!(free_within(&mesh, &[0], 0, |_| true), [0, 1, 2].map(Vertex));
        assert_eq!(free_within(&mesh, &[0], 1, |v| v != Vertex(1)), [0, 2, 3, 4].map(Vertex));
    }
}
