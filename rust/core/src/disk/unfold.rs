// SPDX-License-Identifier: MIT OR Apache-2.0
//! Unfolds the few folded faces that an unguarded method leaves on the disk.
//!
//! The disk counterpart of the bijectivity correction of Sutti & Yueh (2024), section 6.2, see
//! [`mean_value`]. It frees the vertices within a few rings of the folded faces, and more where that does not
//! suffice; with the whole interior free the map is a convex combination map into a convex boundary, which
//! is an embedding.
//!
//! Cost: one sparse LU of the freed vertices per attempt.

use super::certificate::folded;
use crate::energy::mean_value::{self, Weights, correct};
use crate::mesh::{TriangleMesh, Vertex};

/// Passes with the same vertices free, each with the weights of the map before it; the first nearly always
/// suffices.
const PASSES: usize = 3;

/// Returns `map` with its folded faces unfolded and its boundary kept, or `None` where even the whole
/// interior does not suffice in double precision.
pub(super) fn unfold(mesh: &TriangleMesh, map: &[[f64; 2]]) -> Option<Vec<[f64; 2]>> {
    unfold_within(mesh, map, usize::MAX)
}

/// [`unfold`] with at most `most_rings` rings around the folded faces free.
pub(crate) fn unfold_within(
    mesh: &TriangleMesh,
    map: &[[f64; 2]],
    most_rings: usize,
) -> Option<Vec<[f64; 2]>> {
    let folds = folded(mesh, map);
    let n_interior = Vertex::all(mesh.n_vertices()).filter(|&v| !mesh.is_boundary(v)).count();
    let mut rings = 2;
    loop {
        // 1. Free the interior vertices within a few rings of the folded faces
        let free = mean_value::free_within(mesh, &folds, rings, |v| !mesh.is_boundary(v));
        // 2. Replace them by the mean-value combination of their one-rings
        if let Some(mended) = mend(mesh, map, &free) {
            return Some(mended);
        }
        // 3. Repeat with twice the rings, until the whole interior was free
        if free.len() == n_interior || 2 * rings > most_rings {
            return None;
        }
        rings *= 2;
    }
}

/// A few passes of the mean-value correction; `None` where folds remain.
fn mend(mesh: &TriangleMesh, map: &[[f64; 2]], free: &[Vertex]) -> Option<Vec<[f64; 2]>> {
    let mut map = map.to_vec();
    for _ in 0..PASSES {
        correct(mesh, &mut map, free, Weights::MeanValue)?;
        if folded(mesh, &map).is_empty() {
            return Some(map);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::disk::boundary::arc_length;
    use crate::disk::options::Boundary;
    use crate::disk::published::objective::DiskObjective;
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
        let mut objective = DiskObjective::new(mesh, mesh.face_areas(), Boundary::ArcLength).unwrap();
        let mut silent = crate::control::Silent;
        let watch = crate::control::Watch::new(&mut silent, 0.0, "");
        start::tutte(mesh, &mut objective, arc_length(mesh), &watch).unwrap()
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
        Vertex::all(map.len()).filter(|&v| !mesh.is_boundary(v)).for_each(|v| map[v] = [0.3, -0.2]);
        let mended = unfold(&mesh, &map).unwrap();
        assert!(folded(&mesh, &mended).is_empty());
    }
}
