// SPDX-License-Identifier: MIT OR Apache-2.0
//! The energy of the linear map of a face: how far it is from an isometry.
//!
//! With the singular values σ₁ ≥ σ₂ of the map, a = ln σ₁ and b = ln σ₂, the energy is
//!
//! φ = cosh(a + b)^α cosh(a − b)^β,
//!
//! a product of how areas change and how angles do. For α = β = 1 it is the symmetric Dirichlet energy over 4,
//! (σ₁² + σ₂² + σ₁⁻² + σ₂⁻²)/4. It is 1 for isometries and infinite for maps that collapse the face.
//!
//! The inverse has the same φ, on the area of the image. If both count, a face has (φ − 1)(1 + σ₁σ₂)/2 + 1: the mean of
//! the two but for the area of the image, whose sum is that of the target, and which flat images cut short.
//!
//! The Hessian comes without its negative eigenvalues, in closed form (B. Smith, F. de Goes and T. Kim, Analytic
//! eigensystems for isotropic distortion energies, ACM Trans. Graph. 38, 2019). The image lies in space, so that J is
//! 3 × 2: besides the modes of the plane there are two that bend the face out of its plane.

use crate::vector::Vector3;

/// Least determinant of JᵀJ.
const LEAST_SQUARED_AREA: f64 = 1e-28;

/// Difference of the singular values, relative to the larger, below which they count as equal.
const EQUAL: f64 = 1e-6;

/// The columns of the linear map of a face, from its plane into space.
pub(super) type Jacobian = [Vector3; 2];

/// The gradients (in the plane of the face) of the functions that are 1 at one corner and 0 at the others.
pub(super) type Hats = [[f64; 2]; 3];

/// The exponents of the two factors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FaceEnergy {
    /// α, the exponent of the area factor (d + 1/d)/2, d = σ₁ σ₂.
    pub area_weight: f64,
    /// β, the exponent of the angle factor (σ₁/σ₂ + σ₂/σ₁)/2.
    pub angle_weight: f64,
    /// Whether a face counts by the mean of its own area and its image's, so that the inverse counts as much as the map.
    pub both_ways: bool,
}

/// An energy with its derivatives by the two unknowns of each corner.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Expansion {
    pub value: f64,
    pub gradient: [f64; 6],
    pub hessian: [[f64; 6]; 6],
}

impl Expansion {
    /// Adds `factor` times another.
    pub(super) fn add(&mut self, factor: f64, other: &Self) {
        self.value += factor * other.value;
        for i in 0..6 {
            self.gradient[i] += factor * other.gradient[i];
            for j in 0..6 {
                self.hessian[i][j] += factor * other.hessian[i][j];
            }
        }
    }

    /// Adds `factor` times the square of a linear form to the Hessian.
    pub(super) fn add_square(&mut self, factor: f64, row: &[f64; 6]) {
        for (entries, x) in self.hessian.iter_mut().zip(row) {
            let scaled = factor * x;
            entries.iter_mut().zip(row).for_each(|(entry, y)| *entry += scaled * y);
        }
    }
}

/// JᵀJ as (xx, xy, yy).
pub(super) fn gram(jacobian: &Jacobian) -> [f64; 3] {
    let [x, y] = *jacobian;
    [x.dot(x), x.dot(y), y.dot(y)]
}

/// The linear map that takes the corners of a face to `images`.
pub(super) fn jacobian(hats: &Hats, images: [Vector3; 3]) -> Jacobian {
    [0, 1].map(|axis| (0..3).map(|corner| images[corner] * hats[corner][axis]).sum())
}

impl FaceEnergy {
    /// φ of a map with this JᵀJ.
    pub(super) fn value(&self, gram: [f64; 3]) -> f64 {
        let value = self.value_one_way(gram);
        if !self.both_ways {
            return value;
        }
        let [xx, xy, yy] = gram;
        let ratio = (xx * yy - xy * xy).max(LEAST_SQUARED_AREA).sqrt();
        1.0 + (value - 1.0) * 0.5 * (1.0 + ratio)
    }

    /// φ where a face counts by its own area.
    fn value_one_way(&self, [xx, xy, yy]: [f64; 3]) -> f64 {
        let square = (xx * yy - xy * xy).max(LEAST_SQUARED_AREA);
        if self.is_dirichlet() {
            return 0.25 * (xx + yy) * (1.0 + 1.0 / square);
        }
        let ratio = square.sqrt();
        let area = 0.5 * (ratio + 1.0 / ratio);
        let angle = (0.5 * (xx + yy) / ratio).max(1.0);
        raised(area, self.area_weight) * raised(angle, self.angle_weight)
    }

    /// Whether φ is the symmetric Dirichlet energy over 4, whose values take no powers.
    fn is_dirichlet(&self) -> bool {
        self.area_weight == 1.0 && self.angle_weight == 1.0
    }

    /// φ with its derivatives, and the derivatives of φ by the entries (xx, xy, yy) of JᵀJ.
    ///
    /// `moves[k][d]` is the velocity of the image of corner k along its unknown d.
    pub(super) fn expansion(
        &self,
        jacobian: &Jacobian,
        hats: &Hats,
        moves: &[[Vector3; 2]; 3],
    ) -> (Expansion, [f64; 3]) {
        let parts = decomposed(jacobian);
        let along = hats.map(|hat| parts.right.map(|v| hat[0] * v[0] + hat[1] * v[1]));
        let changes = std::array::from_fn(|i| {
            let velocity = moves[i / 2][i % 2];
            parts.left.map(|u| along[i / 2].map(|x| u.dot(velocity) * x))
        });
        let slopes = self.slopes(parts.values);
        (expanded(&slopes, parts.values, &changes), parts.by_gram(slopes.first))
    }

    /// φ with its derivatives by six unknowns, along which J changes by `changes`.
    pub(super) fn expansion_along(&self, jacobian: &Jacobian, changes: &[Jacobian; 6]) -> Expansion {
        let parts = decomposed(jacobian);
        let in_parts = changes.map(|[x, y]| {
            parts.left.map(|u| {
                let (x, y) = (u.dot(x), u.dot(y));
                parts.right.map(|v| x * v[0] + y * v[1])
            })
        });
        expanded(&self.slopes(parts.values), parts.values, &in_parts)
    }

    /// φ and its derivatives by the singular values.
    fn slopes(&self, values: [f64; 2]) -> Slopes {
        let slopes = self.slopes_one_way(values);
        if self.both_ways { slopes.both_ways(values) } else { slopes }
    }

    /// Those where a face counts by its own area.
    fn slopes_one_way(&self, [s, t]: [f64; 2]) -> Slopes {
        if self.is_dirichlet() {
            return dirichlet_slopes([s, t]);
        }
        let (area, angle) = (self.area_weight, self.angle_weight);
        let (sum, difference) = ((s * t).ln(), (s / t).ln());
        let value = raised(sum.cosh(), area) * raised(difference.cosh(), angle);
        let (by_area, by_angle) = (sum.tanh(), difference.tanh());
        let (x, y) = (area * by_area + angle * by_angle, area * by_area - angle * by_angle);
        let (bent, sheared) = (area * (1.0 - by_area * by_area), angle * (1.0 - by_angle * by_angle));
        Slopes {
            value,
            first: [value * x / s, value * y / t],
            second: [
                value * (x * x + bent + sheared - x) / (s * s),
                value * (y * y + bent + sheared - y) / (t * t),
            ],
            mixed: value * (x * y + bent - sheared) / (s * t),
        }
    }
}

/// φ with its derivatives by unknowns along which UᵀJV changes by `changes`, the third row the one out of the plane.
fn expanded(slopes: &Slopes, values: [f64; 2], changes: &[[[f64; 2]; 3]; 6]) -> Expansion {
    let mut expansion = Expansion { value: slopes.value, ..Default::default() };
    // 1. The motion of the face along each pair of directions, left and right
    let mut rows = [[0.0; 6]; 6];
    for (i, [first, second, out]) in changes.iter().enumerate() {
        let [xx, yy] = [first[0], second[1]];
        expansion.gradient[i] = slopes.first[0] * xx + slopes.first[1] * yy;
        let turned = [second[0] - first[1], second[0] + first[1]];
        let [turned, mirrored] = turned.map(|x| x * std::f64::consts::FRAC_1_SQRT_2);
        let motions = [xx, yy, turned, mirrored, out[0], out[1]];
        motions.into_iter().enumerate().for_each(|(mode, x)| rows[mode][i] = x);
    }
    // 2. Their curvatures
    for (factor, row) in slopes.modes(values, &rows) {
        if factor > 0.0 {
            expansion.add_square(factor, &row);
        }
    }
    expansion
}

fn dirichlet_slopes(values: [f64; 2]) -> Slopes {
    let inverse = values.map(|s| 1.0 / (s * s));
    Slopes {
        value: 0.25 * (0..2).map(|k| values[k] * values[k] + inverse[k]).sum::<f64>(),
        first: [0, 1].map(|k| 0.5 * (values[k] - inverse[k] / values[k])),
        second: inverse.map(|x| 0.5 + 1.5 * x * x),
        mixed: 0.0,
    }
}

/// A power; exponents 0 and 1 without rounding.
fn raised(base: f64, exponent: f64) -> f64 {
    if exponent == 1.0 { base } else { base.powf(exponent) }
}

/// The cosine and the sine of half the angle of the vector (x, y), between −π/2 and π/2.
fn half_angle(x: f64, y: f64) -> [f64; 2] {
    let length = (x * x + y * y).sqrt();
    if length == 0.0 {
        return [1.0, 0.0];
    }
    let larger = (0.5 * (1.0 + x.abs() / length)).sqrt();
    let smaller = 0.5 * y / (length * larger);
    if x >= 0.0 { [larger, smaller] } else { [smaller.abs(), larger.copysign(y)] }
}

/// φ and its derivatives by σ₁ and σ₂.
struct Slopes {
    value: f64,
    first: [f64; 2],
    second: [f64; 2],
    mixed: f64,
}

impl Slopes {
    /// Those of 1 + (φ − 1)(1 + σ₁σ₂)/2.
    fn both_ways(&self, [s, t]: [f64; 2]) -> Self {
        let half = 0.5 * (1.0 + s * t);
        let excess = self.value - 1.0;
        let [p, q] = self.first;
        let [along, across] = self.second;
        Self {
            value: 1.0 + excess * half,
            first: [p * half + 0.5 * excess * t, q * half + 0.5 * excess * s],
            second: [along * half + p * t, across * half + q * s],
            mixed: self.mixed * half + 0.5 * (p * s + q * t + excess),
        }
    }

    /// The eigenvalues of the Hessian by the entries of J with their directions: two that stretch, one that turns, one
    /// that mirrors, and two that bend. `rows` are the motions along the axes of each.
    fn modes(&self, [s, t]: [f64; 2], rows: &[[f64; 6]; 6]) -> [(f64, [f64; 6]); 6] {
        let [p, q] = self.first;
        let [along, across] = self.second;
        let (mean, half) = (0.5 * (along + across), 0.5 * (along - across));
        let radius = (half * half + self.mixed * self.mixed).sqrt();
        let [cosine, sine] = half_angle(half, self.mixed);
        let stretched = |a: f64, b: f64| std::array::from_fn(|i| a * rows[0][i] + b * rows[1][i]);
        let mirrored = if s - t > EQUAL * s { (p - q) / (s - t) } else { along - self.mixed };
        [
            (mean + radius, stretched(cosine, sine)),
            (mean - radius, stretched(-sine, cosine)),
            ((p + q) / (s + t), rows[2]),
            (mirrored, rows[3]),
            (p / s, rows[4]),
            (q / t, rows[5]),
        ]
    }
}

/// J = U diag(σ₁, σ₂) Vᵀ.
struct Decomposition {
    /// σ₁ ≥ σ₂ > 0.
    values: [f64; 2],
    /// The columns of U, and the normal of the image.
    left: [Vector3; 3],
    /// The columns of V.
    right: [[f64; 2]; 2],
}

impl Decomposition {
    /// Derivatives by the entries of JᵀJ, from those by the singular values.
    fn by_gram(&self, [p, q]: [f64; 2]) -> [f64; 3] {
        let [s, t] = self.values;
        let [[a, b], [c, d]] = self.right;
        let (along, across) = (0.5 * p / s, 0.5 * q / t);
        [
            along * a * a + across * c * c,
            2.0 * (along * a * b + across * c * d),
            along * b * b + across * d * d,
        ]
    }
}

fn decomposed(jacobian: &Jacobian) -> Decomposition {
    let [xx, xy, yy] = gram(jacobian);
    let (mean, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
    let s = (mean + (half * half + xy * xy).sqrt()).sqrt();
    let t = (xx * yy - xy * xy).max(LEAST_SQUARED_AREA).sqrt() / s;
    let [cosine, sine] = half_angle(half, xy);
    let right = [[cosine, sine], [-sine, cosine]];
    let [first, second] = right.map(|v| jacobian[0] * v[0] + jacobian[1] * v[1]);
    let first = first.normalized();
    let second = second - first * first.dot(second);
    let second = if second.norm() > 1e-12 * s { second.normalized() } else { any_normal(first) };
    Decomposition { values: [s, t], left: [first, second, first.cross(second)], right }
}

/// A unit vector orthogonal to another.
fn any_normal(direction: Vector3) -> Vector3 {
    let axis = if direction[0].abs() < 0.5 { Vector3::unit(0) } else { Vector3::unit(1) };
    direction.cross(axis).normalized()
}

#[cfg(test)]
mod tests {
    use super::*;

    const HATS: Hats = [[-1.3, -0.4], [1.3, -0.2], [0.0, 0.6]];
    const IMAGES: [Vector3; 3] =
        [Vector3([0.1, 0.2, 0.0]), Vector3([0.9, 0.1, 0.3]), Vector3([0.4, 1.1, -0.8])];
    const MOVES: [[Vector3; 2]; 3] = [
        [Vector3([1.0, 0.0, 0.2]), Vector3([0.0, 1.0, -0.3])],
        [Vector3([0.8, 0.1, 0.5]), Vector3([-0.3, 0.9, 0.1])],
        [Vector3([0.2, 0.7, 0.7]), Vector3([0.6, 0.0, -0.8])],
    ];

    const KINDS: [FaceEnergy; 5] = [
        FaceEnergy { area_weight: 1.0, angle_weight: 1.0, both_ways: false },
        FaceEnergy { area_weight: 0.3, angle_weight: 2.0, both_ways: false },
        FaceEnergy { area_weight: 2.5, angle_weight: 0.0, both_ways: false },
        FaceEnergy { area_weight: 1.0, angle_weight: 1.0, both_ways: true },
        FaceEnergy { area_weight: 0.3, angle_weight: 2.0, both_ways: true },
    ];

    /// φ with the unknowns at `x`.
    fn value(energy: FaceEnergy, x: [f64; 6]) -> f64 {
        let moved: [Vector3; 3] = std::array::from_fn(|corner| {
            IMAGES[corner] + MOVES[corner][0] * x[2 * corner] + MOVES[corner][1] * x[2 * corner + 1]
        });
        energy.value(gram(&jacobian(&HATS, moved)))
    }

    fn expansion(energy: FaceEnergy) -> Expansion {
        energy.expansion(&jacobian(&HATS, IMAGES), &HATS, &MOVES).0
    }

    #[test]
    fn with_equal_weights_it_is_the_symmetric_dirichlet_energy() {
        // independent of the singular values: |J|² (1 + 1/det JᵀJ) / 4
        let [xx, xy, yy] = gram(&jacobian(&HATS, IMAGES));
        let dirichlet = (xx + yy) * (1.0 + 1.0 / (xx * yy - xy * xy)) / 4.0;
        assert!((KINDS[0].value([xx, xy, yy]) - dirichlet).abs() < 1e-12 * dirichlet);
        assert!(KINDS.iter().all(|kind| kind.value([1.0, 0.0, 1.0]) == 1.0));
    }

    #[test]
    fn a_map_and_its_inverse_count_alike_both_ways() {
        let [xx, xy, yy] = gram(&jacobian(&HATS, IMAGES));
        let determinant = xx * yy - xy * xy;
        let inverse = [yy / determinant, -xy / determinant, xx / determinant];
        let [_, _, _, dirichlet, general] = KINDS;
        for energy in [dirichlet, general] {
            // on an area of 1, and on that of the image
            let there = energy.value([xx, xy, yy]) - 1.0;
            let back = determinant.sqrt() * (energy.value(inverse) - 1.0);
            assert!((there - back).abs() < 1e-12 * there);
            let one_way = FaceEnergy { both_ways: false, ..energy };
            let sum = one_way.value([xx, xy, yy]) + determinant.sqrt() * one_way.value(inverse);
            assert!((2.0 * there - (sum - 1.0 - determinant.sqrt())).abs() < 1e-12 * sum);
        }
    }

    #[test]
    fn derivatives_are_those_of_differences() {
        for energy in KINDS {
            let expansion = expansion(energy);
            assert!((expansion.value - value(energy, [0.0; 6])).abs() < 1e-12 * expansion.value);
            for i in 0..6 {
                let h = 1e-6;
                let at = |step: f64| value(energy, std::array::from_fn(|k| if k == i { step } else { 0.0 }));
                let slope = (at(h) - at(-h)) / (2.0 * h);
                assert!((slope - expansion.gradient[i]).abs() < 1e-7 * expansion.value);
            }
        }
    }

    #[test]
    fn the_hessian_is_the_true_one_where_that_has_no_negative_eigenvalue() {
        // a stretched face is in a convex region of the symmetric Dirichlet energy
        let energy = KINDS[0];
        let images = IMAGES.map(|x| x * 2.5);
        let at = |x: [f64; 6]| {
            let moved: [Vector3; 3] = std::array::from_fn(|corner| {
                images[corner] + MOVES[corner][0] * x[2 * corner] + MOVES[corner][1] * x[2 * corner + 1]
            });
            energy.value(gram(&jacobian(&HATS, moved)))
        };
        let (expansion, _) = energy.expansion(&jacobian(&HATS, images), &HATS, &MOVES);
        let h = 1e-4;
        for i in 0..6 {
            for j in 0..6 {
                let step = |a: f64, b: f64| {
                    let mut x = [0.0; 6];
                    x[i] += a;
                    x[j] += b;
                    at(x)
                };
                let second = (step(h, h) - step(h, -h) - step(-h, h) + step(-h, -h)) / (4.0 * h * h);
                assert!((second - expansion.hessian[i][j]).abs() < 1e-5 * expansion.value);
            }
        }
    }

    #[test]
    fn derivatives_along_changes_of_the_map_are_those_along_velocities_of_the_corners() {
        let changes = std::array::from_fn(|i| {
            let (corner, d) = (i / 2, i % 2);
            HATS[corner].map(|slope| MOVES[corner][d] * slope)
        });
        for energy in KINDS {
            let (by_corners, along) =
                (expansion(energy), energy.expansion_along(&jacobian(&HATS, IMAGES), &changes));
            assert_eq!(by_corners.value, along.value);
            let scale = by_corners.value;
            for i in 0..6 {
                assert!((by_corners.gradient[i] - along.gradient[i]).abs() < 1e-12 * scale);
                for j in 0..6 {
                    assert!((by_corners.hessian[i][j] - along.hessian[i][j]).abs() < 1e-11 * scale);
                }
            }
        }
    }

    #[test]
    fn half_angles_are_those_of_the_textbook() {
        for k in -31..=31 {
            let angle = 0.1 * f64::from(k);
            let [cosine, sine] = half_angle(3.0 * angle.cos(), 3.0 * angle.sin());
            assert!(
                (cosine - (0.5 * angle).cos()).abs() < 1e-15 && (sine - (0.5 * angle).sin()).abs() < 1e-15
            );
        }
    }

    #[test]
    fn the_symmetric_dirichlet_energy_is_the_limit_of_other_weights() {
        let near = FaceEnergy { area_weight: 1.0 + 1e-9, angle_weight: 1.0 - 1e-9, both_ways: false };
        let (exact, general) = (expansion(KINDS[0]), expansion(near));
        for i in 0..6 {
            assert!((exact.gradient[i] - general.gradient[i]).abs() < 1e-6 * exact.value);
            for j in 0..6 {
                assert!((exact.hessian[i][j] - general.hessian[i][j]).abs() < 1e-6 * exact.value);
            }
        }
    }

    #[test]
    fn derivatives_by_the_metric_are_those_of_differences() {
        for energy in KINDS {
            let jacobian = jacobian(&HATS, IMAGES);
            let (_, slopes) = energy.expansion(&jacobian, &HATS, &MOVES);
            for (k, slope) in slopes.into_iter().enumerate() {
                let at = |step: f64| {
                    let mut gram = gram(&jacobian);
                    gram[k] += step;
                    energy.value(gram)
                };
                let difference = (at(1e-6) - at(-1e-6)) / 2e-6;
                assert!((difference - slope).abs() < 1e-6 * slope.abs().max(1.0));
            }
        }
    }
}
