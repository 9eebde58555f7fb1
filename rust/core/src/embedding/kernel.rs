// SPDX-License-Identifier: MIT OR Apache-2.0
//! The kernel of a star-shaped polygon: the room for a vertex among its neighbors.

use crate::vector::Vector3;

/// The centroid of the kernel of a polygon, in coordinates along `basis` from `center`. The kernel holds the points
/// from which all edges, given by their ends, run counter-clockwise.
///
/// `center` is a corner of the polygon from which all edges but its own two run so. `room` is a buffer.
pub(super) fn kernel_centroid(
    center: Vector3,
    basis: [Vector3; 2],
    edges: impl Iterator<Item = [Vector3; 2]> + Clone,
    room: &mut [Vec<[f64; 2]>; 2],
) -> [f64; 2] {
    let reach = edges.clone().map(|[start, _]| (start - center).norm()).fold(0.0, f64::max);
    let [polygon, next] = room;
    polygon.clear();
    polygon.extend([[-reach, -reach], [reach, -reach], [reach, reach], [-reach, reach]]);
    for [start, end] in edges {
        let normal = start.cross(end - start);
        // exactly 0 for the two edges that end at the center itself
        let constant = center.dot((start - center).cross(end - center));
        let [a, b] = basis.map(|axis| axis.dot(normal));
        clip(polygon, |z| constant + a * z[0] + b * z[1], next);
        std::mem::swap(polygon, next);
    }
    centroid(polygon)
}

/// Writes the part of a convex polygon where `height` is not negative.
fn clip(polygon: &[[f64; 2]], height: impl Fn([f64; 2]) -> f64, kept: &mut Vec<[f64; 2]>) {
    kept.clear();
    let Some(&last) = polygon.last() else { return };
    let (mut from, mut here) = (last, height(last));
    for &to in polygon {
        let there = height(to);
        if (here > 0.0 && there < 0.0) || (here < 0.0 && there > 0.0) {
            let t = here / (here - there);
            kept.push([0, 1].map(|axis| from[axis] + t * (to[axis] - from[axis])));
        }
        if there >= 0.0 {
            kept.push(to);
        }
        (from, here) = (to, there);
    }
}

/// The centroid of a convex polygon, or of its corners where it has no area; the origin where it is empty.
fn centroid(polygon: &[[f64; 2]]) -> [f64; 2] {
    let Some(&first) = polygon.first() else { return [0.0; 2] };
    let (mut total, mut sum) = (0.0, [0.0; 2]);
    for pair in polygon.windows(2) {
        let [a, b] = [pair[0], pair[1]].map(|z| [z[0] - first[0], z[1] - first[1]]);
        let area = a[0] * b[1] - a[1] * b[0];
        total += area;
        (0..2).for_each(|axis| sum[axis] += area * (a[axis] + b[axis]) / 3.0);
    }
    if total > 0.0 {
        return [0, 1].map(|axis| first[axis] + sum[axis] / total);
    }
    let count = polygon.len() as f64;
    [0, 1].map(|axis| polygon.iter().map(|z| z[axis]).sum::<f64>() / count)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_kernel_of_a_notched_square_lies_beyond_the_notch() {
        // a square whose lower side is pushed in to the origin: both halves of that side must be seen
        let corners = [[-1., -1., 1.], [0., 0., 1.], [1., -1., 1.], [1., 1., 1.], [-1., 1., 1.]].map(Vector3);
        let edges = (0..5).map(|k| [corners[k], corners[(k + 1) % 5]]);
        let basis = [0, 1].map(Vector3::unit);
        let [x, y] = kernel_centroid(corners[1], basis, edges, &mut Default::default());
        // the kernel is the triangle (0, 0), (1, 1), (−1, 1)
        assert!(x.abs() < 1e-15 && (y - 2.0 / 3.0).abs() < 1e-15, "{x} {y}");
    }
}
