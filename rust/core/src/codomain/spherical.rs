// SPDX-License-Identifier: MIT OR Apache-2.0
//! Points of the unit sphere.

use crate::vector::Vector3;

/// The point of the sphere in the direction of `x`, `None` at the origin.
pub(crate) fn onto_sphere(x: Vector3) -> Option<Vector3> {
    // divide by the largest coordinate first, so that squares neither over- nor underflow
    let largest = x.max_abs();
    if (x.dot(x) - 1.0).abs() <= 4.0 * f64::EPSILON {
        return Some(x);
    }
    let x = x * (1.0 / largest);
    (largest > 0.0 && x.is_finite()).then(|| x.normalized())
}
