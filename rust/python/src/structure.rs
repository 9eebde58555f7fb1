// SPDX-License-Identifier: MIT OR Apache-2.0
//! Bindings of `authalic::hyperbolic`'s structure of a surface: Fuchsian group, pants and hexagons.

use authalic::{self as core, Complex, Moebius};
use numpy::{Complex64, PyArray1, PyArray2, PyArray3};
use pyo3::prelude::*;

use crate::arrays::{Reals, from_array, from_index_list, from_indices};
use crate::errors::bad_option;
use crate::options::{choice, metrics};
use crate::registration::vertex_paths;
use crate::run::run;
use crate::surface::Given;

/// Rows (a, b).
type Isometries = Py<PyArray2<Complex64>>;

/// A pair of pants between closed geodesics, and its two right-angled hexagons.
#[pyclass(frozen, get_all, module = "authalic")]
pub struct Pants {
    /// (3,) float64: the lengths of its boundaries: the pants curve before, the feature, the pants curve
    /// after; at the ends of the chain the first and the last feature stand for curves.
    boundary_lengths: Py<PyArray1<f64>>,
    /// (2, 6, 2) float64: the corners of the hexagons in Klein's model. Sides 0–1, 2–3 and 4–5 lie on the
    /// boundaries in the order of the lengths and are half as long; side 5–0 is common to both. The first is
    /// counter-clockwise, the second its mirror image.
    hexagons: Py<PyArray3<f64>>,
    /// (2, 6) float64: the inner angles, π/2 but for rounding.
    angles: Py<PyArray2<f64>>,
    /// (2,) complex128: (a, b) of the isometry from the disk of the hexagons to that of `positions`.
    placement: Py<PyArray1<Complex64>>,
}

impl Pants {
    fn new(py: Python<'_>, pants: &core::Pants) -> PyResult<Self> {
        let hexagons = pants.hexagons.map(|corners| corners.map(|z| [z.re, z.im]));
        let as_vectors: Vec<Vec<Vec<f64>>> =
            hexagons.iter().map(|corners| corners.iter().map(|corner| corner.to_vec()).collect()).collect();
        Ok(Self {
            boundary_lengths: PyArray1::from_slice(py, &pants.boundary_lengths).unbind(),
            hexagons: PyArray3::from_vec3(py, &as_vectors)?.unbind(),
            angles: PyArray2::from_vec2(py, &pants.angles.map(|angles| angles.to_vec()))?.unbind(),
            placement: PyArray1::from_slice(py, &[pants.placement.a, pants.placement.b]).unbind(),
        })
    }
}

#[pymethods]
impl Pants {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let [a, b, c]: [f64; 3] = self.boundary_lengths.extract(py)?;
        Ok(format!("Pants(boundary lengths {a:.3}, {b:.3}, {c:.3})"))
    }
}

/// A surface sliced along curves, with its hyperbolic metric, its Fuchsian group and its pairs of pants.
///
/// A chain runs through all B features, curves as given and then the boundary loops that are not among them;
/// an arc leads from each to the next. Cut along features and arcs the surface is a disk, the fundamental
/// domain. Isometries of the Poincaré disk are rows (a, b) of z ↦ (a z + b) / (conj(b) z + conj(a)) with |a|²
/// − |b|² = 1.
#[pyclass(frozen, module = "authalic")]
pub struct HyperbolicStructure {
    /// (n, 3) float64: the vertices of the sliced surface; those of slits stand on both banks.
    #[pyo3(get)]
    vertices: Py<PyArray2<f64>>,
    /// (m, 3) int64: its faces; some of those given are divided.
    #[pyo3(get)]
    faces: Py<PyArray2<i64>>,
    /// (n,) int64: the vertices given; -1 for midpoints of edges.
    #[pyo3(get)]
    vertex_of: Py<PyArray1<i64>>,
    /// (m, 3) int64: the same faces of the disk, which is cut along the arcs too.
    #[pyo3(get)]
    disk_faces: Py<PyArray2<i64>>,
    /// (n_disk, 2) float64: where its vertices lie in the Poincaré disk.
    #[pyo3(get)]
    positions: Reals,
    /// (n_disk,) int64: which rows of `vertices` they are.
    #[pyo3(get)]
    disk_vertex_of: Py<PyArray1<i64>>,
    /// (B,) int64: the features in the order of the chain.
    #[pyo3(get)]
    order: Py<PyArray1<i64>>,
    /// (B,) bool: whether the chain runs through them from end to start.
    #[pyo3(get)]
    reversed: Py<PyArray1<bool>>,
    /// B pairs of (k,) int64: left and right bank of each feature of the chain, as vertices of the disk along
    /// the chain.
    #[pyo3(get)]
    banks: Vec<Sides>,
    /// B − 1 pairs of (k,) int64: left and right copy of each arc, as vertices of the disk along the chain.
    #[pyo3(get)]
    arcs: Vec<Sides>,
    /// (B − 1, 2) complex128: the generators of the Fuchsian group; each takes the left copy of its arc to
    /// the right one, and that of arc k goes around the first k features of the chain.
    #[pyo3(get)]
    generators: Isometries,
    /// (B,) float64: the lengths of the features once around, in the order in which they were given.
    #[pyo3(get)]
    boundary_lengths: Py<PyArray1<f64>>,
    /// B − 2 pairs of pants along the chain.
    #[pyo3(get)]
    pants: Vec<Py<Pants>>,
    /// B − 3 arrays (k, 3) float64: the closed geodesics between the pants on the surface, the first point
    /// once more at the end.
    #[pyo3(get)]
    pants_curves: Vec<Py<PyArray2<f64>>>,
    /// (B − 3,) float64: their lengths.
    #[pyo3(get)]
    lengths: Py<PyArray1<f64>>,
    /// The largest curvature that the metric has left.
    #[pyo3(get)]
    curvature: f64,
    /// The hyperbolic area, 2π(B − 2) but for rounding.
    #[pyo3(get)]
    area: f64,
    found: core::HyperbolicStructure,
}

/// Left and right.
type Sides = (Py<PyArray1<i64>>, Py<PyArray1<i64>>);

impl HyperbolicStructure {
    fn new(py: Python<'_>, found: core::HyperbolicStructure) -> PyResult<Self> {
        let list = |values: &[u32]| from_index_list(py, values.iter().map(|&i| i as usize));
        let sides = |sides: &[[Vec<u32>; 2]]| -> Vec<Sides> {
            sides.iter().map(|[left, right]| (list(left), list(right))).collect()
        };
        let vertex_of = found.vertex_of.iter().map(|vertex| vertex.map_or(-1, i64::from));
        let pants = found.pants.iter().map(|pants| Py::new(py, Pants::new(py, pants)?));
        Ok(Self {
            vertices: from_array(py, found.vertices()),
            faces: from_indices(py, found.faces().view()),
            vertex_of: PyArray1::from_iter(py, vertex_of).unbind(),
            disk_faces: from_indices(py, found.disk_faces().view()),
            positions: from_array(py, found.positions()),
            disk_vertex_of: list(&found.disk_vertex_of),
            order: from_index_list(py, found.chain.iter().map(|&(feature, _)| feature)),
            reversed: PyArray1::from_iter(py, found.chain.iter().map(|&(_, reversed)| reversed)).unbind(),
            banks: sides(&found.banks),
            arcs: sides(&found.arcs),
            generators: isometries(py, &found.generators)?,
            boundary_lengths: PyArray1::from_slice(py, &found.boundary_lengths).unbind(),
            pants: pants.collect::<PyResult<_>>()?,
            pants_curves: found.pants_curves().into_iter().map(|curve| from_array(py, curve)).collect(),
            lengths: PyArray1::from_slice(py, &found.lengths).unbind(),
            curvature: found.curvature,
            area: found.area,
            found,
        })
    }
}

/// Isometries as rows (a, b).
fn isometries(py: Python<'_>, motions: &[Moebius]) -> PyResult<Isometries> {
    let rows: Vec<Vec<Complex>> = motions.iter().map(|motion| vec![motion.a, motion.b]).collect();
    Ok(PyArray2::from_vec2(py, &rows)?.unbind())
}

#[pymethods]
impl HyperbolicStructure {
    /// The fundamental domain and its copies in the universal cover, from the middle outward.
    ///
    /// Parameters
    /// ----------
    /// copies : int
    ///     How many at the most, the domain itself included.
    ///
    /// Returns
    /// -------
    /// words : list of tuple of int
    ///     The generators that lead to each copy, without cancelling neighbours: k for the k-th one, counted
    ///     from 1, and -k for its inverse; the last one acts first. The domain itself has ().
    /// motions : (k, 2) complex128
    ///     The isometries that take the domain there.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     `copies` below 1.
    fn cover(&self, py: Python<'_>, copies: i64) -> PyResult<(Vec<Py<PyAny>>, Isometries)> {
        let count = usize::try_from(copies).ok().filter(|&count| count > 0);
        let count = count.ok_or_else(|| bad_option(format!("copies must be ≥ 1, but is {copies}")))?;
        let cover = self.found.cover(count);
        let word =
            |copy: &core::CoverCopy| Ok(pyo3::types::PyTuple::new(py, &copy.word)?.into_any().unbind());
        let words = cover.iter().map(word).collect::<PyResult<_>>()?;
        let motions: Vec<Moebius> = cover.iter().map(|copy| copy.motion).collect();
        Ok((words, isometries(py, &motions)?))
    }

    fn __repr__(&self) -> String {
        format!(
            "HyperbolicStructure({} features, {} pairs of pants, area {:.4}, curvature {:.1e})",
            self.found.chain.len(),
            self.found.pants.len(),
            self.area,
            self.curvature,
        )
    }
}

/// The hyperbolic structure of a surface of genus 0 sliced along curves: metric, Fuchsian group, pants and
/// hexagons.
///
/// The objects of the theory behind `register_hyperbolic` (Shi et al. 2013, section 3), for pictures and
/// further computation: the surface sliced along its curves has one hyperbolic metric with geodesic boundary,
/// is laid out by it in the Poincaré disk, and falls into pairs of pants along closed geodesics and these
/// into right-angled hexagons.
///
/// Parameters
/// ----------
/// vertices : (n, 3) real array
///     Positions, any unit. Or a Surface, without `faces`.
/// faces : (m, 3) integer array
///     Triangles: one component without handles, closed or with boundary loops.
/// curves : list of (k,) integer arrays
///     Paths of vertices along edges, each of at least two edges, without a vertex in common and off the
///     boundary; or whole boundary loops, which are features anyway. Curves and boundary loops together must
///     be at least three.
/// metric : "newton" or "ricci_flow"
///     How the metric is found: by Newton's method, or by the paper's Ricci flow (slow, then finished by
///     Newton).
/// progress : callable(fraction, message) -> bool, optional
///     Called between steps and in long ones from within; False cancels.
///
/// Returns
/// -------
/// HyperbolicStructure
///
/// Raises
/// ------
/// MeshError
///     A surface of another topology, an array that does not fit, curves that are no simple edge paths, touch
///     each other or the boundary or divide the surface, fewer than three features: the message names the
///     curve; nothing was computed.
/// ValueError
///     An option out of its range.
/// SolverError
///     Double precision did not suffice, or the call was cancelled.
///
/// Examples
/// --------
/// >>> import authalic, numpy as np
/// >>> t = np.linspace(0, 2 * np.pi, 24, endpoint=False)
/// >>> z = np.linspace(-0.9, 0.9, 13)
/// >>> rings = [[(1 - h * h) ** 0.5 * np.cos(a), (1 - h * h) ** 0.5 * np.sin(a), h] for h in z for a in t]
/// >>> faces = [f for i in range(12) for j in range(24) for a, b in [(24 * i + j, 24 * i + (j + 1) % 24)]
/// ...          for f in ([a, b, b + 24], [a, b + 24, a + 24])]
/// >>> curves = [[76, 100, 124, 148], [88, 112, 136, 160, 184]]
/// >>> found = authalic.hyperbolic_structure(rings, faces, curves=curves)
/// >>> len(found.generators), len(found.pants), round(found.area / np.pi, 9)
/// (3, 2, 4.0)
/// >>> words, motions = found.cover(7)
/// >>> motions.shape, all(abs(pants.angles - np.pi / 2).max() < 1e-9 for pants in found.pants)
/// ((7, 2), True)
#[pyfunction]
#[pyo3(signature = (vertices, faces=None, *, curves, metric="newton", progress=None))]
pub fn hyperbolic_structure(
    py: Python<'_>,
    vertices: &Bound<'_, PyAny>,
    faces: Option<&Bound<'_, PyAny>>,
    curves: &Bound<'_, PyAny>,
    metric: &str,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<HyperbolicStructure> {
    let metric = choice("metric", metric, &metrics())?;
    let given = Given::new(vertices, faces)?;
    let curves = vertex_paths(curves, "curves", given.n_vertices())?;
    let found = run(py, progress, move |observer| {
        core::hyperbolic_structure(&given.surface()?, &curves, metric, observer)
    })?;
    HyperbolicStructure::new(py, found)
}
