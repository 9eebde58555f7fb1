// SPDX-License-Identifier: MIT OR Apache-2.0
//! The maps of a coarse mesh's islands carried to those of a finer one.
//!
//! 1. An island belongs to that coarse one to which most of its faces are nearest.
//! 2. A face away from the island's boundary has the nearest face of the coarse island for a model. On the way to the
//!    boundary, where the banks of seams are near to each other, each face takes the model of the one before.
//! 3. The map of the model, continued to the face, which is turned into its plane, gives the face's image.
//!
//! The images do not fit together exactly: they are the start of a map. Cost: O(n log n).

use std::cmp::Reverse;
use std::collections::VecDeque;

use super::edge_mesh::EdgeMesh;
use super::maps::IslandMap;
use crate::location::NearestPoint;
use crate::mesh::geometry::{area_vector, triangle};
use crate::mesh::{Face, TriangleMesh};
use crate::parallel;
use crate::vector::Vector3;

/// Faces within this many edges of the coarse mesh from an island's boundary have no models of their own.
const BANK: f64 = 1.0;

/// Faces whose squared sine of an angle is less are no models.
const FLAT: f64 = 1e-12;

/// The wanted images of an island's faces.
pub(super) type Shapes = Vec<[[f64; 2]; 3]>;

/// Maps of the islands of a coarse mesh.
pub(super) struct Carrier<'a> {
    coarse: &'a EdgeMesh,
    islands: &'a [IslandMap],
    /// The centers of the coarse faces, and the island of each.
    centers: Vec<Vector3>,
    island_of: Vec<usize>,
}

impl<'a> Carrier<'a> {
    pub(super) fn new(coarse: &'a EdgeMesh, islands: &'a [IslandMap]) -> Self {
        let mut island_of = vec![0; coarse.n_faces()];
        for (number, island) in islands.iter().enumerate() {
            island.face_of.iter().for_each(|&face| island_of[face] = number);
        }
        let centers = Face::all(coarse.n_faces()).map(|face| coarse.mesh.center(face)).collect();
        Self { coarse, islands, centers, island_of }
    }

    /// The wanted images of the faces of an island of a finer mesh.
    pub(super) fn shapes(&self, fine: &EdgeMesh, island: &IslandMap) -> Shapes {
        // 1. The coarse island
        let own_centers: Vec<_> = island.face_of.iter().map(|&face| fine.mesh.center(face)).collect();
        let nearest = NearestPoint::new(&self.centers).of_all(&own_centers);
        let mut counts = vec![0; self.islands.len()];
        nearest.iter().for_each(|face| counts[self.island_of[face.index()]] += 1);
        let most = (0..counts.len()).max_by_key(|&k| (counts[k], Reverse(k)));
        let model = &self.islands[most.unwrap_or_default()];
        // 2. The models
        let model_centers: Vec<_> = model.face_of.iter().map(|&face| self.centers[face]).collect();
        let search = NearestPoint::new(&model_centers);
        let n_rings = 2.0 * BANK * self.coarse.mesh.median_edge_length() / fine.mesh.median_edge_length();
        let inner = faces_within(&island.mesh, n_rings.ceil() as usize);
        let models = models(&island.mesh, &inner, |face| search.of(own_centers[face]).index());
        // 3. The images
        parallel::map(island.face_of.len(), |face| {
            let corners = triangle(fine.mesh.points(), fine.mesh.faces()[island.face_of[face]]);
            self.image(corners, model, models[face])
        })
    }

    /// The image of a triangle under the map of a face of a coarse island.
    fn image(&self, [a, b, c]: [Vector3; 3], model: &IslandMap, face: usize) -> [[f64; 2]; 3] {
        let corners = triangle(self.coarse.mesh.points(), self.coarse.mesh.faces()[model.face_of[face]]);
        let image = model.mesh.faces()[face].map(|vertex| model.uv[vertex]);
        let [normal, model_normal] = [[a, b, c], corners].map(|of| area_vector(of).normalized());
        let [p, q] = [corners[1] - corners[0], corners[2] - corners[0]];
        let [pp, pq, qq] = [p.dot(p), p.dot(q), q.dot(q)];
        let determinant = pp * qq - pq * pq;
        let is_sound = determinant > FLAT * pp * qq;
        let mapped = |edge: Vector3| {
            let edge = turned(edge, normal, model_normal);
            let [ep, eq] = [edge.dot(p), edge.dot(q)];
            // a face of almost no area is no model
            let [s, t] =
                [qq * ep - pq * eq, pp * eq - pq * ep].map(|x| if is_sound { x / determinant } else { 0.0 });
            [0, 1].map(|k| s * (image[1][k] - image[0][k]) + t * (image[2][k] - image[0][k]))
        };
        [[0.0; 2], mapped(b - a), mapped(c - a)]
    }
}

/// A vector turned by the least rotation that takes one unit vector to another.
fn turned(vector: Vector3, from: Vector3, to: Vector3) -> Vector3 {
    let (axis, cosine) = (from.cross(to), from.dot(to));
    if cosine <= -1.0 + 1e-6 {
        return vector;
    }
    vector * cosine + axis.cross(vector) + axis * (axis.dot(vector) / (1.0 + cosine))
}

/// Whether each face is more than so many steps across edges from the boundary; all faces where none is.
fn faces_within(mesh: &TriangleMesh, n_rings: usize) -> Vec<bool> {
    let touches = |face: Face| mesh.faces()[face].iter().any(|&vertex| mesh.is_boundary(vertex));
    let mut depth: Vec<Option<usize>> =
        Face::all(mesh.n_faces()).map(|face| touches(face).then_some(0)).collect();
    let mut queue: VecDeque<Face> = Face::all(mesh.n_faces()).filter(|&face| depth[face].is_some()).collect();
    while let Some(face) = queue.pop_front() {
        for next in mesh.neighbors(face) {
            if depth[next].is_none() {
                depth[next] = depth[face].map(|depth| depth + 1);
                queue.push_back(next);
            }
        }
    }
    let is_within: Vec<bool> = depth.iter().map(|depth| depth.is_none_or(|depth| depth >= n_rings)).collect();
    if is_within.contains(&true) { is_within } else { vec![true; mesh.n_faces()] }
}

/// The model of each face: its own where `is_inner`, else that of the inner face from which it is reached first.
fn models(mesh: &TriangleMesh, is_inner: &[bool], own: impl Fn(usize) -> usize + Sync + Send) -> Vec<usize> {
    let mut models =
        parallel::map(mesh.n_faces(), |face| if is_inner[face] { Some(own(face)) } else { None });
    let mut queue: VecDeque<Face> = Face::all(mesh.n_faces()).filter(|&face| is_inner[face]).collect();
    while let Some(face) = queue.pop_front() {
        for next in mesh.neighbors(face) {
            if models[next].is_none() {
                models[next] = models[face];
                queue.push_back(next);
            }
        }
    }
    models.into_iter().map(Option::unwrap_or_default).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::Silent;
    use crate::seams::cut::Cut;
    use crate::seams::maps::{self, Outlines};
    use crate::seams::sample_surfaces::perforated_cylinder;

    #[test]
    fn a_mesh_has_its_own_faces_for_models_and_images_of_their_shapes() {
        let mesh = EdgeMesh::new(perforated_cylinder());
        let mut islands = maps::islands(&mesh, &Cut::none(&mesh)).unwrap();
        maps::map_all(&mut islands, Outlines::MayCross, &mut Silent).unwrap();
        let island = &islands[0];
        let all = vec![true; island.face_of.len()];
        assert_eq!(models(&island.mesh, &all, |face| face), (0..all.len()).collect::<Vec<_>>());
        let shapes = Carrier::new(&mesh, &islands).shapes(&mesh, island);
        let inner = faces_within(&island.mesh, 2);
        assert!(inner.contains(&true) && inner.contains(&false));
        for (face, shape) in shapes.iter().enumerate().filter(|&(face, _)| inner[face]) {
            let [a, b, c] = island.mesh.faces()[face].map(|vertex| island.uv[vertex]);
            for (corner, image) in [b, c].iter().zip(&shape[1..]) {
                let error = [0, 1].map(|k| corner[k] - a[k] - image[k]);
                assert!(error[0].hypot(error[1]) < 1e-9, "face {face}: {error:?}");
            }
        }
    }

    #[test]
    fn the_least_rotation_takes_one_vector_to_the_other() {
        let [from, to] = [[1.0, 2.0, -0.5], [0.3, -1.0, 0.8]].map(|x| Vector3(x).normalized());
        assert!(turned(from, from, to).distance(to) < 1e-12);
        let axis = from.cross(to);
        assert!(turned(axis, from, to).distance(axis) < 1e-12);
    }
}
