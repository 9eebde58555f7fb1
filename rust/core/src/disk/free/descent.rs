// SPDX-License-Identifier: MIT OR Apache-2.0
//! Newton's method on the energy of a free outline and of its contacts.
//!
//! 1. The Hessians of the faces are factored, with the contacts' diagonal block at each vertex. Conjugate gradients with
//!    this factor solve the system of faces and contacts, whose other blocks do not fit into the pattern of the mesh.
//! 2. A step ends before a face folds or an outline meets itself, and where the energy falls.
//! 3. The descent has converged when the decrement −gᵀd of a full step almost vanishes: the map is stationary.
//!
//! Far from the minimum the Hessian leaves out the curvature of the area, which may be negative. Nearer to it the Hessian
//! takes as much of the curvature as leaves it positive definite, in the end all, and the descent converges quadratically.
//! Cost of one iteration: one factorization of two unknowns per vertex, and some ten solves where contacts act.

use super::contact::{Contact, Outline, Stiffness, roots};
use super::energy::{Element, Energy, Hessian};
use crate::codomain::planar::PlanarMap;
use crate::control::{History, Observer, Status, Watch};
use crate::parallel;
use crate::sparse::{Analysis, Factor, Failure};

const MESSAGE: &str = "Evening out areas";

/// μ, the damping of a face that is wholly off its target.
const DAMPING: f64 = 0.005;

/// Bounds of the deviation that the damping adds to every face.
const LEAST_DEVIATIONS: [f64; 2] = [1e-6, 1e-3];

/// Shifts of the Hessian in units of its diagonal, tried in this order until it is positive definite.
const SHIFTS: [f64; 5] = [1e-12, 1e-10, 1e-8, 1e-6, 1e-4];

/// A step covers at most this part of the way to the first fold or meeting of outlines.
const MARGIN: f64 = 0.9;

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

/// Bounds of the relative residual that ends the conjugate gradients; it falls towards the minimum.
const RESIDUALS: [f64; 2] = [1e-4, 0.1];

/// Limit of the conjugate gradient steps.
const MOST_INNER: usize = 60;

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
pub(super) struct Problem<'a> {
    pub energy: &'a Energy<'a>,
    /// The system of the faces, two unknowns at every vertex.
    pub analysis: &'a Analysis,
    /// The outline that must not cross itself; `None` where it may.
    pub outline: Option<&'a Outline>,
}

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

struct Direction {
    along: PlanarMap,
    /// −gᵀd.
    decrement: f64,
}

/// The state of the iterations.
pub(super) struct Descent<'a> {
    problem: Problem<'a>,
    factor: Factor<f64>,
    elements: Vec<Element>,
    /// The part of the curvature of areas to try next.
    curvature: f64,
    /// The last decrement in units of the energy.
    ratio: f64,
    pub done: usize,
}

impl<'a> Descent<'a> {
    pub(super) fn new(problem: Problem<'a>) -> Self {
        let factor = Factor::new(problem.analysis);
        let elements = vec![[[0.0; 6]; 6]; problem.energy.mesh.n_faces()];
        Self { problem, factor, elements, curvature: 1.0, ratio: f64::INFINITY, done: 0 }
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
            iterate = next;
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
        for (contact, [force, _]) in iterate.contacts.iter().zip(&springs) {
            for (k, &v) in contact.vertices.iter().enumerate() {
                (0..2).for_each(|axis| gradient[v as usize][axis] += force * contact.slopes[2 * k + axis]);
            }
        }
        // 2. The Hessian, exact where that is positive definite
        let deviation = energy.parts(&iterate.map).deviation.sqrt();
        let least = deviation.clamp(LEAST_DEVIATIONS[0], LEAST_DEVIATIONS[1]);
        if self.ratio < NEAR {
            let mut tried = self.curvature;
            for _ in 0..MOST_ATTEMPTS {
                let damping = DAMPING * (1.0 - tried);
                let hessian = Hessian { weight, damping, least, curvature: tried };
                match self.solve(iterate, &hessian, &springs, &gradient, SHIFTS[1], watch) {
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
        let composite = Hessian { weight, damping: DAMPING, least, curvature: 0.0 };
        for shift in SHIFTS {
            match self.solve(iterate, &composite, &springs, &gradient, shift, watch) {
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

    /// Solves for the direction with one kind of Hessian.
    fn solve(
        &mut self,
        iterate: &Iterate,
        how: &Hessian,
        springs: &[[f64; 2]],
        gradient: &[[f64; 2]],
        shift: f64,
        watch: &Watch<'_>,
    ) -> Result<Direction, Failure> {
        let (energy, analysis) = (self.problem.energy, self.problem.analysis);
        // 1. The elements, shifted by one value for both unknowns of a corner, so that the step turns with the map
        parallel::fill(&mut self.elements, |face| {
            let mut element = energy.element(&iterate.map, face, how);
            for c in 0..3 {
                let diagonal = 0.5 * (element[2 * c][2 * c] + element[2 * c + 1][2 * c + 1]);
                let shift = shift * diagonal.abs() + 1e-14 * how.weight * energy.targets[face];
                (2 * c..2 * c + 2).for_each(|k| element[k][k] += shift);
            }
            element
        });
        // 2. The contacts' block at each vertex, in the first of its corners
        let shares = shares(energy, &iterate.contacts, springs);
        let elements = &self.elements;
        let with_contacts = |face: usize| {
            let mut element = elements[face];
            for c in 0..3 {
                if let Ok(at) = shares.binary_search_by_key(&((3 * face + c) as u32), |share| share.0) {
                    let block = shares[at].1;
                    element[2 * c][2 * c] += block[0];
                    element[2 * c + 1][2 * c] += block[1];
                    element[2 * c][2 * c + 1] += block[1];
                    element[2 * c + 1][2 * c + 1] += block[2];
                }
            }
            element
        };
        self.factor.refactor(analysis, &with_contacts, watch)?;
        // 3. One solve, or conjugate gradients
        let rhs = parallel::map(gradient.len(), |v| gradient[v].map(|g| -g));
        let along = if iterate.contacts.is_empty() {
            self.preconditioned(&rhs)
        } else {
            self.conjugate_gradients(&iterate.contacts, springs, how.curvature, &rhs, watch)?
        };
        let decrement = dot(&rhs, &along);
        if !decrement.is_finite() {
            return Err(Failure::NotPositiveDefinite);
        }
        Ok(Direction { along, decrement })
    }

    /// Solves with the factor.
    fn preconditioned(&self, rhs: &[[f64; 2]]) -> PlanarMap {
        let mut unknowns: Vec<f64> = rhs.iter().flatten().copied().collect();
        self.factor.solve(self.problem.analysis, &mut unknowns);
        unknowns.chunks_exact(2).map(|x| [x[0], x[1]]).collect()
    }

    /// The product with the Hessian of faces and contacts.
    fn product(
        &self,
        contacts: &[Contact],
        springs: &[[f64; 2]],
        curvature: f64,
        x: &[[f64; 2]],
    ) -> PlanarMap {
        let energy = self.problem.energy;
        let by_face: Vec<[f64; 6]> = parallel::map(energy.mesh.n_faces(), |face| {
            let corners = energy.mesh.faces()[face].map(|v| x[v as usize]);
            std::array::from_fn(|i| (0..6).map(|j| self.elements[face][i][j] * corners[j / 2][j % 2]).sum())
        });
        let mut product = energy.gathered(|corner| {
            let (of_face, c) = (&by_face[corner / 3], corner % 3);
            [of_face[2 * c], of_face[2 * c + 1]]
        });
        for (contact, [force, stiffness]) in contacts.iter().zip(springs) {
            let motion: [f64; 6] = std::array::from_fn(|k| x[contact.vertices[k / 2] as usize][k % 2]);
            let pull = stiffness * contact.slopes.iter().zip(&motion).map(|(a, b)| a * b).sum::<f64>();
            let bent = contact.curvature(&motion);
            for k in 0..6 {
                let of_entry = pull * contact.slopes[k] + curvature * force * bent[k];
                product[contact.vertices[k / 2] as usize][k % 2] += of_entry;
            }
        }
        product
    }

    /// Conjugate gradients on the Hessian of faces and contacts, preconditioned by the factor.
    fn conjugate_gradients(
        &self,
        contacts: &[Contact],
        springs: &[[f64; 2]],
        curvature: f64,
        rhs: &[[f64; 2]],
        watch: &Watch<'_>,
    ) -> Result<PlanarMap, Failure> {
        let mut x = vec![[0.0; 2]; rhs.len()];
        let mut residual = rhs.to_vec();
        let mut z = self.preconditioned(&residual);
        let mut p = z.clone();
        let mut rz = dot(&residual, &z);
        let goal = self.ratio.sqrt().clamp(RESIDUALS[0], RESIDUALS[1]).powi(2) * rz;
        for _ in 0..MOST_INNER {
            if !watch.goes_on() {
                return Err(Failure::Cancelled);
            }
            let kp = self.product(contacts, springs, curvature, &p);
            let stiffness = dot(&p, &kp);
            if stiffness.is_nan() || stiffness <= 0.0 {
                return Err(Failure::NotPositiveDefinite);
            }
            let step = rz / stiffness;
            add(&mut x, step, &p);
            add(&mut residual, -step, &kp);
            z = self.preconditioned(&residual);
            let next = dot(&residual, &z);
            if next <= goal {
                break;
            }
            let ratio = next / rz;
            p = parallel::map(z.len(), |v| [0, 1].map(|k| z[v][k] + ratio * p[v][k]));
            rz = next;
        }
        Ok(x)
    }

    /// The next map and the length of the step; `None` where no step lowers the energy.
    fn step(&self, iterate: &Iterate, direction: &Direction, goal: &Goal) -> Option<(Iterate, f64)> {
        let along = &direction.along;
        let mut step = (MARGIN * self.first_fold(&iterate.map, along)).min(1.0);
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

    /// The first step at which a face loses its area.
    fn first_fold(&self, map: &[[f64; 2]], along: &[[f64; 2]]) -> f64 {
        let energy = self.problem.energy;
        let cross = |x: [f64; 2], y: [f64; 2]| x[0] * y[1] - x[1] * y[0];
        let first = parallel::map(energy.mesh.n_faces(), |face| {
            let edges = |of: &[[f64; 2]]| {
                let [o, p, q] = energy.mesh.faces()[face].map(|v| of[v as usize]);
                [[p[0] - o[0], p[1] - o[1]], [q[0] - o[0], q[1] - o[1]]]
            };
            let ([p, q], [dp, dq]) = (edges(map), edges(along));
            let of_face = roots(cross(p, q), cross(p, dq) + cross(dp, q), cross(dp, dq), 1.0);
            of_face.into_iter().flatten().filter(|&t| t > 0.0).fold(f64::INFINITY, f64::min)
        });
        first.into_iter().fold(f64::INFINITY, f64::min)
    }
}

/// True if the last [`PATIENCE`] iterations gained less than a part of the energy.
fn has_stalled(values: &[f64], least_gain: f64) -> bool {
    let last = values[values.len() - 1];
    let before = values.len().checked_sub(PATIENCE + 1).map(|k| values[k]);
    before.is_some_and(|before| last > (1.0 - least_gain) * before)
}

/// The contacts' diagonal blocks (xx, xy, yy), at the first corner of each vertex, in the order of the corners.
fn shares(energy: &Energy<'_>, contacts: &[Contact], springs: &[[f64; 2]]) -> Vec<(u32, [f64; 3])> {
    let mut all: Vec<(u32, [f64; 3])> = Vec::with_capacity(3 * contacts.len());
    for (contact, [_, stiffness]) in contacts.iter().zip(springs) {
        for (k, &v) in contact.vertices.iter().enumerate() {
            let [x, y] = [contact.slopes[2 * k], contact.slopes[2 * k + 1]];
            all.push((
                energy.mesh.vertex_corners(v as usize)[0],
                [x * x, x * y, y * y].map(|c| stiffness * c),
            ));
        }
    }
    // stable, so that sums have one order
    all.sort_by_key(|(corner, _)| *corner);
    let mut merged: Vec<(u32, [f64; 3])> = Vec::new();
    for (corner, block) in all {
        match merged.last_mut() {
            Some((last, sum)) if *last == corner => (0..3).for_each(|k| sum[k] += block[k]),
            _ => merged.push((corner, block)),
        }
    }
    merged
}

fn dot(a: &[[f64; 2]], b: &[[f64; 2]]) -> f64 {
    parallel::sum(a.len(), |v| a[v][0] * b[v][0] + a[v][1] * b[v][1])
}

fn add(x: &mut [[f64; 2]], factor: f64, y: &[[f64; 2]]) {
    parallel::fill_with_old(x, |v, old| [0, 1].map(|k| old[k] + factor * y[v][k]));
}
