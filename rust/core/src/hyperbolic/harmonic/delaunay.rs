// SPDX-License-Identifier: MIT OR Apache-2.0
//! The intrinsic Delaunay triangulation of a hyperbolic surface, whose cotangent weights are nonnegative.
//!
//! Edges are flipped within the metric; vertices and metric stay (Bobenko & Springborn 2007). The Euclidean
//! triangles of the chords 2 sinh(l/2), which have the same circumcircles, decide whether an edge is locally
//! Delaunay, and their cotangents are the weights of the harmonic energy.
//!
//! Edges can share both ends or go from a vertex to itself, so all data are stored by half-edge. No flip makes an
//! edge between two boundary vertices: the map would put it into the boundary.
//!
//! Cost: O(m) flips in practice.

use crate::hyperbolic::moebius::Moebius;
use crate::hyperbolic::slice::Opened;
use crate::mesh::{Corner, Face, Vertex};

/// An edge is flipped if its cotangents sum to less than minus this.
const CONVEX: f64 = 1e-9;
/// Least distance to π of the angles of a quadrilateral that is flipped.
const STRAIGHT: f64 = 1e-12;
/// Least weight of an edge.
const LEAST_WEIGHT: f64 = 1e-4;
/// Least weight of an edge that may not be flipped.
const LEAST_KEPT: f64 = 1e-2;
/// Area of a triangle of chords that has none, relative to the square of its longest edge.
const LEAST_AREA: f64 = 1e-3;

/// A triangulation by half-edges: corner 3 f + k stands for the edge opposite to vertex k of face f.
#[derive(Debug, Clone)]
pub(crate) struct Net {
    /// (m, 3): the vertices of the faces.
    pub faces: Vec<[Vertex; 3]>,
    /// (3 m,): the opposite corners.
    pub opposite: Vec<Option<Corner>>,
    /// (3 m,): the isometry from the chart of an edge's head to that of its tail; its face runs from tail to head.
    pub transitions: Vec<Moebius>,
}

/// A triangulation with the weight and the length of each corner's edge, equal on both sides.
pub(crate) struct Weighted {
    pub net: Net,
    pub weights: Vec<f64>,
    pub lengths: Vec<f64>,
}

impl Net {
    /// The triangulation of `surface` itself.
    pub(crate) fn new(surface: &Opened, transitions: Vec<Moebius>) -> Self {
        Self { faces: surface.faces.clone(), opposite: surface.opposite.clone(), transitions }
    }

    /// The tail and the head of the edge of a corner.
    pub(crate) fn ends(&self, corner: Corner) -> [Vertex; 2] {
        corner.half_edge(&self.faces)
    }
}

/// Flips the edges of a net, of the given `lengths`, to the Delaunay triangulation of their metric; returns it with
/// weights and lengths.
///
/// Faces that are `kept` stay: weights of their edges that are not positive are raised.
pub(crate) fn delaunay(mut net: Net, lengths: &[[f64; 3]], kept: &[bool]) -> Weighted {
    let mut lengths: Vec<f64> = lengths.iter().flatten().copied().collect();
    let is_boundary = boundary_vertices(&net);
    // 1. Flips until every edge is Delaunay
    let is_first = |corner: &Corner| net.opposite[*corner].is_none_or(|across| *corner < across);
    let mut queue: Vec<Corner> = Corner::all(net.faces.len()).rev().filter(is_first).collect();
    let mut is_queued = vec![false; lengths.len()];
    queue.iter().for_each(|&corner| is_queued[corner] = true);
    let mut flips_left = 100 * lengths.len();
    while let Some(corner) = queue.pop() {
        is_queued[corner] = false;
        let is_kept = |corner: Corner| kept[corner.face()];
        let may_flip = flips_left > 0 && !is_kept(corner) && !net.opposite[corner].is_some_and(is_kept);
        if !may_flip || !should_flip(&net, &lengths, &is_boundary, corner) {
            continue;
        }
        flips_left -= 1;
        for around in flip(&mut net, &mut lengths, corner) {
            let Some(across) = net.opposite[around] else { continue };
            let edge = around.min(across);
            if !is_queued[edge] {
                is_queued[edge] = true;
                queue.push(edge);
            }
        }
    }
    // 2. Weights
    let halves: Vec<f64> = Face::all(net.faces.len()).flat_map(|face| cotangents(&lengths, face)).collect();
    let weight = |corner: Corner| match net.opposite[corner] {
        None => 0.5 * halves[corner],
        Some(across) => 0.5 * (halves[corner] + halves[across]),
    };
    let is_kept = |corner: Corner| {
        kept[corner.face()] || net.opposite[corner].is_some_and(|across| kept[across.face()])
    };
    let least = |corner: Corner| if is_kept(corner) { LEAST_KEPT } else { LEAST_WEIGHT };
    let weights = Corner::all(net.faces.len()).map(|corner| weight(corner).max(least(corner))).collect();
    Weighted { net, weights, lengths }
}

fn boundary_vertices(net: &Net) -> Vec<bool> {
    let n_vertices = net.faces.iter().flatten().max().map_or(0, |&last| last.index() + 1);
    let mut is_boundary = vec![false; n_vertices];
    for corner in Corner::all(net.faces.len()).filter(|&corner| net.opposite[corner].is_none()) {
        net.ends(corner).iter().for_each(|&vertex| is_boundary[vertex] = true);
    }
    is_boundary
}

/// Whether an edge is not Delaunay and may be flipped.
fn should_flip(net: &Net, lengths: &[f64], is_boundary: &[bool], corner: Corner) -> bool {
    let Some(across) = net.opposite[corner].filter(|across| across.face() != corner.face()) else {
        return false;
    };
    let is_on_boundary = |corner: Corner| is_boundary[corner.vertex(&net.faces)];
    let (ours, theirs) = (chords(lengths, corner), chords(lengths, across));
    // the cosines of the opposite angles, doubled; their sum has the sign of that of the cotangents
    let cosine = |[e, a, b]: [f64; 3]| (a * a + b * b - e * e) / (a * b);
    if cosine(ours) + cosine(theirs) >= -CONVEX || is_on_boundary(corner) && is_on_boundary(across) {
        return false;
    }
    let [at_tail, at_head] = angles_at_ends(lengths, corner);
    let [at_head_across, at_tail_across] = angles_at_ends(lengths, across);
    let straight = std::f64::consts::PI - STRAIGHT;
    at_tail + at_tail_across < straight && at_head + at_head_across < straight
}

/// Flips the edge of a corner; returns the corners of the four edges around it.
///
/// Faces (p, i, j) and (q, j, i) become (p, i, q) and (q, j, p).
fn flip(net: &mut Net, lengths: &mut [f64], corner: Corner) -> [Corner; 4] {
    let across = net.opposite[corner].expect("an edge that is flipped has two faces");
    // edges j → p and p → i of the first face, i → q and q → j of the second
    let (jp, pi) = (corner.next(), corner.previous());
    let (iq, qj) = (across.next(), across.previous());
    let [p, q] = [corner, across].map(|corner| corner.vertex(&net.faces));
    let [i, j] = net.ends(corner);
    let length = diagonal(lengths, corner, across);
    let kept = [iq, pi, jp, qj].map(|c| (net.opposite[c], lengths[c], net.transitions[c]));
    let new_transition = net.transitions[iq].inverse() * net.transitions[pi].inverse();
    let (f, g) = (corner.face(), across.face());
    net.faces[f] = [p, i, q];
    net.faces[g] = [q, j, p];
    let places = [f.corner(0), f.corner(2), g.corner(0), g.corner(2)];
    // two of the four edges may be glued to each other; then each has to follow its partner
    let moved = |old: Corner| match [iq, pi, jp, qj].iter().position(|&corner| corner == old) {
        Some(k) => places[k],
        None => old,
    };
    for (&place, (opposite, length, transition)) in places.iter().zip(kept) {
        net.opposite[place] = opposite.map(moved);
        if let Some(opposite) = net.opposite[place] {
            net.opposite[opposite] = Some(place);
        }
        lengths[place] = length;
        net.transitions[place] = transition;
    }
    // the new edge: q → p in the first face, p → q in the second
    let (ours, theirs) = (f.corner(1), g.corner(1));
    (net.opposite[ours], net.opposite[theirs]) = (Some(theirs), Some(ours));
    (lengths[ours], lengths[theirs]) = (length, length);
    net.transitions[ours] = new_transition;
    net.transitions[theirs] = new_transition.inverse();
    places
}

/// The lengths of an edge and of the two edges after it in its face.
fn sides(lengths: &[f64], corner: Corner) -> [f64; 3] {
    [corner, corner.next(), corner.previous()].map(|corner| lengths[corner])
}

/// The chords of an edge and of the two edges after it in its face.
fn chords(lengths: &[f64], corner: Corner) -> [f64; 3] {
    sides(lengths, corner).map(|length| 2.0 * (0.5 * length).sinh())
}

/// The angles at the tail and at the head of an edge in its face.
fn angles_at_ends(lengths: &[f64], corner: Corner) -> [f64; 2] {
    // edge i → j of the face (p, i, j): j → p is opposite to i, p → i to j
    let [ij, jp, pi] = sides(lengths, corner);
    [angle(jp, pi, ij), angle(pi, ij, jp)]
}

/// The angle between sides `b` and `c` of a hyperbolic triangle, opposite to `a`.
fn angle(a: f64, b: f64, c: f64) -> f64 {
    let s = 0.5 * (a + b + c);
    let [near, far] = [(s - b).max(0.0).sinh() * (s - c).max(0.0).sinh(), s.sinh() * (s - a).max(0.0).sinh()];
    2.0 * near.sqrt().atan2(far.sqrt())
}

/// The length of the other diagonal of the two faces at an edge, from the angle between two sides at its tail.
fn diagonal(lengths: &[f64], corner: Corner, across: Corner) -> f64 {
    let [_, _, pi] = sides(lengths, corner);
    let [_, iq, _] = sides(lengths, across);
    let between = angles_at_ends(lengths, corner)[0] + angles_at_ends(lengths, across)[1];
    let half_sine = (0.5 * between).sin();
    let square = (0.5 * (pi - iq)).sinh().powi(2) + pi.sinh() * iq.sinh() * half_sine * half_sine;
    2.0 * square.sqrt().asinh()
}

/// The cotangents of the angles of a face's triangle of chords.
fn cotangents(lengths: &[f64], face: Face) -> [f64; 3] {
    let [a, b, c] = chords(lengths, face.corner(0));
    let longest = a.max(b).max(c);
    let s = 0.5 * (a + b + c);
    let heron = (s * (s - a) * (s - b) * (s - c)).max(0.0).sqrt();
    // chords of a hyperbolic sliver need not satisfy the triangle inequality
    let area = heron.max(if heron > 0.0 { 0.0 } else { LEAST_AREA * longest * longest });
    [b * b + c * c - a * a, c * c + a * a - b * b, a * a + b * b - c * c].map(|twice| twice / (4.0 * area))
}
