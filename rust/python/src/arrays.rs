// SPDX-License-Identifier: MIT OR Apache-2.0
//! Real arrays in and out: views of any dtype and memory layout in, C-contiguous float64 out.
//!
//! What a run uses is copied once, because Python code may write to its arrays while the run goes on without the GIL.

use numpy::ndarray::{Array, Array1, Array2, Dimension};
use numpy::{
    Element, IntoPyArray, PyArray, PyArray2, PyArrayDyn, PyArrayMethods, PyReadonlyArray2,
    PyReadonlyArrayDyn, PyUntypedArray, PyUntypedArrayMethods,
};
use pyo3::exceptions::PyTypeError;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::PyString;
use pyo3::{Borrowed, FromPyObject};

use crate::errors::bad_array;
use crate::memory;

/// The elements of any sequence. Its own word about its length is not believed.
pub struct Items<T>(pub Vec<T>);

impl<'py, T> FromPyObject<'_, 'py> for Items<T>
where
    T: for<'a> FromPyObject<'a, 'py>,
{
    type Error = PyErr;

    fn extract(given: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if given.is_instance_of::<PyString>() {
            return Err(PyTypeError::new_err("a sequence is needed here, but this is a string"));
        }
        let mut items = Vec::new();
        for item in given.try_iter()? {
            items.push(item?.extract().map_err(Into::into)?);
        }
        Ok(Self(items))
    }
}

/// An (n, 2) or (n, 3) array for Python.
pub type Reals = Py<PyArray2<f64>>;

/// Real numbers of shape (n, N).
pub fn real_table<const N: usize>(object: &Bound<'_, PyAny>, name: &str) -> PyResult<Array2<f64>> {
    Ok(table::<f64, N>(object, name, "float64", "iufb", "real numbers")?.to_owned_array())
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

/// An array of a result, without a copy. Python cannot write to it.
pub fn from_array<T: Element, D: Dimension>(py: Python<'_>, array: Array<T, D>) -> Py<PyArray<T, D>> {
    frozen(array.into_pyarray(py))
}

/// An array that is the caller's own, without a copy.
pub fn own_array<T: Element, D: Dimension>(py: Python<'_>, array: Array<T, D>) -> Py<PyArray<T, D>> {
    array.into_pyarray(py).unbind()
}

/// An array that Python cannot write to.
pub fn frozen<T: Element, D: Dimension>(array: Bound<'_, PyArray<T, D>>) -> Py<PyArray<T, D>> {
    array.readwrite().make_nonwriteable();
    array.unbind()
}

/// Any object as an array. Masked values are refused, which would come out from behind their mask.
pub fn as_array<'py>(object: &Bound<'py, PyAny>, name: &str) -> PyResult<Bound<'py, PyUntypedArray>> {
    let py = object.py();
    if object.hasattr(intern!(py, "mask"))? {
        let is_masked = py.import(intern!(py, "numpy.ma"))?.call_method1(intern!(py, "is_masked"), (object,));
        if is_masked?.is_truthy()? {
            let expected = "without masked values: leave out the elements that these belong to".into();
            return Err(bad_array(py, name, "a masked array".into(), expected));
        }
    }
    let made = py.import(intern!(py, "numpy"))?.call_method1(intern!(py, "asarray"), (object,));
    let failed =
        |error: PyErr| bad_array(py, name, error.value(py).to_string(), "an array of numbers".into());
    made.map_err(failed)?.cast_into::<PyUntypedArray>().map_err(Into::into)
}

/// The numpy kind of the dtype: i, u, f, b, c, O, …
pub fn kind(array: &Bound<'_, PyUntypedArray>) -> PyResult<String> {
    array.dtype().getattr(intern!(array.py(), "kind"))?.extract()
}

/// A C-contiguous array of `dtype` made from an object whose dtype is of one of `kinds`.
pub fn converted<'py, T: numpy::Element>(
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
    memory::check_numbers(py, memory::GIVEN, array.len())?;
    // C order and aligned: a view into a packed record is not aligned
    let required =
        py.import(intern!(py, "numpy"))?.call_method1(intern!(py, "require"), (array, dtype, "CA"))?;
    Ok(required.cast_into::<PyArrayDyn<T>>()?.readonly())
}

/// A view of shape (n, N) of `dtype`, of an object whose dtype is of one of `kinds`.
pub fn table<'py, T: Element, const N: usize>(
    object: &Bound<'py, PyAny>,
    name: &str,
    dtype: &str,
    kinds: &str,
    expected: &str,
) -> PyResult<PyReadonlyArray2<'py, T>> {
    // the shape is that before the conversion, which makes a scalar an array of one
    let given = as_array(object, name)?;
    let array: PyReadonlyArrayDyn<'_, T> = converted(object, name, dtype, kinds, expected)?;
    match given.shape() {
        [_, width] if *width == N => Ok(array.cast::<PyArray2<T>>()?.readonly()),
        [0] => Ok(array.reshape([0, N])?.readonly()),
        shape => Err(bad_array(object.py(), name, shape_words(shape), format!("of shape (n, {N})"))),
    }
}

/// A shape in words, as in messages.
pub fn shape_words(shape: &[usize]) -> String {
    let lengths: Vec<String> = shape.iter().map(usize::to_string).collect();
    match lengths.len() {
        1 => format!("of shape ({},)", lengths[0]),
        _ => format!("of shape ({})", lengths.join(", ")),
    }
}

/// One array or `None` for each of `count` surfaces; `None` for all where there is no list.
pub fn reals_of_each(
    py: Python<'_>,
    list: Option<Items<Option<Bound<'_, PyAny>>>>,
    [name, of_each]: [&'static str; 2],
    count: usize,
) -> PyResult<Vec<Option<Array1<f64>>>> {
    let Some(Items(list)) = list else { return Ok(vec![None; count]) };
    if list.len() != count {
        let (found, expected) = (format!("of length {}", list.len()), format!("of length {count}"));
        return Err(bad_array(py, name, found, expected));
    }
    list.iter().map(|each| each.as_ref().map(|array| reals(array, of_each)).transpose()).collect()
}
