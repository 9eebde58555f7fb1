// SPDX-License-Identifier: MIT OR Apache-2.0
//! Meshes of other libraries, known by their attributes, so that none of them need be installed.
//!
//! trimesh and Open3D have `vertices`, with `faces` or `triangles`; pyvista has `points` and `faces` in VTK's layout,
//! meshio and pyvista's grids `points` and `cells_dict`.

use numpy::ndarray::{Array2, ArrayView1};
use numpy::{IntoPyArray, PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::prelude::*;

use crate::arrays::{as_array, converted};
use crate::errors::bad_array;

/// VTK's number of a triangle among the kinds of cells.
const VTK_TRIANGLE: usize = 5;

/// Cells with an area that are no triangles, as meshio and VTK name them.
const OTHER_NAMES: [&str; 3] = ["quad", "polygon", "triangle6"];
const OTHER_NUMBERS: [usize; 5] = [6, 7, 8, 9, 22];

/// The vertices and faces of a mesh object; `None` for any other object.
pub fn mesh_parts<'py>(
    object: &Bound<'py, PyAny>,
) -> PyResult<Option<(Bound<'py, PyAny>, Bound<'py, PyAny>)>> {
    let of = |name: &str| object.getattr_opt(name).ok().flatten();
    if let Some(vertices) = of("vertices") {
        let faces = of("faces").or_else(|| of("triangles"));
        return Ok(faces.map(|faces| (vertices, faces)));
    }
    let Some(points) = of("points") else { return Ok(None) };
    if let Some(cells) = of("cells_dict") {
        return Ok(Some((points, triangles(&cells)?)));
    }
    of("faces").map(|faces| Ok((points, vtk_faces(&faces)?))).transpose()
}

/// The triangles among cells by kind.
fn triangles<'py>(cells: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    let has = |kind: &Bound<'py, PyAny>| cells.contains(kind).unwrap_or(false);
    let key = |name: &str| name.into_pyobject(cells.py()).map(Bound::into_any);
    let number = |kind: usize| kind.into_pyobject(cells.py()).map(Bound::into_any);
    let mut others = Vec::new();
    for name in OTHER_NAMES {
        others.push(key(name)?);
    }
    for kind in OTHER_NUMBERS {
        others.push(number(kind)?);
    }
    if others.iter().any(has) {
        return Err(no_triangles(cells.py(), "with cells of other than three corners"));
    }
    for kind in [key("triangle")?, number(VTK_TRIANGLE)?] {
        if has(&kind) {
            return cells.get_item(kind);
        }
    }
    Err(no_triangles(cells.py(), "without a triangle"))
}

/// Faces in VTK's layout, 3, a, b, c, 3, d, e, f, …, or as rows, as (m, 3).
fn vtk_faces<'py>(faces: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    let given = as_array(faces, "faces")?;
    if matches!(given.shape(), [_, 3]) {
        return Ok(given.into_any());
    }
    let cells: PyReadonlyArrayDyn<'_, i64> = converted(&given, "faces", "int64", "iu", "integers")?;
    let flat = cells.as_slice()?;
    if !is_vtk(flat.into()) {
        return Err(no_triangles(faces.py(), "with faces of other than three corners"));
    }
    let triangles = Array2::from_shape_fn((flat.len() / 4, 3), |(face, corner)| flat[4 * face + 1 + corner]);
    Ok(triangles.into_pyarray(faces.py()).into_any())
}

/// Whether numbers are triangles in VTK's layout.
pub fn is_vtk(flat: ArrayView1<'_, i64>) -> bool {
    flat.len().is_multiple_of(4) && flat.iter().step_by(4).all(|&length| length == 3)
}

fn no_triangles(py: Python<'_>, found: &str) -> PyErr {
    bad_array(py, "the mesh", found.into(), "of triangles, as its triangulate() makes it".into())
}
