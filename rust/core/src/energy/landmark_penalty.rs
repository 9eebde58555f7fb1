// SPDX-License-Identifier: MIT OR Apache-2.0
//! The penalty on landmarks away from their places, λ Σ |x_i − q_i|².
//!
//! Liu & Yueh (2023), section 6; Sutti & Yueh (2024), section 6.6. The Hessian omits indefinite terms, which arise on
//! the sphere for a landmark more than a quarter turn away from its place.

use super::authalic::{AuthalicEnergy, Element};
use crate::codomain::motion::Frame;
use crate::mesh::{Corner, Vertex};
use crate::vector::Vector3;

/// Landmark vertices with the places where they should lie.
#[derive(Debug, Clone, Default)]
pub(crate) struct LandmarkPenalty {
    /// λ.
    pub weight: f64,
    vertices: Vec<Vertex>,
    places: Vec<Vector3>,
    /// One corner of each landmark, to which its Hessian is added, with the landmark's number; ascending.
    corners: Vec<(Corner, usize)>,
}

impl LandmarkPenalty {
    /// The penalty on `vertices` away from `places`, for maps of the energy's surface.
    pub(crate) fn new(
        energy: &AuthalicEnergy,
        vertices: Vec<Vertex>,
        places: Vec<Vector3>,
        weight: f64,
    ) -> Self {
        let corner = |(landmark, &vertex): (usize, &Vertex)| (energy.vertex_corners(vertex)[0], landmark);
        let mut corners: Vec<(Corner, usize)> = vertices.iter().enumerate().map(corner).collect();
        corners.sort_unstable();
        Self { weight, vertices, places, corners }
    }

    /// The landmark vertices.
    pub(crate) fn vertices(&self) -> &[Vertex] {
        &self.vertices
    }

    /// The distance of each landmark from its place.
    pub(crate) fn gaps(&self, map: &[Vector3]) -> Vec<f64> {
        let gap = |(&vertex, &place): (&Vertex, &Vector3)| map[vertex].distance(place);
        self.vertices.iter().zip(&self.places).map(gap).collect()
    }

    /// λ Σ |x_i − q_i|².
    pub(crate) fn value(&self, map: &[Vector3]) -> f64 {
        self.weight * self.gaps(map).iter().map(|gap| gap * gap).sum::<f64>()
    }

    /// Adds the gradient by the unknowns of every vertex.
    pub(crate) fn add_gradient(&self, map: &[Vector3], frames: &[Frame], gradient: &mut [[f64; 2]]) {
        for (&vertex, &place) in self.vertices.iter().zip(&self.places) {
            let pull = (map[vertex] - place) * (2.0 * self.weight);
            let slopes = frames[vertex].axes.map(|axis| pull.dot(axis));
            gradient[vertex] = [gradient[vertex][0] + slopes[0], gradient[vertex][1] + slopes[1]];
        }
    }

    /// Adds the Hessian of the landmarks at corners of a face to its element.
    pub(crate) fn add_element(&self, map: &[Vector3], frames: &[Frame], face: usize, element: &mut Element) {
        let first = self.corners.partition_point(|(corner, _)| corner.face().index() < face);
        let here = self.corners[first..].iter().take_while(|(corner, _)| corner.face().index() == face);
        for &(corner, landmark) in here {
            let (k, vertex) = (corner.place(), self.vertices[landmark]);
            let away = map[vertex] - self.places[landmark];
            let bend = 1.0 - away.dot(frames[vertex].outward);
            let curvature = 2.0 * self.weight * bend.max(0.0);
            (0..2).for_each(|axis| element[2 * k + axis][2 * k + axis] += curvature);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::codomain::Codomain;
    use crate::codomain::motion::{Motion, frames};
    use crate::mesh::TriangleMesh;

    #[test]
    fn derivatives_are_the_differences_of_the_value() {
        let corners = [[1., 1., 1.], [1., -1., -1.], [-1., 1., -1.], [-1., -1., 1.]];
        let mesh = TriangleMesh::new(&corners, &[[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]]).unwrap();
        let energy = AuthalicEnergy::new(&mesh, vec![1.0; 4], Codomain::Sphere, 0.0);
        let map: Vec<Vector3> = corners.iter().map(|&x| Vector3(x).normalized()).collect();
        let place = Vector3([0.6, 0.8, 0.0]);
        let penalty = LandmarkPenalty::new(&energy, [2, 0].map(Vertex).to_vec(), vec![map[2], place], 0.7);
        assert!((penalty.value(&map) - 0.7 * map[0].distance(place).powi(2)).abs() < 1e-15);
        let motions = [Motion::Sphere; 4];
        let frames = frames(&motions, &map);
        let at = |step: f64, axis: usize| {
            let mut moved = map.clone();
            let unknowns = std::array::from_fn(|k| if k == axis { step } else { 0.0 });
            moved[0] = Motion::Sphere.moved(map[0], &frames[0], unknowns);
            penalty.value(&moved)
        };
        let mut gradient = vec![[0.0; 2]; 4];
        penalty.add_gradient(&map, &frames, &mut gradient);
        let mut element = [[0.0; 6]; 6];
        (0..4).for_each(|face| penalty.add_element(&map, &frames, face, &mut element));
        for axis in 0..2 {
            let (there, here, back) = (at(1e-4, axis), at(0.0, axis), at(-1e-4, axis));
            assert!((gradient[0][axis] - (there - back) / 2e-4).abs() < 1e-7);
            // both landmarks are the first or the third corner of face 0; the one in place adds 2 λ
            assert!((element[axis][axis] - (there + back - 2.0 * here) / 1e-8).abs() < 1e-5);
            assert!((element[4 + axis][4 + axis] - 1.4).abs() < 1e-12);
        }
    }
}
