// SPDX-License-Identifier: MIT OR Apache-2.0
//! Indices in and out: integers, or whole reals, in; int64 out.

use authalic::Elements;
use numpy::ndarray::{Array2, ArrayView, ArrayView2, Dimension};
use numpy::{
    IntoPyArray, PyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods,
};
use pyo3::intern;
use pyo3::prelude::*;

use crate::arrays::{as_array, from_array, frozen, kind, shape_words, table};
use crate::errors::{bad_array, bad_indices};

/// Faces or seams: vertex indices of shape (n, N). Whole reals are accepted.
pub fn index_table<const N: usize>(
    object: &Bound<'_, PyAny>,
    name: &str,
    n_vertices: usize,
) -> PyResult<Array2<u32>> {
    narrow(object.py(), name, "row", integers::<N>(object, name)?.as_array(), n_vertices)
}

/// Vertex indices of shape (k,); `noun` names an entry in messages.
pub fn index_list(
    object: &Bound<'_, PyAny>,
    name: &str,
    noun: &str,
    n_vertices: usize,
) -> PyResult<Vec<usize>> {
    let column = integer_column(object, name, "of shape (k,), vertex indices")?;
    let narrowed = narrow(object.py(), name, noun, column.as_array(), n_vertices)?;
    Ok(narrowed.iter().map(|&vertex| vertex as usize).collect())
}

/// Labels of faces: integers of shape (m,).
pub fn labels(object: &Bound<'_, PyAny>, name: &'static str) -> PyResult<Vec<i64>> {
    integer_list(object, name, "of shape (m,), one number per face")
}

/// Integers of shape (k,), as the words `expected` say.
pub fn integer_list(object: &Bound<'_, PyAny>, name: &'static str, expected: &str) -> PyResult<Vec<i64>> {
    Ok(integer_column(object, name, expected)?.as_array().iter().copied().collect())
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

/// The faces of a result, which are indices below 2³².
pub fn narrowed(faces: &Bound<'_, PyArray2<i64>>) -> Array2<u32> {
    faces.readonly().as_array().mapv(|vertex| vertex as u32)
}

/// Indices of a result as an int64 array.
pub fn from_indices<D: Dimension>(py: Python<'_>, indices: ArrayView<'_, u32, D>) -> Py<PyArray<i64, D>> {
    from_array(py, indices.mapv(i64::from))
}

/// Indices of a result as an (n,) int64 array.
pub fn from_index_list(
    py: Python<'_>,
    list: impl ExactSizeIterator<Item = impl Into<usize>>,
) -> Py<PyArray1<i64>> {
    frozen(PyArray1::from_iter(py, list.map(|index| index.into() as i64)))
}

/// Integers of shape (k,) as one column.
fn integer_column<'py>(
    object: &Bound<'py, PyAny>,
    name: &str,
    expected: &str,
) -> PyResult<PyReadonlyArray2<'py, i64>> {
    let array = as_array(object, name)?;
    let &[length] = array.shape() else {
        return Err(bad_array(object.py(), name, shape_words(array.shape()), expected.into()));
    };
    integers::<1>(&array.call_method1(intern!(object.py(), "reshape"), ((length, 1),))?, name)
}

/// Integers, or reals that are whole numbers, of shape (n, N).
fn integers<'py, const N: usize>(
    object: &Bound<'py, PyAny>,
    name: &str,
) -> PyResult<PyReadonlyArray2<'py, i64>> {
    if kind(&as_array(object, name)?)? != "f" {
        return table::<i64, N>(object, name, "int64", "iu", "integers");
    }
    let reals = table::<f64, N>(object, name, "float64", "f", "integers")?;
    let reals = reals.as_array();
    match reals.iter().find(|x| x.fract() != 0.0 || x.abs() > 2f64.powi(53)) {
        Some(x) => Err(bad_array(object.py(), name, format!("not whole: {x}"), "integers".into())),
        None => Ok(reals.mapv(|x| x as i64).into_pyarray(object.py()).readonly()),
    }
}

/// The table as vertex indices, or an error that names the rows with values out of range; `noun` names a row.
fn narrow(
    py: Python<'_>,
    name: &str,
    noun: &str,
    table: ArrayView2<'_, i64>,
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
