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

use crate::mesh::corners::{next_corner, previous_corner};
use crate::mesh::geometry::{area, triangle};
use crate::mesh::ties::tie_breakers;
use crate::mesh::{TriangleMesh, Vertex};

/// A mesh that loses vertices by [`Decimation::coarsen`] and gets them back by [`Decimation::refine`].
#[derive(Debug)]
pub(crate) struct Decimation<'a> {
    mesh: &'a TriangleMesh,
    /// The faces of the mesh, then those at the apex.
    faces: Vec<Face>,
    /// A corner at each vertex; for a collapsed vertex the corner whose next corner it collapsed onto.
    corners: Vec<u32>,
    /// The degree of each vertex; for a collapsed vertex its last degree.
    degrees: Vec<u32>,
    gone: Vec<bool>,
    collapses: Vec<Collapse>,
    /// The targets that the collapses changed, in their order.
    old_targets: Vec<f64>,
    /// The factor of the costs at each vertex, which differs between symmetric parts.
    tie_breakers: Vec<f64>,
}

/// A face with all data for a turn around a vertex, half a cache line.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Face {
    vertices: [Vertex; 3],
    /// The corner across the edge opposite to each corner.
    twins: [u32; 3],
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
        let twin = |corner| mesh.opposite(corner).unwrap_or_default();
        let faces = mesh.faces().iter().zip(targets).zip((0..).step_by(3));
        let face = |((&vertices, target), corner): ((&[Vertex; 3], f64), u32)| Face {
            vertices,
            twins: [corner, corner + 1, corner + 2].map(twin),
            target,
        };
        let mut whole = Self {
            mesh,
            faces: faces.map(face).collect(),
            corners: Vertex::all(n).map(|vertex| mesh.vertex_corners(vertex)[0]).collect(),
            degrees: Vertex::all(n).map(|vertex| mesh.vertex_corners(vertex).len() as u32).collect(),
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
        let (apex, first) = (self.apex(), 3 * self.faces.len() as u32);
        let end = first + 3 * boundary.len() as u32;
        for (k, &vertex) in boundary.iter().enumerate() {
            let next = boundary[(k + 1) % boundary.len()];
            let along = |&&corner: &&u32| {
                self.vertex(next_corner(corner)) == next
                    && self.mesh.opposite(previous_corner(corner)).is_none()
            };
            let corner = self.mesh.vertex_corners(vertex).iter().find(along);
            let across = previous_corner(*corner.expect("the loop runs along boundary edges"));
            let face = first + 3 * k as u32;
            let [before, behind] =
                [if k == 0 { end } else { face } - 3, if face + 3 == end { first } else { face + 3 }];
            let twins = [before + 1, behind, across];
            self.faces.push(Face { vertices: [next, vertex, apex], twins, target: 0.0 });
            *self.twin_mut(across) = face + 2;
            self.degrees[vertex] += 2;
        }
        self.corners.push(first + 2);
        self.degrees.push(boundary.len() as u32);
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
            let ends = [next_corner(corner), previous_corner(corner)].map(|corner| self.vertex(corner));
            (ends[0], ends[1], self.faces[corner as usize / 3].target)
        })
    }

    /// The number of neighbors of a vertex.
    pub(crate) fn degree(&self, vertex: Vertex) -> usize {
        self.degrees[vertex] as usize
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
        for corner in self.dead_faces(corner).into_iter().flat_map(|face| 3 * face..3 * face + 3) {
            let across = self.twin(corner);
            *self.twin_mut(across) = corner;
        }
        // 2. Give the star its vertex back
        let mut current = corner;
        loop {
            self.faces[current as usize / 3].vertices[current as usize % 3] = vertex;
            current = self.turned(current);
            if current == corner {
                break;
            }
        }
        self.corners[onto] = next_corner(corner);
        self.gone[vertex] = false;
        self.count_neighbors(collapse, corner, 1);
        // 3. Give the star its measure back
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
        self.count_neighbors(collapse, corner, -1);
        // 1. Give the star its new vertex
        let mut last = corner;
        loop {
            self.faces[last as usize / 3].vertices[last as usize % 3] = collapse.onto;
            let next = self.turned(last);
            if next == corner {
                break;
            }
            last = next;
        }
        // 2. Join the faces beside each dead face
        for [one, two] in [[corner, next_corner(corner)], [last, previous_corner(last)]] {
            let [one, two] = [one, two].map(|corner| self.twin(corner));
            *self.twin_mut(one) = two;
            *self.twin_mut(two) = one;
            for corner in [next_corner(two), previous_corner(two)] {
                let vertex = self.vertex(corner);
                self.corners[vertex] = corner;
            }
        }
        // 3. Share the measure among the remaining faces
        let measure: f64 = heirs.iter().map(|&face| self.faces[face as usize].target).sum();
        self.old_targets.extend(heirs.iter().map(|&face| self.faces[face as usize].target));
        dead.into_iter().for_each(|face| self.faces[face as usize].target = 0.0);
        self.share_out(heirs.into_iter().filter(|face| !dead.contains(face)), measure);
        // 4. Record the collapse
        self.corners[collapse.vertex] = corner;
        self.gone[collapse.vertex] = true;
        self.collapses.push(collapse);
    }

    /// Shares out half of a measure in equal parts, half by area.
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

    /// Updates the degrees of a vertex's neighbors when it comes back (`sign` 1) or collapses (−1).
    fn count_neighbors(&mut self, collapse: Collapse, corner: u32, sign: i32) {
        let beyond = self.degrees[collapse.vertex] as i32 - 4;
        let across = self.twin(previous_corner(corner));
        let beside = [previous_corner(corner), across].map(|corner| (self.vertex(corner), sign));
        for (vertex, change) in beside.into_iter().chain([(collapse.onto, -sign * beyond)]) {
            let degree = &mut self.degrees[vertex];
            *degree = degree.wrapping_add_signed(change);
        }
    }

    /// The faces that share the measure of the star around a corner: those of the star that are not at the apex; where there
    /// is only one, also the face across from the vertex, which inherits it.
    fn measured_faces(&self, corner: u32) -> impl Iterator<Item = u32> {
        let star = self.around(corner).filter(|&corner| (corner as usize) < 3 * self.mesh.n_faces());
        let is_ear = star.clone().nth(1).is_none();
        let heir = star.clone().next().filter(|_| is_ear).map(|corner| self.twin(corner));
        star.chain(heir).map(|corner| corner / 3)
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

    fn vertex(&self, corner: u32) -> Vertex {
        self.faces[corner as usize / 3].vertices[corner as usize % 3]
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
