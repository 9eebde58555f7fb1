// SPDX-License-Identifier: MIT OR Apache-2.0
//! Start maps with a prescribed boundary: harmonic and Tutte.
//!
//! Both solve L_II f_I = −L_IB b once: with the cotangent weights of the surface (the papers' start,
//! L_S(id)) or with uniform ones. Tutte's map to a convex boundary is an embedding for every disk (Tutte
//! 1963; Floater 2003).

use super::boundary::arc_length;
use super::published::objective::DiskObjective;
use crate::codomain::planar::PlanarMap;
use crate::control::Watch;
use crate::error::Error;
use crate::mesh::TriangleMesh;
use crate::mesh::geometry::corner_cotangents;

/// The harmonic map, or Tutte's where slivers make the cotangents too large for the harmonic system, with an arc-length
/// boundary.
pub(super) fn start(
    mesh: &TriangleMesh,
    objective: &mut DiskObjective<'_>,
    watch: &Watch<'_>,
) -> Result<PlanarMap, Error> {
    harmonic(mesh, objective, arc_length(mesh), watch).or_else(|error| match error {
        Error::CancelledEarly => Err(error),
        _ => tutte(mesh, objective, arc_length(mesh), watch),
    })
}

/// The harmonic map with the boundary of `map`.
pub(super) fn harmonic(
    mesh: &TriangleMesh,
    objective: &mut DiskObjective<'_>,
    mut map: PlanarMap,
    watch: &Watch<'_>,
) -> Result<PlanarMap, Error> {
    let by_face = corner_cotangents(mesh.points(), mesh.faces());
    let weights: Vec<f64> = by_face.iter().flatten().map(|cotangent| 0.5 * cotangent).collect();
    objective.solve_dirichlet(&weights, &mut map, watch)?;
    Ok(map)
}

/// Tutte's map with the boundary of `map`.
pub(super) fn tutte(
    mesh: &TriangleMesh,
    objective: &mut DiskObjective<'_>,
    mut map: PlanarMap,
    watch: &Watch<'_>,
) -> Result<PlanarMap, Error> {
    // half of each edge's weight per face, so that every interior edge has weight 1
    objective.solve_dirichlet(&vec![0.5; 3 * mesh.n_faces()], &mut map, watch)?;
    Ok(map)
}
