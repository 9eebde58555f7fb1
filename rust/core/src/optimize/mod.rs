// SPDX-License-Identifier: MIT OR Apache-2.0
//! Optimizers over maps: guarded Gauss–Newton, our own, and those of the papers.

pub(crate) mod gauss_newton;
pub mod published;
