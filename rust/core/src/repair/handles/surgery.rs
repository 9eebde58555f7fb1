// SPDX-License-Identifier: MIT OR Apache-2.0
//! Cuts a surface along loops and closes both sides of each.

use super::closed::ClosedMesh;
use super::crossing::{Sector, sectors};
use super::loops::Loop;
use crate::mesh::{Corner, Vertex};
use crate::repair::draft::Draft;
use crate::repair::holes::close;
use crate::sets::Sets;

/// The shortest of some loops that do not meet and together do not divide the surface.
pub(super) fn shortest_apart(mesh: &ClosedMesh, mut loops: Vec<Loop>) -> Vec<Loop> {
    loops.sort_by(|a, b| a.length.total_cmp(&b.length).then_with(|| a.vertices.cmp(&b.vertices)));
    let mut is_taken = vec![false; mesh.points.len()];
    let mut is_cut = vec![false; 3 * mesh.faces.len()];
    let whole = n_parts(mesh, &is_cut);
    loops.retain(|each| {
        if each.vertices.iter().any(|&vertex| is_taken[vertex]) || has_repeats(&each.vertices) {
            return false;
        }
        let edges = edges(mesh, &each.vertices);
        edges.iter().for_each(|&corner| is_cut[corner] = true);
        let divides = n_parts(mesh, &is_cut) > whole;
        if divides {
            edges.iter().for_each(|&corner| is_cut[corner] = false);
        } else {
            each.vertices.iter().for_each(|&vertex| is_taken[vertex] = true);
        }
        !divides
    });
    loops
}

fn has_repeats(vertices: &[Vertex]) -> bool {
    let mut sorted = vertices.to_vec();
    sorted.sort_unstable();
    sorted.windows(2).any(|pair| pair[0] == pair[1])
}

/// The corners opposite to the edges of a loop, on both sides.
fn edges(mesh: &ClosedMesh, vertices: &[Vertex]) -> Vec<Corner> {
    let n = vertices.len();
    let beside = (0..n).flat_map(|k| {
        let ahead = vertices[(k + 1) % n];
        let leaving = mesh.neighbors(vertices[k]).find(|&(_, neighbor)| neighbor == ahead);
        let corner = leaving.map(|(corner, _)| corner.previous());
        [corner, corner.and_then(|corner| mesh.opposite[corner])]
    });
    beside.flatten().collect()
}

/// The number of parts that a surface falls into along edges.
fn n_parts(mesh: &ClosedMesh, is_cut: &[bool]) -> usize {
    let mut faces = Sets::new(mesh.faces.len());
    let uncut = Corner::all(mesh.faces.len()).filter(|&corner| !is_cut[corner]);
    let joins = uncut.filter(|&corner| {
        let across = mesh.opposite[corner].filter(|&across| across > corner);
        across.is_some_and(|across| faces.join(corner.face().index(), across.face().index()))
    });
    mesh.faces.len() - joins.count()
}

/// Cuts a surface open along a loop and closes both sides.
pub(super) fn cut_open(draft: &mut Draft, mesh: &ClosedMesh, vertices: &[Vertex]) {
    let Some(sectors) = sectors(mesh, vertices) else { return };
    // 1. The right side gets copies of the vertices
    let copies: Vec<Vertex> = vertices.iter().map(|&vertex| draft.copy_vertex(vertex)).collect();
    for (&vertex, &copy) in vertices.iter().zip(&copies) {
        for &corner in mesh.corners.of(vertex) {
            // the face lies counter-clockwise from the edge that leaves at its corner
            if matches!(sectors.get(&corner), Some(Sector::Behind | Sector::Right)) {
                draft.set_corner(corner, copy);
            }
        }
    }
    // 2. The left side has the surface on the left of the loop, the right side on that of its reverse
    let reversed: Vec<Vertex> = copies.into_iter().rev().collect();
    for hole in [vertices, &reversed] {
        close(draft, hole, hole.len() == 3);
        draft.admit_added();
    }
}
