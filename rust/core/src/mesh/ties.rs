// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tells symmetric parts of a surface apart, so that neither rounding nor the numbering chooses between them.
//!
//! A choice of the best of many vertices or faces has ties if the surface is its own mirror image, and the last bit
//! would decide. So every vertex gets a preference, a function of its place along three directions of the surface
//! itself ([`OwnFrame`]). The preference turns with the surface, does not depend on the order of vertices, and changes
//! smoothly. A value times one plus [`SHARE`] times the preference has no such ties.
//!
//! Surfaces with more symmetry than a mirror plane have fewer directions. Ties that these leave go to the lowest index:
//! values are compared up to rounding ([`first_largest`], [`rounded`]).

use std::collections::BTreeSet;

use super::own_frame::OwnFrame;
use crate::parallel;
use crate::vector::Vector3;

/// Largest relative change of a value by a preference: more than noise, less than matters.
const SHARE: f64 = 1e-6;

/// Relative difference up to which two values are equal: more than rounding and noise, less than [`SHARE`].
const EQUAL: f64 = 1e-9;

/// About [`EQUAL`] as a difference of the bits of two values.
const EQUAL_BITS: u64 = 1 << 22;

/// The lowest index of the largest of `values`, up to rounding; `None` for an empty list.
pub(crate) fn first_largest(values: &[f64]) -> Option<usize> {
    let largest = values.iter().copied().max_by(f64::total_cmp)?;
    values.iter().position(|&value| are_equal(value, largest) || value.to_bits() == largest.to_bits())
}

/// A value near 1 or below as a multiple of what counts as equal, so that ties between sorted values go to the next key.
pub(crate) fn rounded(value: f64) -> f64 {
    (value / EQUAL).round()
}

/// The places of values, the largest first; of those that are equal but for rounding, the lowest first.
pub(crate) fn largest_first(values: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[b].total_cmp(&values[a]));
    order.chunk_by_mut(|&a, &b| are_equal(values[a], values[b])).for_each(<[usize]>::sort_unstable);
    order
}

/// The places of values, the smallest first; of those that are equal but for rounding, the lowest first.
pub(crate) fn smallest_first(values: &[f64]) -> Vec<usize> {
    let negative: Vec<f64> = values.iter().map(|value| -value).collect();
    largest_first(&negative)
}

/// The place of the smallest of values; of those that are equal but for rounding, the lowest; `None` without values.
pub(crate) fn first_smallest(values: impl Iterator<Item = f64>) -> Option<usize> {
    let negative: Vec<f64> = values.map(|value| -value).collect();
    first_largest(&negative)
}

/// A length or cost as a multiple of a small unit: sums are exact then, and mirror images of a path are equal whatever
/// the noise.
pub(crate) fn on_cost_grid(value: f64) -> f64 {
    const UNIT: f64 = 1.0 / (1 << 24) as f64;
    (value / UNIT).round().max(1.0) * UNIT
}

/// The multiple of a power of two that is nearest to a coordinate; zero without a sign, which noise would choose.
pub(crate) fn nearest_multiple(x: f64, cell: f64) -> f64 {
    (x / cell).round() * cell + 0.0
}

/// The power of two nearest to a width, as the ratio of both counts: the cells of a grid on which coordinates are exact.
pub(crate) fn nearest_power_of_two(width: f64) -> f64 {
    width.log2().round().exp2()
}

/// Sort keys that have come up so far, of which those that are equal but for noise are one.
///
/// Rounding does not do for many keys: some would lie at the border of two cells, and noise would choose between these.
#[derive(Debug, Default)]
pub(crate) struct DistinctKeys(BTreeSet<u64>);

impl DistinctKeys {
    /// The lowest key so far within a distance of this one, or itself.
    pub(crate) fn one_of_equals(&mut self, key: u64, within: u64) -> u64 {
        let equals = key.saturating_sub(within)..=key.saturating_add(within);
        if let Some(&known) = self.0.range(equals).next() {
            return known;
        }
        self.0.insert(key);
        key
    }

    /// [`Self::one_of_equals`] of values that are not negative, equal up to rounding.
    pub(crate) fn one_of_equal_values(&mut self, value: f64) -> f64 {
        // the bits of such values are ordered as the values are
        f64::from_bits(self.one_of_equals(value.to_bits(), EQUAL_BITS))
    }
}

/// Whether two values are equal but for rounding.
pub(crate) fn are_equal(a: f64, b: f64) -> bool {
    let apart = (a - b).abs();
    a == b || (apart.is_finite() && apart <= EQUAL * a.abs().max(b.abs()))
}

/// The factor, near 1, for a value at each of the points (n, 3).
pub(crate) fn tie_breakers(points: &[Vector3]) -> Vec<f64> {
    let frame = OwnFrame::of(points);
    let [a, b, c] = frame.axes;
    let generic = a * 0.5 + (b * 0.31 + c * 0.19);
    parallel::map(points.len(), |v| 1.0 + SHARE * frame.standardized(points[v]).dot(generic).tanh())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pairs of mirrored points, one above the other in the list.
    fn mirrored() -> Vec<Vector3> {
        let half = (0..20).map(f64::from).map(|k| [1.0 + k.sin().abs(), k.cos() + 0.1 * k, (2.0 * k).sin()]);
        half.flat_map(|[x, y, z]| [[x, y, z], [-x, y, z]].map(Vector3)).collect()
    }

    #[test]
    fn mirrored_points_differ_by_more_than_noise() {
        let values = tie_breakers(&mirrored());
        for pair in values.chunks(2) {
            assert!((pair[0] - pair[1]).abs() > 1e-8, "{pair:?}");
            assert!((pair[0] - 1.0).abs() <= SHARE);
        }
    }

    #[test]
    fn preferences_turn_with_the_points_and_do_not_know_their_order() {
        let points = mirrored();
        let values = tie_breakers(&points);
        let turned: Vec<Vector3> = points
            .iter()
            .rev()
            .map(|&Vector3([x, y, z])| Vector3([0.6 * x - 0.8 * z + 3.0, 0.8 * x + 0.6 * z, -y]))
            .collect();
        // x, y, z ↦ x', z', −y is a rotation
        for (value, turned) in values.iter().rev().zip(tie_breakers(&turned)) {
            assert!((value - turned).abs() < 1e-14, "{value} {turned}");
        }
    }

    #[test]
    fn the_first_of_equal_values_is_the_largest_whatever_rounding_says() {
        let up = |x: f64| x * (1.0 + 1e-14);
        assert_eq!(first_largest(&[1.0, 3.0, up(3.0), 2.0]), Some(1));
        assert_eq!(first_largest(&[1.0, up(3.0), 3.0]), Some(1));
        assert_eq!(first_largest(&[-3.0, -up(3.0), -4.0]), Some(0));
        assert_eq!(first_largest(&[1.0, 1.0 + 1e-6]), Some(1));
        assert_eq!(first_largest(&[1.0, f64::INFINITY]), Some(1));
        assert_eq!(first_largest(&[f64::NAN]), Some(0));
        assert_eq!(first_largest(&[]), None);
        assert_eq!(rounded(0.3), rounded(up(0.3)));
        assert!(rounded(0.3) < rounded(0.3 + 1e-8));
    }

    #[test]
    fn rounding_does_not_order_equal_values() {
        let values = [2.0, 3.0 - 1e-13, 1.0, 3.0, f64::INFINITY, 2.0 + 1e-13, f64::INFINITY];
        assert_eq!(largest_first(&values), [4, 6, 1, 3, 0, 5, 2]);
        assert_eq!(smallest_first(&values), [2, 0, 5, 1, 3, 4, 6]);
        assert!(largest_first(&[]).is_empty());
        assert_eq!(first_smallest([2.0, 1.0 + 1e-13, 1.0].into_iter()), Some(1));
        assert_eq!(first_smallest(std::iter::empty()), None);
        // whatever sign NaN has, something is found
        assert_eq!(first_smallest([-f64::NAN, 1.0].into_iter()), Some(0));
        assert_eq!(first_smallest([f64::NAN, f64::NAN].into_iter()), Some(0));
    }

    #[test]
    fn zero_has_no_sign_on_a_grid() {
        assert_eq!(nearest_multiple(-1e-17, 0.25).to_bits(), 0.0f64.to_bits());
        assert_eq!([0.3, -0.4, 0.1].map(|x| nearest_multiple(x, 0.25)), [0.25, -0.5, 0.0]);
    }

    #[test]
    fn keys_that_are_equal_but_for_noise_are_one() {
        let mut keys = DistinctKeys::default();
        let given = [111, 100, 105];
        assert_eq!(given.map(|key| keys.one_of_equals(key, 10)), [111, 100, 100]);
        let mut keys = DistinctKeys::default();
        let given = [100, 130, 109, 91, 120, 111];
        assert_eq!(given.map(|key| keys.one_of_equals(key, 10)), [100, 130, 100, 100, 130, 111]);
        let mut keys = DistinctKeys::default();
        let given = [0.3, 0.3 + 1e-14, 0.3 + 1e-8, 0.3 - 1e-14, 0.0, f64::INFINITY];
        let expected = [0.3, 0.3, 0.3 + 1e-8, 0.3, 0.0, f64::INFINITY];
        assert_eq!(given.map(|value| keys.one_of_equal_values(value)), expected);
    }

    #[test]
    fn points_without_directions_are_all_alike() {
        let [x, y, z] = [0, 1, 2].map(Vector3::unit);
        let octahedron = [x, -x, y, -y, z, -z];
        assert_eq!(tie_breakers(&octahedron), vec![1.0; 6]);
        assert_eq!(tie_breakers(&[Vector3([1.0; 3]); 4]), vec![1.0; 4]);
    }
}
