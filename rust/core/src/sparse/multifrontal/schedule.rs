// SPDX-License-Identifier: MIT OR Apache-2.0
//! The schedule of the elimination: which subtrees run on a thread of their own.

use std::ops::Range;

use super::fronts::Fronts;

/// Multiplications below which a thread does not pay.
const GRAIN: f64 = 4e5;

/// The order of the work on a range of whole subtrees.
pub(super) enum Schedule {
    /// One front after the other.
    InOrder,
    /// `before` in order, then `left` and `right` at the same time, then `after` in order. The four are contiguous
    /// in this order, and the last may need all of the others.
    Split { before: Range<usize>, left: Range<usize>, right: Range<usize>, after: Range<usize> },
}

impl Schedule {
    /// Plans a range of fronts that are whole subtrees.
    ///
    /// Each split leaves a good part of the work to either side, so that splits nest a few dozen deep however long the
    /// branches of the tree are.
    pub(super) fn of(fronts: &Fronts, range: &Range<usize>) -> Self {
        let grain = GRAIN.max(fronts.work(&(0..fronts.len())) / 64.0);
        let (mut start, mut end) = (range.start, range.end);
        while fronts.work(&(start..end)) >= 2.0 * grain {
            let middle = halve(fronts, start..end);
            if middle == start {
                // one root: its subtrees come first
                end -= 1;
            } else if fronts.work(&(middle..end)) < grain {
                end = middle;
            } else if fronts.work(&(start..middle)) < grain {
                start = middle;
            } else {
                return Self::Split {
                    before: range.start..start,
                    left: start..middle,
                    right: middle..end,
                    after: end..range.end,
                };
            }
        }
        Self::InOrder
    }
}

/// The boundary between two subtrees that is nearest to half of the work; the start where there is one subtree.
fn halve(fronts: &Fronts, range: Range<usize>) -> usize {
    let half = fronts.work(&range) / 2.0;
    let mut best = (f64::INFINITY, range.start);
    for root in fronts.roots(range.clone()) {
        let boundary = fronts.front(root).first as usize;
        let off = (fronts.work(&(boundary..range.end)) - half).abs();
        if boundary > range.start && off < best.0 {
            best = (off, boundary);
        }
    }
    best.1
}
