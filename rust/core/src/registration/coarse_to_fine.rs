// SPDX-License-Identifier: MIT OR Apache-2.0
//! Large surfaces are laid over each other by coarse meshes of some of their vertices, which then get the others back.
//!
//! The coarse meshes are registered like any surfaces, up to the descent between them. What is left to the large ones is
//! the same descent from there, in which only what the coarse meshes cannot show changes.

use super::features::Signals;
use super::landmarks::Landmarks;
use crate::codomain::CanonicalDomain;
use crate::control::{Observer, Phase};
use crate::embedding::{Coarse, NotCoarse};
use crate::error::Error;
use crate::mesh::{TriangleMesh, Vertex};
use crate::parallel;
use crate::vector::Vector3;

/// Surfaces with more vertices are large.
const LARGE: usize = 5_000;

/// The part of a surface's vertices that a coarse mesh has, and the fewest.
const COARSER: f64 = 0.25;
const FEWEST: usize = 2_500;

/// Between more landmarks a coarse mesh has too few vertices.
const MOST_LANDMARKS: usize = 250;

/// Coarse meshes of two surfaces, with all landmarks.
pub(super) struct CoarsePair<'a> {
    sides: [Coarse<'a>; 2],
    landmarks: [Vec<usize>; 2],
}

impl<'a> CoarsePair<'a> {
    /// The coarse meshes of two surfaces, where one is large; `None` where they are not, where there are too many
    /// landmarks, or where a coarse mesh is no surface.
    ///
    /// # Errors
    /// [`Error::CancelledEarly`] where the observer ends it.
    pub(super) fn new(
        meshes: [&'a TriangleMesh; 2],
        landmarks: &Landmarks<'_>,
        observer: &mut dyn Observer,
    ) -> Result<Option<Self>, Error> {
        if meshes.iter().all(|mesh| mesh.n_vertices() <= LARGE) {
            return Ok(None);
        }
        let given = [landmarks.source, landmarks.target];
        if given[0].len() > MOST_LANDMARKS {
            return Ok(None);
        }
        let mut side = |k: usize| {
            let mut is_landmark = vec![false; meshes[k].n_vertices()];
            given[k].iter().for_each(|&vertex| is_landmark[vertex] = true);
            let half = 0.5 * k as f64;
            let mut phase = Phase { whole: observer, from: half, to: half + 0.5 };
            let n = FEWEST.max((COARSER * meshes[k].n_vertices() as f64) as usize);
            Coarse::new(meshes[k], n, |vertex| is_landmark[vertex], &mut phase)
        };
        let sides = match (side(0), side(1)) {
            (Ok(source), Ok(target)) => [source, target],
            (Err(NotCoarse::Cancelled), _) | (_, Err(NotCoarse::Cancelled)) => {
                return Err(Error::CancelledEarly);
            }
            _ => return Ok(None),
        };
        let number = |k: usize, vertex: usize| {
            let place = sides[k].vertices.binary_search(&Vertex::new(vertex));
            place.expect("landmarks stay")
        };
        let landmarks = [0, 1].map(|k| given[k].iter().map(|&vertex| number(k, vertex)).collect());
        Ok(Some(Self { sides, landmarks }))
    }

    pub(super) fn meshes(&self) -> [&TriangleMesh; 2] {
        [&self.sides[0].mesh, &self.sides[1].mesh]
    }

    pub(super) fn landmarks(&self) -> Landmarks<'_> {
        Landmarks { source: &self.landmarks[0], target: &self.landmarks[1] }
    }

    /// The signals at the vertices of the coarse meshes.
    pub(super) fn signals(&self, signals: &Signals) -> Signals {
        let [source, target] = [&self.sides[0].vertices, &self.sides[1].vertices];
        signals.at([source, target])
    }

    /// A map of the coarse mesh on each side, taken to the large surfaces; `None` where double precision does not suffice.
    pub(super) fn refined(
        &self,
        maps: [&[Vector3]; 2],
        domain: CanonicalDomain,
        sweeps: usize,
    ) -> Option<[Vec<Vector3>; 2]> {
        let refined = |side: usize| self.sides[side].refined(maps[side], domain, sweeps);
        let (source, target) = parallel::join(|| refined(0), || refined(1));
        Some([source?, target?])
    }
}
