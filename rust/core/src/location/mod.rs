// SPDX-License-Identifier: MIT OR Apache-2.0
//! Point location: the triangle of a map in which a point lies, and its barycentric coordinates.
//!
//! Maps live in space as in [`motion`](crate::codomain::motion): in the plane z = 1, or on the sphere around
//! the origin. A point x lies in the triangle (a, b, c) where det(a, b, x), det(b, c, x) and det(c, a, x) are
//! not negative, decided by exact predicates, so that no point falls between two triangles. The same three
//! determinants are its barycentric coordinates up to a factor: on the sphere those of its central projection
//! onto the flat triangle.
//!
//! Input: a map with all faces positively oriented, of a disk into the plane or onto the whole sphere.
//! Cost: O(m log² m) for the tree, O(log m) for a point.

mod bvh;
mod nearest;
mod rays;

use std::sync::Arc;

use robust::{Coord3D, orient3d};

use crate::control::Watch;
use crate::mesh::geometry::{determinant_rounding, triangle};
use crate::mesh::{Corner, Face, Vertex};
use crate::parallel;
use crate::vector::Vector3;
use bvh::{Bounds, Tree};
pub(crate) use nearest::NearestPoint;
pub(crate) use rays::Obstacles;

/// Points located between two checks for cancellation.
const BETWEEN_CHECKS: usize = 64;

/// A place on a surface: a face, and barycentric coordinates in it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Location {
    /// The face.
    pub triangle: Face,
    /// The weights of its corners: not negative, and 1 in sum.
    pub barycentric: [f64; 3],
}

impl Location {
    /// The place at the parameter `t` of the edge opposite to a corner, which runs from the next corner to the one
    /// after that.
    pub(crate) fn on_edge(corner: Corner, t: f64) -> Self {
        let mut barycentric = [0.0; 3];
        let k = corner.place();
        (barycentric[(k + 1) % 3], barycentric[(k + 2) % 3]) = (1.0 - t, t);
        Self { triangle: corner.face(), barycentric }
    }

    /// The place at a corner.
    pub(crate) fn at_corner(corner: Corner) -> Self {
        let mut barycentric = [0.0; 3];
        barycentric[corner.place()] = 1.0;
        Self { triangle: corner.face(), barycentric }
    }

    /// The point of the place, given the corners of its face.
    pub(crate) fn point(&self, corners: [Vector3; 3]) -> Vector3 {
        Vector3::from_fn(|axis| (0..3).map(|k| self.barycentric[k] * corners[k][axis]).sum())
    }

    /// The point of the place on a surface.
    pub(crate) fn point_on(&self, points: &[Vector3], faces: &[[Vertex; 3]]) -> Vector3 {
        self.point(triangle(points, faces[self.triangle]))
    }
}

/// The points of places on a surface.
pub(crate) fn points_on(locations: &[Location], points: &[Vector3], faces: &[[Vertex; 3]]) -> Vec<Vector3> {
    parallel::map(locations.len(), |place| locations[place].point_on(points, faces))
}

/// The tree over the faces of a map, for a caller that keeps it beside the map.
#[derive(Debug, Clone)]
pub(crate) struct FaceTree {
    /// Whether the map lies in the plane z = 1.
    in_plane: bool,
    tree: Arc<Tree>,
}

impl FaceTree {
    /// The tree over `faces` with corners `positions`, as [`Locator::new`] takes them.
    pub(crate) fn new(positions: &[Vector3], faces: &[[Vertex; 3]]) -> Self {
        let in_plane = positions.iter().all(|position| position[2] == 1.0);
        let bounds = parallel::map(faces.len(), |face| match triangle(positions, faces[face]) {
            flat if in_plane => flat.into_iter().fold(Bounds::default(), Bounds::with),
            spherical => spherical_bounds(spherical),
        });
        Self { in_plane, tree: Arc::new(Tree::new(&bounds)) }
    }
}

/// Finds points in a map.
pub(crate) struct Locator<'a> {
    positions: &'a [Vector3],
    faces: &'a [[Vertex; 3]],
    /// Whether the map lies in the plane z = 1.
    in_plane: bool,
    tree: Arc<Tree>,
}

impl<'a> Locator<'a> {
    /// Prepares to find points among `faces` with corners `positions`, either all in the plane z = 1 or on
    /// the sphere.
    pub(crate) fn new(positions: &'a [Vector3], faces: &'a [[Vertex; 3]]) -> Self {
        Self::with_tree(positions, faces, FaceTree::new(positions, faces))
    }

    /// [`Self::new`] with the tree that was made of the same map.
    pub(crate) fn with_tree(positions: &'a [Vector3], faces: &'a [[Vertex; 3]], tree: FaceTree) -> Self {
        let FaceTree { in_plane, tree } = tree;
        Self { positions, faces, in_plane, tree }
    }

    /// The triangle of the lowest index that contains `x`; if there is none, the nearest point of the map.
    ///
    /// `x` lies in the plane z = 1, or, for a map onto the sphere, anywhere but in the origin: its direction
    /// counts. At a vertex the coordinates are exactly 1 and 0.
    pub(crate) fn locate(&self, x: Vector3) -> Location {
        self.containing(x).unwrap_or_else(|| self.nearest(self.on_map(x)))
    }

    /// [`Self::locate`] where a triangle contains `x`, or is as near to it as `tolerance`.
    pub(crate) fn locate_within(&self, x: Vector3, tolerance: f64) -> Option<Location> {
        self.containing(x).or_else(|| {
            let nearest = self.nearest(self.on_map(x));
            let is_near = nearest.point_on(self.positions, self.faces).distance(self.on_map(x)) <= tolerance;
            is_near.then_some(nearest)
        })
    }

    fn on_map(&self, x: Vector3) -> Vector3 {
        if self.in_plane { x } else { x.normalized() }
    }

    /// The triangle of the lowest index that contains `x`.
    fn containing(&self, x: Vector3) -> Option<Location> {
        let mut containing: Option<(Face, [f64; 3])> = None;
        self.tree.visit(self.on_map(x), |face| {
            let Some(weights) = self.weights(face, x) else { return false };
            if containing.is_none_or(|(lowest, _)| face < lowest) {
                containing = Some((face, weights));
            }
            // a point inside a face lies in no other
            weights.iter().all(|&weight| weight > 0.0)
        });
        containing.map(|(triangle, weights)| Location { triangle, barycentric: normalized(weights) })
    }

    /// The locations of many points; `None` if cancelled.
    pub(crate) fn locate_all(&self, points: &[Vector3], watch: &Watch<'_>) -> Option<Vec<Location>> {
        let locations = parallel::map(points.len(), |i| {
            if i % BETWEEN_CHECKS == 0 && !watch.goes_on() {
                Location::default()
            } else {
                self.locate(points[i])
            }
        });
        watch.goes_on().then_some(locations)
    }

    /// Whether a triangle, its edges included, contains `x`.
    pub(super) fn contains(&self, face: Face, x: Vector3) -> bool {
        self.weights(face, x).is_some()
    }

    /// The place of `x` in a triangle that contains it up to rounding: negative coordinates become 0.
    pub(super) fn clamped(&self, triangle: Face, x: Vector3) -> Location {
        let corners = self.corners(triangle);
        let weights = determinants(corners, x).map(|weight| weight.max(0.0));
        let barycentric = if weights.iter().sum::<f64>() > 0.0 {
            normalized(weights)
        } else {
            nearest_on_edges(corners, x).1
        };
        Location { triangle, barycentric }
    }

    /// The length of the longest edge of a triangle.
    pub(super) fn longest_edge(&self, face: Face) -> f64 {
        let [a, b, c] = self.corners(face);
        a.distance(b).max(b.distance(c)).max(c.distance(a))
    }

    fn corners(&self, face: Face) -> [Vector3; 3] {
        triangle(self.positions, self.faces[face])
    }

    /// The barycentric coordinates, up to a factor, of `x` in a face; `None` if the face does not contain it.
    fn weights(&self, face: Face, x: Vector3) -> Option<[f64; 3]> {
        let weights = determinants(self.corners(face), x);
        let is_inside =
            weights.iter().all(|&weight| weight >= 0.0) && weights.iter().any(|&weight| weight > 0.0);
        is_inside.then_some(weights)
    }

    /// The nearest place to a point outside every triangle.
    fn nearest(&self, x: Vector3) -> Location {
        let triangle = self.tree.nearest(x, |face| nearest_on_edges(self.corners(face), x).0);
        Location { triangle, barycentric: nearest_on_edges(self.corners(triangle), x).1 }
    }
}

/// A box that contains a flat triangle and its central projection onto the unit sphere.
fn spherical_bounds(corners: [Vector3; 3]) -> Bounds {
    let [a, b, c] = corners.map(|x| x.normalized());
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    // how far q = Σ λ_i x_i moves out to the sphere: |q|² = 1 − Σ λ_i λ_j |x_i − x_j|², and Σ λ_i λ_j ≤ 1/3
    let height = 1.0 - (1.0 - longest * longest / 3.0).max(0.0).sqrt();
    [a, b, c].into_iter().fold(Bounds::default(), Bounds::with).padded(height + 1e-12)
}

/// det(b, c, x), det(c, a, x) and det(a, b, x), each with its exact sign.
fn determinants([a, b, c]: [Vector3; 3], x: Vector3) -> [f64; 3] {
    [determinant(b, c, x), determinant(c, a, x), determinant(a, b, x)]
}

/// det(p, q, x) with its exact sign, as x · (p − x) × (q − x), whose rounding falls with the distances.
pub(super) fn determinant(p: Vector3, q: Vector3, x: Vector3) -> f64 {
    if p == x || q == x {
        return 0.0;
    }
    let (to_p, to_q) = (p - x, q - x);
    let rounded = x.dot(to_p.cross(to_q));
    if rounded.abs() > determinant_rounding(x, to_p, to_q) {
        return rounded;
    }
    let [p, q, x] = [p, q, x].map(|Vector3([x, y, z])| Coord3D { x, y, z });
    orient3d(p, q, x, Coord3D { x: 0.0, y: 0.0, z: 0.0 })
}

fn normalized(weights: [f64; 3]) -> [f64; 3] {
    let sum: f64 = weights.iter().sum();
    weights.map(|weight| weight / sum)
}

/// The point of a triangle's edges nearest to `x`: its squared distance and its barycentric coordinates.
fn nearest_on_edges(corners: [Vector3; 3], x: Vector3) -> (f64, [f64; 3]) {
    let on_edges = (0..3).map(|k| {
        let (from, to) = ((k + 1) % 3, (k + 2) % 3);
        let edge = corners[to] - corners[from];
        let t = (x - corners[from]).dot(edge) / edge.dot(edge);
        let t = if t > 0.0 { t.min(1.0) } else { 0.0 };
        let mut barycentric = [0.0; 3];
        (barycentric[from], barycentric[to]) = (1.0 - t, t);
        let away = x - (corners[from] * (1.0 - t) + corners[to] * t);
        (away.dot(away), barycentric)
    });
    on_edges.reduce(|best, next| if next.0 < best.0 { next } else { best }).expect("three edges")
}

#[cfg(test)]
pub(crate) mod tests;
