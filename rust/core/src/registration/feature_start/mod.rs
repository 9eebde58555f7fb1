// SPDX-License-Identifier: MIT OR Apache-2.0
//! Lays one closed surface over another by signals that should agree: the start of a registration with features.
//!
//! Both surfaces lie on the sphere. The best rotation is searched for among thousands ([`rotation`]). From there an
//! elastic deformation without folds brings the signals together ([`elastic`]), smoothed ones first, and less and less
//! smooth ones then, so that large shapes find each other before small ones.
//!
//! Input: two surfaces of genus 0 with maps to the sphere, and scaled signals. Cost: some twenty sparse factorizations
//! with two unknowns per vertex.

mod elastic;
mod rotation;
mod smoothing;
mod sphere_signals;
#[cfg(test)]
mod tests;

use super::features::Signals;
use crate::alignment::rotation::rotate;
use crate::control::{Status, Watch};
use crate::distortion::folded_on_sphere;
use crate::error::Error;
use crate::parallel;
use crate::vector::Vector3;
use elastic::Elastic;
use rotation::RotationSearch;
use smoothing::Smoothing;
pub(super) use sphere_signals::OnSphere;
use sphere_signals::SphereSignals;

/// The radii to which signals are smoothed, one after the other, on the sphere of radius 1.
const RADII: [f64; 4] = [0.2, 0.1, 0.05, 0.02];

/// The radius to which signals are smoothed for the last steps of the rotation.
const ROTATION_RADIUS: f64 = RADII[1];

/// The source's map turned and bent so that the signals agree, without folds.
///
/// `turned` is the source's map rotated by landmarks, if these say how; otherwise the rotation is searched for, near
/// one that takes the `pairs` of landmarks, the source's first, to each other.
///
/// # Errors
/// If a system cannot be ordered.
pub(super) fn aligned(
    source: OnSphere<'_>,
    target: OnSphere<'_>,
    signals: &Signals,
    turned: Option<Vec<Vector3>>,
    pairs: &[[Vector3; 2]],
    watch: &Watch<'_>,
) -> Result<(Vec<Vector3>, Status), Error> {
    let smoothing = [Smoothing::new(source)?, Smoothing::new(target)?];
    let smoothed = |radius: f64| -> Option<[Vec<f64>; 2]> {
        let ours = smoothing[0].smoothed(&signals.source, signals.width, radius, watch)?;
        let theirs = smoothing[1].smoothed(&signals.target, signals.width, radius, watch)?;
        Some([ours, theirs])
    };
    // 1. The rotation
    let start = match turned {
        Some(turned) => turned,
        None => {
            let cancelled = || Ok((source.map.to_vec(), Status::Cancelled));
            let [Some(rough), Some(fine)] = [RADII[0], ROTATION_RADIUS].map(smoothed) else {
                return cancelled();
            };
            let levels = [&rough, &fine].map(|[ours, theirs]| {
                (
                    SphereSignals::new(source, ours, signals.width),
                    SphereSignals::new(target, theirs, signals.width),
                )
            });
            let Some(rotation) = RotationSearch { levels: &levels, pairs }.best(watch) else {
                return cancelled();
            };
            let turned = parallel::map(source.map.len(), |v| rotate(rotation, source.map[v]).normalized());
            // rounding may fold a sliver
            if folded_on_sphere(source.mesh.faces(), &turned).is_empty() {
                turned
            } else {
                source.map.to_vec()
            }
        }
    };
    // 2. The deformation, from smooth signals to those given
    let mut elastic = Elastic::new(source.mesh, start)?;
    for radius in RADII {
        let Some([ours, theirs]) = smoothed(radius) else { return Ok((elastic.map, Status::Cancelled)) };
        let theirs = SphereSignals::new(target, &theirs, signals.width);
        if !elastic.descend(&ours, &theirs, watch) {
            return Ok((elastic.map, Status::Cancelled));
        }
    }
    Ok((elastic.map, Status::Converged))
}
