// SPDX-License-Identifier: MIT OR Apache-2.0
//! Arrays in and out: any real dtype and memory layout in, C-contiguous float64 and int64 out.

use authalic::Elements;
use numpy::ndarray::{Array, Array1, Array2, ArrayView, Dimension};
use numpy::{
    Element, IntoPyArray, PyArray, PyArray1, PyArray2, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn,
    PyUntypedArray, PyUntypedArrayMethods,
};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::errors::{bad_array, bad_indices};

/// An (n, 2) or (n, 3) array for Python.
pub type Reals = Py<PyArray2<f64>>;

/// Real numbers of shape (n, N).
pub fn real_table<const N: usize>(object: &Bound<'_, PyAny>, name: &str) -> PyResult<Array2<f64>> {
    table::<f64, N>(object, name, "float64", "iufb", "real numbers")
}

/// The image of a map: real numbers of shape (n, 2) or (n, 3).
pub fn image(object: &Bound<'_, PyAny>) -> PyResult<Array2<f64>> {
    let name = "image";
    match as_array(object, name)?.shape() {
        [_, 2] => real_table::<2>(object, name),
        [_, _] => real_table::<3>(object, name),
        shape => Err(bad_array(object.py(), name, shape_words(shape), "of shape (n, 2) or (n, 3)".into())),
    }
}

/// One real number per face, of shape (m,).
pub fn reals(object: &Bound<'_, PyAny>, name: &str) -> PyResult<Array1<f64>> {
    let array: PyReadonlyArrayDyn<'_, f64> = converted(object, name, "float64", "iufb", "real numbers")?;
    array.as_array().into_dimensionality().map(|values| values.into_owned()).map_err(|_| {
        let found = shape_words(array.shape());
        bad_array(object.py(), name, found, "of shape (m,), one value per face".into())
    })
}

/// Faces or seams: vertex indices of shape (n, N). Whole reals are accepted.
pub fn index_table<const N: usize>(
    object: &Bound<'_, PyAny>,
    name: &str,
    n_vertices: usize,
) -> PyResult<Array2<u32>> {
    narrow(object.py(), name, "row", &integers::<N>(object, name)?, n_vertices)
}

/// Vertex indices of shape (k,); `noun` names an entry in messages.
pub fn index_list(
    object: &Bound<'_, PyAny>,
    name: &str,
    noun: &str,
    n_vertices: usize,
) -> PyResult<Vec<usize>> {
    let column = integer_column(object, name, "of shape (k,), vertex indices")?;
    let narrowed = narrow(object.py(), name, noun, &column, n_vertices)?;
    Ok(narrowed.iter().map(|&vertex| vertex as usize).collect())
}

/// Labels of faces: integers of shape (m,).
pub fn labels(object: &Bound<'_, PyAny>, name: &'static str) -> PyResult<Vec<i64>> {
    Ok(integer_column(object, name, "of shape (m,), one number per face")?.into_iter().collect())
}

/// The indices of vertices that are given as indices, or as one truth value per vertex.
pub fn vertex_set(object: &Bound<'_, PyAny>, name: &'static str, n_vertices: usize) -> PyResult<Vec<usize>> {
    let py = object.py();
    let array = as_array(object, name)?;
    if kind(&array)? != "b" {
        return index_list(object, name, "entry", n_vertices);
    }
    if array.shape() != [n_vertices] {
        let expected = format!("of shape ({n_vertices},), one truth value per vertex, or of indices");
        return Err(bad_array(py, name, shape_words(array.shape()), expected));
    }
    let numpy = py.import(intern!(py, "numpy"))?;
    let indices = numpy.call_method1(intern!(py, "flatnonzero"), (array,))?;
    index_list(&indices, name, "entry", n_vertices)
}

/// Data of any kind and shape.
pub struct Values<'py> {
    array: Bound<'py, PyUntypedArray>,
    name: &'static str,
}

impl<'py> Values<'py> {
    pub fn new(object: &Bound<'py, PyAny>, name: &'static str) -> PyResult<Self> {
        Ok(Self { array: as_array(object, name)?, name })
    }

    pub fn shape(&self) -> Vec<usize> {
        self.array.shape().to_vec()
    }

    pub fn shape_words(&self) -> String {
        shape_words(self.array.shape())
    }

    /// All values in C order as float64; `expected` says in messages what they must be.
    pub fn reals(&self, expected: &str) -> PyResult<Vec<f64>> {
        let array: PyReadonlyArrayDyn<'_, f64> =
            converted(&self.array, self.name, "float64", "iufb", expected)?;
        Ok(array.as_slice()?.to_vec())
    }

    /// The given rows, in the same dtype, as an array of shape `shape`. The first `axes` axes number the rows.
    pub fn taken(&self, axes: usize, rows: &[usize], shape: Vec<usize>) -> PyResult<Py<PyAny>> {
        let py = self.array.py();
        let (first, rest) = self.array.shape().split_at(axes);
        let by_row: Vec<usize> =
            std::iter::once(first.iter().product()).chain(rest.iter().copied()).collect();
        let reshape = intern!(py, "reshape");
        let indices = PyArray1::from_iter(py, rows.iter().map(|&row| row as i64));
        let table = self.array.call_method1(reshape, (PyTuple::new(py, by_row)?,))?;
        let taken = table.call_method1(intern!(py, "take"), (indices, 0))?;
        Ok(taken.call_method1(reshape, (PyTuple::new(py, shape)?,))?.unbind())
    }
}

/// Numbers in C order as an array of any shape.
pub fn from_values(py: Python<'_>, values: Vec<f64>, shape: Vec<usize>) -> PyResult<Py<PyAny>> {
    Ok(PyArray1::from_vec(py, values).reshape(shape)?.into_any().unbind())
}

/// An array for Python, without a copy.
pub fn from_array<T: Element, D: Dimension>(py: Python<'_>, array: Array<T, D>) -> Py<PyArray<T, D>> {
    array.into_pyarray(py).unbind()
}

/// Indices as an int64 array.
pub fn from_indices<D: Dimension>(py: Python<'_>, indices: ArrayView<'_, u32, D>) -> Py<PyArray<i64, D>> {
    from_array(py, indices.mapv(i64::from))
}

/// Indices as an (n,) int64 array.
pub fn from_index_list(
    py: Python<'_>,
    list: impl ExactSizeIterator<Item = impl Into<usize>>,
) -> Py<PyArray1<i64>> {
    PyArray1::from_iter(py, list.map(|index| index.into() as i64)).unbind()
}

fn as_array<'py>(object: &Bound<'py, PyAny>, name: &str) -> PyResult<Bound<'py, PyUntypedArray>> {
    let py = object.py();
    let made = py.import(intern!(py, "numpy"))?.call_method1(intern!(py, "asarray"), (object,));
    let failed =
        |error: PyErr| bad_array(py, name, error.value(py).to_string(), "an array of numbers".into());
    made.map_err(failed)?.cast_into::<PyUntypedArray>().map_err(Into::into)
}

/// The numpy kind of the dtype: i, u, f, b, c, O, …
fn kind(array: &Bound<'_, PyUntypedArray>) -> PyResult<String> {
    array.dtype().getattr(intern!(array.py(), "kind"))?.extract()
}

/// A C-contiguous array of `dtype` made from an object whose dtype is of one of `kinds`.
fn converted<'py, T: numpy::Element>(
    object: &Bound<'py, PyAny>,
    name: &str,
    dtype: &str,
    kinds: &str,
    expected: &str,
) -> PyResult<PyReadonlyArrayDyn<'py, T>> {
    let (py, array) = (object.py(), as_array(object, name)?);
    // an empty list has dtype float64 whatever its caller meant
    if array.len() > 0 && !kinds.contains(&kind(&array)?) {
        return Err(bad_array(py, name, format!("of dtype {}", array.dtype()), expected.into()));
    }
    // C order and aligned: a view into a packed record is not aligned
    let required =
        py.import(intern!(py, "numpy"))?.call_method1(intern!(py, "require"), (array, dtype, "CA"))?;
    Ok(required.cast_into::<PyArrayDyn<T>>()?.readonly())
}

fn table<T: numpy::Element + Copy + Default, const N: usize>(
    object: &Bound<'_, PyAny>,
    name: &str,
    dtype: &str,
    kinds: &str,
    expected: &str,
) -> PyResult<Array2<T>> {
    // the shape is that before the conversion, which makes a scalar an array of one
    let given = as_array(object, name)?;
    let array: PyReadonlyArrayDyn<'_, T> = converted(object, name, dtype, kinds, expected)?;
    match given.shape() {
        [_, width] if *width == N => {
            Ok(array.as_array().into_dimensionality().expect("two axes").into_owned())
        }
        [0] => Ok(Array2::default((0, N))),
        shape => Err(bad_array(object.py(), name, shape_words(shape), format!("of shape (n, {N})"))),
    }
}

/// Integers of shape (k,) as one column.
fn integer_column(object: &Bound<'_, PyAny>, name: &str, expected: &str) -> PyResult<Array2<i64>> {
    let array = as_array(object, name)?;
    let &[length] = array.shape() else {
        return Err(bad_array(object.py(), name, shape_words(array.shape()), expected.into()));
    };
    integers::<1>(&array.call_method1(intern!(object.py(), "reshape"), ((length, 1),))?, name)
}

/// Integers, or reals that are whole numbers, of shape (n, N).
fn integers<const N: usize>(object: &Bound<'_, PyAny>, name: &str) -> PyResult<Array2<i64>> {
    if kind(&as_array(object, name)?)? != "f" {
        return table::<i64, N>(object, name, "int64", "iu", "integers");
    }
    let reals = table::<f64, N>(object, name, "float64", "f", "integers")?;
    match reals.iter().find(|x| x.fract() != 0.0 || x.abs() > 2f64.powi(53)) {
        Some(x) => Err(bad_array(object.py(), name, format!("not whole: {x}"), "integers".into())),
        None => Ok(reals.mapv(|x| x as i64)),
    }
}

/// The table as vertex indices, or an error that names the rows with values out of range; `noun` names a row.
fn narrow(
    py: Python<'_>,
    name: &str,
    noun: &str,
    table: &Array2<i64>,
    n_vertices: usize,
) -> PyResult<Array2<u32>> {
    let outside = |value: &i64| *value < 0 || *value >= n_vertices as i64;
    let bad = table.iter().enumerate().filter(|(_, value)| outside(value));
    let mut rows: Vec<usize> = bad.map(|(place, _)| place / table.ncols()).collect();
    rows.dedup();
    let Some(bad) = Elements::collect(rows) else {
        return Ok(table.mapv(|value| value as u32));
    };
    let value = table.row(bad.first[0]).into_iter().find(|value| outside(value)).expect("the row is bad");
    let found = match bad.count {
        1 => format!("{value} in {noun} {bad}"),
        count => format!("{value} and others in {count} {noun}s ({bad})"),
    };
    let expected: String = match n_vertices {
        0 => "empty where there are no vertices".into(),
        n => format!("indices of the {n} vertices, 0 to {}", n - 1),
    };
    Err(bad_indices(py, name, &found, &expected, &bad))
}

fn shape_words(shape: &[usize]) -> String {
    let lengths: Vec<String> = shape.iter().map(usize::to_string).collect();
    match lengths.len() {
        1 => format!("of shape ({},)", lengths[0]),
        _ => format!("of shape ({})", lengths.join(", ")),
    }
}
