// SPDX-License-Identifier: MIT OR Apache-2.0
//! A mesh renumbered in elimination order.
//!
//! In this order neighbors in space are neighbors in memory: every pass over the faces of a large mesh runs several
//! times faster, and no later system has to be ordered again.

use super::corners::VertexCorners;
use super::triangle_mesh::mark_boundary;
use super::{Corner, Face, TriangleMesh, Vertex};
use crate::parallel;

/// A renumbered mesh with its given numbers.
#[derive(Debug)]
pub(crate) struct Renumbered {
    pub mesh: TriangleMesh,
    /// The given vertex of each vertex, (n,).
    pub vertices: Vec<Vertex>,
    /// The given face of each face, (m,).
    pub faces: Vec<Face>,
}

impl Renumbered {
    /// Renumbers `mesh` so that `vertices[k]` becomes vertex k; faces are sorted by their lowest vertex, corners and
    /// boundary loops keep their beginnings.
    pub(crate) fn new(mesh: &TriangleMesh, vertices: Vec<Vertex>) -> Self {
        let place = inverse(&vertices);
        let lowest = |face: usize| mesh.faces[face].map(|vertex| place[vertex]).into_iter().min();
        let keys = parallel::map(mesh.n_faces(), |face| (lowest(face).unwrap_or_default(), Face::new(face)));
        let mut order = keys;
        order.sort_unstable();
        let faces: Vec<Face> = order.into_iter().map(|(_, face)| face).collect();
        let mesh = renumbered(mesh, &vertices, &place, &faces);
        Self { mesh, vertices, faces }
    }

    /// Values in the order of the given vertices.
    pub(crate) fn given<T: Copy + Default>(&self, values: &[T]) -> Vec<T> {
        let mut out = vec![T::default(); values.len()];
        self.vertices.iter().zip(values).for_each(|(&vertex, &value)| out[vertex] = value);
        out
    }

    /// Values in the order of the renumbered vertices.
    pub(crate) fn of_vertices<T: Copy>(&self, values: &[T]) -> Vec<T> {
        self.vertices.iter().map(|&vertex| values[vertex]).collect()
    }

    /// The given index of a renumbered face.
    pub(crate) fn given_face(&self, face: usize) -> usize {
        self.faces[face].index()
    }

    /// Values in the order of the renumbered faces.
    pub(crate) fn of_faces<T: Copy>(&self, values: &[T]) -> Vec<T> {
        self.faces.iter().map(|&face| values[face]).collect()
    }
}

fn renumbered(mesh: &TriangleMesh, vertices: &[Vertex], place: &[Vertex], faces: &[Face]) -> TriangleMesh {
    let mut new_face = vec![Face::default(); faces.len()];
    faces.iter().zip(Face::all(faces.len())).for_each(|(&given, new)| new_face[given] = new);
    let corner = |corner: Corner| new_face[corner.face()].corner(corner.place());
    let new_faces = parallel::map(faces.len(), |face| mesh.faces[faces[face]].map(|v| place[v]));
    let mut topology = mesh.topology.clone();
    topology.boundary_loops.iter_mut().flatten().for_each(|vertex| *vertex = place[*vertex]);
    topology.first_faces.iter_mut().for_each(|face| *face = new_face[*face]);
    TriangleMesh {
        points: vertices.iter().map(|&vertex| mesh.points[vertex]).collect(),
        scale: mesh.scale,
        flipped: mesh.flipped.iter().map(|&face| new_face[face]).collect(),
        areas: parallel::map(faces.len(), |face| mesh.areas[faces[face]]),
        opposite: parallel::map(3 * faces.len(), |k| mesh.opposite[faces[k / 3].corner(k % 3)].map(corner)),
        corners: VertexCorners::new(vertices.len(), &new_faces),
        on_boundary: mark_boundary(vertices.len(), &topology.boundary_loops),
        in_elimination_order: true,
        faces: new_faces,
        topology,
    }
}

fn inverse(order: &[Vertex]) -> Vec<Vertex> {
    let mut place = vec![Vertex::default(); order.len()];
    order.iter().zip(Vertex::all(order.len())).for_each(|(&vertex, number)| place[vertex] = number);
    place
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_renumbered_mesh_is_the_mesh_of_the_renumbered_arrays() {
        let vertices = [[0., 0., 1.], [1., 0., 0.], [0., 1., 0.], [-1., 0., 0.], [0., -1., 0.]];
        let mesh = TriangleMesh::new(&vertices, &[[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]]).unwrap();
        let order = [3, 0, 4, 2, 1].map(Vertex).to_vec();
        let renumbered = Renumbered::new(&mesh, order.clone());
        let direct = TriangleMesh::new(&renumbered.of_vertices(&vertices), renumbered.mesh.faces()).unwrap();
        assert_eq!(renumbered.mesh.opposite, direct.opposite);
        assert_eq!(renumbered.mesh.on_boundary, direct.on_boundary);
        assert_eq!(renumbered.mesh.areas, direct.areas);
        assert_eq!(renumbered.given(&renumbered.of_vertices(&vertices)), vertices);
        let there = renumbered.mesh.boundary_loops()[0].iter().map(|&v| order[v]);
        assert_eq!(there.collect::<Vec<_>>(), mesh.boundary_loops()[0]);
        for vertex in Vertex::all(5) {
            assert_eq!(renumbered.mesh.vertex_corners(vertex), direct.vertex_corners(vertex));
        }
    }
}
