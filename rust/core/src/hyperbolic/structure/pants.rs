// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pairs of pants between closed geodesics, and the two right-angled hexagons of each.
//!
//! Two generators g and h of a Fuchsian group whose axes are disjoint span a pair of pants: its boundaries
//! are the axes of g, of g⁻¹h (or of h g⁻¹, a copy of the same curve) and of h. The common perpendiculars of
//! these lines divide it into two congruent hexagons, which are convex in Klein's model (Shi et al. 2013,
//! section 3.1 and figure 3). Half the lengths of the boundaries determine it by the law of cosines of
//! right-angled hexagons. Its placement is linear algebra on the hyperboloid: a line is given by its unit normal
//! in the Lorentz product, a common perpendicular by the Lorentz cross product of two normals.
//!
//! Cost: constant.

use crate::hyperbolic::moebius::{Complex, Moebius, exponential, from_hyperboloid, seen_from, to_klein};
use crate::vector::Vector3;

/// A pair of pants.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pants {
    /// The lengths of the boundaries: the pants curve before, the feature, the pants curve after; at the ends
    /// of the chain the first and the last feature take the place of pants curves.
    pub boundary_lengths: [f64; 3],
    /// The corners of both hexagons in Klein's model. Their sides 0–1, 2–3 and 4–5 lie on the boundaries in
    /// the order of the lengths and are half as long, the others are the perpendiculars; 5–0 is common to
    /// both and lies on the imaginary axis with its middle in the origin. The first lies on the right, at the
    /// left bank of the feature, counterclockwise; the second is its mirror image.
    pub hexagons: [[Complex; 6]; 2],
    /// The inner angles, π/2 up to rounding.
    pub angles: [[f64; 6]; 2],
    /// The isometry from the disk of the hexagons to that of the fundamental domain.
    pub placement: Moebius,
}

/// The pair of pants between the axes of two generators; its placement leads to the disk in which these act.
pub(super) fn pants(g: Moebius, h: Moebius) -> Pants {
    // 1. The boundaries: both axes, and between them the feature by its left bank
    let motions = [g, g.inverse() * h, h];
    let lengths = motions.map(|motion| motion.translation_length());
    // 2. A hexagon by half their lengths, and its mirror image
    let right = hexagon(lengths.map(|length| 0.5 * length));
    let hexagons = [right, right.map(|corner| -corner.conj())];
    // 3. Its placement by the perpendicular between the first axis and the feature, as axes of long curves nearly
    //    touch
    let [before, feature] = [motions[0], motions[1]].map(axis);
    let placement = Moebius::between([right[1], right[2]], feet(before, feature));
    Pants {
        boundary_lengths: lengths,
        angles: hexagons.map(angles),
        hexagons: hexagons.map(|corners| corners.map(to_klein)),
        placement,
    }
}

/// The corners of the right-angled hexagon whose alternate sides 0–1, 2–3 and 4–5 have these lengths,
/// counterclockwise, its side 5–0 in the middle of the imaginary axis.
fn hexagon([a, b, c]: [f64; 3]) -> [Complex; 6] {
    let half = Complex::new(0.0, (0.25 * between(a, c, b)).tanh());
    let (low, high) = (-half, half);
    let [low_end, high_end] = [exponential(low, a.into()), exponential(high, c.into())];
    let turned = |from: Complex, corner: Complex, turn: Complex, length: f64| {
        let back = seen_from(corner, from);
        exponential(corner, -back / back.norm() * turn * length)
    };
    let [left, right] = [Complex::i(), -Complex::i()];
    let from = turned(low, low_end, left, between(a, b, c));
    let to = turned(high, high_end, right, between(c, b, a));
    [low, low_end, from, to, high_end, high]
}

/// The length of the side between those of lengths a and b in a right-angled hexagon whose third alternate
/// side has length c, by the law of cosines with cosh − 1 formed without cancellation.
fn between(a: f64, b: f64, c: f64) -> f64 {
    let twice_square = (c.cosh() + (a - b).cosh()) / (a.sinh() * b.sinh());
    2.0 * (0.5 * twice_square).sqrt().asinh()
}

/// The inner angles of a polygon.
fn angles(corners: [Complex; 6]) -> [f64; 6] {
    std::array::from_fn(|k| {
        let [before, after] = [5, 1].map(|step| seen_from(corners[k], corners[(k + step) % 6]));
        (before * after.conj()).arg().abs()
    })
}

/// The unit normal of the axis of a translation.
fn axis(motion: Moebius) -> Vector3 {
    let [from, to] = motion.fixed_points().map(|end| Vector3([end.re, end.im, 1.0]));
    let chord = to - from;
    let half_square = 0.5 * chord.dot(chord);
    lorentz_cross(from, chord) * (1.0 / half_square)
}

/// The feet of the common perpendicular of two disjoint lines.
fn feet(first: Vector3, second: Vector3) -> [Complex; 2] {
    let perpendicular = lorentz_cross(first, second);
    [first, second].map(|line| {
        let foot = lorentz_cross(line, perpendicular);
        from_hyperboloid(foot * foot[2].signum())
    })
}

/// A vector orthogonal to both in the Lorentz product x x' + y y' − t t'.
fn lorentz_cross(u: Vector3, v: Vector3) -> Vector3 {
    let Vector3([x, y, t]) = u.cross(v);
    Vector3([x, y, -t])
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::*;
    use crate::hyperbolic::moebius::{distance, from_klein};

    /// Translations to the left along two lines at equal distances below and above the origin.
    fn two_translations(lengths: [f64; 2]) -> [Moebius; 2] {
        let along = |length: f64| {
            let step = Complex::new((0.5 * length).tanh(), 0.0);
            Moebius::between([step, Complex::default()], [Complex::default(), -step])
        };
        let up = Complex::new(0.0, 0.6);
        let lift = Moebius::between([Complex::default(), up], [up, Complex::new(0.0, 0.9)]);
        [lift.inverse() * along(lengths[0]) * lift, lift * along(lengths[1]) * lift.inverse()]
    }

    #[test]
    fn hexagons_are_right_angled_congruent_and_half_the_pants() {
        for lengths in [[1.0, 2.0], [3.0, 3.0], [0.5, 4.0]] {
            let [g, h] = two_translations(lengths);
            let pants = pants(g, h);
            assert!((pants.boundary_lengths[0] - lengths[0]).abs() < 1e-12);
            assert!((pants.boundary_lengths[2] - lengths[1]).abs() < 1e-12);
            for (hexagon, angles) in pants.hexagons.iter().zip(pants.angles) {
                assert!(angles.iter().all(|angle| (angle - FRAC_PI_2).abs() < 1e-11), "{angles:?}");
                assert!((4.0 * PI - angles.iter().sum::<f64>() - PI).abs() < 1e-11);
                let corners = hexagon.map(from_klein);
                for (side, length) in pants.boundary_lengths.iter().enumerate() {
                    let half = distance(corners[2 * side], corners[2 * side + 1]);
                    assert!((half - 0.5 * length).abs() < 1e-10, "side {side}: {half} of {length}");
                }
            }
            assert!((0..6).all(|k| {
                let [p, q, r] = [0, 1, 2].map(|step| pants.hexagons[0][(k + step) % 6]);
                ((q - p).conj() * (r - q)).im > 0.0
            }));
            assert!(pants.hexagons[0][1].re > 0.1 && pants.hexagons[0][0].im < 0.0);
            for (right, left) in pants.hexagons[0].iter().zip(pants.hexagons[1]) {
                assert!((right + left.conj()).norm() < 1e-11);
            }
        }
    }

    #[test]
    fn the_placement_takes_hexagons_to_the_axes() {
        for lengths in [[1.0, 2.0], [3.0, 3.0], [0.5, 4.0]] {
            let [g, h] = two_translations(lengths);
            let pants = pants(g, h);
            for hexagon in pants.hexagons {
                let placed = hexagon.map(|corner| pants.placement.apply(from_klein(corner)));
                for (motion, corners) in [(g, [0, 1]), (h, [4, 5])] {
                    let along = corners.map(|k| distance(placed[k], motion.apply(placed[k])));
                    assert!(along.iter().all(|&moved| (moved - motion.translation_length()).abs() < 1e-10));
                }
            }
            // the other bank: the mirror image lies on the axis of h g⁻¹
            let right_bank = h * g.inverse();
            let corner = pants.placement.apply(from_klein(pants.hexagons[1][2]));
            assert!(
                (distance(corner, right_bank.apply(corner)) - right_bank.translation_length()).abs() < 1e-10
            );
        }
    }
}
