// SPDX-License-Identifier: MIT OR Apache-2.0
//! The surface handle of callers: arrays checked once, with all that is derived from them.

use std::sync::{Arc, OnceLock};

use ndarray::{Array2, ArrayView2, CowArray, Ix2};

use super::indices::index_array;
use super::soup::TriangleSoup;
use super::{Topology, TriangleMesh, Vertex, validate};
use crate::arrays::{from_rows, row_major, rows, rows_of};
use crate::error::Error;
use crate::vector::Vector3;

/// Triangles in space: checked once, then mapped, measured and cut without a further check or copy.
///
/// The arrays are checked when the surface is made. Whether it is an oriented manifold is checked by the first function
/// that needs one, and the answer is kept. Clones share all of it.
///
/// ```
/// use authalic::Surface;
/// use ndarray::array;
///
/// let square = Surface::new(
///     array![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
///     array![[0, 1, 2], [0, 2, 3]],
/// )?;
/// assert!(square.topology()?.is_disk());
/// assert_eq!(square.cut(array![[0, 2]])?.len(), 2);
/// # Ok::<(), authalic::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Surface(Arc<Parts>);

#[derive(Debug)]
struct Parts {
    vertices: Array2<f64>,
    faces: Vec<[Vertex; 3]>,
    mesh: OnceLock<Result<TriangleMesh, Error>>,
    soup: OnceLock<Result<TriangleSoup, Error>>,
}

impl Surface {
    /// A surface of `vertices` (n, 3), not copied where they are owned, and `faces` (m, 3), vertex indices.
    ///
    /// # Errors
    /// Arrays of another shape or empty, coordinates that are not finite, indices out of range, faces that repeat a
    /// vertex; each with the elements at fault.
    pub fn new<'a>(
        vertices: impl Into<CowArray<'a, f64, Ix2>>,
        faces: impl Into<CowArray<'a, u32, Ix2>>,
    ) -> Result<Self, Error> {
        let vertices = row_major::<3, _>("vertices", vertices.into())?;
        let faces = faces.into();
        let faces = rows_of("faces", faces.view())?.iter().map(|face| face.map(Vertex)).collect::<Vec<_>>();
        validate::arrays(rows(vertices.view()), &faces)?;
        Ok(Self::of_checked(vertices, faces))
    }

    /// A surface of rows that have passed [`validate::arrays`].
    pub(crate) fn of_checked_rows(vertices: Vec<[f64; 3]>, faces: Vec<[Vertex; 3]>) -> Self {
        Self::of_checked(from_rows(vertices), faces)
    }

    fn of_checked(vertices: Array2<f64>, faces: Vec<[Vertex; 3]>) -> Self {
        Self(Arc::new(Parts { vertices, faces, mesh: OnceLock::new(), soup: OnceLock::new() }))
    }

    /// The vertices as given, (n, 3).
    pub fn vertices(&self) -> ArrayView2<'_, f64> {
        self.0.vertices.view()
    }

    /// The faces as given, (m, 3).
    pub fn faces(&self) -> Array2<u32> {
        index_array(self.face_rows())
    }

    /// The faces oriented like most of their component, (m, 3), as maps have them.
    ///
    /// # Errors
    /// As [`Self::topology`].
    pub fn oriented_faces(&self) -> Result<Array2<u32>, Error> {
        self.mesh().map(|mesh| index_array(mesh.faces()))
    }

    /// The number of vertices.
    pub fn n_vertices(&self) -> usize {
        self.0.vertices.nrows()
    }

    /// The number of faces.
    pub fn n_faces(&self) -> usize {
        self.0.faces.len()
    }

    /// The topology of the surface.
    ///
    /// # Errors
    /// Surfaces that are no manifold or cannot be oriented: duplicate faces, faces without area, edges of three or more
    /// faces, vertices in which parts only touch, and vertices without a face.
    pub fn topology(&self) -> Result<&Topology, Error> {
        self.mesh().map(TriangleMesh::topology)
    }

    /// The surface as an oriented manifold.
    ///
    /// # Errors
    /// As [`Self::topology`].
    pub(crate) fn mesh(&self) -> Result<&TriangleMesh, Error> {
        let mesh =
            self.0.mesh.get_or_init(|| TriangleMesh::of_checked(self.vertex_rows(), self.0.faces.clone()));
        mesh.as_ref().map_err(Clone::clone)
    }

    /// The triangles for figures that do not need a manifold; those of the mesh if it is there already.
    ///
    /// # Errors
    /// Faces without area.
    pub(crate) fn triangles(&self) -> Result<Triangles<'_>, Error> {
        if let Some(Ok(mesh)) = self.0.mesh.get() {
            return Ok(Triangles { points: mesh.points(), faces: mesh.faces(), areas: mesh.face_areas() });
        }
        let soup = self.0.soup.get_or_init(|| TriangleSoup::of_checked(self.vertex_rows(), self.face_rows()));
        let soup = soup.as_ref().map_err(Clone::clone)?;
        Ok(Triangles { points: &soup.points, faces: &soup.faces, areas: &soup.areas })
    }

    /// The surface of a mesh in its own coordinates.
    #[cfg(test)]
    pub(crate) fn of_mesh(mesh: &TriangleMesh) -> Self {
        Self::of_checked_rows(crate::vector::coordinates(mesh.points().to_vec()), mesh.faces().to_vec())
    }

    pub(crate) fn vertex_rows(&self) -> &[[f64; 3]] {
        rows(self.vertices())
    }

    pub(crate) fn face_rows(&self) -> &[[Vertex; 3]] {
        &self.0.faces
    }
}

/// Surfaces are equal where their arrays are.
impl PartialEq for Surface {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
            || (self.0.vertices == other.0.vertices && self.0.faces == other.0.faces)
    }
}

/// Triangles with an area, each component oriented consistently.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Triangles<'a> {
    /// The vertices, centered on their bounding box and scaled to a unit diagonal, (n, 3).
    pub points: &'a [Vector3],
    /// The faces, (m, 3), oriented like most of their component.
    pub faces: &'a [[Vertex; 3]],
    /// Their areas, (m,).
    pub areas: &'a [f64],
}

#[cfg(test)]
mod tests {
    use ndarray::{ShapeBuilder, array, aview2};

    use super::*;
    use crate::error::MeshError;

    const SQUARE: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    const HALVES: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

    fn square() -> Surface {
        Surface::new(aview2(&SQUARE), aview2(&HALVES)).unwrap()
    }

    #[test]
    fn what_follows_from_a_surface_is_computed_once_and_shared_by_its_clones() {
        let surface = square();
        assert!(surface.0.mesh.get().is_none(), "nothing before it is asked for");
        let mesh: *const TriangleMesh = surface.mesh().unwrap();
        assert!(std::ptr::eq(surface.clone().mesh().unwrap(), mesh));
        assert!(std::ptr::eq(surface.triangles().unwrap().points, surface.mesh().unwrap().points()));
        assert!(surface.0.soup.get().is_none(), "the figures take the triangles of the mesh");
    }

    #[test]
    fn patches_are_meshes_from_the_cut_on() {
        let patches = square().cut(array![[0, 2]]).unwrap();
        assert!(patches.iter().all(|patch| patch.surface.0.mesh.get().is_some_and(Result::is_ok)));
    }

    #[test]
    fn a_refusal_is_kept_too() {
        let folded = Surface::new(aview2(&SQUARE), array![[0, 1, 2], [1, 2, 0], [0, 2, 3]]).unwrap();
        assert!(matches!(folded.mesh(), Err(Error::Mesh(MeshError::DuplicateFaces { .. }))));
        assert!(matches!(folded.0.mesh.get(), Some(Err(Error::Mesh(MeshError::DuplicateFaces { .. })))));
        assert!(folded.triangles().is_ok(), "figures do not need a manifold");
    }

    #[test]
    fn owned_arrays_are_taken_over_and_other_layouts_copied() {
        let vertices = aview2(&SQUARE).to_owned();
        let address = vertices.as_ptr();
        let surface = Surface::new(vertices, aview2(&HALVES)).unwrap();
        assert_eq!(surface.vertices().as_ptr(), address);
        let columns = Array2::from_shape_fn((4, 3).f(), |(v, k)| SQUARE[v][k]);
        let surface = Surface::new(columns.view(), aview2(&HALVES)).unwrap();
        assert_eq!(surface.vertex_rows(), SQUARE);
    }

    #[test]
    fn arrays_of_another_shape_are_refused() {
        let refused = Surface::new(Array2::zeros((4, 2)), aview2(&HALVES));
        assert!(matches!(refused, Err(Error::InvalidArray { name: "vertices", .. })));
    }
}
