// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options of a registration by curves, and their check.

use ndarray::ArrayView2;

use super::metric::MetricMethod;
use crate::arrays::rows_of;
use crate::error::Error;
use crate::mesh::TriangleMesh;
use crate::registration::surface::FaceEnergy;
use crate::registration::{Features, Signals, check_face_energy, check_weight};
use crate::vector::Vector3;

/// The method that minimizes the harmonic energy.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum HarmonicSolver {
    /// Riemannian Newton: reaches the minimum in a few steps.
    #[default]
    Newton,
    /// The paper's heat diffusion: thousands of small steps toward the minimum.
    Heat,
}

/// What a registration by curves keeps.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum HyperbolicEnergy {
    /// The harmonic energy between the hyperbolic metrics, as in the paper.
    Harmonic,
    /// Areas and angles, of the map from surface to surface in space; the descent starts from the harmonic map.
    #[default]
    Surface,
}

/// Options of [`register_hyperbolic`](super::register_hyperbolic).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HyperbolicOptions<'a> {
    /// What the map keeps.
    pub energy: HyperbolicEnergy,
    /// The exponent ≥ 0 of the area factor of [`HyperbolicEnergy::Surface`].
    pub area_weight: f64,
    /// The exponent ≥ 0 of the angle factor of [`HyperbolicEnergy::Surface`].
    pub angle_weight: f64,
    /// Signals of both surfaces that pull what agrees together, with [`HyperbolicEnergy::Surface`].
    pub features: Option<Features<'a>>,
    /// ≥ 0: how strongly each vertex is pulled to its own position, after the similarity that brings the source nearest
    /// to its image, with [`HyperbolicEnergy::Surface`].
    pub position_weight: f64,
    /// The method that computes the hyperbolic metrics.
    pub metric: MetricMethod,
    /// The method that minimizes the harmonic energy.
    pub solver: HarmonicSolver,
    /// Most steps of the heat diffusion.
    pub heat_steps: usize,
    /// Largest component of the gradient at which the heat diffusion ends.
    pub heat_tolerance: f64,
    /// Fill all boundary loops, but those along which a curve and its partner run, for the time of the call.
    pub fill_holes: bool,
    /// The vertices of source and target on spheres around the origin, which lay the surfaces over each other; they
    /// need not be aligned. `None`: conformal maps.
    pub spheres: Option<[ArrayView2<'a, f64>; 2]>,
}

impl Default for HyperbolicOptions<'_> {
    fn default() -> Self {
        Self {
            energy: HyperbolicEnergy::default(),
            area_weight: 1.0,
            angle_weight: 1.0,
            features: None,
            position_weight: 0.0,
            metric: MetricMethod::default(),
            solver: HarmonicSolver::default(),
            heat_steps: 2000,
            heat_tolerance: 1e-6,
            fill_holes: false,
            spheres: None,
        }
    }
}

impl HyperbolicOptions<'_> {
    /// The spheres as vectors.
    pub(super) fn sphere_vectors(&self) -> Result<Option<[Vec<Vector3>; 2]>, Error> {
        let Some([source, target]) = self.spheres else { return Ok(None) };
        let vectors = |name, array| {
            Ok::<_, Error>(rows_of::<3, _>(name, array)?.iter().copied().map(Vector3).collect())
        };
        Ok(Some([vectors("source_sphere", source)?, vectors("target_sphere", target)?]))
    }

    pub(super) fn check(&self) -> Result<(), Error> {
        if !(self.heat_tolerance >= 0.0 && self.heat_tolerance.is_finite()) {
            return Err(Error::InvalidOption {
                name: "tolerance",
                found: self.heat_tolerance.to_string(),
                expected: "a finite number ≥ 0".into(),
            });
        }
        check_face_energy(self.face_energy())?;
        check_weight("position_weight", self.position_weight)?;
        if self.energy == HyperbolicEnergy::Harmonic { self.check_harmonic() } else { Ok(()) }
    }

    /// The energy of a face between the surfaces.
    pub(super) fn face_energy(&self) -> FaceEnergy {
        FaceEnergy { area_weight: self.area_weight, angle_weight: self.angle_weight, both_ways: false }
    }

    /// Refuses what only the energy between the surfaces weighs.
    fn check_harmonic(&self) -> Result<(), Error> {
        let weights = [
            ("area_weight", self.area_weight, 1.0),
            ("angle_weight", self.angle_weight, 1.0),
            ("position_weight", self.position_weight, 0.0),
        ];
        for (name, found, neutral) in weights {
            if found != neutral {
                let expected = format!("{neutral} with energy \"harmonic\"; \"surface\" weighs it");
                return Err(Error::InvalidOption { name, found: found.to_string(), expected });
            }
        }
        match self.features {
            None => Ok(()),
            Some(_) => Err(Error::InvalidOption {
                name: "energy",
                found: "\"harmonic\"".into(),
                expected: "\"surface\" for features to pull".into(),
            }),
        }
    }

    /// The features, scaled; none if none are given.
    pub(super) fn signals(&self, meshes: [&TriangleMesh; 2]) -> Result<Signals, Error> {
        self.features.map_or_else(|| Ok(Signals::default()), |features| Signals::new(&features, meshes))
    }
}
