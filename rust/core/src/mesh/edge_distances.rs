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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_those_of_shortest_paths_up_to_the_limit() {
        // a strip of two rows of squares' corners, 1 apart, with diagonals
        let points: Vec<Vector3> =
            (0..10).map(|k| Vector3([f64::from(k / 2), f64::from(k % 2), 0.0])).collect();
        let faces: Vec<[Vertex; 3]> = (0..4u32)
            .flat_map(|k| [[2 * k, 2 * k + 2, 2 * k + 3], [2 * k, 2 * k + 3, 2 * k + 1]])
            .map(|face| face.map(Vertex))
            .collect();
        let corners = VertexCorners::new(points.len(), &faces);
        let from = |sources: &[u32], most: f64| {
            edge_distances(&points, &faces, &corners, sources.iter().map(|&v| Vertex(v)), most)
        };
        let root = 2f64.sqrt();
        let along = from(&[0], f64::INFINITY);
        for k in 0..5 {
            let k_f = k as f64;
            assert!((along[2 * k] - k_f).abs() < 1e-12);
            let above = if k == 0 { 1.0 } else { k_f - 1.0 + root };
            assert!((along[2 * k + 1] - above).abs() < 1e-12);
        }
        let near = from(&[0, 8], 1.0);
        assert_eq!([near[0], near[2], near[6], near[8]], [0.0, 1.0, 1.0, 0.0]);
        assert!(near[4].is_infinite() && near[3].is_infinite());
    }
}
