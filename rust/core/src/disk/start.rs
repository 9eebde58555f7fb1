// SPDX-License-Identifier: MIT OR Apache-2.0
//! Start maps with a prescribed boundary: harmonic and Tutte.
//!
//! Both solve L_II f_I = −L_IB b once: with the cotangent weights of the surface (the papers' start, L_S(id)) or with
//! uniform ones. Tutte's map to a convex boundary is an embedding for every disk (Tutte 1963; Floater 2003).

use crate::error::Error;
use crate::mesh::TriangleMesh;
use crate::mesh::geometry::cotangents;
use crate::parallel;
use crate::sparse::{Cholesky, Laplacian};

/// The harmonic map with the boundary that `map` has.
pub(super) fn harmonic(mesh: &TriangleMesh, laplacian: &mut Laplacian, map: &mut [[f64; 2]]) -> Result<(), Error> {
    let points = mesh.points();
    let by_face = parallel::map(mesh.n_faces(), |face| {
        cotangents(mesh.faces()[face].map(|vertex| points[vertex as usize]))
    });
    let weights: Vec<f64> = by_face.iter().flatten().map(|cotangent| 0.5 * cotangent).collect();
    dirichlet(mesh, laplacian, &weights, map)
}

/// Tutte's map with the boundary that `map` has.
pub(super) fn tutte(mesh: &TriangleMesh, laplacian: &mut Laplacian, map: &mut [[f64; 2]]) -> Result<(), Error> {
    // half an edge's weight per face, so that every interior edge has weight 1
    let weights = vec![0.5; 3 * mesh.n_faces()];
    dirichlet(mesh, laplacian, &weights, map)
}

/// Solves for the interior with the boundary held.
fn dirichlet(
    mesh: &TriangleMesh,
    laplacian: &mut Laplacian,
    weights: &[f64],
    map: &mut [[f64; 2]],
) -> Result<(), Error> {
    laplacian.assemble(mesh, weights);
    let mut factor = Cholesky::analyse(laplacian.matrix())?;
    factor.refactor(laplacian.matrix())?;
    let mut correction = laplacian.residual(mesh, weights, map);
    factor.solve(&mut correction);
    let n = laplacian.free().len();
    for (i, &vertex) in laplacian.free().iter().enumerate() {
        map[vertex as usize][0] -= correction[i];
        map[vertex as usize][1] -= correction[n + i];
    }
    Ok(())
}
