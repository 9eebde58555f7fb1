// SPDX-License-Identifier: MIT OR Apache-2.0
//! The surface that is mapped onto: places on it in space and in the domain, and its metric there.
//!
//! A place is a face with barycentric coordinates. In space and in the domain the surface is linear on each face; on
//! the sphere the domain is its central projection. The metric in the domain, by which lengths on the surface are
//! measured there, is constant on each face, hence the mean of the faces around a vertex is interpolated, so that it
//! changes without jumps.

use super::density::Jacobian;
use crate::codomain::CanonicalDomain;
use crate::location::Location;
use crate::mesh::geometry::{area_vector, triangle};
use crate::mesh::{Corner, Face, TriangleMesh, Vertex};
use crate::parallel;
use crate::vector::Vector3;

/// A symmetric matrix, (xx, xy, xz, yy, yz, zz).
pub(super) type Metric = [f64; 6];

/// Least pivot of a metric, relative to its trace.
const LEAST_PIVOT: f64 = 1e-12;

/// The surface that is mapped onto.
pub(super) struct Target<'a> {
    mesh: &'a TriangleMesh,
    domain: CanonicalDomain,
    /// The vertices in space, scaled to a total area of 1.
    pub points: Vec<Vector3>,
    /// The vertices in the domain.
    in_domain: &'a [Vector3],
    /// The unit normal of each face.
    normals: Vec<Vector3>,
    /// The metric in the domain at each vertex.
    metrics: Vec<Metric>,
}

/// A vertex of the source on the target.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Placed {
    pub location: Location,
    /// The place in space.
    pub point: Vector3,
    /// The place in the domain.
    pub in_domain: Vector3,
}

impl<'a> Target<'a> {
    pub(super) fn new(mesh: &'a TriangleMesh, in_domain: &'a [Vector3], domain: CanonicalDomain) -> Self {
        let points = of_unit_area(mesh);
        let normal = |face: usize| area_vector(triangle(&points, mesh.faces()[face])).normalized();
        let normals = parallel::map(mesh.n_faces(), normal);
        let metrics = metrics(mesh, &points, in_domain);
        Self { mesh, domain, points, in_domain, normals, metrics }
    }

    pub(super) fn faces(&self) -> &'a [[Vertex; 3]] {
        self.mesh.faces()
    }

    /// The vertices in the domain.
    pub(super) fn in_domain(&self) -> &'a [Vector3] {
        self.in_domain
    }

    /// The corners of a face in the domain.
    pub(super) fn corners_in_domain(&self, face: Face) -> [Vector3; 3] {
        triangle(self.in_domain, self.faces()[face])
    }

    pub(super) fn mesh(&self) -> &TriangleMesh {
        self.mesh
    }

    /// The corners of a face in space.
    pub(super) fn corners(&self, face: Face) -> [Vector3; 3] {
        triangle(&self.points, self.faces()[face])
    }

    /// A place with its points.
    pub(super) fn placed(&self, location: Location) -> Placed {
        let in_domain = self.onto_domain(location.point_on(self.in_domain, self.faces()));
        Placed { location, point: location.point(self.corners(location.triangle)), in_domain }
    }

    /// A point of the flat faces in the domain, projected onto it.
    pub(super) fn onto_domain(&self, flat: Vector3) -> Vector3 {
        match self.domain {
            CanonicalDomain::Sphere => flat.normalized(),
            CanonicalDomain::Disk => flat,
        }
    }

    /// Two orthogonal unit vectors in the plane of a face, the first along its first edge.
    pub(super) fn frame(&self, face: Face) -> [Vector3; 2] {
        let [a, b, _] = self.corners(face);
        let first = (b - a).normalized();
        [first, self.normals[face].cross(first)]
    }

    /// The change of the barycentric coordinates in a face along a vector in its plane.
    pub(super) fn coordinates(&self, face: Face, along: Vector3) -> [f64; 3] {
        let [a, b, c] = self.corners(face);
        let (p, q) = (b - a, c - a);
        let (pp, pq, qq) = (p.dot(p), p.dot(q), q.dot(q));
        let (x, y) = (p.dot(along), q.dot(along));
        let determinant = pp * qq - pq * pq;
        let (second, third) = ((qq * x - pq * y) / determinant, (pp * y - pq * x) / determinant);
        [-second - third, second, third]
    }

    /// The velocity in the domain of a place that moves with this change of its coordinates.
    pub(super) fn pushed(&self, placed: &Placed, change: [f64; 3]) -> Vector3 {
        let corners = triangle(self.in_domain, self.faces()[placed.location.triangle]);
        let velocity = (0..3).map(|k| corners[k] * change[k]).sum::<Vector3>();
        match self.domain {
            CanonicalDomain::Disk => velocity,
            CanonicalDomain::Sphere => {
                let flat = placed.location.point(corners);
                (velocity - placed.in_domain * placed.in_domain.dot(velocity)) * (1.0 / flat.norm())
            }
        }
    }

    /// The metrics at the corners of the face of a place.
    pub(super) fn corner_metrics(&self, location: &Location) -> [&Metric; 3] {
        self.faces()[location.triangle].map(|vertex| &self.metrics[vertex])
    }

    /// The mean of the metrics at three places.
    pub(super) fn mean_metric(&self, places: [&Placed; 3]) -> Metric {
        let mut mean = [0.0; 6];
        for placed in places {
            let location = &placed.location;
            for (metric, share) in self.corner_metrics(location).into_iter().zip(location.barycentric) {
                mean.iter_mut().zip(metric).for_each(|(sum, entry)| *sum += share / 3.0 * entry);
            }
        }
        mean
    }
}

/// The points of a mesh, scaled to a total area of 1.
pub(super) fn of_unit_area(mesh: &TriangleMesh) -> Vec<Vector3> {
    let area: f64 = mesh.face_areas().iter().sum();
    let scale = 1.0 / area.sqrt();
    parallel::map(mesh.n_vertices(), |vertex| mesh.points()[vertex] * scale)
}

/// xᵀ M y.
pub(super) fn product(metric: &Metric, x: Vector3, y: Vector3) -> f64 {
    let [xx, xy, xz, yy, yz, zz] = *metric;
    x.dot(Vector3([
        xx * y[0] + xy * y[1] + xz * y[2],
        xy * y[0] + yy * y[1] + yz * y[2],
        xz * y[0] + yz * y[1] + zz * y[2],
    ]))
}

/// The upper triangular root R of a metric M = RᵀR, by rows.
pub(super) struct Root([[f64; 3]; 3]);

impl Root {
    pub(super) fn new(&[xx, xy, xz, yy, yz, zz]: &Metric) -> Self {
        let least = LEAST_PIVOT * (xx + yy + zz);
        let pivot = |square: f64| square.max(least).sqrt();
        let a = pivot(xx);
        let (b, c) = (xy / a, xz / a);
        let d = pivot(yy - b * b);
        let e = (yz - b * c) / d;
        Self([[a, b, c], [0.0, d, e], [0.0, 0.0, pivot(zz - c * c - e * e)]])
    }

    /// R x, whose length is that of x by the metric.
    pub(super) fn apply(&self, x: Vector3) -> Vector3 {
        let [[a, b, c], [_, d, e], [_, _, f]] = self.0;
        Vector3([a * x[0] + b * x[1] + c * x[2], d * x[1] + e * x[2], f * x[2]])
    }

    pub(super) fn jacobian(&self, jacobian: &Jacobian) -> Jacobian {
        jacobian.map(|column| self.apply(column))
    }
}

/// The metric at each vertex: the mean of those of its faces, weighted by area.
fn metrics(mesh: &TriangleMesh, points: &[Vector3], in_domain: &[Vector3]) -> Vec<Metric> {
    let of_face = parallel::map(mesh.n_faces(), |face| {
        face_metric(triangle(points, mesh.faces()[face]), triangle(in_domain, mesh.faces()[face]))
    });
    parallel::map(mesh.n_vertices(), |vertex| {
        let (mut sum, mut total) = ([0.0; 6], 0.0);
        for corner in mesh.vertex_corners(Vertex::new(vertex)) {
            let area = mesh.face_areas()[corner.face()];
            total += area;
            sum.iter_mut().zip(of_face[corner.face()]).for_each(|(sum, entry)| *sum += area * entry);
        }
        sum.map(|entry| entry / total)
    })
}

/// The metric of a face, given its corners in space and in the domain; 0 across its plane in the domain.
fn face_metric([a, b, c]: [Vector3; 3], [u, v, w]: [Vector3; 3]) -> Metric {
    let (p, q) = (b - a, c - a);
    let (r, s) = (v - u, w - u);
    let normal = r.cross(s);
    let square = normal.dot(normal);
    if square == 0.0 {
        return [0.0; 6];
    }
    // the linear map takes r to p and s to q; x · (its dual) is the part of x along r, or s
    let (to_p, to_q) = (s.cross(normal) * (1.0 / square), normal.cross(r) * (1.0 / square));
    let (pp, pq, qq) = (p.dot(p), p.dot(q), q.dot(q));
    let entry = |i: usize, j: usize| {
        pp * to_p[i] * to_p[j] + pq * (to_p[i] * to_q[j] + to_q[i] * to_p[j]) + qq * to_q[i] * to_q[j]
    };
    [entry(0, 0), entry(0, 1), entry(0, 2), entry(1, 1), entry(1, 2), entry(2, 2)]
}

/// The edge of the boundary on which a place lies, as the corner opposite to it.
pub(super) fn boundary_edge(mesh: &TriangleMesh, location: &Location) -> Option<Corner> {
    let is_boundary = |corner: &Corner| mesh.opposite(*corner).is_none();
    let lies_on = |corner: &Corner| location.barycentric[corner.place()] == 0.0;
    let corners = location.triangle.corners();
    if let Some(corner) = corners.into_iter().find(|corner| is_boundary(corner) && lies_on(corner)) {
        return Some(corner);
    }
    // a vertex of the boundary in a face without an edge there
    let at = (0..3).find(|&k| location.barycentric[k] == 1.0)?;
    let vertex = mesh.faces()[location.triangle][at];
    let around = mesh.vertex_corners(vertex).iter().flat_map(|corner| corner.face().corners());
    around.into_iter().find(|corner| is_boundary(corner) && corner.half_edge(mesh.faces())[0] == vertex)
}

#[cfg(test)]
mod tests {
    use super::super::sample_maps::{Sample, at_vertex, flat_disk};
    use super::*;
    use crate::location::tests::number;

    fn random_place(mesh: &TriangleMesh, i: usize) -> Location {
        let weights = [0, 1, 2].map(|k| 1.1 + number(3 * i + k));
        let sum: f64 = weights.iter().sum();
        Location { triangle: Face::new(7 * i % mesh.n_faces()), barycentric: weights.map(|w| w / sum) }
    }

    #[test]
    fn the_metric_measures_lengths_of_the_surface_where_the_map_is_linear() {
        let (flat, in_domain) = flat_disk(4);
        // a disk drawn out and tilted in space
        let tilted = |&Vector3([x, y, _]): &Vector3| Vector3([1.5 * x + 0.3 * y, 0.7 * y, x - 0.4 * y]);
        let mesh = flat.at_points(in_domain.iter().map(tilted).collect());
        let mesh = TriangleMesh::at_given_points(mesh.points().to_vec(), mesh.faces().to_vec()).unwrap();
        let target = Target::new(&mesh, &in_domain, CanonicalDomain::Disk);
        for i in 0..50 {
            let places = [0, 1, 2].map(|k| target.placed(random_place(&mesh, 3 * i + k)));
            let metric = target.mean_metric([&places[0], &places[1], &places[2]]);
            for [a, b] in [[0, 1], [1, 2], [2, 0]] {
                let way = places[b].in_domain - places[a].in_domain;
                let length = places[a].point.distance(places[b].point);
                assert!((product(&metric, way, way).sqrt() - length).abs() < 1e-12);
                assert!((Root::new(&metric).apply(way).norm() - length).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn the_root_of_a_metric_has_its_products() {
        let metric = [2.0, 0.3, -0.4, 1.0, 0.2, 0.7];
        let root = Root::new(&metric);
        for i in 0..20 {
            let [x, y] = [0, 1].map(|k| Vector3::from_fn(|axis| number(6 * i + 3 * k + axis)));
            assert!((root.apply(x).dot(root.apply(y)) - product(&metric, x, y)).abs() < 1e-14);
        }
    }

    #[test]
    fn the_surface_has_an_area_of_one_and_its_frames_lie_in_its_faces() {
        let sample = Sample::spheres();
        let target = Target::new(&sample.target, &sample.target_in_domain, sample.domain);
        let mut area = 0.0;
        for face in Face::all(sample.target.n_faces()) {
            let [a, b, c] = target.corners(face);
            area += 0.5 * (b - a).cross(c - a).norm();
            let [x, y] = target.frame(face);
            for (value, expected) in [(x.dot(x), 1.0), (y.dot(y), 1.0), (x.dot(y), 0.0)] {
                assert!((value - expected).abs() < 1e-14);
            }
            assert!(x.cross(y).distance((b - a).cross(c - a).normalized()) < 1e-12);
        }
        assert!((area - 1.0).abs() < 1e-12);
    }

    #[test]
    fn velocities_in_space_and_in_the_domain_are_those_of_differences() {
        for sample in [Sample::spheres(), Sample::disks()] {
            let target = Target::new(&sample.target, &sample.target_in_domain, sample.domain);
            for i in 0..50 {
                let place = random_place(&sample.target, i);
                for axis in target.frame(place.triangle) {
                    let change = target.coordinates(place.triangle, axis);
                    let h = 1e-6;
                    let [before, after] = [-h, h].map(|h| {
                        let barycentric = std::array::from_fn(|k| place.barycentric[k] + h * change[k]);
                        target.placed(Location { barycentric, ..place })
                    });
                    let slope = |from: Vector3, to: Vector3| (to - from) * (0.5 / h);
                    assert!(slope(before.point, after.point).distance(axis) < 1e-8);
                    let pushed = target.pushed(&target.placed(place), change);
                    let difference = slope(before.in_domain, after.in_domain);
                    assert!(difference.distance(pushed) < 1e-8 * (1.0 + pushed.norm()));
                }
            }
        }
    }

    #[test]
    fn places_on_the_boundary_and_no_others_have_an_edge_there() {
        let (mesh, _) = flat_disk(3);
        for corner in Corner::all(mesh.n_faces()) {
            let edge = boundary_edge(&mesh, &Location::on_edge(corner, 0.4));
            assert_eq!(edge, mesh.opposite(corner).is_none().then_some(corner));
        }
        for i in 0..50 {
            assert_eq!(boundary_edge(&mesh, &random_place(&mesh, i)), None);
        }
        for vertex in Vertex::all(mesh.n_vertices()) {
            let edge = boundary_edge(&mesh, &at_vertex(&mesh, vertex));
            assert_eq!(edge.is_some(), mesh.is_boundary(vertex));
            assert!(edge.is_none_or(|edge| edge.half_edge(mesh.faces()).contains(&vertex)));
        }
    }
}
