// SPDX-License-Identifier: MIT OR Apache-2.0
//! Bindings of `authalic::disk_map`.

use std::sync::Arc;

use authalic::{Boundary, DiskMapOptions, DiskMethod, Error, Grid, InverseMap, Record, RepairOptions};
use numpy::ndarray::{Array1, ArrayView2};
use numpy::{PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;

use crate::arrays::{Items, Reals, from_array, real_table, reals, reals_of_each};
use crate::distortion::Distortion;
use crate::errors::{bad_array, bad_option, to_python};
use crate::indices::{from_indices, index_list, narrowed};
use crate::lookup::{Beyond, Conservative, Invertible, Located, Lookup, Request, Shape, image_of, locate};
use crate::memory;
use crate::options::{history, parse_iterations};
use crate::provenance::{Call, Fingerprint, Origin, options};
use crate::repair::{Prepared, Repaired, check_no_start};
use crate::result::{Restorable, ResultBase, State, made};
use crate::run::run;
use crate::surface::{Given, oriented};
use crate::values::Values;

/// A map of a disk to the unit disk or onto a rectangle, one-to-one but for `overlap`.
#[pyclass(frozen, extends = ResultBase, module = "authalic")]
pub struct DiskMap {
    /// (n, 2) float64: the image of each vertex in the unit disk, or on the rectangle asked for.
    #[pyo3(get)]
    uv: Reals,
    /// (m, 3) int64: the faces as oriented; faces turned against the rest are flipped.
    #[pyo3(get)]
    faces: Py<PyArray2<i64>>,
    /// "converged", "max_iterations", "stalled" or "cancelled". The map is sound in every case.
    #[pyo3(get)]
    status: &'static str,
    /// Iterations done, fixed-point steps included.
    #[pyo3(get)]
    iterations: usize,
    /// The figures of the map.
    #[pyo3(get)]
    distortion: Py<Distortion>,
    /// The repaired surface that was mapped, with `repair`; else None.
    #[pyo3(get)]
    repaired: Option<Py<Repaired>>,
    /// Wall time of the call.
    #[pyo3(get)]
    seconds: f64,
    records: Vec<Record>,
    history: PyOnceLock<Py<PyAny>>,
    inverse: Lookup,
}

impl DiskMap {
    pub fn new(
        py: Python<'_>,
        map: authalic::DiskMap,
        faces: ArrayView2<'_, u32>,
        repaired: Option<Py<Repaired>>,
        call: Option<Call>,
    ) -> PyResult<Py<Self>> {
        let map = Self {
            uv: from_array(py, map.uv),
            faces: from_indices(py, faces),
            status: map.status.as_str(),
            iterations: map.history.iterations(),
            records: map.history.records().to_vec(),
            history: PyOnceLock::new(),
            distortion: Distortion::new(py, map.distortion)?,
            repaired,
            seconds: map.seconds,
            inverse: Lookup::default(),
        };
        made(py, map, call.map(Origin::Call))
    }
}

impl Restorable for DiskMap {
    const FIELDS: &'static [&'static str] =
        &["uv", "faces", "status", "iterations", "history", "distortion", "repaired", "seconds"];

    fn restored(state: &State<'_>) -> PyResult<Self> {
        let history = PyOnceLock::new();
        history.set(state.py(), state.get("history")?).expect("it is empty");
        Ok(Self {
            uv: state.get("uv")?,
            faces: state.get("faces")?,
            status: state.status()?,
            iterations: state.get("iterations")?,
            distortion: state.get("distortion")?,
            repaired: state.get("repaired")?,
            seconds: state.get("seconds")?,
            records: Vec::new(),
            history,
            inverse: Lookup::default(),
        })
    }
}

impl Invertible for DiskMap {
    fn inverse(&self, py: Python<'_>) -> PyResult<Arc<InverseMap>> {
        self.inverse.get(py, || {
            let (uv, faces) = (self.uv.bind(py).readonly(), narrowed(self.faces.bind(py)));
            InverseMap::of_disk(uv.as_array(), faces.view())
        })
    }
}

impl DiskMap {
    /// The left, right, lower and upper side of the square around the unit disk, or of the rectangle.
    fn extent(&self, py: Python<'_>) -> [f64; 4] {
        let uv = self.uv.bind(py).readonly();
        let uv = uv.as_array();
        // a rectangle has its lower left corner at the origin, and a disk has it in the middle
        if uv.iter().any(|&x| x < 0.0) {
            return [-1.0, 1.0, -1.0, 1.0];
        }
        let largest = |axis: usize| uv.column(axis).iter().fold(0.0, |most: f64, &x| most.max(x));
        [0.0, largest(0), 0.0, largest(1)]
    }
}

/// The sides of a picture.
fn parse_extent(extent: &Bound<'_, PyAny>) -> PyResult<[f64; 4]> {
    let expected = "of shape (4,), the left, right, lower and upper side";
    let given = Values::new(extent, "extent")?;
    if given.shape() != [4] {
        return Err(bad_array(extent.py(), "extent", given.shape_words(), expected.into()));
    }
    let sides = given.reals(expected)?;
    Ok([sides[0], sides[1], sides[2], sides[3]])
}

#[pymethods]
impl DiskMap {
    /// Finds the places on the surface whose images are given points.
    ///
    /// Parameters
    /// ----------
    /// points : (k, 2) real array
    ///     Points of the disk, or of the rectangle or outline.
    /// outside : "nearest", optional
    ///     Points outside the image, as beyond its boundary edges or in a hole, take the nearest place on its boundary.
    ///     By default they have none. Points within 1e-12 count as on it.
    ///
    /// Returns
    /// -------
    /// triangles : (k,) int64 array
    ///     The face of each place, of the lowest index where several share the point; -1 where there is none.
    /// barycentric : (k, 3) float64 array
    ///     The weights of the corners of that face in `faces`, not negative, with sum 1; NaN where there is none.
    ///
    /// Raises
    /// ------
    /// MeshError
    ///     The points have another shape, or are not finite.
    ///
    /// Examples
    /// --------
    /// >>> import authalic
    /// >>> square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]]
    /// >>> disk = authalic.disk_map(*square)
    /// >>> triangles, barycentric = disk.locate([[0, 0], [2, 0]])
    /// >>> triangles.tolist(), barycentric[0].round(3).tolist()
    /// ([0, -1], [0.5, 0.0, 0.5])
    #[pyo3(signature = (points, *, outside=None))]
    fn locate(
        &self,
        py: Python<'_>,
        points: &Bound<'_, PyAny>,
        outside: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Located> {
        locate(py, self.inverse(py)?, real_table::<2>(points, "points")?, Beyond::new(outside)?.outside)
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
    /// (k, 2) float64 array
    ///     NaN where there is no place.
    ///
    /// Raises
    /// ------
    /// MeshError
    ///     An array has another shape, or a face is out of range.
    ///
    /// Examples
    /// --------
    /// >>> import authalic
    /// >>> square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]]
    /// >>> disk = authalic.disk_map(*square)
    /// >>> disk.image_of([0], [[0.5, 0, 0.5]]).shape
    /// (1, 2)
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
    /// points : (k, 2) real array
    ///     Points of the disk, or of the rectangle or outline.
    /// per : "vertex" or "face", optional
    ///     The elements that `values` has a row for. Default: as its length says, vertices if both fit.
    /// nearest : bool
    ///     Take the value of the corner with the largest weight, of any dtype, instead of interpolating: for labels.
    /// outside : "nearest" or number
    ///     Points outside the image take the value of the nearest place on its boundary, or this number. Default NaN,
    ///     or 0 for values of a dtype without NaN.
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
    /// >>> square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]]
    /// >>> disk = authalic.disk_map(*square)
    /// >>> disk.sample(square[0], [[0, 0], [2, 0]]).round(3).tolist()
    /// [[0.5, 0.5, 0.0], [nan, nan, nan]]
    #[pyo3(signature = (values, points, *, per=None, nearest=false, outside=None))]
    fn sample(
        &self,
        py: Python<'_>,
        values: &Bound<'_, PyAny>,
        points: &Bound<'_, PyAny>,
        per: Option<&str>,
        nearest: bool,
        outside: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Py<PyAny>> {
        let points = real_table::<2>(points, "points")?;
        let request = Request { values, per, nearest, beyond: Beyond::new(outside)? };
        request.at(py, self.inverse(py)?, points)
    }

    /// Draws values as a picture of the disk or the rectangle.
    ///
    /// Row 0 is the upper one, and pixels have the values at their centers, as `matplotlib.pyplot.imshow(picture,
    /// extent=extent)` shows them.
    ///
    /// Parameters
    /// ----------
    /// values : (n, ...) or (m, ...) array
    ///     One row per vertex or per face.
    /// shape : (int, int)
    ///     The numbers of rows and columns.
    /// extent : (4,) real array, optional
    ///     The left, right, lower and upper side of the picture. Default: (-1, 1, -1, 1), the square around the unit
    ///     disk; for a map onto a rectangle, that rectangle.
    /// per : "vertex" or "face", optional
    ///     The elements that `values` has a row for. Default: as its length says, vertices if both fit.
    /// nearest : bool
    ///     Take the value of the corner with the largest weight, of any dtype, instead of interpolating: for labels.
    /// conservative : bool or "total"
    ///     False: the value at the center of a pixel. True: the mean over the part of it that the image covers, weighted
    ///     by area. "total": the integral over that part; all of them add up to the integral over the image. Values per
    ///     vertex count on each face by the mean of its corners.
    /// outside : "nearest" or number
    ///     What pixels outside the image get: the value of the nearest place on its boundary, or this number. Default
    ///     NaN, or 0 for values of a dtype without NaN.
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
    /// >>> square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]]
    /// >>> disk = authalic.disk_map(*square)
    /// >>> disk.image([0, 0, 1, 1], (64, 64)).shape
    /// (64, 64)
    /// >>> disk.image([1, 1, 1, 1], (64, 64), conservative="total").sum().round(9).item()  # the area of the image
    /// 2.0
    #[pyo3(signature = (values, shape, *, extent=None, per=None, nearest=false, conservative=Conservative::No,
                        outside=None),
           text_signature = "($self, values, shape, *, extent=None, per=None, nearest=False, conservative=False, \
                             outside=None)")]
    #[allow(clippy::too_many_arguments)] // keyword arguments of the Python method
    fn image(
        &self,
        py: Python<'_>,
        values: &Bound<'_, PyAny>,
        shape: Shape,
        extent: Option<&Bound<'_, PyAny>>,
        per: Option<&str>,
        nearest: bool,
        conservative: Conservative,
        outside: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Py<PyAny>> {
        let Shape([rows, columns]) = shape;
        let extent = extent.map_or_else(|| Ok(self.extent(py)), parse_extent)?;
        let request = Request { values, per, nearest, beyond: Beyond::new(outside)? };
        request.in_cells(py, self.inverse(py)?, Grid::Planar { rows, columns, extent }, conservative)
    }

    /// One record per iteration, the start first, as a structured array.
    ///
    /// Its fields are iteration, authalic_energy, step, gradient_norm, seconds. gradient_norm is √(gᵀM⁻¹g), the norm
    /// of the gradient in the preconditioner's metric; 0 for a start that "gauss_newton" keeps.
    #[getter]
    fn history(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        Ok(self.history.get_or_try_init(py, || history(py, &self.records))?.clone_ref(py))
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!(
            "DiskMap({} vertices, {} after {} iterations, {:.2} s, {})",
            self.uv.bind(py).len()?,
            self.status,
            self.iterations,
            self.seconds,
            self.distortion.bind(py).repr()?,
        ))
    }
}

/// Maps a disk to the unit disk, or onto a rectangle, so that areas are preserved.
///
/// The default is a guarded Gauss–Newton descent: it starts from a map without folds, built up vertex by vertex if
/// other starts collapse, and lowers E_A without ever folding a face. The papers' methods (Liu & Yueh 2023) remain
/// for comparison: a harmonic start with an arc-length boundary, fixed-point steps (equation 2.5) and
/// preconditioned nonlinear conjugate gradients (Algorithm 3.1); the folds that they leave are unfolded. No result
/// has a folded face; exact predicates decide.
///
/// Parameters
/// ----------
/// vertices : (n, 3) real array
///     Positions, any unit. Or a Surface or another mesh object, without `faces`.
/// faces : (m, 3) int array
///     Triangles of an orientable manifold with one boundary loop and no handles.
/// method : {"gauss_newton", "conjugate_gradient", "fixed_point"}
///     The optimizer.
/// boundary : {"sliding", "arc_length", "free", "rectangle"}
///     "sliding" (default): boundary vertices slide along the circle in their order. "arc_length": they stay at arcs
///     proportional to the edge lengths, as in the papers. "free": they take any outline that does not cross itself,
///     scaled into the unit disk; with an `angle_weight` it suits angles and areas, and holes are as free as the
///     longest loop. "rectangle": four lie at the corners of a rectangle and the others slide along its sides; its
///     lower left corner is (0, 0), its longer side 1. The last two are for "gauss_newton" only.
/// density : (m,) real array, optional
///     Positive target measure of each face, on any scale. Default: the face areas.
/// angle_weight : float
///     Weight λ ≥ 0 of the angle distortion against that of areas: 0 (default) preserves areas alone, .03 is a
///     balance, .3 preserves shapes at the expense of areas. For "gauss_newton" only.
/// area_tolerance : float, optional
///     Instead of a weight: the map of least shear whose area deviation √(E_A/A), with A the area of the image, is
///     within this tolerance, such as .01. The status is "stalled" if no map reached it; `max_iterations` limits the
///     whole search. Excludes `angle_weight`; for "gauss_newton" only. Default: `angle_weight` decides.
/// initial : (n, 2) real array, optional
///     A start map of a mesh with one boundary loop, which runs once around the unit circle, or along the sides of an
///     upright rectangle. With a free boundary: any map, used if it has no folds and its outline does not cross
///     itself. Default: harmonic map and five fixed-point steps; with a free boundary the best of plan view,
///     as-rigid-as-possible and conformal map.
/// max_iterations : int, optional
///     Iteration limit. Default for "gauss_newton": none, but with a weight of 0 and no tolerance it stops after 11
///     iterations (33 below 10,000 vertices) once the area deviation is below .5 % (.2 %); for the papers' methods 50,
///     as in the paper's tables. Not counted: up to five fixed-point steps at the start, steps that unfold it, and a
///     descent after folds were mended.
/// tolerance : float, optional
///     "gauss_newton" has converged when the area deviation √(E_A/A) is below this, default 2e-4, or at a stationary
///     point of the energy; with a free boundary and an `angle_weight` only at such a point. The papers' methods have
///     converged when √(gᵀM⁻¹g), the gradient_norm of the history, is below this, default 1e-8.
/// fill_holes : bool
///     Fill all boundary loops but the longest virtually instead of refusing them; with a free boundary they stay
///     open. Default False.
/// overlap : bool
///     Let a free boundary cross itself, which distorts angles less where limbs would meet in the plane. Default
///     False: maps are one-to-one. ValueError unless the boundary is "free".
/// corners : (4,) int array, optional
///     For a rectangle: the boundary vertices at its corners, counter-clockwise from the lower left. Default: where the
///     boundary turns most, and if there are fewer than four such places, the middles of the longest sides between
///     them; laid out with z, or on flat surfaces y, up. Corners are refused if an inner edge joins two vertices of one
///     side, since its faces would be flat.
/// aspect : float, optional
///     For a rectangle: width over height, from 1e-4 to 1e4. Default: the aspect of least angle distortion,
///     found along with the map.
/// repair : bool
///     Repair the surface first, as the function `repair` does: its largest piece, without pinholes and handles of
///     noise, with its longest boundary loop. The map is then that of its `repaired`, while a density and corners are
///     those of the faces and vertices given. Default False.
/// progress : callable(fraction, message) -> bool, optional
///     Called between iterations and within long steps; False cancels and returns the best map so far.
///
/// Returns
/// -------
/// DiskMap
///     Without `initial`, the map is rotated: the lowest-numbered vertex of the (longest) boundary lies at (1, 0), or
///     with a free boundary to the right of the mean of all vertices.
///
/// Raises
/// ------
/// MeshError
///     The input is no disk, or an array, the corners or the start map do not fit. Nothing is computed.
/// ValueError
///     An option is out of its range.
/// SolverError
///     Every start folds in double precision, or the call was cancelled before there was a map without folds.
///
/// Examples
/// --------
/// >>> import authalic
/// >>> pyramid = [[0, 0, 1], [1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]]
/// >>> result = authalic.disk_map(pyramid, [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]])
/// >>> result.uv.shape, len(result.distortion.folded)
/// ((5, 2), 0)
#[pyfunction]
#[pyo3(signature = (vertices, faces=None, *, method="gauss_newton", boundary="sliding", density=None, angle_weight=0.0,
                    area_tolerance=None, initial=None, max_iterations=None, tolerance=None, fill_holes=false,
                    overlap=false, corners=None, aspect=None, repair=false, progress=None))]
#[allow(clippy::too_many_arguments)] // keyword arguments of the Python function
pub fn disk_map(
    py: Python<'_>,
    vertices: &Bound<'_, PyAny>,
    faces: Option<&Bound<'_, PyAny>>,
    method: &str,
    boundary: &str,
    density: Option<&Bound<'_, PyAny>>,
    angle_weight: f64,
    area_tolerance: Option<f64>,
    initial: Option<&Bound<'_, PyAny>>,
    max_iterations: Option<i64>,
    tolerance: Option<f64>,
    fill_holes: bool,
    overlap: bool,
    corners: Option<&Bound<'_, PyAny>>,
    aspect: Option<f64>,
    repair: bool,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Py<DiskMap>> {
    // 1. Arguments to plain data
    let kept = options!(
        py; method, boundary, density, angle_weight, area_tolerance, initial, max_iterations, tolerance, fill_holes,
        overlap, corners, aspect, repair
    )?;
    let (method, boundary) = (parse_method(method)?, parse_boundary(boundary)?);
    let max_iterations = max_iterations.map(parse_iterations).transpose()?;
    let given = Given::new(vertices, faces)?;
    let density = density.map(|density| reals(density, "density")).transpose()?;
    check_no_start(repair, initial)?;
    let repair = repair.then(|| RepairOptions::for_a_map(true));
    let initial = initial.map(|initial| real_table::<2>(initial, "initial")).transpose()?;
    let corners = corners.map(|corners| parse_corners(corners, given.n_vertices())).transpose()?;
    memory::check(py, memory::MAP, given.n_vertices())?;
    // 2. The run
    let (map, prepared, input) = run(py, progress, move |observer| {
        let input = given.fingerprint();
        let prepared = Prepared::new(given, density, repair.as_ref())?;
        let density = prepared.density.as_ref().map(|density| density.view());
        let corners = corners.map(|corners| prepared.vertices("corners", corners)).transpose()?;
        let initial = initial.as_ref().map(|initial| initial.view());
        let options = DiskMapOptions {
            method,
            boundary,
            density,
            angle_weight,
            area_tolerance,
            initial,
            max_iterations,
            tolerance,
            fill_holes,
            overlap,
            corners,
            aspect,
        };
        let map = prepared.mapped(|surface| authalic::disk_map(surface, &options, observer))?;
        Ok((map, prepared, input))
    })?;
    // 3. The result
    let Prepared { surface, repaired, .. } = prepared;
    let repaired = repaired.map(|repaired| Repaired::new(py, repaired, None)).transpose()?;
    let call = Call::new("disk_map", &kept, "surface", input);
    DiskMap::new(py, map, oriented(&surface).view(), repaired, Some(call))
}

/// Maps many disks in one go, which is much faster than one by one where they are small.
///
/// Every map is what `disk_map` makes of its surface with the same options, which are explained there.
///
/// Parameters
/// ----------
/// surfaces : sequence of Surface, Patch or (vertices, faces)
///     The disks.
/// densities : sequence of (m,) real arrays or None, optional
///     The target measures of the faces of each surface. Default: the face areas.
/// method : {"gauss_newton", "conjugate_gradient", "fixed_point"}
///     The optimizer. This and the following options are as for `disk_map`, and the same for all surfaces.
/// boundary : {"sliding", "arc_length", "free", "rectangle"}
///     Where the boundaries go.
/// angle_weight : float
///     Weight of the angle distortion.
/// area_tolerance : float, optional
///     Area deviation within which to look for the map of least shear.
/// max_iterations : int, optional
///     Iteration limit.
/// tolerance : float, optional
///     When a descent has converged.
/// fill_holes : bool
///     Fill all boundary loops but the longest virtually.
/// overlap : bool
///     Let free boundaries cross themselves.
/// repair : bool
///     Repair each surface first. The map is then that of its `repaired`, while densities are those of the faces given.
/// progress : callable(fraction, message) -> bool, optional
///     Called between surfaces and within large ones; False ends the run.
///
/// Returns
/// -------
/// list of DiskMap, MeshError, SolverError or None
///     The map of each surface, or why it has none. None for those that were not begun when `progress` ended the run.
///
/// Raises
/// ------
/// MeshError
///     The arrays of a surface have a wrong shape or index.
/// ValueError
///     An option is out of its range.
///
/// Examples
/// --------
/// >>> import authalic
/// >>> triangle = [[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]
/// >>> pyramid = [[0, 0, 1], [1, 0, 0], [0, 1, 0], [-1, 0, 0]], [[0, 1, 2], [0, 2, 3], [0, 3, 1]]
/// >>> [len(each.uv) for each in authalic.disk_maps([triangle, pyramid], boundary="free", angle_weight=0.001)]
/// [3, 4]
#[pyfunction]
#[pyo3(signature = (surfaces, *, densities=None, method="gauss_newton", boundary="sliding", angle_weight=0.0,
                    area_tolerance=None, max_iterations=None, tolerance=None, fill_holes=false, overlap=false,
                    repair=false, progress=None))]
#[allow(clippy::too_many_arguments)] // keyword arguments of the Python function
pub fn disk_maps(
    py: Python<'_>,
    surfaces: Items<Bound<'_, PyAny>>,
    densities: Option<Items<Option<Bound<'_, PyAny>>>>,
    method: &str,
    boundary: &str,
    angle_weight: f64,
    area_tolerance: Option<f64>,
    max_iterations: Option<i64>,
    tolerance: Option<f64>,
    fill_holes: bool,
    overlap: bool,
    repair: bool,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Vec<Option<Py<PyAny>>>> {
    // 1. Arguments to plain data
    let kept = options!(
        py; method, boundary, angle_weight, area_tolerance, max_iterations, tolerance, fill_holes, overlap,
        repair
    )?;
    let (method, boundary) = (parse_method(method)?, parse_boundary(boundary)?);
    let max_iterations = max_iterations.map(parse_iterations).transpose()?;
    let names = ["surfaces", "vertices", "faces"];
    let given = surfaces.0.iter().map(|each| Given::pair(each, names)).collect::<PyResult<Vec<_>>>()?;
    let densities = reals_of_each(py, densities, ["densities", "density"], given.len())?;
    let repair = repair.then(|| RepairOptions::for_a_map(true));
    let largest = given.iter().map(Given::n_vertices).max().unwrap_or(0);
    memory::check(py, memory::MAP, largest)?;
    // 2. The run
    let (maps, prepared) = run(py, progress, move |observer| {
        let prepared = prepared_each(given.into_iter().zip(densities), repair.as_ref())?;
        let with_options = prepared.iter().filter_map(|(each, _)| each.as_ref().ok()).map(|each| {
            let options = DiskMapOptions {
                method,
                boundary,
                density: each.density.as_ref().map(|density| density.view()),
                angle_weight,
                area_tolerance,
                max_iterations,
                tolerance,
                fill_holes,
                overlap,
                ..Default::default()
            };
            (each.surface.clone(), options)
        });
        let maps = authalic::disk_maps(&with_options.collect::<Vec<_>>(), observer);
        Ok((maps, prepared))
    })?;
    // 3. The results
    let mut maps = maps.into_iter();
    let results = prepared.into_iter().map(|(prepared, input)| match prepared {
        Err(error) => refused(py, error).map(Some),
        Ok(prepared) => match maps.next().flatten().map(|map| prepared.mapped(|_| map)) {
            None => Ok(None),
            Some(Err(error)) => refused(py, error).map(Some),
            Some(Ok(map)) => {
                let Prepared { surface, repaired, .. } = prepared;
                let repaired = repaired.map(|repaired| Repaired::new(py, repaired, None)).transpose()?;
                let call = Call::new("disk_maps", &kept, "surface", input);
                let map = DiskMap::new(py, map, oriented(&surface).view(), repaired, Some(call))?;
                Ok(Some(map.into_any()))
            }
        },
    });
    results.collect()
}

/// A surface of many, or why there is none, and the fingerprint of what was given.
type PreparedOfMany = (Result<Prepared, Error>, Fingerprint);

/// The surfaces with their densities, repaired where there are options for that.
///
/// # Errors
/// Arrays that are no surface; where they are repaired, what no repair mends is an error of its own surface.
fn prepared_each(
    given: impl Iterator<Item = (Given, Option<Array1<f64>>)>,
    repair: Option<&RepairOptions>,
) -> Result<Vec<PreparedOfMany>, Error> {
    let prepare = |(given, density): (Given, _)| {
        let input = given.fingerprint();
        let prepared = Prepared::new(given, density, repair);
        if repair.is_none() { Ok((Ok(prepared?), input)) } else { Ok((prepared, input)) }
    };
    given.map(prepare).collect()
}

/// An error as the result of one surface of many; options that are wrong for all are raised.
fn refused(py: Python<'_>, error: Error) -> PyResult<Py<PyAny>> {
    let raised = to_python(py, &error);
    if matches!(error, Error::InvalidOption { .. }) {
        return Err(raised);
    }
    Ok(raised.into_value(py).into_any())
}

fn parse_method(method: &str) -> PyResult<DiskMethod> {
    match method {
        "fixed_point" => Ok(DiskMethod::FixedPoint),
        "conjugate_gradient" => Ok(DiskMethod::ConjugateGradient),
        "gauss_newton" => Ok(DiskMethod::GaussNewton),
        unknown => Err(bad_option(format!(
            "method must be \"gauss_newton\", \"conjugate_gradient\" or \"fixed_point\", but is {unknown:?}"
        ))),
    }
}

fn parse_boundary(boundary: &str) -> PyResult<Boundary> {
    match boundary {
        "arc_length" => Ok(Boundary::ArcLength),
        "sliding" => Ok(Boundary::Sliding),
        "free" => Ok(Boundary::Free),
        "rectangle" => Ok(Boundary::Rectangle),
        unknown => Err(bad_option(format!(
            "boundary must be \"sliding\", \"arc_length\", \"free\" or \"rectangle\", but is {unknown:?}"
        ))),
    }
}

/// The corners of a rectangle.
fn parse_corners(corners: &Bound<'_, PyAny>, n_vertices: usize) -> PyResult<[usize; 4]> {
    let list = index_list(corners, "corners", "corner", n_vertices)?;
    let found = format!("of shape ({},)", list.len());
    list.try_into()
        .map_err(|_| bad_array(corners.py(), "corners", found, "of shape (4,), boundary vertices".into()))
}
