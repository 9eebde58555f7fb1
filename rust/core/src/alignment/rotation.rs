// SPDX-License-Identifier: MIT OR Apache-2.0
//! The best rotation of points onto points.
//!
//! Horn (1987), *Closed-form solution of absolute orientation using unit quaternions*: its quaternion is the
//! eigenvector of the largest eigenvalue of a symmetric 4 × 4 matrix. It never reflects.

use crate::parallel;
use crate::sparse::top_eigenvector;
use crate::vector::Vector3;

/// The rotation R, by rows, that maximizes Σ w_i (R x_i)·y_i, `from` x and `to` y.
///
/// With y less its [`centroid`], R minimizes Σ w_i |R x_i + b − y_i|² over all R and b; with both on the sphere, it
/// minimizes Σ w_i |R x_i − y_i|².
pub(crate) fn best_rotation(from: &[Vector3], to: &[Vector3], weights: &[f64]) -> [Vector3; 3] {
    let total = parallel::sum(weights.len(), |v| weights[v]);
    rotation_by_covariance(std::array::from_fn(|a| {
        std::array::from_fn(|b| parallel::sum(from.len(), |v| weights[v] / total * from[v][a] * to[v][b]))
    }))
}

/// [`best_rotation`] by its covariance S_ab = Σ w x_a y_b, on any scale.
pub(crate) fn rotation_by_covariance(s: [[f64; 3]; 3]) -> [Vector3; 3] {
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

/// Σ w_i x_i / Σ w_i.
pub(crate) fn centroid(points: &[Vector3], weights: &[f64]) -> Vector3 {
    let total = parallel::sum(weights.len(), |v| weights[v]);
    Vector3::from_fn(|axis| parallel::sum(points.len(), |v| weights[v] * points[v][axis]) / total)
}

/// The rotation of a unit quaternion w + xi + yj + zk, by rows.
pub(crate) fn rotation_of([w, x, y, z]: [f64; 4]) -> [Vector3; 3] {
    [
        Vector3([1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)]),
        Vector3([2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)]),
        Vector3([2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)]),
    ]
}

/// `x` rotated.
pub(crate) fn rotate(rotation: [Vector3; 3], x: Vector3) -> Vector3 {
    Vector3(rotation.map(|row| row.dot(x)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rotated_points_are_turned_back() {
        let points: Vec<Vector3> = (0..40)
            .map(|i| {
                let (a, h) = (2.4 * i as f64, -1.0 + (2 * i + 1) as f64 / 40.0);
                let r = (1.0 - h * h).sqrt();
                Vector3([r * a.cos(), r * a.sin(), h])
            })
            .collect();
        let weights: Vec<f64> = (0..40).map(|i| 1.0 + 0.1 * (i as f64).sin()).collect();
        let unit = [0.5, -0.1, 0.7, 0.5];
        for turn in [unit, [0.0, 1.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0, 0.6, 0.0, 0.8]] {
            let rotation = rotation_of(turn);
            let turned: Vec<Vector3> = points.iter().map(|&x| rotate(rotation, x)).collect();
            let shifted: Vec<Vector3> = points.iter().map(|&x| x * 3.0 + Vector3([1.0, 0.0, -7.0])).collect();
            let center = centroid(&shifted, &weights);
            let centered: Vec<Vector3> = shifted.iter().map(|&y| y - center).collect();
            let back = best_rotation(&turned, &centered, &weights);
            for (&moved, &point) in turned.iter().zip(&points) {
                assert!(rotate(back, moved).distance(point) < 1e-12);
            }
        }
    }
}
