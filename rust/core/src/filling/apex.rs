// SPDX-License-Identifier: MIT OR Apache-2.0
//! The tip of a cone over a boundary loop, which fills it.

use crate::mesh::geometry::{area, area_vector};
use crate::mesh::ties::first_largest;
use crate::vector::Vector3;

/// Area of the flat polygon nearest to a loop: the length of its area vector.
pub(crate) fn spanned_area(corners: &[Vector3]) -> f64 {
    loop_normal(corners).norm()
}

/// Σ of the area vectors of the fan around the centroid.
fn loop_normal(corners: &[Vector3]) -> Vector3 {
    let center = centroid(corners);
    edges(corners).fold(Vector3::ZERO, |sum, (from, to)| sum + area_vector([center, from, to]))
}

/// A point beside the centroid that lies on the line of no edge: the first candidate that rises most over the edge above
/// which it is lowest, by its height over the length of the edge. A flat loop leaves the side open; its normal decides.
pub(crate) fn apex_of(corners: &[Vector3]) -> Vector3 {
    let (center, normal) = (centroid(corners), loop_normal(corners));
    let length: f64 = edges(corners).map(|(from, to)| (to - from).norm()).sum();
    let mut directions = Vec::new();
    if normal.norm() > 0.0 {
        let unit = normal.normalized();
        directions.extend(edges(corners).take(1).map(|(from, to)| unit.cross(to - from)));
        directions.insert(0, unit);
    }
    directions.extend([0, 1, 2].map(Vector3::unit));
    directions.push(Vector3::ZERO);
    let candidates: Vec<Vector3> =
        directions.into_iter().map(|direction| center + direction * (0.1 * length)).collect();
    // twice the area over the square of an edge is the height over its length
    let least_height = |apex: &Vector3| {
        edges(corners)
            .map(|(from, to)| area([from, to, *apex]) / (to - from).dot(to - from))
            .fold(f64::INFINITY, f64::min)
    };
    let heights: Vec<f64> = candidates.iter().map(least_height).collect();
    candidates[first_largest(&heights).expect("there are candidates")]
}

fn centroid(corners: &[Vector3]) -> Vector3 {
    corners.iter().fold(Vector3::ZERO, |sum, &corner| sum + corner) * (1.0 / corners.len() as f64)
}

fn edges(corners: &[Vector3]) -> impl Iterator<Item = (Vector3, Vector3)> {
    (0..corners.len()).map(|k| (corners[k], corners[(k + 1) % corners.len()]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_does_not_choose_the_side_of_a_flat_loop() {
        let square = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]].map(Vector3);
        for corners in [square, [0, 3, 2, 1].map(|k| square[k])] {
            let apex = apex_of(&corners);
            assert!(apex.dot(loop_normal(&corners)) > 0.0);
            for seed in 0..30 {
                let noise =
                    |k: usize| Vector3::from_fn(|i| 1e-13 * (7.3 * (seed * 12 + 3 * k + i) as f64).sin());
                let noisy: Vec<Vector3> = corners.iter().enumerate().map(|(k, &x)| x + noise(k)).collect();
                assert!(apex_of(&noisy).distance(apex) < 1e-11, "{seed}");
            }
        }
    }
}
