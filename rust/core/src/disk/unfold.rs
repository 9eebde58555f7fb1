// SPDX-License-Identifier: MIT OR Apache-2.0
//! Unfolds the few folded faces that an unguarded method leaves.
//!
//! The disk counterpart of the bijectivity correction of Sutti & Yueh (2024), section 6.2. Around every
//! vertex i the mean-value weights (6.3b) of the image,
//!
//! ```text
//! ω_ij = Σ tan(φ_i / 2) / ‖h_i − h_j‖     over the faces ijk with angle φ_i at h_i,
//! ```
//!
//! are positive and reproduce h_i exactly where its one-ring is unfolded (Floater 2003). Solving Σ_j ω_ij
//! (h̃_i − h̃_j) = 0 with the rest held therefore moves only what is folded. Freed are the vertices within
//! a few rings of the folded faces, more where that does not suffice; with the whole interior free the map
//! is a convex combination map into a convex boundary, which is an embedding.
//!
//! Cost: one sparse LU of the freed vertices per attempt.

use sprs::TriMat;

use super::certificate::folded;
use crate::mesh::TriangleMesh;
use crate::sparse::solve_general;

/// Passes with the same vertices free, each with the weights of the map before it; the first nearly always
/// suffices.
const PASSES: usize = 3;

/// Returns `map` with its folded faces unfolded and its boundary kept, or `None` where even the whole
/// interior does not suffice in double precision.
pub(super) fn unfold(mesh: &TriangleMesh, map: &[[f64; 2]]) -> Option<Vec<[f64; 2]>> {
    let folds = folded(mesh, map);
    let n_interior = (0..mesh.n_vertices()).filter(|&v| !mesh.is_boundary(v)).count();
    let mut rings = 2;
    loop {
        // 1. Free the interior vertices within a few rings of the folded faces
        let free = interior_within(mesh, &folds, rings);
        // 2. Replace them by the mean-value combination of their one-rings
        if let Some(mended) = mend(mesh, map, &free) {
            return Some(mended);
        }
        // 3. Once more with twice the rings, until the whole interior was free
        if free.len() == n_interior {
            return None;
        }
        rings *= 2;
    }
}

/// A few passes of the mean-value correction; `None` where folds remain.
fn mend(mesh: &TriangleMesh, map: &[[f64; 2]], free: &[u32]) -> Option<Vec<[f64; 2]>> {
    let mut map = map.to_vec();
    for _ in 0..PASSES {
        correct(mesh, &mut map, free)?;
        if folded(mesh, &map).is_empty() {
            return Some(map);
        }
    }
    None
}

/// Interior vertices at most `rings` edges away from a vertex of the given faces, ascending.
fn interior_within(mesh: &TriangleMesh, faces: &[usize], rings: usize) -> Vec<u32> {
    let mut reached = vec![false; mesh.n_vertices()];
    let mut front: Vec<u32> = faces.iter().flat_map(|&face| mesh.faces()[face]).collect();
    for ring in 0..=rings {
        front.retain(|&vertex| !std::mem::replace(&mut reached[vertex as usize], true));
        if ring < rings {
            let one_rings = front.iter().flat_map(|&vertex| mesh.vertex_corners(vertex as usize));
            front = one_rings.flat_map(|&corner| mesh.faces()[corner as usize / 3]).collect();
        }
    }
    (0..mesh.n_vertices() as u32).filter(|&v| reached[v as usize] && !mesh.is_boundary(v as usize)).collect()
}

/// Solves (6.2) for the free vertices of `map` in place; `None` where the system is singular.
fn correct(mesh: &TriangleMesh, map: &mut [[f64; 2]], free: &[u32]) -> Option<()> {
    let n = free.len();
    let mut unknown = vec![usize::MAX; mesh.n_vertices()];
    for (i, &vertex) in free.iter().enumerate() {
        unknown[vertex as usize] = i;
    }
    let mut matrix = TriMat::new((n, n));
    let mut rhs = vec![0.0; 2 * n];
    for (i, &vertex) in free.iter().enumerate() {
        for (neighbour, weight) in mean_value_weights(mesh, map, vertex as usize) {
            matrix.add_triplet(i, i, weight);
            match unknown[neighbour] {
                usize::MAX => {
                    rhs[i] += weight * map[neighbour][0];
                    rhs[n + i] += weight * map[neighbour][1];
                }
                j => matrix.add_triplet(i, j, -weight),
            }
        }
    }
    solve_general(&matrix.to_csc(), &mut rhs).ok()?;
    for (i, &vertex) in free.iter().enumerate() {
        map[vertex as usize] = [rhs[i], rhs[n + i]];
    }
    Some(())
}

/// The weights (6.3b) of the one-ring of `vertex`, scaled to sum 1; a neighbour appears once per shared face.
fn mean_value_weights(mesh: &TriangleMesh, map: &[[f64; 2]], vertex: usize) -> Vec<(usize, f64)> {
    let mut weights = Vec::with_capacity(16);
    for &corner in mesh.vertex_corners(vertex) {
        let (face, k) = (mesh.faces()[corner as usize / 3], corner as usize % 3);
        let [one, two] = [1, 2].map(|step| face[(k + step) % 3] as usize);
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
    use crate::Boundary;
    use crate::disk::domain::DiskDomain;
    use crate::disk::start;

    /// A square grid of n × n vertices.
    fn grid(n: u32) -> TriangleMesh {
        let vertices: Vec<[f64; 3]> = (0..n * n).map(|i| [(i % n) as f64, (i / n) as f64, 0.0]).collect();
        let cells = (0..n - 1).flat_map(|row| (0..n - 1).map(move |column| row * n + column));
        let faces: Vec<[u32; 3]> =
            cells.flat_map(|a| [[a, a + 1, a + n + 1], [a, a + n + 1, a + n]]).collect();
        TriangleMesh::new(&vertices, &faces).unwrap()
    }

    fn tutte(mesh: &TriangleMesh) -> Vec<[f64; 2]> {
        let mut domain = DiskDomain::new(mesh, mesh.face_areas(), Boundary::ArcLength).unwrap();
        start::tutte(mesh, &mut domain).unwrap()
    }

    #[test]
    fn one_vertex_outside_its_one_ring_is_brought_back_and_the_far_ones_stay() {
        let mesh = grid(20);
        let good = tutte(&mesh);
        let mut folded_map = good.clone();
        folded_map[10 * 20 + 10] = good[12 * 20 + 13];
        assert!(!folded(&mesh, &folded_map).is_empty());
        let mended = unfold(&mesh, &folded_map).unwrap();
        assert!(folded(&mesh, &mended).is_empty());
        assert_eq!(mended[2 * 20 + 2], good[2 * 20 + 2]);
    }

    #[test]
    fn an_interior_collapsed_to_a_point_is_unfolded() {
        let mesh = grid(12);
        let mut map = tutte(&mesh);
        (0..map.len()).filter(|&v| !mesh.is_boundary(v)).for_each(|v| map[v] = [0.3, -0.2]);
        let mended = unfold(&mesh, &map).unwrap();
        assert!(folded(&mesh, &mended).is_empty());
    }

    #[test]
    fn mean_value_weights_reproduce_an_unfolded_map() {
        let mesh = grid(8);
        let map = tutte(&mesh);
        for vertex in (0..map.len()).filter(|&v| !mesh.is_boundary(v)) {
            let weights = mean_value_weights(&mesh, &map, vertex);
            let average = weights.iter().fold([0.0; 2], |sum, &(v, weight)| {
                [sum[0] + weight * map[v][0], sum[1] + weight * map[v][1]]
            });
            assert!((average[0] - map[vertex][0]).hypot(average[1] - map[vertex][1]) < 1e-12);
        }
    }
}
