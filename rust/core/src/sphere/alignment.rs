// SPDX-License-Identifier: MIT OR Apache-2.0
//! The rotation that aligns a sphere map with its surface.
//!
//! An area-preserving map of the sphere is free up to rotations (and more). The rotation R returned maximizes
//! Σ w_i (R f_i)·(v_i − c), c the centroid of the surface's measure w.

use crate::alignment::rotation::{best_rotation, centroid, rotate};
use crate::codomain::SpatialMap;
use crate::distortion::folded_on_sphere;
use crate::mesh::TriangleMesh;
use crate::parallel;

/// `map` rotated to align with its surface, with one weight per vertex; unchanged where the rounding of the rotation
/// folds a sliver.
pub(super) fn aligned(mesh: &TriangleMesh, map: SpatialMap, weights: &[f64]) -> SpatialMap {
    let (points, center) = (mesh.points(), centroid(mesh.points(), weights));
    let centered = parallel::map(points.len(), |vertex| points[vertex] - center);
    let rotation = best_rotation(&map, &centered, weights);
    let turned = parallel::map(map.len(), |vertex| {
        let turned = rotate(rotation, map[vertex]);
        turned.normalized()
    });
    let folds = |map: &SpatialMap| folded_on_sphere(mesh.faces(), map).len();
    if folds(&turned) > folds(&map) { map } else { turned }
}
