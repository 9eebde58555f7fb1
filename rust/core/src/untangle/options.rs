// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options of [`untangle`](super::untangle).

/// Options of [`untangle`](super::untangle).
#[derive(Debug, Clone, Copy)]
pub struct UntangleOptions<'a> {
    /// Vertices that stay in place, in addition to those of the boundary.
    pub fixed: &'a [usize],
    /// Least area, in `[0, 1)`, of a face that was folded or lost area to a folded one, in units of its fair share: the
    /// area of its patch divided in proportion to the areas on the surface.
    pub tolerance: f64,
}

impl Default for UntangleOptions<'_> {
    fn default() -> Self {
        Self { fixed: &[], tolerance: 0.01 }
    }
}
