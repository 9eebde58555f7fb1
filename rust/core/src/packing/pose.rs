// SPDX-License-Identifier: MIT OR Apache-2.0
//! An island turned by one angle, as cells of a grid.

use super::angles::{direction, flattened, turned, turned_box};
use super::atlas::{Grid, Probes};
use super::mask::{Mask, ROUNDING};
use super::outline::{Outline, Point};

/// An island turned by one angle and flattened, its bounding box moved to the origin.
#[derive(Debug, Clone, Default)]
pub(super) struct Pose {
    /// The angle, counterclockwise.
    pub angle: f64,
    /// The lower left corner of the bounding box before it is moved.
    pub corner: Point,
    /// Width and height.
    pub size: Point,
    /// Width and height in whole cells.
    pub cells: [usize; 2],
    /// The cells that the island touches.
    pub probes: Probes,
    /// The cells within the gap around the island.
    pub halo: Mask,
}

impl Pose {
    /// The cells of an island that keeps a gap around it; none where the island is larger than the grid. Turned, it is
    /// flattened by the `aspect` of the texture.
    pub fn new(outline: &Outline, angle: f64, aspect: f64, gap: f64, grid: Grid) -> Self {
        let [corner, end] = turned_box(&outline.hull, angle, aspect);
        let size = [end[0] - corner[0], end[1] - corner[1]];
        let cells = size.map(|length| (length / grid.cell + ROUNDING) as usize + 1);
        let pose = Self { angle, corner, size, cells, ..Self::default() };
        if cells.iter().any(|&n| n > grid.side) {
            return pose;
        }
        let direction = direction(angle);
        let to_cells = |point| {
            let point = flattened(turned(point, direction), aspect);
            [(point[0] - corner[0]) / grid.cell, (point[1] - corner[1]) / grid.cell]
        };
        let edges: Vec<_> = outline.edges.iter().map(|edge| edge.map(to_cells)).collect();
        let body = Mask::new(&edges, 0.0).clipped(cells);
        Self { probes: Probes::new(&body, grid), halo: Mask::new(&edges, gap / grid.cell), ..pose }
    }
}
