// SPDX-License-Identifier: MIT OR Apache-2.0
//! Bindings of `authalic::mesh`.

use authalic::mesh;
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;

use crate::arrays::{from_index_list, from_indices, from_points, indices, points};
use crate::run::run;

/// One piece of a cut mesh (an island), with maps back to the input.
#[pyclass(frozen, get_all, module = "authalic")]
pub struct Patch {
    /// (n, 3) float64: the vertices, copies of input vertices.
    vertices: Py<PyArray2<f64>>,
    /// (m, 3) int64: the faces, in the order, winding and corner order of the input.
    faces: Py<PyArray2<i64>>,
    /// (n,) int64: the input vertex of each vertex.
    vertex_of: Py<PyArray1<i64>>,
    /// (m, 3) int64: the input corner, 3 × face + corner, of each corner.
    corner_of: Py<PyArray2<i64>>,
    /// (m,) int64: the input face of each face.
    face_of: Py<PyArray1<i64>>,
    /// Vertices − edges + faces.
    euler_characteristic: i64,
    /// The number of handles; None where the patch is not orientable.
    genus: Option<usize>,
    /// List of (k,) int64: the boundary loops as patch vertices, the longest first, the surface on the left.
    boundary_loops: Vec<Py<PyArray1<i64>>>,
    /// Whether the patch is a topological disk.
    is_disk: bool,
    /// Whether the patch has no boundary.
    is_closed: bool,
}

impl Patch {
    fn new(py: Python<'_>, patch: &mesh::Patch) -> Self {
        let list = |values: &[u32]| from_index_list(py, values.iter().map(|&i| i as usize));
        Self {
            vertices: from_points(py, &patch.vertices),
            faces: from_indices(py, &patch.faces),
            vertex_of: list(&patch.vertex_of),
            corner_of: from_indices(py, &patch.corner_of),
            face_of: from_index_list(py, patch.corner_of.iter().map(|corners| corners[0] as usize / 3)),
            euler_characteristic: patch.topology.euler_characteristic,
            genus: patch.topology.genus,
            boundary_loops: patch.topology.boundary_loops.iter().map(|vertices| list(vertices)).collect(),
            is_disk: patch.is_disk(),
            is_closed: patch.is_closed(),
        }
    }
}

#[pymethods]
impl Patch {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!(
            "Patch({} vertices, {} faces, {} boundary loops, Euler characteristic {})",
            self.vertices.bind(py).len()?,
            self.faces.bind(py).len()?,
            self.boundary_loops.len(),
            self.euler_characteristic,
        ))
    }
}

/// Cuts a mesh along seams into its patches (islands).
///
/// Corners of neighbouring faces become one vertex wherever the faces meet in an edge that is no seam.
/// Edges of three or more faces act as seams, parts that only touch in a vertex come apart. A seam that
/// does not separate still opens the surface; a single edge inside the surface opens nothing, because both
/// sides keep both of its ends.
///
/// Parameters
/// ----------
/// vertices : (n, 3) real array
///     Positions, any unit.
/// faces : (m, 3) integer array
///     Triangles as vertex indices.
/// seams : (k, 2) integer array, optional
///     Edges to cut, each as its two vertices. Without seams the patches are the connected components.
///
/// Returns
/// -------
/// list of Patch
///     In the order of their lowest faces.
///
/// Raises
/// ------
/// MeshError
///     Empty arrays, NaN, indices out of range, faces that repeat a vertex, seams that are no edges.
///
/// Examples
/// --------
/// >>> import authalic
/// >>> square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
/// >>> [len(patch.faces) for patch in authalic.cut(square, [[0, 1, 2], [0, 2, 3]], seams=[[0, 2]])]
/// [1, 1]
#[pyfunction]
#[pyo3(signature = (vertices, faces, *, seams=None))]
pub fn cut(
    py: Python<'_>,
    vertices: &Bound<'_, PyAny>,
    faces: &Bound<'_, PyAny>,
    seams: Option<&Bound<'_, PyAny>>,
) -> PyResult<Vec<Patch>> {
    let vertices = points::<3>(vertices, "vertices")?;
    let faces = indices::<3>(faces, "faces", vertices.len())?;
    let seams = seams.map_or(Ok(Vec::new()), |seams| indices::<2>(seams, "seams", vertices.len()))?;
    let patches = run(py, None, move |_| mesh::cut(&vertices, &faces, &seams))?;
    Ok(patches.iter().map(|patch| Patch::new(py, patch)).collect())
}
