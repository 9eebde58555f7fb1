// SPDX-License-Identifier: MIT OR Apache-2.0
//! The motions of the vertices of a map, on the disk and on the sphere alike.
//!
//! All codomains lie in space: the sphere around the origin, the disk in the plane z = 1. Then det(x_i, x_j, x_k) is
//! positive exactly where a face is not folded. A vertex has two unknowns, one or none: its coordinates along the
//! [`Frame`] at its place. [`Motion::moved`] retracts them onto the codomain.

use crate::parallel;
use crate::vector::Vector3;

/// The motion of one vertex.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Motion {
    /// Stays fixed.
    Held,
    /// Slides along the unit circle of the plane z = 1, by an angle.
    Circle,
    /// Slides in the plane z = 1 along an axis, 0 or 1, as on a side of a rectangle.
    Side(usize),
    /// Moves in the plane z = 1.
    Plane,
    /// Moves on the unit sphere.
    Sphere,
}

/// The axes of the plane.
const UNITS: [Vector3; 2] = [Vector3([1.0, 0.0, 0.0]), Vector3([0.0, 1.0, 0.0])];

/// The directions in which a vertex may leave its place.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Frame {
    /// Unit vectors; zero where the vertex cannot move.
    pub axes: [Vector3; 2],
    /// The outward normal of the vertex's path: along ξ its acceleration is −|ξ|² times this.
    pub outward: Vector3,
}

impl Motion {
    /// The number of unknowns of a vertex.
    pub(crate) fn n_unknowns(self) -> u8 {
        match self {
            Self::Held => 0,
            Self::Circle | Self::Side(_) => 1,
            Self::Plane | Self::Sphere => 2,
        }
    }

    /// The frame at `x`.
    pub(crate) fn frame(self, x: Vector3) -> Frame {
        match self {
            Self::Held => Frame::default(),
            Self::Circle => Frame {
                axes: [Vector3([-x[1], x[0], 0.0]), Vector3::ZERO],
                outward: Vector3([x[0], x[1], 0.0]),
            },
            Self::Side(along) => Frame { axes: [UNITS[along], Vector3::ZERO], outward: Vector3::ZERO },
            Self::Plane => Frame { axes: UNITS, outward: Vector3::ZERO },
            Self::Sphere => Frame { axes: tangent_axes(x), outward: x },
        }
    }

    /// The retraction: the place reached from `x` by `unknowns` along its frame, straight in the plane, by a rotation
    /// on the circle, by normalization on the sphere.
    pub(crate) fn moved(self, x: Vector3, frame: &Frame, unknowns: [f64; 2]) -> Vector3 {
        let [a, b] = unknowns;
        match self {
            Self::Held => x,
            Self::Circle => rotated(x, a),
            Self::Side(0) => Vector3([x[0] + a, x[1], 1.0]),
            Self::Side(_) => Vector3([x[0], x[1] + a, 1.0]),
            Self::Plane => Vector3([x[0] + a, x[1] + b, 1.0]),
            Self::Sphere => {
                let moved = x + (frame.axes[0] * a + frame.axes[1] * b);
                moved.normalized()
            }
        }
    }
}

/// The frames of all vertices.
pub(crate) fn frames(motions: &[Motion], map: &[Vector3]) -> Vec<Frame> {
    parallel::map(map.len(), |vertex| motions[vertex].frame(map[vertex]))
}

/// A point of the circle rotated by an angle.
pub(crate) fn rotated(Vector3([u, v, _]): Vector3, angle: f64) -> Vector3 {
    let (sine, cosine) = angle.sin_cos();
    let (u, v) = (u * cosine - v * sine, u * sine + v * cosine);
    let length = (u * u + v * v).sqrt();
    Vector3([u / length, v / length, 1.0])
}

/// Two unit vectors that make an orthonormal frame with the unit vector `x` (Duff et al. 2017).
fn tangent_axes(Vector3([x, y, z]): Vector3) -> [Vector3; 2] {
    let sign = 1f64.copysign(z);
    let a = -1.0 / (sign + z);
    let b = x * y * a;
    [Vector3([1.0 + sign * x * x * a, sign * b, -sign * x]), Vector3([b, sign + y * y * a, -y])]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_start_along_the_frame_and_bend_away_from_outward() {
        let places = [
            (Motion::Circle, [0.6, -0.8, 1.0], [1.0, 0.0]),
            (Motion::Side(0), [0.3, 0.2, 1.0], [1.0, 0.0]),
            (Motion::Side(1), [0.3, 0.2, 1.0], [-2.0, 0.0]),
            (Motion::Plane, [0.3, 0.2, 1.0], [0.6, 0.8]),
            (Motion::Sphere, [2.0 / 7.0, -3.0 / 7.0, 6.0 / 7.0], [0.6, 0.8]),
        ];
        for (motion, x, along) in places {
            let x = Vector3(x);
            let frame = motion.frame(x);
            let at = |t: f64| motion.moved(x, &frame, along.map(|a| t * a));
            let (h, back, here, there) = (1e-4, at(-1e-4), at(0.0), at(1e-4));
            for k in 0..3 {
                let velocity = along[0] * frame.axes[0][k] + along[1] * frame.axes[1][k];
                assert!((here[k] - x[k]).abs() < 1e-15);
                assert!(((there[k] - back[k]) / (2.0 * h) - velocity).abs() < 1e-7);
                let acceleration = (there[k] + back[k] - 2.0 * here[k]) / (h * h);
                assert!((acceleration + frame.outward[k]).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn tangent_axes_are_orthonormal() {
        for x in [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.48, 0.6, 0.64]].map(Vector3) {
            let [a, b] = tangent_axes(x);
            assert!(a.dot(b).abs() < 1e-15 && a.dot(x).abs() < 1e-15 && b.dot(x).abs() < 1e-15);
            assert!((a.cross(b) - x).norm() < 1e-12 || (a.cross(b) + x).norm() < 1e-12);
        }
    }
}
