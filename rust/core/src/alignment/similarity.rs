// SPDX-License-Identifier: MIT OR Apache-2.0
//! The similarity that lays points best over others (Umeyama 1991).

use super::rotation::{best_rotation, centroid, rotate};
use crate::parallel;
use crate::vector::{Vector, add, dot, scaled, sub};

/// A motion of space with a change of scale: x ↦ s R x + b.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Similarity {
    /// s ≥ 0.
    pub scale: f64,
    /// R by rows, never a reflection.
    pub rotation: [Vector; 3],
    /// b.
    pub translation: Vector,
}

impl Similarity {
    /// s R x + b.
    pub fn apply(&self, x: Vector) -> Vector {
        add(scaled(rotate(self.rotation, x), self.scale), self.translation)
    }
}

/// The similarity that brings `from` (n, 3) nearest to `to` (n, 3): it minimises Σ w_i |s R x_i + b − y_i|² (Horn 1987,
/// Umeyama 1991), `weights` w (n,) not negative and not all 0.
///
/// Where all of `from` is one point, the scale is 1.
///
/// # Panics
/// Where the lengths differ.
pub fn similarity(from: &[Vector], to: &[Vector], weights: &[f64]) -> Similarity {
    assert!(from.len() == to.len() && from.len() == weights.len(), "as many points as weights");
    // 1. Both about their centroids, and of size 1: no square over- or underflows.
    let (x, centre, size) = centred(from, weights);
    let (y, to_centre, to_size) = centred(to, weights);
    // 2. The best rotation does not depend on the scale; the best scale for it is a quotient.
    let rotation = best_rotation(&x, &y, weights);
    let [along, square] = parallel::sums(x.len(), |v| {
        [weights[v] * dot(rotate(rotation, x[v]), y[v]), weights[v] * dot(x[v], x[v])]
    });
    let scale = if square > 0.0 { along.max(0.0) / square * (to_size / size) } else { 1.0 };
    // 3. Centroid to centroid.
    let translation = sub(to_centre, scaled(rotate(rotation, centre), scale));
    Similarity { scale, rotation, translation }
}

/// Points about their centroid divided by their largest coordinate there, with both.
fn centred(points: &[Vector], weights: &[f64]) -> (Vec<Vector>, Vector, f64) {
    let centre = centroid(points, weights);
    let about = parallel::map(points.len(), |v| sub(points[v], centre));
    let size = about.as_flattened().iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let size = if size > 0.0 { size } else { 1.0 };
    (parallel::map(about.len(), |v| about[v].map(|x| x / size)), centre, size)
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::alignment::rotation::rotation_of;
    use crate::vector::distance;

    /// Numbers in [-1, 1) without order.
    fn number(i: usize) -> f64 {
        2.0 * (127.1 * i as f64 + 11.7).sin().abs().mul_add(43758.5453, 0.0).fract() - 1.0
    }

    /// Points without order.
    pub(crate) fn cloud(n: usize) -> Vec<Vector> {
        (0..n).map(|i| [number(3 * i), 2.0 * number(3 * i + 1), 0.5 * number(3 * i + 2)]).collect()
    }

    #[test]
    fn a_known_similarity_is_recovered_at_any_size() {
        let points = cloud(50);
        let weights: Vec<f64> = (0..50).map(|i| 1.5 + number(i)).collect();
        for (scale, translation) in
            [(2.5, [3.0, -1.0, 7.0]), (1e-200, [0.0; 3]), (1e200, [1e201, 0.0, 0.0]), (1.0, [1e6, 2e6, 0.0])]
        {
            for turn in [[0.5, -0.1, 0.7, 0.5], [0.0, 1.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]] {
                let known = Similarity { scale, rotation: rotation_of(turn), translation };
                let moved: Vec<Vector> = points.iter().map(|&x| known.apply(x)).collect();
                let found = similarity(&points, &moved, &weights);
                let lost = 1e-15 * translation.iter().fold(scale, |most: f64, x| most.max(x.abs()));
                assert!((found.scale / scale - 1.0).abs() < 1e-12 + 10.0 * lost / scale);
                for (&x, &y) in points.iter().zip(&moved) {
                    let apart = sub(found.apply(x), y).map(|d| d / scale);
                    assert!(distance(apart, [0.0; 3]) < 1e-12 + 10.0 * lost / scale);
                }
            }
        }
    }

    #[test]
    fn no_nearby_similarity_is_better() {
        let (from, to) = (cloud(30), cloud(60).split_off(30));
        let weights: Vec<f64> = (0..30).map(|i| 1.5 + number(i + 7)).collect();
        let cost = |s: &Similarity| -> f64 {
            (0..30).map(|v| weights[v] * distance(s.apply(from[v]), to[v]).powi(2)).sum()
        };
        let best = similarity(&from, &to, &weights);
        let least = cost(&best);
        for i in 0..200 {
            let angle = |k: usize| 0.02 * number(8 * i + k);
            let [x, y, z] = [angle(0), angle(1), angle(2)];
            let nudge = rotation_of([(1.0 - x * x - y * y - z * z).sqrt(), x, y, z]);
            let rotation = std::array::from_fn(|row| {
                std::array::from_fn(|column| (0..3).map(|k| nudge[row][k] * best.rotation[k][column]).sum())
            });
            let translation = add(best.translation, [angle(3), angle(4), angle(5)]);
            let nearby = Similarity { scale: best.scale * (1.0 + angle(6)), rotation, translation };
            assert!(cost(&nearby) > least);
        }
    }

    #[test]
    fn a_reflection_is_not_found() {
        let points = cloud(40);
        let mirrored: Vec<Vector> = points.iter().map(|&[x, y, z]| [-x, y, z]).collect();
        let rows = similarity(&points, &mirrored, &[1.0; 40]).rotation;
        let determinant = dot(rows[0], crate::vector::cross(rows[1], rows[2]));
        assert!((determinant - 1.0).abs() < 1e-12);
        let collapsed = similarity(&points, &[[1.0, 2.0, 3.0]; 40], &[1.0; 40]);
        assert_eq!((collapsed.scale, collapsed.translation), (0.0, [1.0, 2.0, 3.0]));
        assert_eq!(similarity(&[[1.0; 3]; 2], &[[3.0; 3]; 2], &[1.0; 2]).scale, 1.0);
    }
}
