// SPDX-License-Identifier: MIT OR Apache-2.0
//! Data at the corners of faces as given; orienting a surface has flipped some of these faces.

use super::transfer::{corner_sides, nearest_corners, pull_corners, pull_rows};
use crate::location::Location;
use crate::mesh::{Corner, Vertex};
use crate::vector::Vector3;

/// A registered surface with its faces as given, whose corners the data follow.
#[derive(Debug, Clone, Copy)]
pub struct GivenFaces<'a> {
    /// (m, 3): the faces as given.
    pub given: &'a [[Vertex; 3]],
    /// (m, 3): the faces as oriented.
    pub oriented: &'a [[Vertex; 3]],
    /// (n, 3): the vertices in the domain, on the unit sphere or in the plane z = 1.
    pub registered: &'a [Vector3],
}

impl GivenFaces<'_> {
    /// The corner given that has become each corner as oriented, (3 m,).
    fn given_corners(&self) -> Vec<Corner> {
        let given = |corner: Corner| {
            let (face, vertex) = (corner.face(), corner.vertex(self.oriented));
            let place = self.given[face].iter().position(|&given| given == vertex);
            face.corner(place.expect("a face keeps its vertices"))
        };
        Corner::all(self.oriented.len()).map(given).collect()
    }
}

/// The row of the target's data nearest to each corner of the source, (3 m,), both in the order of the corners given.
///
/// `locations` (n,) are those of the source vertices on the target.
///
/// # Panics
/// If a face as oriented has other vertices than as given.
pub fn nearest_given_corners(
    source: &GivenFaces<'_>,
    target: &GivenFaces<'_>,
    locations: &[Location],
) -> Vec<Corner> {
    let sides =
        corner_sides(source.oriented, source.registered, target.oriented, target.registered, locations);
    let (nearest, target_corners) = (nearest_corners(&sides), target.given_corners());
    let mut rows = vec![Corner::default(); nearest.len()];
    for (given, nearest) in source.given_corners().into_iter().zip(nearest) {
        rows[given] = target_corners[nearest];
    }
    rows
}

/// [`pull_corners`] with the rows of both surfaces in the order of the corners given.
///
/// # Panics
/// As [`pull_corners`], and if a face as oriented has other vertices than as given.
pub fn pull_given_corners(
    values: &[f64],
    width: usize,
    source: &GivenFaces<'_>,
    target: &GivenFaces<'_>,
    locations: &[Location],
) -> Vec<f64> {
    let oriented = pull_rows(values, width, &target.given_corners());
    let pulled = pull_corners(
        &oriented,
        width,
        source.oriented,
        source.registered,
        target.oriented,
        target.registered,
        locations,
    );
    let mut oriented_corners = vec![Corner::default(); 3 * source.oriented.len()];
    let corners = Corner::all(source.oriented.len());
    source
        .given_corners()
        .into_iter()
        .zip(corners)
        .for_each(|(given, corner)| oriented_corners[given] = corner);
    pull_rows(&pulled, width, &oriented_corners)
}
