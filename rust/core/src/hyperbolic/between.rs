// SPDX-License-Identifier: MIT OR Apache-2.0
//! From the harmonic map to one between the surfaces: the descent in space, with the curves where they are.

use super::features::curves::LandmarkCurves;
use super::options::HyperbolicOptions;
use crate::codomain::CanonicalDomain;
use crate::control::{History, Observer, Status};
use crate::error::Error;
use crate::location::{Location, points_on};
use crate::mesh::{TriangleMesh, Vertex};
use crate::registration::Signals;
use crate::registration::surface::{Start, SurfaceProblem, descend};
use crate::vector::Vector3;

/// Two surfaces with a map that takes curves to curves.
pub(super) struct Between<'a, 'f> {
    pub meshes: [&'a TriangleMesh; 2],
    /// The target's vertices as given.
    pub target_points: &'a [Vector3],
    /// The target's vertices on its rough sphere.
    pub target_in_domain: &'a [Vector3],
    pub curves: &'a LandmarkCurves<'a>,
    pub signals: Signals,
    pub options: &'a HyperbolicOptions<'f>,
}

impl Between<'_, '_> {
    /// The locations of the source on the target after the descent.
    pub(super) fn lower(
        self,
        start: Vec<Location>,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> Result<(Vec<Location>, Status), Error> {
        let [source, target] = self.meshes;
        let mut signals = self.signals;
        if self.options.position_weight > 0.0 {
            let images = points_on(&start, target.points(), target.faces());
            signals.add_positions(self.meshes, &images, self.options.position_weight);
        }
        // vertices of curves and of the boundary stay
        let mut held: Vec<bool> =
            Vertex::all(source.n_vertices()).map(|vertex| source.is_boundary(vertex)).collect();
        self.curves.source.iter().flatten().for_each(|&vertex| held[vertex] = true);
        let problem = SurfaceProblem {
            source,
            target,
            target_points: self.target_points,
            domain: CanonicalDomain::Sphere,
            target_in_domain: self.target_in_domain,
            held,
            pulls: Vec::new(),
            signals,
            start: Start::Domain,
            is_coarse: false,
            face_energy: self.options.face_energy(),
        };
        let descended = descend(&problem, start, history, observer)?;
        Ok((descended.locations, descended.status))
    }
}
