// SPDX-License-Identifier: MIT OR Apache-2.0
//! Small surfaces and maps between them for the tests.

use super::density::FaceEnergy;
use super::problem::{Start, SurfaceProblem};
use super::target::{Placed, Target};
use crate::codomain::CanonicalDomain;
use crate::location::tests::{Map, number, octasphere, rings};
use crate::location::{Location, Locator};
use crate::mesh::{Corner, TriangleMesh, Vertex};
use crate::registration::features::Signals;
use crate::vector::Vector3;

/// Two surfaces with a map of the first into the domain of the second.
pub(super) struct Sample {
    pub source: TriangleMesh,
    pub target: TriangleMesh,
    pub domain: CanonicalDomain,
    pub target_in_domain: Vec<Vector3>,
    /// The places of the source's vertices on the target.
    pub start: Vec<Location>,
}

impl Sample {
    /// An ellipsoid and a bumpy ball. The map crowds the ellipsoid to one side of the ball.
    pub(super) fn spheres() -> Self {
        let (points, faces) = octasphere(2);
        // central projections from within the polyhedron fold no face
        let shifted = |shift: [f64; 3]| -> Vec<Vector3> {
            points.iter().map(|&x| (x + Vector3(shift)).normalized()).collect()
        };
        let target_in_domain = shifted([0.06, -0.1, 0.08]);
        let locator = Locator::new(&target_in_domain, &faces);
        let start = shifted([0.42, 0.5, 0.54]).into_iter().map(|x| locator.locate(x)).collect();
        let ellipsoid = points.iter().map(|&x| Vector3([x[0], 0.8 * x[1], 0.6 * x[2]]));
        let source = mesh(ellipsoid, &faces);
        let target = mesh(points.iter().map(|&x| bumpy(x)), &faces);
        Self { source, target, domain: CanonicalDomain::Sphere, target_in_domain, start }
    }

    /// Two domes. The map shears the disk around its center; its boundary turns by a part of an edge.
    pub(super) fn disks() -> Self {
        let dome = |(points, faces): &Map, height: f64| {
            mesh(points.iter().map(|&x| Vector3([x[0], x[1], height * (2.0 * x[0] + x[1] * x[1])])), faces)
        };
        let (from, to) = (rings(5), rings(4));
        let (source, target) = (dome(&from, 0.2), dome(&to, -0.5));
        let start = Vertex::all(source.n_vertices())
            .map(|vertex| {
                let Vector3([u, v, _]) = from.0[vertex];
                let (sine, cosine) = (0.1 + 0.4 * (1.0 - u * u - v * v)).sin_cos();
                let turned = Vector3([cosine * u - sine * v, sine * u + cosine * v, 1.0]);
                if source.is_boundary(vertex) {
                    on_boundary(&target, &to.0, turned)
                } else {
                    Locator::new(&to.0, &to.1).locate(turned)
                }
            })
            .collect();
        Self { source, target, domain: CanonicalDomain::Disk, target_in_domain: to.0, start }
    }

    /// An ellipsoid of few faces and a fine bumpy ball.
    pub(super) fn coarse_sphere() -> Self {
        let (points, faces) = octasphere(1);
        let (fine, target_faces) = octasphere(4);
        let target_in_domain: Vec<Vector3> =
            fine.iter().map(|&x| (x + Vector3([0.06, -0.1, 0.08])).normalized()).collect();
        let locator = Locator::new(&target_in_domain, &target_faces);
        let start = points.iter().map(|&x| (x + Vector3([0.21, 0.24, 0.27])).normalized());
        let start = start.map(|x| locator.locate(x)).collect();
        let source = mesh(points.iter().map(|&x| Vector3([x[0], 0.8 * x[1], 0.6 * x[2]])), &faces);
        let target = mesh(fine.iter().map(|&x| bumpy(x)), &target_faces);
        Self { source, target, domain: CanonicalDomain::Sphere, target_in_domain, start }
    }

    /// A flat disk of few rings within a fine dome, turned, sheared and shifted.
    pub(super) fn coarse_disk() -> Self {
        let ((from, faces), (to, target_faces)) = (rings(2), rings(12));
        let source = mesh(from.iter().map(|&x| Vector3([x[0], x[1], 0.0])), &faces);
        let dome = |x: Vector3| Vector3([x[0], x[1], 0.3 * (2.0 * x[0] + x[1] * x[1])]);
        let target = mesh(to.iter().map(|&x| dome(x)), &target_faces);
        let sheared = |Vector3([u, v, _]): Vector3| {
            Vector3([0.91 * u - 0.09 * v + 0.021, 0.1 * u + 0.87 * v - 0.013, 1.0])
        };
        let locator = Locator::new(&to, &target_faces);
        let start = from.iter().map(|&x| locator.locate(sheared(x))).collect();
        Self { source, target, domain: CanonicalDomain::Disk, target_in_domain: to, start }
    }

    /// The bumpy ball, turned about a diagonal, onto itself.
    pub(super) fn turned_ball() -> Self {
        let (points, faces) = octasphere(2);
        let target = mesh(points.iter().map(|&x| bumpy(x)), &faces);
        let source = mesh(points.iter().map(|&x| turned(bumpy(x))), &faces);
        let start = Vertex::all(points.len()).map(|vertex| at_vertex(&target, vertex)).collect();
        Self { source, target, domain: CanonicalDomain::Sphere, target_in_domain: points, start }
    }

    /// The start, placed on the target.
    pub(super) fn placed_on(&self, target: &Target<'_>) -> Vec<Placed> {
        self.start.iter().map(|&location| target.placed(location)).collect()
    }

    /// The places of the start, moved by noise where they lie within a face.
    pub(super) fn start_with_noise(&self, noise: f64) -> Vec<Location> {
        let moved = |(k, location): (usize, &Location)| {
            let [a, b, c] = location.barycentric;
            let change = if location.barycentric.contains(&0.0) { 0.0 } else { noise * number(k) };
            Location { barycentric: [a + change, b - change, c], ..*location }
        };
        self.start.iter().enumerate().map(moved).collect()
    }

    /// The symmetric Dirichlet energy without landmarks and signals.
    pub(super) fn problem(&self) -> SurfaceProblem<'_> {
        SurfaceProblem {
            source: &self.source,
            target: &self.target,
            target_points: self.target.points(),
            domain: self.domain,
            target_in_domain: &self.target_in_domain,
            held: vec![false; self.source.n_vertices()],
            pulls: Vec::new(),
            signals: Signals::default(),
            start: Start::Domain,
            is_coarse: false,
            face_energy: FaceEnergy { area_weight: 1.0, angle_weight: 1.0, both_ways: false },
        }
    }
}

/// The flat disk of `n` rings.
pub(super) fn flat_disk(n: u32) -> (TriangleMesh, Vec<Vector3>) {
    let (points, faces) = rings(n);
    (mesh(points.iter().copied(), &faces), points)
}

/// A vertex as a place in one of its faces.
pub(super) fn at_vertex(mesh: &TriangleMesh, vertex: Vertex) -> Location {
    Location::at_corner(mesh.vertex_corners(vertex)[0])
}

pub(super) fn mesh(points: impl Iterator<Item = Vector3>, faces: &[[Vertex; 3]]) -> TriangleMesh {
    TriangleMesh::new(&points.map(|x| x.0).collect::<Vec<_>>(), faces).expect("a valid mesh")
}

fn bumpy(x: Vector3) -> Vector3 {
    x * (1.0 + 0.25 * (3.0 * x[0] + 1.0).sin() * (2.0 * x[1]).cos())
}

fn turned(Vector3([x, y, z]): Vector3) -> Vector3 {
    Vector3([y, z, x])
}

/// The place of the boundary in the direction of a point of the disk.
fn on_boundary(mesh: &TriangleMesh, in_domain: &[Vector3], point: Vector3) -> Location {
    let cross = |a: Vector3, b: Vector3| a[0] * b[1] - a[1] * b[0];
    Corner::all(mesh.n_faces())
        .filter(|&corner| mesh.opposite(corner).is_none())
        .find_map(|corner| {
            let [from, to] = corner.half_edge(mesh.faces()).map(|vertex| in_domain[vertex]);
            let (before, after) = (cross(from, point), cross(point, to));
            let is_ahead = before >= 0.0 && after > 0.0;
            is_ahead.then(|| Location::on_edge(corner, before / (before + after)))
        })
        .expect("the boundary surrounds the disk")
}
