// SPDX-License-Identifier: MIT OR Apache-2.0
//! Bindings of `authalic::layout`.

use std::sync::Arc;

use authalic::{LayoutKind, LayoutOptions, Precision, Seam, SphereFaces};
use numpy::ndarray::{Axis, Slice};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;

use crate::arrays::{from_array, reals};
use crate::errors::{bad_array, bad_option};
use crate::indices::{from_index_list, from_indices, labels, vertex_set};
use crate::provenance::{Call, Fingerprint, Options, fingerprint_of, options};
use crate::result::{ResultBase, made, restorable};
use crate::run::run;
use crate::values::Values;

/// A map onto the sphere laid out in the plane, cut open along a seam, without folds.
#[pyclass(frozen, get_all, extends = ResultBase, module = "authalic")]
pub struct Layout {
    /// (k, 2) float64 or float32, as requested: the points in the order of their vertices.
    ///
    /// The whole image, with holes, has the area of the unit sphere.
    points: Py<PyAny>,
    /// (m, 3) int64: the faces of the map, or of its refinement, between points, counter-clockwise.
    faces: Py<PyArray2<i64>>,
    /// (k,) int64: the vertex of each point, ascending.
    ///
    /// A vertex on the seam has several points. Split points of a refinement are numbered on from the vertices.
    vertex_of: Py<PyArray1<i64>>,
    /// "converged", "stalled" or "cancelled".
    ///
    /// It has converged if areas are as even as they should be, and stalled if they hardly get more even. No face is
    /// folded in any case.
    status: &'static str,
    /// Wall time of the call.
    seconds: f64,
}

restorable!(Layout { status, points, faces, vertex_of, seconds });

#[pymethods]
impl Layout {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!(
            "Layout({} points, {} faces, {}, {:.2} s)",
            self.points.bind(py).len()?,
            self.faces.bind(py).len()?,
            self.status,
            self.seconds,
        ))
    }
}

/// The arguments of `SphereMap.layout` as given.
pub struct Arguments<'a, 'py> {
    pub kind: &'a str,
    pub pole: Option<&'a Bound<'py, PyAny>>,
    pub seam: Option<&'a Bound<'py, PyAny>>,
    pub polygons: Option<&'a Bound<'py, PyAny>>,
    pub density: Option<&'a Bound<'py, PyAny>>,
    pub candidates: Option<&'a Bound<'py, PyAny>>,
    pub precision: &'a str,
    pub progress: Option<&'a Bound<'py, PyAny>>,
}

/// `SphereMap.layout`.
pub fn layout(
    py: Python<'_>,
    sphere: Arc<SphereFaces>,
    arguments: &Arguments<'_, '_>,
) -> PyResult<Py<Layout>> {
    // 1. Arguments to plain data
    let (kind, precision) = (parse_kind(arguments.kind)?, parse_precision(arguments.precision)?);
    let pole = arguments.pole.map_or(Ok([0.0, 0.0, 1.0]), parse_pole)?;
    let seam = arguments.seam.map_or(Ok(Seam::Angle(0.0)), parse_seam)?;
    let polygons = arguments.polygons.map(|polygons| labels(polygons, "polygons")).transpose()?;
    // labels are only compared, so negative ones may wrap
    let polygons: Option<Vec<usize>> =
        polygons.map(|labels| labels.into_iter().map(|label| label as usize).collect());
    let density = arguments.density.map(|density| reals(density, "density")).transpose()?;
    let candidates = match arguments.candidates {
        Some(given) => {
            let mut mask = vec![false; sphere.n_vertices];
            for vertex in vertex_set(given, "candidates", sphere.n_vertices)? {
                mask[vertex] = true;
            }
            Some(mask)
        }
        None => None,
    };
    let kept = arguments.kept(py)?;
    // 2. The run
    let (layout, input) = run(py, arguments.progress, move |observer| {
        let options = LayoutOptions {
            kind,
            pole,
            seam,
            polygons: polygons.as_deref(),
            density: density.as_ref().map(|density| density.view()),
            candidates: candidates.as_deref(),
            precision,
        };
        Ok((authalic::layout(&sphere, &options, observer)?, fingerprint_of_map(&sphere)))
    })?;
    // 3. The result
    let layout = Layout {
        points: match precision {
            Precision::Double => from_array(py, layout.points).into_any(),
            Precision::Single => from_array(py, layout.points.mapv(|x| x as f32)).into_any(),
        },
        faces: from_indices(py, layout.faces.view()),
        vertex_of: from_index_list(py, layout.vertex_of.iter().map(|vertex| vertex.index())),
        status: layout.status.as_str(),
        seconds: layout.seconds,
    };
    made(py, layout, Call::new("layout", &kept, "map", input).into())
}

/// The fingerprint of a map onto the sphere: of its positions and faces, or of those of its split faces.
fn fingerprint_of_map(sphere: &SphereFaces) -> Fingerprint {
    let (positions, faces) = (sphere.image.vertices(), sphere.image.faces());
    let n_points = if sphere.n_filling == 0 { positions.nrows() } else { sphere.n_vertices };
    fingerprint_of(
        positions.slice_axis(Axis(0), Slice::from(..n_points)),
        faces.slice_axis(Axis(0), Slice::from(..sphere.n_laid_out())),
    )
}

impl Arguments<'_, '_> {
    /// The options for the provenance.
    fn kept(&self, py: Python<'_>) -> PyResult<Options> {
        let &Self { kind, pole, seam, polygons, density, candidates, precision, .. } = self;
        let or_default = |given: Option<&Bound<'_, PyAny>>, default: Bound<'_, PyAny>| {
            given.cloned().unwrap_or(default.clone()).unbind()
        };
        let pole = or_default(pole, "z".into_pyobject(py)?.into_any());
        let seam = or_default(seam, 0.0_f64.into_pyobject(py)?.into_any());
        options!(py; kind, pole, seam, polygons, density, candidates, precision)
    }
}

fn parse_kind(kind: &str) -> PyResult<LayoutKind> {
    match kind {
        "lambert" => Ok(LayoutKind::Lambert),
        "octahedral" => Ok(LayoutKind::Octahedral),
        unknown => {
            let message = format!("kind must be \"lambert\" or \"octahedral\", but is {unknown:?}");
            Err(bad_option(message))
        }
    }
}

fn parse_precision(precision: &str) -> PyResult<Precision> {
    match precision {
        "float64" => Ok(Precision::Double),
        "float32" => Ok(Precision::Single),
        unknown => {
            let message = format!("precision must be \"float64\" or \"float32\", but is {unknown:?}");
            Err(bad_option(message))
        }
    }
}

/// The name of an axis or a direction.
fn parse_pole(pole: &Bound<'_, PyAny>) -> PyResult<[f64; 3]> {
    let Ok(name) = pole.extract::<String>() else { return direction(pole, "pole") };
    match name.as_str() {
        "x" => Ok([1.0, 0.0, 0.0]),
        "y" => Ok([0.0, 1.0, 0.0]),
        "z" => Ok([0.0, 0.0, 1.0]),
        unknown => {
            let message = format!("pole must be \"x\", \"y\", \"z\" or a direction, but is {unknown:?}");
            Err(bad_option(message))
        }
    }
}

/// An angle or a direction.
fn parse_seam(seam: &Bound<'_, PyAny>) -> PyResult<Seam> {
    match seam.extract::<f64>() {
        Ok(angle) => Ok(Seam::Angle(angle)),
        Err(_) => Ok(Seam::Direction(direction(seam, "seam")?)),
    }
}

fn direction(object: &Bound<'_, PyAny>, name: &'static str) -> PyResult<[f64; 3]> {
    let given = Values::new(object, name)?;
    let expected = "of shape (3,), a direction";
    if given.shape() != [3] {
        return Err(bad_array(object.py(), name, given.shape_words(), expected.into()));
    }
    let reals = given.reals(expected)?;
    Ok([reals[0], reals[1], reals[2]])
}
