// SPDX-License-Identifier: MIT OR Apache-2.0
//! The seams of a large component, by those of a coarser mesh.
//!
//! 1. A coarser mesh, symmetric where the component is.
//! 2. Its seams, which its maps have corrected.
//! 3. They are lifted to the component.
//! 4. Its islands are mapped and made one-to-one.
//!
//! Where these maps are sheared more than was wanted, the last three steps follow once more.
//!
//! Cost: that of the maps of the component.

use super::carry::Carrier;
use super::direct::{check_allowed, seek_prepared, stiffness};
use super::edge_mesh::EdgeMesh;
use super::maps::{self, IslandMap};
use super::one_to_one::{Limits, Seamed, one_to_one};
use super::options::MET;
use super::prepared::{Prepared, Wishes, carried};
use super::progress::report;
use super::proxy::{Proxy, coarser};
use super::symmetry::MirrorPlane;
use crate::control::{Observer, Phase, Status};
use crate::error::Error;
use crate::mesh::Vertex;

/// The vertices of the coarser mesh.
const COARSE: usize = 6000;

/// Factor of the corrected excess of the second try, so that it does not fall short again.
const LOWER: f64 = 0.97;

/// Least excess of the second try.
const LEAST_EXCESS: f64 = 0.4;

/// Seeks the seams of a large component, with its mirror plane.
///
/// # Errors
/// [`Error::CancelledEarly`], or failed numerics.
pub(super) fn seek_coarsely(
    fine: &EdgeMesh,
    plane: Option<MirrorPlane>,
    wishes: &Wishes<'_>,
    observer: &mut dyn Observer,
) -> Result<Seamed, Error> {
    // 1. The coarser mesh
    let mut phase = Phase { whole: &mut *observer, from: 0.02, to: 0.1 };
    let Proxy { mesh, nearest, mirror, .. } = coarser(&fine.mesh, plane.as_ref(), COARSE, &mut phase)?;
    let coarse = Coarse { fine, mesh: EdgeMesh::new(mesh), nearest, mirror };
    let weights = wishes.weights.map(|weights| carried(fine, weights, &coarse.mesh));
    let coarse_wishes =
        Wishes { weights: weights.as_deref(), alone: &[], tries_other_starts: false, ..*wishes };
    let mut phase = Phase { whole: &mut *observer, from: 0.1, to: 0.15 };
    let mut prepared = Prepared::new(&coarse.mesh, plane, &coarse_wishes, &mut phase)?;
    // 2. to 4. The component's seams by those of the mesh
    let excess = stiffness([&coarse.mesh, fine].map(|mesh| mesh.n_vertices() as f64));
    let mut phase = Phase { whole: &mut *observer, from: 0.15, to: 0.6 };
    let first = coarse.seek(&mut prepared, [&coarse_wishes, wishes], excess, &mut phase)?;
    let (target, shear) = (prepared.within_reach(wishes).target, first.shear());
    if shear <= MET * target {
        return Ok(first);
    }
    let excess = (LOWER * excess * (target - 1.0) / (shear - 1.0)).max(LEAST_EXCESS);
    let mut phase = Phase { whole: observer, from: 0.6, to: 1.0 };
    let second = coarse.seek(&mut prepared, [&coarse_wishes, wishes], excess, &mut phase)?;
    Ok(if second.shear() < shear { second } else { first })
}

/// A coarser mesh of a component.
struct Coarse<'a> {
    fine: &'a EdgeMesh,
    mesh: EdgeMesh,
    /// The vertex of the component for which each vertex stands.
    nearest: Vec<Vertex>,
    /// The mirror image of each vertex, if the mesh is symmetric.
    mirror: Option<Vec<Vertex>>,
}

impl Coarse<'_> {
    /// The seams of the component, by those whose maps of the coarser mesh have the excess of the target's shear over 1
    /// times `excess`.
    fn seek(
        &self,
        prepared: &mut Prepared<'_>,
        [coarse_wishes, wishes]: [&Wishes<'_>; 2],
        excess: f64,
        observer: &mut dyn Observer,
    ) -> Result<Seamed, Error> {
        let (fine, max_islands) = (self.fine, wishes.max_islands);
        // 2. The seams of the coarser mesh
        let target = 1.0 + excess * (wishes.target - 1.0);
        let mut phase = Phase { whole: &mut *observer, from: 0.0, to: 0.45 };
        let coarse = seek_prepared(prepared, &Wishes { target, ..*coarse_wishes }, &mut phase)?;
        // 3. Those of the component
        let mirror = self.mirror.as_deref();
        let component = prepared.finer(fine, self.nearest.clone(), mirror, wishes);
        let mut phase = Phase { whole: &mut *observer, from: 0.45, to: 0.5 };
        let cut = component.lifted(&self.mesh, &coarse.cut, mirror, max_islands, &mut phase)?;
        check_allowed(fine, &cut, wishes)?;
        report(&mut phase, 1.0)?;
        // 4. Its maps
        let mut islands = maps::islands(fine, &cut)?;
        let mut phase = Phase { whole: &mut *observer, from: 0.5, to: 0.85 };
        map_from_coarse(&mut islands, fine, &Carrier::new(&self.mesh, &coarse.islands), &mut phase)?;
        let measured = Some(maps::figures(&islands));
        let mut seamed = Seamed { cut, islands, predicted: coarse.predicted, measured };
        if !wishes.overlap {
            let shear = MET * prepared.within_reach(wishes).target;
            let limits = Limits { shear, max_islands, tries_other_starts: false };
            let mut phase = Phase { whole: observer, from: 0.85, to: 1.0 };
            one_to_one(&mut seamed, &component, limits, &mut phase)?;
        }
        Ok(seamed)
    }
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
        let shapes = carrier.shapes(fine, island);
        if island.map_from(&shapes, &mut phase)? == Status::Cancelled {
            return Err(Error::CancelledEarly);
        }
    }
    Ok(())
}
