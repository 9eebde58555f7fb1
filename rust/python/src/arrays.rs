// SPDX-License-Identifier: MIT OR Apache-2.0
//! Arrays in and out: any real dtype and memory layout in, C-contiguous float64 and int64 out.

use authalic::{Elements, Vector3};
use numpy::{
    PyArray1, PyArray2, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArray, PyUntypedArrayMethods,
};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::errors::{bad_array, bad_indices};

/// An (n, 2) array for Python.
pub type Pairs = Py<PyArray2<f64>>;

/// Real numbers of shape (n, N).
pub fn points<const N: usize>(object: &Bound<'_, PyAny>, name: &'static str) -> PyResult<Vec<[f64; N]>> {
    rows(object, name, "float64", "iufb", "real numbers")
}

/// Points in space: real numbers of shape (n, 3).
pub fn vectors(object: &Bound<'_, PyAny>, name: &'static str) -> PyResult<Vec<Vector3>> {
    Ok(points(object, name)?.into_iter().map(Vector3).collect())
}

/// Faces or seams: integers of shape (n, N) that fit a vertex index. Reals are taken where they are whole.
pub fn indices<const N: usize>(
    object: &Bound<'_, PyAny>,
    name: &'static str,
    n_vertices: usize,
) -> PyResult<Vec<[u32; N]>> {
    let found: Vec<[i64; N]> = match kind(&as_array(object, name)?)?.as_str() {
        "f" => whole(object, name)?,
        _ => rows(object, name, "int64", "iu", "integers")?,
    };
    narrow(object.py(), name, "row", &found, n_vertices)
}

/// Vertices: integers of shape (k,) that fit a vertex index; `noun` names an entry.
pub fn index_list(
    object: &Bound<'_, PyAny>,
    name: &str,
    noun: &str,
    n_vertices: usize,
) -> PyResult<Vec<usize>> {
    let array = as_array(object, name)?;
    let &[length] = array.shape() else {
        let found = shape_words(array.shape());
        return Err(bad_array(object.py(), name, found, "of shape (k,), vertex indices".into()));
    };
    let column = array.call_method1(intern!(object.py(), "reshape"), ((length, 1),))?;
    let found: Vec<[i64; 1]> = match kind(&array)?.as_str() {
        "f" => whole(&column, name)?,
        _ => rows(&column, name, "int64", "iu", "integers")?,
    };
    let narrowed = narrow(object.py(), name, noun, &found, n_vertices)?;
    Ok(narrowed.as_flattened().iter().map(|&vertex| vertex as usize).collect())
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

    /// All values in C order as float64; `expected` says what they have to be.
    pub fn reals(&self, expected: &str) -> PyResult<Vec<f64>> {
        let array: PyReadonlyArrayDyn<'_, f64> =
            converted(&self.array, self.name, "float64", "iufb", expected)?;
        Ok(array.as_slice()?.to_vec())
    }

    /// Rows of the same dtype as an array of another shape; a row is what is left of the shape after `axes`
    /// of them.
    pub fn taken(&self, axes: usize, rows: &[u32], shape: Vec<usize>) -> PyResult<Py<PyAny>> {
        let py = self.array.py();
        let (first, rest) = self.array.shape().split_at(axes);
        let by_row: Vec<usize> =
            std::iter::once(first.iter().product()).chain(rest.iter().copied()).collect();
        let reshape = intern!(py, "reshape");
        let indices = PyArray1::from_iter(py, rows.iter().map(|&row| i64::from(row)));
        let table = self.array.call_method1(reshape, (PyTuple::new(py, by_row)?,))?;
        let taken = table.call_method1(intern!(py, "take"), (indices, 0))?;
        Ok(taken.call_method1(reshape, (PyTuple::new(py, shape)?,))?.unbind())
    }
}

/// Numbers in C order to an array of any shape.
pub fn from_values(py: Python<'_>, values: Vec<f64>, shape: Vec<usize>) -> PyResult<Py<PyAny>> {
    Ok(PyArray1::from_vec(py, values).reshape(shape)?.into_any().unbind())
}

/// Real numbers of shape (n,).
pub fn values(object: &Bound<'_, PyAny>, name: &'static str) -> PyResult<Vec<f64>> {
    let array: PyReadonlyArrayDyn<'_, f64> = converted(object, name, "float64", "iufb", "real numbers")?;
    match array.shape() {
        [_] => Ok(array.as_slice()?.to_vec()),
        shape => {
            Err(bad_array(object.py(), name, shape_words(shape), "of shape (m,), one value per face".into()))
        }
    }
}

/// The second length of an (n, k) array.
pub fn width(object: &Bound<'_, PyAny>, name: &'static str) -> PyResult<usize> {
    match as_array(object, name)?.shape() {
        [_, width] => Ok(*width),
        shape => Err(bad_array(object.py(), name, shape_words(shape), "of shape (n, 2) or (n, 3)".into())),
    }
}

/// Points of a (n, N) float64 array.
pub fn from_points<const N: usize>(py: Python<'_>, rows: &[impl Copy + Into<[f64; N]>]) -> Pairs {
    let array = PyArray1::from_iter(py, rows.iter().flat_map(|&row| row.into()));
    array.reshape([rows.len(), N]).expect("the lengths agree").unbind()
}

/// Rows to a (n, N) int64 array.
pub fn from_indices<const N: usize>(py: Python<'_>, rows: &[[u32; N]]) -> Py<PyArray2<i64>> {
    let flat = PyArray1::from_iter(py, rows.as_flattened().iter().map(|&i| i64::from(i)));
    flat.reshape([rows.len(), N]).expect("the lengths agree").unbind()
}

/// Indices to an (n,) int64 array.
pub fn from_index_list(py: Python<'_>, list: impl ExactSizeIterator<Item = usize>) -> Py<PyArray1<i64>> {
    PyArray1::from_iter(py, list.map(|i| i as i64)).unbind()
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
    // an empty list has dtype float64, whatever was meant
    if array.len() > 0 && !kinds.contains(&kind(&array)?) {
        return Err(bad_array(py, name, format!("of dtype {}", array.dtype()), expected.into()));
    }
    // C order and aligned, which a view into a packed record is not
    let required =
        py.import(intern!(py, "numpy"))?.call_method1(intern!(py, "require"), (array, dtype, "CA"))?;
    Ok(required.cast_into::<PyArrayDyn<T>>()?.readonly())
}

fn rows<T: numpy::Element + Copy, const N: usize>(
    object: &Bound<'_, PyAny>,
    name: &str,
    dtype: &str,
    kinds: &str,
    expected: &str,
) -> PyResult<Vec<[T; N]>> {
    // the conversion makes a scalar an array of one, so the shape is judged before
    let given = as_array(object, name)?;
    let array: PyReadonlyArrayDyn<'_, T> = converted(object, name, dtype, kinds, expected)?;
    match given.shape() {
        [_, width] if *width == N => Ok(array.as_slice()?.as_chunks::<N>().0.to_vec()),
        [0] => Ok(Vec::new()),
        shape => Err(bad_array(object.py(), name, shape_words(shape), format!("of shape (n, {N})"))),
    }
}

/// Reals that are whole numbers, as integers.
fn whole<const N: usize>(object: &Bound<'_, PyAny>, name: &str) -> PyResult<Vec<[i64; N]>> {
    let reals: Vec<[f64; N]> = rows(object, name, "float64", "f", "integers")?;
    match reals.as_flattened().iter().find(|x| x.fract() != 0.0 || x.abs() > 2f64.powi(53)) {
        Some(x) => Err(bad_array(object.py(), name, format!("not whole: {x}"), "integers".into())),
        None => Ok(reals.iter().map(|row| row.map(|x| x as i64)).collect()),
    }
}

/// Indices of the `n_vertices` vertices, or an error that names the rows (the noun says what they are) with
/// others.
fn narrow<const N: usize>(
    py: Python<'_>,
    name: &str,
    noun: &str,
    rows: &[[i64; N]],
    n_vertices: usize,
) -> PyResult<Vec<[u32; N]>> {
    let outside = |value: &&i64| **value < 0 || **value >= n_vertices as i64;
    let bad = (0..rows.len()).filter(|&row| rows[row].iter().any(|value| outside(&value)));
    let Some(bad) = Elements::collect(bad) else {
        return Ok(rows.iter().map(|row| row.map(|value| value as u32)).collect());
    };
    let value = rows[bad.first[0]].iter().find(outside).expect("the row is bad");
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
