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

use super::corners::{EdgeTable, NO_CORNER, VertexCorners, next_corner, previous_corner, vertex_at};
use super::orientation::Orientation;
use super::topology::Topology;
use super::{geometry, validate};
use crate::error::{Elements, Error, MeshError};

/// One piece of a cut mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Patch {
    /// The vertices, (n, 3), in the order of the input vertices they are copies of.
    pub vertices: Vec<[f64; 3]>,
    /// The faces, (m, 3), in the order, winding and corner order of the input.
    pub faces: Vec<[u32; 3]>,
    /// The input vertex of each vertex, (n,), ascending.
    pub vertex_of: Vec<u32>,
    /// The input corner (3 × face + corner) of each corner, (m, 3).
    pub corner_of: Vec<[u32; 3]>,
    /// What kind of surface the patch is. Its loops have the numbers of the patch.
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

/// Cuts `vertices` (n, 3) and `faces` (m, 3) along `seams` (k, 2), each the two ends of an edge.
///
/// Returns the patches in the order of their lowest faces. Without seams these are the components.
///
/// ```
/// use authalic::mesh::cut;
///
/// let vertices = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
/// let patches = cut(&vertices, &[[0, 1, 2], [0, 2, 3]], &[[0, 2]])?;
/// assert_eq!(patches.len(), 2);
/// assert_eq!(patches[1].vertex_of, [0, 2, 3]);
/// assert_eq!(patches[1].corner_of, [[3, 4, 5]]);
/// # Ok::<(), authalic::Error>(())
/// ```
///
/// # Errors
/// Empty arrays, coordinates that are not finite, indices out of range, faces that repeat a vertex, and
/// seams that are out of range or no edge of the mesh.
pub fn cut(vertices: &[[f64; 3]], faces: &[[u32; 3]], seams: &[[u32; 2]]) -> Result<Vec<Patch>, Error> {
    // 1. The arrays.
    validate::arrays(vertices, faces)?;
    check_range(vertices.len(), seams)?;
    // 2. Which faces are neighbours.
    let table = EdgeTable::new(vertices.len(), faces);
    let mut opposite = table.opposites();
    open_seams(&table, seams, &mut opposite)?;
    drop(table);
    // 3. Which corners are one vertex, and which faces one patch.
    let joined = join_corners(faces, &opposite);
    let islands = Orientation::propagate(faces, &opposite);
    // 4. The patches.
    let mut patches = vec![Patch::empty(); islands.first_faces.len()];
    let numbers = number_vertices(vertices, faces, joined, &islands.component, &mut patches);
    collect_faces(numbers, &islands.component, &mut patches);
    for patch in &mut patches {
        let (points, _) = geometry::normalized(&patch.vertices);
        patch.topology = Topology::of_faces(&points, &patch.faces);
    }
    Ok(patches)
}

impl Patch {
    fn empty() -> Self {
        let topology = Topology {
            euler_characteristic: 0,
            genus: Some(0),
            orientable: true,
            boundary_loops: Vec::new(),
            first_faces: Vec::new(),
        };
        Self {
            vertices: Vec::new(),
            faces: Vec::new(),
            vertex_of: Vec::new(),
            corner_of: Vec::new(),
            topology,
        }
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
    patches: &mut [Patch],
) -> Vec<u32> {
    const UNNUMBERED: u32 = u32::MAX;
    let corners = VertexCorners::new(vertices.len(), faces);
    let mut numbers = vec![UNNUMBERED; 3 * faces.len()];
    for (v, &position) in vertices.iter().enumerate() {
        for &corner in corners.of(v) {
            let root = joined.root(corner) as usize;
            if numbers[root] == UNNUMBERED {
                let patch = &mut patches[patch_of[corner as usize / 3] as usize];
                numbers[root] = patch.vertices.len() as u32;
                patch.vertices.push(position);
                patch.vertex_of.push(v as u32);
            }
            numbers[corner as usize] = numbers[root];
        }
    }
    numbers
}

fn collect_faces(numbers: Vec<u32>, patch_of: &[u32], patches: &mut [Patch]) {
    for (face, (corners, &patch)) in numbers.as_chunks::<3>().0.iter().zip(patch_of).enumerate() {
        let patch = &mut patches[patch as usize];
        patch.faces.push(*corners);
        patch.corner_of.push([0, 1, 2].map(|k| 3 * face as u32 + k));
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
