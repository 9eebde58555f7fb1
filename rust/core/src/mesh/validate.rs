// SPDX-License-Identifier: MIT OR Apache-2.0
//! The checks of a mesh; each error names the elements at fault.

use super::corners::{EdgeTable, VertexCorners};
use super::geometry::triangle;
use super::{Corner, Vertex, geometry};
use crate::error::{Elements, MeshError};
use crate::vector::Vector3;

/// Most faces: corner indices must fit into 32 bits with one value to spare.
const MOST_FACES: usize = (u32::MAX / 3) as usize;

/// Height, in roundings of its coordinates, up to which a face counts as flat.
const ROUNDINGS: f64 = 4.0;

/// Height, relative to the bounding box, below which the square of an area would underflow.
const SMALLEST_HEIGHT: f64 = 1e-60;

/// Checks the arrays alone: sizes, finite coordinates, index range, three different vertices per face.
pub(super) fn arrays(vertices: &[[f64; 3]], faces: &[[Vertex; 3]]) -> Result<(), MeshError> {
    sizes(vertices.len(), faces.len())?;
    finite(vertices)?;
    in_range(vertices.len(), faces)?;
    distinct_corners(faces)
}

/// Checks that there are vertices and faces, and that the faces are between these vertices.
pub(crate) fn check_indices(n_vertices: usize, faces: &[[Vertex; 3]]) -> Result<(), MeshError> {
    sizes(n_vertices, faces.len())?;
    in_range(n_vertices, faces)
}

fn sizes(n_vertices: usize, n_faces: usize) -> Result<(), MeshError> {
    match (n_vertices, n_faces) {
        (0, _) => Err(MeshError::NoVertices),
        (_, 0) => Err(MeshError::NoFaces),
        (_, found) if found > MOST_FACES => Err(MeshError::TooManyFaces { found, limit: MOST_FACES }),
        _ => Ok(()),
    }
}

fn finite(vertices: &[[f64; 3]]) -> Result<(), MeshError> {
    let bad = which(vertices, |vertex| !vertex.iter().all(|x| x.is_finite()));
    refuse(bad, |vertices| MeshError::NonFinite { vertices })
}

fn in_range(n_vertices: usize, faces: &[[Vertex; 3]]) -> Result<(), MeshError> {
    let outside = |v: &Vertex| v.index() >= n_vertices;
    let bad = which(faces, |face| face.iter().any(outside));
    refuse(bad, |bad| {
        let value = faces[bad.first[0]].into_iter().find(outside).map_or(0, |vertex| i64::from(vertex.0));
        MeshError::IndexOutOfRange { faces: bad, value, n_vertices }
    })
}

fn distinct_corners(faces: &[[Vertex; 3]]) -> Result<(), MeshError> {
    let bad = which(faces, |[a, b, c]| a == b || b == c || c == a);
    refuse(bad, |faces| MeshError::RepeatedVertex { faces })
}

/// Refuses faces with the same vertices as an earlier one.
pub(super) fn no_duplicates(faces: &[[Vertex; 3]], table: &EdgeTable) -> Result<(), MeshError> {
    let mut repeated = Vec::new();
    let mut apexes = Vec::new();
    for ([_, high], entries) in table.edges().filter(|(_, entries)| entries.len() > 1) {
        apexes.clear();
        apexes.extend(
            entries.iter().map(|entry| entry.corner()).map(|corner| (corner.vertex(faces), corner.face())),
        );
        apexes.sort_unstable();
        let same = apexes.windows(2).filter(|pair| pair[0].0 == pair[1].0);
        // Each face is looked at once, from the edge of its two lower vertices.
        repeated.extend(same.filter(|pair| pair[1].0 > high).map(|pair| pair[1].1));
    }
    repeated.sort_unstable();
    refuse(Elements::collect(repeated), |faces| MeshError::DuplicateFaces { faces })
}

/// Computes the areas of the faces of `points`, which are `vertices` centered and divided by `scale`.
///
/// Refuses faces whose corners lie on a line.
pub(super) fn positive_areas(
    vertices: &[[f64; 3]],
    points: &[Vector3],
    scale: f64,
    faces: &[[Vertex; 3]],
) -> Result<Vec<f64>, MeshError> {
    let areas = geometry::face_areas(points, faces);
    let bad = faces.iter().zip(&areas).enumerate().filter(|(_, (face, area))| {
        // the coordinates were rounded both as given and after normalization
        let corners = triangle(points, **face);
        let given = largest(face.map(|vertex| Vector3(vertices[vertex]))) / scale;
        is_flat(corners, **area, given.max(largest(corners)))
    });
    let bad = Elements::collect(bad.map(|(face, _)| face));
    refuse(bad, |faces| MeshError::ZeroArea { faces })?;
    Ok(areas)
}

/// Whether a triangle's height over its longest edge is no larger than the rounding of its coordinates.
fn is_flat(corners: [Vector3; 3], area: f64, largest_coordinate: f64) -> bool {
    let longest = geometry::edge_lengths(corners).into_iter().fold(0.0, f64::max);
    let height = 2.0 * area / longest;
    let rounding = ROUNDINGS * f64::EPSILON * largest_coordinate.max(longest);
    // NaN: the corners all coincide, 0 / 0
    height.is_nan() || height <= rounding.max(SMALLEST_HEIGHT)
}

fn largest(corners: [Vector3; 3]) -> f64 {
    corners.into_iter().map(Vector3::max_abs).fold(0.0, f64::max)
}

/// Refuses edges of three or more faces.
pub(super) fn manifold_edges(table: &EdgeTable) -> Result<(), MeshError> {
    let bad = table.edges().filter(|(_, entries)| entries.len() > 2).map(|(edge, _)| edge);
    refuse(Elements::edges(bad), |edges| MeshError::NonManifoldEdges { edges })
}

/// Refuses vertices with several fans, then vertices without a face.
pub(super) fn manifold_vertices(
    corners: &VertexCorners,
    n: usize,
    opposite: &[Option<Corner>],
) -> Result<(), MeshError> {
    let pinched = Elements::collect(Vertex::all(n).filter(|&v| !corners.is_one_fan(v, opposite)));
    refuse(pinched, |vertices| MeshError::NonManifoldVertices { vertices })?;
    let loose = Elements::collect(Vertex::all(n).filter(|&v| corners.of(v).is_empty()));
    refuse(loose, |vertices| MeshError::UnreferencedVertices { vertices })
}

/// The indices of the items that are bad.
fn which<T>(items: &[T], bad: impl Fn(&T) -> bool) -> Option<Elements> {
    Elements::collect(items.iter().enumerate().filter(|(_, item)| bad(item)).map(|(index, _)| index))
}

/// The error of the elements at fault, if there are any.
pub(super) fn refuse(
    bad: Option<Elements>,
    error: impl FnOnce(Elements) -> MeshError,
) -> Result<(), MeshError> {
    bad.map_or(Ok(()), |elements| Err(error(elements)))
}
