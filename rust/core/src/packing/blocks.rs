// SPDX-License-Identifier: MIT OR Apache-2.0
//! Many small islands gathered by their boxes into a few blocks, which are packed as islands themselves.
//!
//! To look at every cell for every island takes time that grows with the square of their number, and of thousands of
//! islands it gains little: their boxes in rows leave small gaps only, because each row holds boxes of about one height.
//!
//! 1. Every island lies level, with its longer side to the right where it may be turned.
//! 2. The few large ones stay by themselves. The others, the highest first, are divided into blocks of about one area.
//! 3. A block is rows of boxes in the width that wastes least.
//!
//! Cost: O(n log n) for n islands.

use std::f64::consts::FRAC_PI_2;

use super::angles::{EQUAL, least_box_angle, turned_box, turned_size};
use super::outline::{Outline, Point};
use super::rotation::Rotation;
use crate::mesh::ties::largest_first;

/// From this number of islands on, small ones are gathered.
pub(super) const MANY: usize = 400;

/// The number of blocks, as in a square of eight by eight.
const BLOCKS: usize = 64;

/// The most islands that stay by themselves, and the least share of the area that they have.
const MOST_LARGE: usize = 100;
const LARGE: f64 = 1e-3;

/// Widths that are tried of a block, and the largest as a part of the side of a square of its area; the smallest is the
/// inverse.
const WIDTHS: usize = 24;
const WIDEST: f64 = 1.5;

/// An island in a block: turned, then moved.
#[derive(Debug, Clone, Copy)]
pub(super) struct Member {
    /// Its number.
    pub island: usize,
    /// The angle, counterclockwise.
    pub angle: f64,
    /// What is added to the turned points.
    pub offset: Point,
}

/// One island by itself, or some in rows.
#[derive(Debug, Clone)]
pub(super) struct Piece {
    /// The outline of the island, or the box of the block with its corner in the origin.
    pub outline: Outline,
    /// The islands.
    pub members: Vec<Member>,
}

/// The box of an island that lies level.
#[derive(Debug, Clone, Copy)]
struct Level {
    island: usize,
    angle: f64,
    corner: Point,
    size: Point,
}

/// All islands in pieces, those in a block a gap apart.
pub(super) fn pieces(outlines: &[Outline], rotation: Rotation, gap: f64) -> Vec<Piece> {
    // 1. The large islands
    let least = LARGE * outlines.iter().map(|outline| outline.area).sum::<f64>() * (1.0 - EQUAL);
    let areas: Vec<f64> = outlines.iter().map(|outline| outline.area).collect();
    let order = largest_first(&areas);
    let n_large = order.iter().take(MOST_LARGE).take_while(|&&island| outlines[island].area >= least).count();
    let (large, small) = order.split_at(n_large);
    let mut pieces: Vec<Piece> = large.iter().map(|&island| alone(outlines, island)).collect();
    // 2. The small ones, the highest first
    let mut small = small.to_vec();
    small.sort_unstable();
    let levels: Vec<Level> =
        small.iter().map(|&island| level(&outlines[island].hull, island, rotation)).collect();
    let heights: Vec<f64> = levels.iter().map(|level| level.size[1]).collect();
    let levels: Vec<Level> = largest_first(&heights).into_iter().map(|k| levels[k]).collect();
    // 3. Blocks of about one area
    let room = |level: &Level| (level.size[0] + gap) * (level.size[1] + gap);
    let total: f64 = levels.iter().map(room).sum();
    let (mut first, mut sum) = (0, 0.0);
    for k in 0..levels.len() {
        sum += room(&levels[k]);
        let is_full = sum * BLOCKS as f64 >= total * (1.0 - 1e-9);
        if is_full || k + 1 == levels.len() {
            pieces.push(block(&levels[first..=k], sum, gap));
            (first, sum) = (k + 1, 0.0);
        }
    }
    pieces
}

fn alone(outlines: &[Outline], island: usize) -> Piece {
    let member = Member { island, angle: 0.0, offset: [0.0; 2] };
    Piece { outline: outlines[island].clone(), members: vec![member] }
}

/// An island turned so that its box is small and no higher than wide.
fn level(hull: &[Point], island: usize, rotation: Rotation) -> Level {
    let mut angle = if rotation == Rotation::Free { least_box_angle(hull) } else { 0.0 };
    let [width, height] = turned_size(hull, angle, 1.0);
    if rotation != Rotation::Fixed && height > width * (1.0 + EQUAL) {
        angle += FRAC_PI_2;
    }
    let [corner, end] = turned_box(hull, angle, 1.0);
    Level { island, angle, corner, size: [end[0] - corner[0], end[1] - corner[1]] }
}

/// Rows of boxes with the least waste. The boxes take this `room`.
fn block(levels: &[Level], room: f64, gap: f64) -> Piece {
    let widest = levels.iter().map(|level| level.size[0]).fold(0.0, f64::max);
    let widths = (0..WIDTHS).map(|k| {
        let exponent = 2.0 * k as f64 / (WIDTHS - 1) as f64 - 1.0;
        (room.sqrt() * WIDEST.powf(exponent)).max(widest)
    });
    let best = widths.map(|width| rows(levels, width, gap)).reduce(|best, other| {
        let area = |(size, _): &(Point, Vec<Point>)| size[0] * size[1];
        if area(&other) < area(&best) * (1.0 - 1e-9) { other } else { best }
    });
    let (size, corners) = best.unwrap_or_default();
    let members = levels.iter().zip(corners).map(|(level, corner)| Member {
        island: level.island,
        angle: level.angle,
        offset: [corner[0] - level.corner[0], corner[1] - level.corner[1]],
    });
    Piece { outline: Outline::of_box(size), members: members.collect() }
}

/// The size of rows of at most a width, and the corner of each box.
fn rows(levels: &[Level], width: f64, gap: f64) -> (Point, Vec<Point>) {
    let (mut size, mut corners) = ([0.0; 2], Vec::with_capacity(levels.len()));
    let [mut x, mut y] = [0.0; 2];
    for level in levels {
        if x > 0.0 && x + level.size[0] > width * (1.0 + 1e-9) {
            [x, y] = [0.0, size[1] + gap];
        }
        corners.push([x, y]);
        size = [f64::max(size[0], x + level.size[0]), f64::max(size[1], y + level.size[1])];
        x += level.size[0] + gap;
    }
    (size, corners)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_of_a_block_keep_the_gap_and_waste_little() {
        let outlines: Vec<Outline> = (0..3000)
            .map(|k| Outline::of_box([1.0 + 0.37 * f64::from(k % 7), 0.5 + 0.11 * f64::from(k % 13)]))
            .collect();
        for rotation in [Rotation::Fixed, Rotation::Cardinal, Rotation::Free] {
            let pieces = pieces(&outlines, rotation, 0.02);
            assert!(pieces.len() <= BLOCKS + 1);
            let mut islands: Vec<usize> =
                pieces.iter().flat_map(|piece| &piece.members).map(|member| member.island).collect();
            islands.sort_unstable();
            assert!(islands.into_iter().eq(0..outlines.len()));
            for piece in &pieces {
                let boxes = piece.members.iter().map(|member| {
                    let [low, high] = turned_box(&outlines[member.island].hull, member.angle, 1.0);
                    [low, high].map(|corner| [0, 1].map(|axis| corner[axis] + member.offset[axis]))
                });
                let boxes: Vec<[Point; 2]> = boxes.collect();
                for (k, one) in boxes.iter().enumerate() {
                    let is_apart = |other: &[Point; 2]| {
                        (0..2).any(|axis| {
                            one[0][axis] - other[1][axis] > 0.02 - 1e-9
                                || other[0][axis] - one[1][axis] > 0.02 - 1e-9
                        })
                    };
                    assert!(boxes[..k].iter().all(is_apart));
                }
            }
            let [used, taken] = [
                outlines.iter().map(|outline| outline.area).sum::<f64>(),
                pieces.iter().map(|piece| piece.outline.area).sum::<f64>(),
            ];
            assert!(used > 0.85 * taken, "{}", used / taken);
        }
    }
}
