// SPDX-License-Identifier: MIT OR Apache-2.0
//! The energy of one face: its Jacobian, and the terms of its Hessian.

/// β of f.
pub(super) const STIFFENING: f64 = 0.1;

/// The matrix of a face over the two unknowns of each of its corners.
pub(super) type Element = [[f64; 6]; 6];

/// The linear map of a face.
#[derive(Clone, Copy)]
pub(super) struct Jacobian {
    /// (a, b, c, d).
    pub entries: [f64; 4],
    pub ratio: f64,
}

impl Jacobian {
    /// The derivatives of the determinant.
    pub(super) fn cofactors(&self) -> [f64; 4] {
        let [a, b, c, d] = self.entries;
        [d, -c, -b, a]
    }

    /// m − 1.
    pub(super) fn shear(&self) -> f64 {
        let [a, b, c, d] = self.entries;
        0.5 * ((a - d).powi(2) + (b + c).powi(2)) / self.ratio
    }

    /// The derivatives of m − 1.
    pub(super) fn shear_slopes(&self) -> [f64; 4] {
        let [a, b, c, d] = self.entries;
        let (along, cofactors) = ([a - d, b + c, b + c, d - a], self.cofactors());
        let shear = self.shear();
        std::array::from_fn(|k| (along[k] - shear * cofactors[k]) / self.ratio)
    }

    /// The rows W of the Hessian Wᵀ W of m − 1 where ρ is taken for linear.
    pub(super) fn quadratic_over_linear(&self, cofactors: &[f64; 4]) -> [[f64; 4]; 2] {
        let [a, b, c, d] = self.entries;
        let root = self.ratio.sqrt();
        let row = |along: [f64; 4], length: f64| {
            std::array::from_fn(|k| along[k] / root - length / (self.ratio * root) * cofactors[k])
        };
        [row([1.0, 0.0, 0.0, -1.0], a - d), row([0.0, 1.0, 1.0, 0.0], b + c)]
    }
}

/// f.
pub(super) fn stiffened(shear: f64) -> f64 {
    shear + 0.5 * STIFFENING * shear * shear
}

/// Adds `factor` times the square of a linear form in the entries of the Jacobian.
pub(super) fn add_square(element: &mut Element, factor: f64, hats: &[[f64; 2]; 3], form: &[f64; 4]) {
    let row: [f64; 6] = std::array::from_fn(|k| {
        let (g, axis) = (hats[k / 2], k % 2);
        form[2 * axis] * g[0] + form[2 * axis + 1] * g[1]
    });
    for i in 0..6 {
        for j in 0..6 {
            element[i][j] += factor * row[i] * row[j];
        }
    }
}

/// Adds `factor` times the second derivative of the determinant of the Jacobian.
pub(super) fn add_area_curvature(element: &mut Element, factor: f64, hats: &[[f64; 2]; 3]) {
    for i in 0..3 {
        for j in 0..3 {
            let twist = factor * (hats[i][0] * hats[j][1] - hats[i][1] * hats[j][0]);
            element[2 * i][2 * j + 1] += twist;
            element[2 * j + 1][2 * i] += twist;
        }
    }
}

/// Adds `factor` times the squared length of the Jacobian.
pub(super) fn add_dirichlet(element: &mut Element, factor: f64, hats: &[[f64; 2]; 3]) {
    for i in 0..3 {
        for j in 0..3 {
            let product = factor * (hats[i][0] * hats[j][0] + hats[i][1] * hats[j][1]);
            element[2 * i][2 * j] += product;
            element[2 * i + 1][2 * j + 1] += product;
        }
    }
}
