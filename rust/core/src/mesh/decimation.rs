// SPDX-License-Identifier: MIT OR Apache-2.0
//! Decimation of a closed surface of genus 0 to a tetrahedron, and its undoing one vertex at a time.
//!
//! Half-edge collapses: a vertex v moves onto a neighbour w, and the two faces between them vanish. A
//! collapse keeps the surface a sphere where v and w have exactly two common neighbours (link condition);
//! with more than four vertices there always is one. The next vertex is the one whose star has least target
//! measure, weighed by its degree and the shapes it would leave, so that the vertices of every coarse mesh
//! are spread evenly over the measure. The measure of a star is handed on to the faces that fill it, so the
//! sum over all faces stays the same.
//!
//! A surface with one boundary loop is closed by an apex, a vertex without place or measure that is joined
//! to the whole loop. The apex never collapses, and a vertex of the loop only onto a neighbour in the loop.
//!
//! Cost: O(n log n), the stars of about four vertices looked at for each one.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::TriangleMesh;
use super::geometry::{Vector, area, cross, dot, sub, triangle};
use super::topology::{next_corner, previous_corner};
use crate::control::Observer;
use crate::parallel;

/// The observer is asked once for so many vertices.
const BEAT: usize = 1024;

/// And once for so many at the beginning, on all threads.
const ROUND: usize = 16_384;

/// A vertex of the boundary costs so many times as much as another: a coarse boundary has room for too few
/// vertices behind it.
const BOUNDARY: f64 = 12.0;

/// The shapes around a vertex with more neighbours are not looked at before it comes to the front of the
/// queue; by then it has fewer.
const MANY_NEIGHBOURS: usize = 32;

/// A mesh that loses vertices by [`Decimation::coarsen`] and gets them back by [`Decimation::refine`].
#[derive(Debug)]
pub(crate) struct Decimation<'a> {
    mesh: &'a TriangleMesh,
    /// The faces of the mesh, then those at the apex.
    faces: Vec<Face>,
    /// A corner at each vertex; of a vertex that is gone, the one whose next corner it went onto.
    corners: Vec<u32>,
    /// How many neighbours each vertex has; of a vertex that is gone, those it had.
    degrees: Vec<u32>,
    gone: Vec<bool>,
    collapses: Vec<Collapse>,
    /// The targets that each collapse changed, one after the other.
    old_targets: Vec<f64>,
}

/// A face with all that turning about a vertex asks for, half a line of the cache.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Face {
    vertices: [u32; 3],
    /// The corner across the edge opposite to each corner.
    twins: [u32; 3],
    target: f64,
}

/// A vertex that moved onto a neighbour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Collapse {
    /// The vertex that went.
    pub vertex: u32,
    /// The neighbour it went onto.
    pub onto: u32,
}

/// A vertex in the queue: cheap ones first, of equal ones the lowest.
#[derive(PartialEq)]
struct Candidate {
    cost: f64,
    vertex: u32,
}

impl Eq for Candidate {}

impl Ord for Candidate {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.cost.total_cmp(&other.cost).then(self.vertex.cmp(&other.vertex))
    }
}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

/// The neighbours of a vertex, counter-clockwise, and the measure of its star.
#[derive(Default)]
struct Ring {
    /// The corners at the vertex whose next corners are the neighbours.
    corners: Vec<u32>,
    vertices: Vec<u32>,
    points: Vec<Vector>,
    measure: f64,
    /// Where in the ring the apex is.
    apex: Option<usize>,
}

impl Ring {
    /// The cost of the vertex but for the shapes that it leaves.
    fn weight(&self) -> f64 {
        let degree = 1.0 + 0.15 * (self.vertices.len() as f64 - 6.0).max(0.0).powi(2);
        let boundary = if self.apex.is_some() { BOUNDARY } else { 1.0 };
        self.measure * degree * boundary
    }

    /// Whether a collapse onto the neighbour keeps the boundary what it is.
    fn keeps_the_boundary(&self, neighbour: usize) -> bool {
        let n = self.vertices.len();
        self.apex.is_none_or(|apex| (apex + 1) % n == neighbour || (neighbour + 1) % n == apex)
    }

    /// How bad the shapes and the degree are that a collapse onto a neighbour of some degree leaves; 1/1.05 or more.
    fn shape(&self, neighbour: usize, degree: usize) -> f64 {
        let degree = (degree + self.vertices.len()) as f64 - 4.0;
        (1.0 + 0.05 * (degree - 7.0).max(0.0).powi(2)) / (self.worst_shape(neighbour) + 0.05)
    }

    /// 4√3·area/Σ edge² of the worst face that a collapse onto a neighbour makes; 1 is equilateral.
    fn worst_shape(&self, neighbour: usize) -> f64 {
        let n = self.vertices.len();
        let onto = self.points[neighbour];
        let mut worst = 1.0;
        for k in neighbour + 1..neighbour + n - 1 {
            let [one, two] = [k, k + 1].map(|k| if k < n { k } else { k - n });
            if self.apex.is_some_and(|apex| apex == one || apex == two) {
                continue;
            }
            let (edge, spoke) = (sub(self.points[two], self.points[one]), sub(self.points[one], onto));
            let other = sub(self.points[two], onto);
            let squares = dot(edge, edge) + dot(spoke, spoke) + dot(other, other);
            let normal = cross(spoke, edge);
            let shape = if squares > 0.0 { dot(normal, normal) / (squares * squares) } else { 0.0 };
            worst = f64::min(worst, 12.0 * shape);
        }
        worst.sqrt()
    }
}

impl<'a> Decimation<'a> {
    /// The whole mesh with its targets, before any collapse: a sphere, or a disk, which gets its apex.
    pub(crate) fn new(mesh: &'a TriangleMesh, targets: Vec<f64>) -> Self {
        let n = mesh.n_vertices();
        let twin = |corner| mesh.opposite(corner).unwrap_or_default();
        let faces = mesh.faces().iter().zip(targets).zip((0..).step_by(3));
        let face = |((&vertices, target), corner): ((&[u32; 3], f64), u32)| Face {
            vertices,
            twins: [corner, corner + 1, corner + 2].map(twin),
            target,
        };
        let mut whole = Self {
            mesh,
            faces: faces.map(face).collect(),
            corners: (0..n).map(|vertex| mesh.vertex_corners(vertex)[0]).collect(),
            degrees: (0..n).map(|vertex| mesh.vertex_corners(vertex).len() as u32).collect(),
            gone: vec![false; n],
            collapses: Vec::with_capacity(n),
            old_targets: Vec::with_capacity(6 * n),
        };
        mesh.boundary_loops().first().into_iter().for_each(|boundary| whole.close(boundary));
        whole
    }

    /// Joins the boundary loop to the apex.
    fn close(&mut self, boundary: &[u32]) {
        let (apex, first) = (self.apex(), 3 * self.faces.len() as u32);
        let end = first + 3 * boundary.len() as u32;
        for (k, &vertex) in boundary.iter().enumerate() {
            let next = boundary[(k + 1) % boundary.len()];
            let along = |&&corner: &&u32| {
                self.vertex(next_corner(corner)) == next
                    && self.mesh.opposite(previous_corner(corner)).is_none()
            };
            let corner = self.mesh.vertex_corners(vertex as usize).iter().find(along);
            let across = previous_corner(*corner.expect("the loop runs along boundary edges"));
            let face = first + 3 * k as u32;
            let [before, behind] =
                [if k == 0 { end } else { face } - 3, if face + 3 == end { first } else { face + 3 }];
            let twins = [before + 1, behind, across];
            self.faces.push(Face { vertices: [next, vertex, apex], twins, target: 0.0 });
            *self.twin_mut(across) = face + 2;
            self.degrees[vertex as usize] += 2;
        }
        self.corners.push(first + 2);
        self.degrees.push(boundary.len() as u32);
        self.gone.push(false);
    }

    /// The vertex that closes a disk.
    pub(crate) fn apex(&self) -> u32 {
        self.mesh.n_vertices() as u32
    }

    /// The faces at a vertex, counter-clockwise, each by the two others of its corners in order, with their
    /// targets.
    pub(crate) fn star(&self, vertex: u32) -> impl Iterator<Item = (u32, u32, f64)> {
        self.around(self.corners[vertex as usize]).map(|corner| {
            let ends = [next_corner(corner), previous_corner(corner)].map(|corner| self.vertex(corner));
            (ends[0], ends[1], self.faces[corner as usize / 3].target)
        })
    }

    /// How many neighbours a vertex has.
    pub(crate) fn degree(&self, vertex: u32) -> usize {
        self.degrees[vertex as usize] as usize
    }

    /// Whether a vertex has been collapsed.
    pub(crate) fn is_gone(&self, vertex: u32) -> bool {
        self.gone[vertex as usize]
    }

    /// Collapses vertices until four are left, the apex among them, or until none can be collapsed; `None`
    /// where the observer ended it early.
    pub(crate) fn coarsen(&mut self, observer: &mut dyn Observer) -> Option<()> {
        let surplus = self.degrees.len().saturating_sub(4);
        let mut queue = self.candidates(observer)?;
        let mut waiting = vec![false; self.degrees.len()];
        let mut ring = Ring::default();
        while self.collapses.len() < surplus {
            let Some(Reverse(Candidate { cost, vertex })) = queue.pop() else { break };
            // 1. Out of date? A cost that fell since then is good enough as it is
            let (now, corner) = self.best_collapse(vertex, &mut ring);
            let Some(corner) = corner else {
                waiting[vertex as usize] = true;
                continue;
            };
            if now > cost {
                queue.push(Reverse(Candidate { cost: now, vertex }));
                continue;
            }
            // 2. Collapse; neighbours that could not collapse may be able to now
            self.collapse(corner);
            for &vertex in &ring.vertices {
                if std::mem::take(&mut waiting[vertex as usize]) {
                    queue.push(Reverse(Candidate { cost: 0.0, vertex }));
                }
            }
            let part = self.collapses.len() as f64 / surplus as f64;
            if self.collapses.len().is_multiple_of(BEAT) && !observer.progress(part, "Coarsening") {
                return None;
            }
        }
        Some(())
    }

    /// Takes the last collapse back and returns it; `None` once all are undone.
    pub(crate) fn refine(&mut self) -> Option<Collapse> {
        let collapse = self.collapses.pop()?;
        let Collapse { vertex, onto } = collapse;
        let corner = self.corners[vertex as usize];
        // 1. The dead faces come back between their neighbours
        for corner in self.dead_faces(corner).into_iter().flat_map(|face| 3 * face..3 * face + 3) {
            let across = self.twin(corner);
            *self.twin_mut(across) = corner;
        }
        // 2. The star has its vertex again
        let mut at = corner;
        loop {
            self.faces[at as usize / 3].vertices[at as usize % 3] = vertex;
            at = self.turned(at);
            if at == corner {
                break;
            }
        }
        self.corners[onto as usize] = next_corner(corner);
        self.gone[vertex as usize] = false;
        self.count_neighbours(collapse, corner, 1);
        // 3. And its measure
        let faces: Vec<u32> = self.measured_faces(corner).collect();
        let begin = self.old_targets.len() - faces.len();
        for (face, target) in faces.into_iter().zip(self.old_targets.drain(begin..)) {
            self.faces[face as usize].target = target;
        }
        Some(collapse)
    }

    /// Moves the vertex at a corner onto that of the next corner.
    fn collapse(&mut self, corner: u32) {
        let collapse = Collapse { vertex: self.vertex(corner), onto: self.vertex(next_corner(corner)) };
        let dead = self.dead_faces(corner);
        let heirs: Vec<u32> = self.measured_faces(corner).collect();
        self.count_neighbours(collapse, corner, -1);
        // 1. The star gets its new vertex
        let mut last = corner;
        loop {
            self.faces[last as usize / 3].vertices[last as usize % 3] = collapse.onto;
            let next = self.turned(last);
            if next == corner {
                break;
            }
            last = next;
        }
        // 2. The faces beside each dead one become neighbours
        for [one, two] in [[corner, next_corner(corner)], [last, previous_corner(last)]] {
            let [one, two] = [one, two].map(|corner| self.twin(corner));
            *self.twin_mut(one) = two;
            *self.twin_mut(two) = one;
            for corner in [next_corner(two), previous_corner(two)] {
                let vertex = self.vertex(corner);
                self.corners[vertex as usize] = corner;
            }
        }
        // 3. Its measure goes to the faces that stay
        let measure: f64 = heirs.iter().map(|&face| self.faces[face as usize].target).sum();
        self.old_targets.extend(heirs.iter().map(|&face| self.faces[face as usize].target));
        dead.into_iter().for_each(|face| self.faces[face as usize].target = 0.0);
        self.share_out(heirs.into_iter().filter(|face| !dead.contains(face)), measure);
        // 4. How to undo it
        self.corners[collapse.vertex as usize] = corner;
        self.gone[collapse.vertex as usize] = true;
        self.collapses.push(collapse);
    }

    /// Half of a measure in equal parts, half by area.
    fn share_out(&mut self, faces: impl Iterator<Item = u32> + Clone, measure: f64) {
        let face_area = |face: u32| area(triangle(self.mesh.points(), self.faces[face as usize].vertices));
        let areas: Vec<f64> = faces.clone().map(face_area).collect();
        let total: f64 = areas.iter().sum();
        let equal = 1.0 / areas.len() as f64;
        for (face, area) in faces.zip(areas) {
            let by_area = if total > 0.0 { area / total } else { equal };
            self.faces[face as usize].target = 0.5 * measure * (by_area + equal);
        }
    }

    /// Adds to the degrees of a vertex's neighbours what it means to them that it comes back (`sign` 1) or
    /// goes (−1).
    fn count_neighbours(&mut self, collapse: Collapse, corner: u32, sign: i32) {
        let beyond = self.degrees[collapse.vertex as usize] as i32 - 4;
        let across = self.twin(previous_corner(corner));
        let beside = [previous_corner(corner), across].map(|corner| (self.vertex(corner), sign));
        for (vertex, change) in beside.into_iter().chain([(collapse.onto, -sign * beyond)]) {
            let degree = &mut self.degrees[vertex as usize];
            *degree = degree.wrapping_add_signed(change);
        }
    }

    /// All vertices with what it costs to collapse them; `None` where the observer ended it early.
    fn candidates(&self, observer: &mut dyn Observer) -> Option<BinaryHeap<Reverse<Candidate>>> {
        let n = self.mesh.n_vertices();
        let mut candidates = Vec::with_capacity(n);
        for first in (0..n).step_by(ROUND) {
            let costs = parallel::map(ROUND.min(n - first), |k| self.first_cost((first + k) as u32));
            let with_cost = |(k, cost)| Reverse(Candidate { cost, vertex: (first + k) as u32 });
            candidates.extend(costs.into_iter().enumerate().map(with_cost));
            if !observer.progress(0.0, "Coarsening") {
                return None;
            }
        }
        Some(BinaryHeap::from(candidates))
    }

    /// What it costs to collapse a vertex, or less.
    fn first_cost(&self, vertex: u32) -> f64 {
        let mut ring = Ring::default();
        if self.degree(vertex) > MANY_NEIGHBOURS {
            self.fill_ring(vertex, &mut ring);
            return ring.weight() / 1.05f64.sqrt();
        }
        let cost = self.best_collapse(vertex, &mut ring).0;
        // those that cannot collapse learn it first
        if cost.is_finite() { cost } else { 0.0 }
    }

    /// What it costs to collapse a vertex and the corner at it that is followed by the neighbour it goes
    /// onto; infinite where it cannot be.
    fn best_collapse(&self, vertex: u32, ring: &mut Ring) -> (f64, Option<u32>) {
        self.fill_ring(vertex, ring);
        let allowed = |&k: &usize| ring.apex != Some(k) && ring.keeps_the_boundary(k);
        let mut rated: Vec<(f64, u32, u32)> = (0..ring.vertices.len())
            .filter(allowed)
            .map(|k| (ring.shape(k, self.degree(ring.vertices[k])), ring.vertices[k], ring.corners[k]))
            .collect();
        // the link condition costs most, so only of the best is it asked, then of the second best
        while let Some(&best) = rated.iter().min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))) {
            if self.keeps_the_sphere(ring, best.1) {
                return (ring.weight() * best.0.sqrt(), Some(best.2));
            }
            rated.retain(|other| other.1 != best.1);
        }
        (f64::INFINITY, None)
    }

    fn fill_ring(&self, vertex: u32, ring: &mut Ring) {
        ring.corners.clear();
        ring.vertices.clear();
        ring.points.clear();
        (ring.measure, ring.apex) = (0.0, None);
        for corner in self.around(self.corners[vertex as usize]) {
            let neighbour = self.vertex(next_corner(corner));
            if neighbour == self.apex() {
                ring.apex = Some(ring.vertices.len());
            }
            ring.measure += self.faces[corner as usize / 3].target;
            ring.corners.push(corner);
            ring.vertices.push(neighbour);
            ring.points.push(self.mesh.points().get(neighbour as usize).copied().unwrap_or_default());
        }
    }

    /// The link condition: exactly two common neighbours.
    fn keeps_the_sphere(&self, ring: &Ring, onto: u32) -> bool {
        let around = self.around(self.corners[onto as usize]);
        around.filter(|&corner| ring.vertices.contains(&self.vertex(next_corner(corner)))).count() == 2
    }

    /// The faces between which the measure of the star around a corner is shared: its own, without those at
    /// the apex; where that is only one, also the one across from the vertex, which inherits it.
    fn measured_faces(&self, corner: u32) -> impl Iterator<Item = u32> {
        let own = self.around(corner).filter(|&corner| (corner as usize) < 3 * self.mesh.n_faces());
        let is_ear = own.clone().nth(1).is_none();
        let heir = own.clone().next().filter(|_| is_ear).map(|corner| self.twin(corner));
        own.chain(heir).map(|corner| corner / 3)
    }

    /// The faces on both sides of the edge from the vertex at a corner to that of the next corner.
    fn dead_faces(&self, corner: u32) -> [u32; 2] {
        [corner / 3, self.twin(previous_corner(corner)) / 3]
    }

    /// The corners at one vertex, counter-clockwise.
    fn around(&self, first: u32) -> impl Iterator<Item = u32> + Clone {
        std::iter::successors(Some(first), move |&corner| {
            Some(self.turned(corner)).filter(|&turned| turned != first)
        })
    }

    /// The next corner at the same vertex, counter-clockwise.
    fn turned(&self, corner: u32) -> u32 {
        next_corner(self.twin(next_corner(corner)))
    }

    fn twin(&self, corner: u32) -> u32 {
        self.faces[corner as usize / 3].twins[corner as usize % 3]
    }

    fn twin_mut(&mut self, corner: u32) -> &mut u32 {
        &mut self.faces[corner as usize / 3].twins[corner as usize % 3]
    }

    fn vertex(&self, corner: u32) -> u32 {
        self.faces[corner as usize / 3].vertices[corner as usize % 3]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::Silent;

    /// A bipyramid over a polygon of n corners, all on the unit sphere; without the first `open` faces.
    fn bipyramid(n: u32, open: usize) -> TriangleMesh {
        let corner = |i: u32| {
            let angle = std::f64::consts::TAU * f64::from(i) / f64::from(n);
            [angle.cos(), angle.sin(), 0.05 * (3.0 * angle).sin()]
        };
        let vertices: Vec<Vector> = (0..n).map(corner).chain([[0., 0., 1.], [0., 0., -1.]]).collect();
        let faces = (0..n).flat_map(|i| [[i, (i + 1) % n, n], [(i + 1) % n, i, n + 1]]).skip(open);
        TriangleMesh::new(&vertices, &faces.collect::<Vec<_>>()).unwrap()
    }

    fn comes_down_and_back(mesh: &TriangleMesh, left: usize) {
        let targets: Vec<f64> = (0..mesh.n_faces()).map(|face| 1.0 + face as f64).collect();
        let total: f64 = targets.iter().sum();
        let mut decimation = Decimation::new(mesh, targets);
        let before = (decimation.faces.clone(), decimation.degrees.clone());
        let measure = |now: &Decimation| now.faces.iter().map(|face| face.target).sum::<f64>();
        decimation.coarsen(&mut Silent).unwrap();
        assert!((measure(&decimation) - total).abs() < 1e-9 * total);
        let remaining: Vec<u32> = (0..mesh.n_vertices() as u32).filter(|&v| !decimation.is_gone(v)).collect();
        assert_eq!(remaining.len(), left);
        assert!(remaining.iter().all(|&v| decimation.degree(v) == 3 && decimation.star(v).count() == 3));
        while let Some(Collapse { vertex, onto }) = decimation.refine() {
            assert!((measure(&decimation) - total).abs() < 1e-9 * total);
            for vertex in [vertex, onto] {
                assert_eq!(decimation.star(vertex).count(), decimation.degree(vertex));
            }
        }
        assert_eq!((decimation.faces, decimation.degrees), before);
    }

    #[test]
    fn a_sphere_comes_down_to_a_tetrahedron_and_back() {
        [3, 4, 23, 200].into_iter().for_each(|n| comes_down_and_back(&bipyramid(n, 0), 4));
    }

    #[test]
    fn a_disk_comes_down_to_a_triangle_and_back() {
        [4, 5, 23, 200].into_iter().for_each(|n| comes_down_and_back(&bipyramid(n, 1), 3));
        comes_down_and_back(&bipyramid(23, 2), 3);
    }

    #[test]
    fn an_observer_ends_it_early() {
        let mesh = bipyramid(2 * BEAT as u32, 0);
        let mut decimation = Decimation::new(&mesh, vec![1.0; mesh.n_faces()]);
        assert_eq!(decimation.coarsen(&mut |part: f64, _: &str| part == 0.0), None);
        assert_eq!(decimation.collapses.len(), BEAT);
    }
}
