// SPDX-License-Identifier: MIT OR Apache-2.0
//! The harmonic map of a piece onto its partner, from local charts to the proof that it is one-to-one.

pub(super) mod atlas;
pub(super) mod certificates;
pub(super) mod chart_map;
pub(crate) mod delaunay;
pub(super) mod flat;
pub(crate) mod heat;
pub(super) mod initial;
pub(crate) mod inverse;
pub(super) mod layout;
pub(super) mod newton;
pub(super) mod piece_map;
