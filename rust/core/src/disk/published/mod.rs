// SPDX-License-Identifier: MIT OR Apache-2.0
//! The papers' methods on the disk (Liu & Yueh 2023): the objective, the fixed point, and the run from start to result.

pub(super) mod fixed_point;
pub(super) mod objective;
pub(super) mod run;
