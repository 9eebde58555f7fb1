// SPDX-License-Identifier: MIT OR Apache-2.0
//! Newton's method on the energy of a free outline and of its contacts.
//!
//! 1. The direction solves the linear system of faces and contacts ([`super::system`]).
//! 2. A step ends before a face folds or an outline meets itself, and where the energy falls.
//! 3. The descent has converged when the decrement −gᵀd of a full step almost vanishes: the map is stationary.
//!
//! Far from the minimum each face's Hessian goes without its negative eigenvalues, and where a step must be short, the
//! faces of highest energy descend by themselves ([`super::local`]). Nearer to the minimum the Hessian takes as much of
//! the curvature of areas as leaves it positive definite, in the end all, and the descent converges quadratically. Cost of
//! one iteration: one factorization of two unknowns per vertex, some ten solves where contacts act, and the descent of a
//! few faces after a short step.

use super::contact::{Contact, Stiffness, add_forces};
use super::energy::{Energy, Hessian};
use super::meeting::first_fold;
use super::outline::Outline;
use super::system::{Direction, Linearized, System};
use crate::codomain::planar::PlanarMap;
use crate::control::{History, Observer, Phase, Status, Watch};
use crate::parallel;
use crate::sparse::{Analysis, Failure};

const MESSAGE: &str = "Evening out areas";

/// μ, the damping of a face that is wholly off its target.
pub(super) const DAMPING: f64 = 0.005;

/// Bounds of the deviation that the damping adds to every face.
const LEAST_DEVIATIONS: [f64; 2] = [1e-6, 1e-3];

/// Shifts of the Hessian in units of its diagonal, tried in this order until it is positive definite.
const SHIFTS: [f64; 5] = [1e-12, 1e-10, 1e-8, 1e-6, 1e-4];

/// A step covers at most this part of the way to the first fold or meeting of outlines.
pub(super) const MARGIN: f64 = 0.9;

/// Steps tried along one direction.
const MOST_TRIALS: usize = 40;

/// A step must gain this part of what the decrement promises.
const SUFFICIENT: f64 = 1e-4;

/// A decrement below this is rounding.
const NOTHING: f64 = 1e-16;

/// A decrement below this part of the energy is rounding.
const ROUNDING: f64 = 1e-13;

/// Iterations over which the descent must gain something, or it has stalled.
const PATIENCE: usize = 50;

/// The part of the energy that [`PATIENCE`] iterations must gain.
const LEAST_GAIN: f64 = 1e-4;

/// That bound in units of the precision asked for; the larger of the two counts.
const IN_PRECISIONS: f64 = 100.0;

/// κ in units of λ.
const CONTACT: f64 = 0.1;

/// The whole Hessian is tried where the decrement is below this part of the energy.
const NEAR: f64 = 1e-2;

/// Reductions of the curvature before it is left out.
const MOST_ATTEMPTS: usize = 2;

/// Factor of the curvature where the Hessian was not positive definite.
const SHRINK: f64 = 0.6;

/// Factor of the curvature for the next iteration where the Hessian was positive definite.
const GROW: f64 = 1.6;

/// The energy to lower, with its linear system and its contacts.
#[derive(Clone, Copy)]
pub(super) struct Problem<'a> {
    pub energy: &'a Energy<'a>,
    /// The system of the faces, two unknowns at every vertex.
    pub analysis: &'a Analysis,
    /// The outline that must not cross itself; `None` where it may.
    pub outline: Option<&'a Outline>,
    /// Whether each vertex stays where it is; `None` where all may move.
    pub is_held: Option<&'a [bool]>,
    /// What lowers the energy of a few faces after a short step, if anything does.
    pub lower_locally: Option<LowerLocally>,
}

/// The map after a descent of the faces of high energy, if there are any.
pub(super) type LowerLocally = fn(&Energy<'_>, &[[f64; 2]], &Goal, &mut dyn Observer) -> Option<PlanarMap>;

/// When a descent ends.
#[derive(Debug, Clone, Copy)]
pub(super) struct Goal {
    /// λ.
    pub weight: f64,
    /// The distance below which outlines repel each other, in units of the heights beside them.
    pub range: f64,
    /// Iteration limit, which counts the iterations of earlier runs too.
    pub most_iterations: usize,
    /// The descent has converged when the decrement is below this part of the energy.
    pub precision: f64,
}

/// A map with its energy and its contacts.
struct Iterate {
    map: PlanarMap,
    value: f64,
    contacts: Vec<Contact>,
}

/// The state of the iterations.
pub(super) struct Descent<'a> {
    problem: Problem<'a>,
    system: System<'a>,
    /// The part of the curvature of areas to try next.
    curvature: f64,
    /// The last decrement in units of the energy.
    ratio: f64,
    pub done: usize,
}

impl<'a> Descent<'a> {
    pub(super) fn new(problem: Problem<'a>) -> Self {
        let system = System::new(problem.energy, problem.analysis, problem.is_held);
        Self { problem, system, curvature: 1.0, ratio: f64::INFINITY, done: 0 }
    }

    /// Lowers the energy from `map`, which must be allowed, to a stationary point.
    pub(super) fn run(
        &mut self,
        map: PlanarMap,
        goal: &Goal,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> (PlanarMap, Status) {
        let weight = goal.weight;
        let mut iterate = self.iterate(map, goal);
        history.push_start(self.problem.energy.unevenness(&iterate.map), 0.0);
        if !iterate.value.is_finite() {
            return (iterate.map, Status::Stalled);
        }
        let mut values = vec![iterate.value];
        loop {
            // 1. Stop where asked to
            if self.done >= goal.most_iterations {
                return (iterate.map, Status::MaxIterations);
            }
            let fraction = 1.0 - 0.95f64.powi(self.done as i32);
            if !observer.progress(fraction, MESSAGE) {
                return (iterate.map, Status::Cancelled);
            }
            // 2. The direction
            let watch = Watch::new(observer, fraction, MESSAGE);
            let direction = match self.direction(&iterate, weight, &watch) {
                Ok(direction) => direction,
                Err(Failure::Cancelled) => return (iterate.map, Status::Cancelled),
                Err(Failure::NotPositiveDefinite) => return (iterate.map, Status::Stalled),
            };
            self.ratio = direction.decrement / iterate.value;
            // 3. The step
            let least = (goal.precision * iterate.value).max(NOTHING);
            let is_flat = direction.decrement <= least;
            if direction.decrement <= (ROUNDING * iterate.value).max(NOTHING) {
                return (iterate.map, Status::Converged);
            }
            let Some((next, step)) = self.step(&iterate, &direction, goal) else {
                return (iterate.map, if is_flat { Status::Converged } else { Status::Stalled });
            };
            self.done += 1;
            let mut phase = Phase { whole: &mut *observer, from: fraction, to: fraction };
            iterate = if step < 1.0 { self.locally_lowered(next, goal, &mut phase) } else { next };
            values.push(iterate.value);
            history.push(
                self.problem.energy.unevenness(&iterate.map),
                step,
                direction.decrement.max(0.0).sqrt(),
            );
            if is_flat && step > 0.5 {
                return (iterate.map, Status::Converged);
            }
            if has_stalled(&values, LEAST_GAIN.max(IN_PRECISIONS * goal.precision)) {
                return (iterate.map, Status::Stalled);
            }
        }
    }

    /// The map after a descent of the faces of highest energy by themselves.
    fn locally_lowered(&self, iterate: Iterate, goal: &Goal, observer: &mut dyn Observer) -> Iterate {
        let Problem { energy, outline, lower_locally, .. } = self.problem;
        let lowered = lower_locally.and_then(|lower| lower(energy, &iterate.map, goal, observer));
        let Some(map) = lowered else { return iterate };
        let next = self.iterate(map, goal);
        let is_allowed = outline.is_none_or(|outline| outline.is_simple(&next.map));
        if next.value < iterate.value && is_allowed { next } else { iterate }
    }

    /// √(E_A/A) of a map.
    pub(super) fn deviation(&self, map: &[[f64; 2]]) -> f64 {
        self.problem.energy.unevenness(map).sqrt()
    }

    /// True if the contacts could give away less than `share` of the energy.
    pub(super) fn is_worth_less(&self, map: &[[f64; 2]], goal: &Goal, share: f64) -> bool {
        let Some(outline) = self.problem.outline else { return true };
        let stiffness = self.stiffness(outline, goal.weight);
        let contacts = outline.contacts(map, goal.range);
        let gain: f64 = contacts.iter().map(|contact| contact.possible_gain(stiffness)).sum();
        gain <= share * self.problem.energy.value(map, goal.weight)
    }

    fn stiffness(&self, outline: &Outline, weight: f64) -> Stiffness {
        outline.stiffness(CONTACT * weight)
    }

    /// The map with its energy, infinite where the map is not allowed, and its contacts.
    fn iterate(&self, map: PlanarMap, goal: &Goal) -> Iterate {
        let mut value = self.problem.energy.value(&map, goal.weight);
        let mut contacts = Vec::new();
        if let Some(outline) = self.problem.outline
            && value.is_finite()
        {
            contacts = outline.contacts(&map, goal.range);
            let stiffness = self.stiffness(outline, goal.weight);
            value += contacts.iter().map(|contact| contact.value(stiffness)).sum::<f64>();
        }
        Iterate { map, value: if value.is_finite() { value } else { f64::INFINITY }, contacts }
    }

    /// The Newton direction.
    fn direction(&mut self, iterate: &Iterate, weight: f64, watch: &Watch<'_>) -> Result<Direction, Failure> {
        let energy = self.problem.energy;
        // 1. The gradient of faces and contacts
        let mut gradient = energy.gradient(&iterate.map, weight);
        let springs = self.springs(iterate, weight);
        add_forces(&mut gradient, &iterate.contacts, &springs);
        for (force, _) in
            gradient.iter_mut().zip(self.problem.is_held.unwrap_or_default()).filter(|(_, held)| **held)
        {
            *force = [0.0; 2];
        }
        let state = Linearized {
            map: &iterate.map,
            gradient: &gradient,
            contacts: &iterate.contacts,
            springs: &springs,
            ratio: self.ratio,
        };
        // 2. The Hessian, exact where that is positive definite
        let deviation = energy.parts(&iterate.map).deviation.sqrt();
        let least = deviation.clamp(LEAST_DEVIATIONS[0], LEAST_DEVIATIONS[1]);
        if self.ratio < NEAR {
            let mut tried = self.curvature;
            for _ in 0..MOST_ATTEMPTS {
                let damping = DAMPING * (1.0 - tried);
                let part = Hessian { weight, damping, least, curvature: Some(tried) };
                match self.system.solve(&state, &part, SHIFTS[1], watch) {
                    Ok(direction) if direction.decrement > 0.0 => {
                        self.curvature =
                            if tried == self.curvature { (GROW * tried).min(1.0) } else { tried };
                        return Ok(direction);
                    }
                    Err(Failure::Cancelled) => return Err(Failure::Cancelled),
                    _ => tried *= SHRINK,
                }
            }
            self.curvature = tried;
        }
        let positive = Hessian { weight, damping: DAMPING, least, curvature: None };
        for shift in SHIFTS {
            match self.system.solve(&state, &positive, shift, watch) {
                Err(Failure::NotPositiveDefinite) => {}
                verdict => return verdict,
            }
        }
        Err(Failure::NotPositiveDefinite)
    }

    /// The first and second derivatives of all contact energies by the distances.
    fn springs(&self, iterate: &Iterate, weight: f64) -> Vec<[f64; 2]> {
        let Some(outline) = self.problem.outline else { return Vec::new() };
        let stiffness = self.stiffness(outline, weight);
        iterate.contacts.iter().map(|contact| contact.derivatives(stiffness)).collect()
    }

    /// The next map and the length of the step; `None` where no step lowers the energy.
    fn step(&self, iterate: &Iterate, direction: &Direction, goal: &Goal) -> Option<(Iterate, f64)> {
        let along = &direction.along;
        let mut step = (MARGIN * first_fold(self.problem.energy.mesh, &iterate.map, along)).min(1.0);
        if let Some(outline) = self.problem.outline {
            let meeting = outline.longest_step(&iterate.map, along, step);
            step = if meeting < step { MARGIN * meeting } else { step };
        }
        for _ in 0..MOST_TRIALS {
            let map = parallel::map(along.len(), |v| [0, 1].map(|k| iterate.map[v][k] + step * along[v][k]));
            let next = self.iterate(map, goal);
            let allowed = iterate.value - SUFFICIENT * step * direction.decrement + 1e-16;
            let is_simple = || self.problem.outline.is_none_or(|outline| outline.is_simple(&next.map));
            if next.value <= allowed && is_simple() {
                return Some((next, step));
            }
            step *= 0.5;
        }
        None
    }
}

/// True if the last [`PATIENCE`] iterations gained less than a part of the energy.
fn has_stalled(values: &[f64], least_gain: f64) -> bool {
    let last = values[values.len() - 1];
    let before = values.len().checked_sub(PATIENCE + 1).map(|k| values[k]);
    before.is_some_and(|before| last > (1.0 - least_gain) * before)
}
