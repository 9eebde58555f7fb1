// SPDX-License-Identifier: MIT OR Apache-2.0
//! Bindings of the morph along a registration.

use pyo3::prelude::*;

use super::result::Registration;
use crate::arrays::{Reals, own_array, real_table};
use crate::run::run;
use crate::surface::handle;

/// The morph along a registration, from the source at t = 0 to its image on the target at t = 1.
///
/// Parameters
/// ----------
/// vertices : (n, 3) real array
///     The source's vertices. Or the source as a Surface.
/// registration : Registration
///     The registration of the source onto the target.
/// t : float
///     Any finite number; below 0 and above 1 the vertices continue along their straight lines.
/// align : bool
///     Move, rotate and scale the image onto the source first (the best similarity by area), so that the shape changes
///     but does not travel.
///
/// Returns
/// -------
/// (n, 3) float64 array
///     (1 − t) v + t g(v), with g the registration.
///
/// Raises
/// ------
/// MeshError
///     The array is not of shape (n, 3).
/// ValueError
///     t is not finite.
///
/// Examples
/// --------
/// >>> import authalic
/// >>> corners = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]
/// >>> faces = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [3, 2, 1]]
/// >>> large = [[3 * x for x in corner] for corner in corners]
/// >>> registration = authalic.register_spheres(
/// ...     (corners, faces), (large, faces), source_landmarks=[0, 1], target_landmarks=[0, 1]
/// ... )
/// >>> authalic.homotopy(corners, registration, 0.5).max().round(6).item()
/// 2.0
#[pyfunction]
#[pyo3(signature = (vertices, registration, t, *, align=false))]
pub fn homotopy(
    py: Python<'_>,
    vertices: &Bound<'_, PyAny>,
    registration: &Registration,
    t: f64,
    align: bool,
) -> PyResult<Reals> {
    let finished = registration.finished.clone();
    let vertices = match handle(vertices) {
        Some(surface) => surface.vertices().to_owned(),
        None => real_table::<3>(vertices, "vertices")?,
    };
    let morphed =
        run(py, None, move |_| authalic::homotopy(vertices.view(), finished.correspondence(), t, align))?;
    Ok(own_array(py, morphed))
}
