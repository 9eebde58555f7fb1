// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the observer of a search for seams hears.

use crate::control::Observer;
use crate::error::Error;

/// What the observer hears.
pub(super) const MESSAGE: &str = "Seeking seams";

/// Tells the observer how far the run is.
///
/// # Errors
/// [`Error::CancelledEarly`].
pub(super) fn report(observer: &mut dyn Observer, fraction: f64) -> Result<(), Error> {
    if observer.progress(fraction, MESSAGE) { Ok(()) } else { Err(Error::CancelledEarly) }
}
