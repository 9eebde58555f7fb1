// SPDX-License-Identifier: MIT OR Apache-2.0
//! Loops over faces and vertices whose results do not depend on the number of threads.
//!
//! Every output element is written by one closure call, and every sum is taken over chunks of a fixed length
//! whose partial sums are added in order, so 1 and 64 threads agree bit for bit.

use std::cell::Cell;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use rayon::ThreadPool;
use rayon::prelude::*;

/// Elements per task: long enough to hide the scheduling, short enough to keep two cores busy.
const CHUNK: usize = 4096;

/// The number of threads that is wanted, 0 for as many as there are processors.
static WANTED: AtomicUsize = AtomicUsize::new(0);

/// The threads of one process, with its id and their wanted number.
struct Pool {
    process: u32,
    wanted: usize,
    threads: Arc<ThreadPool>,
}

/// The threads in use. A forked child inherits the pool but none of its threads.
static POOL: Mutex<Option<Pool>> = Mutex::new(None);

/// The largest number of threads. Each takes memory for its stack.
const MOST: usize = 1024;

/// Sets the number of threads for all that is computed from now on. 0 stands for as many as there are
/// processors, or as the environment variable `RAYON_NUM_THREADS` says. Results do not depend on it. What is
/// being computed goes on with the threads that it has. More than 1024 count as 1024.
pub fn set_threads(count: usize) {
    WANTED.store(count.min(MOST), Ordering::Relaxed);
}

thread_local! {
    /// Whether this thread does the work of a task by itself.
    static IS_ALONE: Cell<bool> = const { Cell::new(false) };
}

/// Whether this is a thread of the pool that may share its work with others.
fn is_sharing() -> bool {
    rayon::current_thread_index().is_some() && !IS_ALONE.get()
}

/// The threads of this process; `None` where they cannot be had right now, as never in WebAssembly. The results
/// are the same without them.
fn threads() -> Option<Arc<ThreadPool>> {
    if cfg!(target_family = "wasm") {
        return None;
    }
    // a fork may have copied the lock while it was held, so never wait for it
    let mut pool = POOL.try_lock().ok()?;
    let (process, wanted) = (std::process::id(), WANTED.load(Ordering::Relaxed));
    if pool.as_ref().is_some_and(|pool| pool.process != process) {
        // the parent's threads do not exist here, so do not stop them
        std::mem::forget(pool.take());
    }
    if pool.as_ref().is_none_or(|pool| pool.wanted != wanted) {
        let pool_of = rayon::ThreadPoolBuilder::new().num_threads(wanted);
        let threads = Arc::new(pool_of.thread_name(|number| format!("authalic {number}")).build().ok()?);
        *pool = Some(Pool { process, wanted, threads });
    }
    pool.as_ref().map(|pool| pool.threads.clone())
}

/// Runs `work` on the threads of this process, so that what it computes finds them; where there are none, on this one.
pub(crate) fn install<R: Send>(work: impl FnOnce() -> R + Send) -> R {
    let (mut work, mut result) = (Some(work), None);
    on_the_threads(&mut || result = work.take().map(|work| work()));
    result.expect("the work is done")
}

/// [`install`] of work behind a pointer, so that rayon is compiled once.
fn on_the_threads(work: &mut (dyn FnMut() + Send)) {
    if IS_ALONE.get() || is_sharing() {
        return work();
    }
    match threads() {
        Some(pool) => pool.install(work),
        None => work(),
    }
}

/// Runs both closures on the threads of this process, at the same time where one is free.
pub(crate) fn join<A: Send, B: Send>(
    one: impl FnOnce() -> A + Send,
    other: impl FnOnce() -> B + Send,
) -> (A, B) {
    install(|| if is_sharing() { rayon::join(one, other) } else { (one(), other()) })
}

/// Calls `work(first index, chunk)` for every chunk of `length` elements, on all threads where there are
/// several.
///
/// `work` is behind a pointer so that rayon is compiled once per type, not once per loop.
fn for_each_chunk<T: Send>(out: &mut [T], length: usize, work: &(dyn Fn(usize, &mut [T]) + Sync)) {
    let on_these_threads = |out: &mut [T]| {
        out.par_chunks_mut(length).enumerate().for_each(|(chunk, part)| work(chunk * length, part));
    };
    let is_one_task = out.len() <= length;
    if !is_one_task && is_sharing() {
        return on_these_threads(out);
    }
    match if is_one_task || IS_ALONE.get() { None } else { threads() } {
        Some(pool) => pool.install(|| on_these_threads(out)),
        None => out.chunks_mut(length).enumerate().for_each(|(chunk, part)| work(chunk * length, part)),
    }
}

/// Writes `value(i)` into every `out[i]`.
pub(crate) fn fill<T: Send>(out: &mut [T], value: impl Fn(usize) -> T + Sync + Send) {
    for_each_chunk(out, CHUNK, &|first, part| {
        part.iter_mut().enumerate().for_each(|(k, element)| *element = value(first + k));
    });
}

/// Replaces every `out[i]` by `value(i, out[i])`.
pub(crate) fn fill_with_old<T: Copy + Send>(out: &mut [T], value: impl Fn(usize, T) -> T + Sync + Send) {
    for_each_chunk(out, CHUNK, &|first, part| {
        part.iter_mut().enumerate().for_each(|(k, element)| *element = value(first + k, *element));
    });
}

/// The values `value(0), …, value(n − 1)`.
pub(crate) fn map<T: Send + Clone + Default>(n: usize, value: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
    let mut out = vec![T::default(); n];
    fill(&mut out, value);
    out
}

/// The values `value(0), …, value(n − 1)`, each a task of its own: for few values that take long.
pub(crate) fn tasks<T: Send>(n: usize, value: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
    let mut out: Vec<Option<T>> = (0..n).map(|_| None).collect();
    for_each_chunk(&mut out, 1, &|i, slot| slot[0] = Some(value(i)));
    out.into_iter().flatten().collect()
}

/// [`tasks`] that share no work of their own: for very many small ones, which would only wait for each other.
pub(crate) fn lone_tasks<T: Send>(n: usize, value: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
    tasks(n, |i| {
        let alone = Alone { was: IS_ALONE.replace(true) };
        let value = value(i);
        drop(alone);
        value
    })
}

/// While it lives, its thread works alone.
struct Alone {
    was: bool,
}

impl Drop for Alone {
    fn drop(&mut self) {
        IS_ALONE.set(self.was);
    }
}

/// Σ value(i) over `0..n`.
pub(crate) fn sum(n: usize, value: impl Fn(usize) -> f64 + Sync + Send) -> f64 {
    let mut partial = vec![0.0; n.div_ceil(CHUNK)];
    for_each_chunk(&mut partial, 1, &|chunk, part| {
        part[0] = (chunk * CHUNK..n.min((chunk + 1) * CHUNK)).map(&value).sum();
    });
    partial.iter().sum()
}

/// Several sums over `0..n` in one pass.
pub(crate) fn sums<const K: usize>(n: usize, values: impl Fn(usize) -> [f64; K] + Sync + Send) -> [f64; K] {
    let mut partial = vec![[0.0; K]; n.div_ceil(CHUNK)];
    let add = |sum: [f64; K], terms: [f64; K]| std::array::from_fn(|k| sum[k] + terms[k]);
    for_each_chunk(&mut partial, 1, &|chunk, part| {
        part[0] = (chunk * CHUNK..n.min((chunk + 1) * CHUNK)).map(&values).fold([0.0; K], add);
    });
    partial.into_iter().fold([0.0; K], add)
}

/// Σ a_i b_i.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    debug_assert_eq!(a.len(), b.len());
    sum(a.len(), |i| a[i] * b[i])
}

/// True if `holds(i)` for all `i` in `0..n`.
pub(crate) fn all(n: usize, holds: impl Fn(usize) -> bool + Sync + Send) -> bool {
    sum(n, |i| if holds(i) { 0.0 } else { 1.0 }) == 0.0
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
    fn both_sides_of_a_join_run_on_the_threads_of_this_process() {
        let is_one_of_them = || {
            let thread = std::thread::current();
            thread.name().is_some_and(|name| name.starts_with("authalic "))
        };
        // the threads cannot be had while another test asks for them
        let mut tries = (0..1000).map(|_| {
            std::thread::sleep(std::time::Duration::from_millis(1));
            join(is_one_of_them, is_one_of_them)
        });
        assert!(tries.any(|both| both == (true, true)));
        assert_eq!(lone_tasks(1, |_| join(|| 1, || 2)), [(1, 2)]);
    }

    #[test]
    fn lone_tasks_sum_the_same_bits_on_one_thread_each() {
        let term = |i: usize| 1.0 / (1.0 + i as f64);
        let sums = lone_tasks(20, |_| {
            let here = std::thread::current().id();
            let is_here = all(3 * CHUNK, |_| std::thread::current().id() == here);
            (is_here, sum(100_003, term).to_bits())
        });
        assert_eq!(sums, vec![(true, sum(100_003, term).to_bits()); 20]);
        assert!(!IS_ALONE.get());
    }

    #[test]
    fn empty_loops_give_empty_results() {
        assert_eq!(sum(0, |_| 1.0), 0.0);
        assert!(map::<f64>(0, |_| 1.0).is_empty());
        assert!(all(0, |_| false));
    }
}
