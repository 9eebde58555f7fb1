// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a map onto a rectangle refuses before any work.

use super::aspect::MOST_ASPECT;
use super::corners::Outline;
use super::sides::{bounds, corners_of, sides};
use crate::disk::options::{Boundary, DiskMapOptions};
use crate::error::{Elements, Error, MapError};
use crate::mesh::{TriangleMesh, Vertex};

/// Refuses options that do not fit a rectangle, and options of rectangles elsewhere.
pub(in crate::disk) fn check(mesh: &TriangleMesh, options: &DiskMapOptions<'_>) -> Result<(), Error> {
    if options.boundary != Boundary::Rectangle {
        let given = [("corners", options.corners.is_some()), ("aspect", options.aspect.is_some())];
        return match given.into_iter().find(|&(_, is_given)| is_given) {
            None => Ok(()),
            Some((name, _)) => Err(Error::InvalidOption {
                name,
                found: "given".into(),
                expected: "left out unless the boundary is a rectangle".into(),
            }),
        };
    }
    if let Some(aspect) = options.aspect
        && !(1.0 / MOST_ASPECT..=MOST_ASPECT).contains(&aspect)
    {
        let expected = "width over height, from 1e-4 to 1e4".into();
        return Err(Error::InvalidOption { name: "aspect", found: aspect.to_string(), expected });
    }
    corners_of(mesh, options).map(|_| ())
}

/// Refuses a start map whose boundary does not run along the sides of an upright rectangle.
pub(in crate::disk) fn check_initial(
    mesh: &TriangleMesh,
    options: &DiskMapOptions<'_>,
    initial: &[[f64; 2]],
) -> Result<(), Error> {
    let outline = Outline::new(mesh);
    let [low, high] = bounds(outline.vertices, initial);
    let size = (high[0] - low[0]).max(high[1] - low[1]);
    let refuse = |vertices: &[Vertex], reason: &str| match Elements::collect(vertices.iter().copied()) {
        None => Ok(()),
        Some(vertices) => Err(MapError::InitialBoundary { vertices, reason: reason.into() }.into()),
    };
    if !(high[0] > low[0] && high[1] > low[1]) {
        return refuse(outline.vertices, "it must run around a rectangle");
    }
    if signed_area(outline.vertices, initial) <= 0.0 {
        return refuse(
            outline.vertices,
            "it must run counter-clockwise (mirror the map if it runs clockwise)",
        );
    }
    let is_off = |&&v: &&Vertex| {
        let on = |axis: usize, line: f64| (initial[v][axis] - line).abs() <= 1e-6 * size;
        ![0, 1].iter().any(|&axis| on(axis, low[axis]) || on(axis, high[axis]))
    };
    let off: Vec<Vertex> = outline.vertices.iter().filter(is_off).copied().collect();
    refuse(&off, "it must lie on the sides of an upright rectangle")?;
    let corners = corners_of(mesh, options)?;
    for (k, side) in sides(outline.vertices, &corners).iter().enumerate() {
        let (across, line) = ((k + 1) % 2, if k == 0 || k == 3 { low } else { high });
        let off = |&&v: &&Vertex| (initial[v][across] - line[across]).abs() > 1e-6 * size;
        let off: Vec<Vertex> = side.iter().filter(off).copied().collect();
        refuse(&off, "it must lie on the sides of an upright rectangle, the corners in its corners")?;
    }
    Ok(())
}

/// The area inside an outline, negative where it runs clockwise.
fn signed_area(outline: &[Vertex], map: &[[f64; 2]]) -> f64 {
    let next = outline.iter().cycle().skip(1);
    let cross = |(&a, &b): (&Vertex, &Vertex)| {
        let ([x, y], [u, v]) = (map[a], map[b]);
        x * v - u * y
    };
    0.5 * outline.iter().zip(next).map(cross).sum::<f64>()
}
