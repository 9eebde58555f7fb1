// SPDX-License-Identifier: MIT OR Apache-2.0
//! Data of the target carried to the source: by vertices, by corners of faces, and labels.
//!
//! Data have a number of columns, their width, and one row per vertex, or three per face for corners. The value at a
//! vertex of the source is interpolated in the triangle of the target in which it lies. The corners of faces around a
//! vertex may lie on different sides of a seam of the data, as of a UV map: each takes the value of the side on which
//! its face lies. [`pull_corners`] finds the seams where the data jump. Labels show no seams; there a point moved from
//! the vertex a little into the face determines the side.

mod corners;
mod frames;
mod smooth;

use crate::location::{Location, Locator};
use crate::mesh::geometry::triangle;
use crate::mesh::{Corner, Vertex};
use crate::parallel;
use crate::vector::Vector3;

pub use corners::pull_corners;
pub use frames::local_similarities;
pub use smooth::pull_vertices_smoothly;

/// Move of a corner into its face that determines its side, relative to the way to the face's centroid or, if shorter,
/// to the longest edge of the target's triangle there.
const INWARD: f64 = 1e-2;

/// Per-vertex data of the target at the vertices of the source.
///
/// `values` are rows of `width` numbers, one per vertex of the target, `faces` its faces, and `locations` (n,) those of
/// the source vertices on them. Returns (n, width).
///
/// # Panics
/// If there are too few `values` for the indices in `faces`.
pub fn pull_vertices(
    values: &[f64],
    width: usize,
    faces: &[[Vertex; 3]],
    locations: &[Location],
) -> Vec<f64> {
    rows(locations.len(), width, |row, column| {
        let location = locations[row];
        let face = faces[location.triangle];
        interpolated(location, |corner| values[face[corner].index() * width + column])
    })
}

/// The vertex of the target nearest to each vertex of the source, (n,): the one of the largest weight in the triangle,
/// the first of equals.
pub fn nearest_vertices(faces: &[[Vertex; 3]], locations: &[Location]) -> Vec<Vertex> {
    parallel::map(locations.len(), |vertex| {
        let location = locations[vertex];
        faces[location.triangle][heaviest(location)]
    })
}

/// The corner of the target's faces nearest to each corner of the source's, (3 m,): corner `3 * face + k`, on the side
/// on which the source's face lies.
pub fn nearest_corners(sides: &[Location]) -> Vec<Corner> {
    parallel::map(sides.len(), |corner| sides[corner].triangle.corner(heaviest(sides[corner])))
}

/// The given rows of data of any type: labels by [`nearest_vertices`] or [`nearest_corners`].
///
/// # Panics
/// If a row is out of range.
pub fn pull_rows<T: Copy>(values: &[T], width: usize, rows: &[impl Copy + Into<usize>]) -> Vec<T> {
    let row = |row: usize| &values[row * width..][..width];
    rows.iter().flat_map(|&index| row(index.into())).copied().collect()
}

/// The locations of the corners of the source's faces in the target, (3 m,): those of their vertices, but in a triangle
/// on the side of the vertex on which the face lies.
///
/// `registered` and `target_registered` are the vertices of both in the domain, either on the unit sphere or in the
/// plane z = 1, and `locations` (n,) those of the source vertices in the target. Cost: O(log m) for a corner.
pub fn corner_sides(
    source_faces: &[[Vertex; 3]],
    registered: &[Vector3],
    target_faces: &[[Vertex; 3]],
    target_registered: &[Vector3],
    locations: &[Location],
) -> Vec<Location> {
    let target = Locator::new(target_registered, target_faces);
    let mut sides = vec![[Location::default(); 3]; source_faces.len()];
    parallel::fill(&mut sides, |face| {
        let corners = triangle(registered, source_faces[face]);
        let centroid = corners.into_iter().sum::<Vector3>() * (1.0 / 3.0);
        let vertices = source_faces[face];
        std::array::from_fn(|k| corner_side(&target, locations[vertices[k]], corners[k], centroid))
    });
    sides.into_flattened()
}

/// The location of a corner at `x` on the side of the point `inner`.
fn corner_side(target: &Locator<'_>, at_vertex: Location, x: Vector3, inner: Vector3) -> Location {
    let here = at_vertex.triangle;
    let fraction = INWARD * (target.longest_edge(here) / x.distance(inner)).min(1.0);
    let moved = x + (inner - x) * fraction;
    if target.contains(here, moved) {
        return at_vertex;
    }
    match target.locate(moved).triangle {
        there if there == here => at_vertex,
        there => target.clamped(there, x),
    }
}

/// The corner of the largest weight, the first of equals.
fn heaviest(Location { barycentric, .. }: Location) -> usize {
    (1..3).fold(0, |best, k| if barycentric[k] > barycentric[best] { k } else { best })
}

/// Σ λ_k value(k); exact for a constant and at a corner.
fn interpolated(location: Location, value: impl Fn(usize) -> f64) -> f64 {
    let heaviest = heaviest(location);
    let base = value(heaviest);
    // a corner without weight does not count even if its value is not finite
    let others = (0..3).filter(|&k| k != heaviest && location.barycentric[k] > 0.0);
    others.fold(base, |sum, k| sum + location.barycentric[k] * (value(k) - base))
}

fn rows(n: usize, width: usize, value: impl Fn(usize, usize) -> f64 + Sync + Send) -> Vec<f64> {
    parallel::map(n * width, |i| value(i / width, i % width))
}

#[cfg(test)]
mod tests;
