// SPDX-License-Identifier: MIT OR Apache-2.0
//! Gauss–Newton for surfaces with slivers: targets are raised to a floor that is lowered step by step.
//!
//! The energy of a face grows like 1/T, so a face with a millionth of the mean target rules the whole descent long
//! before the others are in place. When the descent first raises every target to at least a hundredth of the mean, and
//! then lowers that floor, slivers cost a few iterations each. Rest triangles are fattened too, so that cotangents stay
//! moderate.
//!
//! While a floor holds, the energies in the history are those for the raised targets.

use super::angle_schedule::AnglePath;
use super::{GaussNewtonOptions, Problem, minimize};
use crate::codomain::{Codomain, SpatialMap};
use crate::control::{History, Observer, Phase, Status};
use crate::energy::authalic::AuthalicEnergy;
use crate::energy::stretch::Profile;
use crate::mesh::TriangleMesh;
use crate::parallel;

/// The floors, from the first to the last, in units of the mean target.
const FLOORS: [f64; 4] = [1e-2, 1e-3, 1e-4, 1e-6];

/// Iterations of each floor but the first: the usual number, and the limit except on the last floor.
const ITERATIONS: [usize; 2] = [2, 8];

/// Upper bound of the height to which rest triangles are fattened, in units of their longest edge.
const FLATTEST: f64 = 0.02;

/// Lower bound of the height to which rest triangles are fattened.
const FLATTEST_LAST: f64 = 1e-7;

/// The part of the progress that belongs to the first floor.
const FIRST_PART: f64 = 0.6;

/// The floors that targets (m,) need, in order: those above the smallest target, then 0.
pub(crate) fn floors(targets: &[f64]) -> Vec<f64> {
    let least = targets.iter().fold(f64::INFINITY, |least, &target| least.min(target)) / mean(targets);
    FLOORS.into_iter().filter(|&floor| floor > least).chain([0.0]).collect()
}

/// Targets raised to a floor.
pub(crate) fn raised(targets: &[f64], floor: f64) -> Vec<f64> {
    let floor = floor * mean(targets);
    parallel::map(targets.len(), |face| targets[face].max(floor))
}

/// The energy for targets raised to a floor.
pub(crate) fn energy(mesh: &TriangleMesh, targets: &[f64], codomain: Codomain, floor: f64) -> AuthalicEnergy {
    let flattest = (2.0 * floor).clamp(FLATTEST_LAST, FLATTEST);
    AuthalicEnergy::new(mesh, raised(targets, floor), codomain, flattest)
}

/// A surface with the target areas and the codomain of its map.
pub(crate) struct MappedSurface<'a> {
    pub mesh: &'a TriangleMesh,
    pub targets: &'a [f64],
    pub codomain: Codomain,
}

/// A guarded descent through all floors; `problem` has the energy of the first, and is returned with that of the last.
pub(crate) fn descend(
    surface: &MappedSurface<'_>,
    mut problem: Problem,
    start: SpatialMap,
    options: &GaussNewtonOptions,
    history: &mut History,
    observer: &mut dyn Observer,
) -> (Problem, SpatialMap, Status) {
    debug_assert!(options.profile == Profile::Barrier);
    let MappedSurface { mesh, targets, codomain } = *surface;
    let floors = floors(targets);
    let fraction = |k: usize| match k {
        0 => 0.0,
        _ => FIRST_PART + (1.0 - FIRST_PART) * (k - 1) as f64 / (floors.len() - 1) as f64,
    };
    let (mut map, mut status) = (start, Status::MaxIterations);
    let before = history.iterations();
    for (k, &floor) in floors.iter().enumerate() {
        let mut options = *options;
        if k > 0 {
            problem = problem.with_energy(energy(mesh, targets, codomain, floor));
            let [usual, most] = ITERATIONS;
            let is_last = k + 1 == floors.len();
            options.usual_iterations = match options.usual_iterations {
                // a tolerance that was asked for must be reached
                usize::MAX if is_last => usize::MAX,
                of_first if is_last => (of_first / 2).min(most),
                _ => usual,
            };
            // the last floor has its own verdict and gets the rest of the limit
            let left = options.most_iterations.saturating_sub(history.iterations() - before);
            let few = options.most_iterations.min(most);
            options.most_iterations = if is_last { left.max(few) } else { few };
            // the stages were for the first floor
            options.path = AnglePath::Balanced;
        }
        let to = if floors.len() == 1 { 1.0 } else { fraction(k + 1) };
        let mut phase = Phase { whole: observer, from: fraction(k), to };
        (map, status) = minimize(&problem, map, &options, history, &mut phase);
        if status == Status::Cancelled {
            break;
        }
    }
    (problem, map, status)
}

fn mean(targets: &[f64]) -> f64 {
    parallel::sum(targets.len(), |face| targets[face]) / targets.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_slivers_need_floors() {
        assert_eq!(floors(&[1.0, 2.0, 0.1]), [0.0]);
        assert_eq!(floors(&[1.0, 2.0, 1e-3]), [1e-2, 1e-3, 0.0]);
        assert_eq!(raised(&[1.0, 3.0, 1e-9], 0.0), [1.0, 3.0, 1e-9]);
        let raised = raised(&[1.0, 2.0 - 1e-9, 1e-9], 1e-2);
        assert!((raised[2] - 0.01).abs() < 1e-12 && raised[0] == 1.0);
    }
}
