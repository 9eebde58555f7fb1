// SPDX-License-Identifier: MIT OR Apache-2.0
//! Loops over faces and vertices whose results do not depend on the number of threads.
//!
//! Every output element is written by one closure call, and every sum is taken over chunks of a fixed length
//! whose partial sums are added in order, so 1 and 64 threads agree bit for bit.

use rayon::prelude::*;

/// Elements per task: long enough to hide the scheduling, short enough to keep two cores busy.
const CHUNK: usize = 4096;

/// Writes `value(i)` into every `out[i]`.
pub(crate) fn fill<T: Send>(out: &mut [T], value: impl Fn(usize) -> T + Sync) {
    out.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, part)| {
        for (k, element) in part.iter_mut().enumerate() {
            *element = value(chunk * CHUNK + k);
        }
    });
}

/// Replaces every `out[i]` by `value(i, out[i])`.
pub(crate) fn fill_with_old(out: &mut [f64], value: impl Fn(usize, f64) -> f64 + Sync) {
    out.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, part)| {
        for (k, element) in part.iter_mut().enumerate() {
            *element = value(chunk * CHUNK + k, *element);
        }
    });
}

/// The values `value(0), …, value(n − 1)`.
pub(crate) fn map<T: Send + Clone + Default>(n: usize, value: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let mut out = vec![T::default(); n];
    fill(&mut out, value);
    out
}

/// Σ value(i) over `0..n`.
pub(crate) fn sum(n: usize, value: impl Fn(usize) -> f64 + Sync) -> f64 {
    let partial =
        map(n.div_ceil(CHUNK), |chunk| (chunk * CHUNK..n.min((chunk + 1) * CHUNK)).map(&value).sum::<f64>());
    partial.iter().sum()
}

/// Σ a_i b_i.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    debug_assert_eq!(a.len(), b.len());
    sum(a.len(), |i| a[i] * b[i])
}

/// Whether `holds(i)` for all `i` in `0..n`.
pub(crate) fn all(n: usize, holds: impl Fn(usize) -> bool + Sync + Send) -> bool {
    (0..n).into_par_iter().with_min_len(CHUNK).all(holds)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_are_the_same_bits_for_any_thread_count() {
        let term = |i: usize| 1.0 / (1.0 + i as f64);
        let on = |threads| {
            rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap()
                .install(|| sum(100_003, term))
        };
        assert_eq!(on(1).to_bits(), on(2).to_bits());
        assert_eq!(on(1).to_bits(), on(7).to_bits());
        assert!((on(1) - (100_003_f64.ln() + 0.577_215_664_9)).abs() < 1e-4);
    }

    #[test]
    fn empty_loops_give_empty_results() {
        assert_eq!(sum(0, |_| 1.0), 0.0);
        assert!(map::<f64>(0, |_| 1.0).is_empty());
        assert!(all(0, |_| false));
    }
}
