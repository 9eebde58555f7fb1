// SPDX-License-Identifier: MIT OR Apache-2.0
//! The hyperbolic plane as the unit disk, its isometries and its other models.
//!
//! The metric is 2 |dz| / (1 − |z|²), of curvature −1. Isometries that keep orientation are the Möbius maps
//! z ↦ (a z + b) / (b̄ z + ā) with |a|² − |b|² = 1. Tangent vectors at p are given in the orthonormal frame
//! (1 − |p|²)/2 · {1, i}.
//!
//! Near the circle absolute coordinates lose digits, so quantities are formed relative to one of the points where
//! possible. Every function takes constant time.

use std::ops::Mul;

use crate::vector::Vector3;

/// A point of the disk, or a tangent vector.
pub type Complex = num_complex::Complex<f64>;

/// The largest modulus that [`from_hyperboloid`] returns.
const INSIDE: f64 = 1.0 - f64::EPSILON;

/// The isometry z ↦ (a z + b) / (b̄ z + ā) with |a|² − |b|² = 1; (a, b) and (−a, −b) are the same map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moebius {
    /// Factor of z.
    pub a: Complex,
    /// The constant.
    pub b: Complex,
}

impl Default for Moebius {
    /// The identity.
    fn default() -> Self {
        Self { a: Complex::new(1.0, 0.0), b: Complex::new(0.0, 0.0) }
    }
}

impl Moebius {
    /// The image of a point.
    pub fn apply(&self, z: Complex) -> Complex {
        (self.a * z + self.b) / (self.b.conj() * z + self.a.conj())
    }

    /// The complex derivative at a point; its argument is the angle by which the map turns orthonormal
    /// frames.
    pub fn derivative(&self, z: Complex) -> Complex {
        let denominator = self.b.conj() * z + self.a.conj();
        (denominator * denominator).inv()
    }

    /// The inverse map.
    pub fn inverse(&self) -> Self {
        Self { a: self.a.conj(), b: -self.b }
    }

    /// The isometry that takes p to `to_p` and the direction from p to q to that from `to_p` to `to_q`, hence
    /// q to `to_q` if the distances agree.
    pub fn between([p, q]: [Complex; 2], [to_p, to_q]: [Complex; 2]) -> Self {
        let turn = unit(seen_from(to_p, to_q)) * unit(seen_from(p, q)).conj();
        let half_turn = turn.sqrt();
        let scale = (beneath_circle(p) * beneath_circle(to_p)).sqrt();
        Self {
            a: (half_turn - to_p * (half_turn * p).conj()) / scale,
            b: (to_p * half_turn.conj() - half_turn * p) / scale,
        }
    }

    /// The distance by which the map moves the points of its axis; 0 if it has none.
    pub fn translation_length(&self) -> f64 {
        2.0 * self.half_translation().asinh()
    }

    /// The ends of the axis on the unit circle, the repelling one first; meaningless if the translation length is 0.
    pub fn fixed_points(&self) -> [Complex; 2] {
        let root = self.half_translation().copysign(self.a.re);
        let end = |root: f64| unit(Complex::new(root, self.a.im) / self.b.conj());
        [end(-root), end(root)]
    }

    /// sinh of half the translation length: (Re a)² − 1 is (|b| − |Im a|)(|b| + |Im a|).
    fn half_translation(&self) -> f64 {
        let (b, turn) = (self.b.norm(), self.a.im.abs());
        ((b - turn) * (b + turn)).max(0.0).sqrt()
    }

    /// The map with |a|² − |b|² = 1 restored after rounding.
    fn normalized(self) -> Self {
        let (a, b) = (self.a.norm(), self.b.norm());
        let determinant = (a - b) * (a + b);
        if determinant > 0.0 {
            Self { a: self.a / determinant.sqrt(), b: self.b / determinant.sqrt() }
        } else {
            self
        }
    }
}

impl Mul for Moebius {
    type Output = Self;

    /// First `other`, then this map.
    fn mul(self, other: Self) -> Self {
        let a = self.a * other.a + self.b * other.b.conj();
        let b = self.a * other.b + self.b * other.a.conj();
        Self { a, b }.normalized()
    }
}

/// The image of q under the isometry that moves p to the origin without turning there.
pub fn seen_from(p: Complex, q: Complex) -> Complex {
    (q - p) / (1.0 - p.conj() * q)
}

/// The hyperbolic distance of two points.
pub fn distance(p: Complex, q: Complex) -> f64 {
    2.0 * ((q - p).norm() / (beneath_circle(p) * beneath_circle(q)).sqrt()).asinh()
}

/// The point of the geodesic from p with direction v at the distance |v|.
pub fn exponential(p: Complex, v: Complex) -> Complex {
    let w = unit(v) * (0.5 * v.norm()).tanh();
    (w + p) / (1.0 + p.conj() * w)
}

/// The point on the hyperboloid t² − x² − y² = 1 as (x, y, t).
pub fn to_hyperboloid(z: Complex) -> Vector3 {
    Vector3([2.0 * z.re, 2.0 * z.im, 1.0 + z.norm_sqr()]).map(|coordinate| coordinate / beneath_circle(z))
}

/// The point of the disk on the ray of (x, y, t), t > 0; a ray that rounding has put onto or outside the cone gives a
/// point next to the circle.
pub fn from_hyperboloid(Vector3([x, y, t]): Vector3) -> Complex {
    let radius = x.hypot(y);
    let height = ((t - radius) * (t + radius)).max(0.0).sqrt();
    let z = Complex::new(x, y) / (t + height);
    if z.norm() < 1.0 { z } else { unit(z) * INSIDE }
}

/// The corresponding point of Klein's model, where geodesics are straight.
pub fn to_klein(z: Complex) -> Complex {
    2.0 * z / (1.0 + z.norm_sqr())
}

/// The point of the disk corresponding to a point of Klein's model.
pub fn from_klein(k: Complex) -> Complex {
    k / (1.0 + beneath_circle(k).max(0.0).sqrt())
}

/// Positive if the triangle a, b, c is counterclockwise, negative if it is clockwise.
pub fn orientation(a: Complex, b: Complex, c: Complex) -> f64 {
    let [b, c] = [b, c].map(|corner| to_klein(seen_from(a, corner)));
    (b.conj() * c).im
}

/// 1 − |z|².
fn beneath_circle(z: Complex) -> f64 {
    let modulus = z.norm();
    (1.0 - modulus) * (1.0 + modulus)
}

/// z / |z|; 1 for 0.
fn unit(z: Complex) -> Complex {
    match z.norm() {
        0.0 => Complex::new(1.0, 0.0),
        modulus => z / modulus,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Points up to the distance 3 from the origin.
    fn point() -> impl Strategy<Value = Complex> {
        (0.0..3.0_f64, 0.0..std::f64::consts::TAU)
            .prop_map(|(distance, angle)| Complex::from_polar((0.5 * distance).tanh(), angle))
    }

    fn tangent() -> impl Strategy<Value = Complex> {
        (1e-3..2.0_f64, 0.0..std::f64::consts::TAU)
            .prop_map(|(length, angle)| Complex::from_polar(length, angle))
    }

    fn isometry() -> impl Strategy<Value = Moebius> {
        (point(), point(), tangent(), tangent()).prop_map(|(p, q, v, w)| {
            Moebius::between([p, exponential(p, v)], [q, exponential(q, w / w.norm() * v.norm())])
        })
    }

    /// Rounding of the unit disk as it looks at the distance 15 from the origin.
    const CLOSE: f64 = 1e-7;

    fn logarithm(p: Complex, q: Complex) -> Complex {
        unit(seen_from(p, q)) * distance(p, q)
    }

    proptest! {
        #[test]
        fn maps_form_a_group(g in isometry(), h in isometry(), k in isometry(), z in point()) {
            prop_assert!(distance((g * h).apply(z), g.apply(h.apply(z))) < CLOSE);
            prop_assert!(distance(((g * h) * k).apply(z), (g * (h * k)).apply(z)) < 1e-4);
            prop_assert!(distance((g * g.inverse()).apply(z), z) < CLOSE);
            prop_assert!(distance(g.inverse().apply(g.apply(z)), z) < CLOSE);
            prop_assert_eq!(g * Moebius::default(), g.normalized());
            prop_assert_eq!(Moebius::default().apply(z), z);
        }

        #[test]
        fn isometries_keep_distances(g in isometry(), p in point(), q in point()) {
            prop_assert!((distance(g.apply(p), g.apply(q)) - distance(p, q)).abs() < CLOSE);
            prop_assert!((2.0 * seen_from(p, q).norm().atanh() - distance(p, q)).abs() < 1e-6);
            prop_assert_eq!(distance(p, q), distance(q, p));
        }

        #[test]
        fn a_map_between_segments_takes_both_ends_along(p in point(), v in tangent(), to in point(), w in tangent()) {
            let (q, to_q) = (exponential(p, v), exponential(to, w / w.norm() * v.norm()));
            let map = Moebius::between([p, q], [to, to_q]);
            prop_assert!(distance(map.apply(p), to) < 1e-11);
            prop_assert!(distance(map.apply(q), to_q) < 1e-9);
        }

        #[test]
        fn the_derivative_is_that_of_differences(g in isometry(), z in point()) {
            let step = 1e-5 * beneath_circle(z);
            for direction in [Complex::new(step, 0.0), Complex::new(0.0, step)] {
                let difference = (g.apply(z + direction) - g.apply(z - direction)) / (2.0 * direction);
                prop_assert!((difference / g.derivative(z) - 1.0).norm() < 1e-5);
            }
        }

        #[test]
        fn isometries_keep_the_orientation(g in isometry(), a in point(), v in tangent(), w in tangent()) {
            let [b, c] = [v, w].map(|direction| exponential(a, direction));
            let sine = (v.conj() * w).im / (v.norm() * w.norm());
            prop_assume!(sine.abs() > 1e-3);
            prop_assert!(orientation(a, b, c).signum() == sine.signum());
            prop_assert!(orientation(b, c, a).signum() == sine.signum());
            prop_assert!(orientation(a, c, b).signum() == -sine.signum());
            let moved = orientation(g.apply(a), g.apply(b), g.apply(c));
            prop_assert!(moved.signum() == sine.signum());
        }

        #[test]
        fn models_and_tangents_go_round(z in point(), v in tangent()) {
            let hyperboloid = to_hyperboloid(z);
            prop_assert!(distance(from_hyperboloid(hyperboloid), z) < 1e-10);
            prop_assert!(distance(from_hyperboloid(hyperboloid.map(|x| 7.0 * x)), z) < 1e-10);
            prop_assert!(distance(from_klein(to_klein(z)), z) < 1e-8);
            prop_assert!((logarithm(z, exponential(z, v)) - v).norm() < 1e-8);
        }

        #[test]
        fn a_translation_fixes_the_ends_of_its_axis(g in isometry(), length in 0.1..4.0_f64) {
            let [origin, end, next] =
                [0.0, 1.0, 2.0].map(|times| Complex::new((0.5 * times * length).tanh(), 0.0));
            let along = Moebius::between([origin, end], [end, next]);
            let translation = g * along * g.inverse();
            let [repelling, attracting] = translation.fixed_points();
            prop_assert!((translation.translation_length() - length).abs() < 1e-5);
            prop_assert!((repelling - g.apply(Complex::new(-1.0, 0.0))).norm() < 1e-5);
            prop_assert!((attracting - g.apply(Complex::new(1.0, 0.0))).norm() < 1e-5);
            prop_assert!(translation.derivative(attracting).norm() < 1.0);
            prop_assert!(translation.derivative(repelling).norm() > 1.0);
        }
    }

    #[test]
    fn triangles_next_to_the_circle_have_an_orientation() {
        for distance in [10.0, 15.0, 20.0_f64] {
            let a = Complex::from_polar((0.5 * distance).tanh(), 0.7);
            let corners = [0.0, 0.3].map(|angle| exponential(a, Complex::from_polar(1e-2, 2.0 + angle)));
            assert!(orientation(a, corners[0], corners[1]) > 0.0);
            assert!(orientation(a, corners[1], corners[0]) < 0.0);
        }
    }

    #[test]
    fn a_map_between_charts_is_exact() {
        let [p, q] = [Complex::new(-0.01, 0.006), Complex::new(0.012, -0.003)];
        let to_p = Complex::new(0.004, -0.011);
        let to_q = exponential(to_p, Complex::from_polar(distance(p, q), 2.0));
        let map = Moebius::between([p, q], [to_p, to_q]);
        assert!((map.apply(p) - to_p).norm() < 1e-17);
        assert!((map.apply(q) - to_q).norm() < 1e-17);
    }

    #[test]
    fn rounding_does_not_leave_the_disk() {
        let z = from_hyperboloid(Vector3([3e10, 4e10, 5e10 * (1.0 - 1e-16)]));
        assert!(z.norm() < 1.0 && (z - Complex::new(0.6, 0.8)).norm() < 1e-7);
    }

    #[test]
    fn rotations_and_the_identity_translate_nothing() {
        let rotation = Moebius { a: Complex::from_polar(1.0, 0.4), b: Complex::default() };
        assert_eq!(rotation.translation_length(), 0.0);
        assert_eq!(Moebius::default().translation_length(), 0.0);
        let half = Moebius::between(
            [Complex::default(), Complex::new(0.3, 0.0)],
            [Complex::default(), Complex::new(-0.3, 0.0)],
        );
        assert!((half.apply(Complex::new(0.0, 0.5)) - Complex::new(0.0, -0.5)).norm() < 1e-15);
    }
}
