// SPDX-License-Identifier: MIT OR Apache-2.0
//! The inverse of a registration: the target registered onto the source by the same maps.
//!
//! Cost: one point location per vertex of the target.

use super::result::Registration;
use crate::control::{Observer, Watch};
use crate::distortion::Image;
use crate::error::Error;
use crate::location::Locator;
use crate::vector::Vector3;

/// A point of the disk or of the sphere.
pub trait DomainPoint: Copy + Send + Sync {
    /// The point in space, with the disk in the plane z = 1.
    fn lifted(self) -> Vector3;

    /// A map to the domain.
    fn image(map: &[Self]) -> Image<'_>
    where
        Self: Sized;
}

impl DomainPoint for [f64; 2] {
    fn lifted(self) -> Vector3 {
        Vector3([self[0], self[1], 1.0])
    }

    fn image(map: &[Self]) -> Image<'_> {
        Image::Plane(map)
    }
}

impl DomainPoint for Vector3 {
    fn lifted(self) -> Vector3 {
        self
    }

    fn image(map: &[Self]) -> Image<'_> {
        Image::Sphere(map)
    }
}

impl<Map: Clone, Point: DomainPoint> Registration<Map, Point> {
    /// The registration of the target onto the source: g⁻¹, from the same maps to the domain.
    ///
    /// `source_faces` (m, 3) are the faces of the source as oriented.
    ///
    /// # Errors
    /// [`Error::CancelledEarly`] if the observer cancels.
    ///
    /// # Panics
    /// If the arrays are not those of the registered surfaces.
    pub fn inverse(&self, source_faces: &[[u32; 3]], observer: &mut dyn Observer) -> Result<Self, Error> {
        let source = lifted(&self.registered);
        let watch = Watch::new(observer, 0.0, "Looking up places");
        let locator = Locator::new(&source, source_faces);
        let locations = locator.locate_all(&lifted(&self.target_registered), &watch);
        Ok(Self {
            locations: locations.ok_or(Error::CancelledEarly)?,
            registered: self.target_registered.clone(),
            target_registered: self.registered.clone(),
            target_faces: source_faces.to_vec(),
            source_map: self.target_map.clone(),
            target_map: self.source_map.clone(),
            distortion: self.target_distortion.clone(),
            target_distortion: self.distortion.clone(),
            landmark_error: self.landmark_error.clone(),
            missed: self.missed.clone(),
            ..*self
        })
    }
}

/// The points of a map in space.
pub fn lifted<Point: DomainPoint>(map: &[Point]) -> Vec<Vector3> {
    map.iter().map(|&point| point.lifted()).collect()
}
