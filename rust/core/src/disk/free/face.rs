// SPDX-License-Identifier: MIT OR Apache-2.0
//! The energy of one face: its Jacobian, and the terms of its Hessian.
//!
//! Without its negative eigenvalues, the Hessian is the sum of squares of B. Smith, F. de Goes and T. Kim, Analytic
//! eigensystems for isotropic distortion energies, ACM Trans. Graph. 38 (2019): with J = U diag(σ₁, σ₂) Vᵀ, its
//! eigenvectors are U D Vᵀ, where D turns, mirrors, or stretches along the axes.

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

    /// The singular values with the rotations U and Vᵀ, each as its cosine and sine.
    fn decomposed(&self) -> Decomposition {
        let [a, b, c, d] = self.entries;
        let (similar, mirrored) = ([0.5 * (a + d), 0.5 * (c - b)], [0.5 * (a - d), 0.5 * (b + c)]);
        let largest = similar[0].hypot(similar[1]) + mirrored[0].hypot(mirrored[1]);
        let [sum, difference] = [similar, mirrored].map(|[x, y]| y.atan2(x));
        let rotation = |angle: f64| [angle.cos(), angle.sin()];
        Decomposition {
            values: [largest, self.ratio / largest],
            left: rotation(0.5 * (sum + difference)),
            right: rotation(0.5 * (sum - difference)),
        }
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

/// A singular value decomposition.
struct Decomposition {
    /// σ₁ and σ₂.
    values: [f64; 2],
    /// The cosine and sine of the rotations U and Vᵀ.
    left: [f64; 2],
    right: [f64; 2],
}

impl Decomposition {
    /// U D Vᵀ.
    fn rotated(&self, [x, y, z, w]: [f64; 4]) -> [f64; 4] {
        let ([c, s], [u, v]) = (self.left, self.right);
        let [p, q, r, t] = [c * x - s * z, c * y - s * w, s * x + c * z, s * y + c * w];
        [p * u + q * v, q * u - p * v, r * u + t * v, t * u - r * v]
    }
}

/// The first and second derivatives of the energy of a face by its area ratio, and by m.
pub(super) struct Derivatives {
    pub by_area: [f64; 2],
    pub by_shear: [f64; 2],
}

/// Adds `factor` times the Hessian of a face without its negative eigenvalues.
pub(super) fn add_positive_part(
    element: &mut Element,
    factor: f64,
    hats: &[[f64; 2]; 3],
    jacobian: &Jacobian,
    derivatives: &Derivatives,
) {
    let ([first, second], rho) = ([0, 1].map(|k| derivatives.by_shear[k]), jacobian.ratio);
    let [stress, stiffness] = derivatives.by_area;
    let parts = jacobian.decomposed();
    let [s, t] = parts.values;
    let mut add = |value: f64, form: [f64; 4]| {
        if value > 0.0 {
            add_square(element, factor * value, hats, &parts.rotated(form));
        }
    };
    // 1. Turning and mirroring
    let root = std::f64::consts::FRAC_1_SQRT_2;
    add(stress - 0.5 * first * ((s - t) / rho).powi(2), [0.0, -root, root, 0.0]);
    add(0.5 * first * ((s + t) / rho).powi(2) - stress, [0.0, root, root, 0.0]);
    // 2. Stretching: m = ½ (s/t + t/s), ρ = s t
    let slopes = [0.5 * (1.0 / t - t / (s * s)), 0.5 * (1.0 / s - s / (t * t))];
    let mixed = -0.5 * (1.0 / (t * t) + 1.0 / (s * s));
    let along = stiffness * t * t + second * slopes[0] * slopes[0] + first * t / s.powi(3);
    let across = stiffness * s * s + second * slopes[1] * slopes[1] + first * s / t.powi(3);
    let both = stiffness * rho + stress + second * slopes[0] * slopes[1] + first * mixed;
    let (mean, half) = (0.5 * (along + across), 0.5 * (along - across));
    let radius = half.hypot(both);
    let (sine, cosine) = (0.5 * both.atan2(half)).sin_cos();
    add(mean + radius, [cosine, 0.0, 0.0, sine]);
    add(mean - radius, [-sine, 0.0, 0.0, cosine]);
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
