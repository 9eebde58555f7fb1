// SPDX-License-Identifier: MIT OR Apache-2.0
//! The fixed-point iteration of stretch energy minimisation on the disk.
//!
//! Liu & Yueh (2023), equation (2.5): [L_S(f⁽ᵏ⁾)]_II f_I⁽ᵏ⁺¹⁾ = −[L_S(f⁽ᵏ⁾)]_IB b. Subtracting the same
//! product with f⁽ᵏ⁾ gives the form used here: f⁽ᵏ⁺¹⁾ = f⁽ᵏ⁾ − M_k⁻¹ ∇E(f⁽ᵏ⁾) with M_k = 2 I₂ ⊗ L_S(f⁽ᵏ⁾),
//! the unit step along the direction that the conjugate gradients begin with, so both share one domain.
//!
//! The energy may rise from one iteration to the next; the map with the lowest is returned.
//!
//! Cost of one iteration: one numeric Cholesky factorisation of the interior and two solves.

use super::Map;
use super::domain::DiskDomain;
use crate::control::{History, Observer, Status};
use crate::optimize::Domain;
use crate::parallel;

/// Halvings of a step before it is given up.
const HALVINGS: i32 = 20;

/// When [`fixed_point`] ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FixedPointOptions {
    /// Iterations at the most.
    pub max_iterations: usize,
    /// Converged when √(gᵀM⁻¹g) falls below this.
    pub tolerance: f64,
}

/// Iterates from `start` and returns the map of lowest energy.
pub(super) fn fixed_point(
    domain: &mut DiskDomain<'_>,
    start: Map,
    options: &FixedPointOptions,
    history: &mut History,
    observer: &mut dyn Observer,
) -> (Map, Status) {
    let mut step = 0.0;
    let (mut best, mut map) = ((f64::INFINITY, start.clone()), start);
    for iteration in 0..=options.max_iterations {
        // 1. Keep the best map; M of the current one and the step it asks for
        let (energies, gradient) = domain.gradient(&map);
        let energy = energies.authalic_energy;
        if energy < best.0 {
            best = (energy, map.clone());
        }
        if domain.set_preconditioner(&map).is_err() {
            return (best.1, Status::Stalled);
        }
        let correction = domain.precondition(&gradient);
        let norm = parallel::dot(&gradient, &correction).max(0.0).sqrt();
        match iteration {
            0 => history.push_start(energy, norm),
            _ => history.push(energy, step, norm),
        }
        // 2. Enough?
        if norm <= options.tolerance {
            return (best.1, Status::Converged);
        }
        if iteration == options.max_iterations {
            break;
        }
        if !observer.progress(iteration as f64 / options.max_iterations as f64, "Fixed-point iteration") {
            return (best.1, Status::Cancelled);
        }
        // 3. The unit step
        match allowed_step(domain, &map, &correction) {
            Some(next) => (step, map) = next,
            None => return (best.1, Status::Stalled),
        }
    }
    (best.1, Status::MaxIterations)
}

/// The unit step along −`correction`, halved while a sliding boundary would lose its order.
fn allowed_step(domain: &DiskDomain<'_>, map: &Map, correction: &[f64]) -> Option<(f64, Map)> {
    let steps = (0..HALVINGS).map(|halving| 0.5f64.powi(halving));
    let mut tried = steps.map(|step| (step, domain.retract(map, correction, -step)));
    tried.find(|(_, moved)| domain.objective(moved).is_finite())
}
