// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tells symmetric parts of a surface apart, so that neither rounding nor the numbering chooses between them.
//!
//! A choice of the best of many vertices or faces has ties wherever the surface is its own mirror image, and which one
//! wins would depend on the last bit. So every vertex gets a preference that is a linear function of its place along
//! three directions of the surface itself: its third moment, the image of that under the covariance, and their cross
//! product, which is normal to a plane of symmetry. It turns with the surface, does not depend on the order of vertices,
//! and changes smoothly. A value times one plus [`SHARE`] of it is a value without such ties.
//!
//! Surfaces with more symmetry than a mirror plane have fewer directions; among what these do not tell apart the lowest
//! index has to decide.

use crate::parallel;
use crate::vector::{Vector, add, cross, dot, norm, scaled, sub};

/// By how much at the most a preference changes a value: more than noise does, less than matters.
const SHARE: f64 = 1e-6;

/// A direction shorter than this, in units of the size of the surface, is none.
const NO_DIRECTION: f64 = 1e-9;

/// What to multiply a value at each of the points (n, 3) by, near 1.
pub(crate) fn tie_breakers(points: &[Vector]) -> Vec<f64> {
    let n = points.len();
    let mean = |value: &(dyn Fn(Vector) -> Vector + Sync)| -> Vector {
        let sums = parallel::sums(n, |v| value(points[v]));
        scaled(sums, 1.0 / n as f64)
    };
    // 1. Centered, of unit size
    let center = mean(&|x| x);
    let size = parallel::sum(n, |v| dot(sub(points[v], center), sub(points[v], center)) / n as f64).sqrt();
    let local = |x: Vector| scaled(sub(x, center), 1.0 / size.max(f64::MIN_POSITIVE));
    // 2. The directions of the surface
    let skewness = mean(&|x| scaled(local(x), dot(local(x), local(x))));
    let stretched = mean(&|x| scaled(local(x), dot(local(x), skewness)));
    let across = sub(stretched, scaled(skewness, dot(stretched, skewness) / dot(skewness, skewness)));
    let directions = [skewness, across, cross(skewness, across)].map(unit);
    // 3. A generic combination
    let [a, b, c] = directions;
    let generic = add(scaled(a, 0.5), add(scaled(b, 0.31), scaled(c, 0.19)));
    parallel::map(n, |v| 1.0 + SHARE * dot(local(points[v]), generic).tanh())
}

/// The unit vector along `x`, or none.
fn unit(x: Vector) -> Vector {
    let length = norm(x);
    // also where it is no number
    if length > NO_DIRECTION { scaled(x, 1.0 / length) } else { [0.0; 3] }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pairs of mirrored points, one above the other in the list.
    fn mirrored() -> Vec<Vector> {
        let half = (0..20).map(f64::from).map(|k| [1.0 + k.sin().abs(), k.cos() + 0.1 * k, (2.0 * k).sin()]);
        half.flat_map(|[x, y, z]| [[x, y, z], [-x, y, z]]).collect()
    }

    #[test]
    fn mirrored_points_differ_by_more_than_noise() {
        let values = tie_breakers(&mirrored());
        for pair in values.chunks(2) {
            assert!((pair[0] - pair[1]).abs() > 1e-8, "{pair:?}");
            assert!((pair[0] - 1.0).abs() <= SHARE);
        }
    }

    #[test]
    fn preferences_turn_with_the_points_and_do_not_know_their_order() {
        let points = mirrored();
        let values = tie_breakers(&points);
        let turned: Vec<Vector> =
            points.iter().rev().map(|&[x, y, z]| [0.6 * x - 0.8 * z + 3.0, 0.8 * x + 0.6 * z, -y]).collect();
        // x, y, z ↦ x', z', −y is a rotation
        for (value, turned) in values.iter().rev().zip(tie_breakers(&turned)) {
            assert!((value - turned).abs() < 1e-14, "{value} {turned}");
        }
    }

    #[test]
    fn points_without_directions_are_all_alike() {
        let octahedron =
            [[1., 0., 0.], [-1., 0., 0.], [0., 1., 0.], [0., -1., 0.], [0., 0., 1.], [0., 0., -1.]];
        assert_eq!(tie_breakers(&octahedron), vec![1.0; 6]);
        assert_eq!(tie_breakers(&[[1.0; 3]; 4]), vec![1.0; 4]);
    }
}
