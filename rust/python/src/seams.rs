// SPDX-License-Identifier: MIT OR Apache-2.0
//! Bindings of `authalic::seams` and `authalic::unwrap`.

use std::time::Instant;

use authalic::{SeamMethod, SeamOptions, Symmetry, UnwrapOptions, UnwrapSeams};
use numpy::ndarray::{Array1, Array2};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::{Borrowed, FromPyObject, IntoPyObjectExt};

use crate::arrays::{Reals, from_array, reals};
use crate::errors::{bad_array, bad_option};
use crate::indices::{from_index_list, from_indices, index_table};
use crate::memory;
use crate::options::choice;
use crate::provenance::{Call, fingerprint, options};
use crate::result::{ResultBase, made, restorable};
use crate::run::run;
use crate::surface::Given;
use crate::values::Values;

/// Seams of a surface, and the islands that they leave.
#[pyclass(frozen, get_all, extends = ResultBase, module = "authalic")]
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

restorable!(Seams { status, edges, islands, island_of, length, predicted, seconds });

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

/// The UVs of a surface: one map of its islands into the unit square.
#[pyclass(frozen, get_all, extends = ResultBase, module = "authalic")]
pub struct Unwrap {
    /// (k, 2) float64: the points, by island, then by vertex; in the unit square if they are packed.
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
    /// The share of the unit square that the islands cover; 0 if they are not packed.
    packed: f64,
    /// "converged" if the wanted shear is reached; "stalled" if it is not.
    status: &'static str,
    /// Wall time of the call.
    seconds: f64,
}

restorable!(Unwrap {
    status,
    uv,
    faces,
    vertex_of,
    islands,
    island_of,
    edges,
    length,
    shear,
    shear_p99,
    area_ratio_std,
    packed,
    seconds
});

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

impl SymmetryWish {
    /// The word of the option.
    fn as_str(self) -> &'static str {
        if self.0 == Symmetry::Auto { "auto" } else { "off" }
    }
}

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

impl SeamSource {
    /// The option as it may be given again.
    fn object(&self, py: Python<'_>) -> PyResult<Option<Py<PyAny>>> {
        match self {
            Self::Automatic => "auto".into_py_any(py).map(Some),
            Self::Given(edges) => Ok(edges.as_ref().map(|edges| edges.clone_ref(py))),
        }
    }
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
            // a result of `seams` stands for its edges
            Err(_) => match given.getattr("edges") {
                Ok(edges) => Ok(Self::Given(Some(edges.unbind()))),
                Err(_) => Ok(Self::Given(Some(given.to_owned().unbind()))),
            },
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
/// The surface may have any genus, any number of boundary loops, and several components. The seams are short, run in
/// creases and hidden places where they can, and leave as few islands as they can, each a topological disk. A plate that
/// is clamped along the seams predicts the shear of the best maps; maps of the islands correct the prediction.
///
/// Parameters
/// ----------
/// surface : Surface, or (vertices, faces)
///     (n, 3) real and (m, 3) int array: an orientable manifold where it is not cut along `fixed`.
/// target : float
///     The mean of σ₁/σ₂ over the surface that is wanted, > 1: the ratio of the singular values of each face's map,
///     weighted by area; 1 is no shear. Default 1.4, which needs the shortest seams that still look even; 1.25 needs
///     them about a quarter longer, up to three times on much relief, and shows hardly any shear.
/// fixed : (k, 2) int array, optional
///     Seams that are given, each the two ends of an edge. They stay, and others are added.
/// weights : (n,) or (e,) real array, optional
///     Factors of the cost of a seam, > 0, at the vertices or at the edges in ascending order of their ends, the lower
///     end first. Above 1 they keep seams off, below 1 they draw them, and `inf` forbids them. An edge has the mean of
///     its two vertices.
/// front : (3,) real array, optional
///     A direction from which the surface is seen, of any length. Seams cost up to three times as much on faces that
///     look there.
/// symmetry : "auto" or "off"
///     "auto", the default, mirrors the seams where the surface has a mirror plane, unless symmetric seams are much
///     worse than others. True means "auto"; False and None mean "off".
/// max_islands : int, optional
///     The most islands of the surface, ≥ 1; components, and parts between `fixed` seams, have at least one each.
/// overlap : bool
///     Let islands overlap themselves in the plane, which makes seams shorter. Default False.
/// diagonals : (d, 2) int array, optional
///     Edges that only triangulate polygons, each as its two ends. Seams along them cost four times as much.
/// method : "search" or "cones"
///     "search", the default, seeks the shortest seams and maps the islands to check them. "cones" joins the places of
///     most curvature by cheapest paths, without a map: a preview within a fraction of a second, whose seams are somewhat
///     longer and may miss the target.
/// progress : callable(fraction, message) -> bool, optional
///     Called throughout; False cancels, and the call raises.
///
/// Returns
/// -------
/// Seams
///
/// Raises
/// ------
/// MeshError
///     The mesh is broken, an array does not fit, or a fixed seam is no edge of the mesh.
/// ValueError
///     An option is out of its range.
/// SolverError
///     The call was cancelled, or the numerics failed.
///
/// Examples
/// --------
/// >>> import authalic
/// >>> corners = [[3, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0], [0, 0, -1]]
/// >>> faces = [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]]
/// >>> seams = authalic.seams((corners, faces))
/// >>> seams.status
/// 'converged'
/// >>> all(patch.is_disk for patch in authalic.cut(corners, faces, seams=seams.edges))
/// True
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
) -> PyResult<Py<Seams>> {
    // 1. Arguments to plain data
    let kept = options!(
        py; target, fixed, weights, front, symmetry = symmetry.as_str(), max_islands, overlap, diagonals, method
    )?;
    let began = Instant::now();
    let given = Given::pair(surface, ["surface", "surface vertices", "surface faces"])?;
    let arguments =
        Arguments { target, fixed, weights, front, symmetry, max_islands, overlap, diagonals, method };
    let wishes = arguments.parse(given.n_vertices())?;
    memory::check(py, memory::MAP, given.n_vertices())?;
    // 2. The run
    let (seams, input) = run(py, progress, move |observer| {
        let surface = given.surface()?;
        Ok((authalic::seams(&surface, &wishes.options(), observer)?, fingerprint(&surface)))
    })?;
    // 3. The result
    let seams = Seams {
        edges: from_indices(py, seams.edges.view()),
        islands: seams.islands,
        island_of: from_index_list(py, seams.island_of.iter().map(|&island| island as usize)),
        length: seams.length,
        predicted: seams.predicted,
        status: seams.status.as_str(),
        seconds: began.elapsed().as_secs_f64(),
    };
    made(py, seams, Call::new("seams", &kept, "surface", input).into())
}

/// Cuts a surface, maps its islands at one density, and packs them into the unit square.
///
/// The one call from a mesh to its UVs. Every island has the same share of the texture for its area, to a few
/// thousandths; no face is folded, and no island overlaps itself or another.
///
/// Parameters
/// ----------
/// surface : Surface, or (vertices, faces)
///     (n, 3) real and (m, 3) int array: an orientable manifold where it is not cut along seams.
/// seams : "auto", (s, 2) int array, or None
///     "auto", the default, finds them, as `seams` does with the options below. An array has all seams, each as the two
///     ends of an edge, and no others are made. None has no seams: the components must be disks, or have holes. The
///     options from `target` to `diagonals` but `overlap` count for "auto" only.
/// target : float
///     The mean of σ₁/σ₂ over the surface that is wanted, > 1: the ratio of the singular values of each face's map,
///     weighted by area; 1 is no shear. Default 1.4, which needs the shortest seams that still look even; 1.25 needs
///     them about a quarter longer, up to three times on much relief, and shows hardly any shear.
/// fixed : (k, 2) int array, optional
///     Seams that are given, each the two ends of an edge. They stay, and others are added.
/// weights : (n,) or (e,) real array, optional
///     Factors of the cost of a seam, > 0, at the vertices or at the edges in ascending order of their ends, the lower
///     end first. Above 1 they keep seams off, below 1 they draw them, and `inf` forbids them. An edge has the mean of
///     its two vertices.
/// front : (3,) real array, optional
///     A direction from which the surface is seen, of any length. Seams cost up to three times as much on faces that
///     look there.
/// symmetry : "auto" or "off"
///     "auto", the default, mirrors the seams where the surface has a mirror plane, unless symmetric seams are much
///     worse than others. True means "auto"; False and None mean "off".
/// max_islands : int, optional
///     The most islands of the surface, ≥ 1; components, and parts between `fixed` seams, have at least one each.
/// overlap : bool
///     Let islands overlap themselves in the plane, which makes seams shorter. Default False.
/// diagonals : (d, 2) int array, optional
///     Edges that only triangulate polygons, each as its two ends. Seams along them cost four times as much.
/// pack : bool
///     Pack the islands into the unit square. False leaves each island where its map lies, with the areas of the surface:
///     islands may lie over each other, for a packer of the caller's own. Default True.
/// margin : float
///     Least distance of islands from each other and from the border of the square, in [0, .5), in units of the
///     square. Default .002, which is two pixels of a texture of 1,024².
/// rotate : bool
///     Let the packing turn islands by any angle. Default True.
/// progress : callable(fraction, message) -> bool, optional
///     Called throughout; False cancels, and the call raises.
///
/// Returns
/// -------
/// Unwrap
///
/// Raises
/// ------
/// MeshError
///     The mesh is broken, an array does not fit, a seam is no edge of the mesh, or an island along given seams is
///     closed or has handles.
/// ValueError
///     An option is out of its range.
/// SolverError
///     The call was cancelled, or the numerics failed.
///
/// Examples
/// --------
/// >>> import authalic
/// >>> corners = [[3, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0], [0, 0, -1]]
/// >>> faces = [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]]
/// >>> result = authalic.unwrap((corners, faces))
/// >>> result.faces.shape
/// (8, 3)
/// >>> bool(((result.uv >= 0) & (result.uv <= 1)).all())
/// True
/// >>> result.area_ratio_std < 0.005
/// True
#[pyfunction]
#[pyo3(
    signature = (surface, *, seams=SeamSource::Automatic, target=1.4, fixed=None, weights=None, front=None,
        symmetry=AUTO, max_islands=None, overlap=false, diagonals=None, pack=true, margin=0.002, rotate=true,
        progress=None),
    text_signature = "(surface, *, seams=\"auto\", target=1.4, fixed=None, weights=None, front=None, \
        symmetry=\"auto\", max_islands=None, overlap=False, diagonals=None, pack=True, margin=0.002, rotate=True, progress=None)"
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
    pack: bool,
    margin: f64,
    rotate: bool,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Py<Unwrap>> {
    // 1. Arguments to plain data
    let kept = options!(
        py; seams = seams.object(py)?, target, fixed, weights, front, symmetry = symmetry.as_str(), max_islands, overlap,
        diagonals, pack, margin, rotate
    )?;
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
    memory::check(py, memory::MAP, given.n_vertices())?;
    // 2. The run
    let (map, input) = run(py, progress, move |observer| {
        let surface = given.surface()?;
        let seams = match &edges {
            None => UnwrapSeams::Automatic(wishes.options()),
            Some(edges) => UnwrapSeams::Given(edges.view()),
        };
        let options = UnwrapOptions { seams, overlap, pack, margin, rotate };
        Ok((authalic::unwrap(&surface, &options, observer)?, fingerprint(&surface)))
    })?;
    // 3. The result
    let map = Unwrap {
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
    };
    made(py, map, Call::new("unwrap", &kept, "surface", input).into())
}
