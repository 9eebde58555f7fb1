// SPDX-License-Identifier: MIT OR Apache-2.0
//! Islands that do not overlap themselves in the plane.
//!
//! An island whose map crosses itself is mapped again with an outline that may not, or parted by a chord where that
//! would shear it too much.

use super::chord::chord;
use super::cut::Cut;
use super::edge_mesh::EdgeMesh;
use super::maps::{self, IslandMap, MapFigures, Outlines};
use super::overlap::overlap;
use super::prepared::Fine;
use super::progress::report;
use super::search::Figures;
use crate::control::{Observer, Phase, Status};
use crate::error::Error;
use crate::mesh::Edge;

/// An island that covers more of its place twice is parted by a chord at once: a map whose outline may not cross itself
/// would be sheared too much.
const HOPELESS: f64 = 0.01;

/// Where outlines cannot be pushed apart, other starts are tried if no more of an island's place is covered twice: they
/// take long.
const SHALLOW: f64 = 0.006;

/// Other starts are tried if the mean of σ₁/σ₂ may still rise by this.
const LEAST_ROOM: f64 = 0.004;

/// The mean of σ₁/σ₂ may rise by this for outlines that do not cross themselves.
const ACCEPTED: f64 = 0.03;

/// The most iterations for such an outline, where a chord is the alternative.
const MOST_ITERATIONS: usize = 32;

/// The most chords in one component.
const MOST_CHORDS: usize = 8;

/// The seams of a component with the maps of its islands.
#[derive(Debug, Clone)]
pub(super) struct Seamed {
    pub cut: Cut,
    /// The islands; not mapped for a preview.
    pub islands: Vec<IslandMap>,
    pub predicted: Figures,
    /// The figures of the maps; `None` for a preview.
    pub measured: Option<MapFigures>,
}

impl Seamed {
    /// The mean of σ₁/σ₂ of the maps, or as predicted where there are none.
    pub(super) fn shear(&self) -> f64 {
        self.measured.map_or(self.predicted.mean, |figures| figures.mean)
    }
}

/// What one-to-one maps must keep.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits {
    /// The largest mean of σ₁/σ₂.
    pub shear: f64,
    /// The most islands.
    pub max_islands: usize,
    /// Whether to try other starts than the map itself, which take long.
    pub tries_other_starts: bool,
}

/// The chords of a cut of the proxy: one for each island that covers much of its place twice.
pub(super) fn chords(
    mesh: &EdgeMesh,
    cut: &Cut,
    cost: &[f64],
    max_islands: usize,
    observer: &mut dyn Observer,
) -> Result<Vec<Vec<Edge>>, Error> {
    let mut islands = maps::islands(mesh, cut)?;
    let room = max_islands.saturating_sub(islands.len());
    maps::map_all(&mut islands, Outlines::MayCross, observer)?;
    let chord_of = |island: &IslandMap| {
        let overlap = overlap(island);
        if overlap.share > HOPELESS { chord(mesh, cut, cost, island, &overlap) } else { None }
    };
    Ok(islands.iter().filter_map(chord_of).take(room).collect())
}

/// Maps islands again, or parts them, until none overlaps itself.
pub(super) fn one_to_one(
    seamed: &mut Seamed,
    fine: &Fine<'_>,
    limits: Limits,
    observer: &mut dyn Observer,
) -> Result<(), Error> {
    let total: f64 = seamed.islands.iter().map(IslandMap::area).sum();
    let mean = maps::figures(&seamed.islands).mean;
    let mut left = ACCEPTED.min((limits.shear - mean).max(0.0)) * total;
    let mut n_chords = 0;
    // until one was in vain
    let mut tries_others = limits.tries_other_starts;
    let mut k = 0;
    while k < seamed.islands.len() {
        let overlap = overlap(&seamed.islands[k]);
        if overlap.pairs.is_empty() {
            k += 1;
            continue;
        }
        let n_islands = seamed.islands.len() as f64;
        let [from, to] = [k, k + 1].map(|k| k as f64 / n_islands);
        let observer = &mut Phase { whole: &mut *observer, from, to };
        // 1. An outline that does not cross itself, where that costs little
        let may_part = n_chords < MOST_CHORDS && seamed.islands.len() < limits.max_islands;
        if overlap.share <= HOPELESS {
            let tries_here = tries_others && overlap.share <= SHALLOW && left >= LEAST_ROOM * total;
            let spent = uncross(&mut seamed.islands[k], left, tries_here, observer)?;
            tries_others &= spent.is_some() || !tries_here;
            left -= spent.unwrap_or(0.0).max(0.0);
            if spent.is_some() {
                continue;
            }
        }
        // 2. Else a chord
        report(observer, 0.0)?;
        let island = &seamed.islands[k];
        let chord = may_part.then(|| chord(fine.mesh, &seamed.cut, &fine.cost, island, &overlap)).flatten();
        if let Some(chord) = chord {
            n_chords += 1;
            report(observer, 0.0)?;
            seamed.cut.add(&fine.with_image(&seamed.cut, chord, limits.max_islands));
            seamed.cut = fine.with_alone(seamed.cut.clone());
            k = part(seamed, fine.mesh, k, observer)?;
            continue;
        }
        // 3. Where there is none, such an outline whatever it costs
        uncross_at_any_price(&mut seamed.islands[k], observer)?;
        k += 1;
    }
    seamed.measured = Some(maps::figures(&seamed.islands));
    Ok(())
}

/// Maps an island again so that its outline does not cross itself, if that raises the sum of σ₁/σ₂ over the area by no
/// more than `accepted`; returns by how much.
fn uncross(
    island: &mut IslandMap,
    accepted: f64,
    tries_others: bool,
    observer: &mut dyn Observer,
) -> Result<Option<f64>, Error> {
    // 1. From the map with outlines pushed apart, else from another start
    let mut mapped = island.clone();
    let mut status = mapped.map(Outlines::MayNotCross, Some(MOST_ITERATIONS), observer)?;
    if status == Status::Stalled && tries_others {
        mapped = mapped.unmapped();
        status = mapped.map(Outlines::MayNotCross, Some(MOST_ITERATIONS), observer)?;
    }
    if status == Status::Cancelled {
        return Err(Error::CancelledEarly);
    }
    // 2. The price
    let rise = (maps::figures([&mapped]).mean - maps::figures([&*island]).mean) * island.area();
    if status != Status::Converged || rise > accepted {
        return Ok(None);
    }
    *island = mapped;
    Ok(Some(rise))
}

/// Maps an island again so that its outline does not cross itself.
fn uncross_at_any_price(island: &mut IslandMap, observer: &mut dyn Observer) -> Result<(), Error> {
    if uncross(island, f64::INFINITY, false, observer)?.is_some() {
        return Ok(());
    }
    let mut mapped = island.clone().unmapped();
    if mapped.map(Outlines::MayNotCross, None, observer)? == Status::Cancelled {
        return Err(Error::CancelledEarly);
    }
    *island = mapped;
    Ok(())
}

/// Maps the parts into which the cut now divides islands, which they replace from the first one not done on; returns its
/// number, given that the first `n_done` were done before.
fn part(
    seamed: &mut Seamed,
    mesh: &EdgeMesh,
    n_done: usize,
    observer: &mut dyn Observer,
) -> Result<usize, Error> {
    let mut parts = maps::islands(mesh, &seamed.cut)?;
    let (mut kept, mut parted) = (Vec::new(), Vec::new());
    let mut n_kept = 0;
    for (k, island) in seamed.islands.drain(..).enumerate() {
        let is_whole = |part: &IslandMap| {
            part.face_of == island.face_of && part.mesh.n_vertices() == island.mesh.n_vertices()
        };
        if let Some(whole) = parts.iter().position(is_whole) {
            parts.remove(whole);
            kept.push(island);
            n_kept += usize::from(k < n_done);
        } else {
            parted.push(island);
        }
    }
    for part in &mut parts {
        let whole = parted.iter().find(|island| island.face_of.binary_search(&part.face_of[0]).is_ok());
        whole.into_iter().for_each(|whole| part.take_over(whole));
    }
    maps::map_all(&mut parts, Outlines::MayCross, observer)?;
    kept.splice(n_kept..n_kept, parts);
    seamed.islands = kept;
    Ok(n_kept)
}
