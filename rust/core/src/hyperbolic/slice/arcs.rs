// SPDX-License-Identifier: MIT OR Apache-2.0
//! The arcs that join the features of a chain, on the source and, in the same homotopy class, on the target.
//!
//! Harmonic maps of surfaces with several boundaries are unique only within a homotopy class. The arcs
//! determine the class: those of the source go onto those of the target. On the source an arc is a short path
//! of edges that keeps clear of the cuts. Its image under a deformation of the sphere that carries the features
//! of the source to those of the target is a polyline; the arc on the target is the path of edges that stays
//! nearest to this.
//!
//! Input: surfaces on which the features are marked and no chords are left. After each arc its chords are
//! split, so that there is always a way for the next. Cost: a search by Dijkstra's algorithm for each arc.

use super::chain::Link;
use super::cutting::{Cutting, Seam};
use super::paths::{cheapest_path, lower_distances};
use super::polyline::{Polyline, resampled};
use crate::control::Watch;
use crate::error::{CurveError, Error};
use crate::mesh::Vertex;
use crate::vector::Vector3;

/// The angle between the points of a carried polyline.
const SPACING: f64 = 0.01;

/// Additional cost of a step per squared distance from the polyline, in edge lengths.
const STRAYING: f64 = 10.0;

/// Distance from its polyline, in edge lengths, beyond which an arc may be in another class.
const FAR: f64 = 10.0;

/// Carries a polyline from the sphere of the source to that of the target, if it can.
pub(super) type Carry<'a> = &'a dyn Fn(&[Vector3]) -> Option<Vec<Vector3>>;

/// The polyline that an arc on the target should follow.
pub(super) struct Guide {
    /// At least two points on its sphere.
    polyline: Vec<Vector3>,
    /// Whether the polyline was carried over from the source.
    is_carried: bool,
}

/// Cuts the source along an arc for each link; returns their vertices.
///
/// # Errors
/// [`CurveError::NoArc`], [`Error::CancelledEarly`].
pub(super) fn source_arcs(
    surface: &mut Cutting,
    links: &[Link],
    watch: &Watch<'_>,
) -> Result<Vec<Vec<Vertex>>, Error> {
    let step = median_edge(&surface.points, &surface.faces);
    let mut room = clearance(surface);
    let mut arcs = Vec::new();
    for link in links {
        goes_on(watch)?;
        let cost = |a, b| surface.length(a, b) * narrowness(&room, a, b, step);
        let arc = cheapest_path(surface, link.from, link.to, cost).ok_or(no_arc(link))?;
        cut(surface, &arc);
        lower_distances(surface, &mut room, &arc);
        arcs.push(arc);
    }
    Ok(arcs)
}

/// The polylines that the arcs on the target should follow: the source's, carried over if possible.
pub(super) fn guides(source: &Cutting, arcs: &[Vec<Vertex>], carry: Carry<'_>) -> Vec<Guide> {
    let guide = |arc: &Vec<Vertex>| {
        let along: Vec<Vector3> = arc.iter().map(|&vertex| source.on_sphere[vertex]).collect();
        let along = resampled(&along, SPACING);
        let is_line = |line: &Vec<Vector3>| line.len() >= 2 && line.iter().all(|x| x.is_finite());
        match carry(&along).filter(is_line) {
            Some(polyline) => Guide { polyline, is_carried: true },
            None => Guide { polyline: along, is_carried: false },
        }
    };
    arcs.iter().map(guide).collect()
}

/// Cuts the target along an arc for each link; returns their vertices, and whether all follow carried
/// polylines.
///
/// # Errors
/// [`CurveError::NoArc`], [`Error::CancelledEarly`].
pub(super) fn target_arcs(
    surface: &mut Cutting,
    links: &[Link],
    guides: Vec<Guide>,
    watch: &Watch<'_>,
) -> Result<(Vec<Vec<Vertex>>, bool), Error> {
    let step = median_edge(&surface.on_sphere, &surface.faces);
    let mut arcs = Vec::new();
    let mut all_followed = true;
    for (link, guide) in links.iter().zip(guides) {
        goes_on(watch)?;
        let (arc, followed) = follow(surface, link, guide, step).ok_or(no_arc(link))?;
        cut(surface, &arc);
        arcs.push(arc);
        all_followed &= followed;
    }
    Ok((arcs, all_followed))
}

/// The path along a guide, and whether it stays near to it and so in its class.
fn follow(surface: &Cutting, link: &Link, guide: Guide, step: f64) -> Option<(Vec<Vertex>, bool)> {
    let Guide { mut polyline, is_carried } = guide;
    let last = polyline.len() - 1;
    polyline[0] = surface.on_sphere[link.from];
    polyline[last] = surface.on_sphere[link.to];
    let line = Polyline::new(polyline);
    let mut known = vec![f64::NAN; surface.points.len()];
    let mut strayed = |vertex: Vertex| {
        let known = &mut known[vertex];
        if known.is_nan() {
            *known = line.distance(surface.on_sphere[vertex]) / step;
        }
        *known
    };
    let space_step = median_edge(&surface.points, &surface.faces);
    let room = (!is_carried).then(|| clearance(surface));
    let cost = |a, b| {
        let narrow = room.as_ref().map_or(1.0, |room| narrowness(room, a, b, space_step));
        let off = 0.5 * (strayed(a) + strayed(b));
        surface.length(a, b) * (narrow + STRAYING * off * off)
    };
    let arc = cheapest_path(surface, link.from, link.to, cost)?;
    let is_near = arc.iter().all(|&vertex| strayed(vertex) <= FAR);
    Some((arc, is_carried && is_near))
}

/// Factor on the cost of an edge: 1 far from the cuts, 11 at a cut.
fn narrowness(room: &[f64], a: Vertex, b: Vertex, step: f64) -> f64 {
    let clear = 0.5 * (room[a] + room[b]);
    1.0 + 3.0 * step / (0.3 * step + clear)
}

/// The distances of all vertices from the cuts.
fn clearance(surface: &Cutting) -> Vec<f64> {
    let mut distances = Vec::new();
    lower_distances(surface, &mut distances, &surface.cut_vertices());
    distances
}

fn cut(surface: &mut Cutting, arc: &[Vertex]) {
    surface.mark(arc, Seam::Arc);
    surface.split_chords(arc);
}

fn no_arc(link: &Link) -> CurveError {
    CurveError::NoArc { curve: link.curve }
}

fn goes_on(watch: &Watch<'_>) -> Result<(), Error> {
    if watch.goes_on() { Ok(()) } else { Err(Error::CancelledEarly) }
}

/// The median length of the faces' sides.
fn median_edge(positions: &[Vector3], faces: &[[Vertex; 3]]) -> f64 {
    let sides = faces.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let mut lengths: Vec<f64> = sides.map(|[a, b]| positions[a].distance(positions[b])).collect();
    let middle = lengths.len() / 2;
    if lengths.is_empty() { 0.0 } else { *lengths.select_nth_unstable_by(middle, f64::total_cmp).1 }
}
