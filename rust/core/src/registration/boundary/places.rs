// SPDX-License-Identifier: MIT OR Apache-2.0
//! Places on a convex polygon, by the angle about its middle.

use std::f64::consts::TAU;

use crate::location::Location;
use crate::mesh::{Corner, TriangleMesh, Vertex};
use crate::vector::Vector3;

/// An angle this near to that of a corner, relative to the arcs beside it, is that of the corner.
const AT_CORNER: f64 = 1e-9;

/// Sine of the least angle, in space, by which the boundary bends at a corner.
const BENT: f64 = 1e-6;

/// One of two surfaces in the plane.
#[derive(Debug, Clone, Copy)]
pub(super) struct Side<'a> {
    pub mesh: &'a TriangleMesh,
    pub map: &'a [[f64; 2]],
}

/// A place on the polygon.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub(super) struct Place {
    /// The edge, from corner `edge` of the polygon to the next.
    pub edge: usize,
    /// The share of the edge before the place, in [0, 1): 0 is the corner.
    pub share: f64,
}

/// The boundary of a surface in the plane as a polygon, counter-clockwise.
#[derive(Debug)]
pub(super) struct Rim {
    center: [f64; 2],
    corners: Vec<[f64; 2]>,
    /// The angle of each corner about the center, ascending, all within one turn.
    pub angles: Vec<f64>,
    /// Whether the boundary bends there in space.
    pub is_bent: Vec<bool>,
    /// The corner, of a face of the surface, opposite to each edge.
    opposite: Vec<Corner>,
}

impl Rim {
    /// The boundary of a surface; `None` if it does not run once around its middle.
    pub(super) fn new(side: Side<'_>) -> Option<Self> {
        let boundary = &side.mesh.boundary_loops()[0];
        let corners: Vec<[f64; 2]> = boundary.iter().map(|&vertex| side.map[vertex]).collect();
        let center = centroid(&corners);
        let angles = ascending(corners.iter().map(|&corner| angle(center, corner)))?;
        let is_bent = (0..boundary.len()).map(|k| bends(side.mesh, boundary, k)).collect();
        let opposite = edges(side.mesh, boundary)?;
        Some(Self { center, corners, angles, is_bent, opposite })
    }

    pub(super) fn len(&self) -> usize {
        self.corners.len()
    }

    /// The angles of points around the polygon, ascending from the first; `None` if they do not run once around it.
    pub(super) fn angles_of(&self, points: impl Iterator<Item = [f64; 2]>) -> Option<Vec<f64>> {
        ascending(points.map(|point| angle(self.center, point)))
    }

    /// An angle brought into the turn that begins at the first corner.
    fn within(&self, angle: f64) -> f64 {
        let first = self.angles[0];
        let turns = ((angle - first) / TAU).floor();
        if turns == 0.0 { angle } else { (angle - TAU * turns).clamp(first, first + TAU) }
    }

    /// The places at ascending angles.
    pub(super) fn places(&self, angles: &[f64]) -> Vec<Place> {
        let n = angles.len();
        let gap = |k: usize| (angles[(k + 1) % n] - angles[k]).rem_euclid(TAU);
        (0..n).map(|k| self.place(angles[k], AT_CORNER * gap(k).min(gap((k + n - 1) % n)))).collect()
    }

    /// The place at an angle; a corner if that is nearer than `near`.
    fn place(&self, angle: f64, near: f64) -> Place {
        let n = self.len();
        let x = self.within(angle);
        let edge = self.angles.partition_point(|&corner| corner <= x).max(1) - 1;
        let next = if edge + 1 < n { self.angles[edge + 1] } else { self.angles[0] + TAU };
        if x - self.angles[edge] <= near {
            return Place { edge, share: 0.0 };
        }
        if next - x <= near {
            return Place { edge: (edge + 1) % n, share: 0.0 };
        }
        let (sine, cosine) = x.sin_cos();
        let [p, q] = [edge, (edge + 1) % n].map(|k| self.corners[k]);
        let [px, py] = [p[0] - self.center[0], p[1] - self.center[1]];
        let [qx, qy] = [q[0] - self.center[0], q[1] - self.center[1]];
        let (before, after) = (px * sine - py * cosine, cosine * qy - sine * qx);
        let share = before / (before + after);
        // rounding may not leave the edge
        Place { edge, share: if share > 0.0 { share.min(1.0 - 1e-15) } else { 0.0 } }
    }

    /// The point of a place.
    fn point(&self, place: Place) -> [f64; 2] {
        let [p, q] = [place.edge, (place.edge + 1) % self.len()].map(|k| self.corners[k]);
        if place.share == 0.0 {
            return p;
        }
        [0, 1].map(|axis| p[axis] * (1.0 - place.share) + q[axis] * place.share)
    }

    /// The points of places.
    pub(super) fn points(&self, places: &[Place]) -> Vec<[f64; 2]> {
        places.iter().map(|&place| self.point(place)).collect()
    }

    /// The location of a place on an edge; `None` at a corner.
    pub(super) fn location(&self, place: Place) -> Option<Location> {
        (place.share > 0.0).then(|| Location::on_edge(self.opposite[place.edge], place.share))
    }
}

/// The corners opposite to the edges of a boundary loop.
fn edges(mesh: &TriangleMesh, boundary: &[Vertex]) -> Option<Vec<Corner>> {
    let opposite = |k: usize| {
        let (from, to) = (boundary[k], boundary[(k + 1) % boundary.len()]);
        let corners = mesh.vertex_corners(from).iter();
        let of_edge = corners.copied().find(|corner| corner.next().vertex(mesh.faces()) == to);
        of_edge.map(Corner::previous)
    };
    (0..boundary.len()).map(opposite).collect()
}

/// Whether the boundary bends in space at a vertex of its loop.
fn bends(mesh: &TriangleMesh, boundary: &[Vertex], k: usize) -> bool {
    let n = boundary.len();
    let point = |k: usize| mesh.points()[boundary[k % n]];
    let (before, after): (Vector3, Vector3) = (point(k) - point(k + n - 1), point(k + 1) - point(k));
    let is_back = before.dot(after) < 0.0;
    is_back || before.cross(after).norm() > BENT * before.norm() * after.norm()
}

/// The middle of a polygon, by area.
fn centroid(corners: &[[f64; 2]]) -> [f64; 2] {
    let [ox, oy] = corners[0];
    let (mut twice, mut sum) = (0.0, [0.0; 2]);
    for k in 1..corners.len() - 1 {
        let [ax, ay] = [corners[k][0] - ox, corners[k][1] - oy];
        let [bx, by] = [corners[k + 1][0] - ox, corners[k + 1][1] - oy];
        let cross = ax * by - ay * bx;
        twice += cross;
        sum = [sum[0] + cross * (ax + bx), sum[1] + cross * (ay + by)];
    }
    [ox + sum[0] / (3.0 * twice), oy + sum[1] / (3.0 * twice)]
}

fn angle(center: [f64; 2], [x, y]: [f64; 2]) -> f64 {
    (y - center[1]).atan2(x - center[0])
}

/// Angles that ascend from the first, each by less than half a turn, once around; `None` if they do not.
fn ascending(angles: impl Iterator<Item = f64>) -> Option<Vec<f64>> {
    let mut ascending: Vec<f64> = Vec::new();
    for angle in angles {
        let next = match ascending.last() {
            None => angle,
            Some(&last) => angle + TAU * ((last - angle) / TAU).ceil().max(0.0),
        };
        if ascending.last().is_some_and(|&last| next.is_nan() || next <= last) {
            return None;
        }
        ascending.push(next);
    }
    let is_once = ascending.len() >= 3 && ascending[ascending.len() - 1] < ascending[0] + TAU;
    is_once.then_some(ascending)
}
