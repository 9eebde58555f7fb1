// SPDX-License-Identifier: MIT OR Apache-2.0
//! Named arrays of the core as dictionaries of Python, and back.

use authalic::{Entry, Tree};
use numpy::{PyArrayDyn, PyArrayMethods, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyString};

use crate::arrays::{from_array, kind};

/// A tree as a dictionary of read-only arrays, words, dictionaries and lists of dictionaries.
pub fn to_dictionary<'py>(py: Python<'py>, tree: &Tree) -> PyResult<Bound<'py, PyDict>> {
    let dictionary = PyDict::new(py);
    for (name, entry) in tree.entries() {
        dictionary.set_item(name, to_object(py, entry)?)?;
    }
    Ok(dictionary)
}

fn to_object<'py>(py: Python<'py>, entry: &Entry) -> PyResult<Bound<'py, PyAny>> {
    Ok(match entry {
        Entry::Reals(reals) => from_array(py, reals.clone()).into_bound(py).into_any(),
        Entry::Integers(integers) => from_array(py, integers.clone()).into_bound(py).into_any(),
        Entry::Text(text) => PyString::new(py, text).into_any(),
        Entry::Tree(tree) => to_dictionary(py, tree)?.into_any(),
        Entry::Trees(trees) => {
            let each = trees.iter().map(|tree| to_dictionary(py, tree)).collect::<PyResult<Vec<_>>>()?;
            PyList::new(py, each)?.into_any()
        }
    })
}

/// The tree of such a dictionary.
pub fn from_dictionary(dictionary: &Bound<'_, PyDict>) -> PyResult<Tree> {
    let mut tree = Tree::new();
    for (name, value) in dictionary {
        tree = tree.with(&name.extract::<String>()?, from_object(&value)?);
    }
    Ok(tree)
}

fn from_object(value: &Bound<'_, PyAny>) -> PyResult<Entry> {
    if let Ok(dictionary) = value.cast::<PyDict>() {
        return Ok(from_dictionary(dictionary)?.into());
    }
    if let Ok(list) = value.cast::<PyList>() {
        let trees = list.iter().map(|each| from_dictionary(each.cast::<PyDict>()?));
        return Ok(trees.collect::<PyResult<Vec<_>>>()?.into());
    }
    if let Ok(text) = value.extract::<String>() {
        return Ok(text.as_str().into());
    }
    let array = value.cast::<PyUntypedArray>()?;
    match kind(array)?.as_str() {
        "f" => Ok(Entry::Reals(value.cast::<PyArrayDyn<f64>>()?.to_owned_array())),
        "i" => Ok(Entry::Integers(value.cast::<PyArrayDyn<i64>>()?.to_owned_array())),
        _ => Err(PyValueError::new_err(format!("a saved result has an array of dtype {}", array.dtype()))),
    }
}
