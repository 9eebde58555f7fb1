// SPDX-License-Identifier: MIT OR Apache-2.0
//! Parameters along curves, and points at parameters.

use crate::mesh::ties::first_smallest;
use crate::vector::Vector3;

/// Part of the parameters that is divided evenly if some edges are too short for parameters to increase.
const EVEN_SHARE: f64 = 1e-9;

/// The length of a polyline up to each of its points as a share of the whole, strictly increasing from 0 to 1.
///
/// Takes at least two points.
pub(super) fn shares(points: impl Iterator<Item = Vector3>) -> Vec<f64> {
    let points: Vec<Vector3> = points.collect();
    let mut lengths = vec![0.0];
    points.windows(2).for_each(|ends| lengths.push(lengths[lengths.len() - 1] + ends[0].distance(ends[1])));
    let last = lengths.len() - 1;
    let total = lengths[last].max(f64::MIN_POSITIVE);
    let mut shares: Vec<f64> = lengths.iter().map(|length| length / total).collect();
    if shares.windows(2).any(|ends| ends[1] - ends[0] <= f64::EPSILON) {
        let even = |k: usize| k as f64 / last as f64;
        shares.iter_mut().enumerate().for_each(|(k, s)| *s += EVEN_SHARE * (even(k) - *s));
    }
    shares[last] = 1.0;
    shares
}

/// The point at parameter `s` of a polyline on the unit sphere, whose points have `parameters`.
pub(crate) fn on_sphere(places: &[Vector3], parameters: &[f64], s: f64) -> Vector3 {
    let after = parameters.partition_point(|&parameter| parameter < s).clamp(1, parameters.len() - 1);
    let [low, high] = [parameters[after - 1], parameters[after]];
    let t = ((s - low) / (high - low)).clamp(0.0, 1.0);
    unit(places[after - 1] * (1.0 - t) + places[after] * t)
}

/// The index from `first` to `last` of the parameter nearest to `s`.
pub(super) fn nearest(parameters: &[f64], [first, last]: [usize; 2], s: f64) -> usize {
    first + first_smallest((first..=last).map(|k| (parameters[k] - s).abs())).unwrap_or(0)
}

/// The sum of the chords of a polyline on the unit sphere.
pub(crate) fn length(places: &[Vector3]) -> f64 {
    places.windows(2).map(|ends| ends[0].distance(ends[1])).sum()
}

/// The unit vector along `x`; zero for zero.
pub(crate) fn unit(x: Vector3) -> Vector3 {
    match x.norm() {
        0.0 => x,
        length => x * (1.0 / length),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_go_from_zero_to_one_even_over_edges_without_length() {
        let line = |xs: &[f64]| shares(xs.iter().map(|&x| Vector3([x, 0.0, 0.0])));
        assert_eq!(line(&[0.0, 1.0, 4.0]), [0.0, 0.25, 1.0]);
        let short = line(&[0.0, 1.0, 1.0 + 1e-18, 2.0]);
        assert!(short[0] == 0.0 && short[3] == 1.0 && short.windows(2).all(|ends| ends[0] < ends[1]));
    }

    #[test]
    fn points_at_parameters_lie_between_their_neighbors() {
        let places = [0, 1, 2].map(Vector3::unit);
        let parameters = [0.0, 0.5, 1.0];
        assert_eq!(on_sphere(&places, &parameters, 0.0), places[0]);
        assert_eq!(on_sphere(&places, &parameters, 1.0), places[2]);
        let middle = on_sphere(&places, &parameters, 0.75);
        assert!(middle.distance(unit(Vector3([0.0, 1.0, 1.0]))) < 1e-15);
        assert_eq!(nearest(&parameters, [0, 2], 0.7), 1);
        assert_eq!(nearest(&parameters, [2, 2], 0.7), 2);
    }
}
