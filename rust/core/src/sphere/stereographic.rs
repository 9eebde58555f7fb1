// SPDX-License-Identifier: MIT OR Apache-2.0
//! The stereographic projections of the unit sphere from its two poles.
//!
//! Sutti & Yueh (2024), equations (6.1), (6.4) and (6.5). The inversion Inv(z) = 1/z̄ after the projection
//! from the north pole is the projection from the south pole, (x + iy)/(1 + z), so a method that inverts
//! before every step changes charts here, and the map on the sphere keeps its orientation.

use crate::codomain::SpatialMap;
use crate::parallel;
use crate::vector::Vector3;

/// The projection from one pole.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Chart {
    /// From the north pole: it takes the southern hemisphere to the unit disk, mirrored as seen from outside.
    North,
    /// From the south pole: it takes the northern hemisphere to the unit disk, as seen from outside.
    South,
}

impl Chart {
    /// The chart after an inversion.
    pub(super) fn inverted(self) -> Self {
        match self {
            Self::North => Self::South,
            Self::South => Self::North,
        }
    }

    /// The image of a point of the sphere; infinite at the pole itself.
    pub(super) fn project(self, Vector3([x, y, z]): Vector3) -> [f64; 2] {
        let height = 1.0 - self.pole() * z;
        [x / height, y / height]
    }

    /// The point of the sphere over a point of the plane.
    pub(super) fn lift(self, [u, v]: [f64; 2]) -> Vector3 {
        let square = u * u + v * v;
        let unit = 1.0 / (1.0 + square);
        Vector3([2.0 * u * unit, 2.0 * v * unit, self.pole() * (square - 1.0) * unit])
    }

    /// The images of all points.
    pub(super) fn project_all(self, map: &[Vector3]) -> Vec<[f64; 2]> {
        parallel::map(map.len(), |vertex| self.project(map[vertex]))
    }

    /// The points over all points of the plane.
    pub(super) fn lift_all(self, plane: &[[f64; 2]]) -> SpatialMap {
        parallel::map(plane.len(), |vertex| self.lift(plane[vertex]))
    }

    fn pole(self) -> f64 {
        match self {
            Self::North => 1.0,
            Self::South => -1.0,
        }
    }
}

/// The weighted median: the smallest `values[i]` such that the values up to it carry half of the weight.
pub(super) fn weighted_median(values: &[f64], weights: &[f64]) -> f64 {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_unstable_by(|&a, &b| values[a].total_cmp(&values[b]));
    let half = 0.5 * weights.iter().sum::<f64>();
    let mut passed = 0.0;
    let middle = order.iter().find(|&&i| {
        passed += weights[i];
        passed >= half
    });
    values[*middle.unwrap_or(&order[order.len() - 1])]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points() -> impl Iterator<Item = [f64; 2]> {
        (0..200).map(|i| {
            let (angle, modulus) = (0.7 * i as f64, 1.06f64.powi(i - 100));
            [modulus * angle.cos(), modulus * angle.sin()]
        })
    }

    #[test]
    fn projecting_what_was_lifted_gives_it_back() {
        for (chart, z) in [Chart::North, Chart::South].into_iter().flat_map(|c| points().map(move |z| (c, z)))
        {
            let point = chart.lift(z);
            assert!((point.norm() - 1.0).abs() < 1e-14);
            let back = chart.project(point);
            let modulus = z[0].hypot(z[1]);
            // near the pole the coordinate 1 ∓ z cancels
            assert!((back[0] - z[0]).hypot(back[1] - z[1]) <= 1e-14 * modulus * (1.0 + modulus * modulus));
        }
    }

    #[test]
    fn changing_the_chart_is_the_inversion() {
        for z in points().filter(|z| z[0].hypot(z[1]) < 30.0) {
            let inverted = Chart::South.project(Chart::North.lift(z));
            let square = z[0] * z[0] + z[1] * z[1];
            assert!((inverted[0] - z[0] / square).hypot(inverted[1] - z[1] / square) < 1e-10 / square.sqrt());
        }
    }

    #[test]
    fn the_southern_chart_keeps_orientation_and_the_northern_one_mirrors() {
        let triangle = [[0.1, 0.2], [0.4, 0.1], [0.3, 0.5]];
        for (chart, positive) in [(Chart::South, true), (Chart::North, false)] {
            let map = triangle.map(|z| chart.lift(z)).to_vec();
            assert_eq!(
                crate::distortion::folded_on_sphere(&[[0, 1, 2].map(crate::mesh::Vertex)], &map).is_empty(),
                positive
            );
        }
    }

    #[test]
    fn the_weighted_median_halves_the_weight() {
        assert_eq!(weighted_median(&[3.0, 1.0, 2.0], &[1.0, 1.0, 1.0]), 2.0);
        assert_eq!(weighted_median(&[3.0, 1.0, 2.0], &[9.0, 1.0, 1.0]), 3.0);
        assert_eq!(weighted_median(&[f64::INFINITY, 0.5], &[1.0, 2.0]), 0.5);
    }
}
