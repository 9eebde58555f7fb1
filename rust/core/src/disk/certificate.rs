// SPDX-License-Identifier: MIT OR Apache-2.0
//! Certificates: exact tests that a map to the disk is one-to-one.
//!
//! A map of a disk whose boundary runs once around a convex curve and whose faces all have positive
//! orientation is a bijection.

use super::boundary::runs_once_around;
use crate::distortion::folded_in_plane;
use crate::error::{Elements, Error, NumericsError};
use crate::mesh::TriangleMesh;
use crate::parallel;

/// A face below this part of its target counts as nearly folded: single precision, in which UVs are stored,
/// may fold it.
const SMALLEST_RATIO: f64 = 1e-3;

/// Faces whose exact orientation in `map` is not positive.
pub(super) fn folded(mesh: &TriangleMesh, map: &[[f64; 2]]) -> Vec<usize> {
    folded_in_plane(mesh.faces(), map)
}

/// Refuses a map with folds.
///
/// # Errors
/// [`NumericsError::NoEmbedding`] with the folded faces.
pub(super) fn refuse_folds(mesh: &TriangleMesh, map: &[[f64; 2]]) -> Result<(), Error> {
    match Elements::collect(folded(mesh, map)) {
        None => Ok(()),
        Some(folded) => Err(NumericsError::NoEmbedding { folded }.into()),
    }
}

/// True if `map` is a bijection onto its image: no folded face, boundary once around.
pub(super) fn is_bijective(mesh: &TriangleMesh, map: &[[f64; 2]]) -> bool {
    runs_once_around(&mesh.boundary_loops()[0], map) && folded(mesh, map).is_empty()
}

/// True if some face is left with less than [`SMALLEST_RATIO`] of its target area.
pub(super) fn nearly_folded(areas: &[f64], targets: &[f64]) -> bool {
    let scale = areas.iter().sum::<f64>() / targets.iter().sum::<f64>();
    !parallel::all(areas.len(), |face| areas[face] >= SMALLEST_RATIO * scale * targets[face])
}

/// True if every face is positive by more than its rounding error; never true for a folded face.
pub(super) fn clearly_unfolded(mesh: &TriangleMesh, map: &[[f64; 2]]) -> bool {
    parallel::all(mesh.n_faces(), |face| {
        let [a, b, c] = mesh.faces()[face].map(|vertex| map[vertex]);
        let (left, right) = ((b[0] - a[0]) * (c[1] - a[1]), (b[1] - a[1]) * (c[0] - a[0]));
        // the filter of Shewchuk's orient2d: (3 + 16ε)ε with ε = 2⁻⁵³
        left - right > 3.330_669_073_875_471_6e-16 * (left.abs() + right.abs())
    })
}
