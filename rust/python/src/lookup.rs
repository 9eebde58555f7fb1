// SPDX-License-Identifier: MIT OR Apache-2.0
//! Maps read backwards: places of points, and values at points, for disk and sphere maps alike.

use std::sync::Arc;

use authalic::{CellIntegrals, Error, Grid, Icosphere, InverseMap, Outside, PerElement};
use numpy::ndarray::{Array2, aview1};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::{Borrowed, FromPyObject};

use crate::arrays::{Reals, own_array, real_table};
use crate::errors::{bad_array, bad_option, to_python};
use crate::indices::integer_list;
use crate::memory;
use crate::run::run;
use crate::values::{Values, from_values, table_of};

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

/// For Python: the face in which each point lies, (k,), and its barycentric coordinates there, (k, 3).
pub type Located = (Py<PyArray1<i64>>, Py<PyArray2<f64>>);

/// The method `locate`.
pub fn locate(
    py: Python<'_>,
    map: Arc<InverseMap>,
    points: Array2<f64>,
    outside: Outside,
) -> PyResult<Located> {
    memory::check_numbers(py, memory::POINT, points.nrows())?;
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

/// What a cell gets.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Conservative {
    /// The value at its center.
    No,
    /// The mean over the part of it that the image covers.
    Mean,
    /// The integral over it.
    Total,
}

impl Conservative {
    fn of(self, integrals: &CellIntegrals, fill: f64) -> Array2<f64> {
        if self == Self::Total { integrals.totals.clone() } else { integrals.means(fill) }
    }
}

impl<'py> FromPyObject<'_, 'py> for Conservative {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(is_wanted) = given.extract::<bool>() {
            return Ok(if is_wanted { Self::Mean } else { Self::No });
        }
        match given.extract::<String>().as_deref() {
            Ok("total") => Ok(Self::Total),
            _ => Err(bad_option(format!(
                "conservative must be True, False or \"total\", but is {}",
                given.repr()?
            ))),
        }
    }
}

/// The shape of a grid, (rows, columns).
pub struct Shape(pub [usize; 2]);

impl<'py> FromPyObject<'_, 'py> for Shape {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let count = |length: Bound<'py, PyAny>| length.extract::<usize>().ok().filter(|&length| length > 0);
        let lengths = given.try_iter().and_then(|lengths| lengths.take(3).collect::<PyResult<Vec<_>>>());
        match lengths.unwrap_or_default().into_iter().map(count).collect::<Vec<_>>()[..] {
            [Some(rows), Some(columns)] => Ok(Self([rows, columns])),
            _ => {
                Err(bad_option(format!("shape must be (rows, columns), each ≥ 1, but is {}", given.repr()?)))
            }
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
        check_result(py, points.nrows(), &values)?;
        let shape: Vec<usize> = grid.into_iter().chain(values.shape()[1..].iter().copied()).collect();
        let outside = self.beyond.outside;
        if self.nearest {
            let rows =
                run(py, None, move |observer| map.nearest_rows(per, points.view(), outside, observer))?;
            return values.taken_or(&rows, self.beyond.fill, shape);
        }
        let fill = self.beyond.fill.map_or(Ok(f64::NAN), |fill| fill.extract())?;
        let numbers = table_of(&values)?;
        let sampled = run(py, None, move |observer| {
            map.sample(numbers.view(), per, points.view(), (outside, fill), observer)
        })?;
        from_values(py, sampled.into_raw_vec_and_offset().0, shape)
    }

    /// Values in the cells of a grid: at their centers, or means over them.
    pub fn in_cells(
        &self,
        py: Python<'_>,
        map: Arc<InverseMap>,
        grid: Grid,
        conservative: Conservative,
    ) -> PyResult<Py<PyAny>> {
        grid.check().map_err(|error| to_python(py, &error))?;
        let shape = grid.shape().to_vec();
        let values = Values::new(self.values, "values")?;
        check_result(py, shape.iter().product(), &values)?;
        if conservative == Conservative::No {
            let centers = run(py, None, move |_| Ok(grid.centers()))?;
            return self.on_grid(py, map, centers, shape);
        }
        let (per, numbers, shape) = self.quantities(py, &map, shape)?;
        let fill = self.beyond.fill.map_or(Ok(f64::NAN), |fill| fill.extract())?;
        let cells = run(py, None, move |observer| {
            let integrals = map.integrate(numbers.view(), per, &grid, observer)?;
            Ok(conservative.of(&integrals, fill))
        })?;
        from_values(py, cells.into_raw_vec_and_offset().0, shape)
    }

    /// Values at the vertices of an icosphere, or means around them.
    pub fn on_icosphere(
        &self,
        py: Python<'_>,
        map: Arc<InverseMap>,
        icosphere: Arc<Icosphere>,
        conservative: Conservative,
    ) -> PyResult<Py<PyAny>> {
        let positions = icosphere.positions();
        let shape = vec![positions.nrows()];
        if conservative == Conservative::No {
            return self.on_grid(py, map, positions, shape);
        }
        let (per, numbers, shape) = self.quantities(py, &map, shape)?;
        let around = run(py, None, move |observer| {
            let of_faces = map.integrate_on_icosphere(numbers.view(), per, &icosphere, observer)?;
            Ok(conservative.of(&icosphere.to_vertices(&of_faces), f64::NAN))
        })?;
        from_values(py, around.into_raw_vec_and_offset().0, shape)
    }

    /// The values as numbers that can be added up, the elements that they belong to, and the shape of the result.
    fn quantities(
        &self,
        py: Python<'_>,
        map: &InverseMap,
        grid: Vec<usize>,
    ) -> PyResult<(PerElement, Array2<f64>, Vec<usize>)> {
        if self.nearest {
            return Err(bad_option(
                "nearest=True takes labels, which have no means: leave conservative out".into(),
            ));
        }
        let values = Values::new(self.values, "values")?;
        let per = self.per(py, map, &values)?;
        let shape = grid.into_iter().chain(values.shape()[1..].iter().copied()).collect();
        Ok((per, table_of(&values)?, shape))
    }

    /// The elements that the values belong to.
    pub fn per(&self, py: Python<'_>, map: &InverseMap, values: &Values<'_>) -> PyResult<PerElement> {
        per_element(py, self.per, values, [map.n_vertices(), map.n_faces()])
    }
}

/// Refuses results at so many points for which there is no memory.
fn check_result(py: Python<'_>, n_points: usize, values: &Values<'_>) -> PyResult<()> {
    memory::check_numbers(py, memory::POINT, n_points)?;
    memory::check_numbers(py, memory::RESULT, n_points.saturating_mul(values.row_len()))
}

/// The elements that values belong to, of `n` vertices and `m` faces.
pub fn per_element(
    py: Python<'_>,
    asked: Option<&str>,
    values: &Values<'_>,
    [n, m]: [usize; 2],
) -> PyResult<PerElement> {
    let asked = match asked {
        None => None,
        Some("vertex") => Some(PerElement::Vertex),
        Some("face") => Some(PerElement::Face),
        Some(word) => {
            let message = format!("per must be \"vertex\", \"face\" or None, but is \"{word}\"");
            return Err(bad_option(message));
        }
    };
    let candidates = [(PerElement::Vertex, n), (PerElement::Face, m)];
    let length = values.shape().first().copied();
    let fits =
        |(per, rows): &(PerElement, usize)| asked.is_none_or(|asked| asked == *per) && length == Some(*rows);
    candidates.into_iter().find(fits).map(|(per, _)| per).ok_or_else(|| {
        let expected = match asked {
            None => format!("of shape ({n}, …) per vertex or ({m}, …) per face"),
            Some(PerElement::Vertex) => format!("of shape ({n}, …), one row per vertex"),
            Some(PerElement::Face) => format!("of shape ({m}, …), one row per face"),
        };
        bad_array(py, "values", values.shape_words(), expected)
    })
}
