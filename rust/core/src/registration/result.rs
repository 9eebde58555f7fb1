// SPDX-License-Identifier: MIT OR Apache-2.0
//! The result of a registration by points.

use ndarray::{Array1, Array2};

use super::correspondence::Correspondence;
use super::strain::Strain;
use crate::control::{Observer, Status};
use crate::disk::DiskMap;
use crate::distortion::Distortion;
use crate::error::Error;
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
    /// h₀∘f₀ on the sphere.
    pub registered: Array2<f64>,
    /// The target's vertices in that domain: g on the disk, h₁∘f₁ on the sphere. On the disk they are moved only where
    /// moving the source's landmarks alone misses some.
    pub target_registered: Array2<f64>,
    /// The map of the source alone.
    pub source_map: Map,
    /// The map of the target alone.
    pub target_map: Map,
    /// The landmarks of source and target, as given.
    pub landmarks: [Vec<usize>; 2],
    /// (k,): the final distance of each landmark from its partner, in the parameter domain of radius 1.
    pub landmark_error: Array1<f64>,
    /// The pairs that did not meet: farther apart than 10⁻³ in the domain, or than .5 % of the
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

impl<Map: Clone> Registration<Map> {
    /// The registration of the target onto the source: g⁻¹, from the same maps to the domain. Cost: one point location
    /// per vertex of the target.
    ///
    /// # Errors
    /// [`Error::CancelledEarly`] where the observer ends it.
    pub fn inverse(&self, observer: &mut dyn Observer) -> Result<Self, Error> {
        Ok(Self {
            correspondence: self.correspondence.inverse(observer)?,
            registered: self.target_registered.clone(),
            target_registered: self.registered.clone(),
            source_map: self.target_map.clone(),
            target_map: self.source_map.clone(),
            distortion: self.target_distortion.clone(),
            target_distortion: self.distortion.clone(),
            landmarks: [self.landmarks[1].clone(), self.landmarks[0].clone()],
            landmark_error: self.landmark_error.clone(),
            missed: self.missed.clone(),
            ..*self
        })
    }

    /// How far g stretches and shrinks each face of the source.
    pub fn strain(&self) -> Strain {
        let landmarks: Vec<Vec<usize>> = self.landmarks[0].iter().map(|&vertex| vec![vertex]).collect();
        self.correspondence.strain(&landmarks)
    }
}
