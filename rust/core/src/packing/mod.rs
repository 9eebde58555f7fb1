// SPDX-License-Identifier: MIT OR Apache-2.0
//! Packs islands into the unit square: [`pack`].
//!
//! All islands keep one scale, the largest for which a place is found; they are turned and moved, never mirrored.
//!
//! 1. An island counts as what its outline encloses ([`outline`]), at a number of angles ([`angles`]).
//! 2. At each angle it becomes cells of a grid ([`mask`]): all that it touches, and all within the margin. So islands
//!    that share no cell do not overlap, and keep the margin.
//! 3. Islands are placed one by one, the largest first, each where it costs least among all places that are free
//!    ([`placement`], [`atlas`]). Smaller islands come to lie in bays and holes of larger ones.
//! 4. That is done again in less room, in other orders and by other rules, first on a coarse grid, then on a fine one;
//!    the best is repeated on finer grids ([`search`]).
//!
//! One island alone is turned so that the smallest square holds it. Of very many islands the small ones are gathered in
//! blocks first ([`blocks`]).
//!
//! Input: islands, which may overlap themselves. Cost: for each placement of all islands, (angles of all islands) · (words
//! of the grid) · (the few rows of an island that show that a place is taken). There are up to 60 placements, fewer of
//! many islands: about a tenth of a second for 20 islands, a quarter for 100.

mod angles;
mod atlas;
mod blocks;
mod margin;
mod mask;
mod outline;
mod placement;
mod pose;
mod rotation;
mod search;

use std::f64::consts::FRAC_PI_2;

use crate::control::{Observer, Watch};
use crate::error::Error;
use crate::parallel;
use angles::{
    EQUAL, angles_around, direction, flattened, least, square_angle, turned, turned_box, turned_size,
};
use blocks::{MANY, Piece};
pub use margin::Margin;
pub use outline::Island;
use outline::{Outline, Point};
pub use rotation::Rotation;
use search::{Arrangement, MESSAGE, Placed, Task, smallest_square};

/// At how many angles all around an island is tried whose area is at least a share of that of all islands.
const ANGLES: [(f64, usize); 3] = [(LARGE, 16), (0.001, 8), (0.0, 4)];

/// The share of the area from which on an island is also tried as it fits into the smallest square.
const LARGE: f64 = 0.01;

/// The share of the square that islands take at first; where they do not fit, the square grows.
const FIRST_SHARE: f64 = 0.45;

/// The share of the square that blocks are expected to take.
const BLOCKS_SHARE: f64 = 0.85;

/// The part of the usual effort that is made to pack blocks, which are all boxes.
const BLOCKS_EFFORT: f64 = 0.1;

/// How often the side of the square is estimated, and how often islands are gathered anew because it was too small.
const SIDES: usize = 8;

/// What is added to a side that was too small.
const SPARE: f64 = 0.02;

/// How much rounding may add to a coordinate, over its largest part: at most eight operations (three each for the turn and
/// for the offset, one for the scale, one for the sum) have errors of half an ε, and twice that is on the safe side.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// The share of the square that may be left free at each side against rounding: a scale is positive even for islands that
/// are moved so far that nothing is left of their shape.
const MOST_ROUNDING: f64 = 0.25;

/// Options of [`pack`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PackOptions {
    /// The least distance between islands, and to the border of the square.
    pub margin: Margin,
    /// Whether islands may be turned.
    pub rotation: Rotation,
    /// Width over height of the texture that the square stands for: islands keep their shapes on it.
    pub aspect: f64,
}

impl Default for PackOptions {
    fn default() -> Self {
        Self { margin: Margin::OfSquare(0.002), rotation: Rotation::Free, aspect: 1.0 }
    }
}

/// Where an island goes: turned about the origin, then scaled, then moved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// The angle, counterclockwise.
    pub angle: f64,
    /// Where the origin of the island's plane goes.
    pub offset: [f64; 2],
}

/// Where all islands go.
#[derive(Debug, Clone, PartialEq)]
pub struct Packing {
    /// The common scale, upward.
    pub scale: f64,
    /// Width over height of the texture: the scale to the right is the common one divided by it.
    pub aspect: f64,
    /// The places of the islands, in their order.
    pub places: Vec<Place>,
}

impl Packing {
    /// Islands that stay where they are.
    pub(crate) fn unmoved(islands: usize) -> Self {
        Self { scale: 1.0, aspect: 1.0, places: vec![Place { angle: 0.0, offset: [0.0; 2] }; islands] }
    }

    /// Where a point of an island goes.
    pub fn apply(&self, island: usize, point: [f64; 2]) -> [f64; 2] {
        let Place { angle, offset } = self.places[island];
        let [x, y] = flattened(turned(point, direction(angle)), self.aspect);
        [self.scale * x + offset[0], self.scale * y + offset[1]]
    }
}

/// Packs islands into the unit square, all by one scale.
///
/// # Errors
///
/// [`Error::InvalidOption`] for a margin that is out of range, or too large for the number of islands;
/// [`Error::InvalidArray`] for points that are not finite and for islands without any area; [`Error::CancelledEarly`].
pub fn pack(
    islands: &[Island<'_>],
    options: &PackOptions,
    observer: &mut dyn Observer,
) -> Result<Packing, Error> {
    check(islands, options)?;
    if islands.is_empty() {
        return Ok(Packing { scale: 1.0, aspect: options.aspect, places: Vec::new() });
    }
    // 1. Outlines and angles.
    let outlines = outlines(islands, &Watch::new(observer, 0.0, MESSAGE))?;
    let area: f64 = outlines.iter().map(|outline| outline.area).sum();
    if !(area > 0.0 && area.is_finite()) {
        return Err(invalid_islands(format!("of area {area}"), "of a positive area"));
    }
    // 2. The smallest square that holds the islands.
    let arrangement = if let [outline] = &outlines[..] {
        alone(outline, options)
    } else if outlines.len() < MANY {
        parallel::install(|| by_outlines(&outlines, options, 1.0, observer))?
    } else {
        parallel::install(|| in_blocks(&outlines, options, observer))?
    };
    // 3. That square, within the margin, in the unit square.
    Ok(in_unit_square(&arrangement, options))
}

fn check(islands: &[Island<'_>], options: &PackOptions) -> Result<(), Error> {
    options.margin.check()?;
    if !(options.aspect > 0.0 && options.aspect.is_finite()) {
        return Err(Error::InvalidOption {
            name: "aspect",
            found: options.aspect.to_string(),
            expected: "a finite number > 0".into(),
        });
    }
    options.margin.check_room(islands.len(), options.aspect)?;
    let is_finite = |island: &Island<'_>| island.points.as_flattened().iter().all(|x| x.is_finite());
    match islands.iter().position(|island| !is_finite(island)) {
        Some(island) => Err(invalid_islands(format!("not finite in island {island}"), "of finite points")),
        None => Ok(()),
    }
}

fn invalid_islands(found: String, expected: &str) -> Error {
    Error::InvalidArray { name: "islands", found, expected: expected.into() }
}

fn outlines(islands: &[Island<'_>], watch: &Watch<'_>) -> Result<Vec<Outline>, Error> {
    let outlines = parallel::tasks(islands.len(), |k| {
        if watch.goes_on() { Outline::new(&islands[k]) } else { Outline::default() }
    });
    if watch.goes_on() { Ok(outlines) } else { Err(Error::CancelledEarly) }
}

/// The smallest square found by the outlines of all islands.
fn by_outlines(
    outlines: &[Outline],
    options: &PackOptions,
    effort: f64,
    observer: &mut dyn Observer,
) -> Result<Arrangement, Error> {
    let area: f64 = outlines.iter().map(|outline| outline.area).sum();
    let angles = parallel::tasks(outlines.len(), |k| {
        tried_angles(&outlines[k].hull, outlines[k].area / area, options)
    });
    let PackOptions { margin, aspect, .. } = *options;
    let task = Task { outlines, angles: &angles, margin, aspect, effort };
    smallest_square(&task, first_side(&task, area / aspect), observer)
}

/// The smallest square found for many islands, the small ones in blocks.
fn in_blocks(
    outlines: &[Outline],
    options: &PackOptions,
    observer: &mut dyn Observer,
) -> Result<Arrangement, Error> {
    // the gap in a block must do for the square that the blocks will need
    let gap = |side: f64| options.margin.gap(side) * options.aspect.max(1.0);
    let room = |side: f64| {
        let pieces = blocks::pieces(outlines, options.rotation, gap(side));
        let area: f64 = pieces.iter().map(|piece| piece.outline.area).sum();
        (area / BLOCKS_SHARE / options.aspect).sqrt()
    };
    let mut side = (0..SIDES).fold(room(0.0), |side, _| room(side));
    for _ in 0..SIDES {
        let pieces = blocks::pieces(outlines, options.rotation, gap(side));
        let boxes: Vec<Outline> = pieces.iter().map(|piece| piece.outline.clone()).collect();
        let arrangement = by_outlines(&boxes, options, BLOCKS_EFFORT, observer)?;
        if gap(arrangement.side) <= gap(side) {
            return Ok(of_members(&arrangement, &pieces, outlines.len(), options.aspect));
        }
        side = arrangement.side * (1.0 + SPARE);
    }
    Err(Error::InvalidOption {
        name: "margin",
        found: options.margin.value().to_string(),
        expected: format!("small enough for {} islands", outlines.len()),
    })
}

/// The places of the islands in pieces that have been placed.
fn of_members(arrangement: &Arrangement, pieces: &[Piece], n_islands: usize, aspect: f64) -> Arrangement {
    let mut places = vec![Placed { angle: 0.0, offset: [0.0; 2] }; n_islands];
    for (piece, place) in pieces.iter().zip(&arrangement.places) {
        for member in &piece.members {
            let [x, y] = flattened(turned(member.offset, direction(place.angle)), aspect);
            let offset = [place.offset[0] + x, place.offset[1] + y];
            places[member.island] = Placed { angle: place.angle + member.angle, offset };
        }
    }
    Arrangement { side: arrangement.side, places }
}

/// The angles at which an island is tried that has a share of the area of all.
fn tried_angles(hull: &[Point], share: f64, options: &PackOptions) -> Vec<f64> {
    match options.rotation {
        Rotation::Fixed => return vec![0.0],
        Rotation::Cardinal => return (0..4).map(|k| f64::from(k) * FRAC_PI_2).collect(),
        Rotation::Free => {}
    }
    // of a hundred equal islands rounding must not decide which are large
    let share = share * (1.0 + EQUAL);
    let n = ANGLES.iter().find(|&&(least, _)| share >= least).map_or(1, |&(_, n)| n);
    let mut angles = angles_around(hull, n);
    if share >= LARGE {
        let upright = square_angle(hull, options.aspect);
        angles.extend((0..4).map(|k| upright + f64::from(k) * FRAC_PI_2));
    }
    angles
}

/// The side of the square to begin with: no smaller than one that holds the largest island.
fn first_side(task: &Task<'_>, area: f64) -> f64 {
    let squares = task.outlines.iter().zip(task.angles).map(|(outline, angles)| {
        let sides = angles.iter().map(|&angle| longer_side(&outline.hull, angle, task.aspect));
        sides.fold(f64::INFINITY, f64::min)
    });
    squares.fold((area / FIRST_SHARE).sqrt(), f64::max) * (1.0 + 1e-9)
}

fn longer_side(hull: &[Point], angle: f64, aspect: f64) -> f64 {
    let [width, height] = turned_size(hull, angle, aspect);
    width.max(height)
}

/// The smallest square that holds one island.
fn alone(outline: &Outline, options: &PackOptions) -> Arrangement {
    let angle = match options.rotation {
        Rotation::Fixed => 0.0,
        Rotation::Cardinal => {
            least(&[0.0, FRAC_PI_2], |angle| longer_side(&outline.hull, angle, options.aspect))
        }
        Rotation::Free => square_angle(&outline.hull, options.aspect),
    };
    let [corner, _] = turned_box(&outline.hull, angle, options.aspect);
    let place = Placed { angle, offset: corner.map(|x| -x) };
    Arrangement { side: longer_side(&outline.hull, angle, options.aspect), places: vec![place] }
}

/// An arrangement scaled into the unit square without a margin around it.
fn in_unit_square(arrangement: &Arrangement, &PackOptions { margin, aspect, .. }: &PackOptions) -> Packing {
    let Arrangement { side, places } = arrangement;
    let gap = margin.gap(*side);
    let whole = side + 2.0 * gap;
    // What rounding may add to a coordinate: the more, the farther an island is moved.
    let farthest = places.iter().flat_map(|place| place.offset).fold(*side, |most, x| most.max(x.abs()));
    let rounding = (ROUNDING * farthest / whole).min(MOST_ROUNDING);
    let scale = (1.0 - 2.0 * rounding) / whole;
    let places = places.iter().map(|&Placed { angle, offset }| {
        let offset = offset.map(|x| rounding + scale * (gap + x));
        Place { angle, offset }
    });
    Packing { scale, aspect, places: places.collect() }
}
