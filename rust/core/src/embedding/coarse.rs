// SPDX-License-Identifier: MIT OR Apache-2.0
//! A coarse mesh of some of a surface's vertices, and maps of it taken back to the whole surface.
//!
//! The surface is decimated. Once the coarse mesh has a map, the vertices come back one by one, each into the polygon of
//! its neighbors, to where the images of its faces are most similar to the faces ([`ConformalStar`]). Now and then all
//! vertices are moved to that end, but those that are kept. So between the coarse vertices the map is smooth, and angles
//! are those of the surface.
//!
//! Cost: O(n log n), some ten one-vertex Newton steps for each vertex, on one thread.

use super::conformal_star::ConformalStar;
use super::decimation::{Collapse, Decimation};
use super::kernel::kernel_centroid;
use crate::codomain::CanonicalDomain;
use crate::control::Observer;
use crate::mesh::{TriangleMesh, Vertex};
use crate::vector::Vector3;

/// Newton steps of a vertex that comes back.
const STEPS: usize = 2;

/// A coarse mesh of a surface.
pub(crate) struct Coarse<'a> {
    decimation: Decimation<'a>,
    surface: &'a TriangleMesh,
    /// The coarse mesh.
    pub mesh: TriangleMesh,
    /// The vertices of the surface that it has, in its order.
    pub vertices: Vec<Vertex>,
    /// Which vertices of the surface keep their places.
    stays: Vec<bool>,
}

/// Why there is no coarse mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum NotCoarse {
    /// The observer ended the run.
    Cancelled,
    /// What is left is no surface with faces of positive area.
    Degenerate,
}

impl<'a> Coarse<'a> {
    /// A mesh of about `n_vertices` vertices, among them all that are kept and those of the boundary.
    pub(crate) fn new(
        surface: &'a TriangleMesh,
        n_vertices: usize,
        is_kept: impl Fn(Vertex) -> bool,
        observer: &mut dyn Observer,
    ) -> Result<Self, NotCoarse> {
        let mut decimation = Decimation::new(surface, surface.face_areas().to_vec());
        let all = Vertex::all(surface.n_vertices());
        let stays: Vec<bool> =
            all.clone().map(|vertex| is_kept(vertex) || surface.is_boundary(vertex)).collect();
        // the apex of a disk counts
        let n_left = n_vertices + surface.boundary_loops().len();
        decimation.coarsen_to(n_left, |vertex| stays[vertex], observer).ok_or(NotCoarse::Cancelled)?;
        let vertices: Vec<Vertex> = all.filter(|&vertex| !decimation.is_gone(vertex)).collect();
        let mut number = vec![Vertex::default(); surface.n_vertices()];
        vertices.iter().zip(Vertex::all(vertices.len())).for_each(|(&vertex, new)| number[vertex] = new);
        let faces = decimation.faces().map(|face| face.map(|vertex| number[vertex])).collect();
        let points = vertices.iter().map(|&vertex| surface.points()[vertex]).collect();
        let mesh = TriangleMesh::at_given_points(points, faces).map_err(|_| NotCoarse::Degenerate)?;
        Ok(Self { decimation, surface, mesh, vertices, stays })
    }

    /// A map of the coarse mesh without folds, taken to the whole surface without folds; `None` where double precision
    /// does not suffice. All vertices but those that are kept are evened out by `sweeps` whenever their number has doubled,
    /// and at last.
    pub(crate) fn refined(
        &self,
        map: &[Vector3],
        domain: CanonicalDomain,
        sweeps: usize,
    ) -> Option<Vec<Vector3>> {
        let surface = self.surface;
        let mut places = vec![Vector3::ZERO; surface.n_vertices()];
        self.vertices.iter().zip(map).for_each(|(&vertex, &place)| places[vertex] = place);
        let mut refining = Refining {
            surface,
            domain,
            decimation: self.decimation.clone(),
            places,
            star: ConformalStar::default(),
            room: Default::default(),
        };
        let mut moves: Vec<Vertex> =
            self.vertices.iter().copied().filter(|&vertex| !self.stays[vertex]).collect();
        let mut next_sweep = 2 * self.vertices.len();
        while let Some(collapse) = refining.decimation.refine() {
            refining.insert(collapse)?;
            moves.push(collapse.vertex);
            if moves.len() >= next_sweep {
                next_sweep *= 2;
                (0..sweeps).for_each(|_| refining.sweep(&moves));
            }
        }
        (0..sweeps).for_each(|_| refining.sweep(&moves));
        Some(refining.places)
    }
}

/// A map that gets its vertices back.
struct Refining<'a> {
    surface: &'a TriangleMesh,
    domain: CanonicalDomain,
    decimation: Decimation<'a>,
    places: Vec<Vector3>,
    star: ConformalStar,
    room: [Vec<[f64; 2]>; 2],
}

impl Refining<'_> {
    /// Places a vertex that comes back, and evens out the shapes around it.
    fn insert(&mut self, collapse: Collapse) -> Option<()> {
        let Collapse { vertex, onto } = collapse;
        let motion = self.domain.motion(false);
        self.fill_star(vertex);
        // 1. Into the kernel, from its centroid toward the vertex that had taken this one in
        let center = self.places[onto];
        let frame = motion.frame(center);
        let centroid = kernel_centroid(center, frame.axes, self.star.edges(), &mut self.room);
        let mut tries = (0..12).map(|k| motion.moved(center, &frame, centroid.map(|x| 0.1f64.powi(k) * x)));
        self.places[vertex] = tries.find(|&place| self.star.energy(place).is_some())?;
        // 2. To where the shapes are best
        for _ in 0..STEPS {
            let Some(better) = self.star.improved(self.places[vertex], motion) else { break };
            self.places[vertex] = better;
        }
        Some(())
    }

    /// One Newton step of each vertex that may move.
    fn sweep(&mut self, moves: &[Vertex]) {
        let motion = self.domain.motion(false);
        for &vertex in moves {
            self.fill_star(vertex);
            if let Some(better) = self.star.improved(self.places[vertex], motion) {
                self.places[vertex] = better;
            }
        }
    }

    fn fill_star(&mut self, vertex: Vertex) {
        self.star.clear();
        let points = self.surface.points();
        for (p, q, _) in self.decimation.star(vertex) {
            self.star.push([p, q].map(|v| self.places[v]), [vertex, p, q].map(|v| points[v]));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::Silent;
    use crate::location::tests::{octasphere, rings};

    fn determinant(map: &[Vector3], face: [Vertex; 3]) -> f64 {
        let [a, b, c] = face.map(|vertex| map[vertex]);
        a.dot(b.cross(c))
    }

    /// A potato of 258 vertices.
    fn potato() -> (TriangleMesh, Vec<Vector3>) {
        let (ball, faces) = octasphere(3);
        let points = ball.iter().map(|&x| x * (1.0 + 0.4 * (3.0 * x[0] + x[1]).sin())).collect();
        (TriangleMesh::at_given_points(points, faces).unwrap(), ball)
    }

    #[test]
    fn a_coarse_mesh_has_the_vertices_that_are_kept() {
        let (surface, _) = potato();
        let kept = [0, 17, 101].map(Vertex::new);
        let coarse = Coarse::new(&surface, 60, |vertex| kept.contains(&vertex), &mut Silent).unwrap();
        assert_eq!(coarse.mesh.n_vertices(), 60);
        assert!(coarse.mesh.require_sphere().is_ok());
        assert!(kept.iter().all(|vertex| coarse.vertices.contains(vertex)));
        for (&vertex, &point) in coarse.vertices.iter().zip(coarse.mesh.points()) {
            assert_eq!(surface.points()[vertex], point);
        }
    }

    #[test]
    fn a_map_of_a_sphere_gets_its_vertices_back_without_folds_where_they_belong() {
        let (surface, ball) = potato();
        let kept = [0, 17, 101].map(Vertex::new);
        let coarse = Coarse::new(&surface, 60, |vertex| kept.contains(&vertex), &mut Silent).unwrap();
        let map: Vec<Vector3> = coarse.vertices.iter().map(|&vertex| ball[vertex]).collect();
        assert!(coarse.mesh.faces().iter().all(|&face| determinant(&map, face) > 0.0));
        let refined = coarse.refined(&map, CanonicalDomain::Sphere, 4).unwrap();
        assert!(surface.faces().iter().all(|&face| determinant(&refined, face) > 0.0));
        assert!(kept.iter().all(|&vertex| refined[vertex] == ball[vertex]));
        // an edge of the ball is about .25 long
        let away: f64 = Vertex::all(ball.len()).map(|v| refined[v].distance(ball[v])).sum();
        assert!(away / (ball.len() as f64) < 0.1, "{}", away / ball.len() as f64);
        assert!(refined.iter().all(|x| (x.norm() - 1.0).abs() < 1e-12));
    }

    #[test]
    fn the_boundary_of_a_disk_keeps_its_places() {
        let (flat, faces) = rings(8);
        let surface = TriangleMesh::at_given_points(flat.clone(), faces).unwrap();
        let n_boundary = surface.boundary_loops()[0].len();
        let coarse = Coarse::new(&surface, n_boundary + 20, |_| false, &mut Silent).unwrap();
        assert_eq!(coarse.mesh.n_vertices(), n_boundary + 20);
        assert!(coarse.mesh.require_disk().is_ok());
        // a map that is affine is the most similar one to a surface that is stretched like it
        let map: Vec<Vector3> = coarse.mesh.points().to_vec();
        let refined = coarse.refined(&map, CanonicalDomain::Disk, 4).unwrap();
        for vertex in Vertex::all(flat.len()) {
            if surface.is_boundary(vertex) {
                assert_eq!(refined[vertex], flat[vertex]);
            }
            assert_eq!(refined[vertex][2], 1.0);
            assert!(refined[vertex].distance(flat[vertex]) < 0.02, "{vertex}");
        }
        assert!(surface.faces().iter().all(|&face| determinant(&refined, face) > 0.0));
    }

    #[test]
    fn an_observer_ends_the_decimation() {
        let (surface, _) = potato();
        let ended = Coarse::new(&surface, 60, |_| false, &mut |_: f64, _: &str| false);
        assert_eq!(ended.err(), Some(NotCoarse::Cancelled));
    }
}
