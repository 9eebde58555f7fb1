// SPDX-License-Identifier: MIT OR Apache-2.0
//! Decimation of a closed surface of genus 0 to a tetrahedron, undone one vertex at a time.
//!
//! Half-edge collapses: a vertex v moves onto a neighbor w, and the two faces between them vanish. A
//! collapse keeps the surface a sphere where v and w have exactly two common neighbors (link condition);
//! with more than four vertices there always is one. The next vertex is the one whose star has least target
//! measure, weighed by its degree and the shapes it would leave, so that the vertices of every coarse mesh
//! are spread evenly over the measure. The faces that fill a star inherit its measure, so the sum over all
//! faces is constant.
//!
//! A surface with one boundary loop is closed by an apex, a vertex without place or measure that is joined
//! to the whole loop. The apex never collapses, and a vertex of the loop only onto a neighbor in the loop.
//!
//! Cost: O(n log n), with the costs of about four vertices computed per collapse.

mod coarsen;

use crate::mesh::geometry::{area, triangle};
use crate::mesh::ties::tie_breakers;
use crate::mesh::{Corner, Face, TriangleMesh, Vertex};

/// A mesh that loses vertices by [`Decimation::coarsen`] and gets them back by [`Decimation::refine`].
#[derive(Debug, Clone)]
pub(crate) struct Decimation<'a> {
    mesh: &'a TriangleMesh,
    /// The faces of the mesh, then those at the apex.
    faces: Vec<Triangle>,
    /// A corner at each vertex; for a collapsed vertex the corner whose next corner it collapsed onto.
    corners: Vec<Corner>,
    /// The degree of each vertex; for a collapsed vertex its last degree.
    degrees: Vec<usize>,
    gone: Vec<bool>,
    collapses: Vec<Collapse>,
    /// The targets that the collapses changed, in their order.
    old_targets: Vec<f64>,
    /// The factor of the costs at each vertex, which differs between symmetric parts.
    tie_breakers: Vec<f64>,
}

/// A face with all data for a turn around a vertex, half a cache line.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Triangle {
    vertices: [Vertex; 3],
    /// The corner across the edge opposite to each corner.
    twins: [Corner; 3],
    target: f64,
}

/// The collapse of a vertex onto a neighbor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Collapse {
    /// The vertex that collapsed.
    pub vertex: Vertex,
    /// The neighbor onto which it collapsed.
    pub onto: Vertex,
}

impl<'a> Decimation<'a> {
    /// The whole mesh with its targets, before any collapse: a sphere, or a disk, which gets its apex.
    pub(crate) fn new(mesh: &'a TriangleMesh, targets: Vec<f64>) -> Self {
        let n = mesh.n_vertices();
        // the corners of a boundary get a twin when the apex closes it
        let twin = |corner| mesh.opposite(corner).unwrap_or_default();
        let triangle = |(face, target): (Face, f64)| Triangle {
            vertices: mesh.faces()[face],
            twins: face.corners().map(twin),
            target,
        };
        let mut whole = Self {
            mesh,
            faces: Face::all(mesh.n_faces()).zip(targets).map(triangle).collect(),
            corners: Vertex::all(n).map(|vertex| mesh.vertex_corners(vertex)[0]).collect(),
            degrees: Vertex::all(n).map(|vertex| mesh.vertex_corners(vertex).len()).collect(),
            gone: vec![false; n],
            collapses: Vec::with_capacity(n),
            old_targets: Vec::with_capacity(6 * n),
            tie_breakers: tie_breakers(mesh.points()),
        };
        mesh.boundary_loops().first().into_iter().for_each(|boundary| whole.close(boundary));
        whole
    }

    /// Joins the boundary loop to the apex.
    fn close(&mut self, boundary: &[Vertex]) {
        let (apex, first, n) = (self.apex(), self.faces.len(), boundary.len());
        let face = |k: usize| Face::new(first + k % n);
        for (k, &vertex) in boundary.iter().enumerate() {
            let next = boundary[(k + 1) % n];
            let along = |corner: &&Corner| {
                self.vertex(corner.next()) == next && self.mesh.opposite(corner.previous()).is_none()
            };
            let corner = self.mesh.vertex_corners(vertex).iter().find(along);
            let across = corner.expect("the loop runs along boundary edges").previous();
            let twins = [face(k + n - 1).corner(1), face(k + 1).corner(0), across];
            self.faces.push(Triangle { vertices: [next, vertex, apex], twins, target: 0.0 });
            *self.twin_mut(across) = face(k).corner(2);
            self.degrees[vertex] += 2;
        }
        self.corners.push(face(0).corner(2));
        self.degrees.push(n);
        self.gone.push(false);
    }

    /// The tie breaker between vertices in symmetric places; larger for the preferred vertex.
    pub(crate) fn preference(&self, vertex: Vertex) -> f64 {
        self.tie_breakers[vertex]
    }

    /// The vertex that closes a disk.
    pub(crate) fn apex(&self) -> Vertex {
        Vertex::new(self.mesh.n_vertices())
    }

    /// The faces at a vertex, counter-clockwise, each as its two other vertices in order and its target.
    pub(crate) fn star(&self, vertex: Vertex) -> impl Iterator<Item = (Vertex, Vertex, f64)> {
        self.around(self.corners[vertex]).map(|corner| {
            let ends = [corner.next(), corner.previous()].map(|corner| self.vertex(corner));
            (ends[0], ends[1], self.faces[corner.face()].target)
        })
    }

    /// The faces that are left, those at the apex aside.
    pub(crate) fn faces(&self) -> impl Iterator<Item = [Vertex; 3]> {
        // a face that is gone has a corner that no neighbor knows
        Face::all(self.mesh.n_faces())
            .filter(|face| face.corners().into_iter().all(|corner| self.twin(self.twin(corner)) == corner))
            .map(|face| self.faces[face].vertices)
    }

    /// The number of neighbors of a vertex.
    pub(crate) fn degree(&self, vertex: Vertex) -> usize {
        self.degrees[vertex]
    }

    /// True if a vertex has been collapsed.
    pub(crate) fn is_gone(&self, vertex: Vertex) -> bool {
        self.gone[vertex]
    }

    /// Takes the last collapse back and returns it; `None` once all are undone.
    pub(crate) fn refine(&mut self) -> Option<Collapse> {
        let collapse = self.collapses.pop()?;
        let Collapse { vertex, onto } = collapse;
        let corner = self.corners[vertex];
        // 1. Put the dead faces back between their neighbors
        for corner in self.dead_faces(corner).into_iter().flat_map(Face::corners) {
            let across = self.twin(corner);
            *self.twin_mut(across) = corner;
        }
        // 2. Give the star its vertex back
        let mut current = corner;
        loop {
            self.faces[current.face()].vertices[current.place()] = vertex;
            current = self.turned(current);
            if current == corner {
                break;
            }
        }
        self.corners[onto] = corner.next();
        self.gone[vertex] = false;
        self.count_neighbors(collapse, corner, 1);
        // 3. Give the star its measure back
        let faces: Vec<Face> = self.measured_faces(corner).collect();
        let begin = self.old_targets.len() - faces.len();
        for (face, target) in faces.into_iter().zip(self.old_targets.drain(begin..)) {
            self.faces[face].target = target;
        }
        Some(collapse)
    }

    /// Moves the vertex at a corner onto that of the next corner.
    fn collapse(&mut self, corner: Corner) {
        let collapse = Collapse { vertex: self.vertex(corner), onto: self.vertex(corner.next()) };
        let dead = self.dead_faces(corner);
        let heirs: Vec<Face> = self.measured_faces(corner).collect();
        self.count_neighbors(collapse, corner, -1);
        // 1. Give the star its new vertex
        let mut last = corner;
        loop {
            self.faces[last.face()].vertices[last.place()] = collapse.onto;
            let next = self.turned(last);
            if next == corner {
                break;
            }
            last = next;
        }
        // 2. Join the faces beside each dead face
        for [one, two] in [[corner, corner.next()], [last, last.previous()]] {
            let [one, two] = [one, two].map(|corner| self.twin(corner));
            *self.twin_mut(one) = two;
            *self.twin_mut(two) = one;
            for corner in [two.next(), two.previous()] {
                let vertex = self.vertex(corner);
                self.corners[vertex] = corner;
            }
        }
        // 3. Share the measure among the remaining faces
        let measure: f64 = heirs.iter().map(|&face| self.faces[face].target).sum();
        self.old_targets.extend(heirs.iter().map(|&face| self.faces[face].target));
        dead.into_iter().for_each(|face| self.faces[face].target = 0.0);
        self.share_out(heirs.into_iter().filter(|face| !dead.contains(face)), measure);
        // 4. Record the collapse
        self.corners[collapse.vertex] = corner;
        self.gone[collapse.vertex] = true;
        self.collapses.push(collapse);
    }

    /// Shares out half of a measure in equal parts, half by area.
    fn share_out(&mut self, faces: impl Iterator<Item = Face> + Clone, measure: f64) {
        let face_area = |face: Face| area(triangle(self.mesh.points(), self.faces[face].vertices));
        let areas: Vec<f64> = faces.clone().map(face_area).collect();
        let total: f64 = areas.iter().sum();
        let equal = 1.0 / areas.len() as f64;
        for (face, area) in faces.zip(areas) {
            let by_area = if total > 0.0 { area / total } else { equal };
            self.faces[face].target = 0.5 * measure * (by_area + equal);
        }
    }

    /// Updates the degrees of a vertex's neighbors when it comes back (`sign` 1) or collapses (−1).
    fn count_neighbors(&mut self, collapse: Collapse, corner: Corner, sign: isize) {
        let beyond = self.degrees[collapse.vertex] as isize - 4;
        let across = self.twin(corner.previous());
        let beside = [corner.previous(), across].map(|corner| (self.vertex(corner), sign));
        for (vertex, change) in beside.into_iter().chain([(collapse.onto, -sign * beyond)]) {
            let degree = &mut self.degrees[vertex];
            *degree = degree.wrapping_add_signed(change);
        }
    }

    /// The faces that share the measure of the star around a corner: those of the star that are not at the apex; where
    /// there is only one, also the face across from the vertex, which inherits it.
    fn measured_faces(&self, corner: Corner) -> impl Iterator<Item = Face> {
        let star = self.around(corner).filter(|corner| corner.face().index() < self.mesh.n_faces());
        let is_ear = star.clone().nth(1).is_none();
        let heir = star.clone().next().filter(|_| is_ear).map(|corner| self.twin(corner));
        star.chain(heir).map(Corner::face)
    }

    /// The faces on both sides of the edge from the vertex at a corner to that of the next corner.
    fn dead_faces(&self, corner: Corner) -> [Face; 2] {
        [corner.face(), self.twin(corner.previous()).face()]
    }

    /// The corners at one vertex, counter-clockwise.
    fn around(&self, first: Corner) -> impl Iterator<Item = Corner> + Clone {
        std::iter::successors(Some(first), move |&corner| {
            Some(self.turned(corner)).filter(|&turned| turned != first)
        })
    }

    /// The next corner at the same vertex, counter-clockwise.
    fn turned(&self, corner: Corner) -> Corner {
        self.twin(corner.next()).next()
    }

    fn twin(&self, corner: Corner) -> Corner {
        self.faces[corner.face()].twins[corner.place()]
    }

    fn twin_mut(&mut self, corner: Corner) -> &mut Corner {
        &mut self.faces[corner.face()].twins[corner.place()]
    }

    fn vertex(&self, corner: Corner) -> Vertex {
        self.faces[corner.face()].vertices[corner.place()]
    }
}

#[cfg(test)]
mod tests {
    use super::coarsen::BEAT;
    use super::*;
    use crate::control::Silent;

    /// A bipyramid over a polygon of n corners, all on the unit sphere; without the first `open` faces.
    fn bipyramid(n: u32, open: usize) -> TriangleMesh {
        let corner = |i: u32| {
            let angle = std::f64::consts::TAU * f64::from(i) / f64::from(n);
            [angle.cos(), angle.sin(), 0.05 * (3.0 * angle).sin()]
        };
        let vertices: Vec<[f64; 3]> = (0..n).map(corner).chain([[0., 0., 1.], [0., 0., -1.]]).collect();
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
        let remaining: Vec<Vertex> =
            Vertex::all(mesh.n_vertices()).filter(|&v| !decimation.is_gone(v)).collect();
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
