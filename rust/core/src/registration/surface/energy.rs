// SPDX-License-Identifier: MIT OR Apache-2.0
//! The energy of a map between two surfaces, and its derivatives.
//!
//! Each source face counts by its area, with two energies of the same kind: that of the flat face between the images of
//! its corners in space, or of its parts where it spans many faces of the target, which is what the map is for, and,
//! times a weight, that of the face in the domain, measured by the target's metric there. The second one sees what the
//! first does not: a face that turns over on the target. It is infinite where a face folds in the domain, and so keeps
//! the descent away from folds. Beyond a slack it counts fully, below it not at all, so that it does not act where the
//! map is good.
//!
//! Vertices add soft landmarks, w |g(v) − place|², and signals, |f(v) − f(g(v))|² by area. Both surfaces have an area
//! of 1.

use super::density::{Expansion, FaceEnergy, Hats, gram, jacobian};
use super::problem::{Pull, SurfaceProblem};
use super::subdivision::{Subdivision, is_much_finer};
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
    /// Faces that do not count, since they are folded at the start.
    left_out: Vec<bool>,
    /// How faces are split that span many of the target.
    subdivision: Subdivision<'a>,
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
        let source = problem.source;
        let both_ways = is_much_finer(problem.target, source);
        let kind = FaceEnergy { both_ways, ..problem.face_energy };
        let points = of_unit_area(source);
        let target = Target::new(problem.target, problem.target_in_domain, problem.domain);
        let total: f64 = source.face_areas().iter().sum();
        let areas: Vec<f64> = source.face_areas().iter().map(|area| area / total).collect();
        let hats = parallel::map(source.n_faces(), |face| hats(triangle(&points, source.faces()[face])));
        let shares = source.vertex_shares(&areas);
        let pull = |pull: &Pull| (pull.vertex, target.points[pull.place], pull.weight);
        let mut pulls: Vec<_> = problem.pulls.iter().map(pull).collect();
        pulls.sort_by_key(|(vertex, _, _)| *vertex);
        let left_out = vec![false; source.n_faces()];
        let subdivision = Subdivision::none(source.n_faces());
        Self { source, target, guard, kind, areas, hats, left_out, subdivision, shares, pulls, problem }
    }

    /// Leaves out the faces that are folded by a map; returns them.
    pub(super) fn leave_out_folded(&mut self, map: &[Placed]) -> Vec<usize> {
        self.left_out = parallel::map(self.areas.len(), |face| Self::is_folded(self.corners(map, face)));
        (0..self.areas.len()).filter(|&face| self.left_out[face]).collect()
    }

    /// Splits the faces that span many of the target by a map, for all maps from now on.
    pub(super) fn subdivide(&mut self, map: &[Placed]) {
        self.subdivision = Subdivision::new(self.source, &self.target, map);
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
    fn is_folded(corners: [&Placed; 3]) -> bool {
        let [a, b, c] = corners.map(|placed| placed.in_domain);
        a.dot(b.cross(c)) <= LEAST_DETERMINANT
    }

    /// The energy of each face per area.
    pub(super) fn face_values(&self, map: &[Placed]) -> Vec<f64> {
        parallel::map(self.areas.len(), |face| self.face_value(face, self.corners(map, face)))
    }

    /// The energy of a face per area, infinite if it is folded.
    pub(super) fn face_value(&self, face: usize, corners: [&Placed; 3]) -> f64 {
        if self.left_out[face] {
            return 0.0;
        }
        if Self::is_folded(corners) {
            return f64::INFINITY;
        }
        let hats = &self.hats[face];
        let split = self.subdivision.value(&self.target, self.kind, face, hats, corners);
        let in_space = split
            .unwrap_or_else(|| self.kind.value(gram(&jacobian(hats, corners.map(|placed| placed.point)))));
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
        if self.left_out[face] {
            return Expansion::default();
        }
        let (hats, area) = (&self.hats[face], self.areas[face]);
        let split = self.subdivision.expansion(&self.target, self.kind, face, hats, corners, frames);
        let in_space = split.unwrap_or_else(|| {
            let images = jacobian(hats, corners.map(|placed| placed.point));
            self.kind.expansion(&images, hats, &frames.map(|frame| *frame)).0
        });
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
        for (k, (placed, changes)) in corners.into_iter().zip(&changes).enumerate() {
            let slopes = target.corner_metrics(&placed.location).map(|metric| {
                let [x, y] = flat;
                let entries = [product(metric, x, x), product(metric, x, y), product(metric, y, y)];
                (0..3).map(|i| by_metric[i] * entries[i]).sum::<f64>() / 3.0
            });
            for (d, change) in changes.iter().enumerate() {
                expansion.gradient[2 * k + d] += change.iter().zip(slopes).map(|(x, y)| x * y).sum::<f64>();
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

#[cfg(test)]
mod tests {
    use super::super::sample_maps::Sample;
    use super::*;
    use crate::location::tests::number;
    use crate::registration::features::Signals;

    const NO_GUARD: Guard = Guard { weight: 0.0, slack: 0.0 };
    const STEP: f64 = 1e-6;

    /// With these exponents faces of little distortion exceed the slack of the guard too.
    const STEEP: FaceEnergy = FaceEnergy { area_weight: 3.0, angle_weight: 3.0, both_ways: false };

    /// The slope of a function of a place along a vector, by a central difference.
    fn slope(
        energy: &SurfaceEnergy<'_>,
        placed: &Placed,
        along: Vector3,
        value: impl Fn(&Placed) -> f64,
    ) -> f64 {
        let at =
            |step: f64| value(&energy.target.placed(energy.target.walked(placed.location, along * step)));
        (at(STEP) - at(-STEP)) / (2.0 * STEP)
    }

    #[test]
    fn gradients_of_faces_are_those_of_differences() {
        let kinds = [[1.0, 1.0], [0.4, 2.0]].map(|[area_weight, angle_weight]| FaceEnergy {
            area_weight,
            angle_weight,
            both_ways: false,
        });
        // the faces of the last two span many of the target
        for sample in [Sample::spheres(), Sample::coarse_sphere(), Sample::coarse_disk()] {
            for (kind, slack) in
                kinds.into_iter().chain([STEEP]).flat_map(|kind| [0.0, 3.0].map(|slack| (kind, slack)))
            {
                let mut problem = sample.problem();
                problem.face_energy = kind;
                let mut energy = SurfaceEnergy::new(&problem, Guard { weight: 0.7, slack });
                let map = sample.placed_on(&energy.target);
                energy.subdivide(&map);
                for face in 0..energy.areas.len() {
                    let corners = energy.corners(&map, face);
                    let frames = corners.map(|placed| energy.target.frame(placed.location.triangle));
                    let expansion =
                        energy.face_expansion(face, corners, [&frames[0], &frames[1], &frames[2]]);
                    let scale = energy.areas[face] * energy.face_value(face, corners);
                    assert!((expansion.value - scale).abs() < 1e-12 * scale);
                    for k in 0..3 {
                        for (d, axis) in frames[k].into_iter().enumerate() {
                            let difference = slope(&energy, corners[k], axis, |moved| {
                                let mut corners = corners;
                                corners[k] = moved;
                                energy.areas[face] * energy.face_value(face, corners)
                            });
                            let gradient = expansion.gradient[2 * k + d];
                            assert!((gradient - difference).abs() < 1e-6 * scale.max(gradient.abs()));
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn a_slack_leaves_out_the_guard_of_good_faces_alone() {
        let sample = Sample::spheres();
        let mut problem = sample.problem();
        problem.face_energy = STEEP;
        let value_with = |guard: Guard| {
            let energy = SurfaceEnergy::new(&problem, guard);
            let map = sample.placed_on(&energy.target);
            energy.face_values(&map)
        };
        let without = value_with(NO_GUARD);
        let in_domain = value_with(Guard { weight: 1.0, slack: 0.0 });
        let beyond = value_with(Guard { weight: 1.0, slack: 3.0 });
        let mut n_bad = 0;
        for face in 0..without.len() {
            let bad = in_domain[face] - without[face] > 3.0;
            assert_eq!(beyond[face] > without[face], bad);
            n_bad += usize::from(bad);
        }
        assert!(0 < n_bad && n_bad < without.len());
    }

    #[test]
    fn gradients_of_vertices_are_those_of_differences() {
        let sample = Sample::spheres();
        let mut problem = sample.problem();
        let n = sample.source.n_vertices();
        let pull = |v: usize, place: usize, weight: f64| Pull {
            vertex: Vertex::new(v),
            place: Vertex::new(place),
            weight,
        };
        problem.pulls = vec![pull(9, 40, 3.0), pull(2, 11, 0.5), pull(9, 7, 1.0)];
        problem.signals = Signals {
            width: 2,
            source: (0..2 * n).map(number).collect(),
            target: (0..2 * sample.target.n_vertices()).map(|i| number(1000 + i)).collect(),
        };
        let energy = SurfaceEnergy::new(&problem, NO_GUARD);
        let map = sample.placed_on(&energy.target);
        for vertex in Vertex::all(n) {
            let frame = energy.target.frame(map[vertex].location.triangle);
            let expansion = energy.vertex_expansion(vertex, &map[vertex], &frame);
            for (d, axis) in frame.into_iter().enumerate() {
                let value = |moved: &Placed| energy.vertex_value(vertex, moved);
                let difference = slope(&energy, &map[vertex], axis, value);
                assert!((expansion.gradient[d] - difference).abs() < 1e-7);
            }
            // the energy is a square in each face, so that its Hessian is that of differences too
            let at = |x: f64, y: f64| {
                let along = (frame[0] * x + frame[1] * y) * 1e-3;
                let moved = energy.target.coordinates(map[vertex].location.triangle, along);
                let mut location = map[vertex].location;
                (0..3).for_each(|k| location.barycentric[k] += moved[k]);
                energy.vertex_value(vertex, &energy.target.placed(location))
            };
            let twice = 2.0 * at(0.0, 0.0);
            let second = [
                at(1.0, 0.0) + at(-1.0, 0.0) - twice,
                0.25 * (at(1.0, 1.0) + at(-1.0, -1.0) - at(1.0, -1.0) - at(-1.0, 1.0)),
                at(0.0, 1.0) + at(0.0, -1.0) - twice,
            ];
            for (second, entry) in second.into_iter().zip(expansion.hessian) {
                assert!((1e6 * second - entry).abs() < 1e-6 * (1.0 + entry.abs()));
            }
        }
    }

    #[test]
    fn soft_landmarks_count_by_their_distance_on_a_target_of_area_one() {
        let sample = Sample::spheres();
        let mut problem = sample.problem();
        problem.pulls = vec![Pull { vertex: Vertex(5), place: Vertex(30), weight: 2.5 }];
        let energy = SurfaceEnergy::new(&problem, NO_GUARD);
        let map = sample.placed_on(&energy.target);
        let area: f64 = sample.target.face_areas().iter().sum();
        let there = sample.start[5].point_on(sample.target.points(), sample.target.faces());
        let distance = there.distance(sample.target.points()[30]);
        let expected = 2.5 * distance * distance / area;
        assert!((energy.vertex_value(Vertex(5), &map[5]) - expected).abs() < 1e-12 * expected);
        assert_eq!(energy.vertex_value(Vertex(6), &map[6]), 0.0);
    }

    #[test]
    fn the_energy_of_a_folded_face_is_infinite() {
        let sample = Sample::spheres();
        let problem = sample.problem();
        let energy = SurfaceEnergy::new(&problem, NO_GUARD);
        let map = sample.placed_on(&energy.target);
        for face in 0..energy.areas.len() {
            let [a, b, c] = energy.corners(&map, face);
            assert!(energy.face_value(face, [a, b, c]).is_finite());
            assert_eq!(energy.face_value(face, [b, a, c]), f64::INFINITY);
            assert_eq!(energy.face_value(face, [a, a, c]), f64::INFINITY);
        }
    }

    #[test]
    fn the_guard_sets_in_without_a_kink() {
        for slack in [0.0, 3.0] {
            let guard = Guard { weight: 0.7, slack };
            for energy in [1.0, 2.999, 3.0, 3.001, 4.0, 50.0] {
                let h = 1e-6;
                let difference = (guard.value(energy + h) - guard.value(energy - h)) / (2.0 * h);
                let [first, second] = guard.slopes(energy);
                assert!((first - difference).abs() < 1e-6);
                if energy != slack {
                    let difference = (guard.slopes(energy + h)[0] - guard.slopes(energy - h)[0]) / (2.0 * h);
                    assert!((second - difference).abs() < 1e-6);
                }
            }
        }
        let guard = Guard { weight: 0.7, slack: 3.0 };
        assert_eq!([guard.value(3.0), guard.value(1.0), guard.slopes(3.0)[0]], [0.0; 3]);
    }

    #[test]
    fn the_whole_is_the_sum_of_its_parts() {
        let sample = Sample::spheres();
        let problem = sample.problem();
        let energy = SurfaceEnergy::new(&problem, NO_GUARD);
        let map = sample.placed_on(&energy.target);
        // 1. Without a guard it is the mean of the distortion
        let [whole, mean] = [energy.value(&map), energy.mean_distortion(&map)];
        assert!((whole - mean).abs() < 1e-12 * whole);
        // 2. The stars of all vertices have each face three times
        let stars: f64 = Vertex::all(map.len())
            .map(|vertex| energy.star_value(&map, vertex, &map[vertex], f64::INFINITY))
            .sum();
        assert!((stars - 3.0 * whole).abs() < 1e-12 * stars);
        // 3. A star above its limit is worth nothing
        let star = energy.star_value(&map, Vertex(3), &map[3], f64::INFINITY);
        assert_eq!(energy.star_value(&map, Vertex(3), &map[3], 0.5 * star), f64::INFINITY);
    }
}
