// SPDX-License-Identifier: MIT OR Apache-2.0
//! Smoothing of signals on the sphere: two implicit steps of heat diffusion, M s' + t K s' = M s, with the areas M and
//! the cotangent stiffness K of the surface's map to the sphere.

use super::sphere_signals::OnSphere;
use crate::control::Watch;
use crate::error::Error;
use crate::mesh::geometry::{area, cotangents, triangle};
use crate::mesh::{TriangleMesh, Vertex};
use crate::parallel;
use crate::sparse::{Analysis, Factor, Order};
use crate::vector::Vector3;

/// The steps of a smoothing.
const STEPS: usize = 2;

/// Bounds of cotangents, so that slivers neither hold values fast nor let them go apart.
const COTANGENTS: [f64; 2] = [0.01, 20.0];

/// The cotangents of the faces of a map to the sphere, (m, 3), within bounds.
pub(super) fn bounded_cotangents(faces: &[[Vertex; 3]], map: &[Vector3]) -> Vec<[f64; 3]> {
    let [least, most] = COTANGENTS;
    parallel::map(faces.len(), |face| {
        cotangents(triangle(map, faces[face])).map(|cotangent| {
            // a face without area has none
            if cotangent.is_nan() { least } else { cotangent.clamp(least, most) }
        })
    })
}

/// Smooths signals on one surface.
pub(super) struct Smoothing<'a> {
    mesh: &'a TriangleMesh,
    /// The areas of the faces on the sphere.
    areas: Vec<f64>,
    cotangents: Vec<[f64; 3]>,
    analysis: Analysis,
}

impl<'a> Smoothing<'a> {
    pub(super) fn new(OnSphere { mesh, map }: OnSphere<'a>) -> Result<Self, Error> {
        let faces = mesh.faces();
        Ok(Self {
            mesh,
            areas: parallel::map(faces.len(), |face| area(triangle(map, faces[face]))),
            cotangents: bounded_cotangents(faces, map),
            analysis: Analysis::new(mesh.n_vertices(), faces, &vec![1; mesh.n_vertices()], Order::Sparse)?,
        })
    }

    /// `width` signals at each vertex smoothed over a radius; `None` if cancelled.
    pub(super) fn smoothed(
        &self,
        values: &[f64],
        width: usize,
        radius: f64,
        watch: &Watch<'_>,
    ) -> Option<Vec<f64>> {
        let n = self.mesh.n_vertices();
        // the variance of the diffusion, radius² along each axis, is 2 t over all steps
        let t = 0.5 * radius * radius / STEPS as f64;
        let element = |face: usize| self.element(face, t);
        let mut factor = Factor::<f64>::new(&self.analysis);
        factor.refactor(&self.analysis, &element, watch).ok()?;
        let masses = self.mesh.vertex_shares(&self.areas);
        // signal by signal
        let mut columns: Vec<f64> = (0..n * width).map(|i| values[i % n * width + i / n]).collect();
        for _ in 0..STEPS {
            columns.iter_mut().enumerate().for_each(|(i, value)| *value *= masses[i % n]);
            factor.solve(&self.analysis, &mut columns);
        }
        Some((0..n * width).map(|i| columns[i % width * n + i / width]).collect())
    }

    /// M + t K of a face, for one unknown per vertex.
    fn element(&self, face: usize, t: f64) -> [[f64; 6]; 6] {
        let mut element = [[0.0; 6]; 6];
        for c in 0..3 {
            let (a, b) = (2 * ((c + 1) % 3), 2 * ((c + 2) % 3));
            let stiffness = 0.5 * t * self.cotangents[face][c];
            element[2 * c][2 * c] += self.areas[face] / 3.0;
            element[a][a] += stiffness;
            element[b][b] += stiffness;
            element[a][b] -= stiffness;
            element[b][a] -= stiffness;
        }
        element
    }
}
