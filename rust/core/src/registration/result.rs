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
    /// The pairs that did not meet: farther apart than [`MISSED`](super::MISSED), or than .5 % of the target's size on the
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
    pub fn positions(&self, vertices: &[Vector3]) -> Vec<Vector3> {
        points_on(&self.locations, vertices, &self.target_faces)
    }
}
