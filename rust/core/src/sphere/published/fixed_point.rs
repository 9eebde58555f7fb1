// SPDX-License-Identifier: MIT OR Apache-2.0
//! The fixed-point iteration of stretch energy minimization on the sphere.
//!
//! Yueh, Lin, Lin & Yau (2019) as restated by Sutti & Yueh (2024), Algorithm 2: hemisphere by hemisphere, in
//! the stereographic chart of the one whose turn it is, the vertices |h_i| < r solve
//!
//! ```text
//! [L_S(f)]_II h_I = −[L_S(f)]_IB h_B,
//! ```
//!
//! and the whole chart is divided by the median modulus. The iteration ends when E_S falls by no more than ε.
//!
//! Three things differ from the paper. Its inversions mirror the map each time; here the chart changes instead, which
//! keeps the orientation. Here E_S is taken with image and targets scaled to the sphere's area, so that a smaller image
//! does not count as progress. The paper's median counts vertices, which on a mesh with more vertices on one hemisphere
//! pushes area across the equator after every step; here it counts target area, which an area-preserving map does
//! halve. On meshes of even density the two agree.
//!
//! Cost of one iteration: one Cholesky analysis and factorization of about 0.6 n vertices.

use super::objective::SphereObjective;
use crate::codomain::SpatialMap;
use crate::control::{History, Observer, Status, Watch};
use crate::error::Error;
use crate::optimize::published::Objective;
use crate::parallel;
use crate::sparse::{Cholesky, Laplacian, solve_dirichlet};
use crate::sphere::stereographic::{Chart, weighted_median};

/// r of the algorithm: modulus up to which a chart's vertices are solved for.
const RADIUS: f64 = 1.2;

const MESSAGE: &str = "Fixed-point iteration";

/// The end of the iteration.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FixedPointStopping {
    /// Iteration limit.
    pub max_iterations: usize,
    /// ε: the iteration ends when E_S falls by no more than this; −∞ takes all iterations and returns the last map
    /// instead of the best.
    pub tolerance: f64,
}

/// Iterates from `start`; `weights` are the vertices' shares of the target area.
pub(crate) fn fixed_point(
    objective: &SphereObjective<'_>,
    weights: &[f64],
    start: SpatialMap,
    stopping: &FixedPointStopping,
    history: &mut History,
    observer: &mut dyn Observer,
) -> (SpatialMap, Status) {
    let stretch = |map: &SpatialMap| objective.energy().value(map).objective;
    let (mut map, mut chart) = (start, Chart::North);
    let mut energy = stretch(&map);
    record(objective, &map, history, true);
    for done in 0.. {
        // 1. Stop where converged or at a limit
        if done >= stopping.max_iterations {
            return (map, Status::MaxIterations);
        }
        let fraction = done as f64 / stopping.max_iterations as f64;
        if !observer.progress(fraction, MESSAGE) {
            return (map, Status::Cancelled);
        }
        // 2. The other hemisphere's chart, solved and rescaled
        chart = chart.inverted();
        let watch = Watch::new(observer, fraction, MESSAGE);
        let moved = match iterate(objective, weights, &map, chart, &watch) {
            Ok(moved) => moved,
            Err(Error::CancelledEarly) => return (map, Status::Cancelled),
            Err(_) => return (map, Status::Stalled),
        };
        // 3. δ = E_S(g) − E_S(f)
        let delta = energy - stretch(&moved);
        if stopping.tolerance > f64::NEG_INFINITY && (delta <= 0.0 || delta.is_nan()) {
            return (map, Status::Converged);
        }
        (map, energy) = (moved, energy - delta);
        record(objective, &map, history, false);
        if delta <= stopping.tolerance {
            return (map, Status::Converged);
        }
    }
    unreachable!("the stopping rule ends the loop")
}

/// One step of the iteration in one chart.
fn iterate(
    objective: &SphereObjective<'_>,
    weights: &[f64],
    map: &SpatialMap,
    chart: Chart,
    watch: &Watch<'_>,
) -> Result<SpatialMap, Error> {
    let (mesh, by_corner) = (objective.mesh(), objective.energy().laplacian_weights(map));
    let mut plane = chart.project_all(map);
    let modulus = |z: [f64; 2]| z[0].hypot(z[1]);
    // 1. Solve for the vertices inside
    let mut laplacian = Laplacian::new(mesh, |vertex| modulus(plane[vertex]) < RADIUS);
    let mut factor = Cholesky::analyze_on(mesh, laplacian.matrix())?;
    solve_dirichlet(mesh, &mut laplacian, &mut factor, &by_corner, &mut plane, watch)?;
    // 2. Divide by the median modulus
    let scale = weighted_median(&parallel::map(plane.len(), |v| modulus(plane[v])), weights);
    parallel::fill_with_old(&mut plane, |_, z| [z[0] / scale, z[1] / scale]);
    // 3. Back to the sphere; a vertex at the pole itself stays there
    let lifted = chart.lift_all(&plane);
    Ok(parallel::map(map.len(), |v| if lifted[v].is_finite() { lifted[v] } else { map[v] }))
}

fn record(objective: &SphereObjective<'_>, map: &SpatialMap, history: &mut History, is_start: bool) {
    let (energies, gradient) = objective.gradient(map);
    let norm = parallel::dot(&gradient, &gradient).sqrt();
    if is_start {
        history.push_start(energies.authalic_energy, norm)
    } else {
        history.push(energies.authalic_energy, 1.0, norm)
    }
}
