// SPDX-License-Identifier: MIT OR Apache-2.0
//! Surfaces with their vertices on a grid, from which a registration begins.
//!
//! Maps to the domain, and what carries landmarks there, take hundreds of steps, and noise grows in them. Where only a
//! start is sought, it may as well be that of surfaces whose vertices were rounded to a grid that is fine beside faces and
//! coarse beside noise: nearly the same surfaces then have the same start, but where a coordinate lies midway between two
//! lines of the grid. The grid moves, grows and turns with the surface, where that has directions of its own
//! ([`OwnFrame`]) or by its landmarks, and so does the start.

use std::borrow::Cow;

use super::landmarks::Landmarks;
use super::options::Energy;
use crate::alignment::rotation::rotate;
use crate::mesh::geometry::{least_height, triangle};
use crate::mesh::own_frame::OwnFrame;
use crate::mesh::ties::{nearest_multiple, nearest_power_of_two};
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
    /// The surfaces in their own frames with their vertices on the grid where a descent between them follows; as they are
    /// where the start is the result.
    pub fn of_both(meshes: [&'a TriangleMesh; 2], landmarks: &Landmarks<'_>, energy: Energy) -> [Self; 2] {
        let landmarks = [landmarks.source, landmarks.target];
        [0, 1].map(|side| match energy {
            Energy::Area => Self::as_given(meshes[side]),
            Energy::Surface => Self::rounded(meshes[side], landmarks[side]),
        })
    }

    fn as_given(mesh: &'a TriangleMesh) -> Self {
        Self { mesh: Cow::Borrowed(mesh), axes: [0, 1, 2].map(Vector3::unit) }
    }

    /// The surface in its own frame with its vertices on the grid; as it is where faces would lose their areas.
    fn rounded(mesh: &'a TriangleMesh, landmarks: &[usize]) -> Self {
        let frame = OwnFrame::of(mesh.points());
        let as_given = Self::as_given(mesh);
        let clear = frame.axes[..frame.n_clear].iter().copied();
        let marked = landmarks.iter().map(|&vertex| frame.standardized(mesh.points()[vertex]));
        let axes = axes_through(&clear.chain(marked).collect::<Vec<_>>()).unwrap_or(as_given.axes);
        let turned = |vertex: usize| rotate(axes, frame.standardized(mesh.points()[vertex]));
        let on_grid = rounded_to(mesh, &parallel::map(mesh.n_vertices(), turned));
        let has_areas = parallel::all(on_grid.n_faces(), |face| on_grid.face_areas()[face] > 0.0);
        if has_areas { Self { mesh: Cow::Owned(on_grid), axes } } else { as_given }
    }

    /// A vector of the given surface in the coordinates of this one.
    pub fn turned(&self, given: Vector3) -> Vector3 {
        rotate(self.axes, given)
    }
}

/// Axes toward the first of some places that is away from the origin, and toward the first beside that axis.
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
fn rounded_to(mesh: &TriangleMesh, points: &[Vector3]) -> TriangleMesh {
    let heights = parallel::map(mesh.n_faces(), |face| least_height(triangle(points, mesh.faces()[face])));
    mesh.reshaped(parallel::map(points.len(), |vertex| {
        let around = mesh.vertex_corners(Vertex::new(vertex)).iter();
        let least = around.map(|corner| heights[corner.face()]).fold(f64::INFINITY, f64::min);
        let cell = nearest_power_of_two(CELL * least);
        points[vertex].map(|x| nearest_multiple(x, cell))
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::alignment::rotation::rotation_of;
    use crate::location::tests::{octasphere, rings};
    use crate::mesh::geometry::{area, area_vector};

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
        StartSurface::rounded(mesh, &[]).mesh.into_owned()
    }

    fn bits(points: &[Vector3]) -> Vec<[u64; 3]> {
        points.iter().map(|point| point.0.map(f64::to_bits)).collect()
    }

    #[test]
    fn noise_is_forgotten_on_the_grid() {
        for mesh in samples() {
            let noisy = sample(&with_noise(mesh.points()), mesh.faces());
            assert!(noisy.points() != mesh.points() && noisy.face_areas() != mesh.face_areas());
            let [noisy, mesh] = [on_grid(&noisy), on_grid(&mesh)];
            assert!(bits(noisy.points()) == bits(mesh.points()) && noisy.face_areas() == mesh.face_areas());
        }
    }

    #[test]
    fn the_grid_moves_grows_and_turns_with_the_surface() {
        // a ball has no directions but those of its landmarks
        let (points, faces) = octasphere(3);
        let ball = sample(&points, &faces);
        assert_eq!(OwnFrame::of(ball.points()).n_clear, 0);
        for mesh in samples().into_iter().chain([ball]) {
            let turn = rotation_of([0.8, 0.36, -0.48, 0.0]);
            let moved: Vec<Vector3> =
                mesh.points().iter().map(|&x| rotate(turn, x) * 3.0 + Vector3([5.0, -1.0, 2.0])).collect();
            let moved = sample(&moved, mesh.faces());
            let [ours, theirs] = [&mesh, &moved].map(|mesh| StartSurface::rounded(mesh, &[3, 7, 11]));
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
    fn a_surface_whose_faces_would_lose_their_areas_stays_as_it_is() {
        // rings that shrink tenfold about a point far from the mean of the vertices
        let (n_rings, n) = (24, 8);
        let ring = |k: usize| {
            let radius = 10f64.powi(-(k as i32));
            (0..n).map(f64::from).map(move |i| {
                let (sine, cosine) = (std::f64::consts::TAU * i / f64::from(n)).sin_cos();
                [radius * cosine, radius * sine, if k == 0 { sine } else { 0.0 }]
            })
        };
        let vertices: Vec<[f64; 3]> = (0..n_rings).flat_map(ring).collect();
        let n = n as u32;
        let quad = |k: u32, i: u32| {
            let [a, b] = [n * k + i, n * k + (i + 1) % n];
            [[a, b, b + n], [a, b + n, a + n]]
        };
        let faces: Vec<[u32; 3]> =
            (0..n_rings as u32 - 1).flat_map(|k| (0..n).flat_map(move |i| quad(k, i))).collect();
        let mesh = TriangleMesh::new(&vertices, &faces).unwrap();
        let start = StartSurface::rounded(&mesh, &[]);
        assert!(start.mesh.face_areas().iter().all(|&area| area > 0.0));
        assert!(start.mesh.points().iter().flat_map(|point| point.0).all(f64::is_finite));
    }

    #[test]
    fn where_the_start_is_the_result_nothing_moves() {
        let meshes = samples();
        let landmarks = Landmarks { source: &[3, 7, 11], target: &[3, 7, 11] };
        let starts = StartSurface::of_both(meshes.each_ref(), &landmarks, Energy::Area);
        for (start, mesh) in starts.iter().zip(&meshes) {
            assert!(start.mesh.points() == mesh.points() && start.mesh.face_areas() == mesh.face_areas());
            assert!(start.turned(Vector3([1.0, 2.0, 3.0])) == Vector3([1.0, 2.0, 3.0]));
        }
        let rounded = StartSurface::of_both(meshes.each_ref(), &landmarks, Energy::Surface);
        assert!(rounded.iter().zip(&meshes).all(|(start, mesh)| start.mesh.points() != mesh.points()));
    }
}
