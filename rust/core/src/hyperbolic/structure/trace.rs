// SPDX-License-Identifier: MIT OR Apache-2.0
//! Closed geodesics on a hyperbolic surface, followed from face to face.
//!
//! A line is given by its ends on the unit circle, and these are carried along from chart to chart. On the way
//! forward errors of the end ahead grow and those of the end behind shrink. So the line is followed twice: first
//! to find the edges that it crosses, which determine exactly how it closes up; then with each end carried in the
//! direction in which it keeps its digits.
//!
//! Input: an atlas, and the ends of the axis of a deck transformation in one of its charts. Cost: linear in
//! the edges crossed.

use crate::hyperbolic::harmonic::atlas::Atlas;
use crate::hyperbolic::moebius::{Complex, Moebius, distance, from_hyperboloid, from_klein, to_hyperboloid};
use crate::hyperbolic::slice::Opened;
use crate::location::Location;
use crate::mesh::{Corner, Face};
use crate::vector::Vector3;

/// Relative tolerance on the length when testing whether the line has closed.
const ROUNDING: f64 = 1e-3;
/// Lengths after which a line that has not closed is lost.
const LOST: f64 = 1.5;

/// A closed geodesic.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ClosedGeodesic {
    /// The locations at which it crosses edges, the first repeated at the end.
    pub places: Vec<Location>,
    /// The length.
    pub length: f64,
}

/// A line in the chart of a face, by its ends: it comes from the first and goes to the second.
type Line = [Complex; 2];

/// Follows the closed geodesic of about the given length along a line in the chart of `face`; `None` if rounding has
/// lost it.
pub(super) fn closed_geodesic(
    atlas: &Atlas<'_>,
    surface: &Opened,
    face: Face,
    line: Line,
    length: f64,
) -> Option<ClosedGeodesic> {
    // 1. The edges that the line crosses
    let walk = atlas.walk(face, middle(line));
    let start = exit(atlas, walk.face, moved(walk.motion, line))?;
    let corners = crossings(atlas, surface, start, moved(walk.motion, line), length)?;
    // 2. The line in each chart, from the isometry that closes it
    let lines = lines(atlas, &corners);
    // 3. The crossings
    let mut places: Vec<Location> =
        corners.iter().zip(&lines).map(|(&corner, &line)| crossing(atlas, corner, line).0).collect();
    places.push(places[0]);
    Some(ClosedGeodesic { places, length: holonomy(atlas, &corners).translation_length() })
}

/// The point of a line nearest to the origin.
fn middle([from, to]: Line) -> Complex {
    from_klein(0.5 * (from + to))
}

/// A line in another chart.
fn moved(motion: Moebius, line: Line) -> Line {
    line.map(|end| on_circle(motion.apply(end)))
}

fn on_circle(end: Complex) -> Complex {
    end / end.norm()
}

/// The height of a point of the hyperboloid above a line, positive on its left.
fn height([from, to]: Line, point: Vector3) -> f64 {
    let chord = to - from;
    let normal = Vector3([from.re, from.im, 1.0]).cross(Vector3([chord.re, chord.im, 0.0]));
    2.0 * normal.dot(point) / chord.norm_sqr()
}

/// The height of a corner's vertex above a line in the chart of its face.
fn corner_height(atlas: &Atlas<'_>, corner: Corner, line: Line) -> f64 {
    height(line, to_hyperboloid(atlas.charts[corner.face()][corner.place()]))
}

/// The corner opposite to the edge through which a line leaves a face; `None` if it misses the face.
fn exit(atlas: &Atlas<'_>, face: Face, line: Line) -> Option<Corner> {
    let is_left = |corner| corner_height(atlas, corner, line) >= 0.0;
    let mut corners = face.corners().into_iter();
    corners.find(|&corner| !is_left(corner.next()) && is_left(corner.previous()))
}

/// The edges that a line crosses, from the edge `start` until it closes; each by the opposite corner in the face that
/// the line leaves.
fn crossings(
    atlas: &Atlas<'_>,
    surface: &Opened,
    start: Corner,
    mut line: Line,
    length: f64,
) -> Option<Vec<Corner>> {
    let (mut corner, mut corners, mut traveled) = (start, Vec::new(), 0.0);
    while traveled < LOST * length {
        if corner == start && traveled > (1.0 - ROUNDING) * length {
            return Some(corners);
        }
        let (across, tau) = (surface.opposite[corner]?, atlas.transitions[corner]);
        let entry = tau.apply(crossing(atlas, corner, line).1);
        corners.push(corner);
        line = moved(tau, line);
        corner = ahead(atlas, surface, across, line);
        traveled += distance(entry, crossing(atlas, corner, line).1);
    }
    None
}

/// The edge through which a line leaves a face that it has entered through another edge.
fn ahead(atlas: &Atlas<'_>, surface: &Opened, entered: Corner, line: Line) -> Corner {
    let (exit, remaining) = if corner_height(atlas, entered, line) >= 0.0 {
        (entered.next(), entered.previous())
    } else {
        (entered.previous(), entered.next())
    };
    // geodesics stay on the surface, but may run so close to the boundary that rounding takes them across
    if surface.opposite[exit].is_none() { remaining } else { exit }
}

/// The isometry from the first chart once around to itself.
fn holonomy(atlas: &Atlas<'_>, corners: &[Corner]) -> Moebius {
    corners.iter().fold(Moebius::default(), |motion, &corner| atlas.transitions[corner] * motion)
}

/// The closed line in the chart of every face that it leaves.
fn lines(atlas: &Atlas<'_>, corners: &[Corner]) -> Vec<Line> {
    // the holonomy moves charts against the direction of the line
    let [to, from] = holonomy(atlas, corners).fixed_points();
    let mut lines = vec![[from, to]; corners.len()];
    for k in 1..corners.len() {
        let tau = atlas.transitions[corners[k - 1]];
        lines[k][0] = on_circle(tau.apply(lines[k - 1][0]));
    }
    let mut end = to;
    for k in (1..corners.len()).rev() {
        end = on_circle(atlas.transitions[corners[k]].inverse().apply(end));
        lines[k][1] = end;
    }
    lines
}

/// The point at which a line crosses the edge opposite to a corner: its location on the flat face and its position in
/// the chart.
fn crossing(atlas: &Atlas<'_>, corner: Corner, line: Line) -> (Location, Complex) {
    let ends = [corner.next(), corner.previous()];
    let [right, left] = ends.map(|corner| corner_height(atlas, corner, line));
    let weights = [left.max(f64::MIN_POSITIVE), (-right).max(f64::MIN_POSITIVE)];
    let [from, to] = [0, 1].map(|k| {
        let (face, corner) = (ends[k].face(), ends[k].place());
        (to_hyperboloid(atlas.charts[face][corner]), weights[k] / atlas.mu[face][corner])
    });
    let place = Location::on_edge(corner, to.1 / (from.1 + to.1));
    (place, from_hyperboloid(from.0 * weights[0] + to.0 * weights[1]))
}
