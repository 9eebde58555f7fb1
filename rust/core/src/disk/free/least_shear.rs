// SPDX-License-Identifier: MIT OR Apache-2.0
//! The search for the heaviest weight of angles at which areas are within a tolerance.

use super::descent::{Descent, Goal};
use crate::codomain::planar::PlanarMap;
use crate::control::{History, Observer, Status};

/// Factor from one weight to the next lighter one, √0.1.
const LEVEL: f64 = 0.316_227_766_016_837_94;

/// Lower bound of the weights tried.
const LIGHTEST: f64 = 1e-7;

/// A weight of angles is judged where the decrement is below this part of the energy.
const ROUGHLY: f64 = 1e-4;

/// Lowers λ of `goal` until the deviation of areas is within `tolerance`, or raises it up to `most` while it stays
/// within: `goal` ends with the heaviest such λ. Converged where there is one.
pub(super) fn least_shear(
    descent: &mut Descent<'_>,
    mut map: PlanarMap,
    goal: &mut Goal,
    (tolerance, most): (f64, f64),
    history: &mut History,
    observer: &mut dyn Observer,
) -> (PlanarMap, Status) {
    // the last λ that was too heavy, with the deviation there
    let mut heavier: Option<[f64; 2]> = None;
    let mut was_within = false;
    loop {
        let status;
        (map, status) = descent.run(map, &Goal { precision: ROUGHLY, ..*goal }, history, observer);
        let (weight, deviation) = (goal.weight, descent.deviation(&map));
        let is_within = deviation <= tolerance;
        if status == Status::Cancelled || (status == Status::MaxIterations && !is_within) {
            return (map, status);
        } else if is_within && heavier.is_none() && weight < most && status != Status::MaxIterations {
            goal.weight = weight / LEVEL.powi(2);
            continue;
        } else if is_within && (was_within || heavier.is_none() || status == Status::MaxIterations) {
            return (map, Status::Converged);
        } else if weight <= LIGHTEST {
            return (map, Status::Stalled);
        }
        goal.weight = match heavier {
            // interpolate the logarithms linearly, a little to the side of the tolerance
            Some([heavy, more]) if is_within => {
                let exponent = (more / (0.95 * tolerance)).ln() / (more / deviation).ln();
                heavy * (weight / heavy).powf(exponent.clamp(0.1, 1.0))
            }
            _ if was_within => 0.8 * weight,
            _ => LEVEL * weight,
        };
        was_within = was_within || is_within;
        if !is_within {
            heavier = Some([weight, deviation]);
        }
    }
}
