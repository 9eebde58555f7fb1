// SPDX-License-Identifier: MIT OR Apache-2.0
//! The end of a registration by points: locations on the target, pairs that did not meet, and the status.

use super::landmarks::Landmarks;
use super::options::{Energy, RegistrationOptions};
use crate::control::{Observer, Silent, Status, Watch};
use crate::distortion::Distortion;
use crate::error::Error;
use crate::location::{Location, Locator};
use crate::mesh::TriangleMesh;
use crate::vector::Vector3;

/// Largest final distance of a landmark from its place, in a domain of radius 1; beyond it the pair is missed.
pub const MISSED: f64 = 1e-3;

/// Largest final distance of a landmark from its partner on the target, relative to the target's largest extent.
const MISSED_ON_TARGET: f64 = 5e-3;

/// The locations of points. A cancelled run gets them too: a million take seconds.
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

/// The exact pairs that did not meet, in the parameter domain or on the target.
pub(super) fn missed(
    landmarks: &Landmarks<'_>,
    options: &RegistrationOptions<'_>,
    landmark_error: &[f64],
    target: &TriangleMesh,
    locations: &[Location],
) -> Vec<usize> {
    let extent = |axis: usize| {
        let along = || target.points().iter().map(|point| point[axis]);
        along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min)
    };
    let far = MISSED_ON_TARGET * (0..3).map(extent).fold(0.0, f64::max);
    let is_missed = |&pair: &usize| {
        let location = locations[landmarks.source[pair]];
        let place = location.point_on(target.points(), target.faces());
        let on_target = place.distance(target.points()[landmarks.target[pair]]);
        let is_exact = options.pair_weight(pair).is_infinite();
        is_exact && (landmark_error[pair] > MISSED || on_target > far)
    };
    (0..landmark_error.len()).filter(is_missed).collect()
}

/// Standard deviation of the area ratios below which the areas are even, whatever the descent reports.
const EVEN_ENOUGH: f64 = 0.01;

/// The status of a registration. Areas alone: converged if all landmarks met and the areas are even, else that of the
/// descent; no better than the statuses of the two maps. Between the surfaces: that of the descent.
pub(super) fn verdict(
    energy: Energy,
    descent: Status,
    maps: [Status; 2],
    missed: &[usize],
    figures: [&Distortion; 2],
) -> Status {
    let is_even = figures.iter().all(|figures| figures.area_ratio_std <= EVEN_ENOUGH);
    match descent {
        Status::Cancelled => Status::Cancelled,
        _ if !missed.is_empty() => Status::LandmarksMissed,
        descent if energy == Energy::Surface => descent,
        _ if is_even => worst([Status::Converged, maps[0], maps[1]]),
        descent => worst([descent, maps[0], maps[1]]),
    }
}

/// The worst of several statuses.
pub(super) fn worst<const N: usize>(statuses: [Status; N]) -> Status {
    let rank = |status: &Status| match status {
        Status::Cancelled => 3,
        Status::Stalled => 2,
        Status::MaxIterations => 1,
        _ => 0,
    };
    statuses.into_iter().max_by_key(rank).unwrap_or(Status::Converged)
}
