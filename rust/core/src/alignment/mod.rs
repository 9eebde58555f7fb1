// SPDX-License-Identifier: MIT OR Apache-2.0
//! Rigid alignment of point sets.

pub(crate) mod rotation;
