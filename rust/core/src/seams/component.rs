// SPDX-License-Identifier: MIT OR Apache-2.0
//! The seams of one component.

use super::correction::Correction;
use super::edge_mesh::EdgeMesh;
use super::maps;
use super::one_to_one::Seamed;
use super::options::SeamMethod;
use super::prepared::{Prepared, Wishes};
use crate::control::{Observer, Phase};
use crate::error::Error;

/// Seeks the seams of a component.
///
/// # Errors
/// [`Error::CancelledEarly`], or failed numerics.
pub(super) fn seek(
    fine: &EdgeMesh,
    wishes: &Wishes<'_>,
    observer: &mut dyn Observer,
) -> Result<Seamed, Error> {
    let time = std::time::Instant::now();
    let trace = |what: &str| {
        if std::env::var("SEAMS_TRACE").is_ok() {
            eprintln!("{what} {:.3} s", time.elapsed().as_secs_f64());
        }
    };
    // 1. The proxy
    let mut phase = Phase { whole: observer, from: 0.0, to: 0.1 };
    let mut prepared = Prepared::new(fine, wishes, &mut phase)?;
    trace("prepared");
    // 2. The search
    let mut phase = Phase { whole: observer, from: 0.1, to: 0.5 };
    let solution = prepared.search(wishes, &mut phase)?;
    trace("searched");
    if wishes.method == SeamMethod::Cones {
        let cut = prepared.lifted(&solution.state.cut, &prepared.component);
        let predicted = prepared.predicted(&solution);
        return Ok(Seamed { islands: maps::islands(fine, &cut)?, cut, predicted, measured: None });
    }
    // 3. Maps of the islands, and corrections by these
    let mut phase = Phase { whole: observer, from: 0.5, to: 1.0 };
    let seamed = Correction::new(&prepared, wishes).run(solution, &mut phase);
    trace("mapped");
    seamed
}
