// SPDX-License-Identifier: MIT OR Apache-2.0
//! Bindings of `authalic::sphere_map`.

use authalic::{LineSearch, SphereMapOptions, SphereMethod};
use numpy::ndarray::ArrayView2;
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;

use crate::arrays::{from_array, from_index_list, from_indices, real_table, reals};
use crate::distortion::Distortion;
use crate::errors::bad_option;
use crate::options::{history, parse_iterations};
use crate::run::run;
use crate::surface::{Given, oriented};

/// A one-to-one map of a closed surface to the unit sphere.
#[pyclass(frozen, get_all, module = "authalic")]
pub struct SphereMap {
    /// (n, 3) float64: the image of each vertex, unit rows; faces are seen counter-clockwise from outside.
    positions: Py<PyArray2<f64>>,
    /// (m, 3) int64: the faces as oriented; those turned against the rest were flipped.
    faces: Py<PyArray2<i64>>,
    /// "converged", "max_iterations", "stalled" or "cancelled". The map is sound whatever it says, and converged is not
    /// even: with a weight of angles, or on long limbs, see `distortion.area_ratio_std`. What stalled on long limbs gets even
    /// with `refine`.
    status: &'static str,
    /// Iterations done, fixed-point steps included.
    iterations: usize,
    /// Structured array of all descents, with `refine` also of those of parts of faces that came to nothing; with the fields
    /// iteration, authalic_energy (of unsigned areas), step, gradient_norm,
    /// seconds; the start first, and a record of step 0 where a mended map took the place of a folded one.
    /// gradient_norm is √(gᵀM⁻¹g), of the gradient in the metric of the preconditioner; 0 for a start that
    /// "gauss_newton" keeps.
    history: Py<PyAny>,
    /// The figures of the map. Where faces are split, the image of a face is that of its parts: its area is their sum, its
    /// angle distortion their mean, and it is folded where one of them is.
    distortion: Py<Distortion>,
    /// The parts of the faces where `refine` asked for them, else None.
    refinement: Option<Py<Refinement>>,
    /// Wall time of the call.
    seconds: f64,
}

/// The faces of a surface, some of them split, and where the split points lie.
///
/// Vertices and split points are numbered through: the first split point has the number of the vertices.
#[pyclass(frozen, get_all, module = "authalic")]
pub struct Refinement {
    /// (k, 2) int64: the ends of the edge that each split point halves, vertices or earlier split points.
    parents: Py<PyArray2<i64>>,
    /// (k, 3) float64: the split points on the surface, in the unit of the vertices.
    vertices: Py<PyArray2<f64>>,
    /// (k, 3) float64: their images, unit rows.
    positions: Py<PyArray2<f64>>,
    /// (m', 3) int64: the faces between vertices and split points, oriented like the faces of the map.
    faces: Py<PyArray2<i64>>,
    /// (m',) int64: the face that each of them is a part of, ascending.
    face_of: Py<PyArray1<i64>>,
    /// The figures of these faces.
    distortion: Py<Distortion>,
}

impl Refinement {
    fn new(py: Python<'_>, found: authalic::Refinement, surface: &authalic::Surface) -> PyResult<Self> {
        Ok(Self {
            vertices: from_array(py, found.vertices(surface)),
            parents: from_indices(py, found.parents.view()),
            positions: from_array(py, found.positions),
            faces: from_indices(py, found.faces.view()),
            face_of: from_index_list(py, found.face_of.into_iter()),
            distortion: Py::new(py, Distortion::new(py, found.distortion))?,
        })
    }
}

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
    /// The map without a refinement.
    pub fn new(py: Python<'_>, map: authalic::SphereMap, faces: ArrayView2<'_, u32>) -> PyResult<Self> {
        Ok(Self {
            positions: from_array(py, map.positions),
            faces: from_indices(py, faces),
            status: map.status.as_str(),
            iterations: map.history.iterations(),
            history: history(py, map.history.records())?,
            distortion: Py::new(py, Distortion::new(py, map.distortion))?,
            refinement: None,
            seconds: map.seconds,
        })
    }
}

#[pymethods]
impl SphereMap {
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

/// Maps a closed surface of genus 0 onto the unit sphere so that areas are kept.
///
/// By default a guarded Gauss–Newton descent: from a map without folds, be it built up vertex by vertex where
/// all else collapses, down to the least E_A, without ever folding a face. The papers' methods (Sutti & Yueh
/// 2024) stay for comparison: a spherical conformal start, the fixed-point iteration of the stretch energy
/// (Algorithm 2) and Riemannian gradient descent after it (Algorithm 1); the folds that they leave are
/// unfolded. No result has a folded face, decided by exact predicates.
///
/// Parameters
/// ----------
/// vertices : (n, 3) real array
///     Positions, any unit. Or a Surface, without `faces`.
/// faces : (m, 3) integer array
///     Triangles of a connected orientable manifold without boundary and without handles.
/// method : {"gauss_newton", "gradient_descent", "fixed_point"}
///     The optimiser.
/// line_search : {"interpolation", "bounded"}
///     How gradient descent finds the length of its steps: sufficient decrease by safeguarded quadratic and
///     cubic interpolation, or Brent's minimiser on a bounded interval, which takes longer and gives no more.
/// density : (m,) real array, optional
///     Positive target measure of each face, on any scale. Default: the face areas.
/// angle_weight : float
///     λ ≥ 0, the weight of the angle distortion against that of areas: 0 (the default) keeps areas alone,
///     .03 is a balance, .3 keeps shapes and lets areas go. For "gauss_newton" only.
/// area_tolerance : float, optional
///     Instead of a weight: the map of least shear whose area deviation √(E_A/A), A the area of the image, is within
///     this tolerance, say .01. The status is "stalled" where no map that even was reached; `max_iterations` limits the
///     whole search. Excludes an `angle_weight`; for "gauss_newton" only. Default: none, `angle_weight` decides.
/// initial : (n, 3) real array, optional
///     A start map, outward oriented, no row zero; rows are normalised. Default: the spherical conformal map,
///     and but for "fixed_point" itself fixed-point steps from it, up to five for "gauss_newton" and ten else.
/// max_iterations : int, optional
///     Default for "gauss_newton": as many as it takes; with a weight of 0 a few where those leave area ratios a
///     deviation of less than .5 % (.2 % below 10,000 vertices); for the papers' methods 100, as in the paper's tables.
///     On top come the fixed-point steps before a descent, and where folds were mended or the result is uneven a second
///     descent. 0 with "fixed_point" returns the start map.
/// tolerance : float, optional
///     "gauss_newton" has converged when the deviation of the area ratio, √(E_A/A), falls below it, default 2e-4
///     (after the usual iterations .5 %, and .2 % below 10,000 vertices), or at a stationary point of the energy;
///     gradient descent when the norm of the Riemannian gradient, gradient_norm of the history, falls below it, default
///     1e-8. For "fixed_point" it is the ε of Algorithm 2, which ends when the stretch energy falls by no more; default
///     1e-6. -inf lets it run through rises to max_iterations and returns the last map instead of the best.
/// refine : bool
///     Split faces whose images are too long for their areas, as on the limbs of a body, and map again from there until
///     areas are even: √(E_A/A) of .002, or the tolerance given, in three rounds at the most. The map is given at the
///     vertices as ever, split points and parts of faces beside them in `refinement`; the images of the vertices alone
///     may fold where a face is split, those of the parts never do. Nothing is split where that does not halve E_A, or where
///     `max_iterations`, which counts for each descent, was reached. For "gauss_newton" only. Default False.
/// unfold : bool
///     Unfold what the papers' methods fold. Default True; False shows what they do by themselves.
/// progress : callable(fraction, message) -> bool, optional
///     Called between iterations and in long steps from within; False cancels and returns the best map so far.
///
/// Returns
/// -------
/// SphereMap
///     Without `initial`, of all rotated copies the one that lies over the surface best.
///
/// Raises
/// ------
/// MeshError
///     The input is no sphere or an array does not fit; nothing was computed.
/// ValueError
///     An option out of its range.
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
                    refine=false, unfold=true, progress=None))]
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
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<SphereMap> {
    // 1. Arguments to plain data
    let (method, line_search) = (parse_method(method)?, parse_line_search(line_search)?);
    let max_iterations = max_iterations.map(parse_iterations).transpose()?;
    let given = Given::new(vertices, faces)?;
    let density = density.map(|density| reals(density, "density")).transpose()?;
    let initial = initial.map(|initial| real_table::<3>(initial, "initial")).transpose()?;
    // 2. The run
    let (mut map, surface) = run(py, progress, move |observer| {
        let surface = given.surface()?;
        let density = density.as_ref().map(|density| density.view());
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
            unfold,
        };
        Ok((authalic::sphere_map(&surface, &options, observer)?, surface))
    })?;
    // 3. The result
    let refinement = map.refinement.take().map(|found| Refinement::new(py, *found, &surface)).transpose()?;
    let refinement = refinement.map(|found| Py::new(py, found)).transpose()?;
    Ok(SphereMap { refinement, ..SphereMap::new(py, map, oriented(&surface))? })
}

fn parse_method(method: &str) -> PyResult<SphereMethod> {
    match method {
        "fixed_point" => Ok(SphereMethod::FixedPoint),
        "gradient_descent" => Ok(SphereMethod::GradientDescent),
        "gauss_newton" => Ok(SphereMethod::GaussNewton),
        other => Err(bad_option(format!(
            "method must be \"gauss_newton\", \"gradient_descent\" or \"fixed_point\", but is {other:?}"
        ))),
    }
}

fn parse_line_search(line_search: &str) -> PyResult<LineSearch> {
    match line_search {
        "interpolation" => Ok(LineSearch::Interpolation),
        "bounded" => Ok(LineSearch::Bounded),
        other => {
            Err(bad_option(format!("line_search must be \"interpolation\" or \"bounded\", but is {other:?}")))
        }
    }
}
