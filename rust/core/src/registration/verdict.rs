// SPDX-License-Identifier: MIT OR Apache-2.0
//! How a registration by points ended: places on the target, pairs that did not meet, and the status.

use super::landmarks::Landmarks;
use crate::control::{Observer, Silent, Status, Watch};
use crate::distortion::Distortion;
use crate::error::Error;
use crate::location::{Location, Locator};
use crate::mesh::TriangleMesh;
use crate::vector::Vector3;

/// A landmark that ends farther than this from its place, in a domain of radius 1, was missed.
pub const MISSED: f64 = 1e-3;

/// So was one that ends farther than this part of the target's size from its partner.
const MISSED_ON_TARGET: f64 = 5e-3;

/// The locations of points; a cancelled run still gets them, that takes seconds at a million.
pub(super) fn located(
    locator: &Locator,
    points: &[Vector3],
    status: Status,
    observer: &mut dyn Observer,
) -> Result<(Vec<Location>, Status), Error> {
    if status != Status::Cancelled {
        let watch = Watch::new(observer, 0.0, "Looking up places");
        if let Some(locations) = locator.locate_all(points, &watch) {
            return Ok((locations, status));
        }
    }
    let mut silent = Silent;
    let locations = locator.locate_all(points, &Watch::new(&mut silent, 0.0, ""));
    Ok((locations.ok_or(Error::CancelledEarly)?, Status::Cancelled))
}

/// The pairs that did not meet, in the parameter domain or on the target.
pub(super) fn missed(
    landmarks: &Landmarks<'_>,
    landmark_error: &[f64],
    target: &TriangleMesh,
    locations: &[Location],
) -> Vec<usize> {
    let is_missed = |&pair: &usize| {
        let location = locations[landmarks.source[pair]];
        let place = location.point_on(target.points(), target.faces());
        let on_target = place.distance(target.points()[landmarks.target[pair]]);
        landmark_error[pair] > MISSED || on_target > MISSED_ON_TARGET
    };
    (0..landmark_error.len()).filter(is_missed).collect()
}

/// An area ratio with a smaller deviation is even enough to end with, whatever the descent says.
const EVEN_ENOUGH: f64 = 0.01;

/// The status of a registration: what the descent says unless all landmarks met and areas are even, and no
/// better than those of the two maps.
pub(super) fn verdict(
    carried: Status,
    maps: [Status; 2],
    missed: &[usize],
    figures: [&Distortion; 2],
) -> Status {
    let is_even = figures.iter().all(|figures| figures.area_ratio_std <= EVEN_ENOUGH);
    match carried {
        Status::Cancelled => Status::Cancelled,
        _ if !missed.is_empty() => Status::LandmarksMissed,
        _ if is_even => worst([Status::Converged, maps[0], maps[1]]),
        carried => worst([carried, maps[0], maps[1]]),
    }
}

/// The least good of several statuses.
pub(super) fn worst<const N: usize>(statuses: [Status; N]) -> Status {
    let rank = |status: &Status| match status {
        Status::Cancelled => 3,
        Status::Stalled => 2,
        Status::MaxIterations => 1,
        _ => 0,
    };
    statuses.into_iter().max_by_key(rank).unwrap_or(Status::Converged)
}
