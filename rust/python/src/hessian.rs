// SPDX-License-Identifier: MIT OR Apache-2.0
//! Bindings of the Hessian of the stretch energy.

use numpy::PyArray1;
use numpy::ndarray::Array1;
use pyo3::prelude::*;

use crate::arrays::{own_array, real_table, reals};
use crate::memory;
use crate::run::run;
use crate::surface::Given;

/// Values, row indices and column starts of a sparse matrix.
type Columns = (Py<PyArray1<f64>>, Py<PyArray1<i64>>, Py<PyArray1<i64>>);

/// Hessian of the stretch energy of a map into space, as a sparse matrix.
///
/// Sutti & Yueh (2024), appendix B, with respect to the 3n coordinates of the image: x of all vertices, then y,
/// then z. Target areas are rescaled so that they sum to the image's area. Translations are in its kernel.
///
/// Parameters
/// ----------
/// vertices : (n, 3) real array
///     Positions on the surface, any unit. Or a Surface, without `faces`: `stretch_hessian(surface, image)`.
/// faces : (m, 3) int array
///     Triangles of an orientable manifold.
/// image : (n, 3) real array
///     The map.
/// density : (m,) real array, optional
///     Positive target measure of each face, on any scale. Default: the face areas.
///
/// Returns
/// -------
/// data, indices, indptr : (k,) float64, (k,) int64, (3n + 1,) int64
///     The symmetric (3n, 3n) matrix in compressed columns, both triangles, ready for
///     ``scipy.sparse.csc_array((data, indices, indptr))``.
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
    let image = real_table::<3>(image, "image")?;
    let density = density.map(|density| reals(density, "density")).transpose()?;
    memory::check(py, memory::HESSIAN, given.n_vertices())?;
    let hessian = run(py, None, move |_| {
        let density = density.as_ref().map(|density| density.view());
        authalic::stretch_hessian(&given.surface()?, image.view(), density)
    })?;
    let list = |indices: Array1<usize>| own_array(py, indices.mapv(|index| index as i64));
    Ok((own_array(py, hessian.data), list(hessian.indices), list(hessian.indptr)))
}
