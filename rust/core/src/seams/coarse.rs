// SPDX-License-Identifier: MIT OR Apache-2.0
//! The seams of a large component, by those of a coarser mesh.
//!
//! 1. A coarser mesh, symmetric where the component is.
//! 2. Its seams, which its maps have corrected.
//! 3. They are lifted to the component.
//! 4. Its islands are mapped, once, and made one-to-one.
//!
//! Cost: that of the maps of the component.

use super::carry::Carrier;
use super::component::{check_allowed, seek_prepared, stiffness};
use super::edge_mesh::EdgeMesh;
use super::maps::{self, IslandMap, Outlines};
use super::one_to_one::{Limits, Seamed, one_to_one};
use super::options::{MET, Symmetry};
use super::prepared::{Prepared, Wishes, carried};
use super::progress::report;
use super::proxy::{Proxy, coarser};
use super::symmetry::mirror_plane;
use crate::control::{Observer, Phase, Status};
use crate::error::Error;

/// The vertices of the coarser mesh.
const COARSE: usize = 6000;

/// Seeks the seams of a large component.
///
/// # Errors
/// [`Error::CancelledEarly`], or failed numerics.
pub(super) fn seek_coarsely(
    fine: &EdgeMesh,
    wishes: &Wishes<'_>,
    observer: &mut dyn Observer,
) -> Result<Seamed, Error> {
    // 1. The coarser mesh
    report(observer, 0.0)?;
    let plane = match wishes.symmetry {
        Symmetry::Auto => mirror_plane(&fine.mesh),
        Symmetry::Off => None,
    };
    let mut phase = Phase { whole: &mut *observer, from: 0.02, to: 0.1 };
    let Proxy { mesh, nearest, mirror, .. } = coarser(&fine.mesh, plane.as_ref(), COARSE, &mut phase)?;
    let coarse = EdgeMesh::new(mesh);
    let weights = wishes.weights.map(|weights| carried(fine, weights, &coarse));
    let stiffness = stiffness([&coarse, fine].map(|mesh| mesh.n_vertices() as f64));
    let target = 1.0 + stiffness * (wishes.target - 1.0);
    let coarse_wishes = Wishes { target, weights: weights.as_deref(), tries_other_starts: false, ..*wishes };
    // 2. Its seams
    let mut phase = Phase { whole: &mut *observer, from: 0.1, to: 0.15 };
    let mut prepared = Prepared::new(&coarse, &coarse_wishes, &mut phase)?;
    let mut phase = Phase { whole: &mut *observer, from: 0.15, to: 0.5 };
    let seamed = seek_prepared(&mut prepared, &coarse_wishes, &mut phase)?;
    // 3. Those of the component
    let component = prepared.finer(fine, nearest, mirror.as_deref(), wishes);
    let mut phase = Phase { whole: &mut *observer, from: 0.5, to: 0.55 };
    let cut = component.lifted(&coarse, &seamed.cut, mirror.as_deref(), wishes.max_islands, &mut phase)?;
    check_allowed(fine, &cut, wishes)?;
    // 4. Its maps
    let mut islands = maps::islands(fine, &cut)?;
    let mut phase = Phase { whole: &mut *observer, from: 0.55, to: 0.85 };
    map_from_coarse(&mut islands, fine, &Carrier::new(&coarse, &seamed.islands), &mut phase)?;
    let measured = Some(maps::figures(&islands));
    let mut seamed = Seamed { cut, islands, predicted: seamed.predicted, measured };
    if !wishes.overlap {
        let shear = MET * wishes.target;
        let limits = Limits { shear, max_islands: wishes.max_islands, tries_other_starts: false };
        let mut phase = Phase { whole: observer, from: 0.85, to: 1.0 };
        one_to_one(&mut seamed, &component, limits, &mut phase)?;
    }
    Ok(seamed)
}

/// Maps islands from the maps of the coarse ones.
fn map_from_coarse(
    islands: &mut [IslandMap],
    fine: &EdgeMesh,
    carrier: &Carrier<'_>,
    observer: &mut dyn Observer,
) -> Result<(), Error> {
    let n = fine.n_faces() as f64;
    let mut done = 0.0;
    for island in islands {
        let [from, to] = [done, done + island.face_of.len() as f64].map(|count| count / n);
        done += island.face_of.len() as f64;
        report(observer, from)?;
        let mut phase = Phase { whole: &mut *observer, from, to };
        let status = match carrier.shapes(fine, island) {
            Some(shapes) => island.map_from(&shapes, &mut phase)?,
            None => island.map(Outlines::MayCross, None, &mut phase)?,
        };
        if status == Status::Cancelled {
            return Err(Error::CancelledEarly);
        }
    }
    Ok(())
}
