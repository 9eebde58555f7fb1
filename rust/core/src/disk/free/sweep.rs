// SPDX-License-Identifier: MIT OR Apache-2.0
//! Overlaps of two sets of boxes, by a sweep.
//!
//! Cost: O(n log n) and one comparison for every two boxes that overlap in x.

/// An axis-parallel box.
#[derive(Debug, Clone, Copy)]
pub(super) struct Extent {
    pub low: [f64; 2],
    pub high: [f64; 2],
}

impl Extent {
    pub(super) fn of(points: impl Iterator<Item = [f64; 2]>) -> Self {
        let nothing = Self { low: [f64::INFINITY; 2], high: [f64::NEG_INFINITY; 2] };
        points.fold(nothing, |Self { low, high }, x| Self {
            low: [low[0].min(x[0]), low[1].min(x[1])],
            high: [high[0].max(x[0]), high[1].max(x[1])],
        })
    }

    pub(super) fn widened(self, by: f64) -> Self {
        Self { low: self.low.map(|x| x - by), high: self.high.map(|x| x + by) }
    }

    fn overlaps_in_height(&self, other: &Self) -> bool {
        self.low[1] <= other.high[1] && other.low[1] <= self.high[1]
    }
}

/// Calls `visit` with the indices of every box of `first` and box of `second` that overlap.
pub(super) fn for_each_overlap(first: &[Extent], second: &[Extent], mut visit: impl FnMut(usize, usize)) {
    // 1. Sort all boxes by their lower ends
    let entry = |set: usize| move |(place, extent): (usize, &Extent)| (extent.low[0], set, place);
    let mut order: Vec<(f64, usize, usize)> =
        first.iter().enumerate().map(entry(0)).chain(second.iter().enumerate().map(entry(1))).collect();
    order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    // 2. Compare each with the open boxes of the other set
    let sets = [first, second];
    let mut open: [Vec<usize>; 2] = [Vec::new(), Vec::new()];
    for (begin, set, place) in order {
        let (extent, opposite) = (&sets[set][place], 1 - set);
        open[opposite].retain(|&k| sets[opposite][k].high[0] >= begin);
        for &k in open[opposite].iter().filter(|&&k| extent.overlaps_in_height(&sets[opposite][k])) {
            if set == 0 { visit(place, k) } else { visit(k, place) }
        }
        open[set].push(place);
    }
}
