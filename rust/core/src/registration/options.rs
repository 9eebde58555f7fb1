// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options of registrations by points, and their check.

use super::features::{Features, Signals};
use super::surface::FaceEnergy;
use crate::error::{Elements, Error};
use crate::mesh::TriangleMesh;
use crate::options::check_angle_weight;

/// Angle weights of the two maps and of carrying the landmarks from which the descent between the surfaces starts. With
/// many landmarks the start is the better the less shapes change on the way to the domain, with few ones areas tell more
/// of where the parts between them go. The second is for spheres that have no extremities in common.
pub(super) const START_ANGLE_WEIGHTS: [f64; 2] = [100.0, 10.0];

/// The share of the maps to the domain in the progress of a run whose descent between the surfaces follows.
pub(super) const SHARE_OF_DOMAIN: f64 = 0.4;

/// What a registration by points keeps.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Energy {
    /// Areas (Liu & Yueh 2023, Sutti & Yueh 2024): the stretch of either surface's map to the domain.
    Area,
    /// Areas and angles, of the map from surface to surface in space.
    #[default]
    Surface,
}

/// Options of [`register_disks`](super::register_disks) and [`register_spheres`](super::register_spheres).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RegistrationOptions<'a> {
    /// What the map keeps.
    pub energy: Energy,
    /// λ > 0, the initial weight of the landmark penalty; it grows tenfold until the landmarks meet.
    pub weight: f64,
    /// λ ≥ 0, the weight of angles. With [`Energy::Area`] that of the angle distortion against the areas in all maps,
    /// by default 0; with [`Energy::Surface`] the exponent of the angle factor, by default 1.
    pub angle_weight: Option<f64>,
    /// The exponent ≥ 0 of the area factor of [`Energy::Surface`]; 1 with [`Energy::Area`].
    pub area_weight: f64,
    /// (k,): how strongly each pair of landmarks pulls, a number > 0, against the energy of the whole surface;
    /// infinity takes landmark exactly to landmark. `None`: all exactly. With [`Energy::Area`] all are exact.
    pub weights: Option<&'a [f64]>,
    /// Signals of both surfaces that pull what agrees together, with [`Energy::Surface`].
    pub features: Option<Features<'a>>,
    /// ≥ 0: how strongly each vertex is pulled to its own position, after the similarity that brings the source nearest
    /// to its image, with [`Energy::Surface`]: for bodies in like poses.
    pub position_weight: f64,
    /// Fills holes for the time being: all boundary loops but the longest of a disk, all of a sphere. So surfaces with
    /// different numbers of holes, and open ones and closed ones, can be registered.
    pub fill_holes: bool,
}

impl Default for RegistrationOptions<'_> {
    fn default() -> Self {
        Self {
            energy: Energy::default(),
            weight: 1.0,
            angle_weight: None,
            area_weight: 1.0,
            weights: None,
            features: None,
            position_weight: 0.0,
            fill_holes: false,
        }
    }
}

impl RegistrationOptions<'_> {
    /// Refuses options out of range and weights that do not fit the number of pairs.
    pub(super) fn check(&self, n_pairs: usize) -> Result<(), Error> {
        check_angle_weight(self.angle_weight.unwrap_or(0.0), true)?;
        match self.energy {
            Energy::Area => check_weight("area_weight", self.area_weight)?,
            Energy::Surface => check_face_energy(self.face_energy())?,
        }
        check_weight("position_weight", self.position_weight)?;
        if !(self.weight > 0.0 && self.weight.is_finite()) {
            return Err(refused("weight", self.weight, "a finite number > 0"));
        }
        self.check_pair_weights(n_pairs)?;
        if self.energy == Energy::Area { self.check_areas_alone() } else { Ok(()) }
    }

    fn check_pair_weights(&self, n_pairs: usize) -> Result<(), Error> {
        let Some(weights) = self.weights else { return Ok(()) };
        let (name, one_per_pair) =
            ("weights", "one number > 0 per pair of landmarks, infinity for exact ones");
        if weights.len() != n_pairs {
            let expected = format!("of shape ({n_pairs},), {one_per_pair}");
            return Err(Error::InvalidArray {
                name,
                found: format!("of shape ({},)", weights.len()),
                expected,
            });
        }
        let is_bad = |&pair: &usize| weights[pair].is_nan() || weights[pair] <= 0.0;
        match Elements::collect((0..n_pairs).filter(is_bad)) {
            None => Ok(()),
            Some(rows) => Err(Error::InvalidRows {
                name,
                found: weights[rows.first[0]].to_string(),
                expected: one_per_pair.into(),
                row: "pair",
                rows,
            }),
        }
    }

    /// Refuses what only the energy between the surfaces weighs.
    fn check_areas_alone(&self) -> Result<(), Error> {
        let soft = self.weights.and_then(|weights| weights.iter().find(|weight| weight.is_finite()));
        if let Some(&weight) = soft {
            return Err(refused(
                "weights",
                weight,
                "infinite with energy \"area\"; \"surface\" takes soft landmarks",
            ));
        }
        if self.area_weight != 1.0 {
            let expected = "1 with energy \"area\"; \"surface\" weighs areas";
            return Err(refused("area_weight", self.area_weight, expected));
        }
        if self.position_weight > 0.0 {
            let expected = "0 with energy \"area\"; \"surface\" pulls at positions";
            return Err(refused("position_weight", self.position_weight, expected));
        }
        match self.features {
            None => Ok(()),
            Some(_) => Err(Error::InvalidOption {
                name: "energy",
                found: "\"area\"".into(),
                expected: "\"surface\" for features to pull".into(),
            }),
        }
    }

    /// The features, scaled; none if none are given.
    pub(super) fn signals(&self, meshes: [&TriangleMesh; 2]) -> Result<Signals, Error> {
        self.features.map_or_else(|| Ok(Signals::default()), |features| Signals::new(&features, meshes))
    }

    /// The angle weight of the maps to the domain and of carrying the landmarks there.
    pub(super) fn angle_weight_in_domain(&self) -> f64 {
        match self.energy {
            Energy::Area => self.angle_weight.unwrap_or(0.0),
            Energy::Surface => START_ANGLE_WEIGHTS[0],
        }
    }

    /// The energy of a face between the surfaces.
    pub(super) fn face_energy(&self) -> FaceEnergy {
        FaceEnergy {
            area_weight: self.area_weight,
            angle_weight: self.angle_weight.unwrap_or(1.0),
            both_ways: false,
        }
    }

    /// How strongly a pair of landmarks pulls; infinite if it is exact.
    pub(super) fn pair_weight(&self, pair: usize) -> f64 {
        self.weights.map_or(f64::INFINITY, |weights| weights[pair])
    }
}

/// Refuses exponents that are negative or not finite, and two that are 0, with which no map is better than another.
pub(crate) fn check_face_energy(
    FaceEnergy { area_weight, angle_weight, .. }: FaceEnergy,
) -> Result<(), Error> {
    check_weight("area_weight", area_weight)?;
    check_weight("angle_weight", angle_weight)?;
    if area_weight + angle_weight > 0.0 {
        Ok(())
    } else {
        Err(refused("area_weight", area_weight, "a finite number > 0 where angle_weight is 0"))
    }
}

/// Refuses a weight that is negative or not finite.
pub(crate) fn check_weight(name: &'static str, weight: f64) -> Result<(), Error> {
    if weight >= 0.0 && weight.is_finite() {
        Ok(())
    } else {
        Err(refused(name, weight, "a finite number ≥ 0"))
    }
}

fn refused(name: &'static str, found: f64, expected: &str) -> Error {
    Error::InvalidOption { name, found: found.to_string(), expected: expected.into() }
}
