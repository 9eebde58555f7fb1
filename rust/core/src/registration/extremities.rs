// SPDX-License-Identifier: MIT OR Apache-2.0
//! Extremities that two surfaces have in common: the tips of legs, ears and tails.
//!
//! With few landmarks a map that starts without them takes the tip of a leg to its middle, and stays there: a minimum
//! of the energy between the surfaces, but not a low one. An extremity is farther from the rest of its surface on
//! average than what lies around it (E. Zhang, K. Mischaikow, G. Turk, Feature-based surface parameterization and
//! texture mapping, ACM Transactions on Graphics 24, 2005). Two belong together where either is the most like the
//! other by their distances from the landmarks. What these have in common does not count: a leg may be longer.
//!
//! Cost: O(n log n) for each of some seventy vertices and each landmark.

use std::cmp::Reverse;

use super::landmarks::Landmarks;
use crate::mesh::{TriangleMesh, Vertex};
use crate::parallel;

/// How far an extremity stands out, and how far it is from landmarks at least, in units of the root of the area.
const AROUND: f64 = 0.12;

/// The mean distance at an extremity, as a multiple of the least on the surface, is at least this.
const STANDS_OUT: f64 = 1.3;

/// Vertices far from each other that stand for all in mean distances.
const SAMPLES: usize = 64;

/// Distances from fewer landmarks do not tell one extremity from another.
const FEWEST_LANDMARKS: usize = 3;

/// The landmarks of source and target, and after them the pairs of extremities that are like each other and far from
/// all landmarks; `None` where there are none.
pub(super) fn with_extremities(
    meshes: [&TriangleMesh; 2],
    landmarks: &Landmarks<'_>,
) -> Option<[Vec<usize>; 2]> {
    if landmarks.source.len() < FEWEST_LANDMARKS {
        return None;
    }
    let of = |side: usize| extremities(meshes[side], [landmarks.source, landmarks.target][side]);
    let (ours, theirs) = parallel::join(|| of(0), || of(1));
    let mut with = [landmarks.source.to_vec(), landmarks.target.to_vec()];
    for (k, extremity) in ours.iter().enumerate() {
        let Some(j) = extremity.most_like(&theirs) else { break };
        let partner = &theirs[j];
        if partner.most_like(&ours) == Some(k) && extremity.is_far() && partner.is_far() {
            with[0].push(extremity.vertex.index());
            with[1].push(partner.vertex.index());
        }
    }
    (with[0].len() > landmarks.source.len()).then_some(with)
}

/// A tip of a surface.
struct Extremity {
    vertex: Vertex,
    /// Its distances from the landmarks, in units of the root of the area.
    distances: Vec<f64>,
}

impl Extremity {
    fn is_far(&self) -> bool {
        self.distances.iter().all(|&distance| distance > AROUND)
    }

    /// The most like of others, the first of equals.
    fn most_like(&self, others: &[Self]) -> Option<usize> {
        let unlikeness: Vec<f64> = others.iter().map(|other| self.unlikeness(other)).collect();
        (0..others.len()).min_by(|&i, &j| unlikeness[i].total_cmp(&unlikeness[j]))
    }

    /// The variance of the differences of the distances from the landmarks.
    fn unlikeness(&self, other: &Self) -> f64 {
        let differences = || self.distances.iter().zip(&other.distances).map(|(a, b)| a - b);
        let n = self.distances.len() as f64;
        let mean = differences().sum::<f64>() / n;
        differences().map(|difference| (difference - mean).powi(2)).sum::<f64>() / n
    }
}

/// The extremities of a surface.
fn extremities(mesh: &TriangleMesh, landmarks: &[usize]) -> Vec<Extremity> {
    let unit = mesh.face_areas().iter().sum::<f64>().sqrt();
    let from = |vertex: Vertex, most: f64| mesh.distances_along_edges([vertex], most);
    // 1. Mean distances
    let from_landmarks: Vec<Vec<f64>> =
        parallel::tasks(landmarks.len(), |k| from(Vertex::new(landmarks[k]), f64::INFINITY));
    let mean = mean_distances(mesh, &from_landmarks[0]);
    let least = mean.iter().copied().fold(f64::INFINITY, f64::min);
    // 2. Large, and larger than around, first in the ring
    let ring =
        |vertex: Vertex| mesh.vertex_corners(vertex).iter().flat_map(|corner| mesh.faces()[corner.face()]);
    let around = |vertex: Vertex| {
        let distances = from(vertex, AROUND * unit);
        Vertex::all(distances.len()).filter(move |&other| distances[other].is_finite())
    };
    let peaks = Vertex::all(mesh.n_vertices())
        .filter(|&vertex| mean[vertex] > STANDS_OUT * least && !mesh.is_boundary(vertex))
        .filter(|&vertex| is_largest(&mean, vertex, ring(vertex)))
        .filter(|&vertex| is_largest(&mean, vertex, around(vertex)));
    // 3. Their distances from the landmarks
    let distances = |vertex: Vertex| from_landmarks.iter().map(|from| from[vertex] / unit).collect();
    peaks.map(|vertex| Extremity { vertex, distances: distances(vertex) }).collect()
}

/// Whether the value at a vertex is the largest among others; of equal ones that of the lowest vertex is.
fn is_largest(values: &[f64], vertex: Vertex, others: impl IntoIterator<Item = Vertex>) -> bool {
    let order = |vertex: Vertex| (values[vertex], Reverse(vertex));
    others.into_iter().all(|other| order(other) <= order(vertex))
}

/// The mean distance of each vertex from vertices far from each other, the first far from those at small `distances`.
fn mean_distances(mesh: &TriangleMesh, distances: &[f64]) -> Vec<f64> {
    let mut nearest = distances.to_vec();
    let mut sums = vec![0.0; nearest.len()];
    for _ in 0..SAMPLES {
        let farthest = Vertex::all(nearest.len())
            .reduce(|best, vertex| if nearest[vertex] > nearest[best] { vertex } else { best })
            .expect("meshes have vertices");
        let distances = mesh.distances_along_edges([farthest], f64::INFINITY);
        for (vertex, distance) in distances.into_iter().enumerate() {
            sums[vertex] += distance;
            nearest[vertex] = nearest[vertex].min(distance);
        }
    }
    sums.iter().map(|sum| sum / SAMPLES as f64).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::location::tests::octasphere;
    use crate::vector::Vector3;

    const ARMS: [[f64; 3]; 4] = [[1., 1., 1.], [1., -1., -1.], [-1., 1., -1.], [-1., -1., 1.]];

    /// Vertices of the octahedron that a ball is made of; each is nearest to two arms, and no two arms to the same.
    const BETWEEN: [usize; 4] = [0, 2, 3, 4];

    /// A ball with arms of some lengths along four diagonals of a cube.
    fn with_arms(lengths: [f64; 4]) -> TriangleMesh {
        let (points, faces) = octasphere(4);
        let pulled = |&point: &Vector3| {
            let pull = |(&arm, &length): (&[f64; 3], &f64)| {
                let arm = Vector3(arm).normalized();
                arm * (length * f64::exp(-12.0 * point.distance(arm).powi(2)))
            };
            ARMS.iter().zip(&lengths).map(pull).fold(point, |sum, pull| sum + pull).0
        };
        let vertices: Vec<[f64; 3]> = points.iter().map(pulled).collect();
        TriangleMesh::new(&vertices, &faces).unwrap()
    }

    /// The arms at whose tips some vertices of the ball lie, up to an edge.
    fn arms(vertices: &[usize]) -> Vec<usize> {
        let (points, _) = octasphere(4);
        let arm = |&vertex: &usize| {
            let is_tip = |k: &usize| points[vertex].distance(Vector3(ARMS[*k]).normalized()) < 0.15;
            (0..4).find(is_tip).expect("extremities are tips")
        };
        vertices.iter().map(arm).collect()
    }

    fn found(source: &TriangleMesh, target: &TriangleMesh) -> [Vec<usize>; 2] {
        let landmarks = Landmarks { source: &BETWEEN, target: &BETWEEN };
        let with = with_extremities([source, target], &landmarks).unwrap();
        with.map(|vertices| {
            assert_eq!(vertices[..4], BETWEEN);
            arms(&vertices[4..])
        })
    }

    #[test]
    fn arms_of_other_lengths_are_pairs() {
        let [source, target] = found(&with_arms([2.0, 2.0, 1.5, 2.0]), &with_arms([3.0, 1.5, 2.5, 2.0]));
        assert_eq!(source, target);
        assert!((0..4).all(|arm| source.contains(&arm)) && source.len() == 4);
    }

    #[test]
    fn an_arm_of_one_surface_alone_has_no_partner() {
        let [source, target] = found(&with_arms([2.0; 4]), &with_arms([2.0, 0.0, 2.0, 2.0]));
        assert_eq!(source, target);
        assert!([0, 2, 3].iter().all(|arm| source.contains(arm)) && source.len() == 3);
    }

    #[test]
    fn a_ball_has_none_nor_have_tips_that_are_landmarks() {
        let ball = with_arms([0.0; 4]);
        let landmarks = Landmarks { source: &BETWEEN, target: &BETWEEN };
        assert_eq!(with_extremities([&ball, &ball], &landmarks), None);
        let body = with_arms([2.0; 4]);
        let tips = extremities(&body, &BETWEEN).iter().map(|tip| tip.vertex.index()).collect::<Vec<_>>();
        let landmarks = Landmarks { source: &tips, target: &tips };
        assert_eq!(with_extremities([&body, &body], &landmarks), None);
    }
}
