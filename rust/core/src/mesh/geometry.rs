// SPDX-License-Identifier: MIT OR Apache-2.0
//! Lengths, areas and angles of triangles in space.
//!
//! Areas and cotangents are meant for points in the unit bounding box of
//! [`normalized`], where no square of a length over- or underflows.

use super::Vertex;
use crate::vector::Vector3;

/// The corners of face `[i, j, k]`.
#[inline]
pub fn triangle(points: &[Vector3], [i, j, k]: [Vertex; 3]) -> [Vector3; 3] {
    [points[i], points[j], points[k]]
}

/// The normal of a triangle, of length equal to its area; the corners run counterclockwise seen from its tip.
pub fn area_vector([a, b, c]: [Vector3; 3]) -> Vector3 {
    (b - a).cross(c - a) * 0.5
}

/// A generous bound of the rounding error of det(a, b, c) = a · (p × q) with p = b − a and q = c − a: of the
/// differences, the products and their sum.
#[inline]
pub(crate) fn determinant_rounding(a: Vector3, p: Vector3, q: Vector3) -> f64 {
    let products = |i: usize, j: usize| (p[i] * q[j]).abs() + (p[j] * q[i]).abs();
    2e-15 * (a[0].abs() * products(1, 2) + a[1].abs() * products(2, 0) + a[2].abs() * products(0, 1))
}

/// The area of a triangle.
pub fn area(corners: [Vector3; 3]) -> f64 {
    area_vector(corners).norm()
}

/// The lengths of the edges opposite to each corner.
pub fn edge_lengths([a, b, c]: [Vector3; 3]) -> [f64; 3] {
    [b.distance(c), c.distance(a), a.distance(b)]
}

/// The height of a triangle over its longest edge; NaN where its corners all coincide.
pub fn least_height(corners: [Vector3; 3]) -> f64 {
    2.0 * area(corners) / edge_lengths(corners).into_iter().fold(0.0, f64::max)
}

/// The cotangents of the angles of a triangle of positive area.
pub fn cotangents(corners: [Vector3; 3]) -> [f64; 3] {
    let double_area = 2.0 * area(corners);
    let [a, b, c] = corners;
    let inner = |p: Vector3, q: Vector3, r: Vector3| (q - p).dot(r - p) / double_area;
    [inner(a, b, c), inner(b, c, a), inner(c, a, b)]
}

/// The area of every face, (m,).
pub fn face_areas(points: &[Vector3], faces: &[[Vertex; 3]]) -> Vec<f64> {
    faces.iter().map(|&face| area(triangle(points, face))).collect()
}

/// The cotangents at the corners of every face, (m, 3).
pub fn corner_cotangents(points: &[Vector3], faces: &[[Vertex; 3]]) -> Vec<[f64; 3]> {
    faces.iter().map(|&face| cotangents(triangle(points, face))).collect()
}

/// The length of a closed polygon through the given points.
pub fn loop_length(points: &[Vector3], vertices: &[Vertex]) -> f64 {
    let last = vertices.len().saturating_sub(1);
    let next = |i: usize| if i == last { 0 } else { i + 1 };
    (0..vertices.len()).map(|i| points[vertices[i]].distance(points[vertices[next(i)]])).sum()
}

/// Centers points on their bounding box and scales its diagonal to one; returns them with the diagonal.
///
/// Coordinates may be finite numbers of any size. Points that all coincide become zeros with scale 1.
pub fn normalized(vertices: &[impl Copy + Into<Vector3>]) -> (Vec<Vector3>, f64) {
    let (center, half) = bounding_box(vertices);
    let widest = half.max_abs();
    if widest == 0.0 {
        return (vec![Vector3::ZERO; vertices.len()], 1.0);
    }
    // dividing by the widest side first keeps every square within range
    let diagonal = 2.0 * half.map(|h| h / widest).norm();
    let points = vertices.iter().map(|&v| (v.into() - center).map(|x| x / widest / diagonal)).collect();
    (points, (widest * diagonal).min(f64::MAX))
}

/// The center of the bounding box and half its sides.
fn bounding_box(vertices: &[impl Copy + Into<Vector3>]) -> (Vector3, Vector3) {
    let mut low = Vector3([f64::INFINITY; 3]);
    let mut high = Vector3([f64::NEG_INFINITY; 3]);
    for &vertex in vertices {
        let vertex = vertex.into();
        for axis in 0..3 {
            low[axis] = low[axis].min(vertex[axis]);
            high[axis] = high[axis].max(vertex[axis]);
        }
    }
    // halved before they are added: the full side of a box can overflow
    let [low, high] = [low * 0.5, high * 0.5];
    (high + low, high - low)
}
