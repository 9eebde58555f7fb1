// SPDX-License-Identifier: MIT OR Apache-2.0
//! Bindings of `authalic::hyperbolic_structure`: Fuchsian group, pants and hexagons.

use authalic::{self as core, Complex, Moebius, Vertex};
use numpy::{Complex64, PyArray1, PyArray2, PyArray3, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::arrays::{Reals, from_array, frozen};
use crate::errors::bad_option;
use crate::indices::{from_index_list, from_indices};
use crate::memory;
use crate::options::{choice, metrics};
use crate::provenance::{Call, fingerprint, options};
use crate::registration::vertex_paths;
use crate::result::{Restorable, ResultBase, State, made, restorable};
use crate::run::run;
use crate::surface::Given;

/// Isometries as rows (a, b).
type Isometries = Py<PyArray2<Complex64>>;

/// A pair of pants between closed geodesics, and its two right-angled hexagons.
#[pyclass(frozen, get_all, extends = ResultBase, module = "authalic")]
pub struct Pants {
    /// (3,) float64: the lengths of its boundaries.
    ///
    /// They are those of the pants curve before it, the feature, and the pants curve after it. At the ends of the
    /// chain the first and the last feature take the place of curves.
    boundary_lengths: Py<PyArray1<f64>>,
    /// (2, 6, 2) float64: the corners of the hexagons in Klein's model.
    ///
    /// Sides 0–1, 2–3 and 4–5 lie on the boundaries in the order of the lengths and are half as long; both hexagons
    /// share side 5–0. The first is counter-clockwise, the second its mirror image.
    hexagons: Py<PyArray3<f64>>,
    /// (2, 6) float64: the inner angles, π/2 up to rounding.
    angles: Py<PyArray2<f64>>,
    /// (2,) complex128: (a, b) of the isometry from the disk of the hexagons to the disk of `positions`.
    placement: Py<PyArray1<Complex64>>,
}

impl Pants {
    fn new(py: Python<'_>, pants: &core::Pants) -> PyResult<Py<Self>> {
        let hexagons = pants.hexagons.map(|corners| corners.map(|z| [z.re, z.im]));
        let as_vectors: Vec<Vec<Vec<f64>>> =
            hexagons.iter().map(|corners| corners.iter().map(|corner| corner.to_vec()).collect()).collect();
        let pants = Self {
            boundary_lengths: frozen(PyArray1::from_slice(py, &pants.boundary_lengths)),
            hexagons: frozen(PyArray3::from_vec3(py, &as_vectors)?),
            angles: frozen(PyArray2::from_vec2(py, &pants.angles.map(|angles| angles.to_vec()))?),
            placement: frozen(PyArray1::from_slice(py, &[pants.placement.a, pants.placement.b])),
        };
        made(py, pants, None)
    }
}

restorable!(Pants { boundary_lengths, hexagons, angles, placement });

#[pymethods]
impl Pants {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let [a, b, c]: [f64; 3] = self.boundary_lengths.extract(py)?;
        Ok(format!("Pants(boundary lengths {a:.3}, {b:.3}, {c:.3})"))
    }
}

/// A surface sliced along curves, with its hyperbolic metric, its Fuchsian group and its pairs of pants.
///
/// A chain runs through all B features: the curves as given, then the other boundary loops. An arc leads from each
/// feature to the next. Cut along features and arcs, the surface is a disk, the fundamental domain. A row (a, b)
/// stands for the isometry z ↦ (a z + b) / (conj(b) z + conj(a)) of the Poincaré disk, with |a|² − |b|² = 1.
#[pyclass(frozen, extends = ResultBase, module = "authalic")]
pub struct HyperbolicStructure {
    /// (n, 3) float64: the vertices of the sliced surface; a vertex of a slit occurs on both banks.
    #[pyo3(get)]
    vertices: Py<PyArray2<f64>>,
    /// (m, 3) int64: the faces of the sliced surface; some given faces are divided.
    #[pyo3(get)]
    faces: Py<PyArray2<i64>>,
    /// (n,) int64: the given vertex that each vertex is; -1 for midpoints of edges.
    #[pyo3(get)]
    vertex_of: Py<PyArray1<i64>>,
    /// (m, 3) int64: the faces of the disk, the surface cut along the arcs too.
    #[pyo3(get)]
    disk_faces: Py<PyArray2<i64>>,
    /// (n_disk, 2) float64: the vertices of the disk in the Poincaré disk.
    #[pyo3(get)]
    positions: Reals,
    /// (n_disk,) int64: the row of `vertices` that each vertex of the disk copies.
    #[pyo3(get)]
    disk_vertex_of: Py<PyArray1<i64>>,
    /// (B,) int64: the features in the order of the chain.
    #[pyo3(get)]
    order: Py<PyArray1<i64>>,
    /// (B,) bool: whether the chain runs through each feature from end to start.
    #[pyo3(get)]
    reversed: Py<PyArray1<bool>>,
    /// B pairs of (k,) int64: the left and right bank of each feature, as vertices of the disk along the chain.
    #[pyo3(get)]
    banks: Vec<Sides>,
    /// B − 1 pairs of (k,) int64: the left and right copy of each arc, as vertices of the disk along the chain.
    #[pyo3(get)]
    arcs: Vec<Sides>,
    /// (B − 1, 2) complex128: the generators of the Fuchsian group.
    ///
    /// Generator k takes the left copy of arc k to the right one; it goes around the first k features of the chain,
    /// counted from 1.
    #[pyo3(get)]
    generators: Isometries,
    /// (B,) float64: the lengths of the features once around, in the order given.
    #[pyo3(get)]
    boundary_lengths: Py<PyArray1<f64>>,
    /// B − 2 pairs of pants along the chain.
    #[pyo3(get)]
    pants: Vec<Py<Pants>>,
    /// B − 3 arrays (k, 3) float64: the closed geodesics between the pants on the surface.
    ///
    /// The first point of each is repeated at the end.
    #[pyo3(get)]
    pants_curves: Vec<Py<PyArray2<f64>>>,
    /// (B − 3,) float64: the lengths of the geodesics.
    #[pyo3(get)]
    lengths: Py<PyArray1<f64>>,
    /// The largest curvature that the metric has left.
    #[pyo3(get)]
    curvature: f64,
    /// The hyperbolic area, 2π(B − 2) up to rounding.
    #[pyo3(get)]
    area: f64,
    /// The isometries of `generators`.
    motions: Vec<Moebius>,
}

/// Vertices on the left and on the right.
type Sides = (Py<PyArray1<i64>>, Py<PyArray1<i64>>);

impl HyperbolicStructure {
    fn new(py: Python<'_>, structure: core::HyperbolicStructure) -> PyResult<Self> {
        let list = |vertices: &[Vertex]| from_index_list(py, vertices.iter().copied());
        let sides = |sides: &[[Vec<Vertex>; 2]]| -> Vec<Sides> {
            sides.iter().map(|[left, right]| (list(left), list(right))).collect()
        };
        let vertex_of =
            structure.vertex_of.iter().map(|vertex| vertex.map_or(-1, |vertex| i64::from(vertex.0)));
        let pants = structure.pants.iter().map(|pants| Pants::new(py, pants));
        Ok(Self {
            vertices: from_array(py, structure.vertices()),
            faces: from_indices(py, structure.faces().view()),
            vertex_of: frozen(PyArray1::from_iter(py, vertex_of)),
            disk_faces: from_indices(py, structure.disk_faces().view()),
            positions: from_array(py, structure.positions()),
            disk_vertex_of: list(&structure.disk_vertex_of),
            order: from_index_list(py, structure.chain.iter().map(|&(feature, _)| feature)),
            reversed: frozen(PyArray1::from_iter(py, structure.chain.iter().map(|&(_, reversed)| reversed))),
            banks: sides(&structure.banks),
            arcs: sides(&structure.arcs),
            generators: isometries(py, &structure.generators)?,
            boundary_lengths: frozen(PyArray1::from_slice(py, &structure.boundary_lengths)),
            pants: pants.collect::<PyResult<_>>()?,
            pants_curves: structure.pants_curves().into_iter().map(|curve| from_array(py, curve)).collect(),
            lengths: frozen(PyArray1::from_slice(py, &structure.lengths)),
            curvature: structure.curvature,
            area: structure.area,
            motions: structure.generators,
        })
    }
}

impl Restorable for HyperbolicStructure {
    const FIELDS: &'static [&'static str] = &[
        "vertices",
        "faces",
        "vertex_of",
        "disk_faces",
        "positions",
        "disk_vertex_of",
        "order",
        "reversed",
        "banks",
        "arcs",
        "generators",
        "boundary_lengths",
        "pants",
        "pants_curves",
        "lengths",
        "curvature",
        "area",
    ];

    fn restored(state: &State<'_>) -> PyResult<Self> {
        let generators: Isometries = state.get("generators")?;
        let rows = generators.bind(state.py()).readonly();
        let rows = rows.as_array();
        if rows.ncols() != 2 {
            return Err(PyValueError::new_err("the saved result has wrong generators"));
        }
        let motions = rows.rows().into_iter().map(|row| Moebius { a: row[0], b: row[1] }).collect();
        Ok(Self {
            vertices: state.get("vertices")?,
            faces: state.get("faces")?,
            vertex_of: state.get("vertex_of")?,
            disk_faces: state.get("disk_faces")?,
            positions: state.get("positions")?,
            disk_vertex_of: state.get("disk_vertex_of")?,
            order: state.get("order")?,
            reversed: state.get("reversed")?,
            banks: state.get("banks")?,
            arcs: state.get("arcs")?,
            generators,
            boundary_lengths: state.get("boundary_lengths")?,
            pants: state.get("pants")?,
            pants_curves: state.get("pants_curves")?,
            lengths: state.get("lengths")?,
            curvature: state.get("curvature")?,
            area: state.get("area")?,
            motions,
        })
    }
}

/// Isometries as rows (a, b).
fn isometries(py: Python<'_>, motions: &[Moebius]) -> PyResult<Isometries> {
    let rows: Vec<Vec<Complex>> = motions.iter().map(|motion| vec![motion.a, motion.b]).collect();
    Ok(frozen(PyArray2::from_vec2(py, &rows)?))
}

#[pymethods]
impl HyperbolicStructure {
    /// The fundamental domain and its copies in the universal cover, from the middle outward.
    ///
    /// Parameters
    /// ----------
    /// copies : int
    ///     The greatest number of copies, the domain itself included.
    ///
    /// Returns
    /// -------
    /// words : list of tuple of int
    ///     The reduced word of generators that leads to each copy: k is the k-th generator, counted from 1, and -k
    ///     its inverse; the last acts first. The domain itself has ().
    /// motions : (k, 2) complex128
    ///     The isometries that take the domain to the copies.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     `copies` is below 1.
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
    /// >>> structure = authalic.hyperbolic_structure(rings, faces, curves=curves)
    /// >>> words, motions = structure.cover(7)
    /// >>> words[0], len(words[1]), motions.shape
    /// ((), 1, (7, 2))
    fn cover(&self, py: Python<'_>, copies: i64) -> PyResult<(Vec<Py<PyAny>>, Isometries)> {
        let count = usize::try_from(copies).ok().filter(|&count| count > 0);
        let count = count.ok_or_else(|| bad_option(format!("copies must be ≥ 1, but is {copies}")))?;
        let cover = core::cover(&self.motions, count);
        let word =
            |copy: &core::CoverCopy| Ok(pyo3::types::PyTuple::new(py, &copy.word)?.into_any().unbind());
        let words = cover.iter().map(word).collect::<PyResult<_>>()?;
        let motions: Vec<Moebius> = cover.iter().map(|copy| copy.motion).collect();
        Ok((words, isometries(py, &motions)?))
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!(
            "HyperbolicStructure({} features, {} pairs of pants, area {:.4}, curvature {:.1e})",
            self.boundary_lengths.bind(py).len()?,
            self.pants.len(),
            self.area,
            self.curvature,
        ))
    }
}

/// The hyperbolic structure of a surface of genus 0 sliced along curves.
///
/// It consists of the metric, the Fuchsian group, pairs of pants and hexagons.
///
/// These are the objects of the theory behind `register_hyperbolic` (Shi et al. 2013, section 3). The sliced surface
/// has one hyperbolic metric with geodesic boundary, which lays it out in the Poincaré disk. Closed geodesics divide
/// it into pairs of pants, and these into right-angled hexagons.
///
/// Parameters
/// ----------
/// vertices : (n, 3) real array
///     Positions, any unit. Or a Surface, without `faces`.
/// faces : (m, 3) int array
///     Triangles: one component without handles, closed or with boundary loops.
/// curves : list of (k,) int arrays
///     Disjoint paths of vertices along edges, each of at least two edges, off the boundary; or whole boundary loops,
///     which are features in any case. There must be at least three features.
/// metric : "newton" or "ricci_flow"
///     The method for the metric: Newton's, or the paper's Ricci flow (slow, then finished by Newton's).
/// progress : callable(fraction, message) -> bool, optional
///     Called between steps and within long ones; False cancels.
///
/// Returns
/// -------
/// HyperbolicStructure
///
/// Raises
/// ------
/// MeshError
///     The surface has another topology, an array does not fit, there are fewer than three features, or curves are no
///     simple edge paths, touch each other or the boundary, or divide the surface. Nothing is computed.
/// ValueError
///     An option is out of its range.
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
/// >>> structure = authalic.hyperbolic_structure(rings, faces, curves=curves)
/// >>> len(structure.generators), len(structure.pants), round(structure.area / np.pi, 9)
/// (3, 2, 4.0)
/// >>> words, motions = structure.cover(7)
/// >>> motions.shape, all(abs(pants.angles - np.pi / 2).max() < 1e-9 for pants in structure.pants)
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
) -> PyResult<Py<HyperbolicStructure>> {
    let kept = options!(py; curves, metric)?;
    let metric = choice("metric", metric, &metrics())?;
    let given = Given::new(vertices, faces)?;
    memory::check(py, memory::STRUCTURE, given.n_vertices())?;
    let curves = vertex_paths(curves, "curves", given.n_vertices())?;
    let (structure, input) = run(py, progress, move |observer| {
        let surface = given.surface()?;
        Ok((core::hyperbolic_structure(&surface, &curves, metric, observer)?, fingerprint(&surface)))
    })?;
    let call = Call::new("hyperbolic_structure", &kept, "surface", input);
    made(py, HyperbolicStructure::new(py, structure)?, call.into())
}
