// SPDX-License-Identifier: MIT OR Apache-2.0
//! Place, size and directions of a surface, by its moments: they move, grow and turn with it, and do not depend on the
//! order of its vertices.
//!
//! The first direction is that of the third moment Σ y |y|², y the vertices from their mean; the second is that of its
//! image under the covariance, as far as it is perpendicular to the first; the third is perpendicular to both, and so to
//! a plane of symmetry. Surfaces with more symmetry than a mirror plane have fewer directions.

use crate::parallel;
use crate::vector::Vector3;

/// Length, relative to the size of the surface, up to which a direction is taken for zero.
const NO_DIRECTION: f64 = 1e-9;

/// Length from which a direction is clear: noise of the vertices is noise of the direction a thousandfold at most.
const CLEAR: f64 = 1e-3;

/// Place, size and directions of a surface.
pub(crate) struct OwnFrame {
    /// The mean of the vertices.
    pub center: Vector3,
    /// The root of the mean squared distance from it.
    pub size: f64,
    /// Orthogonal unit vectors; zero where there is no direction.
    pub axes: [Vector3; 3],
    /// How many of the first two axes are clear, since their moments are long.
    pub n_clear: usize,
}

impl OwnFrame {
    /// The frame of the points (n, 3).
    pub fn of(points: &[Vector3]) -> Self {
        let n = points.len();
        let mean = |value: &(dyn Fn(Vector3) -> Vector3 + Sync)| -> Vector3 {
            Vector3(parallel::sums(n, |v| value(points[v]).into())) * (1.0 / n as f64)
        };
        // 1. Center and size
        let center = mean(&|x| x);
        let size = parallel::sum(n, |v| (points[v] - center).dot(points[v] - center) / n as f64).sqrt();
        let frame = Self { center, size, axes: [Vector3::ZERO; 3], n_clear: 0 };
        // 2. The directions
        let skewness = mean(&|x| frame.standardized(x) * frame.standardized(x).dot(frame.standardized(x)));
        let stretched = mean(&|x| frame.standardized(x) * frame.standardized(x).dot(skewness));
        let across = stretched - skewness * (stretched.dot(skewness) / skewness.dot(skewness));
        let n_clear = [skewness, across].iter().take_while(|moment| moment.norm() > CLEAR).count();
        Self { axes: [skewness, across, skewness.cross(across)].map(unit), n_clear, ..frame }
    }

    /// A point relative to the center and the size.
    pub fn standardized(&self, point: Vector3) -> Vector3 {
        (point - self.center) * (1.0 / self.size.max(f64::MIN_POSITIVE))
    }
}

/// The unit vector along `x`; zero if `x` is too short.
fn unit(x: Vector3) -> Vector3 {
    let length = x.norm();
    // a NaN gives zero too
    if length > NO_DIRECTION { x * (1.0 / length) } else { Vector3::ZERO }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::alignment::rotation::{rotate, rotation_of};

    #[test]
    fn a_frame_moves_grows_and_turns_with_the_points() {
        let points: Vec<Vector3> = (0..50)
            .map(f64::from)
            .map(|k| Vector3([1.0 + k.sin().abs(), 0.1 * k + k.cos(), (2.0 * k).sin().powi(3)]))
            .collect();
        let turn = rotation_of([0.8, 0.36, -0.48, 0.0]);
        let moved: Vec<Vector3> =
            points.iter().rev().map(|&x| rotate(turn, x) * 3.0 + Vector3([5.0, -1.0, 2.0])).collect();
        let [frame, other] = [OwnFrame::of(&points), OwnFrame::of(&moved)];
        assert_eq!([frame.n_clear, other.n_clear], [2, 2]);
        assert!((other.size / frame.size - 3.0).abs() < 1e-14);
        assert!(other.center.distance(rotate(turn, frame.center) * 3.0 + Vector3([5.0, -1.0, 2.0])) < 1e-13);
        for (axis, turned) in frame.axes.iter().zip(other.axes) {
            assert!(rotate(turn, *axis).distance(turned) < 1e-13);
        }
        let [a, b, c] = frame.axes;
        assert!(a.cross(b).distance(c) < 1e-14 && (a.norm() - 1.0).abs() < 1e-14);
        let standardized = points.iter().map(|&x| frame.standardized(x).dot(frame.standardized(x)));
        assert!((standardized.sum::<f64>() / 50.0 - 1.0).abs() < 1e-14);
    }

    #[test]
    fn the_directions_of_symmetric_points_are_not_clear() {
        let [x, y, z] = [0, 1, 2].map(Vector3::unit);
        let octahedron = OwnFrame::of(&[x, -x, y, -y, z, -z]);
        assert!(octahedron.n_clear == 0 && octahedron.axes == [Vector3::ZERO; 3]);
        let cone = OwnFrame::of(&[x, -x, y, -y, z * 3.0]);
        assert!(cone.n_clear == 1 && cone.axes[0].distance(z) < 1e-14 && cone.axes[1] == Vector3::ZERO);
    }
}
