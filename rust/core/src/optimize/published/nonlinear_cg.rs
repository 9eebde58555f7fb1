// SPDX-License-Identifier: MIT OR Apache-2.0
//! Preconditioned nonlinear conjugate gradients.
//!
//! Liu & Yueh (2023), Algorithm 3.1: the direction (3.4) with the Fletcher–Reeves β in the metric of M⁻¹,
//! the step of the quadratic model (3.3), and, where that step violates the strong Wolfe conditions (4.1)
//! that the proof of convergence needs, a line search that satisfies them (0 < c₁ < c₂ < ½).
//!
//! Cost of one iteration: one evaluation of the objective (for the model), one of the gradient for every step tried,
//! nearly always a single one, and one solve with M.

use super::line_search::{Trial, WolfeOptions, strong_wolfe};
use super::{Energies, Objective, Stopping};
use crate::control::{History, Observer, Status};
use crate::parallel;

/// Options of [`minimize`].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CgOptions {
    /// When to end.
    pub stopping: Stopping,
    /// The strong Wolfe conditions.
    pub wolfe: WolfeOptions,
}

/// A map on the way with all that the next iteration needs of it.
#[derive(Clone)]
struct State<M> {
    map: M,
    energies: Energies,
    gradient: Vec<f64>,
}

/// Lowers the objective from `start` and returns the last map, which has the lowest objective, with the status.
pub fn minimize<D: Objective>(
    objective: &D,
    start: D::Map,
    options: &CgOptions,
    history: &mut History,
    observer: &mut dyn Observer,
) -> (D::Map, Status) {
    // 1. Gradient g, preconditioned gradient h = M⁻¹g, direction p = −h
    let (energies, gradient) = objective.gradient(&start);
    let mut state = State { map: start, energies, gradient };
    let mut h = objective.precondition(&state.map, &state.gradient);
    let mut norm2 = parallel::dot(&state.gradient, &h);
    let mut direction = descent(&h);
    let mut step = 1.0;
    history.push_start(state.energies.authalic_energy, norm2.max(0.0).sqrt());
    for done in 0.. {
        let norm = norm2.max(0.0).sqrt();
        if let Some(status) = options.stopping.verdict(done, norm, "Minimizing the stretch energy", observer)
        {
            return (state.map, status);
        }
        // 2. A step along p by the quadratic model, safeguarded; back to −h once where p gives none
        let trial = line_step(objective, &state, &direction, step, &options.wolfe).or_else(|| {
            direction = descent(&h);
            line_step(objective, &state, &direction, 1.0, &options.wolfe)
        });
        let Some(trial) = trial else {
            return (state.map, Status::Stalled);
        };
        (step, state) = (trial.step, trial.data.expect("an accepted trial has its state"));
        // 3. Fletcher–Reeves in the metric of M⁻¹: β = hᵀg / λ
        h = objective.precondition(&state.map, &state.gradient);
        let last_norm2 = std::mem::replace(&mut norm2, parallel::dot(&state.gradient, &h));
        let beta = norm2 / last_norm2;
        parallel::fill_with_old(&mut direction, |i, p| beta * p - h[i]);
        history.push(state.energies.authalic_energy, step, norm2.max(0.0).sqrt());
    }
    unreachable!("the stopping rule ends the loop")
}

fn descent(h: &[f64]) -> Vec<f64> {
    parallel::map(h.len(), |i| -h[i])
}

/// The step (3.3) from φ(0), φ'(0) and φ at the last step, accepted under the strong Wolfe conditions or
/// searched for.
fn line_step<D: Objective>(
    objective: &D,
    state: &State<D::Map>,
    direction: &[f64],
    last_step: f64,
    wolfe: &WolfeOptions,
) -> Option<Trial<Option<State<D::Map>>>> {
    let slope = parallel::dot(&state.gradient, direction);
    if slope >= 0.0 || !slope.is_finite() {
        return None;
    }
    let value = state.energies.objective;
    let start = Trial { step: 0.0, value, slope, data: None };
    let last = objective.value(&objective.retract(&state.map, direction, last_step));
    let bend = last - value - last_step * slope;
    let quadratic = -0.5 * last_step * last_step * slope / bend;
    let first = match bend {
        // the last step is not allowed any more: well before it
        bend if !bend.is_finite() => 0.5 * last_step,
        bend if bend > 0.0 => quadratic.min(10.0 * last_step),
        // still descending there: beyond it
        _ => 2.0 * last_step,
    };
    let evaluate = |step: f64| evaluate(objective, state, direction, step);
    strong_wolfe(&start, evaluate(first), wolfe, evaluate)
}

/// φ and φ' at `step`, with the map and the gradient there.
fn evaluate<D: Objective>(
    objective: &D,
    state: &State<D::Map>,
    direction: &[f64],
    step: f64,
) -> Trial<Option<State<D::Map>>> {
    let map = objective.retract(&state.map, direction, step);
    let (energies, gradient) = objective.gradient(&map);
    let slope = parallel::dot(&gradient, direction);
    Trial { step, value: energies.objective, slope, data: Some(State { map, energies, gradient }) }
}
