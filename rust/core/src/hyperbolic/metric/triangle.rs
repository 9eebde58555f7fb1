// SPDX-License-Identifier: MIT OR Apache-2.0
//! The angles of a hyperbolic triangle with given sides, and their derivatives.
//!
//! Half-angle formulas throughout: the cosine laws lose half of the digits of a small or thin triangle. Sides
//! that violate the triangle inequality have the angles π, 0, 0 of a triangle without area; so extended, angles
//! are continuous functions of all sides, and the curvatures that they add up to remain the gradient of a convex
//! function (F. Luo, Rigidity of polyhedral surfaces III, Geometry & Topology 15, 2011).

use std::f64::consts::PI;

/// The angle opposite to each side.
pub(super) fn angles([a, b, c]: [f64; 3]) -> [f64; 3] {
    // half the excess of the two other sides over each side
    let slack = [0.5 * (b - a + c), 0.5 * (c - b + a), 0.5 * (a - c + b)];
    if let Some(longest) = (0..3).find(|&k| slack[k].is_nan() || slack[k] <= 0.0) {
        return std::array::from_fn(|k| if k == longest { PI } else { 0.0 });
    }
    let half_perimeter = (0.5 * (a + b + c)).sinh();
    let [x, y, z] = slack.map(f64::sinh);
    let angle =
        |opposite: f64, b: f64, c: f64| 2.0 * (b * c).sqrt().atan2((half_perimeter * opposite).sqrt());
    [angle(x, y, z), angle(y, z, x), angle(z, x, y)]
}

/// Whether the angles are those of sides that form no triangle.
pub(super) fn is_degenerate(angles: &[f64; 3]) -> bool {
    smallest(angles) == 0.0
}

/// The smallest of three angles.
pub(super) fn smallest(angles: &[f64; 3]) -> f64 {
    angles[0].min(angles[1]).min(angles[2])
}

/// The derivative of each angle (row) by each side (column); zero for sides that form no triangle.
pub(super) fn angle_derivatives(sides: [f64; 3], angles: &[f64; 3]) -> [[f64; 3]; 3] {
    if is_degenerate(angles) {
        return [[0.0; 3]; 3];
    }
    let sinh = sides.map(f64::sinh);
    let largest = (0..3).fold(0, |best, k| if angles[k] > angles[best] { k } else { best });
    // equal for every angle, but the sine of an angle next to π has lost digits
    let k = (largest + 1) % 3;
    let volume = sinh[(k + 1) % 3] * sinh[(k + 2) % 3] * angles[k].sin();
    let cosines = angles.map(f64::cos);
    std::array::from_fn(|i| {
        std::array::from_fn(
            |j| if i == j { sinh[i] / volume } else { -cosines[3 - i - j] * sinh[i] / volume },
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Sides of triangles, small and large, some of them thin.
    fn sides() -> impl Strategy<Value = [f64; 3]> {
        (1e-3..3.0_f64, 0.05..1.0_f64, 0.02..0.98_f64).prop_map(|(scale, ratio, share)| {
            let [a, b] = [scale, ratio * scale];
            [a, b, (a - b) + 2.0 * share * b]
        })
    }

    proptest! {
        #[test]
        fn angles_satisfy_the_cosine_law(sides in sides()) {
            let angles = angles(sides);
            let [a, b, c] = sides;
            let cosine = (b.cosh() * c.cosh() - a.cosh()) / (b.sinh() * c.sinh());
            prop_assert!((angles[0].cos() - cosine).abs() < 1e-7);
            prop_assert!(angles.iter().sum::<f64>() < PI);
            prop_assert!(!is_degenerate(&angles));
        }

        #[test]
        fn derivatives_are_those_of_differences(sides in sides()) {
            let exact = angle_derivatives(sides, &angles(sides));
            let size = exact.as_flattened().iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            let step = 1e-6 * sides[1].min(sides[2]);
            for (row, column) in (0..9).map(|entry| (entry / 3, entry % 3)) {
                let moved = |by: f64| angles(std::array::from_fn(|k| sides[k] + if k == column { by } else { 0.0 }));
                let difference = (moved(step)[row] - moved(-step)[row]) / (2.0 * step);
                prop_assert!((difference - exact[row][column]).abs() < 1e-6 * size);
            }
        }
    }

    #[test]
    fn sides_without_a_triangle_have_straight_angles() {
        assert_eq!(angles([1.0, 2.5, 1.0]), [0.0, PI, 0.0]);
        assert_eq!(angles([2.0, 1.0, 1.0]), [PI, 0.0, 0.0]);
        assert!(is_degenerate(&angles([1.0, 1.0, 3.0])));
        assert_eq!(angle_derivatives([1.0, 1.0, 3.0], &angles([1.0, 1.0, 3.0])), [[0.0; 3]; 3]);
    }

    #[test]
    fn an_equilateral_triangle_is_as_known() {
        // sin(θ/2) cosh(l/2) = 1/2
        let side = 2.0 * (0.5 / (PI / 8.0).sin()).acosh();
        for angle in angles([side; 3]) {
            assert!((angle - PI / 4.0).abs() < 1e-14);
        }
    }
}
