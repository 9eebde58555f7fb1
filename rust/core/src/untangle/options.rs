// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options of [`untangle`](super::untangle).

/// Options of [`untangle`].
#[derive(Debug, Clone, Copy)]
pub struct UntangleOptions<'a> {
    /// Vertices that stay where they are, beside those of the boundary, which stay anyway.
    pub fixed: &'a [usize],
    /// Least area of a face that was folded, or lost area to one, in units of its fair share: the area of its patch
    /// divided in proportion to the areas on the surface. In `[0, 1)`.
    pub tolerance: f64,
}

impl Default for UntangleOptions<'_> {
    fn default() -> Self {
        Self { fixed: &[], tolerance: 0.01 }
    }
}
