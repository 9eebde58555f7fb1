// SPDX-License-Identifier: MIT OR Apache-2.0
//! The angles at which an island is tried.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::outline::Point;

/// Angles, and sizes in parts of themselves, that differ by less are equal but for rounding.
pub(super) const EQUAL: f64 = 1e-9;

/// The point turned by the angle whose cosine and sine are given.
pub(super) fn turned(point: Point, [cos, sin]: [f64; 2]) -> Point {
    [cos * point[0] - sin * point[1], sin * point[0] + cos * point[1]]
}

/// The point of a plane in which lengths count, in the square of a texture whose width is `aspect` times its height.
pub(super) fn flattened(point: Point, aspect: f64) -> Point {
    [point[0] / aspect, point[1]]
}

/// Cosine and sine.
pub(super) fn direction(angle: f64) -> [f64; 2] {
    [angle.cos(), angle.sin()]
}

/// The lowest and the highest coordinates of points turned by an angle, then flattened; zeros without points.
pub(super) fn turned_box(points: &[Point], angle: f64, aspect: f64) -> [Point; 2] {
    if points.is_empty() {
        return [[0.0; 2]; 2];
    }
    let direction = direction(angle);
    let mut corners = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    for point in points.iter().map(|&point| flattened(turned(point, direction), aspect)) {
        for axis in 0..2 {
            corners[0][axis] = corners[0][axis].min(point[axis]);
            corners[1][axis] = corners[1][axis].max(point[axis]);
        }
    }
    corners
}

/// Width and height of points turned by an angle, then flattened.
pub(super) fn turned_size(points: &[Point], angle: f64, aspect: f64) -> Point {
    let [low, high] = turned_box(points, angle, aspect);
    [high[0] - low[0], high[1] - low[1]]
}

/// `n` angles all around, the one of the smallest bounding box first.
pub(super) fn angles_around(hull: &[Point], n: usize) -> Vec<f64> {
    let first = least_box_angle(hull);
    (0..n).map(|k| first + TAU * k as f64 / n as f64).collect()
}

/// The angle of the smallest bounding box, below a right angle.
pub(super) fn least_box_angle(hull: &[Point]) -> f64 {
    least(&flush_angles(hull), |angle| {
        let [width, height] = turned_size(hull, angle, 1.0);
        width * height
    })
}

/// The angle at which the smallest upright square holds the flattened hull.
///
/// Between two angles at which an edge lies flush with the square, width and height are A cos θ + B sin θ and each has
/// its least value at an end; their maximum may have its least value also where they are equal.
pub(super) fn square_angle(hull: &[Point], aspect: f64) -> f64 {
    // on a texture that is no square, a box that stands is another than one that lies
    let quarter = flush_angles(hull);
    let flush: Vec<f64> =
        [0.0, FRAC_PI_2].iter().flat_map(|turn| quarter.iter().map(move |angle| angle + turn)).collect();
    let ends = flush.iter().skip(1).copied().chain([PI + flush[0]]);
    let equal: Vec<f64> =
        flush.iter().zip(ends).filter_map(|(&from, to)| equal_sides(hull, aspect, from, to)).collect();
    least(&[flush, equal].concat(), |angle| {
        let [width, height] = turned_size(hull, angle, aspect);
        width.max(height)
    })
}

/// The angle between two neighboring flush angles at which width and height of the flattened hull are equal.
fn equal_sides(hull: &[Point], aspect: f64, from: f64, to: f64) -> Option<f64> {
    // the corners that touch the box are the same all the way
    let middle = 0.5 * (from + to);
    let along = |angle: f64| {
        let [cos, sin] = direction(angle);
        let by_height =
            |a: &&Point, b: &&Point| (cos * a[0] + sin * a[1]).total_cmp(&(cos * b[0] + sin * b[1]));
        let [low, high] = [hull.iter().min_by(by_height)?, hull.iter().max_by(by_height)?];
        Some([high[0] - low[0], high[1] - low[1]])
    };
    let [across, upward] = [along(-middle)?.map(|x| x / aspect), along(FRAC_PI_2 - middle)?];
    // width / aspect = cos θ across₀ − sin θ across₁ = height = sin θ upward₀ + cos θ upward₁
    let angle = (across[0] - upward[1]).atan2(across[1] + upward[0]);
    (-2..=2).map(|k| angle + f64::from(k) * 2.0 * FRAC_PI_2).find(|angle| (from..=to).contains(angle))
}

/// The angles by which an edge of the hull comes to lie upright or level, sorted; at least one.
///
/// They are below a right angle by more than rounding, or an edge that lies level would be turned or not by chance.
fn flush_angles(hull: &[Point]) -> Vec<f64> {
    let next = hull.iter().cycle().skip(1);
    let mut angles: Vec<f64> = hull
        .iter()
        .zip(next)
        .map(|(a, b)| (-(b[1] - a[1]).atan2(b[0] - a[0]) + EQUAL).rem_euclid(FRAC_PI_2) - EQUAL)
        .chain(hull.is_empty().then_some(0.0))
        .collect();
    angles.sort_unstable_by(f64::total_cmp);
    angles.dedup();
    angles
}

/// The first of the angles with the least value but for rounding, which has no say among a box and its quarter turns.
pub(super) fn least(angles: &[f64], value: impl Fn(f64) -> f64) -> f64 {
    let values = angles.iter().map(|&angle| (value(angle), angle));
    let lower =
        |best: (f64, f64), next: (f64, f64)| if next.0 < best.0 * (1.0 - EQUAL) { next } else { best };
    values.reduce(lower).map_or(0.0, |(_, angle)| angle)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::packing::outline::convex_hull;

    fn scattered(seed: u32) -> Vec<Point> {
        let number = |k: u32| (f64::from(k) * 12.9898 + f64::from(seed) * 78.233).sin() * 43758.5453 % 1.0;
        convex_hull((0..20).map(|k| [number(2 * k), 0.4 * number(2 * k + 1)]).collect())
    }

    #[test]
    fn no_sampled_angle_has_a_smaller_square() {
        for (seed, aspect) in (0..20).zip([1.0, 2.0, 0.3].into_iter().cycle()) {
            let hull = scattered(seed);
            let side = |angle: f64| turned_size(&hull, angle, aspect).into_iter().fold(0.0, f64::max);
            let best = side(square_angle(&hull, aspect));
            let sampled = (0..9000).map(|k| side(f64::from(k) * 1e-4 * TAU)).fold(f64::INFINITY, f64::min);
            assert!(
                best <= sampled * (1.0 + EQUAL) + 1e-12 && best > sampled - 1e-3,
                "{seed}: {best} {sampled}"
            );
        }
    }

    #[test]
    fn the_square_of_a_stick_stands_around_its_diagonal() {
        let stick = [[0.0, 0.0], [1.0, 0.0]];
        let side = turned_size(&stick, square_angle(&stick, 1.0), 1.0);
        assert!((side[0] - 0.5_f64.sqrt()).abs() < 1e-12 && (side[1] - side[0]).abs() < 1e-12);
    }

    #[test]
    fn the_first_angle_has_the_smallest_box() {
        let [cos, sin] = direction(0.3);
        let hull = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [0.0, 1.0]].map(|point| turned(point, [cos, sin]));
        let size = turned_size(&hull, angles_around(&hull, 4)[0], 1.0);
        assert!((size[0] * size[1] - 3.0).abs() < 1e-12);
    }

    /// The corners of a hull, each moved by rounding.
    fn rounded(hull: &[Point], seed: u32) -> Vec<Point> {
        let number = |k: usize| (k as f64 * 78.233 + f64::from(seed) * 12.9898).sin() * 43758.5453 % 1.0;
        let moved =
            |(k, &[x, y]): (usize, &Point)| [x + 1e-15 * number(2 * k), y + 1e-15 * number(2 * k + 1)];
        hull.iter().enumerate().map(moved).collect()
    }

    #[test]
    fn rounding_does_not_choose_between_angles() {
        let level = vec![[0.0, 0.0], [2.0, 0.0], [1.5, 1.0], [0.0, 1.0]];
        for hull in (0..10).map(scattered).chain([level]) {
            let [square, smallest] = [square_angle(&hull, 1.0), least_box_angle(&hull)];
            for seed in 0..30 {
                let hull = rounded(&hull, seed);
                assert!((square_angle(&hull, 1.0) - square).abs() < 1e-12, "{seed}");
                assert!((least_box_angle(&hull) - smallest).abs() < 1e-12, "{seed}");
            }
        }
    }
}
