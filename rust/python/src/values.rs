// SPDX-License-Identifier: MIT OR Apache-2.0
//! Data of any kind and shape, as registrations carry it.

use numpy::ndarray::Array2;
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::arrays::{as_array, converted, kind, shape_words};

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

    /// The numbers in each row of the first axis.
    pub fn row_len(&self) -> usize {
        self.array.shape().iter().skip(1).product()
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

impl Values<'_> {
    /// The given rows, in the same dtype, as an array of shape `shape`; `fill` in the place of those that are missing,
    /// by default NaN, or what the dtype has for zero.
    pub fn taken_or(
        &self,
        rows: &[Option<usize>],
        fill: Option<&Bound<'_, PyAny>>,
        shape: Vec<usize>,
    ) -> PyResult<Py<PyAny>> {
        let py = self.array.py();
        let present: Vec<usize> = rows.iter().map(|row| row.unwrap_or(0)).collect();
        let missing: Vec<i64> = (0..).zip(rows).filter(|(_, row)| row.is_none()).map(|(k, _)| k).collect();
        if missing.is_empty() {
            return self.taken(1, &present, shape);
        }
        let flat = std::iter::once(rows.len()).chain(self.shape()[1..].iter().copied()).collect();
        let taken = self.taken(1, &present, flat)?.into_bound(py);
        let is_real = "fc".contains(&kind(&self.array)?);
        let fill = match fill {
            Some(fill) => fill.clone(),
            None if is_real => f64::NAN.into_pyobject(py)?.into_any(),
            None => py
                .import(intern!(py, "numpy"))?
                .call_method1(intern!(py, "zeros"), (1, self.array.dtype()))?
                .get_item(0)?,
        };
        taken.set_item(PyArray1::from_vec(py, missing), fill)?;
        Ok(taken.call_method1(intern!(py, "reshape"), (PyTuple::new(py, shape)?,))?.unbind())
    }
}

/// Values as a table of real numbers, one row for each of the first axis.
pub fn table_of(values: &Values<'_>) -> PyResult<Array2<f64>> {
    let numbers = values.reals("real numbers; nearest=True takes labels of any kind")?;
    let shape = values.shape();
    let width = shape[1..].iter().product();
    Ok(Array2::from_shape_vec((shape[0], width), numbers).expect("the shape is that of the values"))
}

/// Numbers in C order as an array of any shape.
pub fn from_values(py: Python<'_>, values: Vec<f64>, shape: Vec<usize>) -> PyResult<Py<PyAny>> {
    Ok(PyArray1::from_vec(py, values).reshape(shape)?.into_any().unbind())
}
