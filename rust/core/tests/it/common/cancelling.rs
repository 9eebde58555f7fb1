// SPDX-License-Identifier: MIT OR Apache-2.0
//! Runs that are cancelled at each of their reports.
//!
//! Long steps report in between: on a busy or emulated machine a run has more reports than when done again. No test here
//! counts on their number, nor on which of them it is that is refused.

use authalic::{Error, Observer, Status};

/// Runs a computation once to the end and then once to each of its reports, which cancels it there: it says so, or that
/// there was no map yet, and asks no more. `check` is given a map and how many reports have passed before it was
/// cancelled, and returns its status.
pub fn cancelled_everywhere<T>(
    run: impl Fn(&mut dyn Observer) -> Result<T, Error>,
    check: impl Fn(&T, usize) -> Status,
) {
    let reports = count_reports(|observer| check(&run(observer).expect("a map"), usize::MAX));
    let mut n_maps = 0;
    // the last report tells that the run is done
    for last in 0..reports - 1 {
        let mut observer = CancelAt::after(last);
        match run(&mut observer) {
            Ok(map) => {
                n_maps += 1;
                let is_cancelled = check(&map, last) == Status::Cancelled;
                assert_eq!(is_cancelled, observer.has_cancelled, "after {last}");
            }
            Err(error) => {
                assert!(matches!(error, Error::CancelledEarly) && observer.has_cancelled, "{error}");
            }
        }
        assert!(!observer.asks_again, "after {last}");
    }
    assert!(n_maps > 0);
}

/// The number of reports of a run to its end.
fn count_reports<T>(run: impl FnOnce(&mut dyn Observer) -> T) -> usize {
    let (mut reports, mut reached) = (0, 0.0);
    run(&mut |fraction: f64, message: &str| {
        assert!((0.0..=1.0).contains(&fraction) && !message.is_empty());
        (reports, reached) = (reports + 1, fraction);
        true
    });
    assert_eq!(reached, 1.0, "the last report tells that the run is done");
    reports
}

/// Cancels a run at the report of a number, if it comes to that before it is done.
pub struct CancelAt {
    left: usize,
    pub has_cancelled: bool,
    /// Whether the run has asked once more.
    pub asks_again: bool,
}

impl CancelAt {
    /// Lets as many reports pass, and those that only tell that the run is done.
    pub fn after(reports: usize) -> Self {
        Self { left: reports, has_cancelled: false, asks_again: false }
    }
}

impl Observer for CancelAt {
    fn progress(&mut self, fraction: f64, _message: &str) -> bool {
        self.asks_again = self.has_cancelled;
        if self.left == 0 && fraction < 1.0 {
            self.has_cancelled = true;
            return false;
        }
        self.left = self.left.saturating_sub(1);
        true
    }
}
