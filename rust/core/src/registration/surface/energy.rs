// SPDX-License-Identifier: MIT OR Apache-2.0
//! The energy of a map between two surfaces, and its derivatives.
//!
//! Each source face counts by its area, with two energies of the same kind: that of the flat face between the images of
//! its corners in space, which is what the map is for, and, times a weight, that of the face in the domain, measured by
//! the target's metric there. The second one sees what the first does not: a face that turns over on the target. It is
//! infinite where a face folds in the domain, and so keeps the descent away from folds. Beyond a slack it counts fully,
//! below it not at all, so that it does not act where the map is good.
//!
//! Vertices add soft landmarks, w |g(v) − place|², and signals, |f(v) − f(g(v))|² by area. Both surfaces have an area
//! of 1.

use super::density::{Expansion, FaceEnergy, Hats, gram, jacobian};
use super::problem::{Pull, SurfaceProblem};
use super::target::{Placed, Root, Target, of_unit_area, product};
use crate::mesh::geometry::triangle;
use crate::mesh::{TriangleMesh, Vertex};
use crate::parallel;
use crate::vector::Vector3;

/// How much the energy in the domain counts.
#[derive(Debug, Clone, Copy)]
pub(super) struct Guard {
    /// Its weight against the energy in space.
    pub weight: f64,
    /// The energy below which it does not count; 0 counts it as it is.
    pub slack: f64,
}

/// The energy of maps of a source onto a target.
pub(super) struct SurfaceEnergy<'a> {
    pub source: &'a TriangleMesh,
    pub target: Target<'a>,
    pub guard: Guard,
    kind: FaceEnergy,
    /// The area of each face, 1 in total.
    pub areas: Vec<f64>,
    hats: Vec<Hats>,
    /// A third of the areas of the faces at each vertex.
    shares: Vec<f64>,
    /// The place in space and the weight of the soft landmarks at each vertex that has any.
    pulls: Vec<(Vertex, Vector3, f64)>,
    problem: &'a SurfaceProblem<'a>,
}

/// The derivatives of the energy of a vertex by itself by its two unknowns.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct VertexExpansion {
    pub gradient: [f64; 2],
    /// (xx, xy, yy).
    pub hessian: [f64; 3],
}

impl<'a> SurfaceEnergy<'a> {
    pub(super) fn new(problem: &'a SurfaceProblem<'a>, guard: Guard) -> Self {
        let (source, kind) = (problem.source, problem.face_energy);
        let points = of_unit_area(source);
        let target = Target::new(problem.target, problem.target_in_domain, problem.domain);
        let total: f64 = source.face_areas().iter().sum();
        let areas: Vec<f64> = source.face_areas().iter().map(|area| area / total).collect();
        let hats = parallel::map(source.n_faces(), |face| hats(triangle(&points, source.faces()[face])));
        let shares = source.vertex_shares(&areas);
        let pull = |pull: &Pull| (pull.vertex, target.points[pull.place], pull.weight);
        let mut pulls: Vec<_> = problem.pulls.iter().map(pull).collect();
        pulls.sort_by_key(|(vertex, _, _)| *vertex);
        Self { source, target, guard, kind, areas, hats, shares, pulls, problem }
    }

    /// The energy of a map.
    pub(super) fn value(&self, map: &[Placed]) -> f64 {
        let of_faces = parallel::sum(self.areas.len(), |face| {
            self.areas[face] * self.face_value(face, self.corners(map, face))
        });
        of_faces + parallel::sum(map.len(), |vertex| self.vertex_value(Vertex::new(vertex), &map[vertex]))
    }

    /// The mean energy of the faces in space alone, 1 for an isometry.
    pub(super) fn mean_distortion(&self, map: &[Placed]) -> f64 {
        parallel::sum(self.areas.len(), |face| {
            let images = self.corners(map, face).map(|placed| placed.point);
            self.areas[face] * self.kind.value(gram(&jacobian(&self.hats[face], images)))
        })
    }

    pub(super) fn corners<'m>(&self, map: &'m [Placed], face: usize) -> [&'m Placed; 3] {
        self.source.faces()[face].map(|vertex| &map[vertex])
    }

    /// Whether a face is folded in the domain.
    pub(super) fn is_folded(corners: [&Placed; 3]) -> bool {
        let [a, b, c] = corners.map(|placed| placed.in_domain);
        a.dot(b.cross(c)) <= LEAST_DETERMINANT
    }

    /// The energy of a face per area, infinite if it is folded.
    pub(super) fn face_value(&self, face: usize, corners: [&Placed; 3]) -> f64 {
        if Self::is_folded(corners) {
            return f64::INFINITY;
        }
        let hats = &self.hats[face];
        let in_space = self.kind.value(gram(&jacobian(hats, corners.map(|placed| placed.point))));
        let metric = self.target.mean_metric(corners);
        let [x, y] = jacobian(hats, corners.map(|placed| placed.in_domain));
        let in_domain = [product(&metric, x, x), product(&metric, x, y), product(&metric, y, y)];
        in_space + self.guard.value(self.kind.value(in_domain))
    }

    /// The energy of a face with its derivatives.
    pub(super) fn face_expansion(
        &self,
        face: usize,
        corners: [&Placed; 3],
        frames: [&[Vector3; 2]; 3],
    ) -> Expansion {
        let (hats, area) = (&self.hats[face], self.areas[face]);
        let images = jacobian(hats, corners.map(|placed| placed.point));
        let (in_space, _) = self.kind.expansion(&images, hats, &frames.map(|frame| *frame));
        let mut sum = Expansion::default();
        sum.add(area, &in_space);
        self.add_guard(&mut sum, face, corners, frames);
        sum
    }

    /// Adds the energy of a face in the domain.
    fn add_guard(&self, sum: &mut Expansion, face: usize, corners: [&Placed; 3], frames: [&[Vector3; 2]; 3]) {
        let (hats, target) = (&self.hats[face], &self.target);
        let root = Root::new(&target.mean_metric(corners));
        let flat = jacobian(hats, corners.map(|placed| placed.in_domain));
        let measured = root.jacobian(&flat);
        let value = self.kind.value(gram(&measured));
        let [slope, curvature] = self.guard.slopes(value);
        if slope == 0.0 {
            return;
        }
        // 1. With the metric as it is
        let changes: [[[f64; 3]; 2]; 3] = std::array::from_fn(|k| {
            frames[k].map(|axis| target.coordinates(corners[k].location.triangle, axis))
        });
        let moves =
            std::array::from_fn(|k| changes[k].map(|change| root.apply(target.pushed(corners[k], change))));
        let (mut expansion, by_metric) = self.kind.expansion(&measured, hats, &moves);
        // 2. The metric changes with the place
        for k in 0..3 {
            let slopes = target.corner_metrics(&corners[k].location).map(|metric| {
                let [x, y] = flat;
                let entries = [product(metric, x, x), product(metric, x, y), product(metric, y, y)];
                (0..3).map(|i| by_metric[i] * entries[i]).sum::<f64>() / 3.0
            });
            for d in 0..2 {
                expansion.gradient[2 * k + d] += (0..3).map(|i| changes[k][d][i] * slopes[i]).sum::<f64>();
            }
        }
        // 3. What counts of it
        let area = self.areas[face];
        expansion.value = self.guard.value(value) / slope;
        sum.add(area * slope, &expansion);
        sum.add_square(area * curvature, &expansion.gradient);
    }

    /// The energy of a vertex by itself.
    pub(super) fn vertex_value(&self, vertex: Vertex, placed: &Placed) -> f64 {
        let pulled: f64 = self
            .pulls_at(vertex)
            .iter()
            .map(|(_, place, weight)| weight * (placed.point - *place).dot(placed.point - *place))
            .sum();
        let signals = &self.problem.signals;
        let difference = |k: usize| self.signal_difference(k, vertex, placed);
        pulled + self.shares[vertex] * (0..signals.width).map(|k| difference(k).powi(2)).sum::<f64>()
    }

    /// The derivatives of the energy of a vertex by itself.
    pub(super) fn vertex_expansion(
        &self,
        vertex: Vertex,
        placed: &Placed,
        frame: &[Vector3; 2],
    ) -> VertexExpansion {
        let mut sum = VertexExpansion::default();
        for (_, place, weight) in self.pulls_at(vertex) {
            let away = placed.point - *place;
            (0..2).for_each(|d| sum.gradient[d] += 2.0 * weight * away.dot(frame[d]));
            let products = [frame[0].dot(frame[0]), frame[0].dot(frame[1]), frame[1].dot(frame[1])];
            (0..3).for_each(|i| sum.hessian[i] += 2.0 * weight * products[i]);
        }
        let width = self.problem.signals.width;
        if width == 0 {
            return sum;
        }
        let face = placed.location.triangle;
        let changes = frame.map(|axis| self.target.coordinates(face, axis));
        let corners = self.target.faces()[face];
        for k in 0..width {
            let at = |vertex: Vertex| self.problem.signals.target[width * vertex.index() + k];
            let slope = changes.map(|change| (0..3).map(|i| change[i] * at(corners[i])).sum::<f64>());
            let factor = 2.0 * self.shares[vertex];
            let difference = self.signal_difference(k, vertex, placed);
            (0..2).for_each(|d| sum.gradient[d] += factor * difference * slope[d]);
            let products = [slope[0] * slope[0], slope[0] * slope[1], slope[1] * slope[1]];
            (0..3).for_each(|i| sum.hessian[i] += factor * products[i]);
        }
        sum
    }

    /// The energy of the faces around a vertex and of the vertex itself, if it were at another place; infinite once it
    /// exceeds `limit`.
    pub(super) fn star_value(&self, map: &[Placed], vertex: Vertex, placed: &Placed, limit: f64) -> f64 {
        let mut sum = self.vertex_value(vertex, placed);
        for corner in self.source.vertex_corners(vertex) {
            let face = corner.face();
            let corners = self.source.faces()[face].map(|v| if v == vertex { placed } else { &map[v] });
            sum += self.areas[face] * self.face_value(face.index(), corners);
            if sum > limit {
                return f64::INFINITY;
            }
        }
        sum
    }

    fn signal_difference(&self, k: usize, vertex: Vertex, placed: &Placed) -> f64 {
        let signals = &self.problem.signals;
        let at = |vertex: Vertex| signals.target[signals.width * vertex.index() + k];
        let corners = self.target.faces()[placed.location.triangle];
        let there: f64 = (0..3).map(|i| placed.location.barycentric[i] * at(corners[i])).sum();
        there - signals.source[signals.width * vertex.index() + k]
    }

    fn pulls_at(&self, vertex: Vertex) -> &[(Vertex, Vector3, f64)] {
        let first = self.pulls.partition_point(|pull| pull.0 < vertex);
        let end = self.pulls.partition_point(|pull| pull.0 <= vertex);
        &self.pulls[first..end]
    }
}

/// Determinant of the corners of a face in the domain below which it counts as folded, above the rounding of the exact
/// test.
const LEAST_DETERMINANT: f64 = 1e-15;

impl Guard {
    /// What counts of an energy φ: with the slack s, (φ − s)²/φ beyond s.
    fn value(&self, energy: f64) -> f64 {
        let excess = (energy - self.slack).max(0.0);
        self.weight * excess * excess / energy
    }

    /// The first two derivatives of what counts.
    fn slopes(&self, energy: f64) -> [f64; 2] {
        if energy <= self.slack {
            return [0.0; 2];
        }
        let ratio = self.slack / energy;
        [self.weight * (1.0 - ratio * ratio), self.weight * 2.0 * ratio * ratio / energy]
    }
}

/// The gradients of the corners' functions in the plane of a face, its first edge along the first axis.
fn hats([a, b, c]: [Vector3; 3]) -> Hats {
    let (p, q) = (b - a, c - a);
    let length = p.norm();
    let (x, y) = (p.dot(q) / length, p.cross(q).norm() / length);
    let second = [1.0 / length, -x / (length * y)];
    let third = [0.0, 1.0 / y];
    [[-second[0] - third[0], -second[1] - third[1]], second, third]
}
