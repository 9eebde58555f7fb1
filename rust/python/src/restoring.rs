// SPDX-License-Identifier: MIT OR Apache-2.0
//! Results taken apart into their attributes, and made again, by the names of their classes.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::disk::DiskMap;
use crate::distortion::Distortion;
use crate::layout::Layout;
use crate::packing::Packing;
use crate::provenance::Origin;
use crate::registration::{Certificates, Registration, Strain};
use crate::repair::Repaired;
use crate::result::{Restorable, State, made};
use crate::seams::{Seams, Unwrap};
use crate::sphere::{Refinement, SphereMap};
use crate::structure::{HyperbolicStructure, Pants};
use crate::surface::{Patch, Surface};
use crate::untangle::Untangled;

/// The functions by which the package's Python part takes results apart and makes them again.
macro_rules! kinds {
    ($($Class:ident),* $(,)?) => {
        /// The names of the attributes that make a result of a class.
        #[pyfunction]
        pub fn _fields(py: Python<'_>, kind: &str) -> PyResult<Py<PyTuple>> {
            let names = match kind {
                $(stringify!($Class) => <$Class as Restorable>::FIELDS,)*
                unknown => return Err(unknown_kind(unknown)),
            };
            Ok(PyTuple::new(py, names)?.unbind())
        }

        /// A result of a class, made of its attributes, and of what it was computed from.
        #[pyfunction]
        pub fn _restored(
            kind: &str,
            state: &Bound<'_, PyDict>,
            provenance: Option<Py<PyDict>>,
        ) -> PyResult<Py<PyAny>> {
            let (py, origin) = (state.py(), provenance.map(Origin::Saved));
            let state = State(state.clone());
            match kind {
                $(stringify!($Class) => Ok(made(py, <$Class as Restorable>::restored(&state)?, origin)?.into_any()),)*
                unknown => Err(unknown_kind(unknown)),
            }
        }
    };
}

fn unknown_kind(kind: &str) -> PyErr {
    PyValueError::new_err(format!(
        "there is no class of results {kind:?}: a later version of authalic may have it"
    ))
}

kinds! {
    Surface,
    Patch,
    Distortion,
    DiskMap,
    SphereMap,
    Refinement,
    Layout,
    Registration,
    Repaired,
    Strain,
    Certificates,
    HyperbolicStructure,
    Pants,
    Untangled,
    Seams,
    Unwrap,
    Packing,
}
