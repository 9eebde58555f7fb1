// SPDX-License-Identifier: MIT OR Apache-2.0
//! The registration of the target onto the source.

use std::sync::Arc;

use super::boundary::Onto;
use super::filling::OfGiven;
use super::result::Registration;
use crate::arrays::from_rows;
use crate::codomain::planar::flat;
use crate::control::{History, Observer, Phase};
use crate::distortion::{Image, measure};
use crate::error::Error;

impl<Map: OfGiven> Registration<Map> {
    /// The registration of the target onto the source: g⁻¹, from the same maps to the domain. On the disk the target's
    /// boundary is carried onto the source's, as a boundary edge of either surface has corners of the other beside it.
    /// The inverse of an inverse is the registration itself. Cost: one point location per vertex of the target; on the
    /// disk one sparse LU of the vertices near the boundary, or where that folds faces a descent to even areas.
    ///
    /// # Errors
    /// [`Error::CancelledEarly`] where the observer ends it.
    pub fn inverse(&self, observer: &mut dyn Observer) -> Result<Self, Error> {
        if let Some(original) = &self.original {
            return Ok(Self::clone(original));
        }
        let back = match &self.whole {
            Some(whole) => whole
                .back(observer)?
                .of_given([self.correspondence.target(), self.correspondence.source()])?,
            None => self.back(observer)?,
        };
        Ok(Self { original: Some(Arc::new(self.clone())), ..back })
    }

    fn back(&self, observer: &mut dyn Observer) -> Result<Self, Error> {
        let [source, target] = self.correspondence.sides();
        let [target_landmarks, landmarks] = &self.landmarks;
        // 1. On the disk, boundary onto boundary
        let mut carried = None;
        if self.registered.ncols() == 2 {
            let onto = Onto {
                meshes: [target.surface.mesh()?, source.surface.mesh()?],
                images: [&target.in_domain, &source.in_domain],
                landmarks: [landmarks, target_landmarks],
                weight: self.carrying.weight,
                angle_weight: self.carrying.angle_weight,
            };
            let mut phase = Phase { whole: observer, from: 0.0, to: 0.5 };
            carried = match onto.carry_nearby() {
                None => onto.carry(&mut History::start(), &mut phase)?,
                nearby => nearby,
            };
        }
        // 2. The locations
        let mut phase = Phase { whole: observer, from: 0.5, to: 1.0 };
        let correspondence = self.correspondence.inverse(carried.as_ref(), &mut phase)?;
        // 3. The figures of what moved
        let (mut registered, mut distortion) =
            (self.target_registered.clone(), self.target_distortion.clone());
        let mut landmark_error = self.landmark_error.clone();
        if let Some(carried) = carried.as_ref().filter(|carried| carried.status.is_some()) {
            let (mesh, map) = (target.surface.mesh()?, flat(&carried.image));
            distortion = measure(mesh.points(), mesh.faces(), Image::Plane(&map), mesh.face_areas())?;
            registered = from_rows(map);
            landmark_error = landmarks
                .iter()
                .zip(target_landmarks)
                .map(|(&p, &q)| carried.image[p].distance(source.in_domain[q]))
                .collect();
        }
        Ok(Self {
            correspondence,
            registered,
            distortion,
            landmark_error,
            off_boundary: carried.map_or_else(Vec::new, |carried| carried.on_rim.inside),
            target_registered: self.registered.clone(),
            source_map: self.target_map.clone(),
            target_map: self.source_map.clone(),
            target_distortion: self.distortion.clone(),
            missed: self.missed.clone(),
            landmarks: [landmarks.clone(), target_landmarks.clone()],
            whole: None,
            original: None,
            ..*self
        })
    }
}
