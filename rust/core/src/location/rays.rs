// SPDX-License-Identifier: MIT OR Apache-2.0
//! Rays that triangles block (Möller & Trumbore 1997, *Fast, minimum storage ray/triangle intersection*).

use super::bvh::{Bounds, Ray, Tree};
use crate::mesh::Vertex;
use crate::mesh::geometry::triangle;
use crate::vector::Vector3;

/// How far beyond its edges a triangle still blocks, as a barycentric coordinate. A ray through an edge is blocked
/// then, whatever the rounding.
const MARGIN: f64 = 1e-6;

/// The sine of the angle to a triangle's plane below which a ray runs along the triangle and passes.
const GRAZING: f64 = 1e-9;

/// Triangles in space, which block rays from both sides. Cost: O(m log² m) to build, O(log m) for a ray that meets few
/// boxes.
pub(crate) struct Obstacles<'a> {
    points: &'a [Vector3],
    faces: &'a [[Vertex; 3]],
    tree: Tree,
}

impl<'a> Obstacles<'a> {
    /// Prepares to cast rays at least one face, whose size is of the order of 1 at the most.
    pub(crate) fn new(points: &'a [Vector3], faces: &'a [[Vertex; 3]]) -> Self {
        let bounds = |&face: &[Vertex; 3]| {
            triangle(points, face).into_iter().fold(Bounds::default(), Bounds::with).padded(MARGIN)
        };
        let bounds: Vec<Bounds> = faces.iter().map(bounds).collect();
        Self { points, faces, tree: Tree::new(&bounds) }
    }

    /// Whether a face lies on the ray from `origin` along `direction`.
    pub(crate) fn block(&self, origin: Vector3, direction: Vector3) -> bool {
        let ray = Ray::new(origin, direction);
        self.tree.any_along(&ray, |face| is_met(&ray, triangle(self.points, self.faces[face])))
    }
}

/// Whether a ray meets a triangle.
fn is_met(ray: &Ray, [a, b, c]: [Vector3; 3]) -> bool {
    let (p, q, to_origin) = (b - a, c - a, ray.origin - a);
    let normal = p.cross(q);
    // all barycentric coordinates and the parameter of the ray are divided by this
    let determinant = -ray.direction.dot(normal);
    if determinant.abs() <= GRAZING * normal.norm() * ray.direction.norm() {
        return false;
    }
    let reciprocal = determinant.recip();
    let across = to_origin.cross(ray.direction);
    let (v, w) = (q.dot(across) * reciprocal, -p.dot(across) * reciprocal);
    to_origin.dot(normal) * reciprocal > 0.0 && v >= -MARGIN && w >= -MARGIN && v + w <= 1.0 + MARGIN
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::faces_of_indices;

    #[test]
    fn rays_are_blocked_by_a_triangle_ahead_from_both_sides() {
        let points = [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]].map(Vector3);
        let up = Vector3::unit(2);
        for faces in [[[0, 1, 2]], [[0, 2, 1]]] {
            let faces = faces_of_indices(&faces);
            let obstacles = Obstacles::new(&points, &faces);
            // inside, on an edge, in a vertex, along a slanted line
            for target in [[0.3, 0.3, 1.0], [0.5, 0.5, 1.0], [0.0, 0.0, 1.0], [0.25, 0.5, 1.0]].map(Vector3) {
                let below = Vector3([target[0], target[1], 0.0]);
                assert!(obstacles.block(below, up) && !obstacles.block(below, -up));
                let eye = Vector3([3.0, -1.0, 4.0]);
                assert!(obstacles.block(eye, target - eye) && !obstacles.block(eye, eye - target));
            }
            // beside the triangle, beyond it, along it
            assert!(!obstacles.block(Vector3([0.6, 0.6, 0.0]), up));
            assert!(!obstacles.block(Vector3([0.3, 0.3, 1.5]), up));
            assert!(!obstacles.block(Vector3([-1.0, 0.3, 1.0]), Vector3::unit(0)));
        }
    }

    #[test]
    fn no_ray_passes_between_the_faces_of_a_closed_surface() {
        let [x, y, z] = [0, 1, 2].map(Vector3::unit);
        let points = [x, y, -x, -y, z, -z];
        let quarters = (0..4).flat_map(|i| [[i, (i + 1) % 4, 4], [(i + 1) % 4, i, 5]]);
        let faces = faces_of_indices(&quarters.collect::<Vec<_>>());
        let obstacles = Obstacles::new(&points, &faces);
        for direction in points.iter().flat_map(|&a| points.map(|b| a + b)).filter(|d| d.norm() > 0.5) {
            assert!(obstacles.block(Vector3::ZERO, direction), "{direction:?}");
            assert!(!obstacles.block(direction * 2.0, direction));
        }
    }
}
