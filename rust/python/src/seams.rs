// SPDX-License-Identifier: MIT OR Apache-2.0
//! Bindings of `authalic::seams` and `authalic::unwrap`.

use std::time::Instant;

use authalic::{SeamMethod, SeamOptions, Symmetry, UnwrapOptions, UnwrapSeams};
use numpy::ndarray::{Array1, Array2};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::{Borrowed, FromPyObject};

use crate::arrays::{Reals, from_array, reals};
use crate::errors::{bad_array, bad_option};
use crate::indices::{from_index_list, from_indices, index_table};
use crate::options::choice;
use crate::run::run;
use crate::surface::Given;
use crate::values::Values;

/// Seams of a surface.
#[pyclass(frozen, get_all, module = "authalic")]
pub struct Seams {
    /// (k, 2) int64: the ends of each seam, the lower one first, ascending; the fixed seams among them.
    edges: Py<PyArray2<i64>>,
    /// The number of islands.
    islands: usize,
    /// (m,) int64: the island of each face, numbered by their lowest faces.
    island_of: Py<PyArray1<i64>>,
    /// The length of the seams, each once, over the square root of the surface's area.
    length: f64,
    /// The mean of σ₁/σ₂ over the surface that is predicted for the best maps of the islands.
    predicted: f64,
    /// "converged" if the islands' maps meet the target; "stalled" if they do not.
    status: &'static str,
    /// Wall time of the call.
    seconds: f64,
}

#[pymethods]
impl Seams {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!(
            "Seams({} edges, {} islands, length {:.2}, predicted {:.3}, {}, {:.2} s)",
            self.edges.bind(py).len()?,
            self.islands,
            self.length,
            self.predicted,
            self.status,
            self.seconds,
        ))
    }
}

/// The UVs of a surface.
#[pyclass(frozen, get_all, module = "authalic")]
pub struct Unwrap {
    /// (k, 2) float64 in the unit square: the points, by island, then by vertex.
    uv: Reals,
    /// (m, 3) int64: the faces between points, their corners in the order of the surface's.
    faces: Py<PyArray2<i64>>,
    /// (k,) int64: the vertex of each point.
    vertex_of: Py<PyArray1<i64>>,
    /// The number of islands.
    islands: usize,
    /// (m,) int64: the island of each face.
    island_of: Py<PyArray1<i64>>,
    /// (s, 2) int64: the ends of each seam, the lower one first.
    edges: Py<PyArray2<i64>>,
    /// The length of the seams, each once, over the square root of the surface's area.
    length: f64,
    /// The mean of σ₁/σ₂, weighted by area; 1 preserves angles.
    shear: f64,
    /// The 99th percentile of σ₁/σ₂, weighted by area.
    shear_p99: f64,
    /// The standard deviation of the area ratio, weighted by area; 0: every face has exactly its share.
    area_ratio_std: f64,
    /// The share of the unit square that the islands cover.
    packed: f64,
    /// "converged" if the wanted shear is reached; "stalled" if it is not.
    status: &'static str,
    /// Wall time of the call.
    seconds: f64,
}

#[pymethods]
impl Unwrap {
    fn __repr__(&self) -> String {
        format!(
            "Unwrap({} islands, seam length {:.2}, shear {:.3}, area ratio std {:.4}, {:.0} % packed, {}, {:.2} s)",
            self.islands,
            self.length,
            self.shear,
            self.area_ratio_std,
            100.0 * self.packed,
            self.status,
            self.seconds,
        )
    }
}

/// The options of seams as plain data.
struct Wishes {
    target: f64,
    fixed: Option<Array2<u32>>,
    weights: Option<Array1<f64>>,
    front: Option<[f64; 3]>,
    symmetry: Symmetry,
    max_islands: Option<usize>,
    overlap: bool,
    diagonals: Option<Array2<u32>>,
    method: SeamMethod,
}

impl Wishes {
    fn options(&self) -> SeamOptions<'_> {
        SeamOptions {
            target: self.target,
            fixed: self.fixed.as_ref().map(|edges| edges.view()),
            weights: self.weights.as_ref().map(|weights| weights.view()),
            front: self.front,
            symmetry: self.symmetry,
            max_islands: self.max_islands,
            overlap: self.overlap,
            diagonals: self.diagonals.as_ref().map(|edges| edges.view()),
            method: self.method,
        }
    }
}

/// Arguments that seams and unwraps share, as given.
struct Arguments<'a, 'py> {
    target: f64,
    fixed: Option<&'a Bound<'py, PyAny>>,
    weights: Option<&'a Bound<'py, PyAny>>,
    front: Option<&'a Bound<'py, PyAny>>,
    symmetry: SymmetryWish,
    max_islands: Option<i64>,
    overlap: bool,
    diagonals: Option<&'a Bound<'py, PyAny>>,
    method: &'a str,
}

impl Arguments<'_, '_> {
    fn parse(&self, n_vertices: usize) -> PyResult<Wishes> {
        let table = |edges: Option<&Bound<'_, PyAny>>, name| match edges {
            Some(edges) => index_table::<2>(edges, name, n_vertices).map(Some),
            None => Ok(None),
        };
        Ok(Wishes {
            target: self.target,
            fixed: table(self.fixed, "fixed")?,
            weights: self.weights.map(|weights| reals(weights, "weights")).transpose()?,
            front: self.front.map(direction).transpose()?,
            symmetry: self.symmetry.0,
            max_islands: self.max_islands.map(parse_islands).transpose()?,
            overlap: self.overlap,
            diagonals: table(self.diagonals, "diagonals")?,
            method: choice("method", self.method, &METHODS)?,
        })
    }
}

const METHODS: [(&str, SeamMethod); 2] = [("search", SeamMethod::Search), ("cones", SeamMethod::Cones)];

/// "auto", or "off", which `False` and `None` mean too.
#[derive(Clone, Copy)]
pub struct SymmetryWish(Symmetry);

/// The default of a symmetry.
const AUTO: SymmetryWish = SymmetryWish(Symmetry::Auto);

impl<'py> FromPyObject<'_, 'py> for SymmetryWish {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if given.is_none() {
            return Ok(Self(Symmetry::Off));
        }
        if let Ok(is_wanted) = given.extract::<bool>() {
            return Ok(Self(if is_wanted { Symmetry::Auto } else { Symmetry::Off }));
        }
        match given.extract::<String>().as_deref() {
            Ok("auto") => Ok(Self(Symmetry::Auto)),
            Ok("off") => Ok(Self(Symmetry::Off)),
            _ => Err(bad_option(format!("symmetry must be \"auto\" or \"off\", but is {}", given.repr()?))),
        }
    }
}

/// "auto", or seams, of which `None` means none.
pub enum SeamSource {
    Automatic,
    Given(Option<Py<PyAny>>),
}

impl<'py> FromPyObject<'_, 'py> for SeamSource {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if given.is_none() {
            return Ok(Self::Given(None));
        }
        match given.extract::<String>().as_deref() {
            Ok("auto") => Ok(Self::Automatic),
            Ok(word) => Err(bad_option(format!("seams must be \"auto\", edges or None, but is \"{word}\""))),
            Err(_) => Ok(Self::Given(Some(given.to_owned().unbind()))),
        }
    }
}

fn parse_islands(max_islands: i64) -> PyResult<usize> {
    usize::try_from(max_islands)
        .ok()
        .filter(|&islands| islands > 0)
        .ok_or_else(|| bad_option(format!("max_islands must be ≥ 1, but is {max_islands}")))
}

fn direction(object: &Bound<'_, PyAny>) -> PyResult<[f64; 3]> {
    let given = Values::new(object, "front")?;
    let expected = "of shape (3,), a direction";
    if given.shape() != [3] {
        return Err(bad_array(object.py(), "front", given.shape_words(), expected.into()));
    }
    let reals = given.reals(expected)?;
    Ok([reals[0], reals[1], reals[2]])
}

/// Finds seams along which a surface becomes disks whose area-preserving maps are hardly sheared.
///
/// Docs to come.
#[pyfunction]
#[pyo3(
    signature = (surface, *, target=1.4, fixed=None, weights=None, front=None, symmetry=AUTO, max_islands=None,
        overlap=false, diagonals=None, method="search", progress=None),
    text_signature = "(surface, *, target=1.4, fixed=None, weights=None, front=None, symmetry=\"auto\", \
        max_islands=None, overlap=False, diagonals=None, method=\"search\", progress=None)"
)]
#[expect(clippy::too_many_arguments, reason = "the options of the Python function")]
pub fn seams(
    py: Python<'_>,
    surface: &Bound<'_, PyAny>,
    target: f64,
    fixed: Option<&Bound<'_, PyAny>>,
    weights: Option<&Bound<'_, PyAny>>,
    front: Option<&Bound<'_, PyAny>>,
    symmetry: SymmetryWish,
    max_islands: Option<i64>,
    overlap: bool,
    diagonals: Option<&Bound<'_, PyAny>>,
    method: &str,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Seams> {
    // 1. Arguments to plain data
    let began = Instant::now();
    let given = Given::pair(surface, ["surface", "surface vertices", "surface faces"])?;
    let arguments =
        Arguments { target, fixed, weights, front, symmetry, max_islands, overlap, diagonals, method };
    let wishes = arguments.parse(given.n_vertices())?;
    // 2. The run
    let seams =
        run(py, progress, move |observer| authalic::seams(&given.surface()?, &wishes.options(), observer))?;
    // 3. The result
    Ok(Seams {
        edges: from_indices(py, seams.edges.view()),
        islands: seams.islands,
        island_of: from_index_list(py, seams.island_of.iter().map(|&island| island as usize)),
        length: seams.length,
        predicted: seams.predicted,
        status: seams.status.as_str(),
        seconds: began.elapsed().as_secs_f64(),
    })
}

/// Cuts a surface, maps its islands at one density, and packs them into the unit square.
///
/// Docs to come.
#[pyfunction]
#[pyo3(
    signature = (surface, *, seams=SeamSource::Automatic, target=1.4, fixed=None, weights=None, front=None,
        symmetry=AUTO, max_islands=None, overlap=false, diagonals=None, margin=0.002, rotate=true, progress=None),
    text_signature = "(surface, *, seams=\"auto\", target=1.4, fixed=None, weights=None, front=None, \
        symmetry=\"auto\", max_islands=None, overlap=False, diagonals=None, margin=0.002, rotate=True, progress=None)"
)]
#[expect(clippy::too_many_arguments, reason = "the options of the Python function")]
pub fn unwrap(
    py: Python<'_>,
    surface: &Bound<'_, PyAny>,
    seams: SeamSource,
    target: f64,
    fixed: Option<&Bound<'_, PyAny>>,
    weights: Option<&Bound<'_, PyAny>>,
    front: Option<&Bound<'_, PyAny>>,
    symmetry: SymmetryWish,
    max_islands: Option<i64>,
    overlap: bool,
    diagonals: Option<&Bound<'_, PyAny>>,
    margin: f64,
    rotate: bool,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Unwrap> {
    // 1. Arguments to plain data
    let began = Instant::now();
    let given = Given::pair(surface, ["surface", "surface vertices", "surface faces"])?;
    let method = "search";
    let arguments =
        Arguments { target, fixed, weights, front, symmetry, max_islands, overlap, diagonals, method };
    let wishes = arguments.parse(given.n_vertices())?;
    let edges = match seams {
        SeamSource::Automatic => None,
        SeamSource::Given(None) => Some(Array2::zeros((0, 2))),
        SeamSource::Given(Some(edges)) => {
            Some(index_table::<2>(edges.bind(py), "seams", given.n_vertices())?)
        }
    };
    // 2. The run
    let map = run(py, progress, move |observer| {
        let seams = match &edges {
            None => UnwrapSeams::Automatic(wishes.options()),
            Some(edges) => UnwrapSeams::Given(edges.view()),
        };
        let options = UnwrapOptions { seams, overlap, margin, rotate };
        authalic::unwrap(&given.surface()?, &options, observer)
    })?;
    // 3. The result
    Ok(Unwrap {
        uv: from_array(py, map.uv),
        faces: from_indices(py, map.faces.view()),
        vertex_of: from_index_list(py, map.vertex_of.iter().map(|vertex| vertex.index())),
        islands: map.islands,
        island_of: from_index_list(py, map.island_of.iter().map(|&island| island as usize)),
        edges: from_indices(py, map.edges.view()),
        length: map.length,
        shear: map.shear,
        shear_p99: map.shear_p99,
        area_ratio_std: map.area_ratio_std,
        packed: map.packed,
        status: map.status.as_str(),
        seconds: began.elapsed().as_secs_f64(),
    })
}
