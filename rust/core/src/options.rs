// SPDX-License-Identifier: MIT OR Apache-2.0
//! Checks of the options that disk maps and sphere maps share.

use crate::error::Error;

/// Refuses a weight of angles that is out of range, or that the method does not take.
pub(crate) fn check_angle_weight(weight: f64, is_weighed: bool) -> Result<(), Error> {
    let is_valid = if is_weighed { weight >= 0.0 && weight.is_finite() } else { weight == 0.0 };
    if is_valid {
        return Ok(());
    }
    let expected = if is_weighed {
        "a finite number ≥ 0"
    } else {
        "0 for the papers' methods; only gauss_newton trades areas for angles"
    };
    Err(Error::InvalidOption { name: "angle_weight", found: weight.to_string(), expected: expected.into() })
}

/// Refuses an area tolerance that is out of range, given beside a weight of angles, or that the method does not take.
pub(crate) fn check_area_tolerance(
    tolerance: Option<f64>,
    weight: f64,
    is_weighed: bool,
) -> Result<(), Error> {
    let Some(tolerance) = tolerance else { return Ok(()) };
    let expected = if !is_weighed {
        "not given for the papers' methods; only gauss_newton trades areas for angles"
    } else if !(tolerance > 0.0 && tolerance.is_finite()) {
        "a finite number > 0"
    } else if weight > 0.0 {
        "not given together with angle_weight, which it takes the place of"
    } else {
        return Ok(());
    };
    Err(Error::InvalidOption {
        name: "area_tolerance",
        found: tolerance.to_string(),
        expected: expected.into(),
    })
}
