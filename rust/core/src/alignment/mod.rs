// SPDX-License-Identifier: MIT OR Apache-2.0
//! Alignment of point sets: the best rotation, the best similarity.

pub(crate) mod rotation;
pub(crate) mod similarity;
