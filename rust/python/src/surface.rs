// SPDX-License-Identifier: MIT OR Apache-2.0
//! Bindings of `authalic::Surface`: the handle, its patches, and surfaces as arguments.

use authalic::{Error, RepairOptions, Topology, Vertex};
use numpy::ndarray::{Array2, Axis, aview2, concatenate};
use numpy::{PyArray1, PyArray2};
use pyo3::exceptions::PyTypeError;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;

use crate::arrays::{from_array, frozen, real_table};
use crate::errors::{bad_array, to_python};
use crate::hints::{refuse_plane, refuse_vtk};
use crate::indices::{from_index_list, from_indices, index_table};
use crate::memory;
use crate::mesh_objects::mesh_parts;
use crate::provenance::{Fingerprint, fingerprint, fingerprint_of};
use crate::result::{Restorable, ResultBase, State, made, restorable};
use crate::run::run;

/// A triangle mesh that is checked once, and accepted in the place of vertices and faces.
///
/// Maps, figures and cuts of a surface neither copy nor check its arrays again, and its areas and topology are computed
/// once. The arrays are checked here; the first function that needs an oriented manifold checks that the surface is
/// one. Surfaces never change, and threads may share them.
///
/// Parameters
/// ----------
/// vertices : (n, 3) real array
///     Positions, any unit. Or a mesh object of trimesh, pyvista, meshio or Open3D, without `faces`.
/// faces : (m, 3) int array
///     Triangles as vertex indices.
/// flat : bool
///     Take (n, 2) points of a flat surface, which gets z = 0. Default False.
///
/// Raises
/// ------
/// MeshError
///     An array is empty or has another shape or NaN, an index is out of range, or a face repeats a vertex.
///
/// Examples
/// --------
/// >>> import authalic
/// >>> pyramid = [[0, 0, 1], [1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]]
/// >>> surface = authalic.Surface(pyramid, [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]])
/// >>> surface
/// Surface(5 vertices, 4 faces)
/// >>> surface.is_disk
/// True
/// >>> uv = authalic.disk_map(surface).uv
/// >>> len(authalic.distortion(surface, uv.astype("float32")).folded)
/// 0
/// >>> [patch.surface for patch in surface.cut(seams=[[0, 1], [0, 3]])]
/// [Surface(4 vertices, 2 faces), Surface(4 vertices, 2 faces)]
#[pyclass(frozen, extends = ResultBase, module = "authalic")]
pub struct Surface {
    handle: authalic::Surface,
    vertices: PyOnceLock<Py<PyArray2<f64>>>,
    faces: PyOnceLock<Py<PyArray2<i64>>>,
}

impl From<authalic::Surface> for Surface {
    fn from(handle: authalic::Surface) -> Self {
        Self { handle, vertices: PyOnceLock::new(), faces: PyOnceLock::new() }
    }
}

impl Surface {
    /// A property of the topology; the first may take a while on a large mesh.
    fn of_topology<T: Send + 'static>(
        &self,
        py: Python<'_>,
        read: impl FnOnce(&Topology) -> T + Send + 'static,
    ) -> PyResult<T> {
        let surface = self.handle.clone();
        run(py, None, move |_| surface.topology().map(read))
    }
}

#[pymethods]
impl Surface {
    #[new]
    #[pyo3(signature = (vertices, faces=None, *, flat=false))]
    fn new(
        py: Python<'_>,
        vertices: &Bound<'_, PyAny>,
        faces: Option<&Bound<'_, PyAny>>,
        flat: bool,
    ) -> PyResult<PyClassInitializer<Self>> {
        let given = match faces {
            Some(faces) if flat => Given::flat(vertices, faces)?,
            faces => Given::new(vertices, faces)?,
        };
        let surface = Self::from(run(py, None, move |_| given.surface())?);
        Ok(PyClassInitializer::from(ResultBase::of_unknown_origin()).add_subclass(surface))
    }

    /// (n, 3) float64, read-only: the vertices as given.
    #[getter]
    fn vertices(&self, py: Python<'_>) -> PyResult<Py<PyArray2<f64>>> {
        let made =
            self.vertices.get_or_init(py, || frozen(PyArray2::from_array(py, &self.handle.vertices())));
        Ok(made.clone_ref(py))
    }

    /// (m, 3) int64, read-only: the faces as given; results have the faces as oriented.
    #[getter]
    fn faces(&self, py: Python<'_>) -> PyResult<Py<PyArray2<i64>>> {
        let made = self
            .faces
            .get_or_init(py, || frozen(PyArray2::from_owned_array(py, self.handle.faces().mapv(i64::from))));
        Ok(made.clone_ref(py))
    }

    /// The number of vertices.
    #[getter]
    fn n_vertices(&self) -> usize {
        self.handle.n_vertices()
    }

    /// The number of faces.
    #[getter]
    fn n_faces(&self) -> usize {
        self.handle.n_faces()
    }

    /// The number of connected components.
    ///
    /// This and the properties below raise MeshError if the surface is no oriented manifold.
    #[getter]
    fn n_components(&self, py: Python<'_>) -> PyResult<usize> {
        self.of_topology(py, Topology::n_components)
    }

    /// Vertices − edges + faces.
    #[getter]
    fn euler_characteristic(&self, py: Python<'_>) -> PyResult<i64> {
        self.of_topology(py, |topology| topology.euler_characteristic)
    }

    /// The number of handles.
    #[getter]
    fn genus(&self, py: Python<'_>) -> PyResult<Option<usize>> {
        self.of_topology(py, |topology| topology.genus)
    }

    /// List of (k,) int64: the boundary loops as vertices, the longest first, the surface on the left.
    #[getter]
    fn boundary_loops(&self, py: Python<'_>) -> PyResult<Vec<Py<PyArray1<i64>>>> {
        let loops = self.of_topology(py, |topology| topology.boundary_loops.clone())?;
        Ok(index_lists(py, &loops))
    }

    /// Whether the surface is a topological disk.
    #[getter]
    fn is_disk(&self, py: Python<'_>) -> PyResult<bool> {
        self.of_topology(py, Topology::is_disk)
    }

    /// Whether the surface has no boundary.
    #[getter]
    fn is_closed(&self, py: Python<'_>) -> PyResult<bool> {
        self.of_topology(py, Topology::is_closed)
    }

    /// Cuts the surface along seams into patches (islands), as the function `cut` does.
    ///
    /// Parameters
    /// ----------
    /// seams : (k, 2) int array, optional
    ///     Edges to cut, each as its two vertices. Without seams the patches are the connected components.
    ///
    /// Returns
    /// -------
    /// list of Patch
    ///     The patches in the order of their lowest faces.
    ///
    /// Raises
    /// ------
    /// MeshError
    ///     A seam is no edge.
    ///
    /// Examples
    /// --------
    /// >>> import authalic
    /// >>> square = authalic.Surface([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    /// >>> [len(patch.faces) for patch in square.cut(seams=[[0, 2]])]
    /// [1, 1]
    #[pyo3(signature = (*, seams=None))]
    fn cut(&self, py: Python<'_>, seams: Option<&Bound<'_, PyAny>>) -> PyResult<Vec<Py<Patch>>> {
        patches(py, Given::Handle(self.handle.clone()), seams)
    }

    fn __repr__(&self) -> String {
        format!("Surface({} vertices, {} faces)", self.handle.n_vertices(), self.handle.n_faces())
    }
}

impl Restorable for Surface {
    const FIELDS: &'static [&'static str] = &["vertices", "faces"];

    fn restored(state: &State<'_>) -> PyResult<Self> {
        let [vertices, faces] = ["vertices", "faces"].map(|name| state.object(name));
        let given = Given::arrays(&vertices?, &faces?, ["vertices", "faces"])?;
        Ok(given.surface().map_err(|error| to_python(state.py(), &error))?.into())
    }
}

fn index_lists(py: Python<'_>, lists: &[Vec<Vertex>]) -> Vec<Py<PyArray1<i64>>> {
    lists.iter().map(|list| from_index_list(py, list.iter().copied())).collect()
}

/// One piece of a cut mesh (an island), with maps back to the input. Taken wherever a Surface is.
#[pyclass(frozen, get_all, extends = ResultBase, module = "authalic")]
pub struct Patch {
    /// The patch as a surface of its own.
    surface: Py<Surface>,
    /// (n, 3) float64: the vertices, copies of input vertices.
    vertices: Py<PyArray2<f64>>,
    /// (m, 3) int64: the faces, in the order, winding and corner order of the input.
    faces: Py<PyArray2<i64>>,
    /// (n,) int64: the input vertex of each vertex.
    vertex_of: Py<PyArray1<i64>>,
    /// (m, 3) int64: the input corner, 3 × face + corner, of each corner.
    corner_of: Py<PyArray2<i64>>,
    /// (m,) int64: the input face of each face.
    face_of: Py<PyArray1<i64>>,
    /// Vertices − edges + faces.
    euler_characteristic: i64,
    /// The number of handles; None if the patch is not orientable.
    genus: Option<usize>,
    /// List of (k,) int64: the boundary loops as patch vertices, the longest first, the surface on the left.
    boundary_loops: Vec<Py<PyArray1<i64>>>,
    /// Whether the patch is a topological disk.
    is_disk: bool,
    /// Whether the patch has no boundary.
    is_closed: bool,
}

impl Patch {
    fn new(py: Python<'_>, patch: authalic::Patch) -> PyResult<Py<Self>> {
        let face_of = patch.corner_of.column(0).iter().map(|&corner| corner as usize / 3).collect::<Vec<_>>();
        let patch = Self {
            vertices: from_array(py, patch.surface.vertices().to_owned()),
            faces: from_indices(py, patch.surface.faces().view()),
            vertex_of: from_index_list(py, patch.vertex_of.iter().copied()),
            corner_of: from_indices(py, patch.corner_of.view()),
            face_of: from_index_list(py, face_of.into_iter()),
            euler_characteristic: patch.topology.euler_characteristic,
            genus: patch.topology.genus,
            boundary_loops: index_lists(py, &patch.topology.boundary_loops),
            is_disk: patch.is_disk(),
            is_closed: patch.is_closed(),
            surface: made(py, Surface::from(patch.surface), None)?,
        };
        made(py, patch, None)
    }
}

restorable!(Patch {
    surface,
    vertices,
    faces,
    vertex_of,
    corner_of,
    face_of,
    euler_characteristic,
    genus,
    boundary_loops,
    is_disk,
    is_closed
});

#[pymethods]
impl Patch {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!(
            "Patch({} vertices, {} faces, {} boundary loops, Euler characteristic {})",
            self.vertices.bind(py).len()?,
            self.faces.bind(py).len()?,
            self.boundary_loops.len(),
            self.euler_characteristic,
        ))
    }
}

/// Cuts a mesh along seams into patches (islands).
///
/// Corners of adjacent faces become one vertex wherever the faces meet in an edge that is no seam. Edges of three or
/// more faces act as seams, and parts that only touch in a vertex come apart. A seam opens the surface even if it does
/// not separate it; a single edge inside the surface opens nothing, because both sides keep both of its ends.
///
/// Parameters
/// ----------
/// vertices : (n, 3) real array
///     Positions, any unit. Or a Surface, without `faces`.
/// faces : (m, 3) int array
///     Triangles as vertex indices.
/// seams : (k, 2) int array, optional
///     Edges to cut, each as its two vertices. Without seams the patches are the connected components.
///
/// Returns
/// -------
/// list of Patch
///     The patches in the order of their lowest faces.
///
/// Raises
/// ------
/// MeshError
///     An array is empty or has NaN, an index is out of range, a face repeats a vertex, or a seam is no edge.
///
/// Examples
/// --------
/// >>> import authalic
/// >>> square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
/// >>> [len(patch.faces) for patch in authalic.cut(square, [[0, 1, 2], [0, 2, 3]], seams=[[0, 2]])]
/// [1, 1]
#[pyfunction]
#[pyo3(signature = (vertices, faces=None, *, seams=None))]
pub fn cut(
    py: Python<'_>,
    vertices: &Bound<'_, PyAny>,
    faces: Option<&Bound<'_, PyAny>>,
    seams: Option<&Bound<'_, PyAny>>,
) -> PyResult<Vec<Py<Patch>>> {
    patches(py, Given::new(vertices, faces)?, seams)
}

fn patches(py: Python<'_>, given: Given, seams: Option<&Bound<'_, PyAny>>) -> PyResult<Vec<Py<Patch>>> {
    let seams = seams.map(|seams| index_table::<2>(seams, "seams", given.n_vertices())).transpose()?;
    memory::check(py, memory::CUT, given.n_vertices())?;
    let patches = run(py, None, move |_| {
        let surface = given.surface()?;
        match seams {
            Some(seams) => surface.cut(seams),
            None => surface.cut(aview2::<u32, 2>(&[])),
        }
    })?;
    patches.into_iter().map(|patch| Patch::new(py, patch)).collect()
}

/// A surface as an argument.
pub enum Given {
    Handle(authalic::Surface),
    /// Vertices and faces of which only the dtype and shape are checked.
    Arrays(Array2<f64>, Array2<u32>),
}

impl Given {
    /// The first arguments of a function: a surface, or vertices and faces.
    pub fn new(vertices: &Bound<'_, PyAny>, faces: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        match (Self::whole(vertices, ["vertices", "faces"])?, faces) {
            (Some(given), None) => Ok(given),
            (Some(_), Some(_)) => Err(too_many()),
            (None, Some(faces)) => Self::arrays(vertices, faces, ["vertices", "faces"]),
            (None, None) => {
                Err(missing(vertices.py(), "faces", "integers of shape (m, 3) beside the vertices"))
            }
        }
    }

    /// A surface in one object: a Surface, Patch or Repaired, or a mesh object of another library.
    fn whole(object: &Bound<'_, PyAny>, names: [&'static str; 2]) -> PyResult<Option<Self>> {
        if let Some(handle) = handle(object) {
            return Ok(Some(Self::Handle(handle)));
        }
        let Some((vertices, faces)) = mesh_parts(object)? else { return Ok(None) };
        Self::arrays(&vertices, &faces, names).map(Some)
    }

    /// The first arguments of a function on a map: a surface and its image, or vertices, faces and image.
    pub fn with_image<'a, 'py>(
        vertices: &Bound<'py, PyAny>,
        faces: Option<&'a Bound<'py, PyAny>>,
        image: Option<&'a Bound<'py, PyAny>>,
    ) -> PyResult<(Self, &'a Bound<'py, PyAny>)> {
        let py = vertices.py();
        let no_image = || missing(py, "image", "real numbers of shape (n, 2) or (n, 3)");
        let Some(given) = Self::whole(vertices, ["vertices", "faces"])? else {
            let given = Self::new(vertices, faces)?;
            return Ok((given, image.ok_or_else(no_image)?));
        };
        // a surface takes the place of two arguments, so its image may be the second
        match (faces, image) {
            (Some(image), None) | (None, Some(image)) => Ok((given, image)),
            (None, None) => Err(no_image()),
            (Some(_), Some(_)) => Err(too_many()),
        }
    }

    /// One argument of the given name: a surface, or a pair (vertices, faces).
    pub fn pair(object: &Bound<'_, PyAny>, [name, vertices, faces]: [&'static str; 3]) -> PyResult<Self> {
        if let Some(given) = Self::whole(object, [vertices, faces])? {
            return Ok(given);
        }
        let parts: Vec<Bound<'_, PyAny>> =
            object.try_iter().and_then(|parts| parts.take(3).collect()).unwrap_or_default();
        let [first, second] = &parts[..] else {
            let found = match object.len() {
                Ok(length) => format!("{} of length {length}", object.get_type().name()?),
                Err(_) => object.get_type().name()?.to_string(),
            };
            return Err(bad_array(object.py(), name, found, "a pair (vertices, faces)".into()));
        };
        Self::arrays(first, second, [vertices, faces])
    }

    fn arrays(
        vertices: &Bound<'_, PyAny>,
        faces: &Bound<'_, PyAny>,
        [vertices_name, faces_name]: [&'static str; 2],
    ) -> PyResult<Self> {
        refuse_plane(vertices, vertices_name)?;
        let vertices = real_table::<3>(vertices, vertices_name)?;
        refuse_vtk(faces, faces_name)?;
        let faces = index_table::<3>(faces, faces_name, vertices.nrows())?;
        Ok(Self::Arrays(vertices, faces))
    }

    /// Points (n, 2) in the plane z = 0, and faces.
    fn flat(vertices: &Bound<'_, PyAny>, faces: &Bound<'_, PyAny>) -> PyResult<Self> {
        let points = real_table::<2>(vertices, "vertices")?;
        refuse_vtk(faces, "faces")?;
        let faces = index_table::<3>(faces, "faces", points.nrows())?;
        let heights = Array2::zeros((points.nrows(), 1));
        Ok(Self::Arrays(concatenate![Axis(1), points, heights], faces))
    }

    /// The fingerprint of what was given.
    pub fn fingerprint(&self) -> Fingerprint {
        match self {
            Self::Handle(surface) => fingerprint(surface),
            Self::Arrays(vertices, faces) => fingerprint_of(vertices.view(), faces.view()),
        }
    }

    pub fn n_vertices(&self) -> usize {
        match self {
            Self::Handle(surface) => surface.n_vertices(),
            Self::Arrays(vertices, _) => vertices.nrows(),
        }
    }

    /// The surface; arrays are checked, not copied.
    pub fn surface(self) -> Result<authalic::Surface, Error> {
        match self {
            Self::Handle(surface) => Ok(surface),
            Self::Arrays(vertices, faces) => authalic::Surface::new(vertices, faces),
        }
    }

    /// The repaired surface.
    pub fn repaired(self, options: &RepairOptions) -> Result<authalic::Repaired, Error> {
        match self {
            Self::Handle(surface) => authalic::repair(surface.vertices(), surface.faces(), options),
            Self::Arrays(vertices, faces) => authalic::repair(vertices, faces, options),
        }
    }
}

fn missing(py: Python<'_>, name: &'static str, expected: &str) -> PyErr {
    bad_array(py, name, "missing".into(), expected.into())
}

fn too_many() -> PyErr {
    PyTypeError::new_err("faces go with vertices; a Surface has its own")
}

/// The oriented faces of a surface that has been mapped.
pub fn oriented(surface: &authalic::Surface) -> Array2<u32> {
    surface.oriented_faces().expect("a surface that was mapped is orientable")
}

/// The surface behind a Surface, or an object that has one: a Patch or a Repaired.
pub fn handle(object: &Bound<'_, PyAny>) -> Option<authalic::Surface> {
    if let Ok(surface) = object.cast::<Surface>() {
        return Some(surface.get().handle.clone());
    }
    let inner = object.getattr_opt(intern!(object.py(), "surface")).ok()??;
    Some(inner.cast::<Surface>().ok()?.get().handle.clone())
}
