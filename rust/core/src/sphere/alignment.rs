// SPDX-License-Identifier: MIT OR Apache-2.0
//! The rotation that lays a sphere map over its surface.
//!
//! An area-preserving map of the sphere is free up to rotations (and more), so that of all rotated copies the
//! one that lies over the surface best is returned: it maximises Σ w_i (R f_i)·(v_i − c), c the centroid of
//! the surface's measure w. Horn (1987): R is the rotation of the quaternion that belongs to the largest
//! eigenvalue of a symmetric 4 × 4 matrix.

use super::Map;
use crate::distortion::folded_on_sphere;
use crate::mesh::TriangleMesh;
use crate::mesh::geometry::{Vector, dot, norm, scaled};
use crate::parallel;
use crate::sparse::top_eigenvector;

/// `map` rotated over its surface, with one weight per vertex; as it was where the rounding of a rotation
/// folds a sliver.
pub(super) fn aligned(mesh: &TriangleMesh, map: Map, weights: &[f64]) -> Map {
    let rotation = best_rotation(&map, mesh.points(), weights);
    let turned = parallel::map(map.len(), |vertex| {
        let turned = rotate(rotation, map[vertex]);
        scaled(turned, 1.0 / norm(turned))
    });
    let folds = |map: &Map| folded_on_sphere(mesh.faces(), map).len();
    if folds(&turned) > folds(&map) { map } else { turned }
}

/// The rotation R, by rows, that maximises Σ w_i (R f_i)·(v_i − c).
fn best_rotation(map: &[Vector], points: &[Vector], weights: &[f64]) -> [Vector; 3] {
    let total = parallel::sum(weights.len(), |v| weights[v]);
    let centroid: Vector =
        std::array::from_fn(|axis| parallel::sum(points.len(), |v| weights[v] * points[v][axis]) / total);
    // S_ab = Σ w f_a (v − c)_b
    let s: [Vector; 3] = std::array::from_fn(|a| {
        std::array::from_fn(|b| {
            parallel::sum(map.len(), |v| weights[v] / total * map[v][a] * (points[v][b] - centroid[b]))
        })
    });
    let trace = s[0][0] + s[1][1] + s[2][2];
    let [x, y, z] = [s[1][2] - s[2][1], s[2][0] - s[0][2], s[0][1] - s[1][0]];
    let [xy, yz, zx] = [s[0][1] + s[1][0], s[1][2] + s[2][1], s[2][0] + s[0][2]];
    let diagonal = |axis: usize| 2.0 * s[axis][axis] - trace;
    rotation_of(top_eigenvector(&[
        [trace, x, y, z],
        [x, diagonal(0), xy, zx],
        [y, xy, diagonal(1), yz],
        [z, zx, yz, diagonal(2)],
    ]))
}

/// The rotation of a unit quaternion w + xi + yj + zk, by rows.
fn rotation_of([w, x, y, z]: [f64; 4]) -> [Vector; 3] {
    [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
    ]
}

fn rotate(rotation: [Vector; 3], x: Vector) -> Vector {
    rotation.map(|row| dot(row, x))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::geometry::distance;

    #[test]
    fn a_rotated_map_is_turned_back() {
        let points: Vec<Vector> = (0..40)
            .map(|i| {
                let (a, h) = (2.4 * i as f64, -1.0 + (2 * i + 1) as f64 / 40.0);
                let r = (1.0 - h * h).sqrt();
                [r * a.cos(), r * a.sin(), h]
            })
            .collect();
        let weights: Vec<f64> = (0..40).map(|i| 1.0 + 0.1 * (i as f64).sin()).collect();
        let unit = [0.5, -0.1, 0.7, 0.5].map(|q: f64| q);
        for turn in [unit, [0.0, 1.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0, 0.6, 0.0, 0.8]] {
            let rotation = rotation_of(turn);
            let turned: Vec<Vector> = points.iter().map(|&x| rotate(rotation, x)).collect();
            let shifted: Vec<Vector> =
                points.iter().map(|x| [3.0 * x[0] + 1.0, 3.0 * x[1], 3.0 * x[2] - 7.0]).collect();
            let back = best_rotation(&turned, &shifted, &weights);
            for (&moved, &point) in turned.iter().zip(&points) {
                assert!(distance(rotate(back, moved), point) < 1e-12);
            }
        }
    }
}
