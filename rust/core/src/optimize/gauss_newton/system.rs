// SPDX-License-Identifier: MIT OR Apache-2.0
//! The linear system of one iteration: a damped or exact Hessian, its factor, the direction and the second-order
//! correction.

use super::problem::Problem;
use crate::codomain::motion::{Frame, frames};
use crate::control::Watch;
use crate::energy::authalic::{Element, Hessian, Weights};
use crate::parallel;
use crate::sparse::{Factor, Failure};
use crate::vector::Vector3;

pub(super) const LARGE: usize = 500_000;

/// Where λ stays until the map is stationary, the exact Hessian is tried once the slope promised less than this part of
/// the energy.
pub(super) const NEAR: f64 = 1e-2;

/// The share of the exact Hessian is multiplied by this where it was positive definite at once.
const MORE: f64 = 1.6;

/// The share of the exact Hessian is multiplied by this where it was not positive definite.
const LESS: f64 = 0.6;

/// Shares of the exact Hessian tried in one iteration.
const ATTEMPTS: usize = 2;

/// A direction whose slope has grown by more than this comes from a nearly singular Hessian, and would amplify noise.
const MOST_GROWTH: f64 = 3.0;

/// A direction with its slope.
type Direction = (Vec<[f64; 2]>, f64);

/// The direction at a map, with the frames and the slope.
pub(super) struct Newton {
    pub frames: Vec<Frame>,
    pub direction: Vec<[f64; 2]>,
    /// The directional derivative of the energy, negative.
    pub slope: f64,
}

/// A map from which a direction starts.
struct Iterate<'a> {
    map: &'a [Vector3],
    frames: Vec<Frame>,
    gradient: Vec<[f64; 2]>,
    weights: &'a Weights,
}

/// The factor of the Hessian at a map.
///
/// In single precision its rounding errors, some 1e-3 of a direction along the family of area-preserving maps, would
/// decide which of them the descent reaches.
pub(super) struct Linearized {
    single: Option<Factor<f32>>,
    double: Option<Factor<f64>>,
    single_failed: usize,
    /// The part of the way from the composite Hessian to the exact one to try next.
    curvature: f64,
    /// The last slope.
    slope: f64,
}

impl Linearized {
    /// Without a factor yet; `in_single` asks for single precision while that suffices.
    pub(super) fn new(in_single: bool) -> Self {
        let single_failed = if in_single { 0 } else { usize::MAX };
        Self { single: None, double: None, single_failed, curvature: 1.0, slope: f64::NEG_INFINITY }
    }

    /// The direction at `map`: damped Gauss–Newton, or Newton's where a stationary point is near.
    pub(super) fn direction(
        &mut self,
        problem: &Problem,
        map: &[Vector3],
        weights: &Weights,
        damping: Hessian,
        is_near: bool,
        watch: &Watch<'_>,
    ) -> Result<Newton, Failure> {
        let frames = frames(&problem.motions, map);
        let gradient = problem.gradient(map, &frames, weights);
        let iterate = Iterate { map, frames, gradient, weights };
        let exact = if is_near { self.exact_direction(problem, &iterate, damping, watch)? } else { None };
        let (direction, slope) = match exact {
            Some(direction) => direction,
            None => self.composite_direction(problem, &iterate, damping, watch)?,
        };
        self.slope = slope;
        Ok(Newton { frames: iterate.frames, direction, slope })
    }

    /// The direction by the largest part of the exact Hessian that is positive definite, with its slope; `None` where
    /// no part is.
    fn exact_direction(
        &mut self,
        problem: &Problem,
        iterate: &Iterate<'_>,
        damping: Hessian,
        watch: &Watch<'_>,
    ) -> Result<Option<Direction>, Failure> {
        let mut curvature = self.curvature;
        for _ in 0..ATTEMPTS {
            let element = |face: usize| element(problem, iterate, &Hessian { curvature, ..damping }, face);
            match self.refactor(problem, &element, watch) {
                Err(Failure::Cancelled) => return Err(Failure::Cancelled),
                Err(Failure::NotPositiveDefinite) => {}
                Ok(()) => {
                    let (direction, slope) = self.solved(problem, iterate);
                    if slope <= 0.0 && slope >= MOST_GROWTH * self.slope {
                        let is_first = curvature == self.curvature;
                        self.curvature = if is_first { (MORE * curvature).min(1.0) } else { curvature };
                        return Ok(Some((direction, slope)));
                    }
                }
            }
            curvature *= LESS;
        }
        self.curvature = curvature;
        Ok(None)
    }

    /// The damped Gauss–Newton direction with its slope.
    fn composite_direction(
        &mut self,
        problem: &Problem,
        iterate: &Iterate<'_>,
        damping: Hessian,
        watch: &Watch<'_>,
    ) -> Result<Direction, Failure> {
        for _ in 0..3 {
            self.refactor(problem, &|face: usize| element(problem, iterate, &damping, face), watch)?;
            let (direction, slope) = self.solved(problem, iterate);
            if slope <= 0.0 && slope.is_finite() {
                return Ok((direction, slope));
            }
            // single precision was not enough
            if self.single.take().is_none() {
                break;
            }
            self.single_failed = usize::MAX;
        }
        Err(Failure::NotPositiveDefinite)
    }

    /// The direction of the factor with its slope.
    fn solved(&self, problem: &Problem, iterate: &Iterate<'_>) -> Direction {
        let gradient = &iterate.gradient;
        let mut unknowns = problem.packed(gradient);
        self.solve(problem, &mut unknowns);
        let ascent = problem.unpacked(&unknowns);
        let slope =
            parallel::sum(ascent.len(), |v| gradient[v][0] * -ascent[v][0] + gradient[v][1] * -ascent[v][1]);
        (parallel::map(ascent.len(), |v| ascent[v].map(|d| -d)), slope)
    }

    /// Second-order correction of a full step to `moved`, by the factor of the direction.
    pub(super) fn correction(
        &self,
        problem: &Problem,
        map: &[Vector3],
        moved: &[Vector3],
        newton: &Newton,
        weights: &Weights,
    ) -> Vec<[f64; 2]> {
        let rhs = problem.energy.curvature(map, moved, &newton.frames, &newton.direction, weights);
        let mut unknowns = problem.packed(&rhs);
        self.solve(problem, &mut unknowns);
        problem.unpacked(&unknowns)
    }

    /// Factors in single precision, in double where that fails, and always in double after two failures.
    fn refactor(
        &mut self,
        problem: &Problem,
        element: &(dyn Fn(usize) -> Element + Sync),
        watch: &Watch<'_>,
    ) -> Result<(), Failure> {
        let analysis = &problem.analysis;
        if self.single_failed < 2 {
            self.double = None;
            let factor = self.single.get_or_insert_with(|| Factor::new(analysis));
            match factor.refactor(analysis, element, watch) {
                Err(Failure::NotPositiveDefinite) => self.single_failed += 1,
                verdict => return verdict,
            }
        }
        self.single = None;
        self.double.get_or_insert_with(|| Factor::new(analysis)).refactor(analysis, element, watch)
    }

    fn solve(&self, problem: &Problem, unknowns: &mut [f64]) {
        match (&self.single, &self.double) {
            (Some(factor), _) => factor.solve(&problem.analysis, unknowns),
            (None, Some(factor)) => factor.solve(&problem.analysis, unknowns),
            (None, None) => unreachable!("factored before"),
        }
    }
}

/// The Hessian of a face with landmarks, and with a shift that resists rotations of the whole.
fn element(problem: &Problem, iterate: &Iterate<'_>, how: &Hessian, face: usize) -> Element {
    let (energy, map) = (&problem.energy, iterate.map);
    let mut element = energy.element(map, &iterate.frames, iterate.weights, how, face);
    problem.penalty.add_element(map, &iterate.frames, face, &mut element);
    for c in 0..3 {
        // one shift for both unknowns of a corner, so that the result turns with the map
        let mut shift = 0.5e-10 * (element[2 * c][2 * c] + element[2 * c + 1][2 * c + 1]).abs() + 1e-14;
        if how.curvature > 0.0 {
            // away from a stationary point, a turn of the whole has a negative curvature of the size of the gradient
            let vertex = energy.faces()[face][c];
            let [a, b] = iterate.gradient[vertex];
            shift += how.curvature * a.hypot(b) / energy.vertex_corners(vertex).len() as f64;
        }
        (2 * c..2 * c + 2).for_each(|k| element[k][k] += shift);
    }
    element
}
