// SPDX-License-Identifier: MIT OR Apache-2.0
//! Which of two surfaces an error is about.

use std::fmt;

/// One of the two surfaces of a registration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Side {
    /// The surface that is mapped.
    Source,
    /// The surface that it is mapped onto.
    Target,
}

impl Side {
    /// `source` or `target`.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Source => "source",
            Self::Target => "target",
        }
    }

    /// The surface that an argument is about: arguments about one of two surfaces begin with its name.
    pub fn of_argument(name: &str) -> Option<Self> {
        [Self::Source, Self::Target].into_iter().find(|side| name.starts_with(side.as_str()))
    }
}

impl fmt::Display for Side {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.as_str())
    }
}
