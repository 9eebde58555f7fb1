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

/// The status of a registration. Stalled if faces are folded, as where the target lies in the disk as a strip so thin that
/// the boundary cannot be carried onto its own. Areas alone: converged if all landmarks met and the areas are even, else
/// that of the descent; no better than the statuses of the two maps. Between the surfaces: that of the descent.
pub(super) fn verdict(
    energy: Energy,
    descent: Status,
    maps: [Status; 2],
    missed: &[usize],
    figures: [&Distortion; 2],
) -> Status {
    let is_even = figures.iter().all(|figures| figures.area_ratio_std <= EVEN_ENOUGH);
    let is_folded = figures.iter().any(|figures| !figures.folded.is_empty());
    match descent {
        Status::Cancelled => Status::Cancelled,
        _ if !missed.is_empty() => Status::LandmarksMissed,
        descent if is_folded => worst([descent, Status::Stalled]),
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distortion::{Image, measure};
    use crate::mesh::TriangleMesh;

    #[test]
    fn a_registration_with_folded_faces_has_not_converged() {
        let vertices = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let mesh = TriangleMesh::new(&vertices, &[[0, 1, 2], [0, 2, 3]]).unwrap();
        let sound = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let folded = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.9, 0.1]];
        let [sound, folded] = [&sound, &folded]
            .map(|map| measure(mesh.points(), mesh.faces(), Image::Plane(map), mesh.face_areas()).unwrap());
        for energy in [Energy::Surface, Energy::Area] {
            let of = |descent, missed: &[usize], source| {
                verdict(energy, descent, [Status::Converged; 2], missed, [source, &sound])
            };
            assert_eq!(of(Status::Converged, &[], &sound), Status::Converged);
            assert_eq!(of(Status::Converged, &[], &folded), Status::Stalled);
            assert_eq!(of(Status::MaxIterations, &[], &folded), Status::Stalled);
            assert_eq!(of(Status::Converged, &[0], &folded), Status::LandmarksMissed);
            assert_eq!(of(Status::Cancelled, &[], &folded), Status::Cancelled);
        }
    }
}
