// SPDX-License-Identifier: MIT OR Apache-2.0
//! Runs that are cancelled at each of their reports.

use authalic::Observer;

/// The number of reports of a run to its end.
///
/// Long steps report in between, so on a busy or emulated machine a run has more reports than when done again.
pub fn count_reports<T>(run: impl FnOnce(&mut dyn Observer) -> T) -> usize {
    let (mut reports, mut reached) = (0, 0.0);
    run(&mut |fraction: f64, message: &str| {
        assert!((0.0..=1.0).contains(&fraction) && !message.is_empty());
        (reports, reached) = (reports + 1, fraction);
        true
    });
    assert_eq!(reached, 1.0, "the last report tells that the run is done");
    reports
}

/// Cancels a run at the report of a number, if it comes to that.
pub struct CancelAt {
    left: usize,
    pub has_cancelled: bool,
    /// Whether the run has asked once more.
    pub asks_again: bool,
}

impl CancelAt {
    /// Lets as many reports pass.
    pub fn after(reports: usize) -> Self {
        Self { left: reports, has_cancelled: false, asks_again: false }
    }
}

impl Observer for CancelAt {
    fn progress(&mut self, _fraction: f64, _message: &str) -> bool {
        if self.left == 0 {
            self.asks_again = self.has_cancelled;
            self.has_cancelled = true;
            return false;
        }
        self.left -= 1;
        true
    }
}
