// SPDX-License-Identifier: MIT OR Apache-2.0
//! Loops over the columns of small fronts, where the call of a general dense kernel costs more than its work.
//!
//! All are inlined into code compiled for the processor's widest vectors (see [`on_wide_vectors`]).

use crate::sparse::faer::Scalar;

/// Runs `work` compiled for the widest vectors that this processor has.
pub(super) fn on_wide_vectors<R>(work: impl FnOnce() -> R) -> R {
    arch().dispatch(work)
}

#[cfg(not(test))]
fn arch() -> pulp::Arch {
    pulp::Arch::new()
}

#[cfg(test)]
fn arch() -> pulp::Arch {
    processor::chosen().unwrap_or_default()
}

/// `out -= Σ_p columns[p] · factors[p]`, all as long as `out`.
#[inline(always)]
fn subtract_four<T: Scalar>(out: &mut [T], columns: [&[T]; 4], factors: [T; 4]) {
    let n = out.len();
    let [a, b, c, d] = columns.map(|column| &column[..n]);
    for i in 0..n {
        out[i] -= (a[i] * factors[0] + b[i] * factors[1]) + (c[i] * factors[2] + d[i] * factors[3]);
    }
}

#[inline(always)]
fn subtract_one<T: Scalar>(out: &mut [T], column: &[T], factor: T) {
    for (out, &entry) in out.iter_mut().zip(column) {
        *out -= entry * factor;
    }
}

/// `out -= Σ_p panel[row.., p] · factor(p)` over the first `width` columns of a panel.
#[inline(always)]
pub(super) fn subtract_columns<T: Scalar>(
    out: &mut [T],
    (panel, height, width): (&[T], usize, usize),
    row: usize,
    factor: impl Fn(usize) -> T,
) {
    let column = |p: usize| &panel[p * height + row..(p + 1) * height];
    let fours = width / 4 * 4;
    for p in (0..fours).step_by(4) {
        let columns = [column(p), column(p + 1), column(p + 2), column(p + 3)];
        subtract_four(out, columns, [factor(p), factor(p + 1), factor(p + 2), factor(p + 3)]);
    }
    for p in fours..width {
        subtract_one(out, column(p), factor(p));
    }
}

/// The inner products of `x` with four columns as long, in eight interleaved sums each.
#[inline(always)]
pub(super) fn four_inner_products<T: Scalar>(columns: [&[T]; 4], x: &[T]) -> [T; 4] {
    let n = x.len();
    let (x_blocks, x_rest) = x.as_chunks::<8>();
    let [(a, a_rest), (b, b_rest), (c, c_rest), (d, d_rest)] =
        columns.map(|column| column[..n].as_chunks::<8>());
    let (mut sum_a, mut sum_b, mut sum_c, mut sum_d) =
        ([T::ZERO; 8], [T::ZERO; 8], [T::ZERO; 8], [T::ZERO; 8]);
    for ((((x, a), b), c), d) in x_blocks.iter().zip(a).zip(b).zip(c).zip(d) {
        for lane in 0..8 {
            sum_a[lane] += a[lane] * x[lane];
            sum_b[lane] += b[lane] * x[lane];
            sum_c[lane] += c[lane] * x[lane];
            sum_d[lane] += d[lane] * x[lane];
        }
    }
    let add = |s: [T; 8], rest: &[T]| {
        let sum = ((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7]));
        x_rest.iter().zip(rest).fold(sum, |sum, (&x, &entry)| sum + entry * x)
    };
    [add(sum_a, a_rest), add(sum_b, b_rest), add(sum_c, c_rest), add(sum_d, d_rest)]
}

/// Overwrites the columns of a panel by those of the factor; false where a pivot is not positive and finite.
#[inline(always)]
pub(super) fn eliminate<T: Scalar>(panel: &mut [T], height: usize, width: usize) -> bool {
    for j in 0..width {
        let (done, rest) = panel.split_at_mut(j * height);
        let column = &mut rest[j..height];
        subtract_columns(column, (done, height, j), j, |p| done[p * height + j]);
        let pivot = column[0];
        if !(pivot > T::ZERO && pivot.is_finite()) {
            return false;
        }
        let root = pivot.sqrt();
        let inverse = T::ONE / root;
        column[0] = root;
        column[1..].iter_mut().for_each(|entry| *entry *= inverse);
    }
    true
}

/// Writes −L Lᵀ of the rows below the columns of a factored panel into the lower triangle of `update`.
#[inline(always)]
pub(super) fn subtract_square<T: Scalar>(update: &mut [T], panel: &[T], height: usize, width: usize) {
    let rows = height - width;
    for j in 0..rows {
        let out = &mut update[j * rows + j..(j + 1) * rows];
        let row = width + j;
        out.fill(T::ZERO);
        subtract_columns(out, (panel, height, width), row, |p| panel[p * height + row]);
    }
}

/// Computes as another processor would, in tests.
#[cfg(test)]
pub(crate) mod processor {
    use std::cell::Cell;

    thread_local! {
        static CHOSEN: Cell<Option<pulp::Arch>> = const { Cell::new(None) };
    }

    pub(in super::super) fn chosen() -> Option<pulp::Arch> {
        CHOSEN.get()
    }

    /// What `work` gives by this crate's own loops alone, on one thread, with vectors of each width there is here.
    pub(crate) fn with_each_width<R: Send>(work: impl Fn() -> R + Send + Sync) -> Vec<R> {
        let on_its_own_thread = |arch: pulp::Arch| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
            pool.install(|| {
                CHOSEN.set(Some(arch));
                work()
            })
        };
        [pulp::Arch::Scalar, pulp::Arch::new()].map(on_its_own_thread).into()
    }
}
