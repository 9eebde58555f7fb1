// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a descent between two surfaces is given.

use super::density::FaceEnergy;
use crate::codomain::CanonicalDomain;
use crate::mesh::{TriangleMesh, Vertex};
use crate::registration::features::Signals;
use crate::vector::Vector3;

/// A vertex that is pulled to a place on the target: weight × |g(v) − place|² / the target's area.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pull {
    /// The vertex of the source.
    pub vertex: Vertex,
    /// The vertex of the target that it is pulled to.
    pub place: Vertex,
    /// The weight, against the energy of the source, whose area counts as 1.
    pub weight: f64,
}

/// Where the map comes from at which a descent begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Start {
    /// From maps of both surfaces to the domain.
    Domain,
    /// From coarse meshes that are registered.
    Coarse,
}

/// A map of one surface onto another whose energy is to be lowered.
pub(crate) struct SurfaceProblem<'a> {
    /// The surface that is mapped.
    pub source: &'a TriangleMesh,
    /// The surface that it is mapped onto.
    pub target: &'a TriangleMesh,
    /// The target's vertices as given, for previews.
    pub target_points: &'a [Vector3],
    /// The domain in which no face may fold.
    pub domain: CanonicalDomain,
    /// The target's vertices in the domain, the unit sphere or the disk in the plane z = 1.
    pub target_in_domain: &'a [Vector3],
    /// The vertices of the source that do not move, as exact landmarks.
    pub held: Vec<bool>,
    /// Soft landmarks.
    pub pulls: Vec<Pull>,
    /// Signals that should agree: the sum of their squared differences at the source's vertices, weighted by area with
    /// 1 for the whole source, is part of the energy.
    pub signals: Signals,
    /// Where the map comes from at which the descent begins.
    pub start: Start,
    /// Whether the surfaces are coarse meshes of others, for which another descent follows.
    pub is_coarse: bool,
    /// The energy of each face.
    pub face_energy: FaceEnergy,
}
