// SPDX-License-Identifier: MIT OR Apache-2.0
//! Maps read backwards: places of points, and values at points, for disk and sphere maps alike.

use std::sync::Arc;

use authalic::{Error, InverseMap, Outside, PerElement};
use numpy::ndarray::{Array2, aview1};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;

use crate::arrays::{Reals, own_array, real_table};
use crate::errors::{bad_array, bad_option, to_python};
use crate::indices::integer_list;
use crate::run::run;
use crate::values::{Values, from_values};

/// The inverse of a map, made when it is asked for the first time.
pub struct Lookup(PyOnceLock<Arc<InverseMap>>);

impl Default for Lookup {
    fn default() -> Self {
        Self(PyOnceLock::new())
    }
}

impl Lookup {
    pub fn get(
        &self,
        py: Python<'_>,
        make: impl FnOnce() -> Result<InverseMap, Error>,
    ) -> PyResult<Arc<InverseMap>> {
        let made = || make().map(Arc::new).map_err(|error| to_python(py, &error));
        Ok(self.0.get_or_try_init(py, made)?.clone())
    }
}

/// A map whose places can be looked up.
pub trait Invertible {
    fn inverse(&self, py: Python<'_>) -> PyResult<Arc<InverseMap>>;
}

/// The method `locate`.
pub fn locate(
    py: Python<'_>,
    map: Arc<InverseMap>,
    points: Array2<f64>,
    outside: Outside,
) -> PyResult<(Py<PyArray1<i64>>, Py<PyArray2<f64>>)> {
    let places = run(py, None, move |observer| map.locate(points.view(), outside, observer))?;
    Ok((own_array(py, places.triangles), own_array(py, places.barycentric)))
}

/// The method `image_of`.
pub fn image_of(
    py: Python<'_>,
    map: Arc<InverseMap>,
    triangles: &Bound<'_, PyAny>,
    barycentric: &Bound<'_, PyAny>,
) -> PyResult<Reals> {
    let triangles = integer_list(triangles, "triangles", "of shape (k,), faces")?;
    let barycentric = real_table::<3>(barycentric, "barycentric")?;
    let image = run(py, None, move |_| map.image(aview1(&triangles), barycentric.view()))?;
    Ok(own_array(py, image))
}

/// What becomes of points outside an image.
pub struct Beyond<'a, 'py> {
    pub outside: Outside,
    /// The value that they get, if the caller says which.
    fill: Option<&'a Bound<'py, PyAny>>,
}

impl<'a, 'py> Beyond<'a, 'py> {
    pub fn new(outside: Option<&'a Bound<'py, PyAny>>) -> PyResult<Self> {
        let Some(given) = outside else { return Ok(Self { outside: Outside::Nowhere, fill: None }) };
        match given.extract::<String>() {
            Ok(word) if word == "nearest" => Ok(Self { outside: Outside::Nearest, fill: None }),
            Ok(word) => Err(bad_option(format!("outside must be \"nearest\" or a number, but is {word:?}"))),
            Err(_) => Ok(Self { outside: Outside::Nowhere, fill: Some(given) }),
        }
    }
}

/// Values of a surface that are asked for at points.
pub struct Request<'a, 'py> {
    pub values: &'a Bound<'py, PyAny>,
    pub per: Option<&'a str>,
    pub nearest: bool,
    pub beyond: Beyond<'a, 'py>,
}

impl Request<'_, '_> {
    /// The method `sample`: one row per point.
    pub fn at(&self, py: Python<'_>, map: Arc<InverseMap>, points: Array2<f64>) -> PyResult<Py<PyAny>> {
        let shape = vec![points.nrows()];
        self.on_grid(py, map, points, shape)
    }

    /// Values at the points of a grid, which has the shape `grid`.
    pub fn on_grid(
        &self,
        py: Python<'_>,
        map: Arc<InverseMap>,
        points: Array2<f64>,
        grid: Vec<usize>,
    ) -> PyResult<Py<PyAny>> {
        let values = Values::new(self.values, "values")?;
        let per = self.per(py, &map, &values)?;
        let shape: Vec<usize> = grid.into_iter().chain(values.shape()[1..].iter().copied()).collect();
        let outside = self.beyond.outside;
        if self.nearest {
            let rows =
                run(py, None, move |observer| map.nearest_rows(per, points.view(), outside, observer))?;
            return values.taken_or(&rows, self.beyond.fill, shape);
        }
        let fill = self.beyond.fill.map_or(Ok(f64::NAN), |fill| fill.extract())?;
        let numbers = self.numbers(&values)?;
        let sampled = run(py, None, move |observer| {
            map.sample(numbers.view(), per, points.view(), (outside, fill), observer)
        })?;
        from_values(py, sampled.into_raw_vec_and_offset().0, shape)
    }

    /// The elements that the values belong to.
    pub fn per(&self, py: Python<'_>, map: &InverseMap, values: &Values<'_>) -> PyResult<PerElement> {
        let asked = match self.per {
            None => None,
            Some("vertex") => Some(PerElement::Vertex),
            Some("face") => Some(PerElement::Face),
            Some(word) => {
                let message = format!("per must be \"vertex\", \"face\" or None, but is \"{word}\"");
                return Err(bad_option(message));
            }
        };
        let length = values.shape().first().copied();
        let fits = |per: &PerElement| length == Some(map.n_rows(*per));
        let candidates = [PerElement::Vertex, PerElement::Face];
        candidates.into_iter().filter(|per| asked.is_none_or(|asked| asked == *per)).find(fits).ok_or_else(
            || {
                let (n, m) = (map.n_vertices(), map.n_faces());
                let expected = match asked {
                    None => format!("of shape ({n}, …) per vertex or ({m}, …) per face"),
                    Some(PerElement::Vertex) => format!("of shape ({n}, …), one row per vertex"),
                    Some(PerElement::Face) => format!("of shape ({m}, …), one row per face"),
                };
                bad_array(py, "values", values.shape_words(), expected)
            },
        )
    }

    /// The values as a table of real numbers.
    pub fn numbers(&self, values: &Values<'_>) -> PyResult<Array2<f64>> {
        let numbers = values.reals("real numbers; nearest=True takes labels of any kind")?;
        let shape = values.shape();
        let width = shape[1..].iter().product();
        Ok(Array2::from_shape_vec((shape[0], width), numbers).expect("the shape is that of the values"))
    }
}
