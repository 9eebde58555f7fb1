// SPDX-License-Identifier: MIT OR Apache-2.0
//! The result of a registration by points.

use crate::control::Status;
use crate::disk::DiskMap;
use crate::distortion::Distortion;
use crate::location::{Location, points_on};
use crate::sphere::SphereMap;
use crate::vector::Vector3;

/// A registration of disks.
pub type DiskRegistration = Registration<DiskMap, [f64; 2]>;

/// A registration of spheres.
pub type SphereRegistration = Registration<SphereMap, Vector3>;

/// A one-to-one map g of a source surface onto a target.
#[derive(Debug, Clone)]
pub struct Registration<Map, Point> {
    /// (n,): the location of each source vertex on the target.
    pub locations: Vec<Location>,
    /// The source's vertices in the parameter domain with the landmarks in place: h∘f on the disk, h₀∘f₀ on
    /// the sphere.
    pub registered: Vec<Point>,
    /// The target's vertices in that domain: g on the disk, h₁∘f₁ on the sphere. On the disk they are moved only where
    /// moving the source's landmarks alone misses some.
    pub target_registered: Vec<Point>,
    /// The faces of the target that [`Self::locations`] refer to, all positively oriented in
    /// [`Self::target_registered`].
    pub target_faces: Vec<[u32; 3]>,
    /// The map of the source alone.
    pub source_map: Map,
    /// The map of the target alone.
    pub target_map: Map,
    /// (k,): the final distance of each landmark from its partner, in the parameter domain of radius 1.
    pub landmark_error: Vec<f64>,
    /// The pairs that did not meet: farther apart than [`MISSED`](super::MISSED) in the domain, or than .5 % of the
    /// target's size on the target.
    pub missed: Vec<usize>,
    /// Why the run ended; [`Status::LandmarksMissed`] if some pairs did not meet.
    pub status: Status,
    /// Iterations of carrying the landmarks.
    pub iterations: usize,
    /// The figures of [`Self::registered`] against the source's areas; E_A is that of h if the source's landmarks
    /// were carried.
    pub distortion: Distortion,
    /// The figures of [`Self::target_registered`] against the target's areas.
    pub target_distortion: Distortion,
    /// Wall time of the whole call.
    pub seconds: f64,
}

impl<Map, Point> Registration<Map, Point> {
    /// g: the position of each source vertex on the target with `vertices`, (n, 3).
    ///
    /// # Panics
    /// If there are fewer `vertices` than the target has.
    pub fn positions(&self, vertices: &[Vector3]) -> Vec<Vector3> {
        points_on(&self.locations, vertices, &self.target_faces)
    }
}
