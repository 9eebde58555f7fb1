// SPDX-License-Identifier: MIT OR Apache-2.0
//! Data by corners of faces, carried without smearing a face over a seam.
//!
//! A seam is an edge of the target at which the data of its two faces differ, as the border of an island of a UV map.
//! Faces of the source may lie across it. So the value at a corner is found on the straight way to it from the centroid
//! of its face: at the corner itself, or at the first seam on the way, on the near side.

use super::{interpolated, rows};
use crate::location::{Location, Locator, determinant};
use crate::mesh::geometry::triangle;
use crate::mesh::{Corner, Face, Vertex, VertexCorners};
use crate::parallel;
use crate::vector::Vector3;

/// Largest difference of equal values on both sides of an edge, relative to the larger of them and 1.
const ROUNDING: f64 = 1e-6;

/// Per-corner data of the target at the corners of the source's faces.
///
/// `values` are rows of `width` numbers, three per face of the target. `registered` and `target_registered` are the
/// vertices of both in the domain, either on the unit sphere or in the plane z = 1, and `locations` (n,) those of the
/// source vertices in the target. Returns (3 m, width): the values at the vertices; where a seam of the data runs
/// through a face or along its edges, the face takes the values on the side of its centroid.
///
/// # Panics
/// If `values` has fewer rows than `target_faces` has corners.
pub fn pull_corners(
    values: &[f64],
    width: usize,
    source_faces: &[[Vertex; 3]],
    registered: &[Vector3],
    target_faces: &[[Vertex; 3]],
    target_registered: &[Vector3],
    locations: &[Location],
) -> Vec<f64> {
    let locator = Locator::new(target_registered, target_faces);
    let corners = VertexCorners::new(target_registered.len(), target_faces);
    let target =
        Target { values, width, faces: target_faces, positions: target_registered, corners, locator };
    let mut places = vec![[Location::default(); 3]; source_faces.len()];
    parallel::fill(&mut places, |face| {
        let vertices = source_faces[face];
        let corners = triangle(registered, vertices);
        let centroid = corners.into_iter().sum::<Vector3>() * (1.0 / 3.0);
        let start = target.locator.locate(centroid).triangle;
        std::array::from_fn(|k| target.reached(start, centroid, corners[k], locations[vertices[k]]))
    });
    let places = places.as_flattened();
    rows(places.len(), width, |row, column| {
        let face = places[row].triangle;
        interpolated(places[row], |k| values[face.corner(k).index() * width + column])
    })
}

/// The target with its data.
struct Target<'a> {
    values: &'a [f64],
    width: usize,
    faces: &'a [[Vertex; 3]],
    positions: &'a [Vector3],
    corners: VertexCorners,
    locator: Locator<'a>,
}

impl Target<'_> {
    /// The end of the way `from` a point of the triangle `here` to `x` at `goal`: `goal` itself, or the first seam.
    fn reached(&self, mut here: Face, from: Vector3, x: Vector3, goal: Location) -> Location {
        // a way through more triangles than there are goes in circles
        for _ in 0..self.faces.len() {
            if here == goal.triangle {
                return goal;
            }
            let Some(edge) = self.way_out(here, from, x) else { break };
            match self.across(here, edge) {
                Some(next) => here = next,
                None => return self.crossing(here, edge, from, x),
            }
        }
        self.locator.clamped(here, x)
    }

    /// The edge through which the way to `x` leaves a triangle, by the corner opposite; `None` where `x` lies in it.
    fn way_out(&self, face: Face, from: Vector3, x: Vector3) -> Option<usize> {
        let corners = triangle(self.positions, self.faces[face]);
        // in every triangle alike, a corner on the way counts as left of it
        let is_left = corners.map(|corner| determinant(from, x, corner) >= 0.0);
        let leaves = |k: &usize| determinant(corners[(k + 1) % 3], corners[(k + 2) % 3], x) < 0.0;
        let crosses = |k: &usize| !is_left[(k + 1) % 3] && is_left[(k + 2) % 3];
        (0..3).find(|k| crosses(k) && leaves(k)).or_else(|| (0..3).find(leaves))
    }

    /// The face on the other side of an edge; `None` at a seam or at the boundary.
    fn across(&self, face: Face, edge: usize) -> Option<Face> {
        let (i, j) = ((edge + 1) % 3, (edge + 2) % 3);
        let [start, end] = [i, j].map(|k| self.faces[face][k]);
        // in the adjacent face the edge runs the other way
        let across = *self.corners.of(end).iter().find(|corner| corner.next().vertex(self.faces) == start)?;
        let agrees = |k: usize, corner: Corner| self.agree(face.corner(k), corner);
        (agrees(j, across) && agrees(i, across.next())).then_some(across.face())
    }

    /// The location at which the way crosses an edge.
    fn crossing(&self, face: Face, edge: usize, from: Vector3, x: Vector3) -> Location {
        let (i, j) = ((edge + 1) % 3, (edge + 2) % 3);
        let corners = triangle(self.positions, self.faces[face]);
        let (right, left) = (-determinant(from, x, corners[i]), determinant(from, x, corners[j]));
        let (right, left) = (right.max(0.0), left.max(0.0));
        if right + left == 0.0 {
            return self.locator.clamped(face, x);
        }
        let mut barycentric = [0.0; 3];
        (barycentric[i], barycentric[j]) = (left / (right + left), right / (right + left));
        Location { triangle: face, barycentric }
    }

    /// Whether two corners have the same values up to the rounding of single precision; two NaNs agree.
    fn agree(&self, a: Corner, b: Corner) -> bool {
        let is_same = |(a, b): (&f64, &f64)| {
            (a - b).abs() <= ROUNDING * a.abs().max(b.abs()).max(1.0) || a.is_nan() && b.is_nan() || a == b
        };
        self.row(a).iter().zip(self.row(b)).all(is_same)
    }

    fn row(&self, corner: Corner) -> &[f64] {
        &self.values[corner.index() * self.width..][..self.width]
    }
}
