// SPDX-License-Identifier: MIT OR Apache-2.0
//! The best similarity of points onto points (Umeyama 1991).

use super::rotation::{best_rotation, centroid, rotate};
use crate::parallel;
use crate::vector::Vector3;

/// A motion of space with a change of scale: x ↦ s R x + b.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Similarity {
    /// s ≥ 0.
    pub scale: f64,
    /// R by rows, never a reflection.
    pub rotation: [Vector3; 3],
    /// b.
    pub translation: Vector3,
}

impl Similarity {
    /// s R x + b.
    pub fn apply(&self, x: Vector3) -> Vector3 {
        rotate(self.rotation, x) * self.scale + self.translation
    }
}

/// The similarity that brings `from` (n, 3) nearest to `to` (n, 3): it minimizes Σ w_i |s R x_i + b − y_i|² (Horn 1987,
/// Umeyama 1991), `weights` w (n,) not negative and not all 0.
///
/// The scale is 1 where all of `from` is one point.
///
/// # Panics
/// Where the lengths differ.
pub fn similarity(from: &[Vector3], to: &[Vector3], weights: &[f64]) -> Similarity {
    assert!(from.len() == to.len() && from.len() == weights.len(), "as many points as weights");
    // 1. Center both and scale them to size 1, so that no square over- or underflows
    let (x, center, size) = centered(from, weights);
    let (y, to_center, to_size) = centered(to, weights);
    // 2. The best rotation, which does not depend on the scale, then the best scale for it
    let rotation = best_rotation(&x, &y, weights);
    let [along, square] = parallel::sums(x.len(), |v| {
        [weights[v] * rotate(rotation, x[v]).dot(y[v]), weights[v] * x[v].dot(x[v])]
    });
    let scale = if square > 0.0 { along.max(0.0) / square * (to_size / size) } else { 1.0 };
    // 3. Centroid to centroid
    let translation = to_center - rotate(rotation, center) * scale;
    Similarity { scale, rotation, translation }
}

/// The points relative to their centroid, divided by their largest coordinate; the centroid; that coordinate.
fn centered(points: &[Vector3], weights: &[f64]) -> (Vec<Vector3>, Vector3, f64) {
    let center = centroid(points, weights);
    let about = parallel::map(points.len(), |v| points[v] - center);
    let size = about.iter().fold(0.0, |most, x| f64::max(most, x.max_abs()));
    let size = if size > 0.0 { size } else { 1.0 };
    (parallel::map(about.len(), |v| about[v].map(|x| x / size)), center, size)
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::alignment::rotation::rotation_of;

    /// Numbers in [-1, 1) without order.
    fn number(i: usize) -> f64 {
        2.0 * (127.1 * i as f64 + 11.7).sin().abs().mul_add(43758.5453, 0.0).fract() - 1.0
    }

    /// Points without order.
    pub(crate) fn cloud(n: usize) -> Vec<Vector3> {
        (0..n).map(|i| Vector3([number(3 * i), 2.0 * number(3 * i + 1), 0.5 * number(3 * i + 2)])).collect()
    }

    #[test]
    fn a_known_similarity_is_recovered_at_any_size() {
        let points = cloud(50);
        let weights: Vec<f64> = (0..50).map(|i| 1.5 + number(i)).collect();
        for (scale, translation) in
            [(2.5, [3.0, -1.0, 7.0]), (1e-200, [0.0; 3]), (1e200, [1e201, 0.0, 0.0]), (1.0, [1e6, 2e6, 0.0])]
        {
            let translation = Vector3(translation);
            for turn in [[0.5, -0.1, 0.7, 0.5], [0.0, 1.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]] {
                let known = Similarity { scale, rotation: rotation_of(turn), translation };
                let moved: Vec<Vector3> = points.iter().map(|&x| known.apply(x)).collect();
                let computed = similarity(&points, &moved, &weights);
                let lost = 1e-15 * translation.max_abs().max(scale);
                assert!((computed.scale / scale - 1.0).abs() < 1e-12 + 10.0 * lost / scale);
                for (&x, &y) in points.iter().zip(&moved) {
                    let apart = (computed.apply(x) - y).map(|d| d / scale);
                    assert!(apart.distance(Vector3::ZERO) < 1e-12 + 10.0 * lost / scale);
                }
            }
        }
    }

    #[test]
    fn no_nearby_similarity_is_better() {
        let (from, to) = (cloud(30), cloud(60).split_off(30));
        let weights: Vec<f64> = (0..30).map(|i| 1.5 + number(i + 7)).collect();
        let cost = |s: &Similarity| -> f64 {
            (0..30).map(|v| weights[v] * s.apply(from[v]).distance(to[v]).powi(2)).sum()
        };
        let best = similarity(&from, &to, &weights);
        let least = cost(&best);
        for i in 0..200 {
            let angle = |k: usize| 0.02 * number(8 * i + k);
            let [x, y, z] = [angle(0), angle(1), angle(2)];
            let nudge = rotation_of([(1.0 - x * x - y * y - z * z).sqrt(), x, y, z]);
            let rotation = std::array::from_fn(|row| {
                Vector3::from_fn(|column| (0..3).map(|k| nudge[row][k] * best.rotation[k][column]).sum())
            });
            let translation = best.translation + Vector3([angle(3), angle(4), angle(5)]);
            let nearby = Similarity { scale: best.scale * (1.0 + angle(6)), rotation, translation };
            assert!(cost(&nearby) > least);
        }
    }

    #[test]
    fn a_reflection_is_not_found() {
        let points = cloud(40);
        let mirrored: Vec<Vector3> = points.iter().map(|&Vector3([x, y, z])| Vector3([-x, y, z])).collect();
        let rows = similarity(&points, &mirrored, &[1.0; 40]).rotation;
        let determinant = rows[0].dot(rows[1].cross(rows[2]));
        assert!((determinant - 1.0).abs() < 1e-12);
        let collapsed = similarity(&points, &[Vector3([1.0, 2.0, 3.0]); 40], &[1.0; 40]);
        assert_eq!((collapsed.scale, collapsed.translation), (0.0, Vector3([1.0, 2.0, 3.0])));
        assert_eq!(similarity(&[Vector3([1.0; 3]); 2], &[Vector3([3.0; 3]); 2], &[1.0; 2]).scale, 1.0);
    }
}
