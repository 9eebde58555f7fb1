// SPDX-License-Identifier: MIT OR Apache-2.0
//! The distance that islands keep.

use std::f64::consts::FRAC_PI_4;

use crate::error::Error;

/// A distance between islands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Margin {
    /// In units of the square, ≥ 0 and < ½.
    OfSquare(f64),
    /// In the units of the islands before they are scaled, ≥ 0.
    OfIslands(f64),
}

impl Margin {
    /// The distance in units of the islands, where they lie in a square of this side, without the border.
    pub(super) fn gap(self, side: f64) -> f64 {
        match self {
            Self::OfSquare(margin) => margin * side / (1.0 - 2.0 * margin),
            Self::OfIslands(margin) => margin,
        }
    }

    /// The number, in its unit.
    pub(super) fn value(self) -> f64 {
        match self {
            Self::OfSquare(value) | Self::OfIslands(value) => value,
        }
    }

    /// Refuses what leaves no room for a number of islands in a texture of an aspect, whatever their shapes.
    pub(super) fn check_room(self, n_islands: usize, aspect: f64) -> Result<(), Error> {
        let Self::OfSquare(margin) = self else { return Ok(()) };
        // disks of half the margin about a point of each island do not overlap, and stay half the margin inside
        let disks = n_islands as f64 * FRAC_PI_4 * margin * margin;
        if n_islands < 2 || disks <= (1.0 - margin).powi(2) * aspect.max(1.0 / aspect) {
            return Ok(());
        }
        Err(too_large(self, n_islands))
    }

    pub(super) fn check(self) -> Result<(), Error> {
        let (is_sound, expected) = match self {
            Self::OfSquare(value) => ((0.0..0.5).contains(&value), "a number ≥ 0 and < .5"),
            Self::OfIslands(value) => ((0.0..f64::INFINITY).contains(&value), "a finite number ≥ 0"),
        };
        if is_sound {
            return Ok(());
        }
        let found = self.value().to_string();
        Err(Error::InvalidOption { name: "margin", found, expected: expected.into() })
    }
}

/// The error for a margin with which islands do not fit beside each other.
pub(super) fn too_large(margin: Margin, n_islands: usize) -> Error {
    Error::InvalidOption {
        name: "margin",
        found: margin.value().to_string(),
        expected: format!("small enough for {n_islands} islands"),
    }
}
