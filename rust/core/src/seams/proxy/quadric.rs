// SPDX-License-Identifier: MIT OR Apache-2.0
//! Quadrics: weighted sums of the squared distances from planes, as functions of a point.

use std::ops::AddAssign;

use crate::vector::Vector3;

/// x ↦ xᵀ A x + 2 b·x + c with a symmetric matrix A.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Quadric {
    /// A₀₀, A₁₁, A₂₂, A₀₁, A₀₂, A₁₂.
    matrix: [f64; 6],
    linear: [f64; 3],
    constant: f64,
}

impl Quadric {
    /// `weight` times the squared distance from the plane through `point` with the unit normal `normal`.
    pub(super) fn of_plane(point: Vector3, normal: Vector3, weight: f64) -> Self {
        let Vector3([x, y, z]) = normal;
        let offset = -normal.dot(point);
        Self {
            matrix: [x * x, y * y, z * z, x * y, x * z, y * z].map(|entry| weight * entry),
            linear: [x, y, z].map(|entry| weight * offset * entry),
            constant: weight * offset * offset,
        }
    }

    /// The value at a point; not negative but for rounding.
    pub(super) fn at(&self, Vector3([x, y, z]): Vector3) -> f64 {
        let ([xx, yy, zz, xy, xz, yz], [bx, by, bz]) = (self.matrix, self.linear);
        let quadratic = x * (xx * x + 2.0 * (xy * y + xz * z)) + y * (yy * y + 2.0 * yz * z) + zz * z * z;
        quadratic + 2.0 * (bx * x + by * y + bz * z) + self.constant
    }
}

impl AddAssign for Quadric {
    fn add_assign(&mut self, other: Self) {
        (0..6).for_each(|k| self.matrix[k] += other.matrix[k]);
        (0..3).for_each(|k| self.linear[k] += other.linear[k]);
        self.constant += other.constant;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quadric_sums_squared_distances() {
        let point = |k: f64| Vector3([k.sin(), (2.0 * k).cos(), 0.3 * k]);
        let planes = [1.0, 2.0, 5.0].map(|k| (point(k), point(k + 0.5).normalized(), k));
        let mut quadric = Quadric::default();
        planes
            .iter()
            .for_each(|&(through, normal, weight)| quadric += Quadric::of_plane(through, normal, weight));
        for x in [0.1, 3.0, 7.0].map(point) {
            let squares = planes.iter().map(|&(through, normal, w)| w * (x - through).dot(normal).powi(2));
            assert!((quadric.at(x) - squares.sum::<f64>()).abs() < 1e-13);
        }
    }
}
