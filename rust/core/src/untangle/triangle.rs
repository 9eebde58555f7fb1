// SPDX-License-Identifier: MIT OR Apache-2.0
//! Areas of triangles in the plane, with their derivatives.

/// A Hessian by the coordinates of a face's corners.
pub(super) type Hessian = [[f64; 6]; 6];

/// The corners of a face in the chart of a patch.
pub(super) type Corners = [[f64; 2]; 3];

/// Twice the signed area of a face, and its gradient by the coordinates of the corners.
pub(super) fn doubled_area([a, b, c]: Corners) -> (f64, [f64; 6]) {
    let doubled = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    (doubled, [b[1] - c[1], c[0] - b[0], c[1] - a[1], a[0] - c[0], a[1] - b[1], b[0] - a[0]])
}

/// Adds `factor` times the Hessian of twice the signed area of a face.
pub(super) fn add_area_curvature(hessian: &mut Hessian, factor: f64) {
    for corner in 0..3 {
        let next = (corner + 1) % 3;
        for (i, j, sign) in [(0, 1, 1.0), (1, 0, -1.0)] {
            hessian[2 * corner + i][2 * next + j] += sign * factor;
            hessian[2 * next + j][2 * corner + i] += sign * factor;
        }
    }
}

/// Adds the positive semidefinite part of −`factor` times the Hessian of twice the signed area, for `factor` ≥ 0.
///
/// In complex coordinates the area of a triangle is diagonal in the Fourier modes of its corners: mode 1, the
/// counterclockwise equilateral triangle, has the eigenvalue √3, mode 2 has −√3, and translations have 0.
pub(super) fn add_less_area_curvature(hessian: &mut Hessian, factor: f64) {
    let eigenvalue = factor * 3f64.sqrt() / 3.0;
    // cosine and sine of −2π/3 times the difference of the corners' numbers
    let turns = [[1.0, 0.0], [-0.5, -0.5 * 3f64.sqrt()], [-0.5, 0.5 * 3f64.sqrt()]];
    for a in 0..3 {
        for b in 0..3 {
            let [cosine, sine] = turns[(3 + a - b) % 3].map(|x| eigenvalue * x);
            hessian[2 * a][2 * b] += cosine;
            hessian[2 * a + 1][2 * b + 1] += cosine;
            hessian[2 * a][2 * b + 1] -= sine;
            hessian[2 * a + 1][2 * b] += sine;
        }
    }
}

/// Adds `factor` (u vᵀ + v uᵀ)/2.
pub(super) fn add_symmetric(hessian: &mut Hessian, factor: f64, u: &[f64; 6], v: &[f64; 6]) {
    for row in 0..6 {
        (0..6).for_each(|column| {
            hessian[row][column] += 0.5 * factor * (u[row] * v[column] + v[row] * u[column])
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::clamp_negative_eigenvalues;

    #[test]
    fn the_curvature_of_areas_is_that_of_differences_and_splits_into_two_parts() {
        let mut hessian = [[0.0; 6]; 6];
        add_area_curvature(&mut hessian, 1.0);
        let corners = [[0.1, 0.2], [1.3, 0.1], [0.4, 1.5]];
        let (_, gradient) = doubled_area(corners);
        for k in 0..6 {
            let mut moved = corners;
            moved[k / 2][k % 2] += 1.0;
            let (_, there) = doubled_area(moved);
            (0..6).for_each(|j| assert!((there[j] - gradient[j] - hessian[j][k]).abs() < 1e-14));
        }
        let mut clamped = hessian.map(|row| row.map(|x| -x));
        clamp_negative_eigenvalues(&mut clamped);
        let mut direct = [[0.0; 6]; 6];
        add_less_area_curvature(&mut direct, 1.0);
        for row in 0..6 {
            (0..6).for_each(|column| assert!((clamped[row][column] - direct[row][column]).abs() < 1e-11));
        }
    }
}
