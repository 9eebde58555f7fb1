// SPDX-License-Identifier: MIT OR Apache-2.0
//! A cut with what the plate predicts for it, and the figures by which cuts are compared.

use super::{Search, Workspace};
use crate::control::{Observer, Watch};
use crate::error::Error;
use crate::mesh::Edge;
use crate::seams::cut::Cut;

/// The logarithm of the largest σ₁/σ₂ that counts: far from the target the prediction explodes.
const LARGEST: f64 = 2.5;

/// A cut and the deflection of its plate.
#[derive(Debug, Clone)]
pub(in crate::seams) struct State {
    pub cut: Cut,
    /// ψ at each vertex, (n,).
    pub psi: Vec<f64>,
    /// ln(σ₁/σ₂) of each face as predicted, (m,).
    pub shear: Vec<f64>,
    pub n_islands: usize,
}

/// The predicted shear of a cut.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::seams) struct Figures {
    /// The mean of σ₁/σ₂, weighted by area.
    pub mean: f64,
    /// Its 99th percentile, weighted by area.
    pub percentile: f64,
}

/// What a change of the cut does.
#[derive(Debug, Clone)]
pub(super) struct Trial {
    pub state: State,
    /// The distortion after less that before.
    pub increase: f64,
}

impl Search<'_> {
    /// The state of a cut.
    pub(in crate::seams) fn state(&mut self, cut: Cut, observer: &mut dyn Observer) -> Result<State, Error> {
        let problem = self.problem;
        let n_islands = cut.islands(problem.mesh).len();
        let mut deflections = self.for_each(1, observer, |_, workspace, watch| {
            problem.plate.solve(problem.mesh, &cut, None, workspace, watch)
        })?;
        let deflection = deflections.remove(0);
        Ok(State { cut, psi: deflection.psi, shear: deflection.shear, n_islands })
    }

    /// The state after the cut has become `cut`, by a solve on the islands that change.
    pub(super) fn trial(
        &self,
        state: &State,
        cut: Cut,
        n_islands: usize,
        workspace: &mut Workspace,
        watch: &Watch<'_>,
    ) -> Result<Trial, Error> {
        let faces = self.changed_faces(state, &cut);
        let deflection = self.problem.plate.solve(self.problem.mesh, &cut, Some(&faces), workspace, watch)?;
        let (mut psi, mut shear) = (state.psi.clone(), state.shear.clone());
        for ((face, &corners), _) in self
            .problem
            .mesh
            .mesh
            .faces()
            .iter()
            .enumerate()
            .zip(&faces)
            .filter(|(_, is_changed)| **is_changed)
        {
            shear[face] = deflection.shear[face];
            corners.iter().for_each(|&vertex| psi[vertex] = deflection.psi[vertex]);
        }
        let increase = self.distortion(&shear) - self.distortion(&state.shear);
        Ok(Trial { state: State { cut, psi, shear, n_islands }, increase })
    }

    /// The faces of all islands in which two cuts differ.
    fn changed_faces(&self, state: &State, cut: &Cut) -> Vec<bool> {
        let mesh = self.problem.mesh;
        let differs = |edge: &Edge| state.cut.is_seam(*edge) != cut.is_seam(*edge);
        let changed: Vec<_> = mesh.edges.all().filter(differs).collect();
        let labels = state.cut.without(&changed).islands(mesh).of_face;
        let mut is_changed = vec![false; mesh.n_faces()];
        for &edge in &changed {
            let (first, second) = mesh.faces_at(edge);
            is_changed[labels[first] as usize] = true;
            second.into_iter().for_each(|second| is_changed[labels[second] as usize] = true);
        }
        labels.iter().map(|&label| is_changed[label as usize]).collect()
    }

    /// Σ A φ(k).
    pub(super) fn distortion(&self, shear: &[f64]) -> f64 {
        let price = |shear: f64| {
            let ratio = shear.min(LARGEST).exp();
            ratio - 1.0 + (ratio - self.problem.bound).max(0.0)
        };
        self.problem.mesh.areas.iter().zip(shear).map(|(area, &shear)| area * price(shear)).sum()
    }

    /// The figures of a predicted shear.
    pub(in crate::seams) fn figures(&self, shear: &[f64]) -> Figures {
        Figures::of(&self.problem.mesh.areas, shear)
    }
}

impl Figures {
    /// The figures of ln(σ₁/σ₂) on faces of given areas, which sum to 1.
    pub(in crate::seams) fn of(areas: &[f64], shear: &[f64]) -> Self {
        /// The logarithm of the largest ratio that is a number of use.
        const OVERFLOW: f64 = 8.0;
        let ratio = |shear: f64| shear.min(OVERFLOW).exp();
        let mean: f64 = areas.iter().zip(shear).map(|(area, &shear)| area * ratio(shear)).sum();
        let mut order: Vec<_> = shear.iter().copied().zip(areas.iter().copied()).collect();
        order.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut above = 0.0;
        let beyond = order.iter().find(|(_, area)| {
            above += area;
            above > 0.01
        });
        // areas may sum to a little less than 1
        Self { mean: mean.max(1.0), percentile: ratio(beyond.map_or(0.0, |(shear, _)| *shear)) }
    }
}
