// SPDX-License-Identifier: MIT OR Apache-2.0
//! Bindings of the Hessian of the stretch energy.

use authalic::energy::SpatialStretchEnergy;
use authalic::{Elements, Error, MapError, normalized_density};
use numpy::PyArray1;
use pyo3::prelude::*;

use crate::arrays::{from_index_list, values, vectors};
use crate::errors::bad_array;
use crate::run::run;
use crate::surface::Given;

/// Values, row indices and column starts of a sparse matrix.
type Columns = (Py<PyArray1<f64>>, Py<PyArray1<i64>>, Py<PyArray1<i64>>);

/// Hessian of the stretch energy of a map into space, as a sparse matrix.
///
/// Sutti & Yueh (2024), appendix B, by the 3n coordinates of the image: x of all vertices, then y, then z.
/// Target areas are rescaled so that they sum to the image's area. Translations are in its kernel.
///
/// Parameters
/// ----------
/// vertices : (n, 3) real array
///     Positions on the surface, any unit. Or a Surface, without `faces`: `stretch_hessian(surface, image)`.
/// faces : (m, 3) integer array
///     Triangles of an orientable manifold.
/// image : (n, 3) real array
///     The map.
/// density : (m,) real array, optional
///     Positive target measure of each face, on any scale. Default: the face areas.
///
/// Returns
/// -------
/// data, indices, indptr : (k,) float64, (k,) int64, (3n + 1,) int64
///     The symmetric (3n, 3n) matrix in compressed columns, both triangles, as
///     ``scipy.sparse.csc_array((data, indices, indptr))`` takes it.
///
/// Raises
/// ------
/// MeshError
///     The mesh is broken, or an array does not fit.
///
/// Examples
/// --------
/// >>> import authalic
/// >>> points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
/// >>> faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
/// >>> data, indices, indptr = authalic.stretch_hessian(points, faces, points)
/// >>> len(indptr)
/// 13
#[pyfunction]
#[pyo3(signature = (vertices, faces=None, image=None, *, density=None))]
pub fn stretch_hessian(
    py: Python<'_>,
    vertices: &Bound<'_, PyAny>,
    faces: Option<&Bound<'_, PyAny>>,
    image: Option<&Bound<'_, PyAny>>,
    density: Option<&Bound<'_, PyAny>>,
) -> PyResult<Columns> {
    let (given, image) = Given::with_image(vertices, faces, image)?;
    let image = vectors(image, "image")?;
    if image.len() != given.n_vertices() {
        let expected = format!("of shape ({}, 3), one row per vertex", given.n_vertices());
        return Err(bad_array(py, "image", format!("of {} rows", image.len()), expected));
    }
    let density = density.map(|density| values(density, "density")).transpose()?;
    let matrix = run(py, None, move |_| {
        let surface = given.surface()?;
        let mesh = surface.mesh()?;
        let not_finite = |v: &usize| !image[*v].is_finite();
        if let Some(vertices) = Elements::collect((0..image.len()).filter(not_finite)) {
            return Err(MapError::NonFinite { name: "image", vertices }.into());
        }
        let targets = match density {
            Some(density) => normalized_density(&density, mesh.n_faces())?,
            None => mesh.face_areas().to_vec(),
        };
        let energy = SpatialStretchEnergy::new(mesh, &targets);
        let hessian = energy.hessian(&image);
        if hessian.data().iter().all(|value| value.is_finite()) {
            Ok(hessian)
        } else {
            Err(Error::InvalidArray {
                name: "image",
                found: format!("of area {:e}", energy.value(&image).area),
                expected: "a map whose faces have area, neither huge nor tiny".into(),
            })
        }
    })?;
    let (starts, rows, data) = matrix.into_raw_storage();
    let (rows, starts) = (rows.into_iter(), starts.into_iter());
    Ok((PyArray1::from_vec(py, data).unbind(), from_index_list(py, rows), from_index_list(py, starts)))
}
