// SPDX-License-Identifier: MIT OR Apache-2.0
//! Surfaces with their vertices on a grid, from which a registration begins.
//!
//! Maps to the domain, and what carries landmarks there, take hundreds of steps, and noise grows in them. Where only a
//! start is sought, it may as well be that of surfaces whose vertices were rounded to a grid that is fine beside faces and
//! coarse beside noise: nearly the same surfaces then have the same start, but where a coordinate lies midway between two
//! lines of the grid. The grid moves, grows and turns with the surface, where that has directions of its own
//! ([`OwnFrame`]) or by its landmarks, and so does the start.

use std::borrow::Cow;

use super::options::Energy;
use crate::alignment::rotation::rotate;
use crate::mesh::geometry::{area, edge_lengths, triangle};
use crate::mesh::own_frame::OwnFrame;
use crate::mesh::{TriangleMesh, Vertex};
use crate::parallel;
use crate::vector::Vector3;

/// Width of the cells at a vertex, relative to the least height of its faces; too narrow to fold one.
const CELL: f64 = 1.0 / 16.0;

/// Length of a vector, for a surface of unit size, from which noise hardly turns it.
const LONG: f64 = 0.1;

/// A surface from which a registration begins.
pub(super) struct StartSurface<'a> {
    pub mesh: Cow<'a, TriangleMesh>,
    /// The axes of the coordinates of its points in those of the given surface: rows of a rotation.
    pub axes: [Vector3; 3],
}

impl<'a> StartSurface<'a> {
    /// The surface in its own frame with its vertices on the grid where a descent between the surfaces follows; as it is
    /// where the start is the result.
    pub fn new(mesh: &'a TriangleMesh, landmarks: &[usize], energy: Energy) -> Self {
        let as_given = [0, 1, 2].map(Vector3::unit);
        match energy {
            Energy::Area => Self { mesh: Cow::Borrowed(mesh), axes: as_given },
            Energy::Surface => {
                let frame = OwnFrame::of(mesh.points());
                let of_landmarks = || {
                    let places = landmarks.iter().map(|&vertex| frame.standardized(mesh.points()[vertex]));
                    axes_through(&places.collect::<Vec<_>>())
                };
                let axes = frame.is_clear.then_some(frame.axes).or_else(of_landmarks).unwrap_or(as_given);
                let turned = |v: usize| rotate(axes, frame.standardized(mesh.points()[v]));
                let turned = parallel::map(mesh.n_vertices(), turned);
                Self { mesh: Cow::Owned(on_grid(mesh, &turned)), axes }
            }
        }
    }

    /// A vector of the given surface in the coordinates of this one.
    pub fn turned(&self, given: Vector3) -> Vector3 {
        rotate(self.axes, given)
    }
}

/// Axes toward the first of some places that is away from the origin, and on to the first beside that axis.
fn axes_through(places: &[Vector3]) -> Option<[Vector3; 3]> {
    let first = places.iter().find(|place| place.norm() > LONG)?.normalized();
    let across = |place: &Vector3| *place - first * first.dot(*place);
    let second = places.iter().map(across).find(|across| across.norm() > LONG)?.normalized();
    Some([first, second, first.cross(second)])
}

/// Points of the sphere in the coordinates of the given surface.
pub(super) fn turned_back(axes: [Vector3; 3], points: &[Vector3]) -> Vec<Vector3> {
    let back = [0, 1, 2].map(|row| Vector3(axes.map(|axis| axis[row])));
    parallel::map(points.len(), |v| rotate(back, points[v]).normalized())
}

/// The surface with its vertices at the points of the grid nearest to these.
fn on_grid(mesh: &TriangleMesh, points: &[Vector3]) -> TriangleMesh {
    let heights = parallel::map(mesh.n_faces(), |face| {
        let corners = triangle(points, mesh.faces()[face]);
        2.0 * area(corners) / edge_lengths(corners).into_iter().fold(0.0, f64::max)
    });
    mesh.reshaped(parallel::map(points.len(), |vertex| {
        let around = mesh.vertex_corners(Vertex::new(vertex)).iter();
        let least = around.map(|corner| heights[corner.face()]).fold(f64::INFINITY, f64::min);
        let cell = (CELL * least).log2().round().exp2();
        points[vertex].map(|x| (x / cell).round() * cell)
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::alignment::rotation::rotation_of;
    use crate::location::tests::{octasphere, rings};
    use crate::mesh::geometry::area_vector;

    /// Points moved by about 10⁻¹².
    fn with_noise(points: &[Vector3]) -> Vec<Vector3> {
        let noise = |k: usize| 1e-12 * ((k * 7919) % 1000) as f64 / 1000.0;
        let moved = |(k, &Vector3([x, y, z])): (usize, &Vector3)| {
            Vector3([x + noise(k), y - noise(k + 1), z + noise(k + 2)])
        };
        points.iter().enumerate().map(moved).collect()
    }

    fn sample(points: &[Vector3], faces: &[[Vertex; 3]]) -> TriangleMesh {
        let vertices: Vec<[f64; 3]> = points.iter().map(|point| point.0).collect();
        TriangleMesh::new(&vertices, faces).unwrap()
    }

    /// A lopsided ellipsoid and a turned saddle whose faces become thin toward one side.
    fn samples() -> [TriangleMesh; 2] {
        let (points, faces) = octasphere(4);
        let crowded = |&x: &Vector3| {
            let Vector3([x, y, z]) = (x + Vector3([0.5, 0.3, -0.4])).normalized();
            Vector3([x, 0.8 * y + 0.2 * x * x, 0.6 * z])
        };
        let ellipsoid: Vec<Vector3> = points.iter().map(crowded).collect();
        let (points, rings) = rings(12);
        let (sine, cosine) = 0.3f64.sin_cos();
        let crowded = |&Vector3([x, y, _]): &Vector3| {
            let squeezed = y * (0.4 + 0.3 * x);
            Vector3([cosine * x - sine * squeezed, sine * x + cosine * squeezed, 0.4 * x * (x + y)])
        };
        let saddle: Vec<Vector3> = points.iter().map(crowded).collect();
        [sample(&ellipsoid, &faces), sample(&saddle, &rings)]
    }

    fn on_grid(mesh: &TriangleMesh) -> TriangleMesh {
        StartSurface::new(mesh, &[], Energy::Surface).mesh.into_owned()
    }

    #[test]
    fn noise_is_forgotten_on_the_grid() {
        for mesh in samples() {
            let noisy = sample(&with_noise(mesh.points()), mesh.faces());
            assert!(noisy.points() != mesh.points() && noisy.face_areas() != mesh.face_areas());
            let [noisy, mesh] = [on_grid(&noisy), on_grid(&mesh)];
            assert!(noisy.points() == mesh.points() && noisy.face_areas() == mesh.face_areas());
        }
    }

    #[test]
    fn the_grid_moves_grows_and_turns_with_the_surface() {
        // a ball has no directions but those of its landmarks
        let (points, faces) = octasphere(3);
        let ball = sample(&points, &faces);
        assert!(!OwnFrame::of(ball.points()).is_clear);
        for mesh in samples().into_iter().chain([ball]) {
            let turn = rotation_of([0.8, 0.36, -0.48, 0.0]);
            let moved: Vec<Vector3> =
                mesh.points().iter().map(|&x| rotate(turn, x) * 3.0 + Vector3([5.0, -1.0, 2.0])).collect();
            let moved = sample(&moved, mesh.faces());
            let [ours, theirs] =
                [&mesh, &moved].map(|mesh| StartSurface::new(mesh, &[3, 7, 11], Energy::Surface));
            assert!(ours.mesh.points() == theirs.mesh.points());
            // a direction of the given surface and its image are the same in the frame, and come back from there
            let [x, y] = [Vector3([0.6, 0.0, 0.8]), rotate(turn, Vector3([0.6, 0.0, 0.8]))];
            assert!(ours.turned(x).distance(theirs.turned(y)) < 1e-12);
            assert!(turned_back(theirs.axes, &[theirs.turned(y)])[0].distance(y) < 1e-14);
        }
    }

    #[test]
    fn faces_keep_their_sides_and_nearly_their_areas() {
        for mesh in samples() {
            let frame = OwnFrame::of(mesh.points());
            let turned: Vec<Vector3> =
                mesh.points().iter().map(|&x| rotate(frame.axes, frame.standardized(x))).collect();
            let on_grid = on_grid(&mesh);
            let moved =
                turned.iter().zip(on_grid.points()).filter(|(before, after)| before.distance(**after) > 1e-6);
            assert!(moved.count() > mesh.n_vertices() / 2);
            for (face, &corners) in mesh.faces().iter().enumerate() {
                let [before, after] =
                    [&turned, on_grid.points()].map(|points| area_vector(triangle(points, corners)));
                assert!(before.dot(after) > 0.9 * before.norm() * after.norm());
                assert!((0.75..1.25).contains(&(after.norm() / before.norm())));
                assert!(
                    (on_grid.face_areas()[face] / area(triangle(on_grid.points(), corners)) - 1.0).abs()
                        < 1e-12
                );
            }
        }
    }

    #[test]
    fn where_the_start_is_the_result_nothing_moves() {
        for mesh in samples() {
            let start = StartSurface::new(&mesh, &[], Energy::Area);
            assert!(start.mesh.points() == mesh.points() && start.mesh.face_areas() == mesh.face_areas());
            assert!(start.turned(Vector3([1.0, 2.0, 3.0])) == Vector3([1.0, 2.0, 3.0]));
        }
    }
}
