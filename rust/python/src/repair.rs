// SPDX-License-Identifier: MIT OR Apache-2.0
//! Bindings of `authalic::repair`.

use authalic::{
    CloseHandles, CloseHoles, Error, Face, Keep, PerElement, RepairCounts, RepairOptions, Side, Vertex,
};
use numpy::ndarray::{Array1, Array2};
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use pyo3::{Borrowed, FromPyObject};

use crate::arrays::{from_array, frozen};
use crate::errors::{bad_option, internal};
use crate::indices::from_indices;
use crate::lookup::per_element;
use crate::memory;
use crate::options::choice;
use crate::provenance::{Call, Origin, options};
use crate::result::{ResultBase, made, restorable};
use crate::run::run;
use crate::surface::{Given, Surface, handle};
use crate::values::{Values, from_values, table_of};

/// A repaired surface, with maps between it and the mesh given. Taken wherever a Surface is.
#[pyclass(frozen, get_all, extends = ResultBase, module = "authalic")]
pub struct Repaired {
    /// The surface, an oriented manifold unless a piece is one-sided.
    surface: Py<Surface>,
    /// (n, 3) float64: its vertices; those that were kept have the coordinates given.
    vertices: Py<PyArray2<f64>>,
    /// (m, 3) int64: its faces.
    faces: Py<PyArray2<i64>>,
    /// (n,) int64: the given vertex of which each vertex is a copy; -1 for those that were added.
    vertex_of: Py<PyArray1<i64>>,
    /// (m,) int64: the given face that each face is, or is a part of; -1 for those that were added.
    face_of: Py<PyArray1<i64>>,
    /// One int64 per given vertex: the vertex that it became, -1 where it was dropped.
    ///
    /// Where a vertex was split, the first of its copies.
    vertex_to: Py<PyArray1<i64>>,
    /// One int64 per given face: the face that it became, -1 where it was dropped.
    ///
    /// Where a face was split, the first of its parts.
    face_to: Py<PyArray1<i64>>,
    /// The number of repairs of each kind, by name.
    counts: Py<PyDict>,
    /// What was done and what the surface is now, a line for each.
    report: String,
    /// Whether anything was repaired.
    is_changed: bool,
}

impl Repaired {
    /// The repaired surface for Python.
    pub fn new(py: Python<'_>, repaired: authalic::Repaired, origin: Option<Origin>) -> PyResult<Py<Self>> {
        let counts = PyDict::new(py);
        repaired.counts.named().into_iter().try_for_each(|(name, count)| counts.set_item(name, count))?;
        let result = Self {
            vertices: from_array(py, repaired.surface.vertices().to_owned()),
            faces: from_indices(py, repaired.surface.faces().view()),
            vertex_of: from_options(py, &repaired.vertex_of),
            face_of: from_options(py, &repaired.face_of),
            vertex_to: from_options(py, &repaired.vertex_to),
            face_to: from_options(py, &repaired.face_to),
            counts: counts.unbind(),
            report: repaired.report(),
            is_changed: repaired.is_changed(),
            surface: made(py, Surface::from(repaired.surface), None)?,
        };
        made(py, result, origin)
    }
}

restorable!(Repaired {
    surface,
    vertices,
    faces,
    vertex_of,
    face_of,
    vertex_to,
    face_to,
    counts,
    report,
    is_changed
});

#[pymethods]
impl Repaired {
    /// Carries values of the vertices or faces given to those of the surface.
    ///
    /// Copies have the values of their originals. An element that was added takes the mean of its neighbors, from the
    /// surface around it inward. The other way values go by `vertex_to` and `face_to`.
    ///
    /// Parameters
    /// ----------
    /// values : array
    ///     One row per vertex given, or per face given.
    /// per : "vertex" or "face", optional
    ///     The elements that `values` has a row for. Default: as its length says, vertices if both fit.
    /// nearest : bool
    ///     An added element takes the value of a neighbor, of any dtype, instead of a mean: for labels.
    ///
    /// Returns
    /// -------
    /// (n, ...) or (m, ...) array
    ///     float64; with `nearest`, the dtype of `values`.
    ///
    /// Raises
    /// ------
    /// MeshError
    ///     The values have another shape, or without `nearest` are no real numbers.
    /// ValueError
    ///     An option is none of those above.
    ///
    /// Examples
    /// --------
    /// >>> import authalic
    /// >>> points = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 0, 0], [1, 1, 0], [0, 1, 0]]
    /// >>> repaired = authalic.repair(points, [[0, 1, 2], [3, 4, 5]])
    /// >>> repaired.carry([7, 8, 9, 7, 9, 5]).tolist()
    /// [7.0, 8.0, 9.0, 5.0]
    #[pyo3(signature = (values, *, per=None, nearest=false))]
    fn carry(
        &self,
        py: Python<'_>,
        values: &Bound<'_, PyAny>,
        per: Option<&str>,
        nearest: bool,
    ) -> PyResult<Py<PyAny>> {
        let values = Values::new(values, "values")?;
        let given = [self.vertex_to.bind(py).len()?, self.face_to.bind(py).len()?];
        let per = per_element(py, per, &values, given)?;
        let core = self.core(py)?;
        let rest = values.shape()[1..].to_vec();
        let shaped = |n: usize| std::iter::once(n).chain(rest.iter().copied()).collect();
        if nearest {
            let rows = run(py, None, move |_| {
                Ok(match per {
                    PerElement::Vertex => core.nearest_vertices(),
                    PerElement::Face => core.nearest_faces(),
                })
            })?;
            return values.taken(1, &rows, shaped(rows.len()));
        }
        let numbers = table_of(&values)?;
        let carried = run(py, None, move |_| match per {
            PerElement::Vertex => core.values_on_vertices(numbers.view()),
            PerElement::Face => core.values_on_faces(numbers.view()),
        })?;
        let n = carried.nrows();
        from_values(py, carried.into_raw_vec_and_offset().0, shaped(n))
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!(
            "Repaired({} vertices, {} faces: {})",
            self.vertices.bind(py).len()?,
            self.faces.bind(py).len()?,
            self.report.lines().filter(|line| !line.starts_with("result: ")).collect::<Vec<_>>().join("; "),
        ))
    }
}

impl Repaired {
    /// The result as the core has it, without its counts.
    fn core(&self, py: Python<'_>) -> PyResult<authalic::Repaired> {
        let surface = handle(self.surface.bind(py).as_any());
        Ok(authalic::Repaired {
            surface: surface.ok_or_else(|| internal(py, "a repaired surface is none"))?,
            vertex_of: to_options(py, &self.vertex_of, Vertex::new),
            face_of: to_options(py, &self.face_of, Face::new),
            vertex_to: to_options(py, &self.vertex_to, Vertex::new),
            face_to: to_options(py, &self.face_to, Face::new),
            counts: RepairCounts::default(),
        })
    }
}

/// Indices of int64, where −1 is none.
fn to_options<T>(py: Python<'_>, list: &Py<PyArray1<i64>>, index: fn(usize) -> T) -> Vec<Option<T>> {
    let list = list.bind(py).readonly();
    list.as_array().iter().map(|&number| usize::try_from(number).ok().map(index)).collect()
}

/// Indices as int64, -1 where there is none.
fn from_options<T: Copy + Into<usize>>(py: Python<'_>, list: &[Option<T>]) -> Py<PyArray1<i64>> {
    let number = |index: &Option<T>| index.map_or(-1, |index| index.into() as i64);
    frozen(PyArray1::from_iter(py, list.iter().map(number)))
}

/// Makes a mesh a surface that can be mapped: an oriented manifold without faces that have no area.
///
/// In this order: vertices that are NaN or infinite are dropped with their faces, and vertices without a face. Open
/// edges whose ends are equal are joined, and so their points merged. Faces without area are removed so that no hole
/// appears: corners at one place become one, else the longest edge is flipped. Faces that repeat another one are
/// dropped. Edges of three or more faces are split so that parts of a body that touch come apart, and so are vertices
/// in which parts only touch. The faces of each piece are oriented like most of them. Holes and handles are closed as
/// asked for. A sound mesh stays as it is.
///
/// Parameters
/// ----------
/// vertices : (n, 3) real array
///     Positions, any unit. Or a Surface or another mesh object, without `faces`.
/// faces : (m, 3) int array
///     Any triangles.
/// merge : float, bool or None
///     Open edges whose ends are no farther apart than this are joined, in the unit of the vertices. Default 0, as True:
///     equal points. Points that only touch stay apart. None and False merge none.
/// close_holes : bool, int or "pinholes"
///     The holes to close: all, none, or those of at most so many edges. "pinholes" (default): those of at most 8 edges
///     whose area is at most a tenth of that of their piece.
/// keep_outline : bool
///     Leave the longest boundary loop of each piece open, as for a disk. Default False.
/// close_handles : bool, float or "noise"
///     The handles to close: all, none (default), or those that a loop of at most this length opens, in the unit of the
///     vertices. The surface is cut along the loop and closed on both sides, which fills a tunnel or cuts a bridge,
///     whichever loop is shorter. "noise": loops of at most 24 mean edges of their piece, and of at most a tenth of
///     √area, with its area.
/// keep : {"all", "largest"}
///     The pieces to keep: all, or the one of the largest area.
///
/// Returns
/// -------
/// Repaired
///     The surface, maps from and to the vertices and faces given, and a report.
///
/// Raises
/// ------
/// MeshError
///     An array is empty or has another shape, an index is out of range, or no face is left: all are without area or
///     not finite.
/// ValueError
///     An option is out of its range.
///
/// Examples
/// --------
/// Two triangles that do not know of each other, one of them upside down:
///
/// >>> import authalic
/// >>> points = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 0, 0], [1, 1, 0], [0, 1, 0]]
/// >>> repaired = authalic.repair(points, [[0, 1, 2], [3, 5, 4]])
/// >>> print(repaired.report)
/// merged 2 points with others at the same place
/// turned 1 face over
/// result: 4 vertices, 2 faces; 1 piece, 1 boundary loop, 0 handles
/// >>> repaired.vertex_to.tolist()
/// [0, 1, 2, 0, 2, 3]
#[pyfunction]
#[pyo3(signature = (vertices, faces=None, *, merge=Merge(Some(0.0)), close_holes=None, keep_outline=false,
                    close_handles=None, keep="all"),
       text_signature = "(vertices, faces=None, *, merge=0.0, close_holes=\"pinholes\", keep_outline=False, \
                         close_handles=False, keep=\"all\")")]
#[allow(clippy::too_many_arguments)] // keyword arguments of the Python function
pub fn repair(
    py: Python<'_>,
    vertices: &Bound<'_, PyAny>,
    faces: Option<&Bound<'_, PyAny>>,
    merge: Merge,
    close_holes: Option<&Bound<'_, PyAny>>,
    keep_outline: bool,
    close_handles: Option<&Bound<'_, PyAny>>,
    keep: &str,
) -> PyResult<Py<Repaired>> {
    let Merge(merge) = merge;
    let kept = options!(py; merge, close_holes, keep_outline, close_handles, keep)?;
    let options = RepairOptions {
        merge,
        close_holes: close_holes.map(parse_holes).transpose()?.unwrap_or_default(),
        keep_outline,
        close_handles: close_handles.map(parse_handles).transpose()?.unwrap_or_default(),
        keep: choice("keep", keep, &[("all", Keep::All), ("largest", Keep::Largest)])?,
    };
    let given = Given::new(vertices, faces)?;
    memory::check(py, memory::REPAIR, given.n_vertices())?;
    let (repaired, input) = run(py, None, move |_| {
        let input = given.fingerprint();
        Ok((given.repaired(&options)?, input))
    })?;
    Repaired::new(py, repaired, Call::new("repair", &kept, "surface", input).into())
}

fn parse_holes(value: &Bound<'_, PyAny>) -> PyResult<CloseHoles> {
    if let Ok(all) = value.extract::<bool>() {
        return Ok(if all { CloseHoles::All } else { CloseHoles::Off });
    }
    if value.extract::<String>().is_ok_and(|word| word == "pinholes") {
        return Ok(CloseHoles::Pinholes);
    }
    value.extract::<usize>().map(CloseHoles::UpTo).map_err(|_| {
        bad_option(format!("close_holes must be a bool, an integer ≥ 0 or \"pinholes\", but is {value}"))
    })
}

fn parse_handles(value: &Bound<'_, PyAny>) -> PyResult<CloseHandles> {
    if let Ok(all) = value.extract::<bool>() {
        return Ok(if all { CloseHandles::All } else { CloseHandles::Off });
    }
    if value.extract::<String>().is_ok_and(|word| word == "noise") {
        return Ok(CloseHandles::Noise);
    }
    value.extract::<f64>().map(CloseHandles::UpTo).map_err(|_| {
        bad_option(format!("close_handles must be a bool, a length ≥ 0 or \"noise\", but is {value}"))
    })
}

/// The distance within which points are merged; a truth value is none, though Python takes it for a number.
#[derive(Clone, Copy)]
pub struct Merge(Option<f64>);

impl<'py> FromPyObject<'_, 'py> for Merge {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(is_wanted) = given.extract::<bool>() {
            return Ok(Self(is_wanted.then_some(0.0)));
        }
        given.extract().map(Self).map_err(|_: PyErr| {
            let found = given.repr().map_or_else(|_| "something else".into(), |repr| repr.to_string());
            bad_option(format!("merge must be a length ≥ 0, a bool or None, but is {found}"))
        })
    }
}

/// A surface to map, repaired first where that was asked for.
pub struct Prepared {
    pub surface: authalic::Surface,
    /// The density of its faces.
    pub density: Option<Array1<f64>>,
    pub repaired: Option<authalic::Repaired>,
}

impl Prepared {
    /// A surface given with a density of its faces; repaired where there are options for that.
    ///
    /// # Errors
    /// Those of the surface or of the repair.
    pub fn new(
        given: Given,
        density: Option<Array1<f64>>,
        options: Option<&RepairOptions>,
    ) -> Result<Self, Error> {
        let Some(options) = options else {
            return Ok(Self { surface: given.surface()?, density, repaired: None });
        };
        let repaired = given.repaired(options)?;
        let density = density.map(|density| repaired.measure(density.view())).transpose()?;
        Ok(Self { surface: repaired.surface.clone(), density, repaired: Some(repaired) })
    }

    /// The vertices that given ones became.
    pub fn vertices<const N: usize>(
        &self,
        name: &'static str,
        given: [usize; N],
    ) -> Result<[usize; N], Error> {
        let Some(repaired) = &self.repaired else { return Ok(given) };
        if let Some(dropped) = given.iter().find(|&&vertex| repaired.vertex_to[vertex].is_none()) {
            let found = format!("vertex {dropped}, which the repair drops");
            return Err(Error::InvalidArray { name, found, expected: "vertices that stay".into() });
        }
        Ok(given.map(|vertex| repaired.vertex_to[vertex].map_or(0, Vertex::index)))
    }

    /// What a function makes of the surface; an error has the numbers of the vertices and faces given.
    pub fn mapped<T>(&self, map: impl FnOnce(&authalic::Surface) -> Result<T, Error>) -> Result<T, Error> {
        map(&self.surface).map_err(|error| self.in_given_numbers(error))
    }

    /// An error about the surface with the numbers of the vertices and faces given.
    pub fn in_given_numbers(&self, error: Error) -> Error {
        match &self.repaired {
            Some(repaired) => repaired.in_given_numbers(error),
            None => error,
        }
    }

    /// The vertices that landmarks became.
    pub fn landmarks(&self, side: Side, given: Vec<usize>) -> Result<Vec<usize>, Error> {
        match &self.repaired {
            Some(repaired) => repaired.landmarks(side, &given),
            None => Ok(given),
        }
    }

    /// The paths that curves became.
    pub fn curves(&self, side: Side, given: Vec<Vec<usize>>) -> Result<Vec<Vec<usize>>, Error> {
        match &self.repaired {
            Some(repaired) => repaired.curves(side, &given),
            None => Ok(given),
        }
    }

    /// Values (n, k) of the vertices.
    pub fn signals(&self, side: Side, given: Array2<f64>) -> Result<Array2<f64>, Error> {
        let Some(repaired) = &self.repaired else { return Ok(given) };
        repaired.values_on_vertices(given.view()).map_err(|error| error.of_surface(side))
    }
}

/// Refuses a start map for a surface that is repaired first.
pub fn check_no_start(repair: bool, initial: Option<&Bound<'_, PyAny>>) -> PyResult<()> {
    if repair && initial.is_some() {
        return Err(bad_option(
            "initial must be left out with repair=True: it has rows for other vertices; call repair first"
                .into(),
        ));
    }
    Ok(())
}
