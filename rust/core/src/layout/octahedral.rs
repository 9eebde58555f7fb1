// SPDX-License-Identifier: MIT OR Apache-2.0
//! The equal-area octahedral map (Clarberg, Fast Equal-Area Mapping of the (Hemi)Sphere using SIMD, 2008).
//!
//! A square with the north pole in its middle and the south pole in its four corners. On the northern hemisphere, with
//! r = √(1 − |z|) and the longitude φ within an octant, 0 ≤ φ ≤ π/2,
//!
//! ```text
//! (u, v) = r (1 − 2φ/π, 2φ/π),
//! ```
//!
//! which keeps areas up to the factor 1/π; the southern hemisphere is folded outwards, (u, v) ↦ (1 − v, 1 − u). Each
//! side of the square is glued to itself by a half turn about its middle, a point of the equator. So there are four
//! cuts, from each of these points along its meridian to the south pole.

use std::f64::consts::{FRAC_2_PI, PI};

use super::isometry::Isometry;
use super::projection::{Extent, Projection};
use crate::vector::Vector3;

/// Distance from the south pole, where the four cuts meet, below which a point is moved beside it.
const ON_POLE: f64 = 1e-9;

/// The longitude of the point beside the pole, on none of the cuts (radians).
const BESIDE_POLE: f64 = 0.3;

/// The equal-area octahedral map.
pub(super) struct Octahedral;

impl Projection for Octahedral {
    const SINGULAR: &'static [Vector3] = &[
        Vector3([1.0, 0.0, 0.0]),
        Vector3([0.0, 1.0, 0.0]),
        Vector3([-1.0, 0.0, 0.0]),
        Vector3([0.0, -1.0, 0.0]),
    ];
    const SCALE: f64 = 1.0 / PI;
    const HAS_CONES: bool = true;
    const PERIODS: [f64; 2] = [2.0, 2.0];

    fn place(point: Vector3) -> [f64; 2] {
        let Vector3([x, y, z]) = off_the_pole(point);
        let radius = x.hypot(y) / (1.0 + z.abs()).sqrt();
        let along = y.abs().atan2(x.abs()) * FRAC_2_PI;
        let (u, v) = (radius * (1.0 - along), radius * along);
        let (u, v) = if z < 0.0 { (1.0 - v, 1.0 - u) } else { (u, v) };
        [if x < 0.0 { -u } else { u }, if y < 0.0 { -v } else { v }]
    }

    fn crossing(start: Vector3, end: Vector3) -> Isometry {
        let (start, end) = (off_the_pole(start), off_the_pole(end));
        if start[2] >= 0.0 && end[2] >= 0.0 {
            return Isometry::default();
        }
        // an arc may cross two cuts, in the order of their places along it
        let mut crossed: Vec<(f64, Isometry)> =
            Self::SINGULAR.iter().filter_map(|&middle| cut_crossed(start, end, middle)).collect();
        crossed.sort_by(|a, b| a.0.total_cmp(&b.0));
        crossed.iter().fold(Isometry::default(), |all, &(_, half_turn)| all.after(half_turn))
    }

    fn home(extent: &Extent) -> Isometry {
        let [i, j] = extent.center.map(|x| (x / 2.0).round_ties_even() as i32);
        if (i + j) % 2 == 0 { Isometry::translation([-i, -j]) } else { Isometry::half_turn([i, j]) }
    }

    fn has_strayed(_extent: &Extent) -> bool {
        false
    }

    fn is_within(_place: [f64; 2]) -> bool {
        true
    }

    /// The square with the area of the sphere, the seam direction at its upper side.
    fn finished([u, v]: [f64; 2]) -> [f64; 2] {
        let side = PI.sqrt();
        [-side * v, side * u]
    }
}

/// The point itself, or a point beside the south pole if it lies there.
fn off_the_pole(point: Vector3) -> Vector3 {
    let Vector3([x, y, z]) = point;
    if x.hypot(y) < ON_POLE && z < 0.0 {
        return Vector3([ON_POLE * BESIDE_POLE.cos(), ON_POLE * BESIDE_POLE.sin(), -1.0]);
    }
    point
}

/// Where along an arc, from 0 to 1, it crosses the cut from `middle`, and the half turn across that cut.
fn cut_crossed(start: Vector3, end: Vector3, middle: Vector3) -> Option<(f64, Isometry)> {
    // the sign of one coordinate decides the side of the meridian, as in `place`
    let across = if middle[0] == 0.0 { 0 } else { 1 };
    if (start[across] < 0.0) == (end[across] < 0.0) {
        return None;
    }
    let (before, after) = (start[across].abs(), end[across].abs());
    let meeting = start * after + end * before;
    if meeting.dot(middle) <= 0.0 || meeting[2] >= 0.0 {
        return None;
    }
    let center = [middle[0] as i32, middle[1] as i32];
    Some((before / (before + after).max(f64::MIN_POSITIVE), Isometry::half_turn(center)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit(x: f64, y: f64, z: f64) -> Vector3 {
        Vector3([x, y, z]).normalized()
    }

    #[test]
    fn the_square_has_north_in_its_middle_and_south_in_its_corners() {
        let places = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]];
        let places = places.map(|point| Octahedral::place(Vector3(point)));
        assert_eq!(places, [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]]);
        for (x, y) in [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)] {
            let [u, v] = Octahedral::place(unit(x, y, -1e6));
            assert!((u - x).abs() < 1e-5 && (v - y).abs() < 1e-5, "{u} {v}");
        }
    }

    #[test]
    fn images_of_the_two_sides_of_a_cut_meet() {
        // across each cut, and from points that lie on one exactly
        for (middle, along) in [([1.0, 0.0], [0.0, 1.0]), ([0.0, 1.0], [1.0, 0.0])] {
            for sign in [1.0, -1.0] {
                for step in [1e-9, -1e-9] {
                    let at =
                        |t: f64| unit(sign * middle[0] + t * along[0], sign * middle[1] + t * along[1], -0.7);
                    let (start, end) = (at(0.0), at(step));
                    let image =
                        Octahedral::crossing(start, end).image(Octahedral::PERIODS, Octahedral::place(end));
                    let place = Octahedral::place(start);
                    let apart = (image[0] - place[0]).hypot(image[1] - place[1]);
                    assert!(apart < 1e-8, "{start:?} {end:?}: {place:?} {image:?}");
                }
            }
        }
    }
}
