// SPDX-License-Identifier: MIT OR Apache-2.0
//! The energy of one face: its image triangle, the derivatives of area, determinant and cotangent sum, and its Hessian.

use crate::codomain::motion::Frame;
use crate::mesh::geometry::determinant_rounding;
use crate::vector::Vector3;

/// β, the weight of the quadratic term in m − 1.
pub(super) const STEEPNESS: f64 = 0.1;

/// A symmetric matrix by the unknowns of a face's corners, two for each.
pub(crate) type Element = [[f64; 6]; 6];

/// An image triangle.
#[derive(Clone, Copy)]
pub(super) struct Triangle {
    pub x: [Vector3; 3],
    /// D = det(x_i, x_j, x_k).
    pub determinant: f64,
    /// Twice the area, signed in the plane.
    pub doubled_area: f64,
    /// N over `doubled_area`: the unit normal, in the plane always upwards.
    normal: Vector3,
    /// Q.
    quadratic: f64,
    /// Bound of the rounding error of D.
    pub rounding: f64,
}

/// Derivatives of a triangle's area, D and Q by the unknowns of its corners.
pub(super) struct Slopes {
    pub area: [f64; 6],
    determinant: [f64; 6],
    quadratic: [f64; 6],
}

/// The derivatives of a face's energy by a, D and Q.
pub(super) struct Outer {
    pub by_area: f64,
    pub by_determinant: f64,
    pub by_quadratic: f64,
}

impl Outer {
    pub(super) fn times(&self, factor: f64) -> Self {
        Self {
            by_area: factor * self.by_area,
            by_determinant: factor * self.by_determinant,
            by_quadratic: factor * self.by_quadratic,
        }
    }

    pub(super) fn along(&self, slopes: &Slopes, k: usize) -> f64 {
        self.by_area * slopes.area[k]
            + self.by_determinant * slopes.determinant[k]
            + self.by_quadratic * slopes.quadratic[k]
    }
}

/// (m − 1) + ½ β (m − 1)².
pub(super) fn angle_cost(angle: f64) -> f64 {
    (angle - 1.0) * (1.0 + 0.5 * STEEPNESS * (angle - 1.0))
}

impl Triangle {
    #[inline(always)]
    pub(super) fn new(x: [Vector3; 3], cotangents: [f64; 3], planar: bool) -> Self {
        let (p, q) = (x[1] - x[0], x[2] - x[0]);
        let r = q - p;
        let product = p.cross(q);
        let determinant = x[0].dot(product);
        let (doubled_area, normal) = if planar {
            (determinant, Vector3::unit(2))
        } else {
            let length = product.norm();
            (length, product * (1.0 / length.max(f64::MIN_POSITIVE)))
        };
        let quadratic =
            0.5 * (cotangents[0] * r.dot(r) + cotangents[1] * q.dot(q) + cotangents[2] * p.dot(p));
        let rounding = determinant_rounding(x[0], p, q);
        Self { x, determinant, doubled_area, normal, quadratic, rounding }
    }

    /// m.
    pub(super) fn angle(&self) -> f64 {
        self.quadratic / self.determinant
    }

    /// ∇a = ½ (x_{c+1} − x_{c+2}) × n by the unknowns of each corner c.
    pub(super) fn area_slopes(&self, frames: [&Frame; 3]) -> [f64; 6] {
        self.reduced(frames, |[next, after, _]| (next - after).cross(self.normal) * 0.5)
    }

    pub(super) fn slopes(&self, frames: [&Frame; 3], cotangents: [f64; 3]) -> Slopes {
        let area = self.area_slopes(frames);
        // in the plane D is twice the area
        let determinant = self.reduced(frames, |[next, after, _]| next.cross(after - next));
        let mut quadratic = [0.0; 6];
        for c in 0..3 {
            let (next, after) = ((c + 1) % 3, (c + 2) % 3);
            let slope = (self.x[c] - self.x[after]) * cotangents[next]
                + (self.x[c] - self.x[next]) * cotangents[after];
            (0..2).for_each(|axis| quadratic[2 * c + axis] = slope.dot(frames[c].axes[axis]));
        }
        Slopes { area, determinant, quadratic }
    }

    /// A vector per corner, computed from the triangle turned to it, by the unknowns.
    fn reduced(&self, frames: [&Frame; 3], of_corner: impl Fn([Vector3; 3]) -> Vector3) -> [f64; 6] {
        let mut out = [0.0; 6];
        for c in 0..3 {
            let slope = of_corner([self.x[(c + 1) % 3], self.x[(c + 2) % 3], self.x[c]]);
            (0..2).for_each(|axis| out[2 * c + axis] = slope.dot(frames[c].axes[axis]));
        }
        out
    }

    /// Adds `weight` times the Hessian of (m − 1) + ½ β (m − 1)² without the Hessians of Q, D and a, `curvature` from
    /// the composite, 0, to the exact one, 1; returns the factor of the Hessian of Q.
    pub(super) fn add_angle(
        &self,
        element: &mut Element,
        weight: f64,
        slopes: &Slopes,
        curvature: f64,
    ) -> f64 {
        let (d, angle) = (self.determinant, self.angle());
        let by_quadratic = weight * (1.0 + STEEPNESS * (angle - 1.0)) / d;
        // ∇m
        let by_angle: [f64; 6] =
            std::array::from_fn(|k| (slopes.quadratic[k] - angle * slopes.determinant[k]) / d);
        // ∇(C/D), with C = Q − 2a for the composite and C = Q for the exact Hessian
        let doubled = 2.0 * (1.0 - curvature);
        let conformal = angle - 0.5 * doubled * self.doubled_area / d;
        let by_conformal: [f64; 6] = std::array::from_fn(|k| {
            (slopes.quadratic[k] - doubled * slopes.area[k] - conformal * slopes.determinant[k]) / d
        });
        for row in 0..6 {
            for column in 0..6 {
                // −(∇C ∇Dᵀ + ∇D ∇Cᵀ)/D² + 2C ∇D ∇Dᵀ/D³
                let mixed = by_conformal[row] * slopes.determinant[column]
                    + slopes.determinant[row] * by_conformal[column];
                element[row][column] +=
                    weight * STEEPNESS * by_angle[row] * by_angle[column] - by_quadratic * mixed;
            }
        }
        by_quadratic
    }

    /// Adds the Hessians of the area and of D, and the product of the gradient with the curvature of the vertices'
    /// paths.
    pub(super) fn add_curvature(
        &self,
        element: &mut Element,
        outer: &Outer,
        frames: [&Frame; 3],
        cotangents: [f64; 3],
    ) {
        let axis = |k: usize| frames[k / 2].axes[k % 2];
        let in_plane: [Vector3; 6] = std::array::from_fn(|k| {
            let c = k / 2;
            let turned = axis(k).cross(self.x[(c + 1) % 3] - self.x[(c + 2) % 3]);
            turned - self.normal * turned.dot(self.normal)
        });
        // corners c and e after it: ∂²D is det(axis, axis, third corner), ∂²(2a) has the normal for that
        for c in 0..3 {
            let (e, third) = ((c + 1) % 3, self.x[(c + 2) % 3]);
            let bent = self.normal * (0.5 * outer.by_area) + third * outer.by_determinant;
            for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let triple = axis(2 * c + i).cross(axis(2 * e + j)).dot(bent);
                element[2 * c + i][2 * e + j] += triple;
                element[2 * e + j][2 * c + i] += triple;
            }
        }
        let stretch = 0.5 * outer.by_area / self.doubled_area;
        for row in 0..6 {
            (0..6).for_each(|column| element[row][column] += stretch * in_plane[row].dot(in_plane[column]));
        }
        for c in 0..3 {
            let pull = self.slope_in_space(outer, cotangents, c).dot(frames[c].outward);
            (0..2).for_each(|axis| element[2 * c + axis][2 * c + axis] -= pull);
        }
    }

    /// The gradient of the face's energy by the position of a corner in space.
    pub(super) fn slope_in_space(&self, outer: &Outer, cotangents: [f64; 3], c: usize) -> Vector3 {
        let (n, a) = ((c + 1) % 3, (c + 2) % 3);
        let (next, after) = (self.x[n], self.x[a]);
        let by_area = (next - after).cross(self.normal) * (0.5 * outer.by_area);
        let by_determinant = next.cross(after - next) * outer.by_determinant;
        let by_quadratic = (self.x[c] - after) * (outer.by_quadratic * cotangents[n])
            + (self.x[c] - next) * (outer.by_quadratic * cotangents[a]);
        by_area + (by_determinant + by_quadratic)
    }

    /// Subtracts `factor` times the Hessian of 2a in the plane of the face.
    pub(super) fn subtract_area(&self, element: &mut Element, factor: f64, frames: [&Frame; 3]) {
        for c in 0..3 {
            let next = (c + 1) % 3;
            for i in 0..2 {
                for j in 0..2 {
                    let turn = factor * frames[c].axes[i].cross(frames[next].axes[j]).dot(self.normal);
                    element[2 * c + i][2 * next + j] -= turn;
                    element[2 * next + j][2 * c + i] -= turn;
                }
            }
        }
    }
}

/// Adds `factor` v vᵀ.
pub(super) fn add_product(element: &mut Element, factor: f64, v: &[f64; 6]) {
    for row in 0..6 {
        (0..6).for_each(|column| element[row][column] += factor * v[row] * v[column]);
    }
}

/// Adds the Hessian of ½ Σ weight_c |opposite edge|² by the unknowns of the corners.
pub(super) fn add_quadratic(element: &mut Element, frames: [&Frame; 3], weights: [f64; 3]) {
    for c in 0..3 {
        let (next, after) = ((c + 1) % 3, (c + 2) % 3);
        for i in 0..2 {
            for j in 0..2 {
                let product = frames[c].axes[i].dot(frames[c].axes[j]);
                element[2 * c + i][2 * c + j] += (weights[next] + weights[after]) * product;
                let mixed = weights[after] * frames[c].axes[i].dot(frames[next].axes[j]);
                element[2 * c + i][2 * next + j] -= mixed;
                element[2 * next + j][2 * c + i] -= mixed;
            }
        }
    }
}
