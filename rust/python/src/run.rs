// SPDX-License-Identifier: MIT OR Apache-2.0
//! Long calls: on a thread of their own, without the GIL, with progress, Ctrl-C and panics contained.
//!
//! The calling thread only waits. Every 50 ms it looks for signals, so Ctrl-C raises at once even inside a
//! factorization. The worker sees the flag at its next report and ends.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use authalic::{Error, Observer};
use numpy::ndarray::Array2;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;

use crate::arrays::own_array;
use crate::errors::{internal, to_python};

const SIGNAL_INTERVAL: Duration = Duration::from_millis(50);

/// A message from the worker to the waiting thread.
enum Message<T> {
    Progress(f64, String),
    Preview(Array2<f64>),
    Done(Result<T, Error>),
    Panicked(String),
}

/// The observer on the worker thread.
struct Remote<T> {
    cancelled: Arc<AtomicBool>,
    /// Present if the caller gave a progress function. Each report waits for the answer, so that the step at which
    /// a run is cancelled does not depend on timing.
    line: Option<(Sender<Message<T>>, Receiver<bool>)>,
    /// Present if the caller gave a preview function, which is not waited for.
    previews: Option<Sender<Message<T>>>,
    /// The largest fraction so far, so that progress never falls when a step is tried again.
    reached: f64,
}

impl<T: Send> Observer for Remote<T> {
    fn progress(&mut self, fraction: f64, message: &str) -> bool {
        if self.cancelled.load(Ordering::Relaxed) {
            return false;
        }
        let Some((sender, answers)) = &self.line else {
            return true;
        };
        self.reached = self.reached.max(fraction);
        let sent = sender.send(Message::Progress(self.reached, message.to_owned()));
        let goes_on = sent.is_ok() && answers.recv().unwrap_or(false);
        // a refusal is final: the caller is not asked again
        self.cancelled.fetch_or(!goes_on, Ordering::Relaxed);
        goes_on
    }

    fn preview(&mut self, positions: &dyn Fn() -> Array2<f64>) {
        if let Some(sender) = &self.previews {
            // sending fails if the caller has gone on Ctrl-C
            let _ = sender.send(Message::Preview(positions()));
        }
    }
}

/// Sets the number of threads of all computations that start from now on.
///
/// Results do not depend on it, bit for bit.
///
/// Parameters
/// ----------
/// count : int
///     The number of threads, at most 1024. 0 stands for as many as there are processors, or as the environment
///     variable RAYON_NUM_THREADS says.
///
/// Examples
/// --------
/// >>> import authalic
/// >>> authalic.set_threads(2)
/// >>> authalic.set_threads(0)
#[pyfunction]
pub fn set_threads(count: usize) {
    authalic::set_threads(count);
}

/// Runs `work` to its end, or until the progress function or Ctrl-C stops it.
pub fn run<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&mut dyn Observer) -> Result<T, Error> + Send + 'static,
) -> PyResult<T> {
    run_with_preview(py, progress, None, work)
}

/// [`run`] that shows maps on the way to a preview function.
pub fn run_with_preview<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    preview: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&mut dyn Observer) -> Result<T, Error> + Send + 'static,
) -> PyResult<T> {
    for (name, function) in [("progress", progress), ("preview", preview)] {
        if let Some(function) = function.filter(|function| !function.is_callable()) {
            return Err(PyTypeError::new_err(format!(
                "{name} must be callable, but is {}",
                function.repr()?
            )));
        }
    }
    let (sender, messages) = channel();
    let (answer, answers) = channel();
    let cancelled = Arc::new(AtomicBool::new(false));
    let line = progress.map(|_| (sender.clone(), answers));
    let previews = preview.map(|_| sender.clone());
    let mut remote = Remote { cancelled: cancelled.clone(), line, previews, reached: 0.0 };
    std::thread::spawn(move || {
        let outcome = catch_unwind(AssertUnwindSafe(|| work(&mut remote)));
        // sending fails if the caller has gone on Ctrl-C
        let _ =
            sender.send(outcome.map_or_else(|panic| Message::Panicked(panic_text(&*panic)), Message::Done));
    });
    // a receiver is not Sync; the lock allows waiting without the GIL
    let outcome = wait(py, [progress, preview], &Mutex::new(messages), &answer);
    cancelled.store(true, Ordering::Relaxed);
    outcome
}

/// Serves progress and signals until the worker is done.
fn wait<T: Send>(
    py: Python<'_>,
    [progress, preview]: [Option<&Bound<'_, PyAny>>; 2],
    messages: &Mutex<Receiver<Message<T>>>,
    answer: &Sender<bool>,
) -> PyResult<T> {
    loop {
        match py.detach(|| messages.lock().expect("only this thread locks").recv_timeout(SIGNAL_INTERVAL)) {
            Ok(Message::Done(result)) => return result.map_err(|error| to_python(py, &error)),
            Ok(Message::Panicked(text)) => return Err(internal(py, &text)),
            Ok(Message::Progress(fraction, text)) => {
                // sending fails if the worker has ended meanwhile
                let _ = answer.send(go_on(progress, fraction, &text)?);
            }
            Ok(Message::Preview(positions)) => {
                if let Some(preview) = preview {
                    preview.call1((own_array(py, positions),))?;
                }
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => {
                return Err(internal(py, "the worker thread ended without a result"));
            }
        }
        py.check_signals()?;
    }
}

/// Whether to go on: the truth of what the caller's progress function returns; `None` goes on.
fn go_on(progress: Option<&Bound<'_, PyAny>>, fraction: f64, text: &str) -> PyResult<bool> {
    let Some(progress) = progress else {
        return Ok(true);
    };
    let answer = progress.call1((fraction, text))?;
    if answer.is_none() { Ok(true) } else { answer.is_truthy() }
}

fn panic_text(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "unknown".into())
}
