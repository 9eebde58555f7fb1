// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pairs of landmarks, their check, and the best rotation of one side onto the other in the disk.

use crate::codomain::CanonicalDomain;
use crate::error::{Elements, Error, LandmarkError, Side};
use crate::mesh::{TriangleMesh, Vertex};
use crate::vector::Vector3;

/// Pairs of corresponding vertices, one on the source and one on the target.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Landmarks<'a> {
    /// (k,): vertices of the source.
    pub source: &'a [usize],
    /// (k,): their partners on the target.
    pub target: &'a [usize],
}

impl Landmarks<'_> {
    /// Refuses vertices that are out of range on the source or the target.
    pub(super) fn check_range(&self, [source, target]: [usize; 2]) -> Result<(), Error> {
        check_range(Side::Source, self.source, source)?;
        check_range(Side::Target, self.target, target)?;
        Ok(())
    }

    /// Refuses pairs that cannot be registered, before any work, and fewer than `needed`.
    pub(super) fn check(
        &self,
        source: &TriangleMesh,
        target: &TriangleMesh,
        needed: usize,
    ) -> Result<(), Error> {
        let (source_count, target_count) = (self.source.len(), self.target.len());
        if source_count != target_count {
            return Err(LandmarkError::Counts { source_count, target_count }.into());
        }
        if source_count < needed {
            return Err(LandmarkError::TooFew { found: source_count, needed }.into());
        }
        check_side(Side::Source, self.source, source)?;
        check_side(Side::Target, self.target, target)?;
        Ok(())
    }
}

fn check_range(side: Side, landmarks: &[usize], n_vertices: usize) -> Result<(), LandmarkError> {
    match Elements::collect((0..landmarks.len()).filter(|&pair| landmarks[pair] >= n_vertices)) {
        None => Ok(()),
        Some(pairs) => {
            let value = landmarks[pairs.first[0]];
            Err(LandmarkError::OutOfRange { side, pairs, value, n_vertices })
        }
    }
}

fn check_side(side: Side, landmarks: &[usize], mesh: &TriangleMesh) -> Result<(), LandmarkError> {
    let n_vertices = mesh.n_vertices();
    check_range(side, landmarks, n_vertices)?;
    let pairs =
        |is_bad: &dyn Fn(usize) -> bool| Elements::collect((0..landmarks.len()).filter(|&pair| is_bad(pair)));
    let mut first = vec![usize::MAX; n_vertices];
    (0..landmarks.len()).rev().for_each(|pair| first[landmarks[pair]] = pair);
    if let Some(pairs) = pairs(&|pair| first[landmarks[pair]] != pair) {
        let vertex = landmarks[pairs.first[0]];
        return Err(LandmarkError::Repeated { side, first: first[vertex], pairs, vertex });
    }
    if let Some(pairs) = pairs(&|pair| mesh.is_boundary(Vertex::new(landmarks[pair]))) {
        let vertex = landmarks[pairs.first[0]];
        return Err(LandmarkError::OnBoundary { side, pairs, vertex });
    }
    Ok(())
}

/// The least number of pairs that determines a rotation.
pub(super) fn fewest(domain: CanonicalDomain) -> usize {
    match domain {
        CanonicalDomain::Disk => 1,
        CanonicalDomain::Sphere => 2,
    }
}

/// The angle of the rotation of points `from` in the plane z = 1 about the origin that brings them nearest to `to`.
///
/// R of SO(2) minimizes Σ |R p_i − q_i|²; the angle is 0 where the points determine none, as at the center.
pub(super) fn best_turn(from: &[Vector3], to: &[Vector3]) -> f64 {
    let (mut sine, mut cosine) = (0.0, 0.0);
    for (p, q) in from.iter().zip(to) {
        sine += p[0] * q[1] - p[1] * q[0];
        cosine += p[0] * q[0] + p[1] * q[1];
    }
    if sine.hypot(cosine) > 1e-12 { sine.atan2(cosine) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::codomain::motion::rotated;

    fn square() -> TriangleMesh {
        let vertices = [[0., 0., 0.], [2., 0., 0.], [2., 2., 0.], [0., 2., 0.], [1., 1., 0.], [1.2, 1., 0.]];
        let faces = [[0, 1, 4], [1, 5, 4], [1, 2, 5], [2, 4, 5], [2, 3, 4], [3, 0, 4]];
        TriangleMesh::new(&vertices, &faces).unwrap()
    }

    #[test]
    fn bad_pairs_are_refused_by_name() {
        let mesh = square();
        let said = |source: &[usize], target: &[usize]| {
            let landmarks = Landmarks { source, target };
            landmarks.check(&mesh, &mesh, fewest(CanonicalDomain::Disk)).map_err(|error| error.to_string())
        };
        assert_eq!(said(&[4, 5], &[5, 4]), Ok(()));
        assert!(said(&[4], &[4, 5]).unwrap_err().contains("1 source and 2 target"));
        assert!(said(&[], &[]).unwrap_err().contains("at least 1"));
        assert!(said(&[4, 6], &[4, 5]).unwrap_err().contains("6"));
        assert!(said(&[4, 5], &[4, 4]).unwrap_err().contains("pair 1"));
        assert!(said(&[4, 1], &[4, 5]).unwrap_err().contains("boundary"));
        let pair = Landmarks { source: &[4], target: &[5] };
        assert!(matches!(
            pair.check(&mesh, &mesh, fewest(CanonicalDomain::Sphere)),
            Err(Error::Landmarks(LandmarkError::TooFew { found: 1, needed: 2 }))
        ));
    }

    #[test]
    fn the_best_turn_undoes_a_rotation() {
        let points = [[0.3, 0.1, 1.0], [-0.2, 0.7, 1.0]].map(Vector3);
        let turned = points.map(|Vector3([u, v, w])| {
            let (sine, cosine) = 2.5f64.sin_cos();
            Vector3([cosine * u - sine * v, sine * u + cosine * v, w])
        });
        assert!((best_turn(&points, &turned) - 2.5).abs() < 1e-15);
        assert_eq!(best_turn(&[Vector3([0.0, 0.0, 1.0])], &[Vector3([0.1, 0.2, 1.0])]), 0.0);
        assert!((rotated(Vector3([1.0, 0.0, 1.0]), 2.5)[0] - 2.5f64.cos()).abs() < 1e-15);
    }
}
