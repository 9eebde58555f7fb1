// SPDX-License-Identifier: MIT OR Apache-2.0
//! The inverse of a harmonic map: the location on the source of each vertex of the target.
//!
//! The image of a face of the source is a geodesic triangle. In the chart of one of its corners the faces of the
//! target that it covers are unfolded, and their vertices inside the triangle lie in that face, at the coordinates
//! in the flat triangle that its corners span on the hyperboloid. Vertices on the boundary are located by their
//! parameters, as in the map itself.
//!
//! Cost: some ten faces of the target for every face of the source.

use super::certificates::image;
use super::chart_map::ChartMap;
use super::initial::segment;
use crate::hyperbolic::moebius::{Complex, Moebius, from_klein, seen_from, to_hyperboloid, to_klein};
use crate::hyperbolic::slice::sliced::Sliced;
use crate::location::Location;
use crate::mesh::{Face, Vertex};
use crate::parallel;
use crate::vector::Vector3;

/// Largest distance outside an edge, in barycentric coordinates, of a vertex that may still belong to a face.
const NEAR: f64 = 1e-9;
/// Most faces of the target that one face of the source may cover.
const MOST_COVERED: usize = 1_000_000;

/// The location in the sliced source of each vertex of the sliced target; `None` if rounding has lost it.
pub(crate) fn inverse(map: &ChartMap<'_>, source: &Sliced, target: &Sliced) -> Vec<Option<Location>> {
    let mut locations = vec![None; target.surface.vertex_of.len()];
    // 1. Inside: the vertices that each face of the source covers; of several faces that in which one lies deepest
    let covered = parallel::map(map.input.faces.len(), |face| covered(map, target, face));
    let mut depth = vec![-NEAR; locations.len()];
    for (face, vertices) in covered.iter().enumerate() {
        for &(vertex, barycentric) in vertices {
            let inside = barycentric.iter().copied().fold(1.0, f64::min);
            if inside > depth[vertex] {
                depth[vertex] = inside;
                locations[vertex] = Some(settled(Face::new(face), barycentric));
            }
        }
    }
    // 2. On the boundary: the same parameter
    let corners = source.disk.boundary_corners();
    let surface_vertex = target.surface_vertices();
    for (ours, theirs) in source.sides.iter().zip(&target.sides).filter(|(side, _)| !side.is_arc) {
        for (&vertex, &s) in theirs.vertices.iter().zip(&theirs.parameters) {
            let (first, t) = segment(&ours.parameters, s);
            let corner = corners.after(ours.vertices[first]);
            locations[surface_vertex[vertex]] = Some(Location::on_edge(corner, t));
        }
    }
    locations
}

fn settled(triangle: Face, barycentric: [f64; 3]) -> Location {
    let clipped = barycentric.map(|weight| weight.max(0.0));
    let sum: f64 = clipped.iter().sum();
    Location { triangle, barycentric: clipped.map(|weight| weight / sum) }
}

/// The vertices of the target in the image of a face of the source, with their coordinates there.
fn covered(map: &ChartMap<'_>, target: &Sliced, face: usize) -> Vec<(Vertex, [f64; 3])> {
    let corners = image(map, &map.input, face);
    // relative to the first corner, where geodesics are straight lines
    let straight = |z: Complex| to_klein(seen_from(corners[0], z));
    let triangle = corners.map(straight);
    let mut vertices: Vec<(Vertex, [f64; 3])> = Vec::new();
    let first = map.places.faces[map.input.faces[face][0]];
    let mut queue = vec![(first, Moebius::default())];
    let mut visited = vec![first];
    while let Some((visited_face, motion)) = queue.pop() {
        let chart = map.atlas.charts[visited_face].map(|z| straight(motion.apply(z)));
        if visited_face != first && !overlap(&triangle, &chart) {
            continue;
        }
        for (k, &place) in chart.iter().enumerate() {
            let vertex = target.surface.faces[visited_face][k];
            if let Some(barycentric) = barycentric(&triangle, place)
                && vertices.iter().all(|&(known, _)| known != vertex)
            {
                vertices.push((vertex, barycentric));
            }
        }
        for corner in visited_face.corners() {
            let Some(across) = target.surface.opposite[corner] else { continue };
            let beyond = across.face();
            if visited.len() < MOST_COVERED && !visited.contains(&beyond) {
                visited.push(beyond);
                queue.push((beyond, motion * map.atlas.transitions[corner].inverse()));
            }
        }
    }
    vertices
}

/// Whether two counterclockwise triangles have a point in common: no edge of either separates them.
fn overlap(a: &[Complex; 3], b: &[Complex; 3]) -> bool {
    let separates = |triangle: &[Complex; 3], points: &[Complex; 3]| {
        (0..3).any(|k| {
            let (from, to) = (triangle[k], triangle[(k + 1) % 3]);
            points.iter().all(|&point| ((to - from).conj() * (point - from)).im < 0.0)
        })
    };
    !separates(a, b) && !separates(b, a)
}

/// The barycentric coordinates of a point of Klein's model in a triangle, as those in the flat triangle on the
/// hyperboloid; `None` if the point is farther outside than [`NEAR`].
fn barycentric(triangle: &[Complex; 3], point: Complex) -> Option<[f64; 3]> {
    let ray = |k: Complex| -> Vector3 { Vector3([k.re, k.im, 1.0]) };
    let [a, b, c] = triangle.map(|corner| to_hyperboloid(from_klein(corner)));
    let x = ray(point);
    let weights = [x.dot(b.cross(c)), x.dot(c.cross(a)), x.dot(a.cross(b))];
    let sum: f64 = weights.iter().sum();
    let weights = weights.map(|weight| weight / sum);
    (sum > 0.0 && weights.iter().all(|&weight| weight > -NEAR)).then_some(weights)
}
