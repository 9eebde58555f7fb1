// SPDX-License-Identifier: MIT OR Apache-2.0
//! Surfaces and landmark curves as arguments of a registration.

use authalic::{Error, Side};
use pyo3::prelude::*;

use crate::errors::bad_array;
use crate::indices::index_list;
use crate::surface::Given;

/// The names of the source, its vertices and its faces in messages.
pub(super) const SOURCE: [&str; 3] = ["source", "source vertices", "source faces"];
/// The names of the target, its vertices and its faces in messages.
pub(super) const TARGET: [&str; 3] = ["target", "target vertices", "target faces"];

/// The surface, checked to be a manifold; an error carries the side.
pub(super) fn checked(given: Given, side: Side) -> Result<authalic::Surface, Error> {
    let surface = given.surface().map_err(|error| error.of_surface(side))?;
    surface.topology().map_err(|error| error.of_surface(side))?;
    Ok(surface)
}

/// Paths of vertices, one per curve.
pub(crate) fn vertex_paths(
    object: &Bound<'_, PyAny>,
    name: &'static str,
    n_vertices: usize,
) -> PyResult<Vec<Vec<usize>>> {
    let Ok(paths) = object.try_iter() else {
        let found = object.get_type().name()?.to_string();
        return Err(bad_array(object.py(), name, found, "a list of arrays of vertex indices".into()));
    };
    let path = |(curve, path): (usize, PyResult<Bound<'_, PyAny>>)| {
        let path = path?;
        index_list(&path, &format!("{name}: curve {curve}"), "place", n_vertices)
            .map_err(|error| of_curve(path.py(), error, curve))
    };
    paths.enumerate().map(path).collect()
}

/// The error, with the curve that it is about.
fn of_curve(py: Python<'_>, error: PyErr, curve: usize) -> PyErr {
    match error.value(py).setattr("curve", curve) {
        Ok(()) => error,
        Err(failure) => failure,
    }
}
