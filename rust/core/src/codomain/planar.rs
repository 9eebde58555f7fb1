// SPDX-License-Identifier: MIT OR Apache-2.0
//! Maps into the plane, as pairs and in space as the plane z = 1.

use crate::vector::Vector3;

/// A map of the vertices into the plane, (n, 2).
pub(crate) type PlanarMap = Vec<[f64; 2]>;

/// Points of the plane in the plane z = 1.
pub(crate) fn lifted(points: &[[f64; 2]]) -> Vec<Vector3> {
    points.iter().map(|&[u, v]| Vector3([u, v, 1.0])).collect()
}

/// Points of the plane z = 1 as points of the plane.
pub(crate) fn flat(points: &[Vector3]) -> PlanarMap {
    points.iter().map(|&Vector3([u, v, _])| [u, v]).collect()
}
