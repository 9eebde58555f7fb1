// SPDX-License-Identifier: MIT OR Apache-2.0
//! The linear system of faces and contacts for a Newton direction.
//!
//! The Hessians of the faces are factored, with the contacts' diagonal block at each vertex. Conjugate gradients with
//! this factor solve the system of faces and contacts, whose other blocks do not fit into the pattern of the mesh.
//! Cost: one factorization of two unknowns per vertex, and some ten solves where contacts act.

use super::contact::Contact;
use super::energy::{Energy, Hessian};
use super::face::Element;
use crate::codomain::planar::PlanarMap;
use crate::control::Watch;
use crate::mesh::{Corner, Face, Vertex};
use crate::parallel;
use crate::sparse::{Analysis, Factor, Failure};

/// Bounds of the relative residual that ends the conjugate gradients; it falls toward the minimum.
const RESIDUALS: [f64; 2] = [1e-4, 0.1];

/// The stiffness that holds a vertex, in units of its own.
const HOLD: f64 = 1e12;

/// Limit of the conjugate gradient steps.
const MOST_INNER: usize = 60;

/// The terms of the system at a map.
pub(super) struct Linearized<'a> {
    pub map: &'a [[f64; 2]],
    pub gradient: &'a [[f64; 2]],
    pub contacts: &'a [Contact],
    /// The first and second derivatives of the contacts by their distances.
    pub springs: &'a [[f64; 2]],
    /// The last decrement in units of the energy: how near the minimum is.
    pub ratio: f64,
}

/// A Newton direction.
pub(super) struct Direction {
    pub along: PlanarMap,
    /// −gᵀd.
    pub decrement: f64,
}

/// A system with its factor.
pub(super) struct System<'a> {
    energy: &'a Energy<'a>,
    /// The system of the faces, two unknowns at every vertex.
    analysis: &'a Analysis,
    /// Whether each vertex stays where it is; `None` where all may move.
    is_held: Option<&'a [bool]>,
    factor: Factor<f64>,
    elements: Vec<Element>,
}

impl<'a> System<'a> {
    pub(super) fn new(energy: &'a Energy<'a>, analysis: &'a Analysis, is_held: Option<&'a [bool]>) -> Self {
        let elements = vec![[[0.0; 6]; 6]; energy.mesh.n_faces()];
        Self { energy, analysis, is_held, factor: Factor::new(analysis), elements }
    }

    /// Solves for the direction with one kind of Hessian.
    pub(super) fn solve(
        &mut self,
        state: &Linearized<'_>,
        how: &Hessian,
        shift: f64,
        watch: &Watch<'_>,
    ) -> Result<Direction, Failure> {
        let (energy, analysis) = (self.energy, self.analysis);
        let is_held = |vertex: Vertex| self.is_held.is_some_and(|is_held| is_held[vertex]);
        // 1. The elements, shifted by one value for both unknowns of a corner, so that the step turns with the map
        parallel::fill(&mut self.elements, |face| {
            let mut element = energy.element(state.map, face, how);
            for c in 0..3 {
                let diagonal = 0.5 * (element[2 * c][2 * c] + element[2 * c + 1][2 * c + 1]);
                let shift = if is_held(energy.mesh.faces()[face][c]) {
                    HOLD * diagonal.abs()
                } else {
                    shift * diagonal.abs() + 1e-14 * how.weight * energy.targets[face]
                };
                (2 * c..2 * c + 2).for_each(|k| element[k][k] += shift);
            }
            element
        });
        // 2. The contacts' block at each vertex, in the first of its corners
        let shares = shares(energy, state);
        let elements = &self.elements;
        let with_contacts = |face: usize| {
            let mut element = elements[face];
            for c in 0..3 {
                if let Ok(at) = shares.binary_search_by_key(&Face::new(face).corner(c), |share| share.0) {
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
        let rhs = parallel::map(state.gradient.len(), |v| state.gradient[v].map(|g| -g));
        let along = if state.contacts.is_empty() {
            self.preconditioned(&rhs)
        } else {
            self.conjugate_gradients(state, how.curvature.unwrap_or(0.0), &rhs, watch)?
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
        self.factor.solve(self.analysis, &mut unknowns);
        unknowns.chunks_exact(2).map(|x| [x[0], x[1]]).collect()
    }

    /// The product with the Hessian of faces and contacts.
    fn product(&self, state: &Linearized<'_>, curvature: f64, x: &[[f64; 2]]) -> PlanarMap {
        let energy = self.energy;
        let by_face: Vec<[f64; 6]> = parallel::map(energy.mesh.n_faces(), |face| {
            let corners = energy.mesh.faces()[face].map(|v| x[v]);
            std::array::from_fn(|i| (0..6).map(|j| self.elements[face][i][j] * corners[j / 2][j % 2]).sum())
        });
        let mut product = energy.gathered(|corner| {
            let (of_face, c) = (&by_face[corner.face()], corner.place());
            [of_face[2 * c], of_face[2 * c + 1]]
        });
        for (contact, [force, stiffness]) in state.contacts.iter().zip(state.springs) {
            let motion: [f64; 6] = std::array::from_fn(|k| x[contact.vertices[k / 2]][k % 2]);
            let pull = stiffness * contact.slopes.iter().zip(&motion).map(|(a, b)| a * b).sum::<f64>();
            let bent = contact.curvature(&motion);
            for k in 0..6 {
                let of_entry = pull * contact.slopes[k] + curvature * force * bent[k];
                product[contact.vertices[k / 2]][k % 2] += of_entry;
            }
        }
        product
    }

    /// Conjugate gradients on the Hessian of faces and contacts, preconditioned by the factor.
    fn conjugate_gradients(
        &self,
        state: &Linearized<'_>,
        curvature: f64,
        rhs: &[[f64; 2]],
        watch: &Watch<'_>,
    ) -> Result<PlanarMap, Failure> {
        let mut x = vec![[0.0; 2]; rhs.len()];
        let mut residual = rhs.to_vec();
        let mut z = self.preconditioned(&residual);
        let mut p = z.clone();
        let mut rz = dot(&residual, &z);
        let goal = state.ratio.sqrt().clamp(RESIDUALS[0], RESIDUALS[1]).powi(2) * rz;
        for _ in 0..MOST_INNER {
            if !watch.goes_on() {
                return Err(Failure::Cancelled);
            }
            let kp = self.product(state, curvature, &p);
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
}

/// The contacts' diagonal blocks (xx, xy, yy), at the first corner of each vertex, in the order of the corners.
fn shares(energy: &Energy<'_>, state: &Linearized<'_>) -> Vec<(Corner, [f64; 3])> {
    let mut all: Vec<(Corner, [f64; 3])> = Vec::with_capacity(3 * state.contacts.len());
    for (contact, [_, stiffness]) in state.contacts.iter().zip(state.springs) {
        for (k, &v) in contact.vertices.iter().enumerate() {
            let [x, y] = [contact.slopes[2 * k], contact.slopes[2 * k + 1]];
            all.push((energy.mesh.vertex_corners(v)[0], [x * x, x * y, y * y].map(|c| stiffness * c)));
        }
    }
    // stable, so that sums have one order
    all.sort_by_key(|(corner, _)| *corner);
    let mut merged: Vec<(Corner, [f64; 3])> = Vec::new();
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
