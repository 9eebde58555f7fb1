// SPDX-License-Identifier: MIT OR Apache-2.0
//! Decimation of a closed surface of genus 0 to a tetrahedron, and its undoing one vertex at a time.
//!
//! Half-edge collapses: a vertex v moves onto a neighbour w, and the two faces between them vanish. A
//! collapse keeps the surface a sphere where v and w have exactly two common neighbours (link condition);
//! with more than four vertices there always is one. The next vertex is the one whose star has least target
//! measure, weighed by its degree and the shapes it would leave, so that the vertices of every coarse mesh
//! are spread evenly over the measure.
//!
//! The measure of a star is handed on to the faces that fill it, so the sum over all faces stays the same.
//!
//! Cost: O(n log n), about fifty shapes looked at for each vertex.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::TriangleMesh;
use super::geometry::{Vector, area, dot, sub, triangle};

/// A mesh that loses vertices by [`Decimation::coarsen`] and gets them back by [`Decimation::refine`].
#[derive(Debug)]
pub(crate) struct Decimation<'a> {
    points: &'a [Vector],
    faces: Vec<[u32; 3]>,
    targets: Vec<f64>,
    /// The faces at each vertex; of a vertex that is gone, those it had.
    stars: Vec<Vec<u32>>,
    gone: Vec<bool>,
    collapses: Vec<Collapse>,
    /// The targets of the stars before each collapse, one after the other.
    old_targets: Vec<f64>,
}

/// A vertex that moved onto a neighbour.
#[derive(Debug, Clone, Copy)]
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

impl<'a> Decimation<'a> {
    /// The whole mesh with its targets, before any collapse.
    pub(crate) fn new(mesh: &'a TriangleMesh, targets: Vec<f64>) -> Self {
        let star = |vertex: usize| mesh.vertex_corners(vertex).iter().map(|&corner| corner / 3).collect();
        Self {
            points: mesh.points(),
            faces: mesh.faces().to_vec(),
            targets,
            stars: (0..mesh.n_vertices()).map(star).collect(),
            gone: vec![false; mesh.n_vertices()],
            collapses: Vec::with_capacity(mesh.n_vertices()),
            old_targets: Vec::new(),
        }
    }

    /// The faces at a vertex, each by the two others of its corners in order, with their targets.
    pub(crate) fn star(&self, vertex: u32) -> impl Iterator<Item = (u32, u32, f64)> {
        self.stars[vertex as usize].iter().map(move |&face| {
            let corners = self.faces[face as usize];
            let k =
                corners.iter().position(|&corner| corner == vertex).expect("a star's faces have its vertex");
            (corners[(k + 1) % 3], corners[(k + 2) % 3], self.targets[face as usize])
        })
    }

    /// Whether a vertex has been collapsed.
    pub(crate) fn is_gone(&self, vertex: u32) -> bool {
        self.gone[vertex as usize]
    }

    /// Collapses vertices until `left` are left, or until none can be collapsed.
    pub(crate) fn coarsen(&mut self, left: usize) {
        let n = self.stars.len();
        let mut queue: BinaryHeap<Reverse<Candidate>> = BinaryHeap::with_capacity(n);
        let mut costs: Vec<f64> = (0..n as u32).map(|vertex| self.best_collapse(vertex).0).collect();
        queue.extend((0..n as u32).map(|vertex| Reverse(Candidate { cost: costs[vertex as usize], vertex })));
        while n - self.collapses.len() > left {
            let Some(Reverse(Candidate { cost, vertex })) = queue.pop() else { return };
            // 1. Out of date?
            if self.gone[vertex as usize] || cost != costs[vertex as usize] {
                continue;
            }
            let (now, onto) = self.best_collapse(vertex);
            if now > cost {
                costs[vertex as usize] = now;
                queue.push(Reverse(Candidate { cost: now, vertex }));
                continue;
            }
            let Some(onto) = onto else { continue };
            // 2. Collapse, and look at the ring anew
            let ring: Vec<u32> = self.star(vertex).map(|(next, _, _)| next).collect();
            self.collapse(Collapse { vertex, onto });
            for vertex in ring {
                let cost = self.best_collapse(vertex).0;
                costs[vertex as usize] = cost;
                queue.push(Reverse(Candidate { cost, vertex }));
            }
        }
    }

    /// Takes the last collapse back and returns it; `None` once all are undone.
    pub(crate) fn refine(&mut self) -> Option<Collapse> {
        let collapse = self.collapses.pop()?;
        let Collapse { vertex, onto } = collapse;
        let star = std::mem::take(&mut self.stars[vertex as usize]);
        for &face in &star {
            let corners = &mut self.faces[face as usize];
            if corners.contains(&vertex) {
                // one of the two that vanished
                let ends = corners.iter().copied().filter(|&corner| corner != vertex);
                ends.for_each(|corner| self.stars[corner as usize].push(face));
            } else {
                corners.iter_mut().filter(|corner| **corner == onto).for_each(|corner| *corner = vertex);
                self.stars[onto as usize].retain(|&other| other != face);
            }
        }
        let begin = self.old_targets.len() - star.len();
        for (&face, target) in star.iter().zip(self.old_targets.drain(begin..)) {
            self.targets[face as usize] = target;
        }
        self.stars[vertex as usize] = star;
        self.gone[vertex as usize] = false;
        Some(collapse)
    }

    fn collapse(&mut self, collapse: Collapse) {
        let Collapse { vertex, onto } = collapse;
        let star = std::mem::take(&mut self.stars[vertex as usize]);
        let measure: f64 = star.iter().map(|&face| self.targets[face as usize]).sum();
        self.old_targets.extend(star.iter().map(|&face| self.targets[face as usize]));
        let (vanishing, staying): (Vec<u32>, Vec<u32>) =
            star.iter().partition(|&&face| self.faces[face as usize].contains(&onto));
        for &face in &vanishing {
            let ends = self.faces[face as usize].into_iter().filter(|&corner| corner != vertex);
            ends.for_each(|corner| self.stars[corner as usize].retain(|&other| other != face));
            self.targets[face as usize] = 0.0;
        }
        for &face in &staying {
            let corners = &mut self.faces[face as usize];
            corners.iter_mut().filter(|corner| **corner == vertex).for_each(|corner| *corner = onto);
            self.stars[onto as usize].push(face);
        }
        self.share_out(&staying, measure);
        self.stars[vertex as usize] = star;
        self.gone[vertex as usize] = true;
        self.collapses.push(collapse);
    }

    /// Half of a measure in equal parts, half by area.
    fn share_out(&mut self, faces: &[u32], measure: f64) {
        let areas: Vec<f64> =
            faces.iter().map(|&face| area(triangle(self.points, self.faces[face as usize]))).collect();
        let total: f64 = areas.iter().sum();
        let equal = 1.0 / faces.len() as f64;
        for (&face, area) in faces.iter().zip(areas) {
            let by_area = if total > 0.0 { area / total } else { equal };
            self.targets[face as usize] = 0.5 * measure * (by_area + equal);
        }
    }

    /// What it costs to collapse a vertex and onto which neighbour; infinite where it cannot be.
    fn best_collapse(&self, vertex: u32) -> (f64, Option<u32>) {
        let star: Vec<(u32, u32, f64)> = self.star(vertex).collect();
        let shape = |onto: u32| {
            let degree = (self.stars[onto as usize].len() + star.len()) as f64 - 4.0;
            (1.0 / (self.worst_shape(&star, onto) + 0.05)) * (1.0 + 0.05 * (degree - 7.0).max(0.0).powi(2))
        };
        let allowed =
            star.iter().map(|&(next, _, _)| next).filter(|&onto| self.keeps_the_sphere(&star, onto));
        let best =
            allowed.map(|onto| (shape(onto), onto)).min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let Some((shape, onto)) = best else { return (f64::INFINITY, None) };
        let measure: f64 = star.iter().map(|&(_, _, target)| target).sum();
        let degree = 1.0 + 0.15 * (star.len() as f64 - 6.0).max(0.0).powi(2);
        (measure * degree * shape.sqrt(), Some(onto))
    }

    /// The link condition: exactly two common neighbours, and the surface keeps four vertices.
    fn keeps_the_sphere(&self, star: &[(u32, u32, f64)], onto: u32) -> bool {
        let is_neighbour = |other: u32| star.iter().any(|&(next, _, _)| next == other);
        self.star(onto).filter(|&(next, _, _)| is_neighbour(next)).count() == 2
    }

    /// 4√3·area/Σ edge² of the worst face that a collapse of the star onto `onto` makes; 1 is equilateral.
    fn worst_shape(&self, star: &[(u32, u32, f64)], onto: u32) -> f64 {
        let kept = star.iter().filter(|&&(one, two, _)| one != onto && two != onto);
        let shapes = kept.map(|&(one, two, _)| {
            let [a, b, c] = triangle(self.points, [onto, one, two]);
            let squares: f64 = [sub(b, a), sub(c, b), sub(a, c)].iter().map(|&edge| dot(edge, edge)).sum();
            if squares > 0.0 { 4.0 * 3f64.sqrt() * area([a, b, c]) / squares } else { 0.0 }
        });
        shapes.fold(1.0, f64::min)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A bipyramid over a polygon of n corners, all on the unit sphere.
    fn bipyramid(n: u32) -> TriangleMesh {
        let corner = |i: u32| {
            let angle = std::f64::consts::TAU * f64::from(i) / f64::from(n);
            [angle.cos(), angle.sin(), 0.05 * (3.0 * angle).sin()]
        };
        let vertices: Vec<Vector> = (0..n).map(corner).chain([[0., 0., 1.], [0., 0., -1.]]).collect();
        let faces: Vec<[u32; 3]> =
            (0..n).flat_map(|i| [[i, (i + 1) % n, n], [(i + 1) % n, i, n + 1]]).collect();
        TriangleMesh::new(&vertices, &faces).unwrap()
    }

    #[test]
    fn a_sphere_comes_down_to_a_tetrahedron_and_back() {
        let mesh = bipyramid(23);
        let targets: Vec<f64> = (0..mesh.n_faces()).map(|face| 1.0 + face as f64).collect();
        let total: f64 = targets.iter().sum();
        let mut decimation = Decimation::new(&mesh, targets.clone());
        decimation.coarsen(4);
        assert_eq!(decimation.collapses.len(), mesh.n_vertices() - 4);
        assert!((decimation.targets.iter().sum::<f64>() - total).abs() < 1e-9 * total);
        let left: Vec<usize> = (0..mesh.n_vertices()).filter(|&v| !decimation.is_gone(v as u32)).collect();
        assert!(left.iter().all(|&v| decimation.stars[v].len() == 3));
        while decimation.refine().is_some() {
            assert!((decimation.targets.iter().sum::<f64>() - total).abs() < 1e-9 * total);
        }
        assert_eq!(decimation.faces, mesh.faces());
        assert_eq!(decimation.targets, targets);
        for vertex in 0..mesh.n_vertices() {
            let mut star = decimation.stars[vertex].clone();
            star.sort_unstable();
            let given: Vec<u32> = mesh.vertex_corners(vertex).iter().map(|corner| corner / 3).collect();
            assert_eq!(star, given);
        }
    }
}
