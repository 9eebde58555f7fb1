// SPDX-License-Identifier: MIT OR Apache-2.0
//! Planar layouts of cut surfaces on a convex polygon (Tutte 1963).
//!
//! With positive weights and the boundary on a convex polygon the solution is an embedding, as no interior edge
//! joins two boundary vertices. The weights are the cotangents in space, clamped.
//!
//! Cost: one sparse Cholesky factorization.

use crate::control::Watch;
use crate::distortion::folded_in_plane;
use crate::error::{Elements, Error, NumericsError};
use crate::hyperbolic::slice::Opened;
use crate::hyperbolic::slice::sliced::Sliced;
use crate::mesh::geometry::corner_cotangents;
use crate::mesh::{Corner, Vertex};
use crate::parallel;
use crate::sparse::{Analysis, Factor, Failure, Order};

/// Range to which weights are clamped.
const WEIGHTS: [f64; 2] = [1e-2, 1e2];

/// A place in the plane.
pub(crate) type Planar = [f64; 2];

/// The position of each vertex of the disk, that in `held` if there is one; no face is folded.
///
/// # Errors
/// [`NumericsError::NoEmbedding`], with faces of the piece, if some fold in double precision;
/// [`Error::CancelledEarly`].
pub(crate) fn planar_layout(
    sliced: &Sliced,
    held: &[Option<Planar>],
    watch: &Watch<'_>,
) -> Result<Vec<Planar>, Error> {
    let disk = &sliced.disk;
    let cotangent = harmonic(disk, &clamped_weights(sliced), held, watch)?;
    if folded_in_plane(&disk.faces, &cotangent).is_empty() {
        return Ok(cotangent);
    }
    let uniform = harmonic(disk, &vec![1.0; 3 * disk.faces.len()], held, watch)?;
    let folded = folded_in_plane(&disk.faces, &uniform).into_iter();
    match Elements::collect(folded.map(|face| sliced.places[face].face)) {
        None => Ok(uniform),
        Some(folded) => Err(NumericsError::NoEmbedding { folded }.into()),
    }
}

/// (3 m,): the weight of the edge opposite to each corner.
pub(super) fn clamped_weights(sliced: &Sliced) -> Vec<f64> {
    let cotangents = corner_cotangents(&sliced.points, &sliced.faces);
    let opposite = &sliced.surface.opposite;
    let of = |corner: Corner| cotangents[corner.face()][corner.place()];
    let weight = |corner: Corner| match opposite[corner] {
        None => 0.5 * of(corner),
        Some(across) => 0.5 * (of(corner) + of(across)),
    };
    parallel::map(3 * cotangents.len(), |corner| {
        let weight = weight(Corner::new(corner));
        if weight.is_finite() { weight.clamp(WEIGHTS[0], WEIGHTS[1]) } else { WEIGHTS[1] }
    })
}

/// The map that is the weighted mean of its neighbors at each vertex that is not held.
fn harmonic(
    disk: &Opened,
    weights: &[f64],
    held: &[Option<Planar>],
    watch: &Watch<'_>,
) -> Result<Vec<Planar>, Error> {
    let system = Laplace::new(&disk.faces, held.iter().map(Option::is_some).collect())?;
    let mut map: Vec<Planar> = held.iter().map(|place| place.unwrap_or_default()).collect();
    system.solve(&disk.faces, weights, |_, _| [0.0; 2], &mut map, watch)?;
    Ok(map)
}

/// The system of a weighted graph Laplacian on a triangulation.
pub(super) struct Laplace {
    analysis: Analysis,
    is_held: Vec<bool>,
}

impl Laplace {
    /// Analyzes the pattern of `faces` for the vertices that are not held.
    pub(super) fn new(faces: &[[Vertex; 3]], is_held: Vec<bool>) -> Result<Self, Error> {
        let dofs: Vec<u8> = is_held.iter().map(|&held| u8::from(!held)).collect();
        let analysis = Analysis::new(dofs.len(), faces, &dofs, Order::Sparse)?;
        Ok(Self { analysis, is_held })
    }

    /// Solves Σ w (f_i − f_j − jump(face, k)) = 0 for the vertices of `map` that are not held; the edge i → j
    /// opposite to corner k of a face goes beyond f_j by the jump. Each corner counts half the edge's weight.
    pub(super) fn solve(
        &self,
        faces: &[[Vertex; 3]],
        weights: &[f64],
        jump: impl Fn(usize, usize) -> Planar + Sync,
        map: &mut [Planar],
        watch: &Watch<'_>,
    ) -> Result<(), Error> {
        let element = |face: usize| {
            let mut matrix = [[0.0; 6]; 6];
            for k in 0..3 {
                let (i, j) = (2 * ((k + 1) % 3), 2 * ((k + 2) % 3));
                let weight = 0.5 * weights[3 * face + k];
                (matrix[i][i], matrix[j][j]) = (matrix[i][i] + weight, matrix[j][j] + weight);
                (matrix[i][j], matrix[j][i]) = (-weight, -weight);
            }
            matrix
        };
        let mut factor = Factor::<f64>::new(&self.analysis);
        factor.refactor(&self.analysis, &element, watch).map_err(|failure| match failure {
            Failure::Cancelled => Error::CancelledEarly,
            Failure::NotPositiveDefinite => {
                NumericsError::FactorizationFailed { what: "the Laplacian of a cut surface".into() }.into()
            }
        })?;
        // the solution is the map with the held positions plus Newton's step from it
        let unknown = |vertex: Vertex| self.analysis.first_unknown(vertex);
        let n = self.analysis.n_unknowns();
        let mut rhs = vec![0.0; 2 * n];
        for (face, corners) in faces.iter().enumerate() {
            for k in 0..3 {
                let [i, j] = [corners[(k + 1) % 3], corners[(k + 2) % 3]];
                let (jump, weight) = (jump(face, k), 0.5 * weights[3 * face + k]);
                for axis in 0..2 {
                    let pull = weight * (map[i][axis] - map[j][axis] - jump[axis]);
                    for (vertex, pull) in [(i, -pull), (j, pull)] {
                        if !self.is_held[vertex] {
                            rhs[axis * n + unknown(vertex)] += pull;
                        }
                    }
                }
            }
        }
        factor.solve(&self.analysis, &mut rhs);
        for vertex in Vertex::all(map.len()).filter(|&vertex| !self.is_held[vertex]) {
            let k = unknown(vertex);
            map[vertex] = [map[vertex][0] + rhs[k], map[vertex][1] + rhs[n + k]];
        }
        Ok(())
    }
}
