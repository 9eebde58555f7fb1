// SPDX-License-Identifier: MIT OR Apache-2.0
//! The nonlinear heat diffusion of Shi et al. (2013), algorithm 4: the explicit gradient flow of the harmonic
//! energy.
//!
//! Every image moves along the geodesic of minus its gradient over its area, all by the longest time step
//! that is stable on the whole surface. The energy falls with every step. The diffusion takes thousands of steps
//! where [`newton`](super::newton::newton) takes four; it is there for comparison.
//!
//! Cost: one pass over the edges per step.

use super::chart_map::ChartMap;
use super::newton::Descent;
use crate::control::{Observer, Status};
use crate::hyperbolic::moebius::Complex;
use crate::parallel;

/// Time step relative to the longest stable one.
const CAUTION: f64 = 0.9;
/// Steps between two checks for cancellation.
const BETWEEN_CHECKS: usize = 10;

/// Lowers E in place for at most `max_steps` steps, until the largest component of the gradient is below
/// `tolerance`.
///
/// `areas` (n,) are the vertices' shares of the source's hyperbolic area.
pub(crate) fn diffuse(
    map: &mut ChartMap<'_>,
    areas: &[f64],
    max_steps: usize,
    tolerance: f64,
    observer: &mut dyn Observer,
) -> Descent {
    let stiffness = map.stiffness();
    let stable = |vertex: usize| areas[vertex] / stiffness[vertex].max(f64::MIN_POSITIVE);
    let is_free = |vertex: &usize| map.places.held[*vertex].is_none();
    let time_step = CAUTION * (0..areas.len()).filter(is_free).map(stable).fold(f64::INFINITY, f64::min);
    let mut energies = vec![map.energy()];
    for step in 0..=max_steps {
        // 1. The gradient
        let slopes = map.gradient_now();
        let gradient = slopes.iter().fold(0.0, |most: f64, g| most.max(g.re.abs()).max(g.im.abs()));
        let fraction = step as f64 / max_steps.max(1) as f64;
        let is_asked = step % BETWEEN_CHECKS == 0;
        let status = match () {
            () if gradient <= tolerance => Status::Converged,
            () if step == max_steps => Status::MaxIterations,
            () if is_asked && !observer.progress(fraction, "Heat diffusion") => Status::Cancelled,
            () => {
                // 2. One step of the flow
                let velocities: Vec<Complex> =
                    parallel::map(areas.len(), |vertex| -slopes[vertex] / areas[vertex]);
                map.recharted(map.moved(&velocities, time_step));
                energies.push(map.energy());
                continue;
            }
        };
        return Descent { energies, gradient, status };
    }
    unreachable!("the last step returns")
}
