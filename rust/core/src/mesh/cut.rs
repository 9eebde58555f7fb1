// SPDX-License-Identifier: MIT OR Apache-2.0
//! Cutting a mesh along seams into patches (islands), with maps back to the input.
//!
//! Corners of neighboring faces become one vertex if the faces share an edge that is no seam.
//! - Edges of three or more faces act as seams, and parts that touch only in a vertex come apart: a patch
//!   is always a manifold.
//! - Two faces of opposite winding stay together; the winding of the input is kept.
//! - A seam that does not separate still opens the surface: a path of two or more edges makes a sphere a
//!   disk, a loop makes a torus an annulus. A single edge between two vertices without other seams opens
//!   nothing, because both sides keep both of its ends.
//! - Faces without area, duplicate faces and loose vertices are accepted; loose vertices are in no patch.
//!
//! The cost is linear in the mesh, up to the union-find of its corners.

use ndarray::{Array2, CowArray, Ix2};

use super::corners::{EdgeTable, VertexCorners};
use super::fans::fans;
use super::orientation::Orientation;
use super::topology::Topology;
use super::{Corner, Face, Surface, Vertex, geometry, validate};
use crate::arrays::{from_rows, rows_of};
use crate::error::{Elements, Error, MeshError};
use crate::sets::Sets;

/// A connected part of a cut surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Patch {
    /// The part by itself. Its vertices are copies of vertices of the cut surface, in their order; its faces keep the
    /// order, winding and corner order of those of the cut surface.
    pub surface: Surface,
    /// The vertex of the cut surface of which each vertex is a copy, (n,), ascending.
    pub vertex_of: Vec<Vertex>,
    /// The corner of the cut surface (3 × face + corner) that each corner was, (m, 3).
    pub corner_of: Array2<u32>,
    /// The topology of the patch, even if it has faces without area or duplicates.
    pub topology: Topology,
}

impl Patch {
    /// Whether the patch is a topological disk.
    pub fn is_disk(&self) -> bool {
        self.topology.is_disk()
    }

    /// Whether the patch has no boundary.
    pub fn is_closed(&self) -> bool {
        self.topology.is_closed()
    }
}

impl Surface {
    /// Cuts the surface along `seams` (k, 2), each the two ends of an edge, into patches in the order of their lowest
    /// faces. Without seams these are the connected components.
    ///
    /// # Errors
    /// Seams that are out of range, or no edges of the surface.
    pub fn cut<'a>(&self, seams: impl Into<CowArray<'a, u32, Ix2>>) -> Result<Vec<Patch>, Error> {
        let seams = seams.into();
        let seams: Vec<_> = rows_of("seams", seams.view())?.iter().map(|seam| seam.map(Vertex)).collect();
        along(self, &seams)
    }
}

/// The patches of a surface cut along edges.
fn along(surface: &Surface, seams: &[[Vertex; 2]]) -> Result<Vec<Patch>, Error> {
    let (vertices, faces) = (surface.vertex_rows(), surface.face_rows());
    // 1. The seams.
    check_range(vertices.len(), seams)?;
    // 2. The neighbors of each face.
    let table = EdgeTable::new(vertices.len(), faces);
    let mut opposite = table.opposites();
    open_seams(&table, seams, &mut opposite)?;
    drop(table);
    // 3. The corners of each vertex, and the faces of each patch.
    let joined = fans(faces, &opposite);
    let components = Orientation::propagate(faces, &opposite);
    drop(opposite);
    // 4. The patches.
    let mut drafts = vec![Draft::default(); components.first_faces.len()];
    let numbers = number_vertices(vertices, faces, joined, &components.component, &mut drafts);
    collect_faces(numbers, &components.component, &mut drafts);
    Ok(drafts.into_iter().map(Draft::into_patch).collect())
}

/// A patch while it is being collected.
#[derive(Default, Clone)]
struct Draft {
    vertices: Vec<[f64; 3]>,
    faces: Vec<[Vertex; 3]>,
    vertex_of: Vec<Vertex>,
    corner_of: Vec<[u32; 3]>,
}

impl Draft {
    fn into_patch(self) -> Patch {
        let Self { vertices, faces, vertex_of, corner_of } = self;
        let surface = Surface::of_checked_rows(vertices, faces);
        let topology = surface.topology().cloned().unwrap_or_else(|_| {
            // functions that need a manifold refuse faces without area and duplicates themselves
            let (points, _) = geometry::normalized(surface.vertex_rows());
            Topology::of_faces(&points, surface.face_rows())
        });
        Patch { surface, vertex_of, corner_of: from_rows(corner_of), topology }
    }
}

fn check_range(n_vertices: usize, seams: &[[Vertex; 2]]) -> Result<(), MeshError> {
    let outside = seams.iter().copied().filter(|seam| seam.iter().any(|&v| v.index() >= n_vertices));
    validate::refuse(Elements::edges(outside), |seams| MeshError::SeamOutOfRange { seams, n_vertices })
}

/// Disconnects the faces on both sides of the seams.
fn open_seams(
    table: &EdgeTable,
    seams: &[[Vertex; 2]],
    opposite: &mut [Option<Corner>],
) -> Result<(), MeshError> {
    let mut unknown = Vec::new();
    for &seam in seams {
        let mut corners = table.corners(seam).peekable();
        if corners.peek().is_none() {
            unknown.push(seam);
        }
        corners.for_each(|corner| opposite[corner] = None);
    }
    validate::refuse(Elements::edges(unknown), |seams| MeshError::SeamNotEdge { seams })
}

/// Numbers the joined corners within their patches by (input vertex, first corner); returns their numbers.
fn number_vertices(
    vertices: &[[f64; 3]],
    faces: &[[Vertex; 3]],
    mut joined: Sets,
    patch_of: &[u32],
    drafts: &mut [Draft],
) -> Vec<Vertex> {
    const UNNUMBERED: Vertex = Vertex(u32::MAX);
    let corners = VertexCorners::new(vertices.len(), faces);
    let mut numbers = vec![UNNUMBERED; 3 * faces.len()];
    for (v, &position) in Vertex::all(vertices.len()).zip(vertices) {
        for &corner in corners.of(v) {
            let root = joined.root(corner.index());
            if numbers[root] == UNNUMBERED {
                let draft = &mut drafts[patch_of[corner.face()] as usize];
                numbers[root] = Vertex::new(draft.vertices.len());
                draft.vertices.push(position);
                draft.vertex_of.push(v);
            }
            numbers[corner] = numbers[root];
        }
    }
    numbers
}

fn collect_faces(numbers: Vec<Vertex>, patch_of: &[u32], drafts: &mut [Draft]) {
    for face in Face::all(patch_of.len()) {
        let draft = &mut drafts[patch_of[face] as usize];
        draft.faces.push(face.corners().map(|corner| numbers[corner]));
        draft.corner_of.push(face.corners().map(|corner| corner.index() as u32));
    }
}
