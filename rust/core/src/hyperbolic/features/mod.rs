// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the surfaces are cut along: curves, the pieces that closed curves leave, and the features of each piece.

pub(super) mod curves;
pub(super) mod parameters;
pub(super) mod piece;
pub(super) mod pieces;
pub(super) mod placement;
pub(super) mod regions;
