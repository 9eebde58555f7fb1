// SPDX-License-Identifier: MIT OR Apache-2.0
//! Virtual filling of extra boundary loops, so that a surface with holes maps like a disk.
//!
//! Every loop but the longest is closed by a fan to one new vertex. The fan exists only inside the solver: it
//! keeps the hole open in the map at about the size it has on the surface, and its vertex and faces are
//! dropped from the result.

use crate::error::Error;
use crate::mesh::geometry::{area, area_vector};
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
    let apex = Vertex::new(points.len());
    points.push(apex_of(&corners));
    for k in 0..hole.len() {
        // the loop has the surface on its left, the fan lies on its right
        faces.push([hole[(k + 1) % hole.len()], hole[k], apex]);
    }
}

/// Area of the flat polygon nearest to a loop: the length of its area vector.
fn spanned_area(corners: &[Vector3]) -> f64 {
    loop_normal(corners).norm()
}

/// Σ of the area vectors of the fan around the centroid.
fn loop_normal(corners: &[Vector3]) -> Vector3 {
    let center = centroid(corners);
    edges(corners).fold(Vector3::ZERO, |sum, (from, to)| sum + area_vector([center, from, to]))
}

/// A point beside the centroid that lies on the line of no edge: the candidate whose thinnest fan triangle
/// is fattest.
pub(crate) fn apex_of(corners: &[Vector3]) -> Vector3 {
    let (center, normal) = (centroid(corners), loop_normal(corners));
    let length: f64 = edges(corners).map(|(from, to)| (to - from).norm()).sum();
    let mut directions = vec![Vector3::ZERO];
    directions.extend([0, 1, 2].map(Vector3::unit));
    if normal.norm() > 0.0 {
        let unit = normal.normalized();
        directions.push(unit);
        directions.extend(edges(corners).take(1).map(|(from, to)| unit.cross(to - from)));
    }
    let candidates = directions.into_iter().map(|direction| center + direction * (0.1 * length));
    let thinnest = |apex: &Vector3| {
        edges(corners)
            .map(|(from, to)| area([from, to, *apex]) / (to - from).dot(to - from))
            .fold(f64::INFINITY, f64::min)
    };
    candidates.max_by(|a, b| thinnest(a).total_cmp(&thinnest(b))).expect("there are candidates")
}

fn centroid(corners: &[Vector3]) -> Vector3 {
    corners.iter().fold(Vector3::ZERO, |sum, &corner| sum + corner) * (1.0 / corners.len() as f64)
}

fn edges(corners: &[Vector3]) -> impl Iterator<Item = (Vector3, Vector3)> {
    (0..corners.len()).map(|k| (corners[k], corners[(k + 1) % corners.len()]))
}
