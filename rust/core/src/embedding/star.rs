// SPDX-License-Identifier: MIT OR Apache-2.0
//! The star of a vertex: the energy of its faces, and a Newton step of the vertex that folds no face.
//!
//! On the sphere |x| = 1; the disk lies in the plane z = 1, its boundary on the unit circle, so that one
//! formula serves both. Per face with target T, D = det(x, p, q) and Q = Σ edge²/2√3:
//!
//! ```text
//! E = T (ρ + 1/ρ − 2) + λ T (Q/D − 1) = D/2 + (2T² + λ T Q)/D + const,     ρ = D/2T.
//! ```
//!
//! D is linear in x and is evaluated as (p × (q − p))·(x − p). A vertex on the circle has the further energy
//! Σ s²/α times [`ARC`], α the arcs to its two neighbors there and s their shares, which keeps arcs from closing.
//!
//! Cost: about a hundred operations for each face and step.

use crate::codomain::motion::{Frame, Motion};
use crate::vector::Vector3;

/// D counts as positive where it is larger than this times the size of its products; their rounding is a tenth of that.
const CLEARLY: f64 = 1e-14;

/// The weight of the arcs in the energy of a vertex on the circle.
const ARC: f64 = 0.1;

/// Upper bound of the length of a step.
const LONGEST: f64 = 0.5;

/// A step is worthwhile if it lowers the energy by this part of the star's measure or more.
const WORTH: f64 = 1e-6;

/// The polygon around a vertex.
#[derive(Debug, Default)]
pub(super) struct Star {
    faces: Vec<Face>,
    /// For a vertex on the circle, its neighbors before and behind it, counter-clockwise, each with the
    /// share of the arc to it.
    pub arcs: Option<[(Vector3, f64); 2]>,
    measure: f64,
}

/// A face at the vertex.
#[derive(Debug, Clone, Copy)]
pub(super) struct Face {
    /// The ends of the edge opposite to the vertex.
    pub(super) ends: [Vector3; 2],
    middle: Vector3,
    /// Three halves of the squared length of that edge.
    length: f64,
    /// ∇D.
    pub(super) normal: Vector3,
    /// This times the 1-norm of x − p bounds the rounding error of D.
    rounding: f64,
    target: f64,
}

/// The derivatives of the energy in coordinates along a basis.
pub(super) struct Derivatives {
    pub(super) gradient: [f64; 2],
    /// [[a, b], [b, c]] as [a, b, c].
    pub(super) hessian: [f64; 3],
}

impl Face {
    pub(super) fn new(p: Vector3, q: Vector3, target: f64) -> Self {
        let edge = q - p;
        let product = |i: usize, j: usize| (p[i] * edge[j]).abs() + (p[j] * edge[i]).abs();
        Self {
            ends: [p, q],
            middle: (p + q) * 0.5,
            length: 1.5 * edge.dot(edge),
            normal: p.cross(edge),
            rounding: CLEARLY * product(1, 2).max(product(2, 0)).max(product(0, 1)),
            target,
        }
    }

    /// D where it is clearly positive.
    pub(super) fn determinant(&self, x: Vector3) -> Option<f64> {
        let spoke = x - self.ends[0];
        let determinant = self.normal.dot(spoke);
        let size = spoke[0].abs() + spoke[1].abs() + spoke[2].abs();
        (determinant > self.rounding * size).then_some(determinant)
    }

    /// Q and half its gradient by x times √3, which is x less the middle of the edge, doubled.
    fn size(&self, x: Vector3) -> (f64, Vector3) {
        let spoke = x - self.middle;
        ((2.0 * spoke.dot(spoke) + self.length) / (2.0 * SQRT_3), spoke)
    }
}

const SQRT_3: f64 = 1.732_050_807_568_877_2;

impl Star {
    /// Forgets all faces.
    pub(super) fn clear(&mut self) {
        self.faces.clear();
        self.arcs = None;
        self.measure = 0.0;
    }

    /// Adds the face between the vertex and two neighbors, which follow it counter-clockwise.
    pub(super) fn push(&mut self, p: Vector3, q: Vector3, target: f64) {
        self.faces.push(Face::new(p, q, target));
        self.measure += target;
    }

    /// The edges of the polygon.
    pub(super) fn edges(&self) -> impl Iterator<Item = [Vector3; 2]> + Clone {
        self.faces.iter().map(|face| face.ends)
    }

    /// The energy with the vertex at x; `None` where a face is not clearly positive.
    pub(super) fn energy(&self, x: Vector3, shape: f64) -> Option<f64> {
        let mut sum = self.arcs.map_or(0.0, |arcs| arc_energy(x, arcs)[0]);
        for face in &self.faces {
            let d = face.determinant(x)?;
            sum += 0.5 * d + face.target * (2.0 * face.target + shape * face.size(x).0) / d;
        }
        sum.is_finite().then_some(sum)
    }

    /// The place of the vertex after one Newton step from x that lowers the energy and folds no face; `None`
    /// where there is no such step or it is not worthwhile.
    pub(super) fn improved(&self, x: Vector3, motion: Motion, shape: f64) -> Option<Vector3> {
        let frame = motion.frame(x);
        let (energy, derivatives) = self.derivatives(x, motion, &frame, shape)?;
        let (direction, slope) = derivatives.newton_direction()?;
        if -slope < WORTH * self.measure {
            return None;
        }
        let mut step = (LONGEST / direction[0].hypot(direction[1])).min(1.0);
        for _ in 0..12 {
            let moved = motion.moved(x, &frame, direction.map(|d| step * d));
            if self.energy(moved, shape).is_some_and(|now| now <= energy + 1e-4 * step * slope) {
                return Some(moved);
            }
            step *= 0.4;
        }
        None
    }

    fn derivatives(
        &self,
        x: Vector3,
        motion: Motion,
        frame: &Frame,
        shape: f64,
    ) -> Option<(f64, Derivatives)> {
        let (mut energy, mut gradient, mut hessian) = (0.0, Vector3::ZERO, [0.0; 3]);
        for face in &self.faces {
            let d = face.determinant(x)?;
            let (q, spoke) = face.size(x);
            let weight = shape * face.target;
            let inverse = 1.0 / d;
            let over = (2.0 * face.target * face.target + weight * q) * inverse;
            energy += 0.5 * d + over;
            // ∇D = normal, ∇Q = 2/√3 spoke, Hess Q = 2/√3
            let on_q = 2.0 / SQRT_3 * weight * inverse;
            let (on_d, on_dd, on_dq) =
                (0.5 - over * inverse, 2.0 * over * inverse * inverse, -on_q * inverse);
            gradient += face.normal * on_d + spoke * on_q;
            let [n, s] = [face.normal, spoke].map(|z| frame.axes.map(|axis| axis.dot(z)));
            hessian[0] += (on_dd * n[0] + 2.0 * on_dq * s[0]) * n[0] + on_q;
            hessian[1] += on_dd * n[0] * n[1] + on_dq * (n[0] * s[1] + s[0] * n[1]);
            hessian[2] += (on_dd * n[1] + 2.0 * on_dq * s[1]) * n[1] + on_q;
        }
        let along = frame.axes.map(|axis| axis.dot(gradient));
        let mut sum = (energy, Derivatives { gradient: along, hessian });
        self.bend(x, motion, gradient.dot(frame.outward), &mut sum);
        Some(sum)
    }

    /// Adds the curvature of a step along the sphere or the circle, and the energy of the arcs.
    fn bend(&self, x: Vector3, motion: Motion, bend: f64, (energy, sum): &mut (f64, Derivatives)) {
        match motion {
            Motion::Held | Motion::Side(_) | Motion::Plane => {}
            Motion::Sphere => {
                sum.hessian[0] -= bend;
                sum.hessian[2] -= bend;
            }
            Motion::Circle => {
                let arcs = self.arcs.map_or([0.0; 3], |arcs| arc_energy(x, arcs));
                *energy += arcs[0];
                sum.gradient = [sum.gradient[0] + arcs[1], 0.0];
                sum.hessian = [sum.hessian[0] - bend + arcs[2], 0.0, 1.0];
            }
        }
    }
}

impl Derivatives {
    /// The Newton direction with its slope, eigenvalues made positive; `None` where there is no descent.
    pub(super) fn newton_direction(&self) -> Option<([f64; 2], f64)> {
        let (g, [a, b, c]) = (self.gradient, self.hessian);
        let (mean, half) = (0.5 * (a + c), 0.5 * (a - c));
        let radius = (half * half + b * b).sqrt();
        let largest = mean.abs() + radius;
        let inverse = |value: f64| 1.0 / value.abs().max(1e-3 * largest);
        let [first, second] = [inverse(mean + radius), inverse(mean - radius)];
        // the inverse is (first + second)/2 of the identity and (first − second)/2 of the reflection
        let (same, turned) =
            (0.5 * (first + second), if radius > 0.0 { 0.5 * (first - second) / radius } else { 0.0 });
        let reflected = [half * g[0] + b * g[1], b * g[0] - half * g[1]];
        let direction = [0, 1].map(|k| -(same * g[k] + turned * reflected[k]));
        let slope = g[0] * direction[0] + g[1] * direction[1];
        (slope < 0.0 && slope.is_finite()).then_some((direction, slope))
    }
}

/// The angle from one point of the circle to another, counter-clockwise, in (0, 2π].
pub(super) fn angle(from: Vector3, to: Vector3) -> f64 {
    let angle = (from[0] * to[1] - from[1] * to[0]).atan2(from[0] * to[0] + from[1] * to[1]);
    if angle > 0.0 { angle } else { angle + std::f64::consts::TAU }
}

/// The energy of the arcs beside x and its two derivatives by the angle of x.
fn arc_energy(x: Vector3, [(before, share_before), (behind, share_behind)]: [(Vector3, f64); 2]) -> [f64; 3] {
    let (p, q) = (1.0 / angle(before, x), 1.0 / angle(x, behind));
    let [a, b] = [share_before, share_behind].map(|share| ARC * share * share);
    [a * p + b * q, b * q * q - a * p * p, 2.0 * (a * p * p * p + b * q * q * q)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::codomain::motion::rotated;

    /// A polygon around the vertex at x: on the sphere and in the plane closed, on the circle a fan.
    fn star(motion: Motion) -> (Star, Vector3) {
        let corner = |k: usize| match motion {
            Motion::Sphere => {
                let angle = 1.2 * k as f64;
                let x = Vector3([0.3 * angle.cos(), 0.5 * angle.sin(), 1.0]);
                x.normalized()
            }
            Motion::Held | Motion::Side(_) | Motion::Plane => {
                Vector3([0.2 + 0.3 * (1.2 * k as f64).cos(), 0.4 * (1.2 * k as f64).sin(), 1.0])
            }
            Motion::Circle => {
                Vector3([[0.6, -0.8, 1.0], [0.3, -0.2, 1.0], [-0.3, -0.4, 1.0], [-0.8, -0.6, 1.0]][k])
            }
        };
        let mut star = Star::default();
        let n = if motion == Motion::Circle { 3 } else { 5 };
        let next = |k: usize| if motion == Motion::Circle { k + 1 } else { (k + 1) % n };
        (0..n).for_each(|k| star.push(corner(k), corner(next(k)), 0.02 + 0.01 * k as f64));
        match motion {
            Motion::Sphere => (star, Vector3([0.0, 0.0, 1.0])),
            Motion::Held | Motion::Side(_) | Motion::Plane => (star, Vector3([0.2, 0.05, 1.0])),
            Motion::Circle => {
                star.arcs = Some([(corner(3), 0.4), (corner(0), 0.9)]);
                (star, rotated(Vector3([0.0, -1.0, 1.0]), -0.1))
            }
        }
    }

    #[test]
    fn derivatives_are_those_of_finite_differences() {
        for motion in [Motion::Sphere, Motion::Plane, Motion::Circle] {
            let (star, x) = star(motion);
            let frame = motion.frame(x);
            let (energy, Derivatives { gradient, hessian }) =
                star.derivatives(x, motion, &frame, 0.3).unwrap();
            let at = |a: f64, b: f64| star.energy(motion.moved(x, &frame, [a, b]), 0.3).unwrap();
            assert!((energy - at(0.0, 0.0)).abs() < 1e-12, "{motion:?}");
            let h = 1e-4;
            let slopes = [(at(h, 0.0) - at(-h, 0.0)) / (2.0 * h), (at(0.0, h) - at(0.0, -h)) / (2.0 * h)];
            let bends = [
                (at(h, 0.0) + at(-h, 0.0) - 2.0 * energy) / (h * h),
                (at(h, h) + at(-h, -h) - at(h, -h) - at(-h, h)) / (4.0 * h * h),
                (at(0.0, h) + at(0.0, -h) - 2.0 * energy) / (h * h),
            ];
            let n = if motion == Motion::Circle { 1 } else { 2 };
            let close = |a: f64, b: f64| (a - b).abs() < 1e-4 * (1.0 + b.abs());
            assert!((0..n).all(|k| close(slopes[k], gradient[k])), "{motion:?}: {slopes:?} {gradient:?}");
            assert!((0..2 * n - 1).all(|k| close(bends[k], hessian[k])), "{motion:?}: {bends:?} {hessian:?}");
        }
    }

    #[test]
    fn a_step_lowers_the_energy_and_folds_nothing() {
        for motion in [Motion::Sphere, Motion::Plane, Motion::Circle] {
            let (star, mut x) = star(motion);
            for _ in 0..20 {
                let Some(better) = star.improved(x, motion, 0.3) else { break };
                assert!(star.energy(better, 0.3).unwrap() < star.energy(x, 0.3).unwrap(), "{motion:?}");
                x = better;
            }
            let frame = motion.frame(x);
            let (_, Derivatives { gradient, .. }) = star.derivatives(x, motion, &frame, 0.3).unwrap();
            assert!(gradient[0].hypot(gradient[1]) < 1e-2, "{motion:?}: {gradient:?}");
        }
    }
}
