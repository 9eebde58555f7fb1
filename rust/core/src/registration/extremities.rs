// SPDX-License-Identifier: MIT OR Apache-2.0
//! Extremities that two surfaces have in common: the tips of legs, ears and tails.
//!
//! With few landmarks a map that starts without them takes the tip of a leg to its middle, and stays there: a minimum
//! of the energy between the surfaces, but not a low one. An extremity is farther from the rest of its surface on
//! average than what lies around it (E. Zhang, K. Mischaikow, G. Turk, Feature-based surface parameterization and
//! texture mapping, ACM Transactions on Graphics 24, 2005). Two belong together where either is the most like the
//! other by their distances from the landmarks. What these have in common does not count: a leg may be longer.
//!
//! Cost: O(n log n) for each of some seventy vertices and each extremity.

use std::cmp::Reverse;

use super::landmarks::Landmarks;
use crate::control::{Observer, Watch};
use crate::error::Error;
use crate::mesh::{TriangleMesh, Vertex};
use crate::parallel;

/// How far an extremity stands out, and how far it is from landmarks at least, in units of the root of the area.
const AROUND: f64 = 0.12;

/// The mean distance at an extremity, as a multiple of the least on the surface, is at least this.
const STANDS_OUT: f64 = 1.3;

/// Lengths in units of the root of the area, and variances of them, that differ by less are equal: rounding does not
/// choose between the two sides of a symmetric surface.
const EQUAL: f64 = 1e-9;

/// Vertices far from each other that stand for all in mean distances.
const SAMPLES: usize = 64;

/// Distances from fewer landmarks do not tell one extremity from another.
const FEWEST_LANDMARKS: usize = 3;

/// The landmarks of source and target, and after them the pairs of extremities that are like each other and far from
/// all landmarks; `None` where there are none.
///
/// # Errors
/// [`Error::CancelledEarly`].
pub(super) fn with_extremities(
    meshes: [&TriangleMesh; 2],
    landmarks: &Landmarks<'_>,
    observer: &mut dyn Observer,
) -> Result<Option<[Vec<usize>; 2]>, Error> {
    if landmarks.source.len() < FEWEST_LANDMARKS {
        return Ok(None);
    }
    let watch = Watch::new(observer, 0.0, "Looking for extremities");
    let of = |side: usize| extremities(meshes[side], [landmarks.source, landmarks.target][side], &watch);
    let (Some(ours), Some(theirs)) = parallel::join(|| of(0), || of(1)) else {
        return Err(Error::CancelledEarly);
    };
    let mut with = [landmarks.source.to_vec(), landmarks.target.to_vec()];
    for (k, extremity) in ours.iter().enumerate() {
        let Some(j) = extremity.most_like(&theirs) else { continue };
        let partner = &theirs[j];
        if partner.most_like(&ours) == Some(k) && extremity.is_far() && partner.is_far() {
            with[0].push(extremity.vertex.index());
            with[1].push(partner.vertex.index());
        }
    }
    Ok((with[0].len() > landmarks.source.len()).then_some(with))
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

    /// The most like of others; `None` where two are equally like it, as the two sides of a symmetric surface are by
    /// landmarks in the middle.
    fn most_like(&self, others: &[Self]) -> Option<usize> {
        let unlikeness: Vec<f64> = others.iter().map(|other| self.unlikeness(other)).collect();
        let best = (0..others.len()).min_by(|&i, &j| unlikeness[i].total_cmp(&unlikeness[j]))?;
        let is_alone = |other: usize| other == best || unlikeness[other] > unlikeness[best] + EQUAL;
        (0..others.len()).all(is_alone).then_some(best)
    }

    /// The variance of the differences of the distances from the landmarks.
    fn unlikeness(&self, other: &Self) -> f64 {
        let differences = || self.distances.iter().zip(&other.distances).map(|(a, b)| a - b);
        let n = self.distances.len() as f64;
        let mean = differences().sum::<f64>() / n;
        differences().map(|difference| (difference - mean).powi(2)).sum::<f64>() / n
    }
}

/// The extremities of a surface; `None` if cancelled.
fn extremities(mesh: &TriangleMesh, landmarks: &[usize], watch: &Watch<'_>) -> Option<Vec<Extremity>> {
    let unit = mesh.face_areas().iter().sum::<f64>().sqrt();
    let from = |vertex: Vertex, most: f64| mesh.distances_along_edges([vertex], most);
    // 1. Mean distances, as multiples of what is equal
    let mean = mean_distances(mesh, Vertex::new(landmarks[0]), EQUAL * unit, watch)?;
    let mean: Vec<f64> = mean.into_iter().map(|distance| (distance / (EQUAL * unit)).round()).collect();
    let least = mean.iter().copied().fold(f64::INFINITY, f64::min);
    // 2. Large, and larger than around, first in the ring
    let ring =
        |vertex: Vertex| mesh.vertex_corners(vertex).iter().flat_map(|corner| mesh.faces()[corner.face()]);
    let around = |vertex: Vertex| {
        let distances = from(vertex, AROUND * unit);
        Vertex::all(distances.len()).filter(move |&other| distances[other].is_finite())
    };
    let peaks: Vec<Vertex> = Vertex::all(mesh.n_vertices())
        .filter(|&vertex| mean[vertex] > STANDS_OUT * least && !mesh.is_boundary(vertex))
        .filter(|&vertex| is_largest(&mean, vertex, ring(vertex)))
        .filter(|&vertex| watch.goes_on() && is_largest(&mean, vertex, around(vertex)))
        .collect();
    // 3. Their distances from the landmarks
    let extremities = parallel::tasks(peaks.len(), |k| {
        let distances = from(peaks[k], f64::INFINITY);
        let distances = landmarks.iter().map(|&landmark| distances[landmark] / unit).collect();
        Extremity { vertex: peaks[k], distances }
    });
    watch.goes_on().then_some(extremities)
}

/// Whether the value at a vertex is the largest among others; of equal ones that of the lowest vertex is.
fn is_largest(values: &[f64], vertex: Vertex, others: impl IntoIterator<Item = Vertex>) -> bool {
    let order = |vertex: Vertex| (values[vertex], Reverse(vertex));
    others.into_iter().all(|other| order(other) <= order(vertex))
}

/// The mean distance of each vertex from vertices far from each other and from a `first` one; `None` if cancelled.
/// Distances that differ by less than `equal` are equal.
fn mean_distances(mesh: &TriangleMesh, first: Vertex, equal: f64, watch: &Watch<'_>) -> Option<Vec<f64>> {
    let mut nearest = mesh.distances_along_edges([first], f64::INFINITY);
    let mut sums = vec![0.0; nearest.len()];
    // a small mesh has fewer vertices
    let n_samples = SAMPLES.min(nearest.len() - 1);
    for _ in 0..n_samples {
        if !watch.goes_on() {
            return None;
        }
        let farthest = Vertex::all(nearest.len())
            .reduce(|best, vertex| if nearest[vertex] > nearest[best] + equal { vertex } else { best })
            .expect("meshes have vertices");
        let distances = mesh.distances_along_edges([farthest], f64::INFINITY);
        for (vertex, distance) in distances.into_iter().enumerate() {
            sums[vertex] += distance;
            nearest[vertex] = nearest[vertex].min(distance);
        }
    }
    Some(sums.iter().map(|sum| sum / n_samples as f64).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::Silent;
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

    fn tips(body: &TriangleMesh) -> Vec<Extremity> {
        extremities(body, &BETWEEN, &Watch::new(&mut Silent, 0.0, "")).unwrap()
    }

    fn found(source: &TriangleMesh, target: &TriangleMesh) -> [Vec<usize>; 2] {
        let landmarks = Landmarks { source: &BETWEEN, target: &BETWEEN };
        let with = with_extremities([source, target], &landmarks, &mut Silent).unwrap().unwrap();
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
        assert_eq!(with_extremities([&ball, &ball], &landmarks, &mut Silent), Ok(None));
        let body = with_arms([2.0; 4]);
        let tips: Vec<usize> = tips(&body).iter().map(|tip| tip.vertex.index()).collect();
        let landmarks = Landmarks { source: &tips, target: &tips };
        assert_eq!(with_extremities([&body, &body], &landmarks, &mut Silent), Ok(None));
    }

    #[test]
    fn two_landmarks_tell_no_extremities_apart() {
        let body = with_arms([2.0; 4]);
        let landmarks = Landmarks { source: &BETWEEN[..2], target: &BETWEEN[..2] };
        assert_eq!(with_extremities([&body, &body], &landmarks, &mut Silent), Ok(None));
    }

    #[test]
    fn rounding_does_not_choose_between_the_sides_of_a_symmetric_body() {
        let body = with_arms([2.0; 4]);
        let noisy = |seed: usize| {
            let noise = |k: usize| 1e-12 * ((k * 7919 + seed * 104_729) % 1000) as f64 / 1000.0;
            let moved = |(k, &Vector3([x, y, z])): (usize, &Vector3)| {
                [x + noise(k), y - noise(k + 1), z + noise(k + 2)]
            };
            let vertices: Vec<[f64; 3]> = body.points().iter().enumerate().map(moved).collect();
            TriangleMesh::new(&vertices, body.faces()).unwrap()
        };
        let vertices = |body: &TriangleMesh| tips(body).iter().map(|tip| tip.vertex).collect::<Vec<_>>();
        assert!((1..5).all(|seed| vertices(&noisy(seed)) == vertices(&body)));
    }
}
