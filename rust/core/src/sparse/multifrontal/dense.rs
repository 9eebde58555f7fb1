// SPDX-License-Identifier: MIT OR Apache-2.0
//! The elimination of one front: its panel becomes columns of the factor; its update is added to the parent.
//!
//! Small fronts use loops of our own, larger ones general dense kernels. The largest are cut into tiles of a fixed
//! size, which several threads share and between which a run can be cancelled. The result of a tile does not depend on
//! its thread.

use super::kernels;
use crate::control::Watch;
use crate::parallel;
use crate::sparse::faer::{
    Block, BlockRef, Scalar, block, block_ref, cholesky_in_place, lower_solve_rows, subtract_product,
};

/// Panels with fewer entries or columns use our own loops.
const SMALL: (usize, usize) = (400, 8);
/// Columns of the largest block that is factored at once, and of the tiles of products.
const TILE: usize = 128;
/// Rows of the tiles of triangular solves.
const TALL: usize = 512;
/// Multiplications from which two tiles are worth two threads.
const GRAIN: f64 = 1e6;

/// Factors the `width` columns of a panel of `height` rows and writes −L Lᵀ of the rows below into the lower
/// triangle of `update`.
pub(super) fn eliminate<T: Scalar>(
    panel: &mut [T],
    (height, width): (usize, usize),
    update: &mut [T],
    watch: &Watch<'_>,
) -> Result<(), Failure> {
    #[cfg(test)]
    let is_small = kernels::processor::chosen().is_some();
    #[cfg(not(test))]
    let is_small = false;
    if is_small || panel.len() < SMALL.0 || width <= SMALL.1 {
        return kernels::on_wide_vectors(|| {
            let positive = kernels::eliminate(panel, height, width);
            kernels::subtract_square(update, panel, height, width);
            if positive { Ok(()) } else { Err(Failure::NotPositiveDefinite) }
        });
    }
    let rows = height - width;
    factor_columns(block(panel, height, width), watch)?;
    let below = block_ref(panel, height, width).get(width.., ..);
    subtract_lower(block(update, rows, rows), below, true, watch)
}

/// Factors a panel block by block.
fn factor_columns<T: Scalar>(mut panel: Block<'_, T>, watch: &Watch<'_>) -> Result<(), Failure> {
    let width = panel.ncols();
    for start in (0..width).step_by(TILE) {
        let end = width.min(start + TILE);
        let rest = panel.as_mut().get_mut(start.., start..);
        let (current, right) = rest.split_at_col_mut(end - start);
        let (mut diagonal, mut below) = current.split_at_row_mut(end - start);
        if !cholesky_in_place(diagonal.as_mut()) {
            return Err(Failure::NotPositiveDefinite);
        }
        solve_rows(diagonal.as_ref(), below.as_mut(), watch)?;
        subtract_lower(right.get_mut(end - start.., ..), below.as_ref(), false, watch)?;
    }
    Ok(())
}

/// `below := below · L⁻ᵀ` for the lower triangle L of `diagonal`.
fn solve_rows<T: Scalar>(
    diagonal: BlockRef<'_, T>,
    below: Block<'_, T>,
    watch: &Watch<'_>,
) -> Result<(), Failure> {
    let (rows, width) = (below.nrows(), below.ncols());
    if rows <= TALL {
        lower_solve_rows(diagonal, below);
        return go_on(watch);
    }
    let (upper, lower) = below.split_at_row_mut((rows / TALL).div_ceil(2) * TALL);
    both(
        (rows * width * width) as f64,
        || solve_rows(diagonal, upper, watch),
        || solve_rows(diagonal, lower, watch),
    )
}

/// `out -= rows · rowsᵀ` (or `out := −rows · rowsᵀ`) on and below the diagonal of `out`, whose columns are the first
/// of its rows.
fn subtract_lower<T: Scalar>(
    out: Block<'_, T>,
    rows: BlockRef<'_, T>,
    replace: bool,
    watch: &Watch<'_>,
) -> Result<(), Failure> {
    let (height, width) = (out.nrows(), out.ncols());
    if width <= TILE {
        let (triangle, rest) = out.split_at_row_mut(width);
        let (first, below) = rows.split_at_row(width);
        subtract_product(triangle, first, first, replace, true);
        subtract_product(rest, below, first, replace, false);
        return go_on(watch);
    }
    let middle = (width / TILE).div_ceil(2) * TILE;
    let (left, right) = out.split_at_col_mut(middle);
    both(
        (height * width * rows.ncols()) as f64,
        || subtract_lower(left, rows, replace, watch),
        || subtract_lower(right.get_mut(middle.., ..), rows.get(middle.., ..), replace, watch),
    )
}

/// Runs both closures, at the same time where the work is worth it.
fn both(
    work: f64,
    left: impl FnOnce() -> Result<(), Failure> + Send,
    right: impl FnOnce() -> Result<(), Failure> + Send,
) -> Result<(), Failure> {
    if work < GRAIN {
        left()?;
        return right();
    }
    let (left, right) = parallel::join(left, right);
    left.and(right)
}

fn go_on(watch: &Watch<'_>) -> Result<(), Failure> {
    if watch.goes_on() { Ok(()) } else { Err(Failure::Cancelled) }
}

/// The reason why there is no factor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Failure {
    /// A pivot is not positive, or not finite, to working precision.
    NotPositiveDefinite,
    /// The observer asked to stop.
    Cancelled,
}
