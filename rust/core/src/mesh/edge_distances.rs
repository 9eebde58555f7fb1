// SPDX-License-Identifier: MIT OR Apache-2.0
//! Distances along the edges of a mesh (E. W. Dijkstra, A note on two problems in connexion with graphs, Numerische
//! Mathematik 1, 1959). They are those on the surface, too long by up to a tenth or two.
//!
//! Cost: O(n log n) with the vertices that are reached.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::corners::VertexCorners;
use super::indices::Vertex;
use crate::vector::Vector3;

/// The distance of each vertex from the nearest of some vertices, (n,); infinite beyond `most`.
pub(crate) fn edge_distances(
    points: &[Vector3],
    faces: &[[Vertex; 3]],
    corners: &VertexCorners,
    sources: impl IntoIterator<Item = Vertex>,
    most: f64,
) -> Vec<f64> {
    let mut distances = vec![f64::INFINITY; points.len()];
    // the bits of positive numbers are ordered as the numbers are
    let mut queue = BinaryHeap::new();
    for source in sources {
        distances[source] = 0.0;
        queue.push(Reverse((0.0_f64.to_bits(), source)));
    }
    while let Some(Reverse((bits, vertex))) = queue.pop() {
        let reached = f64::from_bits(bits);
        if reached > distances[vertex] {
            continue;
        }
        for &corner in corners.of(vertex) {
            for neighbor in faces[corner.face()] {
                let through = reached + points[vertex].distance(points[neighbor]);
                if through < distances[neighbor] && through <= most {
                    distances[neighbor] = through;
                    queue.push(Reverse((through.to_bits(), neighbor)));
                }
            }
        }
    }
    distances
}
