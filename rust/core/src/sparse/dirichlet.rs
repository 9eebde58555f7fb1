// SPDX-License-Identifier: MIT OR Apache-2.0
//! Planar harmonic maps with some vertices held.

use super::{Cholesky, Laplacian};
use crate::control::Watch;
use crate::error::Error;
use crate::mesh::TriangleMesh;

/// Solves L_II f_I = −L_IB f_B in place for one weight per corner, the vertices that are not free in `laplacian` held;
/// `factor` must have analyzed its pattern.
///
/// # Errors
/// [`NumericsError::FactorizationFailed`](crate::NumericsError::FactorizationFailed) where L_II is not positive
/// definite to working precision, [`Error::CancelledEarly`] by the watch.
pub(crate) fn solve_dirichlet(
    mesh: &TriangleMesh,
    laplacian: &mut Laplacian,
    factor: &mut Cholesky,
    weights: &[f64],
    map: &mut [[f64; 2]],
    watch: &Watch<'_>,
) -> Result<(), Error> {
    laplacian.assemble(mesh, weights);
    factor.refactor_while(laplacian.matrix(), watch)?;
    let mut correction = laplacian.residual(mesh, weights, map);
    factor.solve(&mut correction);
    let n = laplacian.free().len();
    for (i, &vertex) in laplacian.free().iter().enumerate() {
        map[vertex][0] -= correction[i];
        map[vertex][1] -= correction[n + i];
    }
    Ok(())
}
