// SPDX-License-Identifier: MIT OR Apache-2.0
//! Longest-edge bisection: splits faces at the midpoints of edges so that no vertex hangs on an edge (Rivara 1984).
//!
//! 1. When an edge is split, so are the longest edges of its faces, and so on from these.
//! 2. A face with split edges is halved at its longest edge first; then each half at the edge that it keeps of the
//!    face, if that is split.
//!
//! Every half has half the area. Lengths may be measured in any map of the mesh. Cost: linear.

use super::{Face, TriangleMesh, Vertex};

/// A mesh with some faces split. Vertices keep their numbers, and midpoints follow them.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Bisection {
    /// (k, 2): the ends of the edge that each new vertex halves.
    pub parents: Vec<[Vertex; 2]>,
    /// (m', 3): the faces, oriented as before.
    pub faces: Vec<[Vertex; 3]>,
    /// (m',): the original face of each face, ascending.
    pub face_of: Vec<Face>,
    /// (m',): the original face's area over that of the face: 1, 2 or 4.
    pub parts: Vec<u8>,
}

/// Splits the longest edges of `marked` faces (m,), and the edges that follow; `length` is that of the edge between two
/// vertices, and must not depend on their order.
pub(crate) fn bisect_longest_edges(
    mesh: &TriangleMesh,
    marked: &[bool],
    length: impl Fn(Vertex, Vertex) -> f64,
) -> Bisection {
    let longest: Vec<usize> = mesh.faces().iter().map(|&face| across_longest_edge(face, &length)).collect();
    let midpoints = Midpoints::new(mesh, marked, &longest);
    let mut split = Bisection {
        parents: midpoints.parents.clone(),
        faces: Vec::with_capacity(mesh.n_faces()),
        face_of: Vec::with_capacity(mesh.n_faces()),
        parts: Vec::with_capacity(mesh.n_faces()),
    };
    for (number, &face) in Face::all(mesh.n_faces()).zip(mesh.faces()) {
        // the longest edge is bc
        let apex = longest[number];
        let [a, b, c] = [0, 1, 2].map(|k| face[(apex + k) % 3]);
        let [bc, ca, ab] = [0, 1, 2].map(|k| midpoints.of_corner[number.corner((apex + k) % 3)]);
        let mut push = |corners: [Vertex; 3], parts: u8| {
            split.faces.push(corners);
            split.face_of.push(number);
            split.parts.push(parts);
        };
        let Some(middle) = bc else {
            push(face, 1);
            continue;
        };
        match ab {
            None => push([a, b, middle], 2),
            Some(midpoint) => [[a, midpoint, middle], [midpoint, b, middle]]
                .into_iter()
                .for_each(|quarter| push(quarter, 4)),
        }
        match ca {
            None => push([a, middle, c], 2),
            Some(midpoint) => [[a, middle, midpoint], [midpoint, middle, c]]
                .into_iter()
                .for_each(|quarter| push(quarter, 4)),
        }
    }
    split
}

/// The corner of a face across its longest edge.
fn across_longest_edge(face: [Vertex; 3], length: &impl Fn(Vertex, Vertex) -> f64) -> usize {
    let lengths = [0, 1, 2].map(|k| length(face[(k + 1) % 3], face[(k + 2) % 3]));
    (1..3).fold(0, |most, k| if lengths[k] > lengths[most] { k } else { most })
}

/// The midpoints of split edges.
struct Midpoints {
    /// (k, 2): the ends of the edges.
    parents: Vec<[Vertex; 2]>,
    /// (3 m,): the new vertex on the edge across each corner.
    of_corner: Vec<Option<Vertex>>,
}

impl Midpoints {
    fn new(mesh: &TriangleMesh, marked: &[bool], longest: &[usize]) -> Self {
        let mut midpoints = Self { parents: Vec::new(), of_corner: vec![None; 3 * mesh.n_faces()] };
        let mut waiting: Vec<Face> = Face::all(mesh.n_faces()).filter(|&face| marked[face]).collect();
        waiting.reverse();
        while let Some(face) = waiting.pop() {
            let corner = face.corner(longest[face]);
            if midpoints.of_corner[corner].is_some() {
                continue;
            }
            let middle = Vertex::new(mesh.n_vertices() + midpoints.parents.len());
            let ends = [1, 2].map(|k| mesh.faces()[face][(longest[face] + k) % 3]);
            midpoints.parents.push(ends);
            midpoints.of_corner[corner] = Some(middle);
            if let Some(across) = mesh.opposite(corner) {
                midpoints.of_corner[across] = Some(middle);
                // the face beyond is halved at its own longest edge first
                waiting.push(across.face());
            }
        }
        midpoints
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::geometry::{area, triangle};
    use crate::vector::coordinates;

    /// A bent grid of squares, each of two triangles.
    fn grid(n: u32) -> TriangleMesh {
        let vertex = |i: u32, j: u32| i * (n + 1) + j;
        let place = |k: u32| (f64::from(k / (n + 1)), f64::from(k % (n + 1)));
        let points: Vec<[f64; 3]> = (0..(n + 1) * (n + 1))
            .map(place)
            .map(|(x, y)| [x + 0.2 * (2.0 * y).sin(), y, 0.3 * (x * y).cos()])
            .collect();
        let squares = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
        let faces: Vec<[u32; 3]> = squares
            .flat_map(|(i, j)| {
                [
                    [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)],
                    [vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)],
                ]
            })
            .collect();
        TriangleMesh::new(&points, &faces).unwrap()
    }

    #[test]
    fn parts_fill_their_faces_and_no_vertex_hangs() {
        let mesh = grid(8);
        let marked: Vec<bool> = (0..mesh.n_faces()).map(|face| face % 7 == 3).collect();
        let points = mesh.points();
        let split = bisect_longest_edges(&mesh, &marked, |a, b| points[a].distance(points[b]));
        // 1. Every marked face is split, and some follow
        for (face, _) in marked.iter().enumerate().filter(|(_, is_marked)| **is_marked) {
            assert!(split.face_of.iter().filter(|of| of.index() == face).count() > 1);
        }
        assert!(split.face_of.windows(2).all(|pair| pair[0] <= pair[1]));
        // 2. The parts have the area of their face, each its share
        let mut all = points.to_vec();
        for [a, b] in &split.parents {
            let [a, b] = [all[*a], all[*b]];
            all.push((a + b) * 0.5);
        }
        let mut sums = vec![0.0; mesh.n_faces()];
        for ((&part, &face), &parts) in split.faces.iter().zip(&split.face_of).zip(&split.parts) {
            let (size, whole) = (area(triangle(&all, part)), mesh.face_areas()[face]);
            assert!((size - whole / f64::from(parts)).abs() < 1e-12 * whole.max(1.0));
            sums[face] += size;
        }
        assert!(sums.iter().zip(mesh.face_areas()).all(|(sum, whole)| (sum - whole).abs() < 1e-12));
        // 3. Still one disk: a vertex on an edge would open a hole
        let refined = TriangleMesh::new(&coordinates(all), &split.faces).unwrap();
        refined.require_disk().unwrap();
        assert!(refined.flipped_faces().is_empty());
    }

    #[test]
    fn nothing_is_split_without_marks() {
        let mesh = grid(2);
        let split = bisect_longest_edges(&mesh, &vec![false; mesh.n_faces()], |_, _| 1.0);
        assert_eq!((split.faces.as_slice(), split.parents.len()), (mesh.faces(), 0));
    }
}
