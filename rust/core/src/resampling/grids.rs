// SPDX-License-Identifier: MIT OR Apache-2.0
//! Grids of rows and columns over the sphere and the plane: their cells lie between lines x = const and y = const.
//!
//! On the sphere x is the longitude λ and y the height z, so that dx dy is the element of area (Archimedes). Rows run
//! from the top down and columns from left to right, as in pictures; longitudes run from −π to π.

use std::f64::consts::{PI, TAU};

use ndarray::Array2;

use crate::arrays::from_rows;
use crate::error::Error;

/// Most cells of a grid.
const MOST_CELLS: usize = 1 << 30;

/// A grid of rows and columns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Grid {
    /// Over the sphere, by equal steps of latitude and of longitude.
    Equirectangular {
        /// The rows, from the north to the south pole.
        rows: usize,
        /// The columns, from the longitude −π to π.
        columns: usize,
    },
    /// Over the sphere, by equal steps of height and of longitude (Lambert 1772): all cells have one area.
    EqualArea {
        /// The rows, from the north to the south pole.
        rows: usize,
        /// The columns, from the longitude −π to π.
        columns: usize,
    },
    /// Over an upright rectangle of the plane.
    Planar {
        /// The rows, from the top down.
        rows: usize,
        /// The columns, from left to right.
        columns: usize,
        /// The left, right, lower and upper side.
        extent: [f64; 4],
    },
}

impl Grid {
    /// Checks that the grid has cells, not too many, and a size.
    ///
    /// # Errors
    /// [`Error::InvalidOption`].
    pub fn check(&self) -> Result<(), Error> {
        let [rows, columns] = self.shape();
        let n_cells = rows.saturating_mul(columns);
        if !(1..=MOST_CELLS).contains(&n_cells) {
            let (found, expected) = (format!("({rows}, {columns})"), format!("of 1 to {MOST_CELLS} cells"));
            return Err(Error::InvalidOption { name: "shape", found, expected });
        }
        if let Self::Planar { extent, .. } = self {
            let [left, right, lower, upper] = *extent;
            let has_size = left < right && lower < upper && extent.iter().all(|side| side.is_finite());
            if !has_size {
                let expected =
                    "(left, right, lower, upper) with left < right and lower < upper, finite".into();
                return Err(Error::InvalidOption { name: "extent", found: format!("{extent:?}"), expected });
            }
        }
        Ok(())
    }

    /// The numbers of rows and columns.
    pub fn shape(&self) -> [usize; 2] {
        match *self {
            Self::Equirectangular { rows, columns }
            | Self::EqualArea { rows, columns }
            | Self::Planar { rows, columns, .. } => [rows, columns],
        }
    }

    /// The centers of the cells, row by row: (rows × columns, 3) on the sphere, (rows × columns, 2) in the plane.
    pub fn centers(&self) -> Array2<f64> {
        let [rows, columns] = self.shape();
        let cells = (0..rows * columns).map(|cell| (cell / columns, cell % columns));
        let across = |column: usize| self.vertical(column as f64 + 0.5);
        match self {
            Self::Planar { .. } => from_rows(
                cells.map(|(row, column)| [across(column), self.horizontal(row as f64 + 0.5)]).collect(),
            ),
            _ => {
                let direction = |(row, column): (usize, usize)| {
                    let height = self.horizontal(row as f64 + 0.5);
                    let radius = self.radius(row as f64 + 0.5);
                    let (sin, cos) = across(column).sin_cos();
                    [radius * cos, radius * sin, height]
                };
                from_rows(cells.map(direction).collect())
            }
        }
    }

    /// The areas of the cells, row by row.
    pub fn areas(&self) -> Vec<f64> {
        let [rows, columns] = self.shape();
        let width = self.width();
        let of_row = |row: usize| width * (self.horizontal(row as f64) - self.horizontal(row as f64 + 1.0));
        (0..rows * columns).map(|cell| of_row(cell / columns)).collect()
    }

    /// Whether the columns run around the sphere.
    pub(super) fn is_round(&self) -> bool {
        !matches!(self, Self::Planar { .. })
    }

    /// The width of a column.
    pub(super) fn width(&self) -> f64 {
        match *self {
            Self::Planar { columns, extent: [left, right, ..], .. } => (right - left) / columns as f64,
            _ => TAU / self.shape()[1] as f64,
        }
    }

    /// The place x of the line on the left of a column.
    pub(super) fn vertical(&self, column: f64) -> f64 {
        match *self {
            Self::Planar { columns, extent: [left, right, ..], .. } => {
                left + (right - left) * (column / columns as f64)
            }
            _ => TAU * (column / self.shape()[1] as f64) - PI,
        }
    }

    /// The place y of the line above a row.
    pub(super) fn horizontal(&self, row: f64) -> f64 {
        match *self {
            Self::Equirectangular { rows, .. } => (PI * (row / rows as f64)).cos(),
            Self::EqualArea { rows, .. } => 1.0 - 2.0 * (row / rows as f64),
            Self::Planar { rows, extent: [_, _, lower, upper], .. } => {
                upper - (upper - lower) * (row / rows as f64)
            }
        }
    }

    /// The distance of a height on the sphere from the axis.
    fn radius(&self, row: f64) -> f64 {
        match *self {
            Self::Equirectangular { rows, .. } => (PI * (row / rows as f64)).sin(),
            _ => {
                let height = self.horizontal(row);
                ((1.0 - height) * (1.0 + height)).max(0.0).sqrt()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GRIDS: [Grid; 2] =
        [Grid::Equirectangular { rows: 6, columns: 9 }, Grid::EqualArea { rows: 6, columns: 9 }];

    #[test]
    fn the_cells_of_the_sphere_have_its_area_and_their_centers_lie_on_it() {
        for grid in GRIDS {
            assert!((grid.areas().iter().sum::<f64>() - 4.0 * PI).abs() < 1e-13);
            assert!(grid.centers().rows().into_iter().all(|row| (row.dot(&row) - 1.0).abs() < 1e-15));
        }
        let areas = GRIDS[1].areas();
        assert!(areas.iter().all(|area| (area - areas[0]).abs() < 1e-15));
    }

    #[test]
    fn pictures_begin_at_the_upper_left() {
        let grid = Grid::Planar { rows: 2, columns: 4, extent: [0.0, 4.0, 0.0, 2.0] };
        assert_eq!(grid.centers().row(0).to_vec(), [0.5, 1.5]);
        assert_eq!(grid.centers().row(7).to_vec(), [3.5, 0.5]);
        assert_eq!(grid.areas(), [1.0; 8]);
    }

    #[test]
    fn grids_without_cells_or_size_are_refused() {
        for grid in [
            Grid::EqualArea { rows: 0, columns: 3 },
            Grid::EqualArea { rows: usize::MAX, columns: 3 },
            Grid::Planar { rows: 1, columns: 1, extent: [0.0, 0.0, 0.0, 1.0] },
            Grid::Planar { rows: 1, columns: 1, extent: [0.0, f64::NAN, 0.0, 1.0] },
        ] {
            assert!(matches!(grid.check(), Err(Error::InvalidOption { .. })));
        }
    }
}
