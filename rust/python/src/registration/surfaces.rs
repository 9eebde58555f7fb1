// SPDX-License-Identifier: MIT OR Apache-2.0
//! The surfaces of a registration and the curves on them as arguments.

use authalic::{Error, Side};
use pyo3::prelude::*;

use crate::arrays::index_list;
use crate::errors::bad_array;
use crate::surface::Given;

/// The names of a surface, of its vertices and of its faces in messages.
pub(super) const SOURCE: [&str; 3] = ["source", "source vertices", "source faces"];
pub(super) const TARGET: [&str; 3] = ["target", "target vertices", "target faces"];

/// A surface that is a manifold; errors say which surface is at fault.
pub(super) fn checked(given: Given, side: Side) -> Result<authalic::Surface, Error> {
    let surface = given.surface().map_err(|error| error.of_surface(side))?;
    surface.topology().map_err(|error| error.of_surface(side))?;
    Ok(surface)
}

/// Vertex paths.
pub(crate) fn vertex_paths(
    object: &Bound<'_, PyAny>,
    name: &'static str,
    n_vertices: usize,
) -> PyResult<Vec<Vec<usize>>> {
    let Ok(parts) = object.try_iter() else {
        let found = object.get_type().name()?.to_string();
        return Err(bad_array(object.py(), name, found, "a list of arrays of vertex indices".into()));
    };
    let path = |(curve, part): (usize, PyResult<Bound<'_, PyAny>>)| {
        let part = part?;
        index_list(&part, &format!("{name}: curve {curve}"), "place", n_vertices)
            .map_err(|error| of_curve(part.py(), error, curve))
    };
    parts.enumerate().map(path).collect()
}

/// The error with the curve that it is about.
fn of_curve(py: Python<'_>, error: PyErr, curve: usize) -> PyErr {
    match error.value(py).setattr("curve", curve) {
        Ok(()) => error,
        Err(failure) => failure,
    }
}
