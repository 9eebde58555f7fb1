// SPDX-License-Identifier: MIT OR Apache-2.0
//! Makes a mesh a surface that can be mapped: an oriented manifold without faces that have no area.
//!
//! [`repair`] does as little as it can. Vertices that stay keep their coordinates and their order, and a mesh that is
//! sound stays as it is. Every vertex and face knows which of the given ones it comes from, and what those became.
//!
//! Input: any triangles whose indices are in range. Cost: a few sorts of the edges; for handles see [`handles`].

mod carried;
mod counts;
mod draft;
mod handles;
mod holes;
mod merging;
mod options;
mod paths;
mod pieces;
mod repaired;
mod repeated;
mod sheets;
mod slivers;

use ndarray::{ArrayView2, CowArray, Ix2};

use crate::arrays::rows_of;
use crate::error::{Error, MeshError};
use crate::mesh::geometry::normalized;
use crate::mesh::{Face, Surface, Vertex, check_indices};
use crate::vector::Vector3;
pub use counts::RepairCounts;
use draft::Draft;
pub use options::{CloseHandles, CloseHoles, Keep, RepairOptions};
pub use repaired::Repaired;

/// Repairs a mesh of `vertices` (n, 3) and `faces` (m, 3).
///
/// # Errors
/// Arrays of another shape or empty, indices out of range, options out of range; [`MeshError::NoFaceLeft`] where no face
/// has an area, [`MeshError::NoMainPiece`] with [`Keep::Main`].
///
/// ```
/// use authalic::{RepairOptions, repair};
/// use ndarray::array;
///
/// // two triangles that do not know of each other, one of them upside down
/// let vertices = array![[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
/// let repaired = repair(vertices, array![[0, 1, 2], [3, 5, 4]], &RepairOptions::default())?;
/// assert_eq!((repaired.counts.merged_points, repaired.counts.turned_faces), (2, 1));
/// assert!(repaired.surface.topology()?.is_disk());
/// # Ok::<(), authalic::Error>(())
/// ```
pub fn repair<'a>(
    vertices: impl Into<CowArray<'a, f64, Ix2>>,
    faces: impl Into<CowArray<'a, u32, Ix2>>,
    options: &RepairOptions,
) -> Result<Repaired, Error> {
    let (vertices, faces) = (vertices.into(), faces.into());
    repair_views(vertices.view(), faces.view(), options)
}

fn repair_views(
    vertices: ArrayView2<'_, f64>,
    faces: ArrayView2<'_, u32>,
    options: &RepairOptions,
) -> Result<Repaired, Error> {
    // 1. Check what no repair can mend
    let rows = rows_of::<3, _>("vertices", vertices)?;
    let faces: Vec<_> = rows_of("faces", faces)?.iter().map(|face| face.map(Vertex)).collect();
    check_indices(rows.len(), &faces)?;
    options.check()?;
    let mut counts = RepairCounts::default();
    // 2. The faces between finite vertices, scaled to a unit diagonal
    let mut draft = finite_part(&rows, &faces, &mut counts)?;
    let unit = Unit::new(&mut draft, &rows);
    // 3. Points and faces that are too many
    if let Some(distance) = options.merge {
        counts.merged_points = merging::merge_points(&mut draft, distance / unit.scale);
    }
    counts.faces_without_area = slivers::remove_slivers(&mut draft, unit.largest);
    counts.repeated_faces = repeated::drop_repeated(&mut draft);
    draft.drop_loose();
    if draft.faces.is_empty() {
        return Err(MeshError::NoFaceLeft.into());
    }
    // 4. A manifold, oriented
    let split = sheets::split_sheets(&mut draft);
    (counts.split_edges, counts.split_vertices) = (split.edges, split.vertices);
    let pieces = pieces::orient(&mut draft);
    // 5. Its pieces, holes and handles
    let (pieces, dropped) = pieces::choose(&mut draft, pieces, options.keep)?;
    counts.dropped_pieces = dropped;
    draft.drop_loose();
    counts.closed_holes = holes::close_holes(&mut draft, &pieces, options);
    counts.closed_handles = handles::close_handles(&mut draft, &pieces, options.close_handles, unit.scale);
    // 6. In the coordinates given
    counts.turned_faces = draft.turned.iter().filter(|turned| **turned).count();
    Ok(finished(draft, &unit, &rows, faces.len(), counts))
}

/// The faces of three different vertices whose coordinates are finite.
fn finite_part(
    rows: &[[f64; 3]],
    faces: &[[Vertex; 3]],
    counts: &mut RepairCounts,
) -> Result<Draft, MeshError> {
    let is_finite = |vertex: &Vertex| rows[*vertex].iter().all(|x| x.is_finite());
    let mut is_used = vec![false; rows.len()];
    faces.as_flattened().iter().for_each(|&vertex| is_used[vertex] = true);
    counts.vertices_not_finite = Vertex::all(rows.len()).filter(|vertex| !is_finite(vertex)).count();
    counts.faces_not_finite = faces.iter().filter(|face| !face.iter().all(is_finite)).count();
    counts.loose_vertices =
        Vertex::all(rows.len()).filter(|vertex| is_finite(vertex) && !is_used[*vertex]).count();
    let draft = Draft::new(rows.len(), faces, |face| faces[face].iter().all(is_finite));
    if draft.faces.is_empty() { Err(MeshError::NoFaceLeft) } else { Ok(draft) }
}

/// The unit of a draft in that of the vertices given.
struct Unit {
    /// The length that is 1 in the draft.
    scale: f64,
    /// The largest coordinate given, in the unit of the draft.
    largest: f64,
    /// A place given and in the draft.
    reference: [Vector3; 2],
}

impl Unit {
    /// Gives the draft its points.
    fn new(draft: &mut Draft, rows: &[[f64; 3]]) -> Self {
        let given: Vec<Vector3> = draft.vertex_of.iter().flatten().map(|&v| Vector3(rows[v])).collect();
        let (points, scale) = normalized(&given);
        let largest = given.iter().fold(0.0, |most, x| f64::max(most, x.max_abs()));
        let reference = [given[0], points[0]];
        draft.points = points;
        Self { scale, largest: largest / scale, reference }
    }

    /// A place of the draft in the coordinates given.
    fn given(&self, point: Vector3) -> [f64; 3] {
        let [given, drafted] = self.reference;
        (given + (point - drafted) * self.scale).into()
    }
}

fn finished(
    draft: Draft,
    unit: &Unit,
    rows: &[[f64; 3]],
    n_given_faces: usize,
    counts: RepairCounts,
) -> Repaired {
    let place = |(vertex, point): (&Option<Vertex>, &Vector3)| {
        vertex.map_or_else(|| unit.given(*point), |vertex| rows[vertex])
    };
    let vertices = draft.vertex_of.iter().zip(&draft.points).map(place).collect();
    let mut face_to = vec![None; n_given_faces];
    for (face, given) in draft.face_of.iter().enumerate().rev() {
        if let Some(given) = given {
            face_to[*given] = Some(Face::new(face));
        }
    }
    Repaired {
        surface: Surface::of_checked_rows(vertices, draft.faces),
        vertex_of: draft.vertex_of,
        face_of: draft.face_of,
        vertex_to: draft.vertex_to,
        face_to,
        counts,
    }
}
