// SPDX-License-Identifier: MIT OR Apache-2.0
//! Fills a hole by a smooth membrane: rings of vertices that grow coarser toward its middle, each the mean of its
//! neighbors.
//!
//! Cost: one sparse LU with some three unknowns per vertex of the hole.

use std::iter::successors;

use sprs::TriMat;

use super::apex::apex_of;
use crate::mesh::Vertex;
use crate::mesh::geometry::area;
use crate::sparse::solve_general;
use crate::vector::Vector3;

/// The number of vertices of a ring over that of the ring around it.
const COARSER: f64 = 0.7;

/// Rings of at most so many vertices have the middle inside.
const INNERMOST: usize = 8;

/// Faces of a filling are no smaller than this, relative to the square of their longest edge.
const THINNEST: f64 = 1e-3;

/// Fills one hole by rings of vertices, or by a cone where those would have faces without area.
pub(crate) fn membrane(hole: &[Vertex], points: &mut Vec<Vector3>, faces: &mut Vec<[Vertex; 3]>) {
    let (n_points, n_faces) = (points.len(), faces.len());
    // 1. Rings that grow coarser, and the middle
    let counts = successors(Some(hole.len()), |&count| {
        (count > INNERMOST).then(|| ((COARSER * count as f64).round() as usize).max(5))
    });
    let mut rings: Vec<Vec<Vertex>> = Vec::new();
    let mut next = n_points;
    for count in counts {
        rings.push(if rings.is_empty() {
            hole.to_vec()
        } else {
            (next..next + count).map(Vertex::new).collect()
        });
        next += if rings.len() == 1 { 0 } else { count };
    }
    let middle = Vertex::new(next);
    rings.windows(2).for_each(|pair| stitch(&pair[0], &pair[1], faces));
    let innermost = rings.last().expect("the hole is the first");
    for k in 0..innermost.len() {
        faces.push([innermost[(k + 1) % innermost.len()], innermost[k], middle]);
    }
    // 2. Each vertex the mean of its neighbors
    let places = places(n_points, next + 1 - n_points, &faces[n_faces..], points);
    if let Some(places) = places {
        points.extend(places);
        let is_fat = |face: &[Vertex; 3]| {
            let [a, b, c] = face.map(|vertex| points[vertex]);
            let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
            area([a, b, c].map(|x| x * (1.0 / longest))) > THINNEST
        };
        if faces[n_faces..].iter().all(is_fat) {
            return;
        }
    }
    // 3. Or a cone
    points.truncate(n_points);
    faces.truncate(n_faces);
    let rim: Vec<Vector3> = hole.iter().map(|&vertex| points[vertex]).collect();
    points.push(apex_of(&rim));
    let apex = Vertex::new(n_points);
    faces.extend((0..hole.len()).map(|k| [hole[(k + 1) % hole.len()], hole[k], apex]));
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
