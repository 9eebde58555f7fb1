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
use crate::mesh::{NO_CORNER, Vertex};

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
    pub opposite: Vec<u32>,
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
    pub(crate) fn ends(&self, corner: usize) -> [Vertex; 2] {
        let face = self.faces[corner / 3];
        [face[(corner + 1) % 3], face[(corner + 2) % 3]].map(|v| v)
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
    let mut queue: Vec<u32> =
        (0..lengths.len() as u32).rev().filter(|&c| c < net.opposite[c as usize]).collect();
    let mut is_queued = vec![false; lengths.len()];
    queue.iter().for_each(|&corner| is_queued[corner as usize] = true);
    let mut flips_left = 100 * lengths.len();
    while let Some(corner) = queue.pop() {
        is_queued[corner as usize] = false;
        let is_kept = |corner: u32| corner != NO_CORNER && kept[corner as usize / 3];
        let may_flip = flips_left > 0 && !is_kept(corner) && !is_kept(net.opposite[corner as usize]);
        if !may_flip || !should_flip(&net, &lengths, &is_boundary, corner as usize) {
            continue;
        }
        flips_left -= 1;
        for around in flip(&mut net, &mut lengths, corner as usize) {
            let edge = around.min(net.opposite[around as usize]);
            if net.opposite[around as usize] != NO_CORNER && !is_queued[edge as usize] {
                is_queued[edge as usize] = true;
                queue.push(edge);
            }
        }
    }
    // 2. Weights
    let halves: Vec<f64> = (0..net.faces.len()).flat_map(|face| cotangents(&lengths, face)).collect();
    let weight = |corner: usize| match net.opposite[corner] {
        NO_CORNER => 0.5 * halves[corner],
        across => 0.5 * (halves[corner] + halves[across as usize]),
    };
    let is_kept = |corner: usize| {
        kept[corner / 3] || net.opposite[corner] != NO_CORNER && kept[net.opposite[corner] as usize / 3]
    };
    let least = |corner: usize| if is_kept(corner) { LEAST_KEPT } else { LEAST_WEIGHT };
    let weights = (0..halves.len()).map(|corner| weight(corner).max(least(corner))).collect();
    Weighted { net, weights, lengths }
}

fn boundary_vertices(net: &Net) -> Vec<bool> {
    let n_vertices = net.faces.iter().flatten().max().map_or(0, |&last| last.index() + 1);
    let mut is_boundary = vec![false; n_vertices];
    for corner in (0..net.opposite.len()).filter(|&corner| net.opposite[corner] == NO_CORNER) {
        net.ends(corner).iter().for_each(|&vertex| is_boundary[vertex] = true);
    }
    is_boundary
}

/// Whether an edge is not Delaunay and may be flipped.
fn should_flip(net: &Net, lengths: &[f64], is_boundary: &[bool], corner: usize) -> bool {
    let across = net.opposite[corner];
    if across == NO_CORNER || across as usize / 3 == corner / 3 {
        return false;
    }
    let across = across as usize;
    let is_on_boundary = |corner: usize| is_boundary[net.faces[corner / 3][corner % 3]];
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
fn flip(net: &mut Net, lengths: &mut [f64], corner: usize) -> [u32; 4] {
    let next = |corner: usize| corner - corner % 3 + (corner + 1) % 3;
    let across = net.opposite[corner] as usize;
    // edges j → p and p → i of the first face, i → q and q → j of the second
    let (jp, pi) = (next(corner), next(next(corner)));
    let (iq, qj) = (next(across), next(next(across)));
    let [p, q] = [corner, across].map(|corner| net.faces[corner / 3][corner % 3]);
    let [i, j] = net.ends(corner);
    let length = diagonal(lengths, corner, across);
    let kept = [iq, pi, jp, qj].map(|c| (net.opposite[c], lengths[c], net.transitions[c]));
    let new_transition = net.transitions[iq].inverse() * net.transitions[pi].inverse();
    let (f, g) = (corner / 3, across / 3);
    net.faces[f] = [p, i, q];
    net.faces[g] = [q, j, p];
    let places = [3 * f, 3 * f + 2, 3 * g, 3 * g + 2];
    // two of the four edges may be glued to each other; then each has to follow its partner
    let moved = |old: u32| match [iq, pi, jp, qj].iter().position(|&c| c as u32 == old) {
        Some(k) => places[k] as u32,
        None => old,
    };
    for (&place, (opposite, length, transition)) in places.iter().zip(kept) {
        net.opposite[place] = if opposite == NO_CORNER { NO_CORNER } else { moved(opposite) };
        if opposite != NO_CORNER {
            net.opposite[moved(opposite) as usize] = place as u32;
        }
        lengths[place] = length;
        net.transitions[place] = transition;
    }
    // the new edge: q → p in the first face, p → q in the second
    let (ours, theirs) = (3 * f + 1, 3 * g + 1);
    (net.opposite[ours], net.opposite[theirs]) = (theirs as u32, ours as u32);
    (lengths[ours], lengths[theirs]) = (length, length);
    net.transitions[ours] = new_transition;
    net.transitions[theirs] = new_transition.inverse();
    places.map(|place| place as u32)
}

/// The lengths of an edge and of the two edges after it in its face.
fn sides(lengths: &[f64], corner: usize) -> [f64; 3] {
    let first = corner - corner % 3;
    [0, 1, 2].map(|step| lengths[first + (corner + step) % 3])
}

/// The chords of an edge and of the two edges after it in its face.
fn chords(lengths: &[f64], corner: usize) -> [f64; 3] {
    sides(lengths, corner).map(|length| 2.0 * (0.5 * length).sinh())
}

/// The angles at the tail and at the head of an edge in its face.
fn angles_at_ends(lengths: &[f64], corner: usize) -> [f64; 2] {
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
fn diagonal(lengths: &[f64], corner: usize, across: usize) -> f64 {
    let [_, _, pi] = sides(lengths, corner);
    let [_, iq, _] = sides(lengths, across);
    let between = angles_at_ends(lengths, corner)[0] + angles_at_ends(lengths, across)[1];
    let half_sine = (0.5 * between).sin();
    let square = (0.5 * (pi - iq)).sinh().powi(2) + pi.sinh() * iq.sinh() * half_sine * half_sine;
    2.0 * square.sqrt().asinh()
}

/// The cotangents of the angles of a face's triangle of chords.
fn cotangents(lengths: &[f64], face: usize) -> [f64; 3] {
    let [a, b, c] = chords(lengths, 3 * face);
    let longest = a.max(b).max(c);
    let s = 0.5 * (a + b + c);
    let heron = (s * (s - a) * (s - b) * (s - c)).max(0.0).sqrt();
    // chords of a hyperbolic sliver need not satisfy the triangle inequality
    let area = heron.max(if heron > 0.0 { 0.0 } else { LEAST_AREA * longest * longest });
    [b * b + c * c - a * a, c * c + a * a - b * b, a * a + b * b - c * c].map(|twice| twice / (4.0 * area))
}
