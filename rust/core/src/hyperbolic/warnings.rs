// SPDX-License-Identifier: MIT OR Apache-2.0
//! Warnings of registrations by curves: signs that the curves are not as intended.
//!
//! Cost: linear.

use thiserror::Error;

use super::features::placement::Placement;
use super::harmonic::certificates::Certificates;
use crate::distortion::Distortion;
use crate::error::{Elements, Side, kinds};
use crate::mesh::TriangleMesh;
use crate::mesh::geometry::{area_vector, triangle};
use crate::vector::Vector3;

/// Energy, relative to that of the identity, above which the curves hardly fit.
const STRAINED: f64 = 2.0;
/// Factor on a face's share of the area beyond which it is stretched or squeezed too much.
const TENFOLD: f64 = 10.0;
/// Share of the surface in such faces above which to warn.
const TOO_MUCH: f64 = 0.05;
/// Length of an area vector, relative to the area, above which a surface clearly faces one side.
const FACING: f64 = 0.2;

kinds! {
    /// The subject of a warning; each says what the indices of its elements refer to.
    WarningKind {
        /// Open surfaces face opposite ways, so that the map mirrors one.
        OppositeNormals = "opposite_normals",
        /// A curve fits far better in reverse on one of the surfaces.
        BackwardCurve = "backward_curve",
        /// The curves move too far to tell how the surface between them follows.
        UncertainWinding = "uncertain_winding",
        /// The energy of the map is far above that of the surface itself.
        Strained = "strained",
        /// Much of the surface is stretched or squeezed: faces of the source.
        Distorted = "distorted",
    }
}

/// A sign that the curves are not as intended.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum Warning {
    /// Open surfaces face opposite ways.
    #[error("the surfaces face opposite ways, so the map mirrors one: flip the faces of one of them")]
    OppositeNormals,

    /// A curve seems to run in reverse on one of the surfaces.
    #[error("curve {curve} fits far better in reverse: reverse its path on one of the surfaces")]
    BackwardCurve {
        /// The curve.
        curve: usize,
    },

    /// The map may wind around the curves.
    #[error(
        "the curves move too far to tell how the surface between them follows: it may wind around them \
         more than intended"
    )]
    UncertainWinding,

    /// The curves hardly fit.
    #[error(
        "the map is strained, its energy is {energy_ratio:.1} times that of the surface itself (1.0 to 1.2 is usual): \
         check that curves with the same number belong together and run the same way"
    )]
    Strained {
        /// The harmonic energy of the map over that of the identity.
        energy_ratio: f64,
    },

    /// Much of the surface is stretched or squeezed more than tenfold.
    #[error(
        "{:.0} % of the surface is stretched or squeezed more than tenfold: limbs far from all curves \
         are loosely held, give them curves or closed rings of their own",
        100.0 * share
    )]
    Distorted {
        /// These faces of the source.
        faces: Elements,
        /// Their share of the source's area.
        share: f64,
    },
}

impl Warning {
    /// The subject of the warning, whatever its message says.
    pub fn kind(&self) -> WarningKind {
        match self {
            Self::OppositeNormals => WarningKind::OppositeNormals,
            Self::BackwardCurve { .. } => WarningKind::BackwardCurve,
            Self::UncertainWinding => WarningKind::UncertainWinding,
            Self::Strained { .. } => WarningKind::Strained,
            Self::Distorted { .. } => WarningKind::Distorted,
        }
    }

    /// The surface of the elements.
    pub fn side(&self) -> Option<Side> {
        matches!(self, Self::Distorted { .. }).then_some(Side::Source)
    }

    /// The curve in question.
    pub fn curve(&self) -> Option<usize> {
        match self {
            Self::BackwardCurve { curve } => Some(*curve),
            _ => None,
        }
    }

    /// The elements in question.
    pub fn elements(&self) -> Option<&Elements> {
        match self {
            Self::Distorted { faces, .. } => Some(faces),
            _ => None,
        }
    }

    /// The figure that is too large: the energy ratio, or the share of the area.
    pub fn value(&self) -> Option<f64> {
        match self {
            Self::Strained { energy_ratio } => Some(*energy_ratio),
            Self::Distorted { share, .. } => Some(*share),
            _ => None,
        }
    }
}

/// The warnings, the most likely cause first.
pub(super) fn warnings(
    meshes: [&TriangleMesh; 2],
    placement: &Placement,
    is_sure: bool,
    certificates: &Certificates,
    figures: &Distortion,
) -> Vec<Warning> {
    let backward = placement.backwards.iter().map(|&curve| Warning::BackwardCurve { curve });
    let energy_ratio = certificates.energy_ratio;
    let mut warnings = Vec::new();
    warnings.extend(face_apart(meshes).then_some(Warning::OppositeNormals));
    warnings.extend(backward);
    warnings.extend((!is_sure).then_some(Warning::UncertainWinding));
    warnings.extend((energy_ratio > STRAINED).then_some(Warning::Strained { energy_ratio }));
    warnings.extend(distorted(meshes[0], figures));
    warnings
}

/// Whether two open surfaces face opposite ways in space.
fn face_apart(meshes: [&TriangleMesh; 2]) -> bool {
    let facing = meshes.map(|mesh| {
        let vectors = mesh.faces().iter().map(|&face| area_vector(triangle(mesh.points(), face)));
        let area: f64 = mesh.face_areas().iter().sum();
        vectors.sum::<Vector3>().map(|x| x / area)
    });
    let least = FACING * FACING;
    facing[0].norm() > FACING && facing[1].norm() > FACING && facing[0].dot(facing[1]) < -least
}

/// The faces whose share of area changes more than tenfold, if they are too much of the surface.
pub(super) fn distorted(mesh: &TriangleMesh, figures: &Distortion) -> Option<Warning> {
    let areas = mesh.face_areas();
    let is_distorted = |face: &usize| figures.log2_area_ratio[*face].abs() > TENFOLD.log2();
    let faces = || (0..areas.len()).filter(is_distorted);
    let share = faces().map(|face| areas[face]).sum::<f64>() / areas.iter().sum::<f64>();
    let faces = Elements::collect(faces())?;
    (share > TOO_MUCH).then_some(Warning::Distorted { faces, share })
}
