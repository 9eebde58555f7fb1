// SPDX-License-Identifier: MIT OR Apache-2.0
//! The seams of one component.

use super::coarse::seek_coarsely;
use super::direct::{WEIGHTS, seek_prepared};
use super::edge_mesh::EdgeMesh;
use super::one_to_one::Seamed;
use super::options::{SeamMethod, Symmetry};
use super::prepared::{Prepared, Wishes};
use super::progress::report;
use super::symmetry::mirror_plane;
use crate::control::{Observer, Phase};
use crate::error::Error;

/// A component of more vertices is large.
const LARGE: usize = 12_000;

/// Seeks the seams of a component; those of a large one on a coarser mesh first.
///
/// # Errors
/// [`Error::CancelledEarly`], or failed numerics.
pub(super) fn seek(
    fine: &EdgeMesh,
    wishes: &Wishes<'_>,
    observer: &mut dyn Observer,
) -> Result<Seamed, Error> {
    report(observer, 0.0)?;
    let plane = match wishes.symmetry {
        Symmetry::Auto => mirror_plane(&fine.mesh),
        Symmetry::Off => None,
    };
    if fine.n_vertices() > LARGE && wishes.method == SeamMethod::Search {
        match seek_coarsely(fine, plane, wishes, observer) {
            // what is allowed may be too narrow for a coarser mesh
            Err(Error::InvalidArray { name: WEIGHTS, .. }) => {}
            sought => return sought,
        }
    }
    // 1. The proxy
    let mut phase = Phase { whole: observer, from: 0.0, to: 0.1 };
    let mut prepared = Prepared::new(fine, plane, wishes, &mut phase)?;
    // 2. and 3. Seams and maps
    let mut phase = Phase { whole: observer, from: 0.1, to: 1.0 };
    seek_prepared(&mut prepared, wishes, &mut phase)
}
