// SPDX-License-Identifier: MIT OR Apache-2.0
//! Splits edges of three or more faces, and vertices in which parts only touch (A. Guéziec, G. Taubin, F. Lazarus,
//! B. Horn, Cutting and stitching: converting sets of polygons to manifold surfaces, IEEE TVCG 2001).
//!
//! 1. The faces around an edge of three or more are sorted by angle. Two that are next to each other and have the
//!    inside of the body between them belong together; so parts of a body that touch in an edge come apart. Where faces
//!    bound no body, as at an inner wall, those that lie most nearly in one plane belong together, and the others have
//!    an open edge there.
//! 2. Each fan of faces around a vertex gets a vertex of its own.
//! 3. Where two pairs of faces still have both ends of their edge in common, each pair gets a vertex in the middle of it.
//!
//! Cost: a sort of the edges.

use std::f64::consts::PI;

use super::draft::Draft;
use crate::mesh::geometry::area_vector;
use crate::mesh::orientation::Orientation;
use crate::mesh::ties::first_smallest;
use crate::mesh::{Corner, EdgeTable, Face, Vertex, VertexCorners, fans};
use crate::vector::Vector3;

/// How many elements were split.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Split {
    /// Edges of three or more faces.
    pub edges: usize,
    /// Vertices with several fans of faces.
    pub vertices: usize,
}

/// Makes the mesh a manifold.
pub(super) fn split_sheets(draft: &mut Draft) -> Split {
    // 1. Which faces belong together
    let table = EdgeTable::new(draft.points.len(), &draft.faces);
    let mut opposite = table.opposites();
    let edges = pair_faces(draft, &table, &mut opposite);
    // 2. A vertex for each fan
    let vertices = split_vertices(draft, &opposite);
    // 3. Edges that are still the same
    if edges > 0 {
        split_edges(draft, &opposite);
    }
    Split { edges, vertices }
}

/// Pairs the faces at edges of three or more; returns the number of these edges.
fn pair_faces(draft: &Draft, table: &EdgeTable, opposite: &mut [Option<Corner>]) -> usize {
    let crowded: Vec<_> = table.edges().filter(|(_, corners)| corners.len() > 2).collect();
    if crowded.is_empty() {
        return 0;
    }
    let outward = outward_faces(draft, opposite);
    for ([low, high], corners) in &crowded {
        let around = Around { draft, outward: &outward, low: *low, high: *high };
        for [first, second] in around.pairs(corners.iter().map(|entry| entry.corner())) {
            opposite[first] = Some(second);
            opposite[second] = Some(first);
        }
    }
    crowded.len()
}

/// Whether each face looks outward as it is, by the orientation of most faces and the sign of the volume.
fn outward_faces(draft: &Draft, opposite: &[Option<Corner>]) -> Vec<bool> {
    let flipped = Orientation::propagate(&draft.faces, opposite).flipped;
    let volume = |face: usize| {
        let corners = draft.corners(face);
        corners[0].dot(area_vector(corners)) * if flipped[face] { -1.0 } else { 1.0 }
    };
    let is_inside_out = (0..draft.faces.len()).map(volume).sum::<f64>() < 0.0;
    flipped.into_iter().map(|flipped| flipped == is_inside_out).collect()
}

/// The faces around an edge.
struct Around<'a> {
    draft: &'a Draft,
    outward: &'a [bool],
    low: Vertex,
    high: Vertex,
}

impl Around<'_> {
    /// The pairs of corners, opposite to the edge, whose faces belong together.
    fn pairs(&self, corners: impl Iterator<Item = Corner>) -> Vec<[Corner; 2]> {
        let mut sorted: Vec<(f64, Corner)> = corners.map(|corner| (self.angle(corner), corner)).collect();
        sorted.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let (ends, begins): (Vec<_>, Vec<_>) = sorted.iter().partition(|(_, corner)| self.looks_on(*corner));
        if ends.len() == begins.len() { self.around_inside(&sorted) } else { flattest(begins, ends) }
    }

    /// Pairs with the inside between them: it begins after a face that looks back, and ends before one that looks on.
    fn around_inside(&self, sorted: &[(f64, Corner)]) -> Vec<[Corner; 2]> {
        let mut begun: Vec<Corner> = Vec::new();
        let mut pairs: Vec<[Corner; 2]> = Vec::new();
        // two turns, since the inside may lie across the angle where the order begins
        for &(_, corner) in sorted.iter().chain(sorted) {
            if begun.contains(&corner) || pairs.iter().flatten().any(|&paired| paired == corner) {
                continue;
            }
            if !self.looks_on(corner) {
                begun.push(corner);
            } else if let Some(first) = begun.pop() {
                pairs.push([first, corner]);
            }
        }
        pairs
    }

    /// The angle about the edge, from its lower to its higher end, of the direction in which a corner lies.
    fn angle(&self, corner: Corner) -> f64 {
        let points = &self.draft.points;
        let axis = (points[self.high] - points[self.low]).normalized();
        // any direction across the axis
        let flattest = (0..3).min_by(|&j, &k| axis[j].abs().total_cmp(&axis[k].abs())).unwrap_or_default();
        let across = Vector3::unit(flattest).cross(axis).normalized();
        let direction = points[corner.vertex(&self.draft.faces)] - points[self.low];
        direction.dot(axis.cross(across)).atan2(direction.dot(across))
    }

    /// Whether a face, turned outward, looks to where angles are larger.
    fn looks_on(&self, corner: Corner) -> bool {
        let runs_up = corner.half_edge(&self.draft.faces)[0] == self.low;
        runs_up == self.outward[corner.face()]
    }
}

/// Pairs of faces that look to different sides, those that lie most nearly in one plane first, where some faces remain
/// without a partner.
fn flattest(mut begins: Vec<(f64, Corner)>, mut ends: Vec<(f64, Corner)>) -> Vec<[Corner; 2]> {
    let bend = |a: f64, b: f64| ((a - b).abs() - PI).abs();
    let mut pairs = Vec::new();
    loop {
        let all: Vec<_> = (0..begins.len()).flat_map(|i| (0..ends.len()).map(move |j| (i, j))).collect();
        // beside 1, so that bends near 0 are equal too
        let bends = all.iter().map(|&(i, j)| 1.0 + bend(begins[i].0, ends[j].0));
        let Some(flattest) = first_smallest(bends) else { return pairs };
        let (i, j) = all[flattest];
        pairs.push([begins.remove(i).1, ends.remove(j).1]);
    }
}

/// Gives each fan of faces around a vertex a vertex of its own; returns the number of copies.
fn split_vertices(draft: &mut Draft, opposite: &[Option<Corner>]) -> usize {
    let mut fans = fans(&draft.faces, opposite);
    let corners = VertexCorners::new(draft.points.len(), &draft.faces);
    let mut copies = 0;
    for vertex in Vertex::all(corners.len()) {
        // the vertex of each fan met so far, by the fan's root
        let mut numbers: Vec<(usize, Vertex)> = Vec::new();
        for &corner in corners.of(vertex) {
            let root = fans.root(corner.index());
            let known = numbers.iter().find(|(fan, _)| *fan == root).map(|&(_, number)| number);
            let number = known.unwrap_or_else(|| {
                let number = if numbers.is_empty() { vertex } else { draft.copy_vertex(vertex) };
                numbers.push((root, number));
                number
            });
            draft.set_corner(corner, number);
        }
        copies += numbers.len().saturating_sub(1);
    }
    copies
}

/// Gives each pair of faces a vertex in the middle of its edge where several pairs have the same edge.
fn split_edges(draft: &mut Draft, opposite: &[Option<Corner>]) {
    let table = EdgeTable::new(draft.points.len(), &draft.faces);
    let mut middles: Vec<Option<Vertex>> = vec![None; 3 * draft.faces.len()];
    for ([low, high], corners) in table.edges().filter(|(_, corners)| corners.len() > 2) {
        for corner in corners.iter().map(|entry| entry.corner()) {
            if middles[corner].is_some() {
                continue;
            }
            let middle = Vertex::new(draft.points.len());
            draft.points.push((draft.points[low] + draft.points[high]) * 0.5);
            draft.vertex_of.push(None);
            for corner in [Some(corner), opposite[corner]].into_iter().flatten() {
                middles[corner] = Some(middle);
            }
        }
    }
    for face in Face::all(middles.len() / 3) {
        let parts = parts(draft.faces[face], face.corners().map(|corner| middles[corner]));
        draft.faces[face] = parts[0];
        for &part in &parts[1..] {
            draft.faces.push(part);
            draft.face_of.push(draft.face_of[face]);
            draft.turned.push(draft.turned[face]);
        }
    }
}

/// The parts of a face with points in the middles of some edges, each opposite to a corner.
fn parts(face: [Vertex; 3], middles: [Option<Vertex>; 3]) -> Vec<[Vertex; 3]> {
    let [a, b, c] = face;
    match middles {
        [None, None, None] => vec![face],
        [Some(m), None, None] => vec![[a, b, m], [a, m, c]],
        [Some(m), Some(n), None] => vec![[c, n, m], [n, a, b], [n, b, m]],
        [Some(m), Some(n), Some(o)] => vec![[a, o, n], [b, m, o], [c, n, m], [m, n, o]],
        [m, n, o] => parts([b, c, a], [n, o, m]),
    }
}
