// SPDX-License-Identifier: MIT OR Apache-2.0
//! From a registration in the domain to one between the surfaces: the descent in space, and its map in the domain.

use super::Landmarks;
use super::features::Signals;
use super::options::RegistrationOptions;
use super::surface::{Descended, Pull, Start, SurfaceProblem, descend};
use crate::codomain::CanonicalDomain;
use crate::control::{History, Observer, Status};
use crate::error::Error;
use crate::location::{Location, points_on};
use crate::mesh::{TriangleMesh, Vertex};
use crate::parallel;
use crate::vector::Vector3;

/// Two surfaces in one domain, with what pulls the source over the target.
pub(super) struct Between<'a, 'f> {
    pub source: &'a TriangleMesh,
    pub target: &'a TriangleMesh,
    /// The target's vertices as given.
    pub target_points: &'a [Vector3],
    pub domain: CanonicalDomain,
    /// The target's vertices in the domain.
    pub target_in_domain: &'a [Vector3],
    pub landmarks: &'a Landmarks<'a>,
    pub signals: Signals,
    pub options: &'a RegistrationOptions<'f>,
    /// Where the map comes from.
    pub start: Start,
    /// Whether the surfaces are coarse meshes of others.
    pub is_coarse: bool,
}

/// Two surfaces after the descent.
pub(super) struct Lowered {
    /// The locations of the source on the target.
    pub locations: Vec<Location>,
    /// The source's vertices in the domain.
    pub registered: Vec<Vector3>,
    /// The energy between the surfaces, 1 for an isometry.
    pub energy: f64,
    pub status: Status,
}

impl Between<'_, '_> {
    /// The surfaces after the descent.
    ///
    /// # Errors
    /// As [`descend`].
    pub(super) fn lower(
        self,
        map: Vec<Location>,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> Result<Lowered, Error> {
        let Self {
            source, target, target_points, domain, target_in_domain, options, start, is_coarse, ..
        } = self;
        let (held, pulls) = self.held_and_pulled();
        let mut signals = self.signals;
        if options.position_weight > 0.0 {
            let images = points_on(&map, target.points(), target.faces());
            signals.add_positions([source, target], &images, options.position_weight);
        }
        let face_energy = options.face_energy();
        let problem = SurfaceProblem {
            source,
            target,
            target_points,
            domain,
            target_in_domain,
            held,
            pulls,
            signals,
            start,
            is_coarse,
            face_energy,
        };
        let Descended { locations, energy, status } = descend(&problem, map, history, observer)?;
        let registered = in_domain(&locations, target.faces(), target_in_domain, domain);
        Ok(Lowered { locations, registered, energy, status })
    }

    /// The exact landmarks of the source, which stay, and the soft ones, which are pulled.
    fn held_and_pulled(&self) -> (Vec<bool>, Vec<Pull>) {
        let mut held = vec![false; self.source.n_vertices()];
        let mut pulls = Vec::new();
        for (pair, (&vertex, &place)) in self.landmarks.source.iter().zip(self.landmarks.target).enumerate() {
            let weight = self.options.pair_weight(pair);
            if weight.is_finite() {
                pulls.push(Pull { vertex: Vertex::new(vertex), place: Vertex::new(place), weight });
            } else {
                held[vertex] = true;
            }
        }
        (held, pulls)
    }
}

/// Locations on the target as points of the domain.
fn in_domain(
    locations: &[Location],
    target_faces: &[[Vertex; 3]],
    target_in_domain: &[Vector3],
    domain: CanonicalDomain,
) -> Vec<Vector3> {
    parallel::map(locations.len(), |vertex| {
        let place = locations[vertex].point_on(target_in_domain, target_faces);
        match domain {
            CanonicalDomain::Sphere => place.normalized(),
            CanonicalDomain::Disk => Vector3([place[0], place[1], 1.0]),
        }
    })
}
