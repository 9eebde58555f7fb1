// SPDX-License-Identifier: MIT OR Apache-2.0
//! An isotopy of the sphere that carries the features of a piece to those of its partner.
//!
//! Points of equal parameter move on paths: each curve turns as a whole about the axis of its best rotation,
//! and the rest of the way goes along great arcs, so that a curve that has to turn around spins instead of
//! collapsing. In every small step a smooth displacement interpolates those of the points, by a Matérn kernel
//! of order 3/2, and moves the whole sphere. Paths between the features keep their homotopy class.
//!
//! Input: curves on the unit sphere at equal parameters. Cost: a dense system of k, about 400 at most, points
//! per step, and k for every point carried and step.

use crate::alignment::rotation::{best_rotation, rotate, rotation_of};
use crate::control::Watch;
use crate::hyperbolic::features::parameters::{length, on_sphere, unit};
use crate::hyperbolic::features::piece::{Bank, Piece};
use crate::mesh::ties::first_largest;
use crate::parallel;
use crate::sparse::solve_positive_definite;
use crate::vector::Vector3;

/// Length scale of the kernel.
const REACH: f64 = 0.25;
/// Ridge on the diagonal of the system, relative to the diagonal.
const RIDGE: f64 = 1e-9;
/// Numbers of steps to try in turn.
const STEPS: [usize; 3] = [60, 120, 240];
/// Largest relative move of two points in one step, relative to their distance, so that no step folds.
const LARGEST_STRAIN: f64 = 0.5;
/// Distance of all points to their places up to which there is nothing to move.
const AT_REST: f64 = 1e-9;
/// Largest final distance of a point to its place; beyond it the point is lost.
const LOST: f64 = 3e-2;
/// Distance of points on a curve, unless there would be more than [`MOST_POINTS`].
const SPACING: f64 = 0.03;
/// About the most points on all curves.
const MOST_POINTS: f64 = 400.0;

/// An isotopy of the sphere in small steps.
#[derive(Debug, Clone)]
pub(crate) struct Isotopy {
    steps: Vec<Step>,
}

/// A displacement of the whole sphere.
#[derive(Debug, Clone)]
struct Step {
    places: Vec<Vector3>,
    weights: Vec<Vector3>,
}

impl Isotopy {
    /// The isotopy that takes the features of `source` to those of `target`; `None` as in [`Self::new`].
    pub(crate) fn between(source: &Piece, target: &Piece, watch: &Watch<'_>) -> Option<Self> {
        let [ours, theirs] = samples(source, target);
        Self::new(&ours, &theirs, watch)
    }

    /// The isotopy that takes every point of each curve of `source` to that of the same number on `target`.
    /// Points are unit vectors, and no two on one surface are equal.
    ///
    /// `None` if curves run into each other on the way, or if cancelled.
    pub(super) fn new(source: &[Vec<Vector3>], target: &[Vec<Vector3>], watch: &Watch<'_>) -> Option<Self> {
        let (from, to) = (source.concat(), target.concat());
        let are_within = |points: &[Vector3], most: f64| {
            points.iter().zip(&to).all(|(&x, &place)| x.distance(place) <= most)
        };
        if are_within(&from, AT_REST) {
            return Some(Self { steps: Vec::new() });
        }
        let paths: Vec<Path> = source.iter().zip(target).flat_map(|(from, to)| paths(from, to)).collect();
        let in_steps = |count: &usize| Some(Self { steps: steps(&paths, *count, watch)? });
        STEPS.iter().filter_map(in_steps).find(|isotopy| are_within(&isotopy.carry(&from), LOST))
    }

    /// Carries unit vectors along.
    pub(crate) fn carry(&self, points: &[Vector3]) -> Vec<Vector3> {
        parallel::map(points.len(), |i| self.steps.iter().fold(points[i], |x, step| step.moved(x)))
    }
}

impl Step {
    /// The displacement that interpolates those of the points from `places` to `next`; `None` if the system is
    /// singular.
    fn through(places: Vec<Vector3>, next: &[Vector3]) -> Option<Self> {
        let k = places.len();
        let mut matrix = parallel::map(k * k, |entry| {
            let (i, j) = (entry % k, entry / k);
            kernel(places[i].distance(places[j])) + if i == j { RIDGE } else { 0.0 }
        });
        let mut weights: Vec<f64> =
            (0..3 * k).map(|entry| next[entry % k][entry / k] - places[entry % k][entry / k]).collect();
        solve_positive_definite(&mut matrix, &mut weights).then(|| {
            let weights = (0..k).map(|i| Vector3([weights[i], weights[k + i], weights[2 * k + i]])).collect();
            Self { places, weights }
        })
    }

    fn moved(&self, x: Vector3) -> Vector3 {
        let terms = self.places.iter().zip(&self.weights);
        unit(terms.fold(x, |sum, (&place, &weight)| sum + weight * kernel(x.distance(place))))
    }
}

/// The Matérn kernel of order 3/2.
fn kernel(distance: f64) -> f64 {
    let r = distance / REACH;
    (1.0 + r) * (-r).exp()
}

/// The steps along all paths; `None` if a step would fold or the points are too close for the kernel.
fn steps(paths: &[Path], count: usize, watch: &Watch<'_>) -> Option<Vec<Step>> {
    let after =
        |i: usize| -> Vec<Vector3> { paths.iter().map(|path| path.at(i as f64 / count as f64)).collect() };
    let mut places = after(0);
    let mut steps = Vec::with_capacity(count);
    for i in 1..=count {
        let next = after(i);
        if !watch.goes_on() || strain(&places, &next) > LARGEST_STRAIN {
            return None;
        }
        steps.push(Step::through(places, &next)?);
        places = next;
    }
    Some(steps)
}

/// The largest change of the difference of two points relative to their distance.
fn strain(places: &[Vector3], next: &[Vector3]) -> f64 {
    let of = |i: usize| {
        let pair = |j: usize| {
            let change = next[i] - places[i] - (next[j] - places[j]);
            change.norm() / places[i].distance(places[j])
        };
        (0..i).map(pair).fold(0.0, f64::max)
    };
    parallel::map(places.len(), of).into_iter().fold(0.0, f64::max)
}

/// The path of a point: along a great arc, all of it turned by the rotation of its curve.
struct Path {
    from: Vector3,
    /// The point's final place turned back by the whole rotation.
    to: Vector3,
    axis: Vector3,
    angle: f64,
}

/// The paths of the points of a curve.
fn paths(from: &[Vector3], to: &[Vector3]) -> impl Iterator<Item = Path> {
    let rotation = best_rotation(from, to, &vec![1.0; from.len()]);
    let (axis, angle) = axis_angle(rotation);
    let back = turn(axis, -angle);
    from.iter().zip(to).map(move |(&from, &to)| Path { from, to: rotate(back, to), axis, angle })
}

impl Path {
    fn at(&self, t: f64) -> Vector3 {
        rotate(turn(self.axis, t * self.angle), slerp(self.from, self.to, t))
    }
}

/// The point at the parameter `t` of the great arc.
fn slerp(from: Vector3, to: Vector3, t: f64) -> Vector3 {
    let angle = from.cross(to).norm().atan2(from.dot(to));
    match angle.sin() {
        sine if sine > 1e-12 => {
            let [a, b] = [((1.0 - t) * angle).sin() / sine, (t * angle).sin() / sine];
            unit(from * a + to * b)
        }
        _ => from,
    }
}

/// The rotation about a unit axis.
fn turn(axis: Vector3, angle: f64) -> [Vector3; 3] {
    let (sine, cosine) = (0.5 * angle).sin_cos();
    rotation_of([cosine, sine * axis[0], sine * axis[1], sine * axis[2]])
}

/// The unit axis and the angle in [0, π] of a rotation.
fn axis_angle(rotation: [Vector3; 3]) -> (Vector3, f64) {
    let [Vector3([a, ab, ac]), Vector3([ba, b, bc]), Vector3([ca, cb, c])] = rotation;
    let double_sine = Vector3([cb - bc, ac - ca, ba - ab]);
    let angle = double_sine.norm().atan2(a + b + c - 1.0);
    if double_sine.norm() > 1e-6 {
        return (unit(double_sine), angle);
    }
    if angle < 1.0 {
        return (Vector3::unit(2), 0.0);
    }
    // half a turn: R + I = 2 axis axisᵀ, whose longest column gives the axis
    let columns = [[a + 1.0, ba, ca], [ab, b + 1.0, cb], [ac, bc, c + 1.0]].map(Vector3);
    (unit(columns[first_largest(&columns.map(Vector3::norm)).unwrap_or(0)]), angle)
}

/// Points of equal parameter on all features of both pieces; no point of a loop is repeated.
fn samples(source: &Piece, target: &Piece) -> [Vec<Vec<Vector3>>; 2] {
    let features = || source.features.iter().zip(&target.features);
    let banks = features().flat_map(|(ours, theirs)| {
        let right = ours.is_loop.then_some((&ours.right, &theirs.right));
        [Some((&ours.left, &theirs.left)), right].into_iter().flatten()
    });
    let size = |(ours, theirs): (&Bank, &Bank)| longer(&ours.places(source), &theirs.places(target));
    let spacing = f64::max(SPACING, banks.map(size).sum::<f64>() / MOST_POINTS);
    let both = features().map(|(ours, theirs)| {
        let along = |banks: [&Bank; 2]| along(banks, [source, target], spacing);
        let mut points = along([&ours.left, &theirs.left]);
        if ours.is_loop {
            let right = along([&ours.right, &theirs.right]);
            // start and end belong to both banks
            points
                .iter_mut()
                .zip(right)
                .for_each(|(points, right)| points.extend(&right[1..right.len() - 1]));
        }
        points
    });
    let (ours, theirs) = both.map(|[ours, theirs]| (ours, theirs)).unzip();
    [ours, theirs]
}

fn longer(ours: &[Vector3], theirs: &[Vector3]) -> f64 {
    f64::max(length(ours), length(theirs))
}

/// Points of equal parameter on two banks, both ends included.
fn along(banks: [&Bank; 2], pieces: [&Piece; 2], spacing: f64) -> [Vec<Vector3>; 2] {
    let places = [0, 1].map(|side| banks[side].places(pieces[side]));
    let count = ((longer(&places[0], &places[1]) / spacing).ceil() as usize).max(2);
    let point =
        |side: usize, k: usize| on_sphere(&places[side], &banks[side].parameters, k as f64 / count as f64);
    [0, 1].map(|side| (0..=count).map(|k| point(side, k)).collect())
}

impl Bank {
    fn places(&self, piece: &Piece) -> Vec<Vector3> {
        self.vertices.iter().map(|&vertex| piece.on_sphere[vertex]).collect()
    }
}

#[cfg(test)]
mod tests;
