// SPDX-License-Identifier: MIT OR Apache-2.0
//! Landmark curves, the pieces into which closed curves divide the surfaces, and the features of each piece.

pub(super) mod curves;
pub(super) mod parameters;
pub(super) mod piece;
pub(super) mod pieces;
pub(super) mod placement;
pub(super) mod regions;
