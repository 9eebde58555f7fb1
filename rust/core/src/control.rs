// SPDX-License-Identifier: MIT OR Apache-2.0
//! The dialog of a long run with its caller: progress, cancel, status and history.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Duration;

use ndarray::Array2;

use crate::clock::Instant;

/// Listens to a run and may end it.
///
/// Any `FnMut(f64, &str) -> bool` is an observer.
///
/// ```
/// use authalic::Observer;
/// let mut seen = 0.0;
/// let mut observer = |fraction: f64, _message: &str| {
///     seen = fraction;
///     true
/// };
/// assert!(observer.progress(0.5, "half"));
/// ```
pub trait Observer: Send {
    /// Called between the steps of a run with the fraction done in `[0, 1]` and a short message. A long step also calls
    /// it from within, on any thread, with the last fraction. `false` cancels, and the run returns its best map so far.
    fn progress(&mut self, fraction: f64, message: &str) -> bool;

    /// Called after each step of a registration between surfaces: `positions()` computes the images so far of the
    /// source's vertices, (n, 3), on the target as given. Does nothing by default.
    fn preview(&mut self, positions: &dyn Fn() -> Array2<f64>) {
        let _ = positions;
    }
}

impl<F: FnMut(f64, &str) -> bool + Send> Observer for F {
    fn progress(&mut self, fraction: f64, message: &str) -> bool {
        self(fraction, message)
    }
}

/// A phase of a run: passes its progress on as the part `from..to` of the whole.
pub(crate) struct Phase<'a> {
    /// The observer of the whole run.
    pub whole: &'a mut dyn Observer,
    /// The fraction at which the phase begins.
    pub from: f64,
    /// The fraction at which it ends.
    pub to: f64,
}

impl<'a> Phase<'a> {
    /// The phase of a number in a sequence of unknown length: each has half of what those before it have left.
    pub(crate) fn of_sequence(whole: &'a mut dyn Observer, number: usize) -> Self {
        let [from, to] = [number, number + 1].map(|number| 1.0 - 0.5_f64.powi(number as i32));
        Self { whole, from, to }
    }
}

impl Observer for Phase<'_> {
    fn progress(&mut self, fraction: f64, message: &str) -> bool {
        self.whole.progress(self.from + fraction * (self.to - self.from), message)
    }

    fn preview(&mut self, positions: &dyn Fn() -> Array2<f64>) {
        self.whole.preview(positions);
    }
}

/// Passes on a fraction that never falls, for a run that does some of its steps again; and stays cancelled.
pub(crate) struct Rising<'a> {
    /// The observer of the whole run.
    whole: &'a mut dyn Observer,
    highest: f64,
    is_cancelled: bool,
}

impl<'a> Rising<'a> {
    pub(crate) fn new(whole: &'a mut dyn Observer) -> Self {
        Self { whole, highest: 0.0, is_cancelled: false }
    }
}

impl Observer for Rising<'_> {
    fn progress(&mut self, fraction: f64, message: &str) -> bool {
        self.highest = self.highest.max(fraction);
        self.is_cancelled = self.is_cancelled || !self.whole.progress(self.highest, message);
        !self.is_cancelled
    }

    fn preview(&mut self, positions: &dyn Fn() -> Array2<f64>) {
        self.whole.preview(positions);
    }
}

/// Time between two questions of a long step to the observer.
const HEARTBEAT: Duration = Duration::from_millis(80);

/// Asks the observer for all threads of one long step whether to go on, once per [`HEARTBEAT`].
pub(crate) struct Watch<'a> {
    line: Mutex<(&'a mut dyn Observer, Instant)>,
    /// The bits of the fraction done, an `f64`.
    fraction: AtomicU64,
    message: &'a str,
    cancelled: AtomicBool,
}

impl<'a> Watch<'a> {
    /// Watches over a step at `fraction` of what `observer` listens to.
    pub(crate) fn new(observer: &'a mut dyn Observer, fraction: f64, message: &'a str) -> Self {
        let line = Mutex::new((observer, Instant::now()));
        let fraction = AtomicU64::new(fraction.to_bits());
        Self { line, fraction, message, cancelled: AtomicBool::new(false) }
    }

    /// Tells that the step is at `fraction` by now.
    pub(crate) fn reach(&self, fraction: f64) {
        self.fraction.store(fraction.to_bits(), Ordering::Relaxed);
    }

    /// False once the run is cancelled; cheap enough for inner loops.
    pub(crate) fn goes_on(&self) -> bool {
        if self.cancelled.load(Ordering::Relaxed) {
            return false;
        }
        // another thread is asking
        let Ok(mut line) = self.line.try_lock() else { return true };
        if line.1.elapsed() < HEARTBEAT {
            return true;
        }
        let goes_on = line.0.progress(f64::from_bits(self.fraction.load(Ordering::Relaxed)), self.message);
        line.1 = Instant::now();
        self.cancelled.store(!goes_on, Ordering::Relaxed);
        goes_on
    }
}

/// An [`Observer`] that never cancels and ignores what it hears.
#[derive(Debug, Clone, Copy, Default)]
pub struct Silent;

impl Observer for Silent {
    fn progress(&mut self, _fraction: f64, _message: &str) -> bool {
        true
    }
}

/// Why a run ended. The map it returns is sound whatever the status says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// The tolerance was reached, or nothing is left to gain.
    Converged,
    /// The run did the iterations asked for.
    MaxIterations,
    /// The energy hardly falls any more, or no step lowers it.
    Stalled,
    /// The observer asked to stop.
    Cancelled,
    /// Landmarks of a registration do not meet: that would fold faces.
    LandmarksMissed,
}

impl Status {
    /// The status as the word the Python package uses.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Converged => "converged",
            Self::MaxIterations => "max_iterations",
            Self::Stalled => "stalled",
            Self::Cancelled => "cancelled",
            Self::LandmarksMissed => "landmarks_missed",
        }
    }

    /// The status of a word.
    pub fn of_word(word: &str) -> Option<Self> {
        [Self::Converged, Self::MaxIterations, Self::Stalled, Self::Cancelled, Self::LandmarksMissed]
            .into_iter()
            .find(|status| status.as_str() == word)
    }
}

/// One line of the [`History`] of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Record {
    /// The number of the iteration; 0 for the start map.
    pub iteration: usize,
    /// E_A of the map, target areas rescaled to the image's area.
    pub authalic_energy: f64,
    /// Length of the step along the search direction; 0 for the start.
    pub step: f64,
    /// Norm of the gradient in the metric of the preconditioner, √(gᵀM⁻¹g).
    pub gradient_norm: f64,
    /// Seconds since the run began.
    pub seconds: f64,
}

/// The records of a run, one per iteration, the start first.
#[derive(Debug, Clone)]
pub struct History {
    began: Instant,
    records: Vec<Record>,
}

impl History {
    /// An empty history whose clock starts now.
    pub fn start() -> Self {
        Self { began: Instant::now(), records: Vec::new() }
    }

    /// The history of an earlier run.
    pub fn of_records(records: Vec<Record>) -> Self {
        Self { began: Instant::now(), records }
    }

    /// Adds the start map, where no earlier phase of the same run has added its last map already.
    pub fn push_start(&mut self, authalic_energy: f64, gradient_norm: f64) {
        if self.records.is_empty() {
            self.push(authalic_energy, 0.0, gradient_norm);
        }
    }

    /// Adds the next iteration, numbered in order.
    pub fn push(&mut self, authalic_energy: f64, step: f64, gradient_norm: f64) {
        self.records.push(Record {
            iteration: self.records.len(),
            authalic_energy,
            step,
            gradient_norm,
            seconds: self.seconds(),
        });
    }

    /// Multiplies all energies, for an image that is scaled at the end.
    pub(crate) fn rescale(&mut self, factor: f64) {
        self.records.iter_mut().for_each(|record| record.authalic_energy *= factor);
    }

    /// The records, one per iteration.
    pub fn records(&self) -> &[Record] {
        &self.records
    }

    /// Iterations done: the records less the start.
    pub fn iterations(&self) -> usize {
        self.records.len().saturating_sub(1)
    }

    /// Seconds since the history was started.
    pub fn seconds(&self) -> f64 {
        self.began.elapsed().as_secs_f64()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fraction_that_would_fall_stays_and_previews_pass() {
        struct Heard(Vec<f64>, usize);
        impl Observer for Heard {
            fn progress(&mut self, fraction: f64, _: &str) -> bool {
                self.0.push(fraction);
                fraction < 0.8
            }
            fn preview(&mut self, positions: &dyn Fn() -> Array2<f64>) {
                self.1 += positions().nrows();
            }
        }
        let mut heard = Heard(Vec::new(), 0);
        let mut rising = Rising::new(&mut heard);
        let answers = [0.2, 0.6, 0.1, 0.8, 0.3].map(|fraction| rising.progress(fraction, ""));
        rising.preview(&|| Array2::zeros((7, 3)));
        assert_eq!(answers, [true, true, true, false, false]);
        assert_eq!((heard.0, heard.1), (vec![0.2, 0.6, 0.6, 0.8], 7));
    }

    #[test]
    fn a_watch_asks_now_and_then_and_stays_cancelled() {
        let mut asked = 0;
        let mut observer = |_: f64, _: &str| {
            asked += 1;
            false
        };
        let watch = Watch::new(&mut observer, 0.5, "factoring");
        assert!(watch.goes_on(), "too early to ask");
        std::thread::sleep(HEARTBEAT);
        assert!(!watch.goes_on());
        assert!(!watch.goes_on());
        assert_eq!(asked, 1);
    }
}
