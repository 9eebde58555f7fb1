// SPDX-License-Identifier: MIT OR Apache-2.0
//! Checks of surface and options before a disk map is computed.

use super::options::{Boundary, DiskMapOptions, DiskMethod};
use super::{boundary, rectangle};
use crate::error::{Elements, Error, MapError, MeshError};
use crate::mesh::{TriangleMesh, Vertex};
use crate::options::{check_angle_weight, check_area_tolerance};

/// Refuses a surface that is no disk, and options out of range.
pub(super) fn check(mesh: &TriangleMesh, options: &DiskMapOptions<'_>) -> Result<(), Error> {
    match mesh.require_disk() {
        Err(Error::Mesh(MeshError::SeveralBoundaries { .. })) if options.fill_holes => {}
        verdict => verdict?,
    }
    if let Some(initial) = options.initial_rows() {
        check_initial(mesh, options, initial)?;
    }
    if options.boundary == Boundary::Rectangle && options.method != DiskMethod::GaussNewton {
        let expected =
            "arc_length or sliding for the papers' methods; only gauss_newton has rectangles".into();
        return Err(Error::InvalidOption { name: "boundary", found: "rectangle".into(), expected });
    }
    if options.overlap && options.boundary != Boundary::Free {
        let (found, expected) = ("true".into(), "false unless the boundary is free".into());
        return Err(Error::InvalidOption { name: "overlap", found, expected });
    }
    if options.boundary == Boundary::Free && options.method != DiskMethod::GaussNewton {
        let expected = "arc_length or sliding for the papers' methods; only gauss_newton frees it".into();
        return Err(Error::InvalidOption { name: "boundary", found: "free".into(), expected });
    }
    rectangle::check(mesh, options)?;
    check_angle_weight(options.angle_weight, options.method == DiskMethod::GaussNewton)?;
    check_area_tolerance(
        options.area_tolerance,
        options.angle_weight,
        options.method == DiskMethod::GaussNewton,
    )?;
    match options.tolerance {
        Some(tolerance) if !(tolerance >= 0.0 && tolerance.is_finite()) => Err(Error::InvalidOption {
            name: "tolerance",
            found: tolerance.to_string(),
            expected: "a finite number ≥ 0".into(),
        }),
        _ => Ok(()),
    }
}

/// A start map must be finite and run once around the unit circle; its folds are mended like any others. With a free
/// boundary it may have any outline.
fn check_initial(
    mesh: &TriangleMesh,
    options: &DiskMapOptions<'_>,
    initial: &[[f64; 2]],
) -> Result<(), Error> {
    let is_free = options.boundary == Boundary::Free;
    if initial.len() != mesh.n_vertices() || (mesh.boundary_loops().len() != 1 && !is_free) {
        let where_from = if is_free { "" } else { " on a surface with one boundary loop" };
        let expected = format!("of shape ({}, 2){where_from}", mesh.n_vertices());
        let found = format!("of shape ({}, 2) with {} loops", initial.len(), mesh.boundary_loops().len());
        return Err(Error::InvalidArray { name: "initial", found, expected });
    }
    let not_finite = |v: &usize| !initial[*v].iter().all(|x| x.is_finite());
    if let Some(vertices) = Elements::collect((0..initial.len()).filter(not_finite)) {
        return Err(MapError::NonFinite { name: "initial", vertices }.into());
    }
    if options.boundary == Boundary::Rectangle {
        return rectangle::check_initial(mesh, options, initial);
    }
    if is_free {
        return Ok(());
    }
    let boundary = &mesh.boundary_loops()[0];
    let off_circle = |&v: &Vertex| (initial[v][0].hypot(initial[v][1]) - 1.0).abs() > 1e-6;
    if let Some(vertices) = Elements::collect(boundary.iter().copied().filter(off_circle)) {
        return Err(
            MapError::InitialBoundary { vertices, reason: "it must lie on the unit circle".into() }.into()
        );
    }
    if !boundary::runs_once_around(boundary, initial) {
        let vertices = Elements::collect(boundary.iter().copied()).expect("a loop has vertices");
        return Err(MapError::InitialBoundary {
            vertices,
            reason: "it must run once around the unit circle, counter-clockwise \
                     (mirror the map if it runs clockwise)"
                .into(),
        }
        .into());
    }
    Ok(())
}
