// SPDX-License-Identifier: MIT OR Apache-2.0
//! The seams of a component that is ready for the search: its steps.

use super::correction::Correction;
use super::cut::Cut;
use super::edge_mesh::EdgeMesh;
use super::maps;
use super::one_to_one::Seamed;
use super::options::SeamMethod;
use super::prepared::{Prepared, Wishes};
use crate::control::{Observer, Phase};
use crate::error::Error;

/// The excess of the shear of maps over 1 falls with this power of the number of vertices: coarse triangles are stiffer
/// than the surface.
const STIFFNESS: f64 = 0.13;

/// The number of vertices from which on it falls below the prediction.
const STIFF: f64 = 10_000.0;

/// The name of the factors of costs in errors.
pub(super) const WEIGHTS: &str = "weights";

/// The largest excess of the first prediction, in units of that of the target.
const MOST_EXCESS: f64 = 1.3;

/// Seeks the seams of a component that is ready for the search.
pub(super) fn seek_prepared(
    prepared: &mut Prepared<'_>,
    wishes: &Wishes<'_>,
    observer: &mut dyn Observer,
) -> Result<Seamed, Error> {
    let wishes = &prepared.within_reach(wishes);
    let fine = prepared.component.mesh;
    // 1. The search
    let mut phase = Phase { whole: observer, from: 0.0, to: 0.45 };
    let aim = first_aim(wishes.target, fine.n_vertices());
    let solution = prepared.search(wishes, aim, &mut phase)?;
    let cut = prepared.lifted(&solution.state.cut, &mut phase)?;
    check_allowed(fine, &cut, wishes)?;
    if wishes.method == SeamMethod::Cones {
        let predicted = prepared.predicted(&solution);
        return Ok(Seamed { islands: maps::islands(fine, &cut)?, cut, predicted, measured: None });
    }
    // 2. Maps of the islands, and corrections by these
    let mut phase = Phase { whole: observer, from: 0.45, to: 1.0 };
    Correction::new(prepared, wishes, aim).run(solution, &mut phase)
}

/// Refuses weights that forbid every cut into disks.
pub(super) fn check_allowed(fine: &EdgeMesh, cut: &Cut, wishes: &Wishes<'_>) -> Result<(), Error> {
    let is_forbidden = |edge| wishes.weights.is_some_and(|weights: &[f64]| weights[edge] == f64::INFINITY);
    if cut.islands(fine).are_disks() && !cut.seams().any(is_forbidden) {
        return Ok(());
    }
    let found = "inf on all edges along which the surface could be cut into disks".into();
    Err(Error::InvalidArray { name: WEIGHTS, found, expected: "finite on some of them".into() })
}

/// The predicted shear for which the maps of a mesh of so many vertices are likely to have the wanted one.
fn first_aim(target: f64, n_vertices: usize) -> f64 {
    1.0 + stiffness([STIFF, n_vertices as f64]) * (target - 1.0)
}

/// The excess of the shear of a mesh over 1 in units of that of a finer one, given their numbers of vertices.
pub(super) fn stiffness([coarse, fine]: [f64; 2]) -> f64 {
    (fine / coarse).powf(STIFFNESS).clamp(1.0, MOST_EXCESS)
}
