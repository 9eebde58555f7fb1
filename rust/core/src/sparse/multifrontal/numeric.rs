// SPDX-License-Identifier: MIT OR Apache-2.0
//! The numbers of the factor: fronts are assembled from elements and from their children's updates.

use std::ops::Range;

use super::super::factor::Scalar;
use super::fronts::{Element, Fronts, Run};
use super::schedule::Schedule;
use super::{Failure, dense};
use crate::control::Watch;
use crate::parallel;

/// Multiplications between two looks at the watch.
const LOOK: f64 = 1e6;

/// Writes the factor of the sum of all elements; `assemble` adds one element to its front.
pub(super) fn factorize<T: Scalar>(
    fronts: &Fronts,
    factor: &mut [T],
    assemble: &(impl Fn(&Element, &mut Place<'_, T>) + Sync),
    watch: &Watch<'_>,
) -> Result<(), Failure> {
    let elimination = Numeric { fronts, assemble, watch };
    parallel::install(|| elimination.range(0..fronts.len(), factor, &mut Updates::default()))
}

/// Where the elements of one front are added.
pub(in crate::sparse) struct Place<'a, T> {
    panel: &'a mut [T],
    height: usize,
    width: usize,
    /// What belongs below the columns: (place in the update, value).
    late: &'a mut Vec<(usize, T)>,
}

impl<T: Scalar> Place<'_, T> {
    /// Adds an entry of the symmetric front, given on either side of the diagonal.
    #[inline]
    pub(in crate::sparse) fn add(&mut self, one: usize, other: usize, value: f64) {
        let (row, column) = (one.max(other), one.min(other));
        let value = T::from_f64(value);
        if column < self.width {
            self.panel[column * self.height + row] += value;
        } else {
            let rows = self.height - self.width;
            self.late.push(((column - self.width) * rows + row - self.width, value));
        }
    }
}

/// A stack of updates, square and column-major, of which only the lower triangles mean something.
struct Updates<T> {
    values: Vec<T>,
    top: usize,
    late: Vec<(usize, T)>,
}

impl<T> Default for Updates<T> {
    fn default() -> Self {
        Self { values: Vec::new(), top: 0, late: Vec::new() }
    }
}

impl<T: Scalar> Updates<T> {
    /// The stack and room for `length` more numbers.
    fn split(&mut self, length: usize) -> (&mut [T], &mut [T]) {
        if self.values.len() < self.top + length {
            self.values.resize((self.top + length).max(self.values.len() * 3 / 2), T::ZERO);
        }
        let (used, free) = self.values.split_at_mut(self.top);
        (used, &mut free[..length])
    }

    /// Puts the `length` numbers above the stack in the place of the last `taken` on it.
    fn replace_last(&mut self, taken: usize, length: usize) {
        let base = self.top - taken;
        if taken > 0 {
            self.values.copy_within(self.top..self.top + length, base);
        }
        self.top = base + length;
    }

    fn append(&mut self, other: &Self) {
        let (_, room) = self.split(other.top);
        room.copy_from_slice(&other.values[..other.top]);
        self.top += other.top;
    }
}

struct Numeric<'a, 'w, A> {
    fronts: &'a Fronts,
    assemble: &'a A,
    watch: &'a Watch<'w>,
}

impl<A> Numeric<'_, '_, A> {
    /// Eliminates whole subtrees; the updates of their roots go onto the stack.
    fn range<T: Scalar>(
        &self,
        range: Range<usize>,
        factor: &mut [T],
        updates: &mut Updates<T>,
    ) -> Result<(), Failure>
    where
        A: Fn(&Element, &mut Place<'_, T>) + Sync,
    {
        let Schedule::Split { before, left, right, after } = Schedule::of(self.fronts, &range) else {
            return self.in_order(range, factor, updates);
        };
        let length = |range: &Range<usize>| self.fronts.panels(range).len();
        let (of_before, rest) = factor.split_at_mut(length(&before));
        let (of_left, rest) = rest.split_at_mut(length(&left));
        let (of_right, of_after) = rest.split_at_mut(length(&right));
        self.in_order(before, of_before, updates)?;
        let mut others = Updates::default();
        let (one, other) = parallel::join(
            || self.range(left, of_left, updates),
            || self.range(right, of_right, &mut others),
        );
        one.and(other)?;
        updates.append(&others);
        drop(others);
        self.in_order(after, of_after, updates)
    }

    fn in_order<T: Scalar>(
        &self,
        range: Range<usize>,
        mut factor: &mut [T],
        updates: &mut Updates<T>,
    ) -> Result<(), Failure>
    where
        A: Fn(&Element, &mut Place<'_, T>) + Sync,
    {
        let mut since_look = 0.0;
        for front in range {
            let (panel, rest) = factor.split_at_mut(self.fronts.panels(&(front..front + 1)).len());
            factor = rest;
            self.eliminate(front, panel, updates)?;
            since_look += self.fronts.work(&(front..front + 1));
            if since_look > LOOK {
                since_look = 0.0;
                if !self.watch.goes_on() {
                    return Err(Failure::Cancelled);
                }
            }
        }
        Ok(())
    }

    fn eliminate<T: Scalar>(
        &self,
        front: usize,
        panel: &mut [T],
        updates: &mut Updates<T>,
    ) -> Result<(), Failure>
    where
        A: Fn(&Element, &mut Place<'_, T>) + Sync,
    {
        let (height, width) = (self.fronts.front(front).height(), self.fronts.front(front).columns());
        let rows = height - width;
        let mut late = std::mem::take(&mut updates.late);
        let (stack, update) = updates.split(rows * rows);
        // 1. the panel: elements, then what the children leave
        panel.fill(T::ZERO);
        let mut place = Place { panel, height, width, late: &mut late };
        self.fronts.elements(front).iter().for_each(|element| (self.assemble)(element, &mut place));
        self.for_each_child(front, stack, |child| child.add_to_panel(panel, height));
        // 2. the columns of the factor
        dense::eliminate(panel, (height, width), update, self.watch)?;
        // 3. what the parent must add
        late.drain(..).for_each(|(place, value)| update[place] += value);
        let taken = self.for_each_child(front, stack, |child| child.add_to_update(update, rows, width));
        updates.replace_last(taken, rows * rows);
        updates.late = late;
        Ok(())
    }

    /// Visits the updates of all children, last first; returns their length on the stack.
    fn for_each_child<T>(&self, front: usize, stack: &[T], mut visit: impl FnMut(Child<'_, T>)) -> usize {
        let mut end = stack.len();
        for child in self.fronts.children(front) {
            let (runs, child) = (self.fronts.runs(child), self.fronts.front(child));
            let start = end - child.rows() * child.rows();
            visit(Child {
                update: &stack[start..end],
                rows: child.rows(),
                shared: child.n_shared as usize,
                runs,
            });
            end = start;
        }
        stack.len() - end
    }
}

/// The update of a child and where its rows are in the parent.
struct Child<'a, T> {
    update: &'a [T],
    rows: usize,
    /// How many of the rows are columns of the parent.
    shared: usize,
    runs: &'a [Run],
}

impl<T: Scalar> Child<'_, T> {
    fn add_to_panel(&self, panel: &mut [T], height: usize) {
        self.add(0..self.shared, panel, height, 0);
    }

    fn add_to_update(&self, update: &mut [T], rows: usize, width: usize) {
        self.add(self.shared..self.rows, update, rows, width);
    }

    /// Adds some columns to those of the parent, whose first row and column here is its row `offset`.
    fn add(&self, columns: Range<usize>, out: &mut [T], height: usize, offset: usize) {
        for (k, run) in self.runs.iter().enumerate() {
            let (from, length) = (run.from as usize, run.length as usize);
            for column in from.max(columns.start)..(from + length).min(columns.end) {
                let source = &self.update[column * self.rows..(column + 1) * self.rows];
                let to = run.to as usize + column - from - offset;
                let out = &mut out[to * height..(to + 1) * height];
                add_slice(&mut out[to..], &source[column..from + length]);
                for run in &self.runs[k + 1..] {
                    let (from, length) = (run.from as usize, run.length as usize);
                    add_slice(&mut out[run.to as usize - offset..], &source[from..from + length]);
                }
            }
        }
    }
}

#[inline]
fn add_slice<T: Scalar>(out: &mut [T], add: &[T]) {
    for (out, &add) in out.iter_mut().zip(add) {
        *out += add;
    }
}
