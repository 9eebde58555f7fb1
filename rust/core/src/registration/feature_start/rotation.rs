// SPDX-License-Identifier: MIT OR Apache-2.0
//! The rotation under which signals on two spheres agree best.
//!
//! Thousands of rotations, spread evenly over all (M. Alexa, *Super-Fibonacci spirals*, CVPR 2022), are compared at a
//! few hundred points by smooth signals that are looked up in a cube map. Gauss–Newton brings the best of them to their
//! minima, first of smooth and then of less smooth signals; the lowest wins.

use std::f64::consts::{PI, SQRT_2, TAU};

use super::sphere_signals::{SpherePlace, SphereSignals};
use crate::alignment::rotation::{rotate, rotation_of};
use crate::control::Watch;
use crate::parallel;
use crate::sparse::solve_positive_definite;
use crate::vector::Vector3;

/// Rotations compared.
const ROTATIONS: usize = 6000;
/// Points at which all rotations are compared.
const POINTS: usize = 400;
/// Points at which the best are compared.
const FINE_POINTS: usize = 3000;
/// Rotations brought to their minima for smooth signals, and of these for less smooth ones.
const BEST: [usize; 2] = [24, 4];
/// Most steps to a minimum.
const STEPS: usize = 40;
/// Length of a step, in radians, at which a minimum is reached.
const REACHED: f64 = 1e-13;
/// Cells along an edge of the cube map.
const CELLS: usize = 32;
/// Weight of the squared distance of a pair of landmarks against the mean squared difference of the signals.
const PAIR_WEIGHT: f64 = 20.0;
/// The constant of the super-Fibonacci spiral: the positive solution of ψ⁴ = ψ + 4.
const PSI: f64 = 1.533_751_168_755_204_3;

/// A rotation, by rows.
type Rotation = [Vector3; 3];

/// Signals of the source and of the target.
type Level<'a> = (SphereSignals<'a>, SphereSignals<'a>);

/// The search for a rotation.
pub(super) struct RotationSearch<'a> {
    /// Smooth signals, then less smooth ones.
    pub levels: &'a [Level<'a>; 2],
    /// Places of the source that should come to places of the target.
    pub pairs: &'a [[Vector3; 2]],
}

/// Points of the source with their signals.
struct Samples {
    points: Vec<Vector3>,
    /// `width` values at each.
    values: Vec<f64>,
}

impl RotationSearch<'_> {
    /// The best rotation; `None` if cancelled.
    pub(super) fn best(&self, watch: &Watch<'_>) -> Option<Rotation> {
        let [rough, fine] = self.levels;
        // 1. All rotations
        let samples = Samples::new(&rough.0, POINTS);
        let cube = CubeMap::new(&rough.1);
        let costs = parallel::tasks(ROTATIONS, |k| {
            if watch.goes_on() { self.rough_cost(&samples, &cube, spread_rotation(k)) } else { f64::NAN }
        });
        if !watch.goes_on() {
            return None;
        }
        let mut order: Vec<usize> = (0..ROTATIONS).collect();
        order.sort_by(|&a, &b| costs[a].total_cmp(&costs[b]).then(a.cmp(&b)));
        let starts = order[..BEST[0]].iter().map(|&k| spread_rotation(k)).collect();
        // 2. The best of them at their minima
        let best = self.minima(&rough.1, &samples, starts);
        let samples = Samples::new(&fine.0, FINE_POINTS);
        let starts = best.into_iter().take(BEST[1]).map(|(_, rotation)| rotation).collect();
        let best = self.minima(&fine.1, &samples, starts);
        watch.goes_on().then(|| best[0].1)
    }

    fn rough_cost(&self, samples: &Samples, cube: &CubeMap, rotation: Rotation) -> f64 {
        let width = cube.width;
        let square = |(k, &point): (usize, &Vector3)| -> f64 {
            let values = cube.at(rotate(rotation, point));
            let ours = &samples.values[k * width..(k + 1) * width];
            ours.iter().zip(values).map(|(a, b)| (a - b) * (a - b)).sum()
        };
        let total: f64 = samples.points.iter().enumerate().map(square).sum();
        total / samples.points.len() as f64 + self.pair_cost(rotation)
    }

    /// The cost of landmarks apart.
    fn pair_cost(&self, rotation: Rotation) -> f64 {
        let square = |&[p, q]: &[Vector3; 2]| (rotate(rotation, p) - q).dot(rotate(rotation, p) - q);
        PAIR_WEIGHT * self.pairs.iter().map(square).sum::<f64>()
    }

    /// Rotations at their minima with their costs, the lowest first.
    fn minima(
        &self,
        target: &SphereSignals<'_>,
        samples: &Samples,
        starts: Vec<Rotation>,
    ) -> Vec<(f64, Rotation)> {
        let mut minima =
            parallel::tasks(starts.len(), |k| Minimization { search: self, target, samples }.run(starts[k]));
        minima.sort_by(|a, b| a.0.total_cmp(&b.0));
        minima
    }
}

/// Gauss–Newton over rotations with adaptive damping.
struct Minimization<'a> {
    search: &'a RotationSearch<'a>,
    target: &'a SphereSignals<'a>,
    samples: &'a Samples,
}

impl Minimization<'_> {
    fn run(&self, start: Rotation) -> (f64, Rotation) {
        let mut rotation = start;
        let mut places: Vec<SpherePlace> =
            self.samples.points.iter().map(|&point| self.target.place(rotate(rotation, point))).collect();
        let (mut cost, mut system) = self.linearized(rotation, &mut places);
        let mut damping = 1e-3;
        for _ in 0..STEPS {
            let Some(turn) = system.solved(damping) else { break };
            let turned = turned(rotation, turn);
            let mut new_places = places.clone();
            let (new_cost, new_system) = self.linearized(turned, &mut new_places);
            if new_cost <= cost {
                (rotation, cost, system, places) = (turned, new_cost, new_system, new_places);
                damping *= 0.1;
            } else {
                damping *= 10.0;
            }
            if turn.norm() <= REACHED {
                break;
            }
        }
        (cost, rotation)
    }

    /// The cost of a rotation, and its normal equations for a further small one; `places` are near before and right
    /// after.
    fn linearized(&self, rotation: Rotation, places: &mut [SpherePlace]) -> (f64, System) {
        let width = self.target.width;
        let share = 1.0 / self.samples.points.len() as f64;
        let mut cost = 0.0;
        let mut system = System::default();
        for (k, &point) in self.samples.points.iter().enumerate() {
            let x = rotate(rotation, point);
            places[k] = self.target.place_near(x, places[k]);
            for signal in 0..width {
                let residual =
                    self.samples.values[k * width + signal] - self.target.value(&places[k], signal);
                cost += share * residual * residual;
                // a turn ω moves x by ω × x
                system.add(x.cross(self.target.gradient(&places[k], x, signal)), residual, share);
            }
        }
        for &[p, q] in self.search.pairs {
            let x = rotate(rotation, p);
            (0..3).for_each(|axis| {
                system.add(x.cross(Vector3::unit(axis)), q[axis] - x[axis], PAIR_WEIGHT);
            });
        }
        (cost + self.search.pair_cost(rotation), system)
    }
}

/// The normal equations of a turn.
#[derive(Default)]
struct System {
    matrix: [[f64; 3]; 3],
    rhs: [f64; 3],
}

impl System {
    fn add(&mut self, slope: Vector3, residual: f64, weight: f64) {
        for i in 0..3 {
            (0..3).for_each(|j| self.matrix[i][j] += weight * slope[i] * slope[j]);
            self.rhs[i] += weight * slope[i] * residual;
        }
    }

    fn solved(&self, damping: f64) -> Option<Vector3> {
        let trace: f64 = (0..3).map(|i| self.matrix[i][i]).sum();
        let mut matrix = self.matrix;
        (0..3).for_each(|i| matrix[i][i] += damping * trace);
        let mut rhs = self.rhs;
        solve_positive_definite(matrix.as_flattened_mut(), &mut rhs).then_some(Vector3(rhs))
    }
}

/// A rotation followed by the turn about an axis, of the axis's length in radians.
fn turned(rotation: Rotation, turn: Vector3) -> Rotation {
    let angle = turn.norm();
    if angle == 0.0 {
        return rotation;
    }
    let axis = turn * ((0.5 * angle).sin() / angle);
    let rows = rotation_of([(0.5 * angle).cos(), axis[0], axis[1], axis[2]]);
    rows.map(|row| rotation[0] * row[0] + rotation[1] * row[1] + rotation[2] * row[2])
}

/// The rotation of a number, all numbers spread evenly.
fn spread_rotation(number: usize) -> Rotation {
    let s = number as f64 + 0.5;
    let t = s / ROTATIONS as f64;
    let (alpha, beta) = (TAU * s / SQRT_2, TAU * s / PSI);
    let (inner, outer) = (t.sqrt(), (1.0 - t).sqrt());
    rotation_of([outer * beta.cos(), inner * alpha.sin(), inner * alpha.cos(), outer * beta.sin()])
}

impl Samples {
    /// The signals at points spread evenly over the sphere.
    fn new(signals: &SphereSignals<'_>, count: usize) -> Self {
        let points: Vec<Vector3> = (0..count).map(|k| spread_point(k, count)).collect();
        let rows = parallel::map(count, |k| {
            let place = signals.place(points[k]);
            (0..signals.width).map(|signal| signals.value(&place, signal)).collect::<Vec<f64>>()
        });
        Self { points, values: rows.concat() }
    }
}

/// A point of the Fibonacci spiral on the sphere.
fn spread_point(number: usize, count: usize) -> Vector3 {
    let s = number as f64 + 0.5;
    let height = 1.0 - 2.0 * s / count as f64;
    let (radius, angle) = ((1.0 - height * height).sqrt(), PI * (1.0 + 5f64.sqrt()) * s);
    Vector3([radius * angle.cos(), radius * angle.sin(), height])
}

/// Signals in the cells of the six faces of a cube.
struct CubeMap {
    width: usize,
    values: Vec<f64>,
}

impl CubeMap {
    fn new(signals: &SphereSignals<'_>) -> Self {
        let rows = parallel::map(6 * CELLS * CELLS, |cell| {
            let place = signals.place(cell_center(cell));
            (0..signals.width).map(|signal| signals.value(&place, signal)).collect::<Vec<f64>>()
        });
        Self { width: signals.width, values: rows.concat() }
    }

    /// The signals in the cell of a direction.
    fn at(&self, x: Vector3) -> &[f64] {
        let axis = (0..3).max_by(|&a, &b| x[a].abs().total_cmp(&x[b].abs())).unwrap_or(0);
        let length = x[axis].abs();
        let index = |across: f64| (((across / length + 1.0) * 0.5 * CELLS as f64) as usize).min(CELLS - 1);
        let face = 2 * axis + usize::from(x[axis] < 0.0);
        let cell = (face * CELLS + index(x[(axis + 1) % 3])) * CELLS + index(x[(axis + 2) % 3]);
        &self.values[cell * self.width..(cell + 1) * self.width]
    }
}

/// The direction of the center of a cell.
fn cell_center(cell: usize) -> Vector3 {
    let center = |index: usize| 2.0 * (index as f64 + 0.5) / CELLS as f64 - 1.0;
    let (face, row, column) = (cell / (CELLS * CELLS), cell / CELLS % CELLS, cell % CELLS);
    let (axis, sign) = (face / 2, if face % 2 == 0 { 1.0 } else { -1.0 });
    let mut x = Vector3::ZERO;
    (x[axis], x[(axis + 1) % 3], x[(axis + 2) % 3]) = (sign, center(row), center(column));
    x.normalized()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_find_their_cells() {
        let cube = CubeMap { width: 1, values: (0..6 * CELLS * CELLS).map(|cell| cell as f64).collect() };
        for cell in 0..6 * CELLS * CELLS {
            assert_eq!(cube.at(cell_center(cell)), [cell as f64]);
        }
    }

    #[test]
    fn every_rotation_is_near_one_of_those_spread() {
        assert!((PSI.powi(4) - PSI - 4.0).abs() < 1e-12);
        for wanted in
            [[0.5, -0.1, 0.7, 0.5], [0.0, 1.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.1, 0.7, -0.1, 0.7]]
        {
            let wanted = rotation_of(wanted);
            let nearest = (0..ROTATIONS).map(spread_rotation).map(|rotation| {
                let trace: f64 = (0..3).map(|row| rotation[row].dot(wanted[row])).sum();
                (0.5 * (trace - 1.0)).clamp(-1.0, 1.0).acos()
            });
            assert!(nearest.fold(f64::INFINITY, f64::min) < 0.3);
        }
    }

    #[test]
    fn a_turn_follows_a_rotation() {
        let rotation = rotation_of([0.5, -0.1, 0.7, 0.5]);
        let turn = Vector3([1e-6, -2e-6, 3e-6]);
        let x = Vector3([0.48, 0.6, 0.64]);
        let moved = rotate(turned(rotation, turn), x);
        let expected = rotate(rotation, x) + turn.cross(rotate(rotation, x));
        assert!(moved.distance(expected) < 1e-10);
    }
}
