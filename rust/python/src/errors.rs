// SPDX-License-Identifier: MIT OR Apache-2.0
//! The two exceptions of the package, the errors that become them, and the facts that exceptions and warnings carry.

use authalic::{CurveError, Elements, Error, ErrorKind, LandmarkError, Side, Warning, WarningKind};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyAnyMethods, PyDict, PyTuple, PyType};
use pyo3::{create_exception, intern};

create_exception!(
    authalic,
    MeshError,
    PyValueError,
    "Bad input: the message says what is wrong, where, and what to do.

The attributes hold the facts of the message, which may be reworded. A ValueError about an option has them too,
with the kind \"invalid_option\".

Attributes
----------
kind : str
    One of the kinds below, which are also in `ERROR_KINDS`; it says what the indices number.
side : \"source\", \"target\" or None
    The surface at fault, if it is one of two.
curve : int or None
    The landmark curve at fault, or the first of two.
second_curve : int or None
    The second of two curves at fault.
indices : tuple of int, or of pairs of int
    The first few elements at fault, an edge as a pair of vertices.
count : int
    The number of elements at fault."
);
create_exception!(
    authalic,
    SolverError,
    PyRuntimeError,
    "The numerics failed on good input, or a run was cancelled before there was a map.

It carries `kind`, `side`, `curve`, `second_curve`, `indices` and `count` as MeshError does."
);

/// Adds the exceptions and the closed lists of kinds to the module.
pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    let of_errors = ErrorKind::ALL.iter().map(|kind| (kind.as_str(), kind.meaning()));
    let of_warnings = WarningKind::ALL.iter().map(|kind| (kind.as_str(), kind.meaning()));
    module.add("ERROR_KINDS", dictionary(py, of_errors)?)?;
    module.add("WARNING_KINDS", dictionary(py, of_warnings)?)?;
    let mesh_error = py.get_type::<MeshError>();
    list_kinds(&mesh_error)?;
    module.add("MeshError", mesh_error)?;
    module.add("SolverError", py.get_type::<SolverError>())
}

/// Appends the closed list of kinds to the documentation of a class.
fn list_kinds(class: &Bound<'_, PyType>) -> PyResult<()> {
    let name = intern!(class.py(), "__doc__");
    let mut text: String = class.getattr(name)?.extract()?;
    text.push_str("\n\nNotes\n-----\nThe kinds are:\n\n");
    for kind in ErrorKind::ALL {
        text.push_str(&format!("{}\n    {}\n", kind.as_str(), kind.meaning()));
    }
    class.setattr(name, text)
}

fn dictionary<'py>(
    py: Python<'py>,
    meanings: impl Iterator<Item = (&'static str, &'static str)>,
) -> PyResult<Bound<'py, PyDict>> {
    let dictionary = PyDict::new(py);
    meanings.into_iter().try_for_each(|(word, meaning)| dictionary.set_item(word, meaning))?;
    Ok(dictionary)
}

/// `MeshError` for bad meshes and arrays, plain `ValueError` for bad options, `SolverError` for failed numerics.
pub fn to_python(py: Python<'_>, error: &Error) -> PyErr {
    let message = in_python_words(error);
    let raised = match error {
        Error::InvalidOption { .. } => PyValueError::new_err(message),
        error if error.is_mesh_error() => MeshError::new_err(message),
        _ => SolverError::new_err(message),
    };
    let facts = Facts {
        kind: error.kind().as_str(),
        side: error.side(),
        curve: error.curve(),
        second_curve: error.second_curve(),
        elements: error.elements(),
    };
    with_facts(py, raised, &facts)
}

/// The message of an error, with the argument of Python that avoids it.
fn in_python_words(error: &Error) -> String {
    let hint = match error {
        error if error.is_mended_by_repair() => Some("authalic.repair mends this"),
        Error::Mesh(inner) => hint(inner),
        Error::OfSurface { error: inner, .. } => match &**inner {
            Error::Mesh(
                authalic::MeshError::OpenSurface { coincident: 0, .. }
                | authalic::MeshError::SeveralBoundaries { .. },
            ) => Some("fill_holes=True fills them for the time of the call"),
            Error::Mesh(inner) => hint(inner),
            _ => None,
        },
        Error::Curves(CurveError::LoopCounts { .. } | CurveError::LoopSides { .. }) => {
            Some("fill_holes=True fills them for the time of the call")
        }
        Error::Landmarks(LandmarkError::TooFew { needed: 2, .. }) => {
            return format!("{error}, or features=, with which any number will do");
        }
        _ => None,
    };
    hint.map_or_else(|| error.to_string(), |hint| format!("{error} ({hint})"))
}

/// What mends a mesh in Python, where `repair` by itself does not.
fn hint(error: &authalic::MeshError) -> Option<&'static str> {
    use authalic::MeshError as Of;
    match error {
        Of::SeveralComponents { coincident: 1.., .. } | Of::OpenSurface { coincident: 1.., .. } => {
            Some("repair=True merges them")
        }
        Of::SeveralBoundaries { .. } | Of::OpenSurface { .. } => Some("fill_holes=True fills them"),
        Of::NoMainPiece { .. } => {
            Some("repair takes merge=distance and keep=\"largest\", cut returns the pieces")
        }
        Of::ClosedSurface { .. }
        | Of::HasHandles { .. }
        | Of::SphereHasHandles { .. }
        | Of::GenusNotZero { .. } => Some(
            "unwrap with seams=\"auto\" cuts any surface open, repair with close_handles=True closes handles",
        ),
        _ => None,
    }
}

/// A `MeshError` about an argument, without elements.
pub fn bad_array(py: Python<'_>, name: &str, found: String, expected: String) -> PyErr {
    about_argument(py, ErrorKind::InvalidArray, name, &found, &expected, None)
}

/// A `MeshError` about the rows of an argument that hold no vertex indices.
pub fn bad_indices(py: Python<'_>, name: &str, found: &str, expected: &str, rows: &Elements) -> PyErr {
    about_argument(py, ErrorKind::IndexOutOfRange, name, found, expected, Some(rows))
}

fn about_argument(
    py: Python<'_>,
    kind: ErrorKind,
    name: &str,
    found: &str,
    expected: &str,
    elements: Option<&Elements>,
) -> PyErr {
    let raised = MeshError::new_err(format!("{name} must be {expected}, but is {found}"));
    let facts = Facts { side: Side::of_argument(name), elements, ..Facts::new(kind.as_str()) };
    with_facts(py, raised, &facts)
}

/// A `ValueError` about an option.
pub fn bad_option(message: String) -> PyErr {
    Python::attach(|py| {
        with_facts(py, PyValueError::new_err(message), &Facts::new(ErrorKind::InvalidOption.as_str()))
    })
}

/// A `SolverError` about a fault of the library itself.
pub fn internal(py: Python<'_>, text: &str) -> PyErr {
    let message = format!("internal error, please report it with the mesh: {text}");
    with_facts(py, SolverError::new_err(message), &Facts::new(ErrorKind::Internal.as_str()))
}

/// A warning as a string that carries its facts.
pub fn warning(py: Python<'_>, warning: &Warning) -> PyResult<Py<PyAny>> {
    static CLASS: PyOnceLock<Py<PyType>> = PyOnceLock::new();
    let facts = Facts {
        side: warning.side(),
        curve: warning.curve(),
        elements: warning.elements(),
        ..Facts::new(warning.kind().as_str())
    };
    let facts = facts.dictionary(py)?;
    facts.set_item(intern!(py, "value"), warning.value())?;
    let class = CLASS.import(py, "authalic._warnings", "RegistrationWarning")?;
    Ok(class.call((warning.to_string(),), Some(&facts))?.unbind())
}

/// The data that an exception or a warning carries beside its message.
struct Facts<'a> {
    kind: &'static str,
    side: Option<Side>,
    curve: Option<usize>,
    second_curve: Option<usize>,
    elements: Option<&'a Elements>,
}

impl Facts<'_> {
    /// A kind alone.
    fn new(kind: &'static str) -> Self {
        Self { kind, side: None, curve: None, second_curve: None, elements: None }
    }

    fn dictionary<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dictionary = PyDict::new(py);
        dictionary.set_item(intern!(py, "kind"), self.kind)?;
        dictionary.set_item(intern!(py, "side"), self.side.map(Side::as_str))?;
        dictionary.set_item(intern!(py, "curve"), self.curve)?;
        dictionary.set_item(intern!(py, "second_curve"), self.second_curve)?;
        dictionary.set_item(intern!(py, "indices"), indices(py, self.elements)?)?;
        dictionary.set_item(intern!(py, "count"), self.elements.map_or(0, |elements| elements.count))?;
        Ok(dictionary)
    }
}

fn indices<'py>(py: Python<'py>, elements: Option<&Elements>) -> PyResult<Bound<'py, PyTuple>> {
    match elements {
        None => Ok(PyTuple::empty(py)),
        Some(elements) if elements.arity == 1 => PyTuple::new(py, &elements.first),
        Some(elements) => {
            let each = elements.first.chunks(elements.arity).map(|element| PyTuple::new(py, element));
            PyTuple::new(py, each.collect::<PyResult<Vec<_>>>()?)
        }
    }
}

/// The exception, with the facts as attributes.
fn with_facts(py: Python<'_>, raised: PyErr, facts: &Facts<'_>) -> PyErr {
    let set = |dictionary: Bound<'_, PyDict>| {
        let value = raised.value(py);
        dictionary.iter().try_for_each(|(name, fact)| value.setattr(name.cast_into()?, fact))
    };
    match facts.dictionary(py).and_then(set) {
        Ok(()) => raised,
        Err(failure) => failure,
    }
}
