// SPDX-License-Identifier: MIT OR Apache-2.0
//! Unfolds one patch: first to any places without folds, then to those nearest to the old ones.

use super::closest::closest;
use super::foldover::{Springs, unfold};
use super::newton::Newton;
use super::patch::{CLOSED, Patch};
use crate::control::{Status, Watch};
use crate::error::Error;

/// Cotangent of the angles of an equilateral triangle.
const EQUILATERAL: f64 = 0.577_350_269_189_625_8;

/// A patch starts from Tutte's embedding if more than one face out of so many is folded.
const HEAVY: usize = 3;

/// Faces from which on a patch is tried from one start only, unless it is the last.
const LARGE: usize = 3000;

/// The effort spent on a patch.
#[derive(Debug, Clone, Copy)]
pub(super) struct Effort {
    /// Whether unfolded faces may stay below their least areas.
    pub is_thin_enough: bool,
    /// Whether no larger patch comes after this one.
    pub is_last: bool,
}

/// Places without folds.
struct Unfolded {
    places: Vec<[f64; 2]>,
    /// Whether a face is below its least area.
    is_thin: bool,
}

/// The outcome of a patch.
pub(super) enum Outcome {
    /// Places in the chart without folds, with their status.
    Open(Vec<[f64; 2]>, Status),
    /// Faces stay folded.
    Folded,
}

impl Patch {
    /// Unfolds the patch, and brings its vertices back as far as possible.
    ///
    /// # Errors
    /// [`Error::CancelledEarly`] if cancelled while there are folds.
    pub(super) fn solved(&self, effort: Effort, watch: &Watch<'_>) -> Result<Outcome, Error> {
        let mut newton = Newton::new(self)?;
        // 1. Any places without folds
        let Some(Unfolded { places: start, is_thin }) = self.unfolded(&mut newton, effort, watch)? else {
            return Ok(Outcome::Folded);
        };
        let kept = |face: usize| self.floors[face].min(0.5 * self.ratio(&start, face));
        let floors: Vec<f64> = (0..self.faces.len()).map(kept).collect();
        // 2. The nearest such places
        let (places, is_done) = closest(&mut newton, self, &floors, start, watch);
        let status = match (is_done, is_thin) {
            (false, _) => Status::Cancelled,
            (true, true) => Status::Stalled,
            (true, false) => Status::Converged,
        };
        Ok(Outcome::Open(places, status))
    }

    /// Some places without folds; `None` if none were found.
    fn unfolded(
        &self,
        newton: &mut Newton<'_>,
        effort: Effort,
        watch: &Watch<'_>,
    ) -> Result<Option<Unfolded>, Error> {
        let value = newton.value(&Springs, &self.present);
        let tutte = newton.step(&Springs, &self.present, value, watch)?.map(|step| step.places);
        let equilateral = vec![[EQUILATERAL; 3]; self.faces.len()];
        // the present places are nearer to the result if few faces are folded, Tutte's embedding if many are; on large
        // patches it takes fewer steps
        let is_folded = |face: &usize| self.ratio(&self.present, *face) <= 0.0;
        let n_folded = (0..self.faces.len()).filter(is_folded).count();
        let mut starts = [Some(&self.present), tutte.as_ref()];
        if HEAVY * n_folded > self.faces.len() || self.faces.len() >= LARGE {
            starts.reverse();
        }
        let attempts =
            [(starts[0], &self.cotangents), (starts[1], &self.cotangents), (tutte.as_ref(), &equilateral)];
        let n_attempts = match self.faces.len() {
            _ if effort.is_last => attempts.len(),
            0..LARGE => 2,
            _ => 1,
        };
        for (start, rest) in attempts.into_iter().take(n_attempts) {
            let Some(start) = start else { continue };
            let places = unfold(newton, self, rest, start.clone(), effort.is_last, watch)?;
            if self.misses(&places) == 0 {
                return Ok(Some(Unfolded { places, is_thin: false }));
            }
            if effort.is_thin_enough && self.least_ratio(&places) > CLOSED {
                return Ok(Some(Unfolded { places, is_thin: true }));
            }
        }
        Ok(None)
    }
}
