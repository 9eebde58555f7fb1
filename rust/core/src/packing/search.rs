// SPDX-License-Identifier: MIT OR Apache-2.0
//! The search for the smallest square: islands are placed again and again, in other orders and by other rules, in less
//! and less room.

use super::angles::EQUAL;
use super::atlas::Grid;
use super::margin::{Margin, too_large};
use super::outline::{Outline, Point};
use super::placement::{Layout, Plan, Rule, place_all};
use super::pose::Pose;
use crate::control::{Observer, Phase, Watch};
use crate::error::Error;
use crate::mesh::ties::largest_first;
use crate::parallel;

pub(super) const MESSAGE: &str = "Packing islands";

/// How finely and how often islands are placed.
struct Effort {
    /// Cells along the square, at least.
    cells: usize,
    /// Cells along the square for each unit of √(number of islands), at least.
    cells_per_root: f64,
    /// How many plans are tried at the most.
    max_plans: usize,
    /// How many words of the grid the poses of all plans may look at: what limits the time.
    max_words: usize,
}

/// What finds a square in which all islands fit.
const COARSE: Effort = Effort { cells: 128, cells_per_root: 8.0, max_plans: 6, max_words: 2_000_000 };

/// What finds the smallest.
const FINE: Effort = Effort { cells: 512, cells_per_root: 16.0, max_plans: 60, max_words: 12_000_000 };

impl Effort {
    /// The grid of a square.
    fn grid(&self, task: &Task<'_>, side: f64) -> Grid {
        let root = (task.outlines.len() as f64).sqrt();
        let cells = self.cells.max((self.cells_per_root * root) as usize);
        Grid { side: cells, cell: side / cells as f64 }
    }

    /// How many plans are tried on the grid; at the least one, whether or not that is too many.
    fn n_plans(&self, task: &Task<'_>, grid: Grid) -> usize {
        ((task.effort * self.max_words as f64) as usize / words(task, grid)).clamp(1, self.max_plans)
    }
}

/// How many words all poses may look at.
fn words(task: &Task<'_>, grid: Grid) -> usize {
    let n_poses: usize = task.angles.iter().map(Vec::len).sum();
    (n_poses * grid.side * grid.side / u64::BITS as usize).max(1)
}

/// How much finer the grids are on which the best plan is repeated in the end.
const REFINEMENTS: [usize; 2] = [2, 4];

/// Growth of a square that is too small.
const GROWTH: f64 = 1.3;

/// How often it may grow.
const MAX_GROWTHS: usize = 40;

/// Islands are sorted by their areas times a number between 1 and this.
const SHUFFLE: f64 = 1.5;

/// How often a plan holds the first island in one pose.
const FIRST_POSE_SHARE: f64 = 0.7;

/// An island turned by `angle`, flattened, then moved so that the corner of its bounding box lies in `corner`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Placed {
    /// The angle, counterclockwise.
    pub angle: f64,
    /// What is added to the points.
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
    pub margin: Margin,
    /// Width over height of the texture, by which turned islands are flattened.
    pub aspect: f64,
    /// The part of the usual effort that is made.
    pub effort: f64,
}

/// A square and the plan that led to it.
type Planned = (Arrangement, Plan);

/// The smallest square found that holds all islands.
pub(super) fn smallest_square(
    task: &Task<'_>,
    side: f64,
    observer: &mut dyn Observer,
) -> Result<Arrangement, Error> {
    // 1. A square on a coarse grid.
    let rough = first_square(task, side, observer)?;
    // 2. Smaller ones on a fine grid.
    let grid = FINE.grid(task, rough.0.side);
    let n_plans = FINE.n_plans(task, grid);
    let fine = improved(task, grid, n_plans, usize::MAX, observer)?.unwrap_or(rough);
    // 3. The smallest once more on finer grids.
    refined(task, fine, observer)
}

/// A square on the coarse grid, which grows until all islands fit.
fn first_square(task: &Task<'_>, side: f64, observer: &mut dyn Observer) -> Result<Planned, Error> {
    let mut side = side;
    for _ in 0..MAX_GROWTHS {
        let grid = COARSE.grid(task, side);
        let n_plans = COARSE.n_plans(task, grid).max(Rule::ALL.len());
        let mut beginning = Phase { whole: observer, from: 0.0, to: 0.0 };
        if let Some(planned) = improved(task, grid, n_plans, Rule::ALL.len(), &mut beginning)? {
            return Ok(planned);
        }
        side *= GROWTH;
    }
    Err(too_large(task.margin, task.outlines.len()))
}

/// The smallest square of a number of plans, within the grid; gives up where the first `patience` of them find none.
fn improved(
    task: &Task<'_>,
    grid: Grid,
    n_plans: usize,
    patience: usize,
    observer: &mut dyn Observer,
) -> Result<Option<Planned>, Error> {
    let poses = all_poses(task, grid, &Watch::new(observer, 0.0, MESSAGE))?;
    let mut numbers = Numbers(1);
    let mut best: Option<(Layout, Plan)> = None;
    for k in 0..n_plans {
        if best.is_none() && k >= patience {
            break;
        }
        let fraction = k as f64 / n_plans as f64;
        if !observer.progress(fraction, MESSAGE) {
            return Err(Error::CancelledEarly);
        }
        let watch = Watch::new(observer, fraction, MESSAGE);
        let plan = plan(task, k, &mut numbers);
        let limit = best.as_ref().map_or(grid.side, |(layout, _)| layout.extent - 1);
        if let Some(layout) = tightest(&poses, &plan, limit, grid, &watch)? {
            best = Some((layout, plan));
        }
    }
    Ok(best.map(|(layout, plan)| (arrangement(&poses, &layout, grid), plan)))
}

/// The arrangement made again on finer grids, by its plan and at its angles, as far as that makes the square smaller.
fn refined(
    task: &Task<'_>,
    (mut best, plan): Planned,
    observer: &mut dyn Observer,
) -> Result<Arrangement, Error> {
    let plan = Plan { first_pose: None, ..plan };
    for refinement in REFINEMENTS {
        let angles: Vec<Vec<f64>> = best.places.iter().map(|place| vec![place.angle]).collect();
        let task = Task { angles: &angles, ..*task };
        let grid = FINE.grid(&task, best.side).refined(refinement);
        if words(&task, grid) > FINE.max_words / 4 {
            break;
        }
        let watch = Watch::new(observer, 1.0, MESSAGE);
        let poses = all_poses(&task, grid, &watch)?;
        let layout = tightest(&poses, &plan, grid.side, grid, &watch)?;
        let finer = layout.map(|layout| arrangement(&poses, &layout, grid));
        best = finer.filter(|finer| finer.side < best.side * (1.0 - EQUAL)).unwrap_or(best);
    }
    Ok(best)
}

/// The islands in all poses.
fn all_poses(task: &Task<'_>, grid: Grid, watch: &Watch<'_>) -> Result<Vec<Vec<Pose>>, Error> {
    // what is left of the unit square within the margin is the whole grid at the most
    let gap = task.margin.gap(grid.length());
    let pairs: Vec<(&Outline, f64)> = task
        .outlines
        .iter()
        .zip(task.angles)
        .flat_map(|(outline, angles)| angles.iter().map(move |&angle| (outline, angle)))
        .collect();
    let poses = parallel::tasks(pairs.len(), |k| {
        let (outline, angle) = pairs[k];
        if watch.goes_on() { Pose::new(outline, angle, task.aspect, gap, grid) } else { Pose::default() }
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
    let order = largest_first(&keys);
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
