// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a result was computed from: the function, its options, and the fingerprints of its surfaces.

use std::sync::Arc;

use numpy::ndarray::ArrayView2;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use sha2::{Digest, Sha256};

/// Where a result comes from.
pub enum Origin {
    /// From a call of this process.
    Call(Call),
    /// From a file or a pickle.
    Saved(Py<PyDict>),
}

/// A call: the function, its options and the surfaces that it was given.
#[derive(Clone)]
pub struct Call {
    pub function: &'static str,
    pub options: Options,
    pub inputs: Vec<(&'static str, Fingerprint)>,
}

/// The options of a call as plain data.
#[derive(Clone)]
pub struct Options(Arc<Py<PyAny>>);

/// The SHA-256 of a surface, and its size.
#[derive(Clone)]
pub struct Fingerprint {
    sha256: String,
    n_vertices: usize,
    n_faces: usize,
}

impl Call {
    /// A call with one surface.
    pub fn new(function: &'static str, options: &Options, name: &'static str, input: Fingerprint) -> Self {
        Self { function, options: options.clone(), inputs: vec![(name, input)] }
    }
}

impl From<Call> for Option<Origin> {
    fn from(call: Call) -> Self {
        Some(Origin::Call(call))
    }
}

impl Origin {
    /// A dictionary of its own for Python.
    pub fn dictionary(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        let package = py.import(intern!(py, "authalic._provenance"))?;
        Ok(match self {
            Self::Saved(dictionary) => package.call_method1(intern!(py, "copied"), (dictionary,))?,
            Self::Call(call) => {
                let inputs = PyDict::new(py);
                for (name, input) in &call.inputs {
                    inputs.set_item(name, (&input.sha256, input.n_vertices, input.n_faces))?;
                }
                let options = call.options.0.clone_ref(py);
                package.call_method1(intern!(py, "described"), (call.function, options, inputs))?
            }
        }
        .unbind())
    }

    /// The same once more.
    pub fn again(&self, py: Python<'_>) -> Self {
        match self {
            Self::Call(call) => Self::Call(call.clone()),
            Self::Saved(dictionary) => Self::Saved(dictionary.clone_ref(py)),
        }
    }
}

impl Options {
    /// Options by name; arrays become their shapes and SHA-256, now, before their owner can write to them.
    pub fn new<'py>(
        py: Python<'py>,
        named: impl IntoIterator<Item = (&'static str, PyResult<Py<PyAny>>)>,
    ) -> PyResult<Self> {
        let options = PyDict::new(py);
        for (name, value) in named {
            options.set_item(name, value?)?;
        }
        let package = py.import(intern!(py, "authalic._provenance"))?;
        Ok(Self(Arc::new(package.call_method1(intern!(py, "plain"), (options,))?.unbind())))
    }
}

/// The options of the names of some variables, or of names with values.
macro_rules! options {
    (@value $name:ident) => { $name };
    (@value $name:ident $value:expr) => { $value };
    ($py:expr; $($name:ident $(= $value:expr)?),* $(,)?) => {
        crate::provenance::Options::new(
            $py,
            [$((
                stringify!($name),
                pyo3::IntoPyObjectExt::into_py_any(crate::provenance::options!(@value $name $($value)?), $py),
            )),*],
        )
    };
}
pub(crate) use options;

/// The fingerprint of a surface.
pub fn fingerprint(surface: &authalic::Surface) -> Fingerprint {
    fingerprint_of(surface.vertices(), surface.faces().view())
}

/// The fingerprint of arrays: the SHA-256 of the vertices as little-endian float64, followed by the faces as
/// little-endian int64, both row by row.
pub fn fingerprint_of(vertices: ArrayView2<'_, f64>, faces: ArrayView2<'_, u32>) -> Fingerprint {
    let mut hasher = Sha256::new();
    let mut bytes = Vec::with_capacity(1 << 16);
    let mut feed = |word: [u8; 8]| {
        bytes.extend_from_slice(&word);
        if bytes.len() >= 1 << 16 {
            hasher.update(&bytes);
            bytes.clear();
        }
    };
    vertices.iter().for_each(|x| feed(x.to_le_bytes()));
    faces.iter().for_each(|&vertex| feed(i64::from(vertex).to_le_bytes()));
    hasher.update(&bytes);
    let sha256 = hasher.finalize().iter().map(|byte| format!("{byte:02x}")).collect();
    Fingerprint { sha256, n_vertices: vertices.nrows(), n_faces: faces.nrows() }
}
