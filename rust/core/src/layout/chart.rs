// SPDX-License-Identifier: MIT OR Apache-2.0
//! A mesh of the sphere developed into the plane, face by face.

use std::marker::PhantomData;

use super::isometry::Isometry;
use super::projection::Projection;
use crate::mesh::{Corner, Face, Vertex};
use crate::parallel;

/// A point of the plane.
pub(super) type Point = [f64; 2];

/// A mesh in the plane. The image of a corner is the place of its vertex, moved by the isometry of the corner.
///
/// So the two faces at an edge agree on its length, wherever they lie, and moving a vertex does not tear the layout.
pub(super) struct Chart<'a, P> {
    /// (m, 3), counter-clockwise.
    pub faces: &'a [[Vertex; 3]],
    /// (n,): the place of each vertex.
    pub places: Vec<Point>,
    /// (m, 3): the isometry of each corner.
    pub isometries: Vec<[Isometry; 3]>,
    /// The corners at poles, grouped by polygon and pole. They lie in the middle of the other corners of their polygon.
    pub polar: Vec<Vec<Corner>>,
    /// (m,): whether the corners of each face fit together; they do not if it winds around a singular point.
    pub is_closed: Vec<bool>,
    pub projection: PhantomData<P>,
}

impl<P: Projection> Chart<'_, P> {
    /// The images of all corners, (m, 3).
    pub fn images(&self) -> Vec<[Point; 3]> {
        let mut images = parallel::map(self.faces.len(), |face| self.corner_images(Face::new(face)));
        center_polar_corners(&self.polar, &mut images);
        images
    }

    /// The images of the corners of a face, except those at poles.
    pub fn corner_images(&self, face: Face) -> [Point; 3] {
        std::array::from_fn(|corner| {
            let place = self.places[self.faces[face][corner]];
            self.isometries[face][corner].image(P::PERIODS, place)
        })
    }

    /// The image of a corner that is not at a pole.
    pub fn image(&self, corner: Corner) -> Point {
        self.corner_images(corner.face())[corner.place()]
    }
}

/// Centers the corners at poles between the other corners of their polygons.
pub(super) fn center_polar_corners(polar: &[Vec<Corner>], images: &mut [[Point; 3]]) {
    for group in polar {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for &corner in group {
            let (face, polar) = (corner.face(), corner.place());
            for k in [(polar + 1) % 3, (polar + 2) % 3] {
                low = low.min(images[face][k][0]);
                high = high.max(images[face][k][0]);
            }
        }
        for &corner in group {
            images[corner.face()][corner.place()][0] = 0.5 * (low + high);
        }
    }
}

/// The signed area of a triangle in the plane.
pub(super) fn signed_area([a, b, c]: [Point; 3]) -> f64 {
    0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
}

/// The signed areas of all faces, (m,).
pub(super) fn signed_areas(images: &[[Point; 3]]) -> Vec<f64> {
    parallel::map(images.len(), |face| signed_area(images[face]))
}
