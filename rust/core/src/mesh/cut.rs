// SPDX-License-Identifier: MIT OR Apache-2.0
//! Cutting a mesh along seams into patches (islands), with maps back to the input.
//!
//! Corners of neighbouring faces become one vertex wherever the faces meet in an edge that is no seam.
//! - Edges of three or more faces act as seams, and parts that only touch in a vertex come apart: a patch
//!   is always a manifold.
//! - Two faces of opposite winding stay together; the winding of the input is kept.
//! - A seam that does not separate still opens the surface: a sphere along a path of two or more edges
//!   becomes a disk, a torus along a loop an annulus. A single edge between two vertices that are otherwise
//!   whole opens nothing, because both sides keep both of its ends.
//! - Faces without area, duplicate faces and loose vertices are accepted; loose vertices are in no patch.
//!
//! The cost is linear in the mesh, up to the union-find of its corners.

use ndarray::{CowArray, Ix2};

use super::corners::{EdgeTable, NO_CORNER, VertexCorners, next_corner, previous_corner, vertex_at};
use super::orientation::Orientation;
use super::topology::Topology;
use super::{Surface, geometry, validate};
use crate::arrays::{row_major, rows};
use crate::error::{Elements, Error, MeshError};

/// One piece of a cut surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Patch {
    /// The piece by itself. Its vertices are copies of vertices of the surface that was cut, in their order; its faces
    /// have the order, winding and corner order of those.
    pub surface: Surface,
    /// The vertex of the cut surface that each vertex is a copy of, (n,), ascending.
    pub vertex_of: Vec<u32>,
    /// The corner of the cut surface (3 × face + corner) that each corner was, (m, 3).
    pub corner_of: Vec<[u32; 3]>,
    /// What kind of surface the patch is, also where it has faces without area or duplicates.
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
    /// Seams that are out of range or no edge of the surface.
    pub fn cut<'a>(&self, seams: impl Into<CowArray<'a, u32, Ix2>>) -> Result<Vec<Patch>, Error> {
        let seams = row_major::<2, _>("seams", seams.into())?;
        along(self, rows(&seams))
    }
}

/// The patches of a surface cut along edges.
fn along(surface: &Surface, seams: &[[u32; 2]]) -> Result<Vec<Patch>, Error> {
    let (vertices, faces) = (surface.vertex_rows(), surface.face_rows());
    // 1. The seams.
    check_range(vertices.len(), seams)?;
    // 2. Which faces are neighbors.
    let table = EdgeTable::new(vertices.len(), faces);
    let mut opposite = table.opposites();
    open_seams(&table, seams, &mut opposite)?;
    drop(table);
    // 3. Which corners are one vertex, and which faces one patch.
    let joined = join_corners(faces, &opposite);
    let islands = Orientation::propagate(faces, &opposite);
    drop(opposite);
    // 4. The patches.
    let mut pieces = vec![Piece::default(); islands.first_faces.len()];
    let numbers = number_vertices(vertices, faces, joined, &islands.component, &mut pieces);
    collect_faces(numbers, &islands.component, &mut pieces);
    Ok(pieces.into_iter().map(Piece::into_patch).collect())
}

/// A patch while it is being collected.
#[derive(Default, Clone)]
struct Piece {
    vertices: Vec<[f64; 3]>,
    faces: Vec<[u32; 3]>,
    vertex_of: Vec<u32>,
    corner_of: Vec<[u32; 3]>,
}

impl Piece {
    fn into_patch(self) -> Patch {
        let Self { vertices, faces, vertex_of, corner_of } = self;
        let surface = Surface::of_checked_rows(vertices, faces);
        let topology = surface.topology().cloned().unwrap_or_else(|_| {
            // faces without area or duplicates are for the functions that cannot do with them to refuse
            let (points, _) = geometry::normalized(surface.vertex_rows());
            Topology::of_faces(&points, surface.face_rows())
        });
        Patch { surface, vertex_of, corner_of, topology }
    }
}

fn check_range(n_vertices: usize, seams: &[[u32; 2]]) -> Result<(), MeshError> {
    let outside = seams.iter().copied().filter(|seam| seam.iter().any(|&v| v as usize >= n_vertices));
    validate::refuse(Elements::edges(outside), |seams| MeshError::SeamOutOfRange { seams, n_vertices })
}

/// Makes the faces along the seams strangers to each other.
fn open_seams(table: &EdgeTable, seams: &[[u32; 2]], opposite: &mut [u32]) -> Result<(), MeshError> {
    let mut unknown = Vec::new();
    for &seam in seams {
        let mut corners = table.corners(seam).peekable();
        if corners.peek().is_none() {
            unknown.push(seam);
        }
        corners.for_each(|corner| opposite[corner as usize] = NO_CORNER);
    }
    validate::refuse(Elements::edges(unknown), |seams| MeshError::SeamNotEdge { seams })
}

/// Joins the corners at both ends of every edge between neighbours.
fn join_corners(faces: &[[u32; 3]], opposite: &[u32]) -> UnionFind {
    let mut joined = UnionFind::new(opposite.len());
    for corner in 0..opposite.len() as u32 {
        let other = opposite[corner as usize];
        // Each pair once; the missing partner is the largest number of all.
        if other == NO_CORNER || other < corner {
            continue;
        }
        let [mut first, mut second] = [next_corner(other), previous_corner(other)];
        if vertex_at(faces, next_corner(corner)) != vertex_at(faces, first) {
            [first, second] = [second, first];
        }
        joined.join(next_corner(corner), first);
        joined.join(previous_corner(corner), second);
    }
    joined
}

/// Numbers the joined corners within their patches by (input vertex, first corner); returns their numbers.
fn number_vertices(
    vertices: &[[f64; 3]],
    faces: &[[u32; 3]],
    mut joined: UnionFind,
    patch_of: &[u32],
    pieces: &mut [Piece],
) -> Vec<u32> {
    const UNNUMBERED: u32 = u32::MAX;
    let corners = VertexCorners::new(vertices.len(), faces);
    let mut numbers = vec![UNNUMBERED; 3 * faces.len()];
    for (v, &position) in vertices.iter().enumerate() {
        for &corner in corners.of(v) {
            let root = joined.root(corner) as usize;
            if numbers[root] == UNNUMBERED {
                let piece = &mut pieces[patch_of[corner as usize / 3] as usize];
                numbers[root] = piece.vertices.len() as u32;
                piece.vertices.push(position);
                piece.vertex_of.push(v as u32);
            }
            numbers[corner as usize] = numbers[root];
        }
    }
    numbers
}

fn collect_faces(numbers: Vec<u32>, patch_of: &[u32], pieces: &mut [Piece]) {
    for (face, (corners, &patch)) in numbers.as_chunks::<3>().0.iter().zip(patch_of).enumerate() {
        let piece = &mut pieces[patch as usize];
        piece.faces.push(*corners);
        piece.corner_of.push([0, 1, 2].map(|k| 3 * face as u32 + k));
    }
}

/// Disjoint sets of numbers; the root of a set is its smallest member.
struct UnionFind {
    parent: Vec<u32>,
}

impl UnionFind {
    fn new(n: usize) -> Self {
        Self { parent: (0..n as u32).collect() }
    }

    fn root(&mut self, mut item: u32) -> u32 {
        while self.parent[item as usize] != item {
            let grandparent = self.parent[self.parent[item as usize] as usize];
            self.parent[item as usize] = grandparent;
            item = grandparent;
        }
        item
    }

    fn join(&mut self, a: u32, b: u32) {
        let [a, b] = [self.root(a), self.root(b)];
        self.parent[a.max(b) as usize] = a.min(b);
    }
}
