// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options of a repair and their check.

use crate::error::Error;

/// Which holes a repair closes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum CloseHoles {
    /// None.
    Off,
    /// Those of at most 8 edges whose area is at most a tenth of that of their piece.
    #[default]
    Pinholes,
    /// Those of at most so many edges.
    UpTo(usize),
    /// All.
    All,
}

/// Which handles a repair closes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum CloseHandles {
    /// None.
    #[default]
    Off,
    /// Those as small as the noise of a mesh: that a loop opens whose length is at most 24 mean edges of their piece,
    /// and at most a tenth of √area, of its area.
    Noise,
    /// Those that a loop of at most this length opens.
    UpTo(f64),
    /// All.
    All,
}

/// Which pieces a repair keeps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Keep {
    /// All of them.
    #[default]
    All,
    /// The one of the largest area.
    Largest,
    /// The one that has more than half of the area; where none has, the mesh is refused.
    Main,
}

/// Options of [`repair`](super::repair).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RepairOptions {
    /// Open edges whose ends are no farther apart are joined; by default those whose ends are equal. `None`: none.
    pub merge: Option<f64>,
    /// The holes to close; by default pinholes.
    pub close_holes: CloseHoles,
    /// Whether the longest boundary loop of each piece stays open, as that of a disk; by default it may be closed.
    pub keep_outline: bool,
    /// The handles to close; by default none.
    pub close_handles: CloseHandles,
    /// The pieces to keep; by default all.
    pub keep: Keep,
}

impl Default for RepairOptions {
    fn default() -> Self {
        Self {
            merge: Some(0.0),
            close_holes: CloseHoles::default(),
            keep_outline: false,
            close_handles: CloseHandles::default(),
            keep: Keep::default(),
        }
    }
}

impl RepairOptions {
    /// What a map needs: one piece without pinholes and without handles of noise.
    pub fn for_a_map(keep_outline: bool) -> Self {
        Self { keep_outline, close_handles: CloseHandles::Noise, keep: Keep::Main, ..Default::default() }
    }

    /// Refuses lengths that are no lengths.
    pub(super) fn check(&self) -> Result<(), Error> {
        check_length("merge", self.merge.unwrap_or(0.0), f64::MAX)?;
        match self.close_handles {
            CloseHandles::UpTo(length) => check_length("close_handles", length, f64::INFINITY),
            _ => Ok(()),
        }
    }
}

fn check_length(name: &'static str, length: f64, most: f64) -> Result<(), Error> {
    if (0.0..=most).contains(&length) {
        return Ok(());
    }
    let (found, expected) = (length.to_string(), "a length ≥ 0, in the unit of the vertices".into());
    Err(Error::InvalidOption { name, found, expected })
}
