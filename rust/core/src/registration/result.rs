// SPDX-License-Identifier: MIT OR Apache-2.0
//! The result of a registration by points.

use std::sync::Arc;

use ndarray::{Array1, Array2};

use super::correspondence::Correspondence;
use super::options::RegistrationOptions;
use super::strain::Strain;
use crate::control::Status;
use crate::disk::DiskMap;
use crate::distortion::Distortion;
use crate::sphere::SphereMap;

/// A registration of disks.
pub type DiskRegistration = Registration<DiskMap>;

/// A registration of spheres.
pub type SphereRegistration = Registration<SphereMap>;

/// A registration of a source surface onto a target by landmarks.
#[derive(Debug, Clone)]
pub struct Registration<Map> {
    /// g: the location of each source vertex on the target.
    pub correspondence: Correspondence,
    /// The source's vertices, (n, 2) or (n, 3), in the parameter domain with the landmarks in place: h∘f on the disk,
    /// h₀∘f₀ on the sphere. The boundary of a disk lies on that of the target's image, a polygon.
    pub registered: Array2<f64>,
    /// The target's vertices in that domain: g on the disk, h₁∘f₁ on the sphere. On the disk they are moved only where
    /// moving the source's landmarks alone misses some.
    pub target_registered: Array2<f64>,
    /// The map of the source alone, from which the registration started; of large spheres the refined map of a coarse
    /// mesh. With [`Energy::Surface`](super::Energy::Surface) it is a map of the surface with rounded vertices: its history
    /// is of that, its figures are of the source as given.
    pub source_map: Map,
    /// The map of the target alone, likewise.
    pub target_map: Map,
    /// The landmarks of source and target, as given.
    pub landmarks: [Vec<usize>; 2],
    /// (k,): the final distance of each landmark from its partner, in the parameter domain of radius 1.
    pub landmark_error: Array1<f64>,
    /// The pairs that did not meet: farther apart than 10⁻³ in the domain, or than .5 % of the
    /// target's size on the target.
    pub missed: Vec<usize>,
    /// Vertices of the source's boundary that lie a little inside the target, since faces between them would have no
    /// area on a straight side of its boundary; ascending. All others lie on the target's boundary. Empty for spheres.
    pub off_boundary: Vec<usize>,
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
    pub(super) carrying: CarryingOptions,
    /// The registration of the surfaces with their holes filled.
    pub(super) whole: Option<Arc<Self>>,
    /// The registration that this is the inverse of.
    pub(super) original: Option<Arc<Self>>,
}

/// The options of carrying landmarks in the domain.
#[derive(Debug, Clone, Copy)]
pub(super) struct CarryingOptions {
    /// λ at the beginning.
    pub weight: f64,
    /// The weight of the angle distortion against that of the areas.
    pub angle_weight: f64,
}

impl CarryingOptions {
    pub(super) fn new(options: &RegistrationOptions<'_>) -> Self {
        Self { weight: options.weight, angle_weight: options.angle_weight_in_domain() }
    }
}

impl<Map> Registration<Map> {
    /// How far g stretches and shrinks each face of the source.
    pub fn strain(&self) -> Strain {
        let landmarks: Vec<Vec<usize>> = self.landmarks[0].iter().map(|&vertex| vec![vertex]).collect();
        self.correspondence.strain(&landmarks)
    }
}
