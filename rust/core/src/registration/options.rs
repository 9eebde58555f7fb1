// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options of registrations by points, and their check.

use crate::error::Error;
use crate::options::check_angle_weight;

/// Options of [`register_disks`](super::register_disks) and [`register_spheres`](super::register_spheres).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RegistrationOptions {
    /// λ > 0, the initial weight of the landmark penalty; it grows tenfold until the landmarks meet.
    pub weight: f64,
    /// λ ≥ 0, the weight of the angle distortion against that of the areas in all maps; 0 preserves areas alone.
    pub angle_weight: f64,
}

impl Default for RegistrationOptions {
    fn default() -> Self {
        Self { weight: 1.0, angle_weight: 0.0 }
    }
}

impl RegistrationOptions {
    pub(super) fn check(&self) -> Result<(), Error> {
        check_angle_weight(self.angle_weight, true)?;
        if self.weight > 0.0 && self.weight.is_finite() {
            Ok(())
        } else {
            Err(Error::InvalidOption {
                name: "weight",
                found: self.weight.to_string(),
                expected: "a finite number > 0".into(),
            })
        }
    }
}
