// SPDX-License-Identifier: MIT OR Apache-2.0
//! How islands may be turned.

/// By which angles islands may be turned.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rotation {
    /// None.
    Fixed,
    /// Right angles.
    Cardinal,
    /// Any.
    Free,
}
