// SPDX-License-Identifier: MIT OR Apache-2.0
//! The papers' methods on the sphere (Sutti & Yueh 2024): the objective, the fixed point, and the run from start to
//! result.

pub(super) mod fixed_point;
pub(super) mod objective;
pub(super) mod run;
