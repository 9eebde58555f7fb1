// SPDX-License-Identifier: MIT OR Apache-2.0
//! What can be wrong with a mesh, with an option or with a computation.
//!
//! Every message names what failed, the elements (the first few indices and how many there are) and what
//! the caller can do about it. Only broken input and failed numerics are errors: a run that stops early
//! returns its best map with a [`Status`](crate::Status).

use std::fmt;

use thiserror::Error;

/// How many indices an [`Elements`] keeps and prints.
pub const NAMED_ELEMENTS: usize = 8;

/// Indices of offending elements: the first few and the count of all.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Elements {
    /// The first [`NAMED_ELEMENTS`] indices, in the order found.
    pub first: Vec<usize>,
    /// How many elements offend in all.
    pub count: usize,
}

impl Elements {
    /// Collects the indices of an iterator, or `None` where it is empty.
    pub fn collect(indices: impl IntoIterator<Item = usize>) -> Option<Self> {
        let mut all = indices.into_iter();
        let first: Vec<usize> = all.by_ref().take(NAMED_ELEMENTS).collect();
        let count = first.len() + all.count();
        (count > 0).then_some(Self { first, count })
    }
}

impl fmt::Display for Elements {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let named: Vec<String> = self.first.iter().map(usize::to_string).collect();
        write!(formatter, "{}", named.join(", "))?;
        match self.count - self.first.len() {
            0 => Ok(()),
            more => write!(formatter, " and {more} more"),
        }
    }
}
