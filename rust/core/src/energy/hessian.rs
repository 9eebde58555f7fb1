// SPDX-License-Identifier: MIT OR Apache-2.0
//! The Hessian of the stretch energy of a map into space as a sparse matrix (Sutti & Yueh 2024, appendix B).

use ndarray::{Array1, ArrayView1, ArrayView2};

use super::SpatialStretchEnergy;
use crate::arrays::rows_of;
use crate::distortion::targets;
use crate::error::{Elements, Error, MapError};
use crate::mesh::Surface;
use crate::vector::Vector3;

/// A sparse matrix in compressed columns, both triangles where it is symmetric.
#[derive(Debug, Clone, PartialEq)]
pub struct SparseColumns {
    /// The entries, column by column.
    pub data: Array1<f64>,
    /// The row of each entry, ascending in a column.
    pub indices: Array1<usize>,
    /// Where the entries of each column start, and their number.
    pub indptr: Array1<usize>,
}

/// Hessian of the stretch energy of the map `image` (n, 3) into space, by its 3n coordinates: x of all vertices, then
/// y, then z.
///
/// `density` (m,) is a positive target measure of each face on any scale; the face areas where `None`. Targets are
/// rescaled so that they sum to the image's area. Translations are in the kernel.
///
/// # Errors
/// A surface that is no oriented manifold, arrays of another shape, coordinates that are not finite, a density that is
/// not positive, an image whose faces have no area or areas that over- or underflow.
///
/// ```
/// use authalic::{Surface, stretch_hessian};
/// use ndarray::array;
///
/// let vertices = array![[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]];
/// let surface = Surface::new(&vertices, array![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])?;
/// let hessian = stretch_hessian(&surface, vertices.view(), None)?;
/// assert_eq!(hessian.indptr.len(), 3 * 4 + 1);
/// # Ok::<(), authalic::Error>(())
/// ```
pub fn stretch_hessian(
    surface: &Surface,
    image: ArrayView2<'_, f64>,
    density: Option<ArrayView1<'_, f64>>,
) -> Result<SparseColumns, Error> {
    // 1. The arguments
    let image = rows_of::<3, _>("image", image)?;
    if image.len() != surface.n_vertices() {
        let expected = format!("of shape ({}, 3), one row per vertex", surface.n_vertices());
        return Err(Error::InvalidArray {
            name: "image",
            found: format!("of {} rows", image.len()),
            expected,
        });
    }
    let mesh = surface.mesh()?;
    let map: Vec<Vector3> = image.iter().copied().map(Vector3).collect();
    let not_finite = (0..map.len()).filter(|&vertex| !map[vertex].is_finite());
    if let Some(vertices) = Elements::collect(not_finite) {
        return Err(MapError::NonFinite { name: "image", vertices }.into());
    }
    let targets = targets(density, mesh.face_areas())?;
    // 2. The matrix
    let energy = SpatialStretchEnergy::new(mesh, &targets);
    let hessian = energy.hessian(&map);
    if !hessian.data().iter().all(|value| value.is_finite()) {
        return Err(Error::InvalidArray {
            name: "image",
            found: format!("of area {:e}", energy.value(&map).area),
            expected: "a map whose faces have area, neither huge nor tiny".into(),
        });
    }
    let (indptr, indices, data) = hessian.into_raw_storage();
    Ok(SparseColumns { data: data.into(), indices: indices.into(), indptr: indptr.into() })
}
