// SPDX-License-Identifier: MIT OR Apache-2.0
//! Which vertices may move: few at first, more from round to round.
//!
//! Round 0 frees the fewest vertices that touch all folded faces, by the greedy cover, and among equals those that stick
//! out the most from between their neighbors; round 1 all corners of these; then come 1, 2, 4, 8, … rings around them.

use std::collections::BTreeMap;

use super::positions::Positions;
use crate::mesh::TriangleMesh;

/// Vertices that stick out by the same but for this part of it are equals.
const MARGIN: f64 = 1e-6;

/// The round that frees whole components.
pub(super) const EVERYTHING: u32 = 62;

/// The vertices that may move in a round.
pub(super) struct Around {
    /// Ascending.
    pub free: Vec<u32>,
    /// Whether no further round frees more.
    pub is_all: bool,
}

/// The vertices around the folded faces that may move in a round.
pub(super) fn around(
    mesh: &TriangleMesh,
    now: &Positions,
    held: &[bool],
    folded: &[usize],
    round: u32,
) -> Around {
    match round {
        0 => Around { free: cover(mesh, now, held, folded), is_all: false },
        _ => {
            let rings = if round == 1 { 0 } else { 1usize << (round - 2).min(60) };
            within(mesh, held, folded, rings)
        }
    }
}

/// Free vertices that touch all folded faces: again and again those that touch the most of the remaining ones, and of
/// these the ones that stick out more than those beside them. Of equals all are taken, so that no numbering decides.
fn cover(mesh: &TriangleMesh, now: &Positions, held: &[bool], folded: &[usize]) -> Vec<u32> {
    let mut left = folded.to_vec();
    let mut free = Vec::new();
    loop {
        let mut counts = BTreeMap::new();
        for vertex in left.iter().flat_map(|&face| mesh.faces()[face]) {
            if !held[vertex as usize] {
                *counts.entry(vertex).or_insert(0usize) += 1;
            }
        }
        let Some(&most) = counts.values().max() else { break };
        let equals: Vec<(u32, f64)> = counts
            .iter()
            .filter(|(_, count)| **count == most)
            .map(|(&vertex, _)| (vertex, now.distance_from_neighbors(mesh, vertex)))
            .collect();
        let chosen = sticking_out(mesh, &equals);
        left.retain(|&face| !mesh.faces()[face].iter().any(|vertex| chosen.binary_search(vertex).is_ok()));
        free.extend(chosen);
    }
    free.sort_unstable();
    free
}

/// The vertices that are farther from the middle of their neighbors than those beside them, out of a list (ascending) with
/// these distances.
fn sticking_out(mesh: &TriangleMesh, vertices: &[(u32, f64)]) -> Vec<u32> {
    let distance = |vertex: u32| {
        let found = vertices.binary_search_by_key(&vertex, |&(other, _)| other);
        found.map_or(0.0, |k| vertices[k].1)
    };
    let is_far = |&&(vertex, own): &&(u32, f64)| {
        let corners = mesh.vertex_corners(vertex as usize).iter();
        let beside = corners.flat_map(|&corner| mesh.faces()[corner as usize / 3]);
        beside.map(distance).all(|other| own >= (1.0 - MARGIN) * other)
    };
    vertices.iter().filter(is_far).map(|&(vertex, _)| vertex).collect()
}

/// Free vertices at most so many edges away from the corners of the folded faces.
fn within(mesh: &TriangleMesh, held: &[bool], folded: &[usize], rings: usize) -> Around {
    let mut reached = vec![false; mesh.n_vertices()];
    let mut front: Vec<u32> = folded.iter().flat_map(|&face| mesh.faces()[face]).collect();
    for ring in 0..=rings {
        front.retain(|&vertex| !std::mem::replace(&mut reached[vertex as usize], true));
        if front.is_empty() {
            break;
        }
        if ring < rings {
            let corners = front.iter().flat_map(|&vertex| mesh.vertex_corners(vertex as usize));
            front = corners.flat_map(|&corner| mesh.faces()[corner as usize / 3]).collect();
        }
    }
    let free = (0..mesh.n_vertices()).filter(|&v| reached[v] && !held[v]).map(|v| v as u32).collect();
    Around { free, is_all: front.is_empty() && rings > 0 }
}

/// The parts of free vertices (ascending) that share no face, each ascending.
pub(super) fn parts(mesh: &TriangleMesh, free: &[u32]) -> Vec<Vec<u32>> {
    let mut is_taken = vec![false; free.len()];
    let mut parts = Vec::new();
    for first in 0..free.len() {
        if std::mem::replace(&mut is_taken[first], true) {
            continue;
        }
        let (mut part, mut next) = (vec![free[first]], 0);
        while next < part.len() {
            for &corner in mesh.vertex_corners(part[next] as usize) {
                for vertex in mesh.faces()[corner as usize / 3] {
                    if let Ok(k) = free.binary_search(&vertex)
                        && !std::mem::replace(&mut is_taken[k], true)
                    {
                        part.push(vertex);
                    }
                }
            }
            next += 1;
        }
        part.sort_unstable();
        parts.push(part);
    }
    parts
}
