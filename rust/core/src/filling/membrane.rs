// SPDX-License-Identifier: MIT OR Apache-2.0
//! Fills a hole by a smooth membrane: rings of vertices that grow coarser toward its middle, each the mean of its
//! neighbors.
//!
//! Cost: one sparse LU with some three unknowns per vertex of the hole.

use sprs::TriMat;

use super::apex::apex_of;
use crate::mesh::Vertex;
use crate::mesh::geometry::{area, edge_lengths};
use crate::sparse::solve_general;
use crate::vector::Vector3;

/// The number of vertices of a ring over that of the ring around it.
const COARSER: f64 = 0.7;

/// Rings of at most so many vertices have the middle inside.
const INNERMOST: usize = 8;

/// The least number of vertices of a ring.
const FEWEST: usize = 5;

/// Faces of a membrane are to be no smaller than this, relative to the square of their longest edge.
const THINNEST: f64 = 1e-3;

/// Fills one hole by rings of vertices, or by a cone where those would have thin faces and its own are thicker.
pub(crate) fn membrane(hole: &[Vertex], points: &mut Vec<Vector3>, faces: &mut Vec<[Vertex; 3]>) {
    let (n_points, n_faces) = (points.len(), faces.len());
    // 1. Rings that grow coarser, and the middle
    let rings = rings(hole, n_points);
    rings.windows(2).for_each(|pair| stitch(&pair[0], &pair[1], faces));
    let n_added = 1 + rings[1..].iter().map(Vec::len).sum::<usize>();
    let middle = Vertex::new(n_points + n_added - 1);
    faces.extend(cone(&rings[rings.len() - 1], middle));
    // 2. Each vertex the mean of its neighbors
    let mut thickness = 0.0;
    if let Some(places) = places(n_points, n_added, &faces[n_faces..], points) {
        points.extend(places);
        thickness = least_thickness(faces[n_faces..].iter().map(|face| face.map(|vertex| points[vertex])));
    }
    if thickness > THINNEST {
        return;
    }
    // 3. Or a cone
    let rim: Vec<Vector3> = hole.iter().map(|&vertex| points[vertex]).collect();
    let apex = apex_of(&rim);
    if least_thickness((0..rim.len()).map(|k| [rim[k], rim[(k + 1) % rim.len()], apex])) >= thickness {
        points.truncate(n_points);
        faces.truncate(n_faces);
        points.push(apex);
        faces.extend(cone(hole, Vertex::new(n_points)));
    }
}

/// The faces between a loop, which has the surface on its left, and the tip of a cone on its right.
pub(crate) fn cone(hole: &[Vertex], apex: Vertex) -> impl Iterator<Item = [Vertex; 3]> {
    (0..hole.len()).map(move |k| [hole[(k + 1) % hole.len()], hole[k], apex])
}

/// Whether a face is thicker than the thinnest that a filling should have.
pub(crate) fn is_fat(corners: [Vector3; 3]) -> bool {
    thickness(corners) > THINNEST
}

/// Thickness of the thinnest of some faces.
fn least_thickness(faces: impl Iterator<Item = [Vector3; 3]>) -> f64 {
    faces.map(thickness).fold(f64::INFINITY, f64::min)
}

/// Area relative to the square of the longest edge; 0 where all corners coincide.
fn thickness(corners: [Vector3; 3]) -> f64 {
    let longest = edge_lengths(corners).into_iter().fold(0.0, f64::max);
    area(corners.map(|x| x * (1.0 / longest))).max(0.0)
}

/// The hole and the rings inside, of vertices numbered from `first`.
fn rings(hole: &[Vertex], first: usize) -> Vec<Vec<Vertex>> {
    let mut rings = vec![hole.to_vec()];
    let mut next = first;
    let mut count = hole.len();
    while count > INNERMOST {
        count = ((COARSER * count as f64).round() as usize).max(FEWEST);
        rings.push((next..next + count).map(Vertex::new).collect());
        next += count;
    }
    rings
}

/// The faces between a ring and the next one inside. The ring has the surface on its left and these on its right.
fn stitch(outer: &[Vertex], inner: &[Vertex], faces: &mut Vec<[Vertex; 3]>) {
    let (n, m) = (outer.len(), inner.len());
    let (mut i, mut j) = (0, 0);
    while i < n || j < m {
        let [here, there] = [outer[i % n], inner[j % m]];
        // the ring that lags behind goes on: (i + 1)/n against (j + 1)/m
        if j == m || (i < n && (i + 1) * m <= (j + 1) * n) {
            i += 1;
            faces.push([outer[i % n], here, there]);
        } else {
            j += 1;
            faces.push([here, there, inner[j % m]]);
        }
    }
}

/// The places of `count` new vertices from number `first`, each the mean of its neighbors in `faces`; `None` where the
/// system is singular.
fn places(first: usize, count: usize, faces: &[[Vertex; 3]], points: &[Vector3]) -> Option<Vec<Vector3>> {
    let mut matrix = TriMat::new((count, count));
    let mut rhs = vec![0.0; 3 * count];
    // around an inner vertex every edge belongs to two faces, in one of them in each direction
    for face in faces {
        for k in 0..3 {
            let (from, to) = (face[k].index(), face[(k + 1) % 3].index());
            if from < first {
                continue;
            }
            let row = from - first;
            matrix.add_triplet(row, row, 1.0);
            match to.checked_sub(first) {
                Some(column) => matrix.add_triplet(row, column, -1.0),
                None => (0..3).for_each(|axis| rhs[axis * count + row] += points[to][axis]),
            }
        }
    }
    solve_general(&matrix.to_csc(), &mut rhs).ok()?;
    Some((0..count).map(|row| Vector3::from_fn(|axis| rhs[axis * count + row])).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The rim of a hole with its filling: the points, and the corners of the new faces.
    fn filled(rim: &[[f64; 3]]) -> (Vec<Vector3>, Vec<[Vector3; 3]>) {
        let mut points: Vec<Vector3> = rim.iter().map(|&point| Vector3(point)).collect();
        let hole: Vec<Vertex> = (0..rim.len()).map(Vertex::new).collect();
        let mut faces = Vec::new();
        membrane(&hole, &mut points, &mut faces);
        let corners = faces.iter().map(|face| face.map(|vertex| points[vertex])).collect();
        (points, corners)
    }

    #[test]
    fn a_hole_so_thin_that_a_cone_would_be_flat_keeps_its_membrane() {
        // the first edge is short, and the tip of the cone lies in line with it but for rounding
        let thin = 2e-8;
        let rim = [[0.0, 1.0, 0.0], [thin, 1.0, 0.0], [-thin, thin, 0.0], [-thin, 2.0, 0.0]];
        let apex = apex_of(&rim.map(Vector3));
        assert!(thickness([Vector3(rim[0]), Vector3(rim[1]), apex]) < 1e-15);
        let (points, faces) = filled(&rim);
        let middle = rim.iter().map(|&point| Vector3(point) * 0.25).sum();
        assert!(points.len() == 5 && points[4].distance(middle) < 1e-15);
        assert_eq!(faces.len(), 4);
        assert!(faces.into_iter().all(|corners| thickness(corners) > 1e-9));
    }

    #[test]
    fn a_hole_whose_membrane_would_be_flat_gets_a_cone() {
        let (points, faces) = filled(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]);
        assert_eq!((points.len(), faces.len()), (4, 3));
        assert!(faces.into_iter().all(is_fat));
    }
}
