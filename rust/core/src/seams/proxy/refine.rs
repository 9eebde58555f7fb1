// SPDX-License-Identifier: MIT OR Apache-2.0
//! The uniform refinement of a mesh: every face is split into four at the midpoints of its edges.

use crate::error::Error;
use crate::mesh::{EdgeTable, Face, TriangleMesh, Vertex};

/// A mesh whose faces are split into four.
#[derive(Debug)]
pub(super) struct Refined {
    /// The mesh at the same points, followed by the midpoints. Face 4 f + k is the part of face f at its corner k, and
    /// face 4 f + 3 the middle one.
    pub mesh: TriangleMesh,
    /// (k, 2): the ends of the edge that each midpoint halves, the lower first, in ascending order.
    pub parents: Vec<[Vertex; 2]>,
}

/// Splits every face into four. Cost: linear.
///
/// # Errors
/// Faces that are too small for their parts to have an area.
pub(super) fn refine(mesh: &TriangleMesh) -> Result<Refined, Error> {
    let mut middles = vec![Vertex::default(); 3 * mesh.n_faces()];
    let mut points = mesh.points().to_vec();
    let mut parents = Vec::new();
    for (edge, corners) in EdgeTable::new(mesh.n_vertices(), mesh.faces()).edges() {
        let [a, b] = edge.map(|end| mesh.points()[end]);
        corners.iter().for_each(|corner| middles[corner.corner()] = Vertex::new(points.len()));
        points.push((a + b) * 0.5);
        parents.push(edge);
    }
    let parts = |(number, &[a, b, c]): (Face, &[Vertex; 3])| {
        let [bc, ca, ab] = number.corners().map(|corner| middles[corner]);
        [[a, ab, ca], [ab, b, bc], [ca, bc, c], [bc, ca, ab]]
    };
    let faces = Face::all(mesh.n_faces()).zip(mesh.faces()).flat_map(parts).collect();
    Ok(Refined { mesh: TriangleMesh::at_given_points(points, faces)?, parents })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seams::sample_surfaces::{perforated_cylinder, plate_with_three_holes, topology};

    #[test]
    fn parts_have_a_quarter_of_the_area_and_the_topology_stays() {
        for mesh in [plate_with_three_holes(), perforated_cylinder()] {
            let refined = refine(&mesh).unwrap();
            assert_eq!(topology(&refined.mesh), topology(&mesh));
            assert_eq!(refined.mesh.n_faces(), 4 * mesh.n_faces());
            assert!(refined.mesh.flipped_faces().is_empty());
            for (part, area) in refined.mesh.face_areas().iter().enumerate() {
                assert!(
                    (4.0 * area
                        - crate::mesh::geometry::area(mesh.faces()[part / 4].map(|v| mesh.points()[v])))
                    .abs()
                        < 1e-15
                );
            }
            assert_eq!(refined.mesh.points()[..mesh.n_vertices()], *mesh.points());
            for (&[a, b], middle) in refined.parents.iter().zip(&refined.mesh.points()[mesh.n_vertices()..]) {
                assert_eq!((mesh.points()[a] + mesh.points()[b]) * 0.5, *middle);
            }
        }
    }
}
