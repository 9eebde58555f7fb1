// SPDX-License-Identifier: MIT OR Apache-2.0
//! Bindings of `authalic::sphere_map`.

use std::sync::Arc;

use authalic::{
    Grid, Icosphere, InverseMap, LineSearch, Outside, RefinedFaces, RepairOptions, SphereFaces,
    SphereFilling, SphereMapOptions, SphereMethod,
};
use numpy::ndarray::{ArrayView2, Axis, Slice, concatenate};
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Reals, from_array, frozen, real_table, reals};
use crate::distortion::Distortion;
use crate::errors::{bad_option, to_python};
use crate::indices::{from_index_list, from_indices, index_table, narrowed};
use crate::layout::{Arguments, Layout, layout};
use crate::lookup::{Beyond, Conservative, Invertible, Located, Lookup, Request, Shape, image_of, locate};
use crate::memory;
use crate::options::{history, parse_iterations};
use crate::provenance::{Call, Origin, options};
use crate::repair::{Prepared, Repaired, check_no_start};
use crate::result::{Restorable, ResultBase, State, made, restorable};
use crate::run::run;
use crate::surface::{Given, Surface, oriented};

/// A one-to-one map of a closed surface to the unit sphere.
#[pyclass(frozen, extends = ResultBase, module = "authalic")]
pub struct SphereMap {
    /// (n, 3) float64: the image of each vertex, unit rows; faces are seen counter-clockwise from outside.
    #[pyo3(get)]
    positions: Py<PyArray2<f64>>,
    /// (m, 3) int64: the faces as oriented; faces turned against the rest are flipped.
    #[pyo3(get)]
    faces: Py<PyArray2<i64>>,
    /// "converged", "max_iterations", "stalled" or "cancelled".
    ///
    /// The map is sound in every case. A converged map need not be even, see `distortion.area_ratio_std`; on long
    /// limbs `refine` makes it even.
    #[pyo3(get)]
    status: &'static str,
    /// Iterations done, fixed-point steps included.
    #[pyo3(get)]
    iterations: usize,
    /// One record per iteration, the start first, as a structured array.
    ///
    /// Its fields are iteration, authalic_energy (of unsigned areas), step, gradient_norm, seconds. A record of step
    /// 0 stands where a mended map replaced a folded one. gradient_norm is √(gᵀM⁻¹g), the norm of the gradient in the
    /// preconditioner's metric; 0 for a start that "gauss_newton" keeps. With `refine`, it has the records of all
    /// descents, even discarded ones.
    #[pyo3(get)]
    history: Py<PyAny>,
    /// The figures of the map.
    ///
    /// The image of a split face consists of those of its parts: its area is their sum, its angle distortion their
    /// mean, and it is folded if one of them is.
    #[pyo3(get)]
    distortion: Py<Distortion>,
    /// The split faces, with `refine`; else None.
    #[pyo3(get)]
    refinement: Option<Py<Refinement>>,
    /// The repaired surface that was mapped, with `repair`; else None.
    #[pyo3(get)]
    repaired: Option<Py<Repaired>>,
    /// Wall time of the call.
    #[pyo3(get)]
    seconds: f64,
    /// What `layout` lays out.
    sphere: Arc<SphereFaces>,
    inverse: Lookup,
}

/// The faces of a surface, some of them split, and the split points.
///
/// Split points are numbered on from the vertices: the first has the number n.
#[pyclass(frozen, extends = ResultBase, module = "authalic")]
pub struct Refinement {
    /// (k, 2) int64: the ends of the edge that each split point halves: vertices, or earlier split points.
    #[pyo3(get)]
    parents: Py<PyArray2<i64>>,
    /// (k, 3) float64: the split points on the surface, in the unit of the vertices.
    #[pyo3(get)]
    vertices: Py<PyArray2<f64>>,
    /// (k, 3) float64: the images of the split points, unit rows.
    #[pyo3(get)]
    positions: Py<PyArray2<f64>>,
    /// (m', 3) int64: the faces between vertices and split points, oriented as the faces of the map.
    #[pyo3(get)]
    faces: Py<PyArray2<i64>>,
    /// (m',) int64: the given face that each of `faces` is a part of, ascending.
    #[pyo3(get)]
    face_of: Py<PyArray1<i64>>,
    /// The figures of these faces.
    #[pyo3(get)]
    distortion: Py<Distortion>,
}

impl Refinement {
    fn new(
        py: Python<'_>,
        refinement: authalic::Refinement,
        surface: &authalic::Surface,
    ) -> PyResult<Py<Self>> {
        let refinement = Self {
            vertices: from_array(py, refinement.vertices(surface)),
            parents: from_indices(py, refinement.parents.view()),
            positions: from_array(py, refinement.positions),
            faces: from_indices(py, refinement.faces.view()),
            face_of: from_index_list(py, refinement.face_of.into_iter()),
            distortion: Distortion::new(py, refinement.distortion)?,
        };
        made(py, refinement, None)
    }
}

restorable!(Refinement { parents, vertices, positions, faces, face_of, distortion });

#[pymethods]
impl Refinement {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!(
            "Refinement({} split points, {} faces, {})",
            self.parents.bind(py).len()?,
            self.faces.bind(py).len()?,
            self.distortion.bind(py).repr()?,
        ))
    }
}

impl SphereMap {
    /// The map, what is laid out of it, its split faces and the repaired surface.
    pub fn new(
        py: Python<'_>,
        map: authalic::SphereMap,
        faces: ArrayView2<'_, u32>,
        sphere: SphereFaces,
        (refinement, repaired): (Option<Py<Refinement>>, Option<Py<Repaired>>),
        call: Option<Call>,
    ) -> PyResult<Py<Self>> {
        let map = Self {
            positions: from_array(py, map.positions),
            faces: from_indices(py, faces),
            status: map.status.as_str(),
            iterations: map.history.iterations(),
            history: history(py, map.history.records())?,
            distortion: Distortion::new(py, map.distortion)?,
            refinement,
            repaired,
            seconds: map.seconds,
            sphere: Arc::new(sphere),
            inverse: Lookup::default(),
        };
        made(py, map, call.map(Origin::Call))
    }
}

impl Restorable for SphereMap {
    const FIELDS: &'static [&'static str] = &[
        "positions",
        "faces",
        "status",
        "iterations",
        "history",
        "distortion",
        "refinement",
        "repaired",
        "seconds",
        "_targets",
        "_filling",
    ];

    fn restored(state: &State<'_>) -> PyResult<Self> {
        let (positions, faces) = (state.object("positions")?, state.object("faces")?);
        let refinement: Option<Py<Refinement>> = state.get("refinement")?;
        let targets: Vec<f64> = reals(&state.object("_targets")?, "_targets")?.to_vec();
        let mut sphere = laid_out(&positions, &faces, refinement.as_ref().map(Py::get), targets)?;
        if let Some(filling) = state.optional::<Bound<'_, PyDict>>("_filling")? {
            let filling = filling_of(State(filling), &sphere)?;
            sphere = sphere.filled(&filling).map_err(|error| to_python(state.py(), &error))?;
        }
        Ok(Self {
            positions: state.get("positions")?,
            faces: state.get("faces")?,
            status: state.status()?,
            iterations: state.get("iterations")?,
            history: state.get("history")?,
            distortion: state.get("distortion")?,
            refinement,
            repaired: state.get("repaired")?,
            seconds: state.get("seconds")?,
            sphere: Arc::new(sphere),
            inverse: Lookup::default(),
        })
    }
}

/// The faces on the sphere of a saved map.
fn laid_out(
    positions: &Bound<'_, PyAny>,
    faces: &Bound<'_, PyAny>,
    refinement: Option<&Refinement>,
    targets: Vec<f64>,
) -> PyResult<SphereFaces> {
    let py = positions.py();
    let positions = real_table::<3>(positions, "positions")?;
    let n_vertices = positions.nrows();
    let (points, faces, face_of) = match refinement {
        None => (positions, index_table::<3>(faces, "faces", n_vertices)?, None),
        Some(refinement) => {
            let split = refinement.positions.bind(py).readonly();
            let points = concatenate![Axis(0), positions, split.as_array()];
            let face_of = refinement.face_of.bind(py).readonly().as_array().mapv(|face| face as usize);
            (points, narrowed(refinement.faces.bind(py)), Some(face_of.to_vec()))
        }
    };
    let image = authalic::Surface::new(points, faces).map_err(|error| to_python(py, &error))?;
    Ok(SphereFaces { image, targets, face_of, n_vertices, n_filling: 0 })
}

/// What fills the holes of a saved map.
fn filling_of(state: State<'_>, map: &SphereFaces) -> PyResult<SphereFilling> {
    let positions = real_table::<3>(&state.object("positions")?, "positions")?;
    let n_points = map.n_vertices + positions.nrows();
    Ok(SphereFilling {
        faces: index_table::<3>(&state.object("faces")?, "faces", n_points)?,
        targets: reals(&state.object("targets")?, "targets")?.to_vec(),
        positions,
    })
}

impl Invertible for SphereMap {
    fn inverse(&self, py: Python<'_>) -> PyResult<Arc<InverseMap>> {
        self.inverse.get(py, || {
            let (positions, faces) = (self.positions.bind(py).readonly(), narrowed(self.faces.bind(py)));
            let Some(refinement) = self.refinement.as_ref().map(Py::get) else {
                return InverseMap::of_positions(positions.as_array(), faces.view(), None);
            };
            let [parents, parts] = [&refinement.parents, &refinement.faces]
                .map(|rows| rows.bind(py).readonly().as_array().mapv(|k| k as u32));
            let face_of = refinement.face_of.bind(py).readonly().as_array().mapv(|face| face as usize);
            let split = refinement.positions.bind(py).readonly();
            let refined = RefinedFaces {
                parents: parents.view(),
                positions: split.as_array(),
                faces: parts.view(),
                face_of: face_of.as_slice().expect("one row"),
            };
            InverseMap::of_positions(positions.as_array(), faces.view(), Some(refined))
        })
    }
}

#[pymethods]
impl SphereMap {
    /// (m,) or (m',) float64: the target measure of each face of the map or of its refinement, for saved maps.
    #[getter]
    fn _targets(&self, py: Python<'_>) -> Py<PyArray1<f64>> {
        frozen(PyArray1::from_slice(py, &self.sphere.targets[..self.sphere.n_laid_out()]))
    }

    /// What fills the holes of an open surface on the sphere, for saved maps: a dict, or None.
    #[getter]
    fn _filling<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let (sphere, first) = (&self.sphere, self.sphere.n_laid_out());
        if sphere.n_filling == 0 {
            return Ok(None);
        }
        let filling = PyDict::new(py);
        let positions = sphere.image.vertices();
        let inside = positions.slice_axis(Axis(0), Slice::from(sphere.n_vertices..)).to_owned();
        filling.set_item("positions", from_array(py, inside))?;
        let faces = sphere.image.faces();
        filling.set_item("faces", from_indices(py, faces.slice_axis(Axis(0), Slice::from(first..))))?;
        filling.set_item("targets", frozen(PyArray1::from_slice(py, &sphere.targets[first..])))?;
        Ok(Some(filling))
    }

    /// Finds the places on the surface whose images are given points.
    ///
    /// Parameters
    /// ----------
    /// points : (k, 3) real array
    ///     Points of the sphere, of which only the directions count.
    ///
    /// Returns
    /// -------
    /// triangles : (k,) int64 array
    ///     The face of each place, of the lowest index where several share the point; -1 in holes, with `fill_holes`.
    /// barycentric : (k, 3) float64 array
    ///     The weights of the corners of that face in `faces`, not negative, with sum 1; NaN where there is none.
    ///
    /// Raises
    /// ------
    /// MeshError
    ///     The points have another shape, or are zero or not finite.
    ///
    /// Examples
    /// --------
    /// >>> import authalic
    /// >>> corners = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]
    /// >>> ball = authalic.sphere_map(corners, [[0, 1, 2], [0, 2, 3], [0, 3, 1], [3, 2, 1]])
    /// >>> triangles, barycentric = ball.locate([[1, 1, -1], [0, 0, -3]])
    /// >>> triangles.tolist(), barycentric[0].round(3).tolist()
    /// ([0, 0], [0.333, 0.333, 0.333])
    fn locate(&self, py: Python<'_>, points: &Bound<'_, PyAny>) -> PyResult<Located> {
        locate(py, self.inverse(py)?, real_table::<3>(points, "points")?, Outside::Nowhere)
    }

    /// Maps places on the surface: the inverse of `locate`.
    ///
    /// Parameters
    /// ----------
    /// triangles : (k,) int array
    ///     Faces; -1 for no place.
    /// barycentric : (k, 3) real array
    ///     The weights of their corners.
    ///
    /// Returns
    /// -------
    /// (k, 3) float64 array
    ///     Unit rows; NaN where there is no place.
    ///
    /// Raises
    /// ------
    /// MeshError
    ///     An array has another shape, or a face is out of range.
    ///
    /// Examples
    /// --------
    /// >>> import authalic
    /// >>> corners = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]
    /// >>> ball = authalic.sphere_map(corners, [[0, 1, 2], [0, 2, 3], [0, 3, 1], [3, 2, 1]])
    /// >>> ball.image_of([0], [[1, 1, 1]]).round(3).tolist()
    /// [[0.577, 0.577, -0.577]]
    fn image_of(
        &self,
        py: Python<'_>,
        triangles: &Bound<'_, PyAny>,
        barycentric: &Bound<'_, PyAny>,
    ) -> PyResult<Reals> {
        image_of(py, self.inverse(py)?, triangles, barycentric)
    }

    /// Carries values of the surface to points of its image.
    ///
    /// Parameters
    /// ----------
    /// values : (n, ...) or (m, ...) array
    ///     One row per vertex, interpolated linearly on each face, or one per face.
    /// points : (k, 3) real array
    ///     Points of the sphere, of which only the directions count.
    /// per : "vertex" or "face", optional
    ///     The elements that `values` has a row for. Default: as its length says, vertices if both fit.
    /// nearest : bool
    ///     Take the value of the corner with the largest weight, of any dtype, instead of interpolating: for labels.
    ///
    /// Returns
    /// -------
    /// (k, ...) array
    ///     float64; with `nearest`, the dtype of `values`.
    ///
    /// Raises
    /// ------
    /// MeshError
    ///     The points or values have another shape, or without `nearest` are no real numbers.
    /// ValueError
    ///     An option is none of those above.
    ///
    /// Examples
    /// --------
    /// >>> import authalic
    /// >>> corners = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]
    /// >>> ball = authalic.sphere_map(corners, [[0, 1, 2], [0, 2, 3], [0, 3, 1], [3, 2, 1]])
    /// >>> ball.sample([0, 0, 0, 1], [[-1, -1, 1], [1, 1, -1]]).tolist()
    /// [1.0, 0.0]
    #[pyo3(signature = (values, points, *, per=None, nearest=false))]
    fn sample(
        &self,
        py: Python<'_>,
        values: &Bound<'_, PyAny>,
        points: &Bound<'_, PyAny>,
        per: Option<&str>,
        nearest: bool,
    ) -> PyResult<Py<PyAny>> {
        let points = real_table::<3>(points, "points")?;
        let request = Request { values, per, nearest, beyond: Beyond::new(None)? };
        request.at(py, self.inverse(py)?, points)
    }

    /// Lays values out as a picture of the sphere, by equal steps of latitude and longitude.
    ///
    /// Row 0 lies at the north pole (+z), and column 0 at the longitude −180°, counted from +x towards +y. The center of
    /// cell (i, j) has the latitude 90° − (i + 1/2) 180°/rows, and the longitude (j + 1/2) 360°/columns − 180°.
    ///
    /// Parameters
    /// ----------
    /// values : (n, ...) or (m, ...) array
    ///     One row per vertex or per face.
    /// shape : (int, int)
    ///     The numbers of rows and columns.
    /// per : "vertex" or "face", optional
    ///     The elements that `values` has a row for. Default: as its length says, vertices if both fit.
    /// nearest : bool
    ///     Take the value of the corner with the largest weight, of any dtype, instead of interpolating: for labels.
    /// conservative : bool or "total"
    ///     False: the value at the center of a cell. True: the mean over the cell, weighted by area on the sphere;
    ///     times the cells' areas, these add up to the integral over the sphere. "total": that integral over each cell.
    ///     Values per vertex count on each face by the mean of its corners.
    ///
    /// Returns
    /// -------
    /// (rows, columns, ...) array
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
    /// >>> corners = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]
    /// >>> ball = authalic.sphere_map(corners, [[0, 1, 2], [0, 2, 3], [0, 3, 1], [3, 2, 1]])
    /// >>> picture = ball.equirectangular([0, 0, 0, 1], (90, 180), conservative="total")
    /// >>> picture.shape, picture.sum().round(6).item()  # a quarter of 4π
    /// ((90, 180), 3.141593)
    #[pyo3(signature = (values, shape, *, per=None, nearest=false, conservative=Conservative::No),
           text_signature = "($self, values, shape, *, per=None, nearest=False, conservative=False)")]
    #[allow(clippy::too_many_arguments)] // keyword arguments of the Python method
    fn equirectangular(
        &self,
        py: Python<'_>,
        values: &Bound<'_, PyAny>,
        shape: Shape,
        per: Option<&str>,
        nearest: bool,
        conservative: Conservative,
    ) -> PyResult<Py<PyAny>> {
        let Shape([rows, columns]) = shape;
        let request = Request { values, per, nearest, beyond: Beyond::new(None)? };
        request.in_cells(py, self.inverse(py)?, Grid::Equirectangular { rows, columns }, conservative)
    }

    /// Lays values out on a grid whose cells all have one area (Lambert's cylindrical projection).
    ///
    /// Row 0 lies at the north pole (+z), and column 0 at the longitude −180°, counted from +x towards +y. Rows are
    /// equal steps of the height z, from +1 down to −1, and columns of longitude: the center of cell (i, j) has the
    /// height 1 − (2 i + 1)/n, and the longitude (j + 1/2) 180°/n − 180°. All cells have the area 2π/n², so that a plain
    /// mean over them is the mean over the sphere. Other grids of points, such as HEALPix, go by `sample`:
    /// `ball.sample(values, np.transpose(healpy.pix2vec(nside, np.arange(12 * nside**2))))`.
    ///
    /// Parameters
    /// ----------
    /// values : (n, ...) or (m, ...) array
    ///     One row per vertex or per face.
    /// n : int
    ///     The number of rows. There are 2 n columns.
    /// per : "vertex" or "face", optional
    ///     The elements that `values` has a row for. Default: as its length says, vertices if both fit.
    /// nearest : bool
    ///     Take the value of the corner with the largest weight, of any dtype, instead of interpolating: for labels.
    /// conservative : bool or "total"
    ///     False: the value at the center of a cell. True: the mean over the cell, weighted by area on the sphere;
    ///     times the cells' areas, these add up to the integral over the sphere. "total": that integral over each cell.
    ///     Values per vertex count on each face by the mean of its corners.
    ///
    /// Returns
    /// -------
    /// (n, 2 n, ...) array
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
    /// >>> corners = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]
    /// >>> ball = authalic.sphere_map(corners, [[0, 1, 2], [0, 2, 3], [0, 3, 1], [3, 2, 1]])
    /// >>> ball.equal_area_grid([0, 0, 0, 1], 32, conservative=True).mean().round(9).item()
    /// 0.25
    #[pyo3(signature = (values, n, *, per=None, nearest=false, conservative=Conservative::No),
           text_signature = "($self, values, n, *, per=None, nearest=False, conservative=False)")]
    #[allow(clippy::too_many_arguments)] // keyword arguments of the Python method
    fn equal_area_grid(
        &self,
        py: Python<'_>,
        values: &Bound<'_, PyAny>,
        n: i64,
        per: Option<&str>,
        nearest: bool,
        conservative: Conservative,
    ) -> PyResult<Py<PyAny>> {
        let Some(rows) = usize::try_from(n).ok().filter(|&rows| rows > 0) else {
            return Err(bad_option(format!("n must be ≥ 1, but is {n}")));
        };
        let columns = rows.saturating_mul(2);
        let request = Request { values, per, nearest, beyond: Beyond::new(None)? };
        request.in_cells(py, self.inverse(py)?, Grid::EqualArea { rows, columns }, conservative)
    }

    /// Carries values to the vertices of an icosphere.
    ///
    /// Maps of many surfaces to one icosphere have vertices in common. The icosahedron has a vertex at +z and one at −z;
    /// each level divides every face in four.
    ///
    /// Parameters
    /// ----------
    /// values : (n, ...) or (m, ...) array
    ///     One row per vertex or per face.
    /// level : int
    ///     0 to 10; the icosphere has 10 · 4^level + 2 vertices.
    /// per : "vertex" or "face", optional
    ///     The elements that `values` has a row for. Default: as its length says, vertices if both fit.
    /// nearest : bool
    ///     Take the value of the corner with the largest weight, of any dtype, instead of interpolating: for labels.
    /// conservative : bool or "total"
    ///     False: the value at each vertex. True: the mean around each vertex, weighted by area on the sphere, where a
    ///     face of the icosphere gives a third of what it has to each corner; times the areas (a third of those of the
    ///     faces at each vertex), these add up to the integral over the sphere. "total": that integral around each vertex.
    ///     Values per vertex count on each face by the mean of its corners.
    ///
    /// Returns
    /// -------
    /// values : (k, ...) array
    ///     float64; with `nearest`, the dtype of `values`.
    /// icosphere : Surface
    ///     Its vertices are unit rows; those of a coarser level come first.
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
    /// >>> corners = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]
    /// >>> ball = authalic.sphere_map(corners, [[0, 1, 2], [0, 2, 3], [0, 3, 1], [3, 2, 1]])
    /// >>> values, icosphere = ball.resample([0, 0, 0, 1], 2)
    /// >>> values.shape, icosphere
    /// ((162,), Surface(162 vertices, 320 faces))
    #[pyo3(signature = (values, level, *, per=None, nearest=false, conservative=Conservative::No),
           text_signature = "($self, values, level, *, per=None, nearest=False, conservative=False)")]
    #[allow(clippy::too_many_arguments)] // keyword arguments of the Python method
    fn resample(
        &self,
        py: Python<'_>,
        values: &Bound<'_, PyAny>,
        level: i64,
        per: Option<&str>,
        nearest: bool,
        conservative: Conservative,
    ) -> PyResult<(Py<PyAny>, Py<Surface>)> {
        let level = usize::try_from(level)
            .map_err(|_| bad_option(format!("level must be 0 to 10, but is {level}")))?;
        let (icosphere, surface) = run(py, None, move |_| {
            let icosphere = Icosphere::new(level)?;
            let surface = icosphere.surface()?;
            Ok((Arc::new(icosphere), surface))
        })?;
        let request = Request { values, per, nearest, beyond: Beyond::new(None)? };
        let values = request.on_icosphere(py, self.inverse(py)?, icosphere, conservative)?;
        Ok((values, made(py, Surface::from(surface), None)?))
    }

    /// Lays the map out in the plane, cut open along a seam: areas are preserved, no face is folded.
    ///
    /// A vertex is moved onto each singular point of the layout, the images of the faces are joined in the plane, and
    /// Levenberg–Marquardt steps even out the areas, which straight edges change near poles and across creases. Exact
    /// predicates on the rounded points decide that no face is folded. A refined map is laid out with the parts of its
    /// faces. Holes that `fill_holes` has filled for the map are so for the layout too, and open in the result.
    ///
    /// Parameters
    /// ----------
    /// kind : {"lambert", "octahedral"}
    ///     "lambert": Lambert's cylindrical equal-area projection (1772), (λ, z) of longitude λ and height z. About 2π
    ///     wide, 2 high; faces on the seam extend beyond the right side, and each pole becomes a line. "octahedral":
    ///     the equal-area octahedral map (Clarberg 2008), r (1 − 2φ/π, 2φ/π) with r = √(1 − |z|) in each octant. A
    ///     square of side √(4π) around the origin, with the pole in its middle and the opposite pole in its corners;
    ///     the half turn about the middle of a side glues the side to itself.
    /// pole : {"x", "y", "z"} or (3,) real array
    ///     The direction, in the coordinates of `positions`, of the top or the middle of the layout. Default "z".
    /// seam : float or (3,) real array
    ///     The left side of a Lambert layout, or the upper side of the square: a direction, whose component
    ///     perpendicular to the pole counts, or an angle about the pole in radians, counter-clockwise seen from outside
    ///     above the pole. Angles begin at +y, for poles within 45° of ±y at −z. Default 0.
    /// polygons : (m,) int array, optional
    ///     The number of each face's polygon: faces with one number that meet at an edge are not cut apart, areas are
    ///     those of polygons, and rows of quads stay rows. Default: each face is a polygon.
    /// density : (m,) real array, optional
    ///     Positive target measure of each face, on any scale. Default: the measure of the map.
    /// candidates : (k,) int or (n,) bool array, optional
    ///     The vertices that may be moved onto singular points: the two poles of "lambert", four points of the equator,
    ///     at the middles of the sides, for "octahedral". Default: all.
    /// precision : {"float64", "float32"}
    ///     The precision of the points, in which no face is folded; "float32" for programs with such UVs.
    /// progress : callable(fraction, message) -> bool, optional
    ///     Called between and within steps; False cancels, and the layout is returned if it has no folds.
    ///
    /// Returns
    /// -------
    /// Layout
    ///     A corner at a pole of "lambert" lies in the middle of the other corners of its polygon.
    ///
    /// Raises
    /// ------
    /// MeshError
    ///     An array does not fit, or the map has holes of which it does not know how they were filled, as the rough map
    ///     of a registration by curves. Nothing is computed.
    /// ValueError
    ///     An option is out of its range.
    /// SolverError
    ///     Faces would fold wherever the singular points are put, as on a tetrahedron; then `indices` has the first few
    ///     faces and `count` their number. Or the call was cancelled before there was a layout without folds.
    ///
    /// Examples
    /// --------
    /// >>> import authalic
    /// >>> points = [[3, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0], [0, 0, -1]]
    /// >>> upper, lower = [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2]], [[1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]]
    /// >>> layout = authalic.sphere_map(points, upper + lower).layout("lambert", precision="float32")
    /// >>> layout.faces.shape, layout.points.dtype.name, len(layout.vertex_of) == len(layout.points)
    /// ((8, 3), 'float32', True)
    #[pyo3(signature = (kind="lambert", *, pole=None, seam=None, polygons=None, density=None, candidates=None,
                        precision="float64", progress=None),
           text_signature = "($self, kind=\"lambert\", *, pole=\"z\", seam=0.0, polygons=None, density=None, \
                             candidates=None, precision=\"float64\", progress=None)")]
    #[allow(clippy::too_many_arguments)] // keyword arguments of the Python method
    fn layout(
        &self,
        py: Python<'_>,
        kind: &str,
        pole: Option<&Bound<'_, PyAny>>,
        seam: Option<&Bound<'_, PyAny>>,
        polygons: Option<&Bound<'_, PyAny>>,
        density: Option<&Bound<'_, PyAny>>,
        candidates: Option<&Bound<'_, PyAny>>,
        precision: &str,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Py<Layout>> {
        let arguments = Arguments { kind, pole, seam, polygons, density, candidates, precision, progress };
        layout(py, self.sphere.clone(), &arguments)
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!(
            "SphereMap({} vertices, {} after {} iterations, {:.2} s, {})",
            self.positions.bind(py).len()?,
            self.status,
            self.iterations,
            self.seconds,
            self.distortion.bind(py).repr()?,
        ))
    }
}

/// Maps a closed surface of genus 0 onto the unit sphere so that areas are preserved.
///
/// The default is a guarded Gauss–Newton descent: it starts from a map without folds, built up vertex by vertex if
/// other starts collapse, and lowers E_A without ever folding a face. The papers' methods (Sutti & Yueh 2024)
/// remain for comparison: a spherical conformal start, the fixed-point iteration of the stretch energy
/// (Algorithm 2) and Riemannian gradient descent after it (Algorithm 1); the folds that they leave are unfolded. No
/// result has a folded face unless `unfold` is off; exact predicates decide.
///
/// Parameters
/// ----------
/// vertices : (n, 3) real array
///     Positions, any unit. Or a Surface or another mesh object, without `faces`.
/// faces : (m, 3) int array
///     Triangles of a connected orientable manifold without boundary and without handles.
/// method : {"gauss_newton", "gradient_descent", "fixed_point"}
///     The optimizer.
/// line_search : {"interpolation", "bounded"}
///     The line search of the gradient descent: sufficient decrease by safeguarded quadratic and cubic interpolation,
///     or Brent's minimizer on a bounded interval, which takes longer and is no more exact.
/// density : (m,) real array, optional
///     Positive target measure of each face, on any scale. Default: the face areas.
/// angle_weight : float
///     Weight λ ≥ 0 of the angle distortion against that of areas: 0 (default) preserves areas alone, .03 is a
///     balance, .3 preserves shapes at the expense of areas. For "gauss_newton" only.
/// area_tolerance : float, optional
///     Instead of a weight: the map of least shear whose area deviation √(E_A/A), with A the area of the image, is
///     within this tolerance, such as .01. The status is "stalled" if no map reached it; `max_iterations` limits the
///     whole search. Excludes `angle_weight`; for "gauss_newton" only. Default: `angle_weight` decides.
/// initial : (n, 3) real array, optional
///     A start map, outward oriented, no row zero; rows are normalized. Default: the spherical conformal map, followed
///     by up to five fixed-point steps for "gauss_newton" and ten for "gradient_descent".
/// max_iterations : int, optional
///     Iteration limit. Default for "gauss_newton": none, but with a weight of 0 and no tolerance it stops after 17
///     iterations (20 below 20,000 vertices, 40 below 10,000) once the area deviation is below .5 % (.2 % below 10,000
///     vertices); for the papers' methods 100, as in the paper's tables. Not counted: the fixed-point steps before the
///     descent, and a descent after folds were mended. 0 with "fixed_point" returns the start map.
/// tolerance : float, optional
///     "gauss_newton" has converged when the area deviation √(E_A/A) is below this, default 2e-4, or at a stationary
///     point of the energy; "gradient_descent" when the norm of the Riemannian gradient, the gradient_norm of the
///     history, is below this, default 1e-8. For "fixed_point" it is ε of Algorithm 2: the iteration ends when the
///     stretch energy falls by no more than this, default 1e-6; -inf makes it take all iterations, even if the energy
///     rises, and return the last map instead of the best.
/// refine : bool
///     Split faces that keep areas uneven, as those of long limbs do, and continue the map until √(E_A/A) is below
///     .002, or the tolerance given, in at most three rounds. `refinement` has the split points and the parts of faces.
///     The parts never fold; the images of the vertices alone may, where a face is split. Nothing is split if that does
///     not halve E_A, or if `max_iterations`, which applies to each descent, was reached. For "gauss_newton" only.
///     Default False.
/// unfold : bool
///     Unfold the faces that the papers' methods fold. Default True.
/// fill_holes : bool
///     Fill all holes for the time of the map instead of refusing a surface with holes, which then stay open on the
///     sphere, at about the size that they have on the surface. Not with `initial` or `refine`. Default False.
/// repair : bool
///     Repair the surface first, as the function `repair` does: its largest piece, without pinholes and handles of
///     noise. The map is then that of its `repaired`, while a density is that of the faces given. Default False.
/// progress : callable(fraction, message) -> bool, optional
///     Called between iterations and within long steps; False cancels and returns the best map so far.
///
/// Returns
/// -------
/// SphereMap
///     Without `initial`, the map is rotated to align with the surface.
///
/// Raises
/// ------
/// MeshError
///     The input is no sphere, or an array does not fit. Nothing is computed.
/// ValueError
///     An option is out of its range.
/// SolverError
///     Every start folds in double precision, or the call was cancelled before there was a map without folds.
///
/// Examples
/// --------
/// >>> import authalic
/// >>> points = [[3, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0], [0, 0, -1]]
/// >>> upper, lower = [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2]], [[1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]]
/// >>> result = authalic.sphere_map(points, upper + lower)
/// >>> result.positions.shape, len(result.distortion.folded)
/// ((6, 3), 0)
#[pyfunction]
#[pyo3(signature = (vertices, faces=None, *, method="gauss_newton", line_search="interpolation", density=None,
                    angle_weight=0.0, area_tolerance=None, initial=None, max_iterations=None, tolerance=None,
                    refine=false, unfold=true, fill_holes=false, repair=false, progress=None))]
#[allow(clippy::too_many_arguments)] // keyword arguments of the Python function
pub fn sphere_map(
    py: Python<'_>,
    vertices: &Bound<'_, PyAny>,
    faces: Option<&Bound<'_, PyAny>>,
    method: &str,
    line_search: &str,
    density: Option<&Bound<'_, PyAny>>,
    angle_weight: f64,
    area_tolerance: Option<f64>,
    initial: Option<&Bound<'_, PyAny>>,
    max_iterations: Option<i64>,
    tolerance: Option<f64>,
    refine: bool,
    unfold: bool,
    fill_holes: bool,
    repair: bool,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Py<SphereMap>> {
    // 1. Arguments to plain data
    let kept = options!(
        py; method, line_search, density, angle_weight, area_tolerance, initial, max_iterations, tolerance, refine, unfold,
        fill_holes, repair
    )?;
    let (method, line_search) = (parse_method(method)?, parse_line_search(line_search)?);
    let max_iterations = max_iterations.map(parse_iterations).transpose()?;
    let given = Given::new(vertices, faces)?;
    let density = density.map(|density| reals(density, "density")).transpose()?;
    check_no_start(repair, initial)?;
    let repair = repair.then(|| RepairOptions::for_a_map(false));
    let initial = initial.map(|initial| real_table::<3>(initial, "initial")).transpose()?;
    memory::check(py, memory::MAP, given.n_vertices())?;
    // 2. The run
    let (mut map, prepared, sphere, input) = run(py, progress, move |observer| {
        let input = given.fingerprint();
        let prepared = Prepared::new(given, density, repair.as_ref())?;
        let density = prepared.density.as_ref().map(|density| density.view());
        let initial = initial.as_ref().map(|initial| initial.view());
        let options = SphereMapOptions {
            method,
            line_search,
            density,
            angle_weight,
            area_tolerance,
            initial,
            max_iterations,
            tolerance,
            refine,
            fill_holes,
            unfold,
        };
        let (map, sphere) = prepared.mapped(|surface| {
            let map = authalic::sphere_map(surface, &options, observer)?;
            let sphere = map.faces_on_sphere(surface.oriented_faces()?.view())?;
            Ok((map, sphere))
        })?;
        Ok((map, prepared, sphere, input))
    })?;
    // 3. The result
    let Prepared { surface, repaired, .. } = prepared;
    let repaired = repaired.map(|repaired| Repaired::new(py, repaired, None)).transpose()?;
    let refinement = map.refinement.take().map(|refinement| Refinement::new(py, *refinement, &surface));
    let call = Call::new("sphere_map", &kept, "surface", input);
    let parts = (refinement.transpose()?, repaired);
    SphereMap::new(py, map, oriented(&surface).view(), sphere, parts, Some(call))
}

fn parse_method(method: &str) -> PyResult<SphereMethod> {
    match method {
        "fixed_point" => Ok(SphereMethod::FixedPoint),
        "gradient_descent" => Ok(SphereMethod::GradientDescent),
        "gauss_newton" => Ok(SphereMethod::GaussNewton),
        unknown => Err(bad_option(format!(
            "method must be \"gauss_newton\", \"gradient_descent\" or \"fixed_point\", but is {unknown:?}"
        ))),
    }
}

fn parse_line_search(line_search: &str) -> PyResult<LineSearch> {
    match line_search {
        "interpolation" => Ok(LineSearch::Interpolation),
        "bounded" => Ok(LineSearch::Bounded),
        unknown => Err(bad_option(format!(
            "line_search must be \"interpolation\" or \"bounded\", but is {unknown:?}"
        ))),
    }
}
