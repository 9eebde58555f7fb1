// SPDX-License-Identifier: MIT OR Apache-2.0
//! Polylines on the unit sphere: resampling, and the distance of a point.
//!
//! Distances use a tree of balls: the root encloses the whole line, the two children of a ball enclose the
//! halves of its part. Cost: O(n log n) to build; O(log n) for the distance of a point near the line.

use crate::vector::Vector3;

/// The polyline with additional points, so that neighbors are at most about `spacing` apart.
pub(super) fn resampled(points: &[Vector3], spacing: f64) -> Vec<Vector3> {
    let mut dense: Vec<Vector3> = points.first().copied().into_iter().collect();
    for ends in points.windows(2) {
        let parts = (ends[0].distance(ends[1]) / spacing).ceil().max(1.0);
        for k in 1..parts as usize {
            let between = along(ends[0], ends[1], k as f64 / parts);
            let length = between.norm();
            // nothing lies between antipodes
            if length > f64::EPSILON {
                dense.push(between * (1.0 / length));
            }
        }
        dense.push(ends[1]);
    }
    dense
}

/// A polyline of two or more points, prepared for distances.
pub(super) struct Polyline {
    points: Vec<Vector3>,
    /// Center and radius; the children of ball i are balls 2 i + 1 and 2 i + 2.
    balls: Vec<(Vector3, f64)>,
}

impl Polyline {
    /// Prepares for distances to the chords between consecutive points.
    pub(super) fn new(points: Vec<Vector3>) -> Self {
        let n_chords = points.len() - 1;
        let mut line =
            Self { points, balls: vec![(Vector3::ZERO, 0.0); 2 * n_chords.next_power_of_two() - 1] };
        line.enclose(0, 0, n_chords);
        line
    }

    /// The distance of a point in space.
    pub(super) fn distance(&self, x: Vector3) -> f64 {
        self.nearest(0, 0, self.points.len() - 1, x, f64::INFINITY)
    }

    /// Encloses the chords `low..high` in a ball, and their halves in its children.
    fn enclose(&mut self, ball: usize, low: usize, high: usize) {
        let center = self.points[usize::midpoint(low, high)];
        let radius = self.points[low..=high].iter().map(|&point| center.distance(point)).fold(0.0, f64::max);
        self.balls[ball] = (center, radius);
        if high - low > 1 {
            let middle = usize::midpoint(low, high);
            self.enclose(2 * ball + 1, low, middle);
            self.enclose(2 * ball + 2, middle, high);
        }
    }

    /// The distance to the chords `low..high`, or `least` if that is less.
    fn nearest(&self, ball: usize, low: usize, high: usize, x: Vector3, least: f64) -> f64 {
        let (center, radius) = self.balls[ball];
        if center.distance(x) - radius >= least {
            return least;
        }
        if high - low == 1 {
            return least.min(chord_distance(self.points[low], self.points[high], x));
        }
        let middle = usize::midpoint(low, high);
        let children = [(2 * ball + 1, low, middle), (2 * ball + 2, middle, high)];
        let [first, second] = children.map(|(child, ..)| self.balls[child].0.distance(x));
        let nearer_first = if first <= second { children } else { [children[1], children[0]] };
        nearer_first.iter().fold(least, |least, &(ball, low, high)| self.nearest(ball, low, high, x, least))
    }
}

/// The distance of a point from the segment between two points.
fn chord_distance(a: Vector3, b: Vector3, x: Vector3) -> f64 {
    let chord = b - a;
    let squared = chord.dot(chord);
    let share = if squared > 0.0 { ((x - a).dot(chord) / squared).clamp(0.0, 1.0) } else { 0.0 };
    x.distance(along(a, b, share))
}

fn along(a: Vector3, b: Vector3, share: f64) -> Vector3 {
    a * (1.0 - share) + b * share
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spiral(n: usize) -> Vec<Vector3> {
        let point = |i: usize| {
            let t = i as f64 / n as f64;
            let (latitude, longitude) = (2.0 * t - 1.0, 20.0 * t);
            Vector3([latitude.cos() * longitude.cos(), latitude.cos() * longitude.sin(), latitude.sin()])
        };
        (0..=n).map(point).collect()
    }

    #[test]
    fn distances_are_those_to_the_nearest_chord() {
        for n in [1, 2, 3, 7, 100] {
            let points = spiral(n);
            let line = Polyline::new(points.clone());
            for x in spiral(37).into_iter().map(|Vector3([x, y, z])| Vector3([y, z, -x])) {
                let chords = points.windows(2).map(|ends| chord_distance(ends[0], ends[1], x));
                assert_eq!(line.distance(x), chords.fold(f64::INFINITY, f64::min));
            }
            assert!(points.iter().all(|&point| line.distance(point) == 0.0));
        }
    }

    #[test]
    fn resampling_keeps_the_points_and_fills_the_gaps() {
        let points = spiral(30);
        let dense = resampled(&points, 0.01);
        assert!(dense.windows(2).all(|ends| ends[0].distance(ends[1]) < 0.012));
        assert!(dense.iter().all(|&point| (point.norm() - 1.0).abs() < 1e-15));
        assert!(points.iter().all(|point| dense.contains(point)));
        assert_eq!(resampled(&points, 10.0), points);
    }
}
