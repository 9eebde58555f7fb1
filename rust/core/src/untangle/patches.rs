// SPDX-License-Identifier: MIT OR Apache-2.0
//! The vertices that may move: few at first, more from round to round.
//!
//! Round 0 frees few vertices that touch all folded faces, by the greedy cover, and among equals those farthest from
//! the mean of their neighbors; round 1 frees all corners of the folded faces; later rounds free 1, 2, 4, 8, … rings
//! around them.

use std::collections::BTreeMap;

use super::positions::Positions;
use crate::mesh::{TriangleMesh, Vertex};

/// Relative difference up to which two distances of vertices from their neighbors are equal.
const MARGIN: f64 = 1e-6;

/// A round that frees whole components.
pub(super) const EVERYTHING: u32 = 62;

/// The vertices that may move in a round.
pub(super) struct Around {
    /// Ascending.
    pub free: Vec<Vertex>,
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

/// Free vertices that touch all folded faces: again and again those that touch the most remaining faces, and of these
/// the ones that stick out more than those beside them. All of several equals are taken, so that no numbering decides.
fn cover(mesh: &TriangleMesh, now: &Positions, held: &[bool], folded: &[usize]) -> Vec<Vertex> {
    let mut remaining = folded.to_vec();
    let mut free = Vec::new();
    loop {
        let mut counts = BTreeMap::new();
        for vertex in remaining.iter().flat_map(|&face| mesh.faces()[face]) {
            if !held[vertex] {
                *counts.entry(vertex).or_insert(0usize) += 1;
            }
        }
        let Some(&most) = counts.values().max() else { break };
        let equals: Vec<(Vertex, f64)> = counts
            .iter()
            .filter(|(_, count)| **count == most)
            .map(|(&vertex, _)| (vertex, now.distance_from_neighbors(mesh, vertex)))
            .collect();
        let chosen = sticking_out(mesh, &equals);
        remaining
            .retain(|&face| !mesh.faces()[face].iter().any(|vertex| chosen.binary_search(vertex).is_ok()));
        free.extend(chosen);
    }
    free.sort_unstable();
    free
}

/// The vertices, of a list (ascending) with distances from the mean of their neighbors, that are no nearer to it than
/// those beside them.
fn sticking_out(mesh: &TriangleMesh, vertices: &[(Vertex, f64)]) -> Vec<Vertex> {
    let distance = |vertex: Vertex| {
        let index = vertices.binary_search_by_key(&vertex, |&(listed, _)| listed);
        index.map_or(0.0, |k| vertices[k].1)
    };
    let is_far = |&&(vertex, distance_here): &&(Vertex, f64)| {
        let corners = mesh.vertex_corners(vertex).iter();
        let beside = corners.flat_map(|&corner| mesh.faces()[corner.face()]);
        beside.map(distance).all(|beside| distance_here >= (1.0 - MARGIN) * beside)
    };
    vertices.iter().filter(is_far).map(|&(vertex, _)| vertex).collect()
}

/// The free vertices within so many rings around the corners of the folded faces.
fn within(mesh: &TriangleMesh, held: &[bool], folded: &[usize], rings: usize) -> Around {
    let mut reached = vec![false; mesh.n_vertices()];
    let mut front: Vec<Vertex> = folded.iter().flat_map(|&face| mesh.faces()[face]).collect();
    for ring in 0..=rings {
        front.retain(|&vertex| !std::mem::replace(&mut reached[vertex], true));
        if front.is_empty() {
            break;
        }
        if ring < rings {
            let corners = front.iter().flat_map(|&vertex| mesh.vertex_corners(vertex));
            front = corners.flat_map(|&corner| mesh.faces()[corner.face()]).collect();
        }
    }
    let free = Vertex::all(mesh.n_vertices()).filter(|&v| reached[v] && !held[v]).collect();
    Around { free, is_all: front.is_empty() && rings > 0 }
}

/// The free vertices (ascending) in sets that share no face, each ascending.
pub(super) fn separate(mesh: &TriangleMesh, free: &[Vertex]) -> Vec<Vec<Vertex>> {
    let mut is_taken = vec![false; free.len()];
    let mut sets = Vec::new();
    for first in 0..free.len() {
        if std::mem::replace(&mut is_taken[first], true) {
            continue;
        }
        let (mut set, mut next) = (vec![free[first]], 0);
        while next < set.len() {
            for &corner in mesh.vertex_corners(set[next]) {
                for vertex in mesh.faces()[corner.face()] {
                    if let Ok(k) = free.binary_search(&vertex)
                        && !std::mem::replace(&mut is_taken[k], true)
                    {
                        set.push(vertex);
                    }
                }
            }
            next += 1;
        }
        set.sort_unstable();
        sets.push(set);
    }
    sets
}
