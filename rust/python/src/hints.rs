// SPDX-License-Identifier: MIT OR Apache-2.0
//! Arrays that are nearly vertices and faces, refused with a hint of what to do.

use numpy::{PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::prelude::*;

use crate::arrays::{as_array, converted, kind, shape_words};
use crate::errors::bad_array;
use crate::mesh_objects::is_vtk;

/// Refuses points of the plane, with a hint.
pub fn refuse_plane(vertices: &Bound<'_, PyAny>, name: &str) -> PyResult<()> {
    let &[n, 2] = as_array(vertices, name)?.shape() else { return Ok(()) };
    let found = format!("of shape ({n}, 2); for a flat surface take Surface(vertices, faces, flat=True)");
    Err(bad_array(vertices.py(), name, found, "of shape (n, 3)".into()))
}

/// Refuses faces in VTK's layout, and quads, with a hint.
pub fn refuse_vtk(faces: &Bound<'_, PyAny>, name: &str) -> PyResult<()> {
    let array = as_array(faces, name)?;
    if matches!(array.shape(), [_, 3]) || !["i", "u"].contains(&&*kind(&array)?) {
        return Ok(());
    }
    let numbers: PyReadonlyArrayDyn<'_, i64> = converted(&array, name, "int64", "iu", "integers")?;
    let hint = match array.shape() {
        [_, 4] | [_] if is_vtk(numbers.as_slice()?.into()) && !numbers.is_empty() => {
            format!("in VTK's layout: take np.reshape({name}, (-1, 4))[:, 1:]")
        }
        [_, 4] => "quads: split each into two triangles".into(),
        _ => return Ok(()),
    };
    let found = format!("{}, {hint}", shape_words(array.shape()));
    Err(bad_array(faces.py(), name, found, "of shape (m, 3)".into()))
}
