// SPDX-License-Identifier: MIT OR Apache-2.0
//! Arrays in and out: any real dtype and memory layout in, C-contiguous float64 and int64 out.

use authalic::Elements;
use numpy::{
    PyArray1, PyArray2, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArray, PyUntypedArrayMethods,
};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::errors::bad_array;

/// An (n, 2) array for Python.
pub type Pairs = Py<PyArray2<f64>>;

/// Real numbers of shape (n, N).
pub fn points<const N: usize>(object: &Bound<'_, PyAny>, name: &'static str) -> PyResult<Vec<[f64; N]>> {
    rows(object, name, "float64", "iufb", "real numbers")
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
    narrow(object.py(), name, &found, n_vertices)
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

/// Rows to a (n, N) float64 array.
pub fn from_points<const N: usize>(py: Python<'_>, rows: &[[f64; N]]) -> Pairs {
    let array = PyArray1::from_slice(py, rows.as_flattened());
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

fn as_array<'py>(object: &Bound<'py, PyAny>, name: &'static str) -> PyResult<Bound<'py, PyUntypedArray>> {
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
    name: &'static str,
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
    name: &'static str,
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
fn whole<const N: usize>(object: &Bound<'_, PyAny>, name: &'static str) -> PyResult<Vec<[i64; N]>> {
    let reals: Vec<[f64; N]> = rows(object, name, "float64", "f", "integers")?;
    match reals.as_flattened().iter().find(|x| x.fract() != 0.0 || x.abs() > 2f64.powi(53)) {
        Some(x) => Err(bad_array(object.py(), name, format!("not whole: {x}"), "integers".into())),
        None => Ok(reals.iter().map(|row| row.map(|x| x as i64)).collect()),
    }
}

/// Indices of the `n_vertices` vertices, or an error that names the rows with others.
fn narrow<const N: usize>(
    py: Python<'_>,
    name: &'static str,
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
        1 => format!("{value} in row {bad}"),
        count => format!("{value} and others in {count} rows ({bad})"),
    };
    let expected = match n_vertices {
        0 => "empty where there are no vertices".into(),
        n => format!("indices of the {n} vertices, 0 to {}", n - 1),
    };
    let raised = bad_array(py, name, found, expected);
    raised.value(py).setattr("indices", PyTuple::new(py, &bad.first)?)?;
    raised.value(py).setattr("count", bad.count)?;
    Err(raised)
}

fn shape_words(shape: &[usize]) -> String {
    let lengths: Vec<String> = shape.iter().map(usize::to_string).collect();
    match lengths.len() {
        1 => format!("of shape ({},)", lengths[0]),
        _ => format!("of shape ({})", lengths.join(", ")),
    }
}
