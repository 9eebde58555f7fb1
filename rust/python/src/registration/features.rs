// SPDX-License-Identifier: MIT OR Apache-2.0
//! Features and weights of landmarks as arguments of a registration.

use authalic::{Error, Features, Side};
use numpy::ndarray::{Array1, Array2};
use numpy::{PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::prelude::*;

use super::surfaces::Pair;
use crate::arrays::{as_array, converted, shape_words};
use crate::errors::{bad_array, bad_option};

/// Signals of both surfaces, as plain data.
pub(super) struct GivenFeatures {
    source: Array2<f64>,
    target: Array2<f64>,
    weights: Vec<f64>,
}

impl GivenFeatures {
    /// The pair (source_values, target_values), if given, with the weight of all signals or of each.
    pub(super) fn new(
        features: Option<&Bound<'_, PyAny>>,
        weight: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Option<Self>> {
        let Some(features) = features else {
            return weight.map_or(Ok(None), |_| {
                Err(bad_option(
                    "feature_weight weighs features, but there are none: give features, or leave it out"
                        .into(),
                ))
            });
        };
        let parts: Vec<Bound<'_, PyAny>> =
            features.try_iter().and_then(|parts| parts.take(3).collect()).unwrap_or_default();
        let [source, target] = &parts[..] else {
            let found = features.get_type().name()?.to_string();
            let expected = "a pair (source_values, target_values)".into();
            return Err(bad_array(features.py(), "features", found, expected));
        };
        let (source, target) = (signals(source, "source features")?, signals(target, "target features")?);
        let weights = weight.map_or_else(|| Ok(vec![1.0]), |weight| numbers(weight, "feature_weight"))?;
        Ok(Some(Self { source, target, weights }))
    }

    /// The signals of the surfaces, as they were repaired.
    pub(super) fn prepared(self, pair: &Pair) -> Result<Self, Error> {
        Ok(Self {
            source: pair.source.signals(Side::Source, self.source)?,
            target: pair.target.signals(Side::Target, self.target)?,
            weights: self.weights,
        })
    }

    pub(super) fn view(&self) -> Features<'_> {
        Features { source: self.source.view(), target: self.target.view(), weights: &self.weights }
    }
}

/// Real numbers of shape (n,) or (n, k), one row per vertex.
fn signals(object: &Bound<'_, PyAny>, name: &str) -> PyResult<Array2<f64>> {
    let array: PyReadonlyArrayDyn<'_, f64> = converted(object, name, "float64", "iufb", "real numbers")?;
    let values = array.as_array().to_owned();
    let shaped = match values.ndim() {
        1 => values
            .into_dimensionality()
            .map(|column: Array1<f64>| column.insert_axis(numpy::ndarray::Axis(1))),
        _ => values.into_dimensionality(),
    };
    shaped.map_err(|_| {
        let expected = "of shape (n,) or (n, k), one row per vertex".into();
        bad_array(object.py(), name, shape_words(array.shape()), expected)
    })
}

/// A real number, or real numbers of shape (k,).
pub(super) fn numbers(object: &Bound<'_, PyAny>, name: &str) -> PyResult<Vec<f64>> {
    let given = as_array(object, name)?;
    if given.ndim() > 1 {
        let expected = "a number, or of shape (k,)".into();
        return Err(bad_array(object.py(), name, shape_words(given.shape()), expected));
    }
    let array: PyReadonlyArrayDyn<'_, f64> = converted(object, name, "float64", "iuf", "real numbers")?;
    Ok(array.as_array().iter().copied().collect())
}
