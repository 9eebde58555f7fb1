// SPDX-License-Identifier: MIT OR Apache-2.0
//! The best of several starts of a descent between two surfaces.

use super::surface::ISOMETRY;
use crate::control::{Observer, Phase, Status};
use crate::error::Error;

/// Part of the energy by which a later start has to be better: rounding does not choose between two that end alike.
const LEAST_GAIN: f64 = 1e-6;

/// What one map is better by than another.
pub(super) struct Rank {
    /// The number of exact pairs of landmarks that do not meet.
    pub n_apart: usize,
    /// The energy between the surfaces.
    pub energy: f64,
    pub status: Status,
}

/// The best map of `n` starts, up to the first isometry, and whether the observer ended the search; the first start
/// must end with a map or an error.
pub(super) fn best_of<L>(
    n: usize,
    observer: &mut dyn Observer,
    mut lay: impl FnMut(usize, &mut dyn Observer) -> Result<L, Error>,
    rank: impl Fn(&L) -> Rank,
) -> Result<(L, bool), Error> {
    let mut best: Option<(L, Rank)> = None;
    let mut is_cancelled = false;
    for k in 0..n {
        let share = |k: usize| k as f64 / n as f64;
        let mut phase = Phase { whole: observer, from: share(k), to: share(k + 1) };
        let laid = match lay(k, &mut phase) {
            Err(Error::CancelledEarly) if best.is_some() => {
                is_cancelled = true;
                break;
            }
            laid => laid?,
        };
        let of_laid = rank(&laid);
        is_cancelled = of_laid.status == Status::Cancelled;
        let is_last = is_cancelled || of_laid.energy < 1.0 + ISOMETRY;
        let is_better = |best: &Rank| {
            let energy = (1.0 - LEAST_GAIN) * best.energy;
            (of_laid.n_apart, of_laid.energy) < (best.n_apart, energy)
        };
        if best.as_ref().is_none_or(|(_, best)| is_better(best)) {
            best = Some((laid, of_laid));
        }
        if is_last {
            break;
        }
    }
    let (best, _) = best.expect("there is a start");
    Ok((best, is_cancelled))
}
