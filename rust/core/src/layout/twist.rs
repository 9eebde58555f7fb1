// SPDX-License-Identifier: MIT OR Apache-2.0
//! Motions of the sphere that preserve areas and take a given point to another.
//!
//! A twist turns each circle about a center rigidly: by the same angle up to the circle of the two points, by less
//! farther out, and not at all where points are fixed. In the coordinate log tan (δ/2) of the distance δ from the
//! center, an angle that falls linearly shears uniformly; here it falls by a smooth step.

use crate::mesh::ties::first_smallest;
use crate::vector::Vector3;

/// Width of the rigid ring beyond the circle of the moved point, as a fraction of the way to where the sphere rests.
const RIGID: f64 = 0.15;

/// Distance from which the sphere rests, as a fraction of the distance of the nearest fixed point.
const AT_FIXED: f64 = 0.999;

/// Largest distance from the center at which the sphere still turns (radians).
const WIDEST: f64 = 120.0 / DEGREES;

/// Distances from the midpoint of the two points at which centers are tried (degrees).
const DISTANCES: [f64; 9] = [5.0, 10.0, 15.0, 20.0, 30.0, 40.0, 55.0, 70.0, 85.0];

/// Least room for slowing down, as a fraction of the radius of the circle of the moved point.
const LEAST_ROOM: f64 = 0.1;

/// Degrees per radian.
const DEGREES: f64 = 180.0 / std::f64::consts::PI;

/// A side of the way of a point, seen from outside the sphere.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    Left,
    Right,
}

/// A motion of the sphere.
#[derive(Debug, Clone, Copy)]
pub(super) enum Motion {
    /// A rotation by a matrix, given by its rows.
    Rotation([Vector3; 3]),
    /// A turn by an angle that depends on the distance from a center.
    Twist(Twist),
}

/// A turn about a center: by `angle` up to the distance `near`, less and less up to `far`, not at all beyond.
#[derive(Debug, Clone, Copy)]
pub(super) struct Twist {
    center: Vector3,
    angle: f64,
    near: f64,
    far: f64,
}

impl Motion {
    /// The rotation by the smallest angle that takes one point of the unit sphere to another.
    pub fn rotation(start: Vector3, goal: Vector3) -> Self {
        let (axis, cosine) = (start.cross(goal), start.dot(goal));
        if cosine < -1.0 + 1e-12 {
            return half_turn(start);
        }
        let Vector3([x, y, z]) = axis;
        let turn = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]];
        // I + K + K²/(1 + cos), by Rodrigues' formula
        let square = |i: usize, j: usize| (0..3).map(|k| turn[i][k] * turn[k][j]).sum::<f64>();
        Self::Rotation(
            [0, 1, 2]
                .map(|i| Vector3::unit(i) + Vector3::from_fn(|j| turn[i][j] + square(i, j) / (1.0 + cosine))),
        )
    }

    /// The twist of least shear that takes `start` to `goal` and keeps the points `fixed`; `None` if there is no room
    /// for one. Of two of equal shear, as centers on either side of the way often have, that of the `side` is taken.
    pub fn twist(start: Vector3, goal: Vector3, fixed: &[Vector3], side: Side) -> Option<Self> {
        if start.distance(goal) < 1e-15 {
            return Some(Self::rotation(goal, goal));
        }
        let twists: Vec<Twist> = centers(start, goal, side)
            .into_iter()
            .filter_map(|center| Twist::about(center, start, goal, fixed))
            .collect();
        first_smallest(twists.iter().map(Twist::shear)).map(|best| Self::Twist(twists[best]))
    }

    /// Where a point of the unit sphere goes.
    pub fn image(&self, point: Vector3) -> Vector3 {
        match self {
            Self::Rotation(rows) => Vector3(rows.map(|row| row.dot(point))),
            Self::Twist(twist) => twist.image(point),
        }
    }
}

impl Twist {
    /// The twist about a center equally far from both points.
    fn about(center: Vector3, start: Vector3, goal: Vector3, fixed: &[Vector3]) -> Option<Self> {
        let radius = distance(start, center);
        let nearest = fixed.iter().map(|&point| distance(point, center)).fold(f64::INFINITY, f64::min);
        let far = (nearest * AT_FIXED).min(WIDEST);
        if far <= (1.0 + LEAST_ROOM) * radius {
            return None;
        }
        let [a, b] = [start, goal].map(|point| point - center * point.dot(center));
        let angle = a.cross(b).dot(center).atan2(a.dot(b));
        Some(Self { center, angle, near: radius + RIGID * (far - radius), far })
    }

    /// The largest shear.
    fn shear(&self) -> f64 {
        1.5 * self.angle.abs() / (log_tan(self.far) - log_tan(self.near))
    }

    fn image(&self, point: Vector3) -> Vector3 {
        let distance = distance(point, self.center).max(1e-9);
        let share = (log_tan(distance) - log_tan(self.near)) / (log_tan(self.far) - log_tan(self.near));
        let share = share.clamp(0.0, 1.0);
        let angle = self.angle * (1.0 - share * share * (3.0 - 2.0 * share));
        if angle == 0.0 { point } else { turned(point, self.center, angle) }
    }
}

/// Half a turn about an axis perpendicular to a point.
fn half_turn(point: Vector3) -> Motion {
    let least = (0..3).min_by(|&i, &j| point[i].abs().total_cmp(&point[j].abs())).unwrap_or(0);
    let axis = point.cross(Vector3::unit(least)).normalized();
    Motion::Rotation([0, 1, 2].map(|i| axis * (2.0 * axis[i]) - Vector3::unit(i)))
}

/// Centers equally far from both points, on either side of them, those of one side first.
fn centers(start: Vector3, goal: Vector3, first: Side) -> Vec<Vector3> {
    let (middle, across) = (start + goal, start.cross(goal));
    if middle.norm() < 1e-9 || across.norm() == 0.0 {
        return Vec::new();
    }
    let (middle, across) = (middle.normalized(), across.normalized());
    let center = |distance: f64, side: f64| middle * distance.cos() + across * (side * distance.sin());
    let sides = match first {
        Side::Left => [1.0, -1.0],
        Side::Right => [-1.0, 1.0],
    };
    DISTANCES.iter().flat_map(|d| sides.map(|side| center(d / DEGREES, side))).collect()
}

/// The angle between two points of the unit sphere.
fn distance(a: Vector3, b: Vector3) -> f64 {
    a.cross(b).norm().atan2(a.dot(b))
}

fn log_tan(distance: f64) -> f64 {
    (distance / 2.0).tan().ln()
}

fn turned(point: Vector3, axis: Vector3, angle: f64) -> Vector3 {
    let along = axis * point.dot(axis);
    (along + (point - along) * angle.cos() + axis.cross(point) * angle.sin()).normalized()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::sample_spheres::small_triangles;
    use crate::mesh::geometry::area;

    const FIXED: [Vector3; 3] =
        [Vector3([0.0, 1.0, 0.0]), Vector3([0.0, -1.0, 0.0]), Vector3([-1.0, 0.0, 0.0])];

    #[test]
    fn a_twist_keeps_areas_and_fixed_points() {
        let (start, goal) = (Vector3([1.0, 0.05, 0.08]).normalized(), Vector3::unit(0));
        let twist = Motion::twist(start, goal, &FIXED, Side::Left).unwrap();
        assert!(twist.image(start).distance(goal) < 1e-14);
        for point in FIXED {
            assert!(twist.image(point).distance(point) < 1e-14);
        }
        let mut farthest: f64 = 0.0;
        for corners in small_triangles() {
            let moved = corners.map(|corner| twist.image(corner));
            farthest = farthest.max(moved[0].distance(corners[0]));
            assert!((moved[0].norm() - 1.0).abs() < 1e-14);
            assert!((area(moved) / area(corners) - 1.0).abs() < 5e-3);
            let orientation = |[a, b, c]: [Vector3; 3]| (b - a).cross(c - a).dot(a).signum();
            assert_eq!(orientation(moved), orientation(corners));
        }
        assert!(farthest > 0.05);
    }

    #[test]
    fn rounding_does_not_choose_the_side_of_a_twist() {
        // both sides give the same shear where start, goal and the fixed point lie on a great circle
        let goal = -Vector3::unit(2);
        for k in 0..20 {
            let angle = f64::from(k);
            let start = Vector3([0.02 * angle.cos(), 0.02 * angle.sin(), -1.0]).normalized();
            for (side, sign) in [(Side::Left, 1.0), (Side::Right, -1.0)] {
                let Some(Motion::Twist(twist)) = Motion::twist(start, goal, &[Vector3::unit(2)], side) else {
                    panic!("there is room")
                };
                let toward = sign * twist.center.dot(start.cross(goal));
                assert!(toward > 0.0, "{k}, {side:?}: {toward}");
            }
        }
    }

    #[test]
    fn a_rotation_takes_its_start_to_its_goal() {
        let start = Vector3([0.3, -0.4, 0.5]).normalized();
        for goal in [Vector3([-1.0, 2.0, 0.1]).normalized(), -start, start] {
            let rotation = Motion::rotation(start, goal);
            assert!(rotation.image(start).distance(goal) < 1e-14);
        }
    }

    #[test]
    fn there_is_no_twist_where_a_fixed_point_is_in_the_way() {
        let between = Vector3([1.0, 1.0, 0.0]).normalized();
        assert!(Motion::twist(Vector3::unit(0), Vector3::unit(1), &[between], Side::Left).is_none());
    }
}
