// SPDX-License-Identifier: MIT OR Apache-2.0
//! Start maps with a prescribed boundary: harmonic and Tutte.
//!
//! Both solve L_II f_I = −L_IB b once: with the cotangent weights of the surface (the papers' start,
//! L_S(id)) or with uniform ones. Tutte's map to a convex boundary is an embedding for every disk (Tutte
//! 1963; Floater 2003).

use super::boundary;
use super::published::objective::DiskDomain;
use crate::codomain::planar::PlanarMap;
use crate::control::Watch;
use crate::error::Error;
use crate::mesh::TriangleMesh;
use crate::mesh::geometry::corner_cotangents;

/// The harmonic map, or Tutte's where slivers make the cotangents too large for the harmonic system.
pub(super) fn start(
    mesh: &TriangleMesh,
    domain: &mut DiskDomain<'_>,
    watch: &Watch<'_>,
) -> Result<PlanarMap, Error> {
    harmonic(mesh, domain, watch).or_else(|error| match error {
        Error::CancelledEarly => Err(error),
        _ => tutte(mesh, domain, watch),
    })
}

/// The harmonic map with an arc-length boundary.
fn harmonic(mesh: &TriangleMesh, domain: &mut DiskDomain<'_>, watch: &Watch<'_>) -> Result<PlanarMap, Error> {
    let by_face = corner_cotangents(mesh.points(), mesh.faces());
    let weights: Vec<f64> = by_face.iter().flatten().map(|cotangent| 0.5 * cotangent).collect();
    solve(mesh, domain, &weights, watch)
}

/// Tutte's map with an arc-length boundary.
pub(super) fn tutte(
    mesh: &TriangleMesh,
    domain: &mut DiskDomain<'_>,
    watch: &Watch<'_>,
) -> Result<PlanarMap, Error> {
    // half of each edge's weight per face, so that every interior edge has weight 1
    solve(mesh, domain, &vec![0.5; 3 * mesh.n_faces()], watch)
}

fn solve(
    mesh: &TriangleMesh,
    domain: &mut DiskDomain<'_>,
    weights: &[f64],
    watch: &Watch<'_>,
) -> Result<PlanarMap, Error> {
    let mut map = boundary::arc_length(mesh);
    domain.solve_dirichlet(weights, &mut map, watch)?;
    Ok(map)
}
