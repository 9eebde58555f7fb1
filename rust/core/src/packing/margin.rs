// SPDX-License-Identifier: MIT OR Apache-2.0
//! The distance that islands keep.

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
