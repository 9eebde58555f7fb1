// SPDX-License-Identifier: MIT OR Apache-2.0
//! Groups of triangles that make up polygons, which a layout does not cut.

use std::collections::VecDeque;

use crate::mesh::{Corner, Face, Vertex};

/// The polygon of each face, and the edges along which faces of one polygon meet.
pub(super) struct Polygons {
    /// (m,): the polygon of each face, numbered in the order of their first faces.
    pub of: Vec<usize>,
    /// The number of polygons.
    pub count: usize,
    /// Diagonals that join the faces of each polygon to its first face, outwards from there.
    pub joints: Vec<Diagonal>,
    /// All other diagonals.
    pub loops: Vec<Diagonal>,
}

/// An edge between two triangles of a polygon, by the corners at its two ends.
#[derive(Debug, Clone, Copy)]
pub(super) struct Diagonal {
    /// The ends as corners of the first triangle.
    pub here: [Corner; 2],
    /// The ends, in the same order, as corners of the second triangle.
    pub there: [Corner; 2],
}

impl Polygons {
    /// Groups faces with the same label that share an edge; without labels each face is a polygon.
    pub fn new(faces: &[[Vertex; 3]], labels: Option<&[usize]>) -> Self {
        match labels {
            Some(labels) => Self::joined(faces.len(), &diagonals(faces, labels)),
            None => Self::joined(faces.len(), &[]),
        }
    }

    /// Walks from the first face of each polygon over its diagonals.
    fn joined(n_faces: usize, diagonals: &[Diagonal]) -> Self {
        let of_face = diagonals_of_faces(n_faces, diagonals);
        let mut polygons =
            Self { of: vec![usize::MAX; n_faces], count: 0, joints: Vec::new(), loops: Vec::new() };
        let mut is_joint = vec![false; diagonals.len()];
        let mut border = VecDeque::new();
        for first in Face::all(n_faces) {
            if polygons.of[first] != usize::MAX {
                continue;
            }
            let polygon = polygons.count;
            polygons.of[first] = polygon;
            polygons.count += 1;
            border.push_back(first);
            while let Some(face) = border.pop_front() {
                for &index in of_face.get(face.index()).map_or(&[][..], Vec::as_slice) {
                    let diagonal = diagonals[index].seen_from(face);
                    let next = diagonal.there[0].face();
                    if polygons.of[next] == usize::MAX {
                        polygons.of[next] = polygon;
                        polygons.joints.push(diagonal);
                        is_joint[index] = true;
                        border.push_back(next);
                    }
                }
            }
        }
        let rest = diagonals.iter().zip(&is_joint).filter(|(_, joins)| !**joins);
        polygons.loops = rest.map(|(&diagonal, _)| diagonal).collect();
        polygons
    }
}

impl Diagonal {
    /// The diagonal that begins at these corners of its triangles.
    fn new(faces: &[[Vertex; 3]], here: Corner, there: Corner) -> Self {
        let is_aligned = here.vertex(faces) == there.vertex(faces);
        let (here, there) = ([here, here.next()], [there, there.next()]);
        Self { here, there: if is_aligned { there } else { [there[1], there[0]] } }
    }

    /// The diagonal with its other end first.
    pub fn reversed(self) -> Self {
        let [a, b] = self.here;
        let [c, d] = self.there;
        Self { here: [b, a], there: [d, c] }
    }

    /// The diagonal with `face` as its first triangle.
    fn seen_from(self, face: Face) -> Self {
        if self.here[0].face() == face { self } else { Self { here: self.there, there: self.here } }
    }
}

/// Every edge between two faces with the same label.
fn diagonals(faces: &[[Vertex; 3]], labels: &[usize]) -> Vec<Diagonal> {
    // 1. Collect the edges of faces whose label occurs several times.
    let mut sorted = labels.to_vec();
    sorted.sort_unstable();
    let repeats: Vec<usize> =
        sorted.windows(2).filter(|pair| pair[0] == pair[1]).map(|pair| pair[0]).collect();
    let mut edges = Vec::new();
    for (face, label) in Face::all(faces.len()).zip(labels) {
        if repeats.binary_search(label).is_ok() {
            edges.extend(face.corners().map(|corner| {
                let (a, b) = (corner.vertex(faces), corner.next().vertex(faces));
                (*label, a.min(b), a.max(b), corner)
            }));
        }
    }
    // 2. Join each two edges with the same label and ends to a diagonal.
    edges.sort_unstable();
    let pairs = edges.chunk_by(|a, b| (a.0, a.1, a.2) == (b.0, b.1, b.2));
    pairs.filter_map(|pair| Some(Diagonal::new(faces, pair.first()?.3, pair.get(1)?.3))).collect()
}

/// The diagonals at each face, empty where there are none at all.
fn diagonals_of_faces(n_faces: usize, diagonals: &[Diagonal]) -> Vec<Vec<usize>> {
    let mut of_face = vec![Vec::new(); if diagonals.is_empty() { 0 } else { n_faces }];
    for (index, diagonal) in diagonals.iter().enumerate() {
        of_face[diagonal.here[0].face()].push(index);
        of_face[diagonal.there[0].face()].push(index);
    }
    of_face
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::faces_of_indices;

    /// A fan of four triangles around vertex 0.
    fn fan() -> Vec<[Vertex; 3]> {
        faces_of_indices(&[[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]])
    }

    #[test]
    fn faces_with_one_label_are_joined_where_they_meet() {
        let polygons = Polygons::new(&fan(), Some(&[7, 7, 3, 5]));
        assert_eq!((polygons.of.as_slice(), polygons.count), (&[0, 0, 1, 2][..], 3));
        let [joint] = polygons.joints[..] else { panic!("one diagonal") };
        assert_eq!(joint.here.map(|c| c.vertex(&fan())), joint.there.map(|c| c.vertex(&fan())));
        assert!(polygons.loops.is_empty());
    }

    #[test]
    fn faces_with_one_label_that_do_not_meet_are_polygons_of_their_own() {
        let polygons = Polygons::new(&fan(), Some(&[7, 3, 7, 5]));
        assert_eq!(polygons.of, [0, 1, 2, 3]);
    }

    #[test]
    fn a_ring_has_one_edge_more_than_a_tree() {
        let polygons = Polygons::new(&fan(), Some(&[1; 4]));
        assert_eq!((polygons.count, polygons.joints.len(), polygons.loops.len()), (1, 3, 1));
    }
}
