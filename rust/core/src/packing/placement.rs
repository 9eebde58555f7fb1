// SPDX-License-Identifier: MIT OR Apache-2.0
//! Islands placed one by one, each where it costs least among all places and poses that are free.

use std::sync::atomic::{AtomicU64, Ordering};

use super::atlas::{Atlas, Grid};
use super::pose::Pose;
use crate::control::Watch;
use crate::error::Error;
use crate::parallel;

/// Which place is the cheapest, for an island whose bounding box ends at `right` and `top`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Rule {
    /// The least right + top: islands grow from the corner along a diagonal front.
    Diagonal,
    /// The least top: islands rise from the bottom.
    Bottom,
    /// The least square that holds all islands so far.
    Square,
}

impl Rule {
    /// The rules in the order in which they are tried.
    pub const ALL: [Self; 3] = [Self::Diagonal, Self::Bottom, Self::Square];

    /// A number that grows with `right` and with `top`. All islands before lie in a square of side `extent`.
    fn cost(self, right: usize, top: usize, extent: usize) -> u64 {
        let [major, minor] = match self {
            Self::Diagonal => [right + top, right.max(top)],
            Self::Bottom => [top, right],
            Self::Square => [right.max(top).max(extent), right + top],
        };
        ((major as u64) << u32::BITS) + minor as u64
    }
}

/// In which order and by which rule islands are placed.
#[derive(Debug, Clone)]
pub(super) struct Plan {
    /// The islands, first to last.
    pub order: Vec<usize>,
    /// The only pose that is tried of the first island, or all.
    pub first_pose: Option<usize>,
    /// Which place is the cheapest.
    pub rule: Rule,
}

/// Where an island lies: one of its poses, its bounding box moved by whole cells.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Spot {
    /// The pose.
    pub pose: usize,
    /// Where the lower left corner of the bounding box goes.
    pub cell: [usize; 2],
}

/// Where all islands lie.
#[derive(Debug, Clone)]
pub(super) struct Layout {
    /// The place of each island.
    pub spots: Vec<Spot>,
    /// The side, in cells, of the square that holds them.
    pub extent: usize,
}

/// Places all islands within the first `limit` rows and columns, or returns `None` where one of them does not fit.
pub(super) fn place_all(
    poses: &[Vec<Pose>],
    plan: &Plan,
    limit: usize,
    grid: Grid,
    watch: &Watch<'_>,
) -> Result<Option<Layout>, Error> {
    let mut atlas = Atlas::new(grid);
    let mut layout = Layout { spots: vec![Spot::default(); poses.len()], extent: 0 };
    for (rank, &island) in plan.order.iter().enumerate() {
        let poses = &poses[island];
        let tried = match plan.first_pose {
            Some(pose) if rank == 0 => pose..pose + 1,
            _ => 0..poses.len(),
        };
        let ceiling = AtomicU64::new(u64::MAX);
        let candidates = parallel::tasks(tried.len(), |k| {
            let pose = tried.start + k;
            let place = if watch.goes_on() {
                cheapest_place(&atlas, &poses[pose], plan.rule, [limit, layout.extent], &ceiling)
            } else {
                None
            };
            place.map(|(cost, cell)| (cost, pose, cell))
        });
        if !watch.goes_on() {
            return Err(Error::CancelledEarly);
        }
        let Some((_, pose, cell)) = candidates.into_iter().flatten().min() else { return Ok(None) };
        layout.spots[island] = Spot { pose, cell };
        let Pose { cells: [width, height], halo, .. } = &poses[pose];
        layout.extent = layout.extent.max(cell[0] + width).max(cell[1] + height);
        atlas.take(halo, cell);
    }
    Ok(Some(layout))
}

/// The cheapest free place of a pose, with its cost.
///
/// Places that cost more than the `ceiling`, the least cost of all poses so far, are left out. Which these are depends
/// on the threads, but the cheapest place of all poses is never one of them.
fn cheapest_place(
    atlas: &Atlas,
    pose: &Pose,
    rule: Rule,
    [limit, extent]: [usize; 2],
    ceiling: &AtomicU64,
) -> Option<(u64, [usize; 2])> {
    let [width, height] = pose.cells;
    let [mut last_x, last_y] = [limit.checked_sub(width)?, limit.checked_sub(height)?];
    let mut best: Option<(u64, [usize; 2])> = None;
    for y in 0..=last_y {
        let cost = |x: usize| rule.cost(x + width, y + height, extent);
        let least = ceiling.load(Ordering::Relaxed);
        let is_dear = |x: usize| cost(x) > least || best.is_some_and(|(cost_below, _)| cost(x) >= cost_below);
        // the farther up, the fewer places are worth a look
        while is_dear(last_x) {
            last_x = match last_x.checked_sub(1) {
                Some(x) => x,
                None => return best,
            };
        }
        if let Some(x) = atlas.first_free(&pose.probes, y, last_x) {
            best = Some((cost(x), [x, y]));
            ceiling.fetch_min(cost(x), Ordering::Relaxed);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn costs_grow_with_both_coordinates() {
        for rule in Rule::ALL {
            for [x, y] in [[3, 9], [9, 3], [5, 5]] {
                assert!(
                    rule.cost(x + 1, y, 4) >= rule.cost(x, y, 4)
                        && rule.cost(x, y + 1, 4) >= rule.cost(x, y, 4)
                );
            }
        }
    }
}
