// SPDX-License-Identifier: MIT OR Apache-2.0
//! The vertices of one mesh nearest to those of another that lies near it.
//!
//! The banks of an open seam lie at the same place. So that each vertex finds one of its own bank, boundary vertices of
//! both meshes first move inward a little.

use crate::location::NearestPoint;
use crate::mesh::{TriangleMesh, Vertex};
use crate::vector::Vector3;

/// How far boundary vertices move, in median edges of the finer mesh.
const INSET: f64 = 0.05;

/// The vertex of `to` nearest to each vertex of `from`. Cost: O(n log² n).
pub(in crate::seams) fn nearest_vertices(from: &TriangleMesh, to: &TriangleMesh) -> Vec<Vertex> {
    let inset = INSET * from.median_edge_length().min(to.median_edge_length());
    NearestPoint::new(&inset_points(to, inset)).of_all(&inset_points(from, inset))
}

/// The points of a mesh, those of its boundary moved towards the mean of their neighbors.
fn inset_points(mesh: &TriangleMesh, by: f64) -> Vec<Vector3> {
    let mut points = mesh.points().to_vec();
    for &vertex in mesh.boundary_loops().iter().flatten() {
        let point = mesh.points()[vertex];
        let corners = mesh.vertex_corners(vertex).iter();
        let ends = corners.flat_map(|corner| corner.half_edge(mesh.faces()));
        let inward: Vector3 = ends.map(|end| mesh.points()[end] - point).sum();
        if inward.norm() > 0.0 {
            points[vertex] = point + inward.normalized() * by;
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::faces_of_indices;

    #[test]
    fn the_banks_of_a_seam_are_told_apart() {
        // rows of four vertices, the two in the middle at one place; in the last two rows they are one
        let n = 8;
        let row = |j: u32| {
            let columns: &[f64] = if j + 1 < n { &[-1.0, 0.0, 0.0, 1.0] } else { &[-1.0, 0.0, 1.0] };
            columns.iter().map(move |&x| Vector3([x, f64::from(j), 0.0]))
        };
        let points: Vec<Vector3> = (0..=n).flat_map(row).collect();
        let vertex = |column: u32, j: u32| match j.checked_sub(n - 1) {
            None => 4 * j + column,
            Some(above) => 4 * (n - 1) + 3 * above + column - u32::from(column > 1),
        };
        let quad = |column: u32, j: u32| {
            let [a, b] = [vertex(column, j), vertex(column + 1, j)];
            let [c, d] = [vertex(column + 1, j + 1), vertex(column, j + 1)];
            [[a, b, c], [a, c, d]]
        };
        let faces: Vec<[u32; 3]> = (0..n).flat_map(|j| [quad(0, j), quad(2, j)]).flatten().collect();
        let slit = TriangleMesh::at_given_points(points, faces_of_indices(&faces)).unwrap();
        slit.require_disk().unwrap();
        let nearest = nearest_vertices(&slit, &slit);
        assert!(nearest.into_iter().eq(Vertex::all(slit.n_vertices())));
    }
}
