// SPDX-License-Identifier: MIT OR Apache-2.0
//! The result of a registration, for Python.

use std::sync::Arc;

use authalic::{Corner, Correspondence, DiskMap, Error, History, RoughSphere, SphereMap, Status, Vertex};
use numpy::ndarray::{Array1, Array2, Array3, ArrayView2, aview1};
use numpy::{PyArray1, PyArray2, PyArray3};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::certificates::Certificates;
use super::finished::{Finished, Outcome, Per};
use super::strain::Strain;
use crate::arrays::{Reals, from_array, frozen, own_array, real_table};
use crate::distortion::Distortion;
use crate::errors::{bad_array, bad_option, to_python, warning};
use crate::indices::{from_index_list, from_indices, integer_list};
use crate::memory;
use crate::provenance::Call;
use crate::record::{from_dictionary, to_dictionary};
use crate::repair::Repaired;
use crate::result::{Restorable, ResultBase, State, made};
use crate::run::run;
use crate::values::{Values, from_values};
use crate::{disk, sphere};

/// A one-to-one map of a source surface onto a target that takes landmarks to landmarks.
#[pyclass(frozen, extends = ResultBase, module = "authalic")]
pub struct Registration {
    /// (n, 3) float64: g(v), the place of each source vertex on the target, in the target's coordinates.
    #[pyo3(get)]
    positions: Py<PyArray2<f64>>,
    /// (n,) int64: the target face in which each source vertex lies.
    #[pyo3(get)]
    triangles: Py<PyArray1<i64>>,
    /// (n, 3) float64: the weights of that face's corners, nonnegative, with sum 1.
    #[pyo3(get)]
    barycentric: Py<PyArray2<f64>>,
    /// (n, 2) or (n, 3) float64: the source vertices in the parameter domain, landmarks in place.
    ///
    /// The domain is the unit disk or sphere. The boundary of a disk lies on that of the target's image, a polygon.
    #[pyo3(get)]
    registered: Reals,
    /// (n_t, 2) or (n_t, 3) float64: the target vertices in the parameter domain.
    #[pyo3(get)]
    target_registered: Reals,
    /// (m, 3) int64: the source faces as oriented; faces turned against the rest are flipped.
    #[pyo3(get)]
    faces: Py<PyArray2<i64>>,
    /// (m_t, 3) int64: the target faces as oriented.
    #[pyo3(get)]
    target_faces: Py<PyArray2<i64>>,
    /// DiskMap or SphereMap: the map of the source alone.
    ///
    /// With `energy="surface"` a map of the surface with rounded vertices, which is only a start: its history is of that,
    /// its figures are of the source as given.
    ///
    /// By curves: a rough map onto the sphere, which may have folds and has no iterations.
    #[pyo3(get)]
    source_map: Py<PyAny>,
    /// DiskMap or SphereMap: the map of the target alone.
    ///
    /// By curves: a rough map onto the sphere, which may have folds and has no iterations.
    #[pyo3(get)]
    target_map: Py<PyAny>,
    /// (k,) float64: the final distance of each landmark from its partner.
    ///
    /// It is taken in the parameter domain of radius 1. By curves: the largest distance of each curve's vertices from
    /// its partner, as a fraction of the target's size.
    #[pyo3(get)]
    landmark_error: Py<PyArray1<f64>>,
    /// (j,) int64: the pairs that did not meet.
    ///
    /// They are farther apart than 1e-3 in the domain, or than .5 % of the target's size on the target. By curves:
    /// farther than 1e-9 of the target's size.
    #[pyo3(get)]
    missed: Py<PyArray1<i64>>,
    /// (j,) int64: vertices of the source's boundary that lie a little inside the target.
    ///
    /// Faces between them would have no area on a straight side of the target's boundary; all others lie on its
    /// boundary. Empty but for disks.
    #[pyo3(get)]
    off_boundary: Py<PyArray1<i64>>,
    /// (j,) int64: with `fill_holes`, the source vertices that lie on a filling of the target's holes.
    ///
    /// Their `triangles` and `barycentric` are the nearest place on the target itself, from where `pull` takes data.
    #[pyo3(get)]
    in_holes: Py<PyArray1<i64>>,
    /// "converged", "landmarks_missed", "max_iterations", "stalled" or "cancelled".
    ///
    /// No face is folded in any case, except with the solver "heat", where `certificates` tell.
    #[pyo3(get)]
    status: &'static str,
    /// The figures of `registered` against the source's areas.
    ///
    /// By curves: the figures of `positions` against the source, in space.
    #[pyo3(get)]
    distortion: Py<Distortion>,
    /// The figures of `target_registered` against the target's areas.
    ///
    /// By curves: the figures of the inverse map, in space.
    #[pyo3(get)]
    target_distortion: Py<Distortion>,
    /// (m,) float64: the area of each source face's image on the target over the face's own.
    ///
    /// The source is scaled to the area of its image; 1 is where areas are preserved.
    #[pyo3(get)]
    area_ratio: Py<PyArray1<f64>>,
    /// (m,) float64: max(J, 1/J) of `area_ratio` J, at least 1; infinite where the image has no area.
    #[pyo3(get)]
    area_distortion: Py<PyArray1<f64>>,
    /// Strain: how far g stretches and shrinks each source face, both surfaces scaled to one area.
    #[pyo3(get)]
    strain: Py<Strain>,
    /// Certificates or None: the proof that a map by curves is one-to-one; None for a map by points.
    #[pyo3(get)]
    certificates: Option<Py<Certificates>>,
    /// List of RegistrationWarning: signs that the curves are wrong; empty for a map by points.
    #[pyo3(get)]
    warnings: Vec<Py<PyAny>>,
    /// List of (k,) float64: the harmonic energy at the start and after each step.
    ///
    /// There is one array for each piece with a hyperbolic metric, and none for a map by points.
    #[pyo3(get)]
    energies: Vec<Py<PyArray1<f64>>>,
    /// Iterations of carrying the landmarks, without those of `source_map` and `target_map`.
    ///
    /// By curves: the steps of the harmonic map.
    #[pyo3(get)]
    iterations: usize,
    /// The repaired source that was registered, with `repair`; else None.
    #[pyo3(get)]
    source_repaired: Option<Py<Repaired>>,
    /// The repaired target, with `repair`; else None.
    #[pyo3(get)]
    target_repaired: Option<Py<Repaired>>,
    /// Wall time of the call.
    #[pyo3(get)]
    seconds: f64,
    pub(super) finished: Arc<Finished>,
}

impl Registration {
    /// The result for Python, and what it was computed from.
    pub(super) fn new(py: Python<'_>, outcome: Outcome, call: Call) -> PyResult<Py<Self>> {
        let Outcome { finished, repaired: [source, target], .. } = outcome;
        let warnings = finished.warnings();
        let warnings = warnings.iter().map(|sign| warning(py, sign)).collect::<PyResult<_>>()?;
        let for_python = |side: Option<authalic::Repaired>| {
            side.map(|repaired| Repaired::new(py, repaired, None)).transpose()
        };
        let repaired = [for_python(source)?, for_python(target)?];
        made(py, Self::of(py, finished, warnings, repaired)?, call.into())
    }

    fn of(
        py: Python<'_>,
        finished: Finished,
        warnings: Vec<Py<PyAny>>,
        [source_repaired, target_repaired]: [Option<Py<Repaired>>; 2],
    ) -> PyResult<Self> {
        let map = finished.correspondence();
        let (faces, target_faces) = (map.faces(), map.target_faces());
        let [registered, target_registered] = in_domain(&finished).map(|array| from_array(py, array));
        let [source_map, target_map] = maps(py, &finished, [faces.view(), target_faces.view()])?;
        let figures = Figures::of(&finished);
        let (certificates, energies) = match &finished {
            Finished::Curves(curves) => (
                Some(Certificates::new(py, &curves.certificates)?),
                curves
                    .descents
                    .iter()
                    .map(|descent| frozen(PyArray1::from_slice(py, &descent.energies)))
                    .collect(),
            ),
            _ => (None, Vec::new()),
        };
        let area_ratio = map.area_ratio();
        Ok(Self {
            positions: from_array(py, map.positions()),
            triangles: from_index_list(py, map.triangles().into_iter()),
            barycentric: from_array(py, map.barycentric()),
            registered,
            target_registered,
            faces: from_indices(py, faces.view()),
            target_faces: from_indices(py, target_faces.view()),
            source_map,
            target_map,
            landmark_error: from_array(py, figures.landmark_error.clone()),
            missed: from_index_list(py, figures.missed.iter().copied()),
            off_boundary: from_index_list(py, figures.off_boundary.iter().copied()),
            in_holes: from_index_list(py, map.in_holes().iter().copied()),
            status: figures.status.as_str(),
            distortion: Distortion::new(py, figures.distortion.clone())?,
            area_distortion: from_array(py, area_ratio.mapv(|ratio| ratio.max(1.0 / ratio))),
            area_ratio: from_array(py, area_ratio),
            strain: Strain::new(py, finished.strain())?,
            target_distortion: Distortion::new(py, figures.target_distortion.clone())?,
            certificates,
            warnings,
            energies,
            iterations: figures.iterations,
            source_repaired,
            target_repaired,
            seconds: figures.seconds,
            finished: Arc::new(finished),
        })
    }
}

/// The figures that registrations of all kinds have.
struct Figures<'a> {
    landmark_error: &'a Array1<f64>,
    missed: &'a [usize],
    off_boundary: &'a [usize],
    status: Status,
    distortion: &'a authalic::Distortion,
    target_distortion: &'a authalic::Distortion,
    iterations: usize,
    seconds: f64,
}

impl<'a> Figures<'a> {
    fn of(finished: &'a Finished) -> Self {
        match finished {
            Finished::Disk(registration) => Self::of_points(registration),
            Finished::Sphere(registration) => Self::of_points(registration),
            Finished::Curves(curves) => Self {
                landmark_error: &curves.map.curve_error,
                missed: &curves.map.missed,
                off_boundary: &[],
                status: curves.map.status,
                distortion: &curves.map.distortion,
                target_distortion: &curves.inverse.distortion,
                iterations: curves.iterations,
                seconds: curves.seconds,
            },
        }
    }

    fn of_points<Map>(registration: &'a authalic::Registration<Map>) -> Self {
        Self {
            landmark_error: &registration.landmark_error,
            missed: &registration.missed,
            off_boundary: &registration.off_boundary,
            status: registration.status,
            distortion: &registration.distortion,
            target_distortion: &registration.target_distortion,
            iterations: registration.iterations,
            seconds: registration.seconds,
        }
    }
}

/// The vertices of source and target in the domain.
fn in_domain(finished: &Finished) -> [Array2<f64>; 2] {
    match finished {
        Finished::Disk(disks) => [disks.registered.clone(), disks.target_registered.clone()],
        Finished::Sphere(spheres) => [spheres.registered.clone(), spheres.target_registered.clone()],
        Finished::Curves(curves) => [curves.map.registered.clone(), curves.spheres[1].positions.clone()],
    }
}

/// The maps of source and target alone, with their faces.
fn maps(
    py: Python<'_>,
    finished: &Finished,
    [faces, target_faces]: [ArrayView2<'_, u32>; 2],
) -> PyResult<[Py<PyAny>; 2]> {
    let disk = |map: &DiskMap, faces| {
        Ok::<_, PyErr>(disk::DiskMap::new(py, map.clone(), faces, None, None)?.into_any())
    };
    let sphere = |map: &SphereMap, faces| {
        let on_sphere = map.faces_on_sphere(faces).map_err(|error| to_python(py, &error))?;
        let map = sphere::SphereMap::new(py, map.clone(), faces, on_sphere, (None, None), None)?;
        Ok::<_, PyErr>(map.into_any())
    };
    Ok(match finished {
        Finished::Disk(disks) => [disk(&disks.source_map, faces)?, disk(&disks.target_map, target_faces)?],
        Finished::Sphere(spheres) => {
            [sphere(&spheres.source_map, faces)?, sphere(&spheres.target_map, target_faces)?]
        }
        Finished::Curves(curves) => [
            sphere(&without_iterations(&curves.spheres[0]), faces)?,
            sphere(&without_iterations(&curves.spheres[1]), target_faces)?,
        ],
    })
}

/// A surface laid roughly onto the sphere, as a map without iterations.
fn without_iterations(sphere: &RoughSphere) -> SphereMap {
    SphereMap {
        positions: sphere.positions.clone(),
        status: Status::Converged,
        history: History::start(),
        distortion: sphere.distortion.clone(),
        targets: sphere.targets.clone(),
        refinement: None,
        filling: None,
        seconds: 0.0,
    }
}

impl Restorable for Registration {
    const FIELDS: &'static [&'static str] = &["warnings", "source_repaired", "target_repaired", "_record"];

    fn restored(state: &State<'_>) -> PyResult<Self> {
        let py = state.py();
        let record = from_dictionary(&state.get("_record")?)?;
        let finished = Finished::of_record(&record).map_err(|error| to_python(py, &error))?;
        let repaired = [state.optional("source_repaired")?, state.optional("target_repaired")?];
        Self::of(py, finished, state.get("warnings")?, repaired)
    }
}

#[pymethods]
impl Registration {
    /// Data of the target at the vertices or corners of the source.
    ///
    /// Parameters
    /// ----------
    /// values : (n_t, ...) or (m_t, 3, ...) array
    ///     One row per target vertex, or one per corner of the given target faces; with `repair`, of the repaired target,
    ///     to which `target_repaired.carry` takes data. At a seam of the data, each corner
    ///     of a source face takes the value of the side on which its face lies.
    /// per : "vertex" or "corner", optional
    ///     The elements that `values` has a row for. Default: as its shape says, vertices if both fit.
    /// nearest : bool
    ///     Take the value of the nearest target vertex or corner, of any dtype, instead of interpolating: for labels.
    /// smooth : bool
    ///     Interpolate values per vertex by cubics with estimated gradients instead of linear functions: without the
    ///     facets of a target that is coarser than the source. Between vertices they may exceed the range of the values.
    ///
    /// Returns
    /// -------
    /// (n, ...) or (m, 3, ...) array
    ///     float64; with `nearest`, the dtype of `values`.
    ///
    /// Raises
    /// ------
    /// MeshError
    ///     The values have another shape, or without `nearest` are no real numbers.
    /// ValueError
    ///     `smooth` goes with values per corner or with `nearest`.
    ///
    /// Examples
    /// --------
    /// >>> import authalic
    /// >>> corners = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]
    /// >>> faces = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [3, 2, 1]]
    /// >>> large = [[3 * x for x in corner] for corner in corners]
    /// >>> registration = authalic.register_spheres(
    /// ...     (corners, faces), (large, faces), source_landmarks=[0, 1], target_landmarks=[0, 1]
    /// ... )
    /// >>> registration.pull([1.0, 2.0, 3.0, 4.0]).round(6).tolist()
    /// [1.0, 2.0, 3.0, 4.0]
    /// >>> registration.pull([5, 6, 7, 8], nearest=True).tolist()
    /// [5, 6, 7, 8]
    #[pyo3(signature = (values, *, per=None, nearest=false, smooth=false))]
    fn pull(
        &self,
        py: Python<'_>,
        values: &Bound<'_, PyAny>,
        per: Option<&str>,
        nearest: bool,
        smooth: bool,
    ) -> PyResult<Py<PyAny>> {
        let asked = match per {
            None => None,
            Some("vertex") => Some(Per::Vertex),
            Some("corner") => Some(Per::Corner),
            Some(word) => {
                let message = format!("per must be \"vertex\", \"corner\" or None, but is \"{word}\"");
                return Err(bad_option(message));
            }
        };
        let map = self.finished.correspondence();
        let (source, target) = (map.source(), map.target());
        let values = Values::new(values, "values")?;
        let shape = values.shape();
        let Some((per, axes)) = Per::of(&shape, target, asked) else {
            let (n, m) = (target.n_vertices(), target.n_faces());
            let expected = format!("of shape ({n}, …) per vertex or ({m}, 3, …) per corner of the target");
            return Err(bad_array(py, "values", values.shape_words(), expected));
        };
        if smooth && (nearest || per == Per::Corner) {
            let with = if nearest { "nearest=True" } else { "values per corner" };
            return Err(bad_option(format!(
                "smooth=True takes values per vertex; it does not go with {with}"
            )));
        }
        let out: Vec<usize> = per.axes(source).into_iter().chain(shape[axes..].iter().copied()).collect();
        let bytes = if smooth { memory::SMOOTH } else { memory::RESULT };
        memory::check_numbers(py, bytes, out.iter().product())?;
        let finished = self.finished.clone();
        if nearest {
            let rows = run(py, None, move |_| Ok(nearest_rows(finished.correspondence(), per)))?;
            return values.taken(axes, &rows, out);
        }
        let width = shape[axes..].iter().product();
        let numbers = values.reals("real numbers; nearest=True takes labels of any kind")?;
        let pulled = run(py, None, move |_| pulled(finished.correspondence(), numbers, width, per, smooth))?;
        from_values(py, pulled, out)
    }

    /// Where points beside the source go when it goes to its place on the target: eyes, teeth, clothes.
    ///
    /// Parameters
    /// ----------
    /// points : (k, 3) real array
    ///     In the source's coordinates.
    /// pieces : (k,) int array, optional
    ///     Points with the same number, from 0, are a piece. A small piece moves by one similarity, the best one for
    ///     the surface around it, so that it keeps its shape. Points of a large piece, points with negative numbers and
    ///     without `pieces` all points bend with the surface; points on the surface go where it goes.
    /// rigid_size : float
    ///     The largest size of pieces that keep their shapes, as a fraction of the source's; 0 bends all, infinity none.
    ///
    /// Returns
    /// -------
    /// (k, 3) float64 array
    ///     In the target's coordinates.
    ///
    /// Raises
    /// ------
    /// MeshError
    ///     An array has another shape, or points are not finite.
    /// ValueError
    ///     `rigid_size` is negative or NaN.
    ///
    /// Examples
    /// --------
    /// >>> import authalic
    /// >>> corners = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]
    /// >>> faces = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [3, 2, 1]]
    /// >>> large = [[3 * x for x in corner] for corner in corners]
    /// >>> registration = authalic.register_spheres(
    /// ...     (corners, faces), (large, faces), source_landmarks=[0, 1], target_landmarks=[0, 1]
    /// ... )
    /// >>> (registration.follow([[0, 0, 2]]).round(6) + 0.0).tolist()
    /// [[0.0, 0.0, 6.0]]
    #[pyo3(signature = (points, *, pieces=None, rigid_size=0.25))]
    fn follow(
        &self,
        py: Python<'_>,
        points: &Bound<'_, PyAny>,
        pieces: Option<&Bound<'_, PyAny>>,
        rigid_size: f64,
    ) -> PyResult<Reals> {
        let points = real_table::<3>(points, "points")?;
        let pieces = match pieces {
            Some(pieces) => integer_list(pieces, "pieces", "of shape (k,), one number per point")?,
            None => vec![-1; points.nrows()],
        };
        memory::check_numbers(py, memory::POINT, points.nrows())?;
        let finished = self.finished.clone();
        let places = run(py, None, move |_| {
            authalic::follow(finished.correspondence(), points.view(), aview1(&pieces), rigid_size)
        })?;
        Ok(own_array(py, places))
    }

    /// How vectors on the target are turned and scaled on their way to the source.
    ///
    /// For each source vertex v the linear part of the similarity that takes the target's surroundings of g(v), within
    /// a twentieth of the square root of the area, nearest to those of v. `np.einsum("nij,nj->ni", matrices,
    /// registration.pull(vectors))` carries vectors, such as offsets of a shape key.
    ///
    /// Returns
    /// -------
    /// (n, 3, 3) float64 array
    ///     A rotation times a scale for each source vertex.
    ///
    /// Examples
    /// --------
    /// >>> import authalic
    /// >>> corners = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]
    /// >>> faces = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [3, 2, 1]]
    /// >>> large = [[3 * x for x in corner] for corner in corners]
    /// >>> registration = authalic.register_spheres(
    /// ...     (corners, faces), (large, faces), source_landmarks=[0, 1], target_landmarks=[0, 1]
    /// ... )
    /// >>> registration.local_similarities()[0].diagonal().round(3).tolist()
    /// [0.333, 0.333, 0.333]
    fn local_similarities(&self, py: Python<'_>) -> PyResult<Py<PyArray3<f64>>> {
        let finished = self.finished.clone();
        Ok(own_array(py, run(py, None, move |_| finished.correspondence().local_similarities())?))
    }

    /// The registration of the target onto the source by the same maps. Its `pull` carries source data to the target.
    ///
    /// Returns
    /// -------
    /// Registration
    ///
    /// Examples
    /// --------
    /// >>> import authalic
    /// >>> corners = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]
    /// >>> faces = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [3, 2, 1]]
    /// >>> large = [[3 * x for x in corner] for corner in corners]
    /// >>> registration = authalic.register_spheres(
    /// ...     (corners, faces), (large, faces), source_landmarks=[0, 1], target_landmarks=[0, 1]
    /// ... )
    /// >>> registration.inverse().positions.max().round(6).item()
    /// 1.0
    fn inverse(slf: &Bound<'_, Self>) -> PyResult<Py<Self>> {
        let (py, this) = (slf.py(), slf.get());
        let finished = this.finished.clone();
        let inverse = run(py, None, move |observer| finished.inverse(observer))?;
        let warnings = this.warnings.iter().map(|sign| sign.clone_ref(py)).collect();
        let origin = slf.as_super().get().origin().map(|origin| origin.again(py));
        let [source, target] = [&this.target_repaired, &this.source_repaired]
            .map(|repaired| repaired.as_ref().map(|repaired| repaired.clone_ref(py)));
        made(py, Self::of(py, inverse, warnings, [source, target])?, origin)
    }

    /// All that makes the registration, for saved ones.
    #[getter]
    fn _record<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        to_dictionary(py, &self.finished.record())
    }

    /// The agreement of scalars of both surfaces through the map, weighted by area on the source.
    ///
    /// Parameters
    /// ----------
    /// source_values : (n,) real array
    ///     One per source vertex.
    /// target_values : (n_t,) real array
    ///     One per target vertex.
    ///
    /// Returns
    /// -------
    /// (float, float)
    ///     Pearson's correlation, NaN if one side is constant, and the mean absolute difference.
    ///
    /// Raises
    /// ------
    /// MeshError
    ///     The values have another shape or are no real numbers.
    ///
    /// Examples
    /// --------
    /// >>> import authalic
    /// >>> corners = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]
    /// >>> faces = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [3, 2, 1]]
    /// >>> large = [[3 * x for x in corner] for corner in corners]
    /// >>> registration = authalic.register_spheres(
    /// ...     (corners, faces), (large, faces), source_landmarks=[0, 1], target_landmarks=[0, 1]
    /// ... )
    /// >>> correlation, difference = registration.compare([1, 2, 3, 4], [1, 2, 3, 4])
    /// >>> round(correlation, 6), round(difference, 6)
    /// (1.0, 0.0)
    fn compare(
        &self,
        py: Python<'_>,
        source_values: &Bound<'_, PyAny>,
        target_values: &Bound<'_, PyAny>,
    ) -> PyResult<(f64, f64)> {
        let finished = self.finished.clone();
        let map = finished.correspondence();
        let source = scalars(source_values, "source_values", map.source().n_vertices())?;
        let target = scalars(target_values, "target_values", map.target().n_vertices())?;
        run(py, None, move |_| finished.correspondence().compare(aview1(&source), aview1(&target)))
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!(
            "Registration({} onto {} vertices, {} landmarks, {} missed, {} after {} iterations, {:.2} s, {})",
            self.finished.correspondence().source().n_vertices(),
            self.finished.correspondence().target().n_vertices(),
            self.landmark_error.bind(py).len()?,
            self.missed.bind(py).len()?,
            self.status,
            self.iterations,
            self.seconds,
            self.distortion.bind(py).repr()?,
        ))
    }
}

/// The row of the target's data that each vertex or corner of the source takes.
fn nearest_rows(map: &Correspondence, per: Per) -> Vec<usize> {
    match per {
        Per::Vertex => map.nearest_vertices().into_iter().map(Vertex::index).collect(),
        Per::Corner => map.nearest_corners().into_iter().map(Corner::index).collect(),
    }
}

/// Rows of `width` numbers of the target, interpolated at the vertices or corners of the source.
fn pulled(
    map: &Correspondence,
    numbers: Vec<f64>,
    width: usize,
    per: Per,
    smooth: bool,
) -> Result<Vec<f64>, Error> {
    let shaped = "the shape was checked";
    let pulled = match per {
        Per::Vertex => {
            let rows = (map.target().n_vertices(), width);
            let values = Array2::from_shape_vec(rows, numbers).expect(shaped);
            let pulled = if smooth {
                map.pull_vertices_smoothly(values.view())
            } else {
                map.pull_vertices(values.view())
            };
            pulled?.into_raw_vec_and_offset()
        }
        Per::Corner => {
            let rows = (map.target().n_faces(), 3, width);
            map.pull_corners(Array3::from_shape_vec(rows, numbers).expect(shaped).view())?
                .into_raw_vec_and_offset()
        }
    };
    Ok(pulled.0)
}

/// One real number per vertex.
fn scalars(object: &Bound<'_, PyAny>, name: &'static str, n_vertices: usize) -> PyResult<Vec<f64>> {
    let values = Values::new(object, name)?;
    match values.shape().as_slice() {
        [n] if *n == n_vertices => values.reals("real numbers"),
        _ => {
            let expected = format!("of shape ({n_vertices},), one value per vertex");
            Err(bad_array(object.py(), name, values.shape_words(), expected))
        }
    }
}
