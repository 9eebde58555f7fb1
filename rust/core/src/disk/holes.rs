// SPDX-License-Identifier: MIT OR Apache-2.0
//! Virtual filling of extra boundary loops, so that a surface with holes maps like a disk.
//!
//! Every loop but the longest is closed by a fan to one new vertex. The fan exists only inside the solver: it
//! keeps the hole open in the map at about the size it has on the surface, and its vertex and faces are
//! dropped from the result.

use crate::error::Error;
use crate::filling::{apex_of, cone, spanned_area};
use crate::mesh::{TriangleMesh, Vertex};
use crate::vector::{Vector3, coordinates};

/// A hole's faces get at least this part of the mean target, so that a slit without area stays solvable.
const SMALLEST_SHARE: f64 = 0.05;

/// A surface with its holes filled; the original vertices and faces come first.
#[derive(Debug)]
pub(super) struct Filled {
    pub mesh: TriangleMesh,
    pub targets: Vec<f64>,
}

/// Fills all loops but the longest. `targets` are the areas of the given faces.
///
/// # Errors
/// As [`TriangleMesh::new`], where a fan doubles a face.
pub(super) fn fill_holes(mesh: &TriangleMesh, targets: &[f64]) -> Result<Filled, Error> {
    let (mut points, mut faces, mut targets) =
        (mesh.points().to_vec(), mesh.faces().to_vec(), targets.to_vec());
    let scale = targets.iter().sum::<f64>() / mesh.face_areas().iter().sum::<f64>();
    let least = SMALLEST_SHARE * targets.iter().sum::<f64>() / targets.len() as f64;
    for hole in &mesh.boundary_loops()[1..] {
        let corners: Vec<Vector3> = hole.iter().map(|&vertex| points[vertex]).collect();
        let share = (scale * spanned_area(&corners) / hole.len() as f64).max(least);
        fill(hole, &mut points, &mut faces);
        targets.resize(faces.len(), share);
    }
    Ok(Filled { mesh: TriangleMesh::new(&coordinates(points), &faces)?, targets })
}

/// The closed surface with all loops filled; the original vertices and faces come first.
///
/// # Errors
/// As [`fill_holes`].
pub(crate) fn closed(mesh: &TriangleMesh) -> Result<TriangleMesh, Error> {
    let (mut points, mut faces) = (mesh.points().to_vec(), mesh.faces().to_vec());
    mesh.boundary_loops().iter().for_each(|hole| fill(hole, &mut points, &mut faces));
    TriangleMesh::new(&coordinates(points), &faces)
}

/// Fills one hole by a fan to a new vertex.
fn fill(hole: &[Vertex], points: &mut Vec<Vector3>, faces: &mut Vec<[Vertex; 3]>) {
    let corners: Vec<Vector3> = hole.iter().map(|&vertex| points[vertex]).collect();
    faces.extend(cone(hole, Vertex::new(points.len())));
    points.push(apex_of(&corners));
}
