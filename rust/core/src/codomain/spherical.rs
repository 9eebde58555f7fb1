// SPDX-License-Identifier: MIT OR Apache-2.0
//! Points of the unit sphere.

use crate::vector::{Vector, dot, norm, scaled};

/// The point of the sphere in the direction of `x`, `None` at the origin.
pub(crate) fn onto_sphere(x: Vector) -> Option<Vector> {
    // by the largest coordinate first, so that squares neither over- nor underflow
    let largest = x.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
    if (dot(x, x) - 1.0).abs() <= 4.0 * f64::EPSILON {
        return Some(x);
    }
    let x = scaled(x, 1.0 / largest);
    (largest > 0.0 && x.iter().all(|c| c.is_finite())).then(|| scaled(x, 1.0 / norm(x)))
}
