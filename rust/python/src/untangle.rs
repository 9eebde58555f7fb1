// SPDX-License-Identifier: MIT OR Apache-2.0
//! Bindings of `authalic::untangle`.

use std::time::Instant;

use authalic::UntangleOptions;
use numpy::PyArray1;
use pyo3::prelude::*;

use crate::arrays::{self, Reals, from_array};
use crate::distortion::Distortion;
use crate::indices::{from_index_list, vertex_set};
use crate::memory;
use crate::provenance::{Call, fingerprint, options};
use crate::result::{ResultBase, made, restorable};
use crate::run::run;
use crate::surface::Given;

/// A map without folds, made from one with folds.
#[pyclass(frozen, get_all, extends = ResultBase, module = "authalic")]
pub struct Untangled {
    /// (n, 2) or (n, 3) float64: the map; rows of vertices that did not move keep their bits.
    image: Reals,
    /// (k,) int64: the vertices that moved, ascending.
    moved: Py<PyArray1<i64>>,
    /// (k,) int64: the faces that were folded, ascending.
    folded_before: Py<PyArray1<i64>>,
    /// "converged", "stalled" or "cancelled".
    ///
    /// It is stalled if a face stays below the tolerance, though not folded, and cancelled if vertices did not return
    /// as far as they could. The map has no folds in any case.
    status: &'static str,
    /// The figures of the map, with mirrored components turned back.
    distortion: Py<Distortion>,
    /// Wall time of the call.
    seconds: f64,
}

restorable!(Untangled { status, image, moved, folded_before, distortion, seconds });

#[pymethods]
impl Untangled {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!(
            "Untangled({} of {} vertices moved, {} faces were folded, {}, {:.2} s, {})",
            self.moved.bind(py).len()?,
            self.image.bind(py).len()?,
            self.folded_before.bind(py).len()?,
            self.status,
            self.seconds,
            self.distortion.bind(py).repr()?,
        ))
    }
}

/// Removes the folds of a given map, and changes as little as possible.
///
/// Only vertices near folded faces move, as few as suffice: to a map without folds (Garanzha et al. 2021), and then
/// back toward their old places as far as open faces let them. The outline and the fixed vertices stay. A map without
/// folds comes back as it is. Exact predicates decide which faces are folded.
///
/// Each component keeps the orientation of most of its area, so a component that is mirrored as a whole stays
/// mirrored. Components may overlap each other, and the outline may overlap itself, as before.
///
/// Parameters
/// ----------
/// surface : Surface, or (vertices, faces)
///     (n, 3) real and (m, 3) int array: an orientable manifold of any number of components and boundary loops.
/// image : (n, 2) or (n, 3) real array
///     The map of its vertices into the plane, or onto a sphere around the origin. A closed component needs the sphere,
///     and each tangle there must lie within a hemisphere.
/// fixed : (k,) int or (n,) bool array, optional
///     Vertices that stay in place, in addition to those of the boundary.
/// tolerance : float
///     Least area, in [0, 1), of a face that was folded or lost area to a folded one, in units of its fair share: the
///     area of the region that moves, divided in proportion to the areas on the surface. Default .01.
/// progress : callable(fraction, message) -> bool, optional
///     Called between and within steps; False cancels, and the map is returned if it has no folds any more.
///
/// Returns
/// -------
/// Untangled
///
/// Raises
/// ------
/// MeshError
///     The mesh is broken, an array does not fit, or the outline or the fixed vertices make folds inevitable; then
///     `indices` has the folded faces.
/// ValueError
///     An option is out of its range.
/// SolverError
///     No map without folds was found; then `indices` has the faces that stay folded. Or the call was cancelled before
///     there was one.
///
/// Examples
/// --------
/// >>> import authalic
/// >>> pyramid = [[0, 0, 1], [1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]]
/// >>> faces = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]]
/// >>> uv = [[2, 0], [1, 0], [0, 1], [-1, 0], [0, -1]]
/// >>> result = authalic.untangle((pyramid, faces), uv)
/// >>> len(result.folded_before), len(result.moved), len(result.distortion.folded)
/// (2, 1, 0)
#[pyfunction]
#[pyo3(signature = (surface, image, *, fixed=None, tolerance=0.01, progress=None))]
pub fn untangle(
    py: Python<'_>,
    surface: &Bound<'_, PyAny>,
    image: &Bound<'_, PyAny>,
    fixed: Option<&Bound<'_, PyAny>>,
    tolerance: f64,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Py<Untangled>> {
    // 1. Arguments to plain data
    let began = Instant::now();
    let kept = options!(py; image, fixed, tolerance)?;
    let given = Given::pair(surface, ["surface", "surface vertices", "surface faces"])?;
    memory::check(py, memory::UNTANGLING, given.n_vertices())?;
    let image = arrays::image(image)?;
    let fixed = fixed.map_or(Ok(Vec::new()), |fixed| vertex_set(fixed, "fixed", given.n_vertices()))?;
    // 2. The run
    let (map, input) = run(py, progress, move |observer| {
        let surface = given.surface()?;
        let options = UntangleOptions { fixed: &fixed, tolerance };
        Ok((authalic::untangle(&surface, image.view(), &options, observer)?, fingerprint(&surface)))
    })?;
    // 3. The result
    let result = Untangled {
        image: from_array(py, map.image),
        moved: from_index_list(py, map.moved.iter().copied()),
        folded_before: from_index_list(py, map.folded_before.iter().copied()),
        status: map.status.as_str(),
        distortion: Distortion::new(py, map.distortion)?,
        seconds: began.elapsed().as_secs_f64(),
    };
    made(py, result, Call::new("untangle", &kept, "surface", input).into())
}
