// SPDX-License-Identifier: MIT OR Apache-2.0
//! Lambert's cylindrical equal-area projection (1772; Snyder, Map Projections: A Working Manual, 1987, §10).
//!
//! The point at longitude λ and height z = sin φ goes to (λ, z): a rectangle of width 2π and height 2, with the areas
//! of the sphere by the theorem of Archimedes. The seam is the meridian λ = 0, the poles are the upper and the lower
//! side.

use std::f64::consts::TAU;

use super::isometry::Isometry;
use super::projection::{Extent, Projection};
use crate::vector::Vector3;

/// Distance to the left of the seam up to which a polygon counts as on the seam (radians).
const ON_SEAM: f64 = 1e-5;

/// Distance beyond the seam above which a polygon has strayed (radians).
const STRAYED: f64 = 0.01;

/// Lambert's cylindrical equal-area projection.
pub(super) struct Lambert;

impl Projection for Lambert {
    const SINGULAR: &'static [Vector3] = &[Vector3([0.0, 0.0, 1.0]), Vector3([0.0, 0.0, -1.0])];
    const SCALE: f64 = 1.0;
    const HAS_CONES: bool = false;
    const PERIODS: [f64; 2] = [TAU, 0.0];

    fn place(Vector3([x, y, z]): Vector3) -> [f64; 2] {
        let longitude = y.atan2(x).rem_euclid(TAU);
        // −1e-17 is rounded to a whole turn
        [if longitude >= TAU { 0.0 } else { longitude }, z]
    }

    fn crossing(start: Vector3, end: Vector3) -> Isometry {
        let turns = ((Self::place(end)[0] - Self::place(start)[0]) / TAU).round();
        Isometry::translation([-turns as i32, 0])
    }

    fn home(extent: &Extent) -> Isometry {
        let turns = ((extent.low[0] + ON_SEAM) / TAU).floor();
        Isometry::translation([-turns as i32, 0])
    }

    fn has_strayed(extent: &Extent) -> bool {
        !(-STRAYED..=TAU + STRAYED).contains(&extent.low[0])
    }

    fn is_within([_, height]: [f64; 2]) -> bool {
        height.abs() < 1.0
    }

    fn finished(place: [f64; 2]) -> [f64; 2] {
        place
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn longitudes_are_within_a_turn_and_an_arc_over_the_seam_is_short() {
        let at = |longitude: f64| Vector3([longitude.cos(), longitude.sin(), 0.0]);
        assert_eq!(Lambert::place(Vector3([1.0, -1e-17, 0.0])), [0.0, 0.0]);
        let crossing = Lambert::crossing(at(0.1), at(-0.1));
        let end = crossing.image(Lambert::PERIODS, Lambert::place(at(-0.1)));
        assert!((end[0] + 0.1).abs() < 1e-15, "{end:?}");
        assert_eq!(Lambert::crossing(at(1.0), at(2.0)), Isometry::default());
    }
}
