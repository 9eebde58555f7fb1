// SPDX-License-Identifier: MIT OR Apache-2.0
//! The morph along a registration.

use crate::alignment::similarity::similarity;
use crate::parallel;
use crate::vector::Vector3;

/// The morph (1 − t) v + t g(v) from `vertices` (n, 3) at t = 0 to their `positions` (n, 3) on the target at t = 1.
///
/// # Panics
/// If the lengths differ.
///
/// ```
/// use authalic::{Vector3, registration::homotopy};
///
/// let (vertex, position) = (Vector3::ZERO, Vector3([1.0, 2.0, 4.0]));
/// assert_eq!(homotopy(&[vertex], &[position], 0.25), [Vector3([0.25, 0.5, 1.0])]);
/// ```
pub fn homotopy(vertices: &[Vector3], positions: &[Vector3], t: f64) -> Vec<Vector3> {
    assert_eq!(vertices.len(), positions.len(), "one position per vertex");
    parallel::map(vertices.len(), |v| vertices[v] * (1.0 - t) + positions[v] * t)
}

/// The morph from `vertices` to `positions` after the best similarity, with `weights` (n,), of `positions` onto
/// `vertices`: the shape changes but does not travel.
///
/// # Panics
/// If the lengths differ.
pub fn aligned_homotopy(
    vertices: &[Vector3],
    positions: &[Vector3],
    weights: &[f64],
    t: f64,
) -> Vec<Vector3> {
    let motion = similarity(positions, vertices, weights);
    let aligned: Vec<Vector3> = positions.iter().map(|&position| motion.apply(position)).collect();
    homotopy(vertices, &aligned, t)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::alignment::similarity::tests::cloud;

    #[test]
    fn a_morph_begins_and_ends_exactly() {
        let (from, to) = (cloud(9), cloud(18).split_off(9));
        assert_eq!(homotopy(&from, &to, 0.0), from);
        assert_eq!(homotopy(&from, &to, 1.0), to);
        let middle = homotopy(&from, &to, 0.5);
        (0..9).for_each(|v| assert!(middle[v].distance((from[v] + to[v]) * 0.5) < 1e-15));
    }
}
