// SPDX-License-Identifier: MIT OR Apache-2.0
//! Straightest geodesics (K. Polthier and M. Schmies, Straightest geodesics on polyhedral surfaces, 1998): a place
//! walks straight on over the edges of the target, which are unfolded into the plane of the face it comes from.
//!
//! Cost: a few operations for each edge that is crossed.

use super::target::{Target, boundary_edge};
use crate::location::Location;
use crate::mesh::{Corner, Face};
use crate::vector::Vector3;

/// Most edges that a walk crosses.
const MOST_EDGES: usize = 10_000;

impl Target<'_> {
    /// The place reached by a walk along a vector in the plane of the face it starts in; the boundary ends it.
    pub(super) fn walked(&self, start: Location, along: Vector3) -> Location {
        self.walked_until(start, along, None)
    }

    /// The same, where the walk stops on the edge of the face `until`.
    pub(super) fn walked_until(&self, start: Location, along: Vector3, until: Option<Face>) -> Location {
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
            if until == Some(across.face()) {
                break;
            }
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
    pub(super) fn seen_from(&self, place: &Location, corner: Corner, across: Corner) -> Location {
        let mut barycentric = [0.0; 3];
        // the faces run along their common edge in opposite directions
        let (k, l) = (corner.place(), across.place());
        barycentric[(l + 1) % 3] = place.barycentric[(k + 2) % 3];
        barycentric[(l + 2) % 3] = place.barycentric[(k + 1) % 3];
        Location { triangle: across.face(), barycentric }
    }

    /// The place reached by a walk along the edge opposite to a corner, which ends at its ends.
    pub(super) fn walked_along_edge(&self, start: Location, edge: Corner, distance: f64) -> Location {
        let [from, to] = edge.half_edge(self.faces()).map(|vertex| self.points[vertex]);
        let t = self.parameter(edge, &start) + distance / from.distance(to);
        Location::on_edge(edge, t.clamp(0.0, 1.0))
    }

    /// The unit vectors along the edge opposite to a corner, and from it into the face.
    pub(super) fn edge_frame(&self, edge: Corner) -> [Vector3; 2] {
        let [from, to] = edge.half_edge(self.faces()).map(|vertex| self.points[vertex]);
        let along = (to - from).normalized();
        let apex = self.points[edge.vertex(self.faces())] - from;
        [along, (apex - along * apex.dot(along)).normalized()]
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

    /// The share of an edge that lies before a place on it.
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

#[cfg(test)]
mod tests {
    use super::super::sample_maps::{at_vertex, flat_disk, mesh};
    use super::*;
    use crate::codomain::CanonicalDomain;
    use crate::location::tests::number;
    use crate::mesh::{Face, TriangleMesh, Vertex, faces_of_indices};

    /// A cube of two triangles a side, with its vertices on the unit sphere.
    fn cube() -> (TriangleMesh, Vec<Vector3>) {
        let sides = [[4, 5, 7, 6], [0, 2, 3, 1], [1, 3, 7, 5], [0, 4, 6, 2], [2, 6, 7, 3], [0, 1, 5, 4]];
        let faces: Vec<[u32; 3]> =
            sides.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        let points: Vec<Vector3> = (0..8u32)
            .map(|i| Vector3::from_fn(|axis| if i >> axis & 1 == 1 { 1.0 } else { -1.0 }).normalized())
            .collect();
        (mesh(points.iter().copied(), &faces_of_indices(&faces)), points)
    }

    /// Side of a cube of area 1.
    fn side() -> f64 {
        (1.0f64 / 6.0).sqrt()
    }

    /// A place in the first triangle of the top of the cube, beside its center.
    const NEAR_TOP: Location = Location { triangle: Face(0), barycentric: [0.45, 0.1, 0.45] };

    fn random_places(mesh: &TriangleMesh, n: usize) -> impl Iterator<Item = Location> {
        let n_faces = mesh.n_faces();
        (0..n).map(move |i| {
            let weights = [0, 1, 2].map(|k| 1.1 + number(3 * i + k));
            let sum: f64 = weights.iter().sum();
            Location { triangle: Face::new(7 * i % n_faces), barycentric: weights.map(|w| w / sum) }
        })
    }

    #[test]
    fn walks_over_a_flat_surface_are_straight() {
        let (mesh, in_domain) = flat_disk(4);
        let target = Target::new(&mesh, &in_domain, CanonicalDomain::Disk);
        let vertices = Vertex::all(mesh.n_vertices()).map(|vertex| at_vertex(&mesh, vertex));
        let mut n_inside = 0;
        for (i, start) in random_places(&mesh, 300).chain(vertices).enumerate() {
            let along = Vector3([0.4 * number(1000 + 2 * i), 0.4 * number(1001 + 2 * i), 0.0]);
            let end = start.point_on(&target.points, mesh.faces()) + along;
            // the radius of a disk of area 1 is 0.56, and the polygon lies within it
            if end.norm() < 0.5 {
                let place = target.walked(start, along);
                assert!(place.point_on(&target.points, mesh.faces()).distance(end) < 1e-12, "{i}");
                assert!(place.barycentric.iter().all(|&x| x >= 0.0));
                n_inside += 1;
            }
        }
        assert!(n_inside > 100);
    }

    #[test]
    fn a_walk_stops_on_the_edge_of_a_face_that_it_must_not_enter() {
        let (mesh, in_domain) = cube();
        let target = Target::new(&mesh, &in_domain, CanonicalDomain::Sphere);
        let along = target.frame(NEAR_TOP.triangle)[0] * side();
        let end = target.walked(NEAR_TOP, along);
        assert!(end.triangle != NEAR_TOP.triangle);
        let stopped = target.walked_until(NEAR_TOP, along, Some(end.triangle));
        let edge = (0..3).find(|&k| stopped.barycentric[k] == 0.0).unwrap();
        let across = mesh.opposite(stopped.triangle.corner(edge)).unwrap();
        assert_eq!(across.face(), end.triangle);
        // the face that it starts in does not matter
        assert_eq!(target.walked_until(NEAR_TOP, along, Some(NEAR_TOP.triangle)), end);
    }

    #[test]
    fn a_walk_along_an_edge_ends_at_its_ends() {
        let (mesh, in_domain) = cube();
        let target = Target::new(&mesh, &in_domain, CanonicalDomain::Sphere);
        for corner in Corner::all(mesh.n_faces()) {
            let [from, to] = corner.half_edge(mesh.faces()).map(|vertex| target.points[vertex]);
            let start = Location::on_edge(corner, 0.25);
            let there = target.walked_along_edge(start, corner, 0.5 * from.distance(to));
            assert!(there.point_on(&target.points, mesh.faces()).distance(from * 0.25 + to * 0.75) < 1e-15);
            for (distance, end) in [(9.0, to), (-9.0, from)] {
                let there = target.walked_along_edge(start, corner, distance);
                assert_eq!(there.point_on(&target.points, mesh.faces()), end);
                assert_eq!(there.barycentric.iter().filter(|&&x| x == 0.0).count(), 2);
            }
            let [along, inward] = target.edge_frame(corner);
            assert!((along.dot(inward)).abs() < 1e-15 && along.distance((to - from).normalized()) < 1e-15);
            assert!(inward.dot(target.points[corner.vertex(mesh.faces())] - from) > 0.0);
        }
    }

    #[test]
    fn the_boundary_ends_a_walk_on_its_straight_way() {
        let (mesh, in_domain) = flat_disk(4);
        let target = Target::new(&mesh, &in_domain, CanonicalDomain::Disk);
        for (i, start) in random_places(&mesh, 50).enumerate() {
            let along = Vector3([(i as f64).cos(), (i as f64).sin(), 0.0]) * 3.0;
            let place = target.walked(start, along);
            let [from, to] = [start, place].map(|place| place.point_on(&target.points, mesh.faces()));
            assert!(boundary_edge(&mesh, &place).is_some());
            assert!((to - from).cross(along).norm() < 1e-12 && (to - from).dot(along) > 0.0);
        }
    }

    #[test]
    fn walks_over_a_cube_are_straight_on_its_unfolded_sides() {
        let (mesh, in_domain) = cube();
        let target = Target::new(&mesh, &in_domain, CanonicalDomain::Sphere);
        let (start, half) = (target.placed(NEAR_TOP).point, 0.5 * side());
        assert!((start[2] - half).abs() < 1e-12);
        // 1. Over an edge, down the next side: what is left of the way forward goes down, what is sideways stays
        let (forward, sideways) = (0.8 * side(), 0.05 * side());
        let place = target.walked(NEAR_TOP, Vector3([forward, sideways, 0.0]));
        let down = start[0] + forward - half;
        let expected = Vector3([half, start[1] + sideways, half - down]);
        assert!(target.placed(place).point.distance(expected) < 1e-12);
        // 2. There and back: the way has turned by a right angle with the side
        let back = target.walked(place, Vector3([0.0, -sideways, forward]));
        assert!(target.placed(back).point.distance(start) < 1e-12);
        // 3. Around all four sides
        let around = target.walked(NEAR_TOP, Vector3([4.0 * side(), sideways, 0.0]));
        let expected = start + Vector3([0.0, sideways, 0.0]);
        assert!(target.placed(around).point.distance(expected) < 1e-12);
    }

    #[test]
    fn walks_along_the_boundary_keep_their_length_around_its_corners() {
        // on the round boundary of the flat disk every edge is as long: k edges turn a place by k parts of the circle
        let (mesh, in_domain) = flat_disk(4);
        let target = Target::new(&mesh, &in_domain, CanonicalDomain::Disk);
        let corner = Corner::all(mesh.n_faces()).find(|&corner| mesh.opposite(corner).is_none()).unwrap();
        let start = Location::on_edge(corner, 0.3);
        let point = |place: Location| place.point_on(&target.points, mesh.faces());
        let [from, to] = corner.half_edge(mesh.faces()).map(|vertex| target.points[vertex]);
        let length = from.distance(to);
        for k in -50..=50 {
            let (sine, cosine) = (std::f64::consts::TAU * f64::from(k) / 24.0).sin_cos();
            let Vector3([x, y, z]) = point(start);
            let turned = Vector3([cosine * x - sine * y, sine * x + cosine * y, z]);
            let end = target.walked_along_boundary(start, f64::from(k) * length);
            assert!(point(end).distance(turned) < 1e-12, "{k}");
            let back = target.walked_along_boundary(end, -f64::from(k) * length);
            assert!(point(back).distance(point(start)) < 1e-12, "{k}");
        }
        let part = target.walked_along_boundary(start, 0.4 * length);
        assert!(point(part).distance(point(Location::on_edge(corner, 0.7))) < 1e-12);
    }

    #[test]
    fn a_walk_along_the_boundary_starts_at_its_vertices_too() {
        let (mesh, in_domain) = flat_disk(3);
        let target = Target::new(&mesh, &in_domain, CanonicalDomain::Disk);
        for vertex in Vertex::all(mesh.n_vertices()).filter(|&vertex| mesh.is_boundary(vertex)) {
            for corner in mesh.vertex_corners(vertex) {
                let mut start = Location { triangle: corner.face(), barycentric: [0.0; 3] };
                start.barycentric[corner.place()] = 1.0;
                for distance in [-0.1, 0.1] {
                    let end = target.walked_along_boundary(start, distance);
                    let way = end.point_on(&target.points, mesh.faces()) - target.points[vertex];
                    // an edge is longer than the walk
                    assert!((way.norm() - 0.1).abs() < 1e-12);
                    assert!(target.points[vertex].cross(way)[2] * distance > 0.0, "the surface on the left");
                }
            }
        }
    }
}
