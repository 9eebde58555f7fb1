// SPDX-License-Identifier: MIT OR Apache-2.0
//! Registration of surfaces by landmarks: a one-to-one map g of a source onto a target that takes landmark
//! vertices to landmark vertices and keeps areas.
//!
//! [`register_disks`] (Liu & Yueh 2023, section 6) and [`register_spheres`] (Sutti & Yueh 2024, section 6.6)
//! map both surfaces into one domain, carry the landmarks onto each other there without folding a face, and
//! look up where each vertex of the source has come to lie on the target. [`homotopy`] morphs along g.
//!
//! Input: two [`TriangleMesh`]es that are both disks or both spheres, and pairs of [`Landmarks`]. Cost: the
//! two maps, and about as much again for carrying the landmarks.

mod disk;
mod figures;
mod flow;
mod inverse;
mod landmark_descent;
mod landmarks;
mod morph;
mod sphere;
mod transfer;

use crate::control::{Observer, Silent, Status, Watch};
use crate::disk::DiskMap;
use crate::distortion::Distortion;
use crate::error::Error;
use crate::mesh::TriangleMesh;
use crate::mesh::geometry::triangle;
use crate::parallel;
use crate::sphere::SphereMap;
use crate::vector::{Vector, distance};

use crate::location::Locator;

pub use crate::alignment::similarity::{Similarity, similarity};
pub use crate::location::Location;
pub use disk::register_disks;
pub use figures::{area_ratios, compare};
pub use inverse::DomainPoint;
pub use landmarks::Landmarks;
pub use morph::homotopy;
pub(crate) use sphere::inside_out;
pub use sphere::register_spheres;
pub use transfer::{corner_sides, nearest_corners, nearest_vertices, pull_corners, pull_rows, pull_vertices};

/// A landmark that ends farther than this from its place, in a domain of radius 1, was missed.
pub const MISSED: f64 = 1e-3;

/// So was one that ends farther than this part of the target's size from its partner.
const MISSED_ON_TARGET: f64 = 5e-3;

/// Options of [`register_disks`] and [`register_spheres`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RegistrationOptions {
    /// λ > 0, the weight of the landmark penalty at the beginning; it grows tenfold until the landmarks meet.
    pub weight: f64,
    /// λ ≥ 0, the weight of the angle distortion against that of areas in all maps; 0 keeps areas alone.
    pub angle_weight: f64,
}

impl Default for RegistrationOptions {
    fn default() -> Self {
        Self { weight: 1.0, angle_weight: 0.0 }
    }
}

/// A registration of disks.
pub type DiskRegistration = Registration<DiskMap, [f64; 2]>;

/// A registration of spheres.
pub type SphereRegistration = Registration<SphereMap, [f64; 3]>;

/// A one-to-one map g of a source surface onto a target.
#[derive(Debug, Clone)]
pub struct Registration<Map, Point> {
    /// (n,): where on the target each vertex of the source comes to lie.
    pub locations: Vec<Location>,
    /// The source's vertices in the parameter domain with the landmarks in place: h∘f on the disk, h₀∘f₀ on
    /// the sphere.
    pub registered: Vec<Point>,
    /// The target's vertices there: g on the disk, h₁∘f₁ on the sphere. Where landmarks could be met only the
    /// other way round, they are the ones that were moved on the disk too.
    pub target_registered: Vec<Point>,
    /// The faces of the target that [`Self::locations`] speak of, all positively oriented in
    /// [`Self::target_registered`].
    pub target_faces: Vec<[u32; 3]>,
    /// The map of the source alone.
    pub source_map: Map,
    /// The map of the target alone.
    pub target_map: Map,
    /// (k,): how far each landmark ends from its partner, in the parameter domain of radius 1.
    pub landmark_error: Vec<f64>,
    /// The pairs that did not meet: farther apart than [`MISSED`], or than .5 % of the target's size on the
    /// target.
    pub missed: Vec<usize>,
    /// Why the run ended; [`Status::LandmarksMissed`] where there are such pairs.
    pub status: Status,
    /// Iterations of carrying the landmarks.
    pub iterations: usize,
    /// The figures of [`Self::registered`] against the source's areas; its E_A is that of h where the
    /// source's landmarks were carried.
    pub distortion: Distortion,
    /// The figures of [`Self::target_registered`] against the target's areas.
    pub target_distortion: Distortion,
    /// Wall time of the whole call.
    pub seconds: f64,
}

impl<Map, Point> Registration<Map, Point> {
    /// g: the place of each source vertex among the target's `vertices`, (n, 3).
    ///
    /// # Panics
    /// Where `vertices` are fewer than the target's.
    pub fn positions(&self, vertices: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let (locations, faces) = (&self.locations, &self.target_faces);
        parallel::map(locations.len(), |source| {
            let location = locations[source];
            location.point(triangle(vertices, faces[location.triangle as usize]))
        })
    }
}

/// The locations of points; a cancelled run still gets them, that takes seconds at a million.
fn located(
    locator: &Locator,
    points: &[Vector],
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
fn missed(
    landmarks: &Landmarks<'_>,
    landmark_error: &[f64],
    target: &TriangleMesh,
    locations: &[Location],
) -> Vec<usize> {
    let is_missed = |&pair: &usize| {
        let location = locations[landmarks.source[pair]];
        let place = location.point(triangle(target.points(), target.faces()[location.triangle as usize]));
        let on_target = distance(place, target.points()[landmarks.target[pair]]);
        landmark_error[pair] > MISSED || on_target > MISSED_ON_TARGET
    };
    (0..landmark_error.len()).filter(is_missed).collect()
}

/// An area ratio with a smaller deviation is even enough to end with, whatever the descent says.
const EVEN_ENOUGH: f64 = 0.01;

/// The status of a registration: what the descent says unless all landmarks met and areas are even, and no
/// better than those of the two maps.
fn verdict(carried: Status, maps: [Status; 2], missed: &[usize], figures: [&Distortion; 2]) -> Status {
    let is_even = figures.iter().all(|figures| figures.area_ratio_std <= EVEN_ENOUGH);
    match carried {
        Status::Cancelled => Status::Cancelled,
        _ if !missed.is_empty() => Status::LandmarksMissed,
        _ if is_even => worst([Status::Converged, maps[0], maps[1]]),
        carried => worst([carried, maps[0], maps[1]]),
    }
}

/// The least good of several statuses.
fn worst<const N: usize>(statuses: [Status; N]) -> Status {
    let rank = |status: &Status| match status {
        Status::Cancelled => 3,
        Status::Stalled => 2,
        Status::MaxIterations => 1,
        _ => 0,
    };
    statuses.into_iter().max_by_key(rank).unwrap_or(Status::Converged)
}
