// SPDX-License-Identifier: MIT OR Apache-2.0
//! Substitution with a factor over the tree: up the tree with L, down with Lᵀ.
//!
//! A front passes what it subtracts from the rows below to its parent, and receives the solution there from it, so that
//! subtrees share nothing and run on threads of their own.

use std::ops::Range;

use super::fronts::{Front, Fronts};
use super::kernels;
use super::schedule::Schedule;
use crate::parallel;
use crate::sparse::faer::Scalar;

/// Solves `L Lᵀ x = b` in place for K right-hand sides, ordered by front and within a front by right-hand side.
pub(super) fn substitute<T: Scalar, const K: usize>(fronts: &Fronts, factor: &[T], x: &mut [T]) {
    let substitution = Substitution::<T, K> { fronts, factor };
    parallel::install(|| {
        substitution.up(0..fronts.len(), x, &mut Vec::new());
        substitution.down(0..fronts.len(), x, &mut Vec::new());
    });
}

struct Substitution<'a, T, const K: usize> {
    fronts: &'a Fronts,
    factor: &'a [T],
}

impl<T: Scalar, const K: usize> Substitution<'_, T, K> {
    /// Solves L x = b; what the roots subtract from the rows below them goes onto the stack.
    fn up(&self, range: Range<usize>, x: &mut [T], stack: &mut Vec<T>) {
        let Schedule::Split { before, left, right, after } = Schedule::of(self.fronts, &range) else {
            return self.up_in_order(range, x, stack);
        };
        let (of_before, rest) = x.split_at_mut(self.unknowns(&before));
        let (of_left, rest) = rest.split_at_mut(self.unknowns(&left));
        let (of_right, of_after) = rest.split_at_mut(self.unknowns(&right));
        self.up_in_order(before, of_before, stack);
        let mut right_stack = Vec::new();
        parallel::join(|| self.up(left, of_left, stack), || self.up(right, of_right, &mut right_stack));
        stack.extend_from_slice(&right_stack);
        self.up_in_order(after, of_after, stack);
    }

    fn up_in_order(&self, range: Range<usize>, x: &mut [T], stack: &mut Vec<T>) {
        kernels::on_wide_vectors(|| {
            let mut x = x;
            let mut vector = Vec::new();
            for index in range {
                let front = self.fronts.front(index);
                let (eliminated, rest) = x.split_at_mut(K * front.columns());
                x = rest;
                self.gather_children(index, eliminated, stack, &mut vector);
                forward::<T, K>(self.panel(index), front, &mut vector);
                scatter::<T, K>(front, &vector, eliminated, stack);
            }
        });
    }

    /// Solves Lᵀ x = b; pops the solution in the rows below the roots off the stack.
    fn down(&self, range: Range<usize>, x: &mut [T], stack: &mut Vec<T>) {
        let Schedule::Split { before, left, right, after } = Schedule::of(self.fronts, &range) else {
            return self.down_in_order(range, x, stack);
        };
        let (of_before, rest) = x.split_at_mut(self.unknowns(&before));
        let (of_left, rest) = rest.split_at_mut(self.unknowns(&left));
        let (of_right, of_after) = rest.split_at_mut(self.unknowns(&right));
        self.down_in_order(after, of_after, stack);
        let of_roots: usize =
            self.fronts.roots(right.clone()).map(|root| self.fronts.front(root).rows()).sum();
        let mut right_stack = stack.split_off(stack.len() - K * of_roots);
        parallel::join(|| self.down(left, of_left, stack), || self.down(right, of_right, &mut right_stack));
        self.down_in_order(before, of_before, stack);
    }

    fn down_in_order(&self, range: Range<usize>, x: &mut [T], stack: &mut Vec<T>) {
        kernels::on_wide_vectors(|| {
            let mut x = x;
            let mut vector = Vec::new();
            for index in range.rev() {
                let front = self.fronts.front(index);
                let (rest, eliminated) = x.split_at_mut(x.len() - K * front.columns());
                x = rest;
                gather_parent::<T, K>(front, eliminated, stack, &mut vector);
                backward::<T, K>(self.panel(index), front, &mut vector);
                self.scatter_to_children(index, &vector, eliminated, stack);
            }
        });
    }

    fn unknowns(&self, range: &Range<usize>) -> usize {
        K * self.fronts.columns(range).len()
    }

    fn panel(&self, front: usize) -> &[T] {
        &self.factor[self.fronts.panels(&(front..front + 1))]
    }

    /// The vector over all rows of a front: its right-hand side and what its children subtract.
    #[inline(always)]
    fn gather_children(&self, index: usize, eliminated: &[T], stack: &mut Vec<T>, vector: &mut Vec<T>) {
        let front = self.fronts.front(index);
        let (height, width) = (front.height(), front.columns());
        vector.clear();
        vector.resize(K * height, T::ZERO);
        for k in 0..K {
            vector[k * height..k * height + width].copy_from_slice(&eliminated[k * width..(k + 1) * width]);
        }
        for child in self.fronts.children(index) {
            let rows = self.fronts.front(child).rows();
            let update = &stack[stack.len() - K * rows..];
            for run in self.fronts.runs(child) {
                let (from, to, length) = (run.from as usize, run.to as usize, run.length as usize);
                for k in 0..K {
                    let out = &mut vector[k * height + to..k * height + to + length];
                    let add = &update[k * rows + from..k * rows + from + length];
                    out.iter_mut().zip(add).for_each(|(out, &add)| *out += add);
                }
            }
            stack.truncate(stack.len() - K * rows);
        }
    }

    /// Keeps the solution of the front's own columns and hands the children what they need.
    #[inline(always)]
    fn scatter_to_children(&self, index: usize, vector: &[T], eliminated: &mut [T], stack: &mut Vec<T>) {
        let front = self.fronts.front(index);
        let (height, width) = (front.height(), front.columns());
        for k in 0..K {
            eliminated[k * width..(k + 1) * width].copy_from_slice(&vector[k * height..k * height + width]);
        }
        let of_children: usize =
            self.fronts.children(index).map(|child| self.fronts.front(child).rows()).sum();
        let mut end = stack.len() + K * of_children;
        stack.resize(end, T::ZERO);
        for child in self.fronts.children(index) {
            let rows = self.fronts.front(child).rows();
            let values = &mut stack[end - K * rows..end];
            for run in self.fronts.runs(child) {
                let (from, to, length) = (run.from as usize, run.to as usize, run.length as usize);
                for k in 0..K {
                    values[k * rows + from..k * rows + from + length]
                        .copy_from_slice(&vector[k * height + to..k * height + to + length]);
                }
            }
            end -= K * rows;
        }
    }
}

/// Splits the vector of a front into its own columns and what the parent must add.
#[inline(always)]
fn scatter<T: Scalar, const K: usize>(front: &Front, vector: &[T], eliminated: &mut [T], stack: &mut Vec<T>) {
    let (height, width) = (front.height(), front.columns());
    for k in 0..K {
        let (columns, rows) = vector[k * height..(k + 1) * height].split_at(width);
        eliminated[k * width..(k + 1) * width].copy_from_slice(columns);
        stack.extend_from_slice(rows);
    }
}

/// The vector over all rows of a front: its right-hand side and the solution below, taken off the stack.
#[inline(always)]
fn gather_parent<T: Scalar, const K: usize>(
    front: &Front,
    eliminated: &[T],
    stack: &mut Vec<T>,
    vector: &mut Vec<T>,
) {
    let (width, rows) = (front.columns(), front.rows());
    let below = stack.len() - K * rows;
    vector.clear();
    for k in 0..K {
        vector.extend_from_slice(&eliminated[k * width..(k + 1) * width]);
        vector.extend_from_slice(&stack[below + k * rows..below + (k + 1) * rows]);
    }
    stack.truncate(below);
}

/// Solves L x = b for the columns of a front; subtracts their part from the rows below.
#[inline(always)]
fn forward<T: Scalar, const K: usize>(panel: &[T], front: &Front, vector: &mut [T]) {
    let (height, width) = (front.height(), front.columns());
    for start in (0..width).step_by(4) {
        let end = width.min(start + 4);
        for k in 0..K {
            let x = &mut vector[k * height..(k + 1) * height];
            let (solved, below) = x.split_at_mut(end);
            for j in start..end {
                let column = &panel[j * height..(j + 1) * height];
                let pivot = solved[j] / column[j];
                solved[j] = pivot;
                (j + 1..end).for_each(|i| solved[i] -= column[i] * pivot);
            }
            let columns = &panel[start * height..end * height];
            kernels::subtract_columns(below, (columns, height, end - start), end, |p| solved[start + p]);
        }
    }
}

/// Solves Lᵀ x = b for the columns of a front, the rows below known.
#[inline(always)]
fn backward<T: Scalar, const K: usize>(panel: &[T], front: &Front, vector: &mut [T]) {
    let (height, width) = (front.height(), front.columns());
    for start in (0..width).step_by(4).rev() {
        let end = width.min(start + 4);
        let column = |j: usize| &panel[j.min(end - 1) * height..(j.min(end - 1) + 1) * height];
        let below = [0, 1, 2, 3].map(|p| &column(start + p)[end..]);
        for k in 0..K {
            let x = &mut vector[k * height..(k + 1) * height];
            let (solved, known) = x.split_at_mut(end);
            let products = kernels::four_inner_products(below, known);
            for j in (start..end).rev() {
                let column = column(j);
                let inside = (j + 1..end).fold(products[j - start], |sum, i| sum + column[i] * solved[i]);
                solved[j] = (solved[j] - inside) / column[j];
            }
        }
    }
}
