// SPDX-License-Identifier: MIT OR Apache-2.0
//! Straightest geodesics (K. Polthier and M. Schmies, Straightest geodesics on polyhedral surfaces, 1998): a place
//! walks straight on over the edges of the target, which are unfolded into the plane of the face it comes from.
//!
//! Cost: a few operations for each edge that is crossed.

use super::target::{Target, boundary_edge};
use crate::location::Location;
use crate::mesh::Corner;
use crate::vector::Vector3;

/// Most edges that a walk crosses.
const MOST_EDGES: usize = 10_000;

impl Target<'_> {
    /// The place reached by a walk along a vector in the plane of the face it starts in; the boundary ends it.
    pub(super) fn walked(&self, start: Location, along: Vector3) -> Location {
        let (mut place, mut left) = (start, along);
        for _ in 0..MOST_EDGES {
            let change = self.coordinates(place.triangle, left);
            if !change.iter().all(|x| x.is_finite()) {
                break;
            }
            // 1. To the first edge, or to the end
            let (share, edge) = first_edge(&place.barycentric, &change);
            for (coordinate, change) in place.barycentric.iter_mut().zip(change) {
                *coordinate = (*coordinate + share * change).max(0.0);
            }
            let Some(edge) = edge else { break };
            place.barycentric[edge] = 0.0;
            // 2. Into the next face
            let corner = place.triangle.corner(edge);
            let Some(across) = self.mesh().opposite(corner) else { break };
            left = self.unfolded(corner, across, left * (1.0 - share));
            place = self.seen_from(&place, corner, across);
        }
        let sum: f64 = place.barycentric.iter().sum();
        place.barycentric = place.barycentric.map(|coordinate| coordinate / sum);
        place
    }

    /// A vector in the plane of one face, turned about the edge to the next into the plane of that.
    fn unfolded(&self, corner: Corner, across: Corner, vector: Vector3) -> Vector3 {
        let [from, to] = corner.half_edge(self.faces()).map(|vertex| self.points[vertex]);
        let edge = (to - from).normalized();
        let along = vector.dot(edge);
        let forward = (vector - edge * along).norm();
        let apex = self.points[across.vertex(self.faces())] - from;
        edge * along + (apex - edge * apex.dot(edge)).normalized() * forward
    }

    /// A place on the edge opposite to a corner, in the face across.
    fn seen_from(&self, place: &Location, corner: Corner, across: Corner) -> Location {
        let mut barycentric = [0.0; 3];
        // the faces run along their common edge in opposite directions
        let (k, l) = (corner.place(), across.place());
        barycentric[(l + 1) % 3] = place.barycentric[(k + 2) % 3];
        barycentric[(l + 2) % 3] = place.barycentric[(k + 1) % 3];
        Location { triangle: across.face(), barycentric }
    }

    /// The place reached along the boundary, the surface on the left of travel; a negative distance goes back.
    pub(super) fn walked_along_boundary(&self, start: Location, distance: f64) -> Location {
        let Some(mut corner) = boundary_edge(self.mesh(), &start) else { return start };
        let mut t = self.parameter(corner, &start);
        let mut left = distance;
        for _ in 0..MOST_EDGES {
            let [from, to] = corner.half_edge(self.faces()).map(|vertex| self.points[vertex]);
            let length = from.distance(to);
            let end = t + left / length;
            if (0.0..=1.0).contains(&end) {
                return Location::on_edge(corner, end);
            }
            (left, t) = if end > 1.0 { (left - (1.0 - t) * length, 0.0) } else { (left + t * length, 1.0) };
            let Some(next) = self.next_on_boundary(corner, end > 1.0) else { break };
            corner = next;
        }
        Location::on_edge(corner, t.clamp(0.0, 1.0))
    }

    /// The share of a boundary edge that lies before a place on it.
    fn parameter(&self, corner: Corner, place: &Location) -> f64 {
        if place.triangle == corner.face() { place.barycentric[(corner.place() + 2) % 3] } else { 0.0 }
    }

    /// The boundary edge after or before another.
    fn next_on_boundary(&self, corner: Corner, forward: bool) -> Option<Corner> {
        let vertex = corner.half_edge(self.faces())[usize::from(forward)];
        let end = usize::from(!forward);
        let around = self.mesh().vertex_corners(vertex).iter().flat_map(|corner| corner.face().corners());
        around.into_iter().find(|corner| {
            self.mesh().opposite(*corner).is_none() && corner.half_edge(self.faces())[end] == vertex
        })
    }
}

/// The first edge that a place meets, as its number in the face, with the share of the way up to it.
fn first_edge(barycentric: &[f64; 3], change: &[f64; 3]) -> (f64, Option<usize>) {
    let (mut share, mut edge) = (1.0, None);
    for k in 0..3 {
        if change[k] < 0.0 && barycentric[k] + share * change[k] < 0.0 {
            (share, edge) = (barycentric[k] / -change[k], Some(k));
        }
    }
    (share, edge)
}
