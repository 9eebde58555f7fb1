// SPDX-License-Identifier: MIT OR Apache-2.0
//! Checks of options that the maps of disks and spheres have in common.

use crate::error::Error;

/// Refuses a weight of angles out of range, and one for a method that has none.
pub(crate) fn check_angle_weight(weight: f64, is_weighed: bool) -> Result<(), Error> {
    let expected = match is_weighed {
        true if weight >= 0.0 && weight.is_finite() => return Ok(()),
        false if weight == 0.0 => return Ok(()),
        true => "a finite number ≥ 0",
        false => "0 for the papers' methods; only gauss_newton trades areas for angles",
    };
    Err(Error::InvalidOption { name: "angle_weight", found: weight.to_string(), expected: expected.into() })
}

/// Refuses a tolerance of areas out of range, one beside a weight of angles, and one for a method that has none.
pub(crate) fn check_area_tolerance(
    tolerance: Option<f64>,
    weight: f64,
    is_weighed: bool,
) -> Result<(), Error> {
    let Some(tolerance) = tolerance else { return Ok(()) };
    let expected = match is_weighed {
        true if !(tolerance > 0.0 && tolerance.is_finite()) => "a finite number > 0",
        true if weight > 0.0 => "not given together with angle_weight, which it takes the place of",
        true => return Ok(()),
        false => "not given for the papers' methods; only gauss_newton trades areas for angles",
    };
    Err(Error::InvalidOption {
        name: "area_tolerance",
        found: tolerance.to_string(),
        expected: expected.into(),
    })
}
