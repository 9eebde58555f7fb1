// SPDX-License-Identifier: MIT OR Apache-2.0
//! The two exceptions of the package, and what becomes which.

use authalic::Error;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use pyo3::{create_exception, types::PyAnyMethods};

create_exception!(
    authalic,
    MeshError,
    PyValueError,
    "Bad input: says what is wrong, where and what to do.\n\n`indices` holds the first few elements at fault (an edge as a pair of vertices), `count` how many there are."
);
create_exception!(
    authalic,
    SolverError,
    PyRuntimeError,
    "The numerics failed on good input.\n\n`indices` and `count` as for MeshError."
);

/// Bad meshes and arrays are `MeshError`, bad options plain `ValueError`, failed numerics `SolverError`.
pub fn to_python(py: Python<'_>, error: &Error) -> PyErr {
    let message = error.to_string();
    let raised = match error {
        Error::InvalidOption { .. } => return PyValueError::new_err(message),
        error if error.is_mesh_error() => MeshError::new_err(message),
        _ => SolverError::new_err(message),
    };
    match name_elements(py, &raised, error) {
        Ok(()) => raised,
        Err(failure) => failure,
    }
}

/// Sets `indices` and `count` on the exception.
fn name_elements(py: Python<'_>, raised: &PyErr, error: &Error) -> PyResult<()> {
    let value = raised.value(py);
    let Some(elements) = error.elements() else {
        value.setattr("indices", PyTuple::empty(py))?;
        return value.setattr("count", 0);
    };
    let indices = match elements.arity {
        1 => PyTuple::new(py, &elements.first)?,
        arity => PyTuple::new(
            py,
            elements.first.chunks(arity).map(|e| PyTuple::new(py, e)).collect::<PyResult<Vec<_>>>()?,
        )?,
    };
    value.setattr("indices", indices)?;
    value.setattr("count", elements.count)
}

/// A `MeshError` about an argument, without elements.
pub fn bad_array(py: Python<'_>, name: &'static str, found: String, expected: String) -> PyErr {
    to_python(py, &Error::InvalidArray { name, found, expected })
}
