// SPDX-License-Identifier: MIT OR Apache-2.0
//! The numbers of the factor: fronts are assembled from elements and from their children's updates.

use std::ops::Range;
use std::sync::Mutex;

use super::dense;
use super::dense::Failure;
use super::fronts::{Element, Fronts, Run};
use super::schedule::Schedule;
use crate::control::Watch;
use crate::parallel;
use crate::sparse::faer::Scalar;

/// Multiplications between two questions to the watch.
const LOOK: f64 = 1e6;

/// Writes the factor of the sum of all elements; `assemble` adds one element to its front. `scratch` keeps the memory
/// of the updates for the next factorization.
pub(super) fn factorize<T: Scalar>(
    fronts: &Fronts,
    factor: &mut [T],
    assemble: &(impl Fn(&Element, &mut Place<'_, T>) + Sync),
    scratch: &mut Vec<Updates<T>>,
    watch: &Watch<'_>,
) -> Result<(), Failure> {
    let elimination = Numeric { fronts, assemble, scratch: Mutex::new(std::mem::take(scratch)), watch };
    let mut updates = elimination.no_updates();
    let verdict = parallel::install(|| elimination.range(0..fronts.len(), factor, &mut updates));
    elimination.keep(updates);
    *scratch = elimination.scratch.into_inner().unwrap_or_default();
    verdict
}

/// The front to which elements are added.
pub(in crate::sparse) struct Place<'a, T> {
    panel: &'a mut [T],
    height: usize,
    width: usize,
    /// The entries below the columns: (place in the update, value).
    late: &'a mut Vec<(usize, T)>,
}

impl<T: Scalar> Place<'_, T> {
    /// Adds an entry of the symmetric front, given on either side of the diagonal.
    #[inline]
    pub(in crate::sparse) fn add(&mut self, i: usize, j: usize, value: f64) {
        let (row, column) = (i.max(j), i.min(j));
        let value = T::from_f64(value);
        if column < self.width {
            self.panel[column * self.height + row] += value;
        } else {
            let rows = self.height - self.width;
            self.late.push(((column - self.width) * rows + row - self.width, value));
        }
    }
}

/// The updates that wait for their parents, on two stacks: a front takes the updates of its children off one stack and
/// puts its own on the other, by the parity of its depth in the tree.
#[derive(Debug, Clone)]
pub(super) struct Updates<T> {
    stacks: [Stack<T>; 2],
    late: Vec<(usize, T)>,
}

/// A stack of updates, square and column-major, of which only the lower triangles are used.
#[derive(Debug, Clone)]
struct Stack<T> {
    values: Vec<T>,
    top: usize,
}

impl<T: Scalar> Default for Updates<T> {
    fn default() -> Self {
        let empty = || Stack { values: Vec::new(), top: 0 };
        Self { stacks: [empty(), empty()], late: Vec::new() }
    }
}

impl<T: Scalar> Updates<T> {
    fn append(&mut self, other: &Self) {
        for (stack, appended) in self.stacks.iter_mut().zip(&other.stacks) {
            stack.push(appended.top).copy_from_slice(&appended.values[..appended.top]);
        }
    }
}

impl<T: Scalar> Stack<T> {
    /// Room for `length` more numbers, of any value.
    fn push(&mut self, length: usize) -> &mut [T] {
        let top = self.top + length;
        if self.values.len() < top {
            self.values.resize(top.max(self.values.len() * 3 / 2), T::ZERO);
        }
        &mut self.values[std::mem::replace(&mut self.top, top)..top]
    }
}

struct Numeric<'a, 'w, A, T> {
    fronts: &'a Fronts,
    assemble: &'a A,
    /// Memory that no thread is using.
    scratch: Mutex<Vec<Updates<T>>>,
    watch: &'a Watch<'w>,
}

impl<A, T: Scalar> Numeric<'_, '_, A, T>
where
    A: Fn(&Element, &mut Place<'_, T>) + Sync,
{
    /// Empty updates, in reused memory where there is some.
    fn no_updates(&self) -> Updates<T> {
        let mut updates = self.scratch.lock().ok().and_then(|mut unused| unused.pop()).unwrap_or_default();
        updates.stacks.iter_mut().for_each(|stack| stack.top = 0);
        updates.late.clear();
        updates
    }

    fn keep(&self, updates: Updates<T>) {
        if let Ok(mut unused) = self.scratch.lock() {
            unused.push(updates);
        }
    }

    /// Eliminates whole subtrees; the updates of their roots go onto the stack.
    fn range(&self, range: Range<usize>, factor: &mut [T], updates: &mut Updates<T>) -> Result<(), Failure> {
        let Schedule::Split { before, left, right, after } = Schedule::of(self.fronts, &range) else {
            return self.in_order(range, factor, updates);
        };
        let length = |range: &Range<usize>| self.fronts.panels(range).len();
        let (of_before, rest) = factor.split_at_mut(length(&before));
        let (of_left, rest) = rest.split_at_mut(length(&left));
        let (of_right, of_after) = rest.split_at_mut(length(&right));
        self.in_order(before, of_before, updates)?;
        let mut right_updates = self.no_updates();
        let (left, right) = parallel::join(
            || self.range(left, of_left, updates),
            || self.range(right, of_right, &mut right_updates),
        );
        left.and(right)?;
        updates.append(&right_updates);
        self.keep(right_updates);
        self.in_order(after, of_after, updates)
    }

    fn in_order(
        &self,
        range: Range<usize>,
        mut factor: &mut [T],
        updates: &mut Updates<T>,
    ) -> Result<(), Failure> {
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

    fn eliminate(&self, front: usize, panel: &mut [T], updates: &mut Updates<T>) -> Result<(), Failure> {
        let (height, width) = (self.fronts.front(front).height(), self.fronts.front(front).columns());
        let rows = height - width;
        let Updates { stacks: [even, odd], late } = updates;
        let is_odd = self.fronts.front(front).is_odd;
        let (own_stack, of_children) = if is_odd { (odd, even) } else { (even, odd) };
        let (update, stack) = (own_stack.push(rows * rows), &of_children.values[..of_children.top]);
        // 1. Assemble the panel from elements and the children's updates
        panel.fill(T::ZERO);
        let mut place = Place { panel, height, width, late };
        self.fronts.elements(front).iter().for_each(|element| (self.assemble)(element, &mut place));
        self.for_each_child(front, stack, |child| child.add_to_panel(panel, height));
        // 2. Eliminate the columns
        dense::eliminate(panel, (height, width), update, self.watch)?;
        // 3. Complete the update for the parent
        late.drain(..).for_each(|(place, value)| update[place] += value);
        of_children.top -=
            self.for_each_child(front, stack, |child| child.add_to_update(update, rows, width));
        Ok(())
    }

    /// Visits the updates of all children, last first; returns their length on the stack.
    fn for_each_child(&self, front: usize, stack: &[T], mut visit: impl FnMut(Child<'_, T>)) -> usize {
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

/// The update of a child, with the runs of its rows in the parent.
struct Child<'a, T> {
    update: &'a [T],
    rows: usize,
    /// The number of rows that are columns of the parent.
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

    /// Adds some columns to those of the parent; `out` begins at the parent's row and column `offset`.
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
