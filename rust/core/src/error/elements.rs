// SPDX-License-Identifier: MIT OR Apache-2.0
//! The elements at fault: the indices of the first few and the count of all.

use std::fmt;

/// How many elements an [`Elements`] keeps and prints.
pub(super) const NAMED_ELEMENTS: usize = 8;

/// Offending elements: the indices of the first few and the count of all.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Elements {
    /// The indices of the first `NAMED_ELEMENTS` elements, in the order found: `arity` numbers for each.
    pub first: Vec<usize>,
    /// How many elements offend in all.
    pub count: usize,
    /// How many indices name one element: 1 for vertices, faces and loops; 2 for edges, named by their ends.
    pub arity: usize,
}

impl Elements {
    /// Collects the indices of an iterator, or `None` where it is empty.
    pub fn collect(indices: impl IntoIterator<Item = impl Into<usize>>) -> Option<Self> {
        Self::gather(indices.into_iter().map(|index| [index.into()]))
    }

    /// Collects edges, each named by its two vertices, or `None` where there are none.
    pub fn edges(edges: impl IntoIterator<Item = [impl Into<usize>; 2]>) -> Option<Self> {
        Self::gather(edges.into_iter().map(|edge| edge.map(Into::into)))
    }

    fn gather<const ARITY: usize>(mut all: impl Iterator<Item = [usize; ARITY]>) -> Option<Self> {
        let named: Vec<_> = all.by_ref().take(NAMED_ELEMENTS).collect();
        let count = named.len() + all.count();
        (count > 0).then(|| Self { first: named.concat(), count, arity: ARITY })
    }

    /// Gives the elements other numbers.
    pub(super) fn renumber(&mut self, number_of: &dyn Fn(usize) -> usize) {
        self.first.iter_mut().for_each(|index| *index = number_of(*index));
    }

    /// The elements as a phrase: `face 3`, `2 edges ((0, 4), (4, 7))`, `12 vertices (0, 1, 2, …)`.
    pub(super) fn named(&self, noun: &str) -> String {
        match self.count {
            1 => format!("{noun} {self}"),
            count => format!("{count} {} ({self})", plural(noun)),
        }
    }

    fn name(&self, element: &[usize]) -> String {
        let indices: Vec<String> = element.iter().map(usize::to_string).collect();
        match self.arity {
            1 => indices.concat(),
            _ => format!("({})", indices.join(", ")),
        }
    }
}

impl fmt::Display for Elements {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let named: Vec<String> = self.first.chunks(self.arity.max(1)).map(|e| self.name(e)).collect();
        write!(formatter, "{}", named.join(", "))?;
        match self.count.saturating_sub(named.len()) {
            0 => Ok(()),
            _ => write!(formatter, ", …"),
        }
    }
}

fn plural(noun: &str) -> String {
    match noun {
        "vertex" => "vertices".into(),
        _ => format!("{noun}s"),
    }
}
