// SPDX-License-Identifier: MIT OR Apache-2.0
//! Fillings of boundary loops: a cone, whose tip [`apex_of`] finds, or a smooth [`membrane()`].

mod apex;
mod membrane;

pub(crate) use apex::{apex_of, spanned_area};
pub(crate) use membrane::{cone, is_fat, membrane};
