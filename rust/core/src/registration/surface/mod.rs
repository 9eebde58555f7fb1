// SPDX-License-Identifier: MIT OR Apache-2.0
//! The descent on the energy between two surfaces: each face of the source against its image in space on the target.

use super::features::Signals;
use crate::control::{History, Observer, Status};
use crate::location::Location;
use crate::mesh::{TriangleMesh, Vertex};
use crate::vector::Vector3;

/// The energy of a face: (angle factor)^angle_weight × (area factor)^area_weight, with the singular values σ₁ ≥ σ₂ of the
/// map of the face, d = σ₁ σ₂, the angle factor (σ₁/σ₂ + σ₂/σ₁)/2 and the area factor (d + 1/d)/2. With weights of 1 it
/// is the symmetric Dirichlet energy over 4.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FaceEnergy {
    /// The exponent of the area factor.
    pub area_weight: f64,
    /// The exponent of the angle factor.
    pub angle_weight: f64,
}

/// A vertex that is pulled to a place on the target: weight × |g(v) − place|² / the target's area.
#[derive(Debug, Clone, Copy)]
#[expect(dead_code, reason = "read by the descent")]
pub(crate) struct Pull {
    /// The vertex of the source.
    pub vertex: Vertex,
    /// The vertex of the target that it is pulled to.
    pub place: Vertex,
    /// The weight, against the energy of the source, whose area counts as 1.
    pub weight: f64,
}

/// A map of one surface onto another whose energy is to be lowered.
#[expect(dead_code, reason = "read by the descent")]
pub(crate) struct SurfaceProblem<'a> {
    /// The surface that is mapped.
    pub source: &'a TriangleMesh,
    /// The surface that it is mapped onto.
    pub target: &'a TriangleMesh,
    /// The target's vertices in the domain, the unit sphere or the disk in the plane z = 1, where no face may fold.
    pub target_in_domain: &'a [Vector3],
    /// The vertices of the source that do not move, as exact landmarks.
    pub held: Vec<bool>,
    /// Soft landmarks.
    pub pulls: Vec<Pull>,
    /// Signals that should agree: the sum of their squared differences at the source's vertices, weighted by area with
    /// 1 for the whole source, is part of the energy.
    pub signals: Signals,
    /// The energy of each face.
    pub face_energy: FaceEnergy,
}

/// Lowers the energy from a map without folds.
pub(crate) fn descend(
    _problem: &SurfaceProblem<'_>,
    start: Vec<Location>,
    _history: &mut History,
    _observer: &mut dyn Observer,
) -> (Vec<Location>, Status) {
    (start, Status::MaxIterations)
}
