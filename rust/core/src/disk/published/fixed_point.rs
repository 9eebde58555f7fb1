// SPDX-License-Identifier: MIT OR Apache-2.0
//! The fixed-point iteration of stretch energy minimization on the disk.
//!
//! Liu & Yueh (2023), equation (2.5): [L_S(f⁽ᵏ⁾)]_II f_I⁽ᵏ⁺¹⁾ = −[L_S(f⁽ᵏ⁾)]_IB b. Subtracting the same
//! product with f⁽ᵏ⁾ gives the form used here: f⁽ᵏ⁺¹⁾ = f⁽ᵏ⁾ − M_k⁻¹ ∇E(f⁽ᵏ⁾) with M_k = 2 I₂ ⊗ L_S(f⁽ᵏ⁾),
//! the unit step along the direction that the conjugate gradients begin with, so both share one objective.
//!
//! The energy may rise from one iteration to the next; the map with the lowest is returned.
//!
//! Cost of one iteration: one numeric Cholesky factorization of the interior and two solves.

use super::objective::DiskObjective;
use crate::codomain::planar::PlanarMap;
use crate::control::{History, Observer, Status, Watch};
use crate::error::Error;
use crate::optimize::published::{Objective, Stopping};
use crate::parallel;

const MESSAGE: &str = "Fixed-point iteration";

/// Halvings of a step before it is given up.
const HALVINGS: i32 = 20;

/// Iterates from `start` and returns the map of lowest energy.
pub(crate) fn fixed_point(
    objective: &mut DiskObjective<'_>,
    start: PlanarMap,
    stopping: &Stopping,
    history: &mut History,
    observer: &mut dyn Observer,
) -> (PlanarMap, Status) {
    let mut step = 0.0;
    let (mut best, mut map) = ((f64::INFINITY, start.clone()), start);
    for done in 0.. {
        // 1. Keep the best map; M of the current one and the step it asks for
        let (energies, gradient) = objective.gradient(&map);
        if energies.authalic_energy < best.0 {
            best = (energies.authalic_energy, map.clone());
        }
        let fraction = done as f64 / stopping.max_iterations.max(1) as f64;
        match objective.set_preconditioner(&map, &Watch::new(observer, fraction.min(1.0), MESSAGE)) {
            Ok(()) => {}
            Err(Error::CancelledEarly) => return (best.1, Status::Cancelled),
            Err(_) => return (best.1, Status::Stalled),
        }
        let correction = objective.precondition(&map, &gradient);
        let norm = parallel::dot(&gradient, &correction).max(0.0).sqrt();
        match done {
            0 => history.push_start(energies.authalic_energy, norm),
            _ => history.push(energies.authalic_energy, step, norm),
        }
        // 2. Stop where converged or at a limit
        if let Some(status) = stopping.verdict(done, norm, MESSAGE, observer) {
            return (best.1, status);
        }
        // 3. The unit step
        match allowed_step(objective, &map, &correction) {
            Some(next) => (step, map) = next,
            None => return (best.1, Status::Stalled),
        }
    }
    unreachable!("the stopping rule ends the loop")
}

/// The unit step along −`correction`, halved while a sliding boundary would lose its order.
fn allowed_step(
    objective: &DiskObjective<'_>,
    map: &PlanarMap,
    correction: &[f64],
) -> Option<(f64, PlanarMap)> {
    let steps = (0..HALVINGS).map(|halving| 0.5f64.powi(halving));
    let mut tried = steps.map(|step| (step, objective.retract(map, correction, -step)));
    tried.find(|(_, moved)| objective.value(moved).is_finite())
}
