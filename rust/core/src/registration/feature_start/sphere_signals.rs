// SPDX-License-Identifier: MIT OR Apache-2.0
//! Signals on the sphere, at any point: linear on the flat faces of a map onto which points are projected centrally.

use crate::location::Locator;
use crate::mesh::geometry::triangle;
use crate::mesh::{Face, TriangleMesh};
use crate::vector::Vector3;

/// Faces through which a search walks before it looks the point up among all.
const LONGEST_WALK: usize = 64;

/// Lowest weight of a corner at which a point lies in a face: rounding.
const OUTSIDE: f64 = -1e-12;

/// A surface on the unit sphere.
#[derive(Clone, Copy)]
pub(crate) struct OnSphere<'a> {
    pub mesh: &'a TriangleMesh,
    /// The vertices on the sphere.
    pub map: &'a [Vector3],
}

/// A place among the faces: a face, with the weights of its corners.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct SpherePlace {
    pub face: Face,
    weights: [f64; 3],
}

/// Signals at the vertices of a surface on the sphere.
pub(super) struct SphereSignals<'a> {
    mesh: &'a TriangleMesh,
    map: &'a [Vector3],
    locator: Locator<'a>,
    /// The number of signals.
    pub width: usize,
    /// `width` values at each vertex.
    values: Vec<f64>,
}

impl<'a> SphereSignals<'a> {
    pub(super) fn new(OnSphere { mesh, map }: OnSphere<'a>, values: &[f64], width: usize) -> Self {
        Self { mesh, map, locator: Locator::new(map, mesh.faces()), width, values: values.to_vec() }
    }

    /// The place of a point of the sphere.
    pub(super) fn place(&self, x: Vector3) -> SpherePlace {
        let location = self.locator.locate(x);
        SpherePlace { face: location.triangle, weights: location.barycentric }
    }

    /// The place of a point of the sphere near the face of another: the search walks from face to face toward it.
    pub(super) fn place_near(&self, x: Vector3, near: SpherePlace) -> SpherePlace {
        let mut face = near.face;
        for _ in 0..LONGEST_WALK {
            let weights = self.weights(face, x);
            let total: f64 = weights.iter().sum();
            let least = (0..3).min_by(|&a, &b| weights[a].total_cmp(&weights[b])).unwrap_or(0);
            // a face on the far side has its weights turned
            if total <= 0.0 {
                break;
            }
            if weights[least] >= OUTSIDE * total {
                return SpherePlace { face, weights: weights.map(|weight| weight / total) };
            }
            match self.mesh.opposite(face.corner(least)) {
                Some(across) => face = across.face(),
                None => break,
            }
        }
        self.place(x)
    }

    /// det(x, b, c), det(a, x, c) and det(a, b, x) of a face.
    fn weights(&self, face: Face, x: Vector3) -> [f64; 3] {
        let [a, b, c] = triangle(self.map, self.mesh.faces()[face]);
        [b.cross(c).dot(x), c.cross(a).dot(x), a.cross(b).dot(x)]
    }

    /// A signal at a place.
    pub(super) fn value(&self, place: &SpherePlace, signal: usize) -> f64 {
        let corners = self.mesh.faces()[place.face];
        (0..3).map(|k| place.weights[k] * self.values[corners[k].index() * self.width + signal]).sum()
    }

    /// The gradient of a signal by the point x at a place.
    pub(super) fn gradient(&self, place: &SpherePlace, x: Vector3, signal: usize) -> Vector3 {
        let corners = self.mesh.faces()[place.face];
        let [a, b, c] = triangle(self.map, corners);
        let normal = (b - a).cross(c - a);
        let square = normal.dot(normal);
        let toward = normal.dot(x);
        if square == 0.0 || toward <= 0.0 {
            return Vector3::ZERO;
        }
        let at = |k: usize| self.values[corners[k].index() * self.width + signal];
        let flat = normal.cross((c - b) * at(0) + (a - c) * at(1) + (b - a) * at(2)) * (1.0 / square);
        // the point of the face is x (n·a)/(n·x)
        (flat - normal * (flat.dot(x) / toward)) * (normal.dot(a) / toward)
    }
}
