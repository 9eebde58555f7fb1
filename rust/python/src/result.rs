// SPDX-License-Identifier: MIT OR Apache-2.0
//! What all results have in common: they are compared, copied, pickled, saved and shown by their attributes.

use pyo3::PyClass;
use pyo3::exceptions::PyValueError;
use pyo3::impl_::pyclass::PyClassBaseType;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::provenance::Origin;

/// The base of all results: they never change, and can be compared, pickled, copied and saved.
///
/// Results are equal (`==`) if all their arrays and figures are, except for the time that they took. `copy.copy` and
/// `copy.deepcopy` return the result itself, since nothing of it can change; the arrays are read-only.
#[pyclass(frozen, subclass, name = "Result", module = "authalic")]
pub struct ResultBase {
    origin: Option<Origin>,
}

/// A result that can be made again from its attributes.
pub trait Restorable: Sized {
    /// The attributes that make the result, those that begin with an underscore are for this alone.
    const FIELDS: &'static [&'static str];

    /// The result of such attributes.
    fn restored(state: &State<'_>) -> PyResult<Self>;
}

/// The attributes of a result by name.
pub struct State<'py>(pub Bound<'py, PyDict>);

impl<'py> State<'py> {
    pub fn py(&self) -> Python<'py> {
        self.0.py()
    }

    /// The attribute, as an object.
    pub fn object(&self, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let missing = || PyValueError::new_err(format!("the saved result has no {name}"));
        self.0.get_item(name)?.ok_or_else(missing)
    }

    /// The attribute as a value of a type of its own.
    pub fn get<T>(&self, name: &str) -> PyResult<T>
    where
        T: for<'a> FromPyObject<'a, 'py>,
    {
        let object = self.object(name)?;
        object.extract().map_err(|error: <T as FromPyObject<'_, 'py>>::Error| {
            let error: PyErr = error.into();
            PyValueError::new_err(format!("the saved result has a wrong {name}: {error}"))
        })
    }

    /// The attribute as a value, of a file that may be older than the attribute.
    pub fn optional<T>(&self, name: &str) -> PyResult<Option<T>>
    where
        T: for<'a> FromPyObject<'a, 'py>,
    {
        if self.0.contains(name)? { self.get(name) } else { Ok(None) }
    }

    /// The attribute `status`.
    pub fn status(&self) -> PyResult<&'static str> {
        let word: String = self.get("status")?;
        let known = ["converged", "max_iterations", "stalled", "cancelled", "landmarks_missed"];
        known
            .into_iter()
            .find(|known| *known == word)
            .ok_or_else(|| PyValueError::new_err(format!("the saved result has the unknown status {word:?}")))
    }
}

/// Makes a class restorable whose fields are its attributes. A field `status` comes first.
macro_rules! restorable {
    ($Class:ident { status, $($field:ident),* }) => {
        impl crate::result::Restorable for $Class {
            const FIELDS: &'static [&'static str] = &["status", $(stringify!($field)),*];

            fn restored(state: &crate::result::State<'_>) -> pyo3::PyResult<Self> {
                Ok(Self { status: state.status()?, $($field: state.get(stringify!($field))?),* })
            }
        }
    };
    ($Class:ident { $($field:ident),* }) => {
        impl crate::result::Restorable for $Class {
            const FIELDS: &'static [&'static str] = &[$(stringify!($field)),*];

            fn restored(state: &crate::result::State<'_>) -> pyo3::PyResult<Self> {
                Ok(Self { $($field: state.get(stringify!($field))?),* })
            }
        }
    };
}
pub(crate) use restorable;

/// A new result for Python.
pub fn made<T>(py: Python<'_>, value: T, origin: Option<Origin>) -> PyResult<Py<T>>
where
    T: PyClass<BaseType = ResultBase>,
    ResultBase: PyClassBaseType<Initializer = PyClassInitializer<ResultBase>>,
{
    Py::new(py, PyClassInitializer::from(ResultBase { origin }).add_subclass(value))
}

impl ResultBase {
    /// The base of a result that nothing is known of.
    pub fn of_unknown_origin() -> Self {
        Self { origin: None }
    }

    pub fn origin(&self) -> Option<&Origin> {
        self.origin.as_ref()
    }
}

/// Calls a function of the package's Python part.
fn call<'py, A>(py: Python<'py>, module: &str, function: &str, arguments: A) -> PyResult<Bound<'py, PyAny>>
where
    A: pyo3::call::PyCallArgs<'py>,
{
    py.import(module)?.getattr(function)?.call1(arguments)
}

#[pymethods]
impl ResultBase {
    /// What the result was computed from: a dict, or None for a part of a result, and for surfaces.
    ///
    /// It has the name of the `function`, its `options`, the SHA-256 of each surface among its `inputs`, and the
    /// versions of `authalic`, `numpy`, `python` and the `platform`. Arrays among the options stand as their shape,
    /// dtype and SHA-256.
    #[getter]
    fn provenance(&self, py: Python<'_>) -> PyResult<Option<Py<PyAny>>> {
        self.origin.as_ref().map(|origin| origin.dictionary(py)).transpose()
    }

    /// Saves the result to a file, from which `authalic.load` makes it again.
    ///
    /// This version reads the file, and so do later ones.
    ///
    /// The format is numpy's npz: `numpy.load` reads the arrays too, by the names of the attributes. The file is written
    /// beside its place and moved there at the end.
    ///
    /// Parameters
    /// ----------
    /// path : str or path-like
    ///     The file to write; by convention it ends in ".npz". An older file is replaced.
    ///
    /// Examples
    /// --------
    /// >>> import authalic, os, tempfile
    /// >>> square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    /// >>> result = authalic.disk_map(square, [[0, 1, 2], [0, 2, 3]])
    /// >>> file = os.path.join(tempfile.mkdtemp(), "square.npz")
    /// >>> result.save(file)
    /// >>> authalic.load(file) == result
    /// True
    fn save(slf: &Bound<'_, Self>, path: &Bound<'_, PyAny>) -> PyResult<()> {
        call(slf.py(), "authalic._files", "save", (slf, path)).map(|_| ())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        call(slf.py(), "authalic._objects", "reduced", (slf,))
    }

    fn __copy__<'py>(slf: &Bound<'py, Self>) -> Bound<'py, Self> {
        slf.clone()
    }

    fn __deepcopy__<'py>(slf: &Bound<'py, Self>, _memo: &Bound<'py, PyAny>) -> Bound<'py, Self> {
        slf.clone()
    }

    fn __eq__(slf: &Bound<'_, Self>, other: &Bound<'_, PyAny>) -> PyResult<bool> {
        call(slf.py(), "authalic._objects", "equal", (slf, other))?.extract()
    }

    fn __hash__(slf: &Bound<'_, Self>) -> PyResult<isize> {
        call(slf.py(), "authalic._objects", "hashed", (slf,))?.extract()
    }

    fn _repr_html_(slf: &Bound<'_, Self>) -> PyResult<String> {
        call(slf.py(), "authalic._pictures", "html", (slf,))?.extract()
    }
}
