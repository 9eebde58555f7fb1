// SPDX-License-Identifier: MIT OR Apache-2.0
//! Bindings of `authalic::distortion`.

use authalic::Error;
use numpy::PyArray1;
use pyo3::prelude::*;

use crate::arrays::{self, Items, from_array, reals, reals_of_each};
use crate::errors::{bad_array, to_python};
use crate::indices::from_index_list;
use crate::memory;
use crate::result::{ResultBase, made, restorable};
use crate::run::run;
use crate::surface::Given;

/// The quality figures of a map. All are signed: a folded face never scores like a good one.
#[pyclass(frozen, get_all, extends = ResultBase, module = "authalic")]
pub struct Distortion {
    /// E_A = Σ (a − |τ|)²/|τ| on targets rescaled to the image's area; 0 for an area-preserving map.
    authalic_energy: f64,
    /// Mean of the area ratio, the signed image area of a face over its rescaled target.
    area_ratio_mean: f64,
    /// Population standard deviation of the area ratio.
    area_ratio_std: f64,
    /// (m,) float64: log2 of the area ratio of each face, -inf for a folded face.
    log2_area_ratio: Py<PyArray1<f64>>,
    /// (k,) int64: faces whose exact orientation in the image is not positive, ascending.
    folded: Py<PyArray1<i64>>,
    /// (m,) float64: σ₁/σ₂ ≥ 1 of the linear map of each face, inf for a folded face.
    angle_distortion: Py<PyArray1<f64>>,
    /// Mean of angle_distortion over the faces.
    angle_distortion_mean: f64,
    /// 99th percentile of angle_distortion.
    angle_distortion_p99: f64,
    /// Maximum of angle_distortion.
    angle_distortion_max: f64,
}

impl Distortion {
    pub fn new(py: Python<'_>, figures: authalic::Distortion) -> PyResult<Py<Self>> {
        let figures = Self {
            authalic_energy: figures.authalic_energy,
            area_ratio_mean: figures.area_ratio_mean,
            area_ratio_std: figures.area_ratio_std,
            log2_area_ratio: from_array(py, figures.log2_area_ratio),
            folded: from_index_list(py, figures.folded.iter().copied()),
            angle_distortion: from_array(py, figures.angle_distortion),
            angle_distortion_mean: figures.angle_distortion_mean,
            angle_distortion_p99: figures.angle_distortion_p99,
            angle_distortion_max: figures.angle_distortion_max,
        };
        made(py, figures, None)
    }
}

restorable!(Distortion {
    authalic_energy,
    area_ratio_mean,
    area_ratio_std,
    log2_area_ratio,
    folded,
    angle_distortion,
    angle_distortion_mean,
    angle_distortion_p99,
    angle_distortion_max
});

#[pymethods]
impl Distortion {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!(
            "Distortion(authalic_energy={:.3e}, area_ratio_std={:.3e}, folded={}, angle_distortion_mean={:.3})",
            self.authalic_energy,
            self.area_ratio_std,
            self.folded.bind(py).len()?,
            self.angle_distortion_mean,
        ))
    }
}

/// Measures a map: area ratios, authalic energy, folds, angle distortion.
///
/// Target areas are rescaled so that they sum to the image's area. Exact predicates decide which faces are folded.
///
/// Parameters
/// ----------
/// vertices : (n, 3) real array
///     Positions on the surface, any unit. Or a Surface, without `faces`: `distortion(surface, image)`.
/// faces : (m, 3) int array
///     Triangles; they need not form a manifold. Faces turned against the rest of their component are turned back.
/// image : (n, 2) or (n, 3) real array
///     The map: into the plane (a face is positive counter-clockwise), or onto a sphere around the origin
///     (positive counter-clockwise from outside). Arrays in single precision are measured and certified as they are.
/// density : (m,) real array, optional
///     Positive target measure of each face, on any scale. Default: the face areas.
///
/// Returns
/// -------
/// Distortion
///
/// Raises
/// ------
/// MeshError
///     An array has a wrong shape or NaN, or faces or the image have no area.
///
/// Examples
/// --------
/// >>> import authalic
/// >>> square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
/// >>> figures = authalic.distortion(square, [[0, 1, 2], [0, 2, 3]], [[0, 0], [2, 0], [2, 2], [0, 2]])
/// >>> figures.area_ratio_std, len(figures.folded)
/// (0.0, 0)
#[pyfunction]
#[pyo3(signature = (vertices, faces=None, image=None, *, density=None))]
pub fn distortion(
    py: Python<'_>,
    vertices: &Bound<'_, PyAny>,
    faces: Option<&Bound<'_, PyAny>>,
    image: Option<&Bound<'_, PyAny>>,
    density: Option<&Bound<'_, PyAny>>,
) -> PyResult<Py<Distortion>> {
    let (given, map) = Given::with_image(vertices, faces, image)?;
    let map = arrays::image(map)?;
    let density = density.map(|density| reals(density, "density")).transpose()?;
    memory::check(py, memory::FIGURES, given.n_vertices())?;
    let figures = run(py, None, move |_| {
        authalic::distortion(&given.surface()?, map.view(), density.as_ref().map(|density| density.view()))
    })?;
    Distortion::new(py, figures)
}

/// Measures many maps in one go, which is much faster than one by one where they are small.
///
/// Parameters
/// ----------
/// surfaces : sequence of Surface, Patch or (vertices, faces)
///     The surfaces.
/// images : sequence of (n, 2) or (n, 3) real arrays
///     The map of each surface, as for `distortion`.
/// densities : sequence of (m,) real arrays or None, optional
///     The target measures of the faces of each surface. Default: the face areas.
///
/// Returns
/// -------
/// list of Distortion or MeshError
///     The figures of each map, or why it has none.
///
/// Raises
/// ------
/// MeshError
///     The arrays of a surface have a wrong shape or index, or a list another length.
///
/// Examples
/// --------
/// >>> import authalic
/// >>> triangle = [[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]
/// >>> images = [[0, 0], [1, 0], [0, 1]], [[0, 0], [0, 1], [1, 0]]
/// >>> [len(each.folded) for each in authalic.distortions([triangle, triangle], images)]
/// [0, 1]
#[pyfunction]
#[pyo3(signature = (surfaces, images, *, densities=None))]
pub fn distortions(
    py: Python<'_>,
    surfaces: Items<Bound<'_, PyAny>>,
    images: Items<Bound<'_, PyAny>>,
    densities: Option<Items<Option<Bound<'_, PyAny>>>>,
) -> PyResult<Vec<Py<PyAny>>> {
    let (Items(surfaces), Items(images)) = (surfaces, images);
    if images.len() != surfaces.len() {
        let (found, expected) =
            (format!("of length {}", images.len()), format!("of length {}", surfaces.len()));
        return Err(bad_array(py, "images", found, expected));
    }
    let names = ["surfaces", "vertices", "faces"];
    let given = surfaces.iter().map(|each| Given::pair(each, names)).collect::<PyResult<Vec<_>>>()?;
    let images = images.iter().map(arrays::image).collect::<PyResult<Vec<_>>>()?;
    let densities = reals_of_each(py, densities, ["densities", "density"], given.len())?;
    memory::check(py, memory::FIGURES, given.iter().map(Given::n_vertices).sum())?;
    let figures = run(py, None, move |_| {
        let surfaces = given.into_iter().map(Given::surface).collect::<Result<Vec<_>, Error>>()?;
        let maps: Vec<_> = surfaces
            .into_iter()
            .zip(images)
            .zip(densities)
            .map(|((surface, image), density)| (surface, image, density))
            .collect();
        Ok(authalic::distortions(&maps))
    })?;
    let results = figures.into_iter().map(|figures| match figures {
        Ok(figures) => Ok(Distortion::new(py, figures)?.into_any()),
        Err(error) => Ok(to_python(py, &error).into_value(py).into_any()),
    });
    results.collect()
}
