// SPDX-License-Identifier: MIT OR Apache-2.0
//! Decimation by quadric error metrics (Garland & Heckbert 1997, *Surface simplification using quadric error metrics*)
//! with half-edge collapses: a vertex v moves onto a neighbor w, and the two faces between them vanish, so that the
//! vertices left are vertices of the mesh.
//!
//! - The quadric of a vertex sums the squared distances from the planes of its faces, weighed by area. Planes through the
//!   edges and normal to the faces keep the boundary in place and, with a small weight, faces of flat regions well shaped.
//! - The cost of a collapse is the quadric of both vertices at w over the quality of the worst face that it makes.
//! - A collapse keeps the topology where v and w have exactly two common neighbors and both of these have more than three
//!   neighbors (link condition). With an apex over each boundary loop the same condition keeps loops apart; a boundary
//!   vertex collapses only along its loop.
//! - Vertices on a mirror plane collapse only along the curve in it, and no other edge may come to lie in the plane.
//!
//! While there are many vertices, sweeps in the order of the vertices collapse those whose costs are among the lowest:
//! the arrays then pass through the cache in order. At the end a queue has the cheapest vertex next. Most costs only rise,
//! so the cost of a vertex whose star has changed is computed again when its last one is low enough. Costs that differ by
//! rounding or noise are equal, and the vertex of the lower index goes first.
//!
//! Cost: O(n log n), with the costs of about three vertices computed per collapse.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::connectivity::Connectivity;
use super::quadric::Quadric;
use crate::control::Watch;
use crate::mesh::geometry::{area_vector, triangle};
use crate::mesh::ties::DistinctKeys;
use crate::mesh::{Corner, Face, TriangleMesh, Vertex};
use crate::vector::Vector3;

/// Weight of the planes that keep the boundary in place, against those of the faces.
const BOUNDARY_WEIGHT: f64 = 4.0;

/// Weight of the planes normal to faces through inner edges.
const SHAPE_WEIGHT: f64 = 2e-3;

/// The quality of faces, 4√3·area/Σ edge², above which better shapes do not lower the cost.
const GOOD_QUALITY: f64 = 0.5;

/// The quality below which a face is a sliver, which no collapse makes.
const SLIVER: f64 = 0.02;

/// The cosine of the largest angle, 75°, by which a collapse turns a face.
const LEAST_COSINE: f64 = 0.258_819_045_102_520_76;

/// Vertices left to the queue by the sweeps.
const QUEUED: usize = 8000;

/// The share of the vertices, those of the lowest costs, that a sweep may collapse.
const SWEPT: f64 = 0.3;

/// The key of a vertex that cannot collapse or has done so.
const NEVER: u64 = u64::MAX;

/// Bits of the mantissa of a cost that are lost to rounding.
const ROUNDED_BITS: u32 = 20;

/// Keys that differ by no more are equal, a millionth of the cost: where a surface is nearly flat, costs are small
/// differences, and noise of the input changes them more than rounding.
const EQUAL_KEYS: u64 = 1 << 12;

/// Steps between two checks for cancellation.
const BETWEEN_CHECKS: usize = 1024;

/// A mesh with some of the vertices of another.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Decimated {
    /// The vertices that are left, ascending.
    pub vertices: Vec<Vertex>,
    /// The faces; their vertices are positions in `vertices`.
    pub faces: Vec<[Vertex; 3]>,
}

/// Decimates a mesh until the vertices left count `target`, or until nothing can collapse; `None` if cancelled.
///
/// Where the mesh is half of a symmetric one, `on_plane` (n,) says which vertices lie on the mirror plane. All of these
/// lie on the boundary and count once, other vertices twice.
pub(super) fn decimate(
    mesh: &TriangleMesh,
    on_plane: Option<&[bool]>,
    target: usize,
    watch: &Watch<'_>,
) -> Option<Decimated> {
    let mut decimation = Decimation::new(mesh, on_plane);
    // 1. Sweeps; the first computes all costs
    let swept = target.max(QUEUED);
    while decimation.left > swept
        && let Some(limit) = decimation.lowest_keys()
    {
        decimation.sweep(limit, swept, watch)?;
    }
    // 2. The cheapest vertex next
    decimation.empty_queue(target, watch)?;
    Some(decimation.into_rest())
}

/// What is to become of a vertex.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Plan {
    /// The star has changed since the cost was computed.
    Outdated,
    /// It moves onto the vertex at the next corner of this one.
    Collapse(Corner),
    /// It cannot collapse.
    Stuck,
    /// It has collapsed.
    Gone,
}

struct Decimation<'a> {
    points: &'a [Vector3],
    on_plane: Option<&'a [bool]>,
    connectivity: Connectivity,
    quadrics: Vec<Quadric>,
    /// The value of each vertex's quadric at the vertex.
    errors: Vec<f64>,
    plans: Vec<Plan>,
    /// The last known costs, rounded; 0 if there is none yet.
    keys: Vec<u64>,
    /// The keys in the queue; `None` during sweeps.
    distinct_keys: Option<DistinctKeys>,
    /// What the vertices left count.
    left: usize,
    /// Vertices that were stuck until their star changed.
    freed: Vec<Vertex>,
    ring: Ring,
}

impl<'a> Decimation<'a> {
    fn new(mesh: &'a TriangleMesh, on_plane: Option<&'a [bool]>) -> Self {
        let connectivity = Connectivity::new(mesh);
        let n_on_plane =
            on_plane.map_or(mesh.n_vertices(), |on_plane| on_plane.iter().filter(|x| **x).count());
        Self {
            points: mesh.points(),
            on_plane,
            connectivity,
            quadrics: quadrics(mesh, on_plane),
            errors: vec![0.0; mesh.n_vertices()],
            plans: vec![Plan::Outdated; mesh.n_vertices()],
            keys: vec![0; mesh.n_vertices()],
            distinct_keys: None,
            left: 2 * mesh.n_vertices() - n_on_plane,
            freed: Vec::new(),
            ring: Ring::default(),
        }
    }

    /// The key that a share of [`SWEPT`] of the vertices that may collapse do not exceed; `None` if none may.
    fn lowest_keys(&self) -> Option<u64> {
        let mut keys: Vec<u64> = self.keys.iter().copied().filter(|&key| key != NEVER).collect();
        let rank = (SWEPT * keys.len() as f64) as usize;
        // those equal to the last of them are low too
        (!keys.is_empty()).then(|| keys.select_nth_unstable(rank).1.saturating_add(EQUAL_KEYS))
    }

    /// Collapses vertices whose cost is at most `limit`, in their order, until those left count `target`; `None` if
    /// cancelled.
    fn sweep(&mut self, limit: u64, target: usize, watch: &Watch<'_>) -> Option<()> {
        for vertex in Vertex::all(self.points.len()) {
            if vertex.index() % BETWEEN_CHECKS == 0 && !watch.goes_on() {
                return None;
            }
            let is_low = self.keys[vertex] <= limit && self.left > target;
            if is_low && (!self.is_outdated(vertex) || self.evaluate(vertex) <= limit) {
                self.collapse(vertex);
            }
        }
        self.freed.clear();
        Some(())
    }

    /// Collapses the cheapest vertex again and again until those left count `target`, or until none can collapse; `None`
    /// if cancelled.
    fn empty_queue(&mut self, target: usize, watch: &Watch<'_>) -> Option<()> {
        self.distinct_keys = Some(DistinctKeys::default());
        let mut queue = BinaryHeap::new();
        for vertex in Vertex::all(self.points.len()) {
            let key = self.keys[vertex];
            if key != NEVER {
                self.keys[vertex] = self.one_of_equals(key);
                queue.push(Reverse((self.keys[vertex], vertex)));
            }
        }
        let mut steps = 0;
        while self.left > target
            && let Some(Reverse((_, vertex))) = queue.pop()
        {
            if !self.is_outdated(vertex) {
                self.collapse(vertex);
                queue.extend(self.freed.drain(..).map(|vertex| Reverse((0, vertex))));
            } else if self.evaluate(vertex) != NEVER {
                queue.push(Reverse((self.keys[vertex], vertex)));
            }
            steps += 1;
            if steps % BETWEEN_CHECKS == 0 && !watch.goes_on() {
                return None;
            }
        }
        Some(())
    }

    fn is_on_plane(&self, vertex: Vertex) -> bool {
        self.on_plane.is_some_and(|on_plane| !self.connectivity.is_apex(vertex) && on_plane[vertex])
    }

    /// Whether the cost of a vertex must be computed again: its star has changed, or a vertex beside the edge to collapse
    /// has lost neighbors.
    fn is_outdated(&self, vertex: Vertex) -> bool {
        match self.plans[vertex] {
            Plan::Collapse(corner) => !self.leaves_neighbors(corner),
            _ => true,
        }
    }

    fn leaves_neighbors(&self, corner: Corner) -> bool {
        self.connectivity.beside(corner).into_iter().all(|vertex| self.connectivity.degree(vertex) > 3)
    }

    /// Plans the cheapest collapse of a vertex; returns its key.
    fn evaluate(&mut self, vertex: Vertex) -> u64 {
        self.ring.gather(vertex, &self.connectivity, self.points);
        let mut cheapest = self.cheapest(vertex);
        while let Some((_, k)) = cheapest
            && !self.keeps_topology(self.ring.corners[k])
        {
            self.ring.is_refused[k] = true;
            cheapest = self.cheapest(vertex);
        }
        let (key, plan) = match cheapest {
            Some((key, k)) => (self.one_of_equals(key), Plan::Collapse(self.ring.corners[k])),
            None => (NEVER, Plan::Stuck),
        };
        (self.keys[vertex], self.plans[vertex]) = (key, plan);
        key
    }

    /// The key that stands for those equal to one, in the queue.
    fn one_of_equals(&mut self, key: u64) -> u64 {
        self.distinct_keys.as_mut().map_or(key, |distinct| distinct.one_of_equals(key, EQUAL_KEYS))
    }

    /// The neighbor in the ring onto which the collapse costs least, with its key: the lowest of equals.
    fn cheapest(&self, vertex: Vertex) -> Option<(u64, usize)> {
        let quadric = self.quadrics[vertex];
        let mut best: Option<(u64, usize)> = None;
        for (k, &onto) in self.ring.vertices.iter().enumerate() {
            if self.ring.is_refused[k] || !self.keeps_curves(vertex, k) {
                continue;
            }
            let error = (quadric.at(self.ring.points[k]) + self.errors[onto]).max(0.0);
            let is_worse = |cost: f64| {
                best.is_some_and(|(least, first)| match rounded(cost) {
                    key if key.abs_diff(least) <= EQUAL_KEYS => self.ring.vertices[first] < onto,
                    key => key > least,
                })
            };
            if is_worse(error / GOOD_QUALITY) {
                continue;
            }
            let Some(quality) = self.ring.quality_after(k) else { continue };
            let cost = error / quality.min(GOOD_QUALITY);
            if !is_worse(cost) {
                best = Some((rounded(cost), k));
            }
        }
        best
    }

    /// Whether a collapse onto neighbor `k` of the ring keeps the boundary and the curve on the mirror plane.
    fn keeps_curves(&self, vertex: Vertex, k: usize) -> bool {
        let onto = self.ring.vertices[k];
        let beside = self.ring.beside(k);
        let is_apex = |vertex| self.connectivity.is_apex(vertex);
        if is_apex(onto) || (self.ring.has_apex && !beside.into_iter().any(is_apex)) {
            return false;
        }
        match (self.is_on_plane(vertex), self.is_on_plane(onto)) {
            (_, false) => !self.is_on_plane(vertex),
            (true, true) => true,
            // a neighbor on the plane must be joined to `onto` already
            (false, true) => {
                let mut neighbors = self.ring.vertices.iter();
                neighbors.all(|&v| v == onto || beside.contains(&v) || !self.is_on_plane(v))
            }
        }
    }

    /// The link condition for the collapse of the vertex of the ring onto that at the next corner.
    fn keeps_topology(&self, corner: Corner) -> bool {
        let onto = self.connectivity.vertex(corner.next());
        let neighbors = self.connectivity.around(onto).map(|corner| self.connectivity.vertex(corner.next()));
        let is_common = |neighbor: &Vertex| self.ring.vertices.contains(neighbor);
        self.leaves_neighbors(corner) && neighbors.filter(is_common).count() == 2
    }

    /// Carries out the plan of a vertex.
    fn collapse(&mut self, vertex: Vertex) {
        let Plan::Collapse(corner) = self.plans[vertex] else { return };
        let onto = self.connectivity.vertex(corner.next());
        self.connectivity.collapse(corner);
        let quadric = self.quadrics[vertex];
        self.quadrics[onto] += quadric;
        self.errors[onto] += quadric.at(self.points[onto]);
        self.plans[vertex] = Plan::Gone;
        self.keys[vertex] = NEVER;
        self.left -= if self.on_plane.is_some_and(|on_plane| !on_plane[vertex]) { 2 } else { 1 };
        let neighbors = self.connectivity.around(onto).map(|corner| self.connectivity.vertex(corner.next()));
        for changed in neighbors.filter(|&v| !self.connectivity.is_apex(v)).chain([onto]) {
            if self.plans[changed] == Plan::Stuck {
                self.freed.push(changed);
                self.keys[changed] = 0;
            }
            self.plans[changed] = Plan::Outdated;
        }
    }

    /// The vertices and faces that are left.
    fn into_rest(self) -> Decimated {
        let is_left = |vertex: &Vertex| self.plans[*vertex] != Plan::Gone;
        let vertices: Vec<Vertex> = Vertex::all(self.points.len()).filter(is_left).collect();
        let mut numbers = vec![Vertex::default(); self.points.len()];
        for (number, &vertex) in Vertex::all(vertices.len()).zip(&vertices) {
            numbers[vertex] = number;
        }
        let faces = self.connectivity.faces_left().map(|face| face.map(|vertex| numbers[vertex])).collect();
        Decimated { vertices, faces }
    }
}

/// A cost as a whole number that orders costs as they are, without the digits that rounding decides.
fn rounded(cost: f64) -> u64 {
    cost.to_bits() >> ROUNDED_BITS
}

/// The neighbors of a vertex, counterclockwise.
#[derive(Debug, Default)]
struct Ring {
    /// The corners at the vertex whose next corners are the neighbors.
    corners: Vec<Corner>,
    vertices: Vec<Vertex>,
    points: Vec<Vector3>,
    /// Twice the area vector of the face from each neighbor to the next; `None` at an apex.
    normals: Vec<Option<Vector3>>,
    /// Whether a collapse onto the neighbor would change the topology.
    is_refused: Vec<bool>,
    /// The quality of the worst face at the vertex.
    quality: f64,
    has_apex: bool,
}

impl Ring {
    /// Collects the ring of a vertex.
    fn gather(&mut self, vertex: Vertex, connectivity: &Connectivity, points: &[Vector3]) {
        self.corners.clear();
        self.vertices.clear();
        self.points.clear();
        self.normals.clear();
        self.is_refused.clear();
        (self.quality, self.has_apex) = (1.0, false);
        for corner in connectivity.around(vertex) {
            let neighbor = connectivity.vertex(corner.next());
            let is_apex = connectivity.is_apex(neighbor);
            self.has_apex |= is_apex;
            self.is_refused.push(false);
            self.corners.push(corner);
            self.vertices.push(neighbor);
            self.points.push(if is_apex { Vector3::ZERO } else { points[neighbor] });
        }
        for k in 0..self.vertices.len() {
            let next = if k + 1 == self.vertices.len() { 0 } else { k + 1 };
            let is_virtual = [k, next].into_iter().any(|k| connectivity.is_apex(self.vertices[k]));
            let (normal, quality) = shape(points[vertex], self.points[k], self.points[next]);
            self.normals.push((!is_virtual).then_some(normal));
            self.quality = if is_virtual { self.quality } else { self.quality.min(quality) };
        }
    }

    /// The neighbors before and after one.
    fn beside(&self, k: usize) -> [Vertex; 2] {
        let n = self.vertices.len();
        [self.vertices[if k == 0 { n - 1 } else { k - 1 }], self.vertices[if k + 1 == n { 0 } else { k + 1 }]]
    }

    /// The quality of the worst face after a collapse onto neighbor `k`; `None` if it turns a face too far or makes a
    /// sliver.
    fn quality_after(&self, k: usize) -> Option<f64> {
        let n = self.vertices.len();
        let (onto, least) = (self.points[k], SLIVER.min(self.quality));
        let mut worst = 1.0;
        for step in 1..n - 1 {
            let from = if k + step < n { k + step } else { k + step - n };
            let to = if from + 1 == n { 0 } else { from + 1 };
            let Some(old) = self.normals[from] else { continue };
            let (new, quality) = shape(onto, self.points[from], self.points[to]);
            let cosine = old.dot(new);
            let is_turned =
                cosine <= 0.0 || cosine * cosine < LEAST_COSINE * LEAST_COSINE * old.dot(old) * new.dot(new);
            if is_turned || quality < least {
                return None;
            }
            worst = f64::min(worst, quality);
        }
        Some(worst)
    }
}

/// The normal of a triangle, twice as long as its area, and its quality.
fn shape(a: Vector3, b: Vector3, c: Vector3) -> (Vector3, f64) {
    let (p, q, r) = (b - a, c - a, c - b);
    let normal = p.cross(q);
    let squares = p.dot(p) + q.dot(q) + r.dot(r);
    (normal, 12f64.sqrt() * normal.norm() / squares)
}

/// The quadric of every vertex. Vertices on the mirror plane get those of the mirrored faces too, which are as far from
/// points of the plane.
fn quadrics(mesh: &TriangleMesh, on_plane: Option<&[bool]>) -> Vec<Quadric> {
    let is_on_plane = |vertex: Vertex| on_plane.is_some_and(|on_plane| on_plane[vertex]);
    let mut quadrics = vec![Quadric::default(); mesh.n_vertices()];
    let mut add = |vertex: Vertex, quadric: Quadric| {
        quadrics[vertex] += quadric;
        if is_on_plane(vertex) {
            quadrics[vertex] += quadric;
        }
    };
    for (number, &face) in Face::all(mesh.n_faces()).zip(mesh.faces()) {
        let area = mesh.face_areas()[number];
        let normal = area_vector(triangle(mesh.points(), face)).normalized();
        let plane = Quadric::of_plane(mesh.points()[face[0]], normal, area);
        face.into_iter().for_each(|vertex| add(vertex, plane));
        for corner in number.corners() {
            let [from, to] = corner.half_edge(mesh.faces());
            let edge = mesh.points()[to] - mesh.points()[from];
            let is_kept = mesh.opposite(corner).is_none() && !(is_on_plane(from) && is_on_plane(to));
            let weight = area * if is_kept { BOUNDARY_WEIGHT } else { SHAPE_WEIGHT };
            let across = Quadric::of_plane(mesh.points()[from], normal.cross(edge).normalized(), weight);
            [from, to].into_iter().for_each(|vertex| add(vertex, across));
        }
    }
    quadrics
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::Silent;
    use crate::seams::proxy::refine::refine;
    use crate::seams::sample_surfaces::{
        body, cube, greatest_distance, perforated_cylinder, plate_with_three_holes, sphere, topology, torus,
        uneven_body,
    };
    use crate::vector::coordinates;

    fn decimated(mesh: &TriangleMesh, target: usize) -> Decimated {
        decimate(mesh, None, target, &Watch::new(&mut Silent, 0.0, "")).unwrap()
    }

    fn as_mesh(mesh: &TriangleMesh, decimated: &Decimated) -> TriangleMesh {
        let points = decimated.vertices.iter().map(|&vertex| mesh.points()[vertex]).collect();
        TriangleMesh::at_given_points(points, decimated.faces.clone()).unwrap()
    }

    fn fine_plate() -> TriangleMesh {
        (0..3).fold(plate_with_three_holes(), |mesh, _| refine(&mesh).unwrap().mesh)
    }

    #[test]
    fn surfaces_of_any_topology_keep_it_and_their_shape() {
        let cases = [
            (torus(), 400, (1, 0, 0), 0.01),
            (perforated_cylinder(), 500, (1, -8, 10), 0.01),
            (fine_plate(), 300, (1, -4, 0), 1e-9),
            (uneven_body(5), 600, (1, 2, 0), 0.01),
        ];
        for (mesh, target, expected, distance) in cases {
            assert_eq!(topology(&mesh), expected);
            let coarse = as_mesh(&mesh, &decimated(&mesh, target));
            assert_eq!((topology(&coarse), coarse.n_vertices()), (expected, target));
            assert!(coarse.flipped_faces().is_empty());
            let missed = greatest_distance(mesh.points(), &coarse);
            assert!(missed <= distance, "{missed}");
        }
    }

    #[test]
    fn where_nothing_more_can_collapse_the_topology_is_still_that_of_the_surface() {
        for mesh in [torus(), perforated_cylinder(), fine_plate(), body(3)] {
            let coarse = as_mesh(&mesh, &decimated(&mesh, 0));
            assert_eq!(topology(&coarse), topology(&mesh));
            assert!(coarse.n_vertices() < 150, "{}", coarse.n_vertices());
        }
    }

    #[test]
    fn a_large_mesh_is_swept_first() {
        let mesh = uneven_body(6);
        assert!(mesh.n_vertices() > 2 * QUEUED);
        let coarse = as_mesh(&mesh, &decimated(&mesh, 1000));
        assert_eq!((topology(&coarse), coarse.n_vertices()), ((1, 2, 0), 1000));
        let some: Vec<Vector3> = mesh.points().iter().step_by(7).copied().collect();
        assert!(greatest_distance(&some, &coarse) < 0.005);
    }

    #[test]
    fn the_outline_of_a_flat_square_keeps_its_corners() {
        let n = 30;
        let points: Vec<[f64; 3]> = (0..n * n).map(|k| [(k % n) as f64, (k / n) as f64, 0.0]).collect();
        let quads = (0..n - 1).flat_map(|j| (0..n - 1).map(move |i| (j * n + i) as u32));
        let faces: Vec<[u32; 3]> = quads.flat_map(|a| [[a, a + 1, a + 31], [a, a + 31, a + 30]]).collect();
        let mesh = TriangleMesh::new(&points, &faces).unwrap();
        let left = decimated(&mesh, 40).vertices;
        for corner in [0, n - 1, n * (n - 1), n * n - 1] {
            assert!(left.contains(&Vertex::new(corner)));
        }
    }

    #[test]
    fn mirrored_and_noisy_input_loses_the_same_vertices() {
        let mesh = uneven_body(4);
        let left = decimated(&mesh, 300).vertices;
        let again = |points: Vec<[f64; 3]>, faces: &[[Vertex; 3]]| {
            decimated(&TriangleMesh::new(&points, faces).unwrap(), 300).vertices
        };
        let noise = |k: usize| Vector3::from_fn(|axis| 1e-12 * (7.3 * k as f64 + axis as f64).sin());
        let noisy = mesh.points().iter().enumerate().map(|(k, &point)| point + noise(k));
        assert_eq!(again(coordinates(noisy), mesh.faces()), left);
        let mirrored = mesh.points().iter().map(|&Vector3([x, y, z])| [-x, y, z]).collect();
        let turned: Vec<_> = mesh.faces().iter().map(|&[a, b, c]| [a, c, b]).collect();
        assert_eq!(again(mirrored, &turned), left);
    }

    #[test]
    fn of_symmetric_vertices_noise_chooses_none() {
        for mesh in [sphere(5), (0..3).fold(cube(4), |mesh, _| refine(&mesh).unwrap().mesh)] {
            let left = decimated(&mesh, 300).vertices;
            for seed in 1..4 {
                let noise =
                    |k: usize| Vector3::from_fn(|axis| 1e-12 * (7.3 * (k * seed) as f64 + axis as f64).sin());
                let noisy = mesh.points().iter().enumerate().map(|(k, &point)| point + noise(k));
                let noisy = TriangleMesh::new(&coordinates(noisy), mesh.faces()).unwrap();
                assert_eq!(decimated(&noisy, 300).vertices, left, "{seed}");
            }
        }
    }

    #[test]
    fn a_cancelled_decimation_returns_nothing() {
        let mut cancel = |_: f64, _: &str| false;
        let watch = Watch::new(&mut cancel, 0.0, "");
        std::thread::sleep(std::time::Duration::from_millis(100));
        assert_eq!(decimate(&torus(), None, 100, &watch), None);
    }
}
