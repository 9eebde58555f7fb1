// SPDX-License-Identifier: MIT OR Apache-2.0
//! The search for the smallest square: islands are placed again and again, in other orders and by other rules, in less
//! and less room.

use super::atlas::Grid;
use super::outline::{Outline, Point};
use super::placement::{Layout, Plan, Rule, place_all};
use super::pose::Pose;
use crate::control::{Observer, Phase, Watch};
use crate::error::Error;
use crate::parallel;

pub(super) const MESSAGE: &str = "Packing islands";

/// Cells along the square in which islands are placed at first, and in the end; more for many islands.
const CELLS: [usize; 2] = [128, 512];

/// Cells along the square for each unit of √(number of islands), at first and in the end.
const CELLS_PER_ISLAND: [f64; 2] = [16.0, 32.0];

/// How often islands are placed anew on the coarse grid.
const COARSE_PLANS: usize = 20;

/// How often they are on the fine grid, at the most.
const FINE_PLANS: usize = 400;

/// Poses placed on the fine grid, over all plans: what limits the time of many islands.
const FINE_POSES: usize = 50_000;

/// Growth of a square that is too small.
const GROWTH: f64 = 1.3;

/// How often it may grow.
const MAX_GROWTHS: usize = 40;

/// Islands are sorted by their areas times a number between 1 and this.
const SHUFFLE: f64 = 1.5;

/// How often a plan holds the first island in one pose.
const FIRST_POSE_SHARE: f64 = 0.7;

/// An island turned by `angle`, then moved so that the corner of its bounding box lies in `corner`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Placed {
    /// The angle, counterclockwise.
    pub angle: f64,
    /// What is added to the turned points.
    pub offset: Point,
}

/// Islands in a square with a corner in the origin.
#[derive(Debug, Clone)]
pub(super) struct Arrangement {
    /// The side of the square.
    pub side: f64,
    /// The places of the islands.
    pub places: Vec<Placed>,
}

/// What to pack.
#[derive(Debug, Clone, Copy)]
pub(super) struct Task<'a> {
    /// The outlines of the islands.
    pub outlines: &'a [Outline],
    /// The angles that are tried of each.
    pub angles: &'a [Vec<f64>],
    /// The distance between islands, and to the border of the unit square.
    pub margin: f64,
}

/// The smallest square found that holds all islands, first on a coarse grid, then on a fine one.
pub(super) fn smallest_square(
    task: &Task<'_>,
    side: f64,
    observer: &mut dyn Observer,
) -> Result<Arrangement, Error> {
    let n = task.outlines.len();
    let [coarse, fine] = [0, 1].map(|k| CELLS[k].max((CELLS_PER_ISLAND[k] * (n as f64).sqrt()) as usize));
    let n_poses: usize = task.angles.iter().map(Vec::len).sum();
    let fine_plans = (FINE_POSES / n_poses.max(1)).clamp(Rule::ALL.len(), FINE_PLANS);
    let mut best = first_arrangement(task, side, coarse, &mut Phase { whole: observer, from: 0.0, to: 0.1 })?;
    for (cells, n_plans, from, to) in [(coarse, COARSE_PLANS, 0.1, 0.2), (fine, fine_plans, 0.2, 1.0)] {
        let mut phase = Phase { whole: observer, from, to };
        best = improved(task, best.side, cells, n_plans, &mut phase)?.unwrap_or(best);
    }
    Ok(best)
}

/// An arrangement on a grid, in a square that grows until all islands fit.
fn first_arrangement(
    task: &Task<'_>,
    side: f64,
    cells: usize,
    observer: &mut dyn Observer,
) -> Result<Arrangement, Error> {
    let mut side = side;
    for _ in 0..MAX_GROWTHS {
        if let Some(arrangement) = improved(task, side, cells, Rule::ALL.len(), observer)? {
            return Ok(arrangement);
        }
        side *= GROWTH;
    }
    Err(Error::InvalidOption {
        name: "margin",
        found: task.margin.to_string(),
        expected: format!("small enough for {} islands", task.outlines.len()),
    })
}

/// The smallest square among those of a number of plans, none larger than `side`.
fn improved(
    task: &Task<'_>,
    side: f64,
    cells: usize,
    n_plans: usize,
    observer: &mut dyn Observer,
) -> Result<Option<Arrangement>, Error> {
    let grid = Grid { side: cells, cell: side / cells as f64 };
    // what is left of the unit square within the margin is `side` at the most
    let gap = task.margin * side / (1.0 - 2.0 * task.margin);
    let poses = all_poses(task, gap, grid, &Watch::new(observer, 0.0, MESSAGE))?;
    let mut numbers = Numbers(1);
    let mut best: Option<Layout> = None;
    for k in 0..n_plans {
        let fraction = k as f64 / n_plans as f64;
        if !observer.progress(fraction, MESSAGE) {
            return Err(Error::CancelledEarly);
        }
        let watch = Watch::new(observer, fraction, MESSAGE);
        let plan = plan(task, k, &mut numbers);
        let limit = best.as_ref().map_or(cells, |layout| layout.extent - 1);
        best = tightest(&poses, &plan, limit, grid, &watch)?.or(best);
    }
    Ok(best.map(|layout| arrangement(&poses, &layout, grid)))
}

/// The islands in all poses.
fn all_poses(task: &Task<'_>, gap: f64, grid: Grid, watch: &Watch<'_>) -> Result<Vec<Vec<Pose>>, Error> {
    let pairs: Vec<(&Outline, f64)> = task
        .outlines
        .iter()
        .zip(task.angles)
        .flat_map(|(outline, angles)| angles.iter().map(move |&angle| (outline, angle)))
        .collect();
    let poses = parallel::tasks(pairs.len(), |k| {
        let (outline, angle) = pairs[k];
        if watch.goes_on() { Pose::new(outline, angle, gap, grid) } else { Pose::default() }
    });
    if !watch.goes_on() {
        return Err(Error::CancelledEarly);
    }
    let mut poses = poses.into_iter();
    Ok(task.angles.iter().map(|angles| poses.by_ref().take(angles.len()).collect()).collect())
}

/// The plan of a number: each rule with the largest islands first, then others at random.
fn plan(task: &Task<'_>, number: usize, numbers: &mut Numbers) -> Plan {
    let is_random = number >= Rule::ALL.len();
    let mut random = |scale: f64| if is_random { scale * numbers.next() } else { 0.0 };
    let keys: Vec<f64> =
        task.outlines.iter().map(|outline| outline.area * (1.0 + random(SHUFFLE - 1.0))).collect();
    let mut order: Vec<usize> = (0..keys.len()).collect();
    order.sort_by(|&one, &other| keys[other].total_cmp(&keys[one]));
    let n_poses = order.first().map_or(0, |&island| task.angles[island].len());
    let has_first_pose = is_random && random(1.0) < FIRST_POSE_SHARE;
    let first_pose = has_first_pose.then(|| random(n_poses as f64) as usize);
    let rule = if is_random { random(Rule::ALL.len() as f64) as usize } else { number };
    Plan { order, first_pose, rule: Rule::ALL[rule] }
}

/// The layout of a plan in the least room in which it succeeds, of at most `limit` cells; steps double while it does.
fn tightest(
    poses: &[Vec<Pose>],
    plan: &Plan,
    limit: usize,
    grid: Grid,
    watch: &Watch<'_>,
) -> Result<Option<Layout>, Error> {
    let mut best: Option<Layout> = None;
    let mut step = 1;
    loop {
        let limit = best.as_ref().map_or(limit, |layout| layout.extent.saturating_sub(step));
        match place_all(poses, plan, limit, grid, watch)? {
            Some(layout) => {
                best = Some(layout);
                step *= 2;
            }
            None if step == 1 => return Ok(best),
            None => step = 1,
        }
    }
}

/// A layout in the units of the islands.
fn arrangement(poses: &[Vec<Pose>], layout: &Layout, grid: Grid) -> Arrangement {
    let mut arrangement = Arrangement { side: 0.0, places: Vec::new() };
    for (poses, spot) in poses.iter().zip(&layout.spots) {
        let pose = &poses[spot.pose];
        let low = spot.cell.map(|cell| cell as f64 * grid.cell);
        let end = (low[0] + pose.size[0]).max(low[1] + pose.size[1]);
        arrangement.side = arrangement.side.max(end);
        let offset = [low[0] - pose.corner[0], low[1] - pose.corner[1]];
        arrangement.places.push(Placed { angle: pose.angle, offset });
    }
    arrangement
}

/// Pseudorandom numbers in [0, 1), always the same, by a linear congruential generator.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as f64 / f64::from(1_u32 << 31)
    }
}
