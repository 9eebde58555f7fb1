// SPDX-License-Identifier: MIT OR Apache-2.0
//! The star of a vertex with the shapes that its faces have on a surface, and a Newton step of the vertex that makes
//! their images more similar to them.
//!
//! Per face with target area T, E = T Q/D, where D = det(x, p, q) is twice the area of the image and
//! Q = Σ cot(angle opposite) edge² twice its Dirichlet energy (K. Hormann and G. Greiner, MIPS, 2000): 1 where the face
//! and its image are similar, infinite at a fold.
//!
//! Cost: about a hundred operations for each face and step.

use super::star::{Derivatives, Face};
use crate::codomain::motion::Motion;
use crate::mesh::geometry::area;
use crate::vector::Vector3;

/// Tries of a step, each .4 of the one before.
const TRIES: usize = 8;

/// A step is worthwhile if it lowers the energy by this part or more.
const WORTH: f64 = 1e-6;

/// The polygon around a vertex.
#[derive(Debug, Default)]
pub(super) struct ConformalStar {
    faces: Vec<ConformalFace>,
}

#[derive(Debug)]
struct ConformalFace {
    image: Face,
    target: f64,
    /// Q(x) = a x·x − 2 x·b + c.
    a: f64,
    b: Vector3,
    c: f64,
}

impl ConformalStar {
    /// Forgets all faces.
    pub(super) fn clear(&mut self) {
        self.faces.clear();
    }

    /// Adds the face between the vertex and two neighbors, which follow it counter-clockwise: their images, and the
    /// corners on the surface, first that of the vertex.
    pub(super) fn push(&mut self, [p, q]: [Vector3; 2], corners: [Vector3; 3]) {
        let target = area(corners);
        let cotangent = |k: usize| {
            let [here, next, after] = [0, 1, 2].map(|i| corners[(k + i) % 3]);
            0.5 * (next - here).dot(after - here) / target
        };
        let [at_x, at_p, at_q] = [0, 1, 2].map(cotangent);
        let edge = q - p;
        self.faces.push(ConformalFace {
            image: Face::new(p, q, target),
            target,
            a: at_p + at_q,
            b: q * at_p + p * at_q,
            c: at_p * q.dot(q) + at_q * p.dot(p) + at_x * edge.dot(edge),
        });
    }

    /// The edges of the polygon.
    pub(super) fn edges(&self) -> impl Iterator<Item = [Vector3; 2]> + Clone {
        self.faces.iter().map(|face| face.image.ends)
    }

    /// The energy with the vertex at x; `None` where a face is not clearly positive.
    pub(super) fn energy(&self, x: Vector3) -> Option<f64> {
        let of_face =
            |face: &ConformalFace| Some(0.5 * face.target * face.size(x) / face.image.determinant(x)?);
        let sum: f64 = self.faces.iter().map(of_face).sum::<Option<f64>>()?;
        sum.is_finite().then_some(sum)
    }

    /// The place of the vertex after one Newton step from x that lowers the energy and folds no face; `None` where there
    /// is no such step or it is not worthwhile.
    pub(super) fn improved(&self, x: Vector3, motion: Motion) -> Option<Vector3> {
        let frame = motion.frame(x);
        let energy = self.energy(x)?;
        // 1. The derivatives
        let (mut gradient, mut hessian) = (Vector3::ZERO, [0.0; 3]);
        for face in &self.faces {
            let (d, q) = (face.image.determinant(x)?, face.size(x));
            let (on_q, on_d) = (0.5 * face.target / d, -0.5 * face.target * q / (d * d));
            let (normal, slope) = (face.image.normal, (x * face.a - face.b) * 2.0);
            gradient += normal * on_d + slope * on_q;
            let [n, s] = [normal, slope].map(|z| frame.axes.map(|axis| axis.dot(z)));
            let (on_dd, on_dq) = (-2.0 * on_d / d, -on_q / d);
            hessian[0] += on_dd * n[0] * n[0] + 2.0 * on_dq * n[0] * s[0] + 2.0 * face.a * on_q;
            hessian[1] += on_dd * n[0] * n[1] + on_dq * (n[0] * s[1] + s[0] * n[1]);
            hessian[2] += on_dd * n[1] * n[1] + 2.0 * on_dq * n[1] * s[1] + 2.0 * face.a * on_q;
        }
        let bend = gradient.dot(frame.outward);
        hessian[0] -= bend;
        hessian[2] -= bend;
        // 2. The step
        let derivatives = Derivatives { gradient: frame.axes.map(|axis| axis.dot(gradient)), hessian };
        let (direction, slope) = derivatives.newton_direction()?;
        if -slope < WORTH * energy {
            return None;
        }
        let mut step = 1.0;
        for _ in 0..TRIES {
            let moved = motion.moved(x, &frame, direction.map(|d| step * d));
            if self.energy(moved).is_some_and(|now| now <= energy + 1e-4 * step * slope) {
                return Some(moved);
            }
            step *= 0.4;
        }
        None
    }
}

impl ConformalFace {
    /// Q.
    fn size(&self, x: Vector3) -> f64 {
        self.a * x.dot(x) - 2.0 * x.dot(self.b) + self.c
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A flat star around a point inside an irregular pentagon, and the images of its neighbors: turned, twice as large
    /// in the plane z = 1.
    fn star() -> (ConformalStar, Vector3, f64) {
        let on_surface = |k: usize| {
            let (sine, cosine) = (1.2 * k as f64).sin_cos();
            Vector3([(2.0 + 0.3 * k as f64) * cosine, 1.5 * sine, 0.0])
        };
        let center = Vector3([0.3, -0.2, 0.0]);
        let image = |Vector3([x, y, _]): Vector3| Vector3([0.5 - 2.0 * y, 0.1 + 2.0 * x, 1.0]);
        let mut star = ConformalStar::default();
        let mut total = 0.0;
        for k in 0..5 {
            let corners = [center, on_surface(k), on_surface((k + 1) % 5)];
            star.push([image(corners[1]), image(corners[2])], corners);
            total += area(corners);
        }
        (star, image(center), total)
    }

    #[test]
    fn the_energy_of_similar_faces_is_their_area_and_the_least() {
        let (star, place, total) = star();
        let energy = star.energy(place).unwrap();
        assert!((energy - total).abs() < 1e-12 * total);
        for [x, y] in [[0.1, 0.0], [-0.1, 0.0], [0.0, 0.2], [0.2, -0.3]] {
            assert!(star.energy(place + Vector3([x, y, 0.0])).unwrap() > energy);
        }
    }

    #[test]
    fn newton_finds_the_place_where_shapes_are_kept() {
        let (star, place, _) = star();
        let mut x = place + Vector3([0.9, -0.7, 0.0]);
        for _ in 0..20 {
            let Some(better) = star.improved(x, Motion::Plane) else { break };
            assert!(star.energy(better) < star.energy(x));
            x = better;
        }
        assert!(x.distance(place) < 1e-3, "{}", x.distance(place));
    }

    #[test]
    fn on_the_sphere_a_step_stays_there_and_lowers_the_energy() {
        let mut star = ConformalStar::default();
        let corners = [[0.0, 0.0], [1.0, 0.0], [0.1, 1.0], [-1.0, 0.2], [-0.1, -0.8]]
            .map(|[x, y]| Vector3([x, y, 0.0]));
        for k in 0..4 {
            let [p, q] = [1 + k, 1 + (k + 1) % 4].map(|k| corners[k]);
            star.push([p, q].map(|x| (x * 0.4 + Vector3::unit(2)).normalized()), [corners[0], p, q]);
        }
        let x = Vector3([0.15, -0.1, 1.0]).normalized();
        let better = star.improved(x, Motion::Sphere).unwrap();
        assert!((better.norm() - 1.0).abs() < 1e-15);
        assert!(star.energy(better).unwrap() < star.energy(x).unwrap());
    }

    #[test]
    fn a_fold_has_no_energy() {
        let (star, place, _) = star();
        assert_eq!(star.energy(place + Vector3([40.0, 0.0, 0.0])), None);
    }
}
