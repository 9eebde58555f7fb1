// SPDX-License-Identifier: MIT OR Apache-2.0
//! Cuts a surface along loops and closes both sides of each.

use std::collections::VecDeque;

use super::closed::ClosedMesh;
use super::crossing::{Sector, sectors};
use super::loops::Loop;
use crate::mesh::{Corner, Vertex};
use crate::repair::draft::Draft;
use crate::repair::holes::close;

/// The shortest of some loops that do not meet and together do not divide the surface.
pub(super) fn shortest_apart(mesh: &ClosedMesh, mut loops: Vec<Loop>) -> Vec<Loop> {
    loops.sort_by(|a, b| a.length.total_cmp(&b.length).then_with(|| a.vertices.cmp(&b.vertices)));
    let mut is_taken = vec![false; mesh.points.len()];
    let mut floods = Floods::new(mesh);
    loops.retain(|each| {
        if each.vertices.iter().any(|&vertex| is_taken[vertex]) || has_repeats(&each.vertices) {
            return false;
        }
        let edges = edges(mesh, &each.vertices);
        edges.iter().for_each(|&corner| floods.is_cut[corner] = true);
        let divides = floods.are_apart(edges[0]);
        if divides {
            edges.iter().for_each(|&corner| floods.is_cut[corner] = false);
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

/// Floods of a surface that is cut along edges.
struct Floods<'a> {
    mesh: &'a ClosedMesh,
    /// Whether the edge opposite to each corner is cut.
    is_cut: Vec<bool>,
    /// The last flood that reached each face.
    flood_of: Vec<u32>,
    n_floods: u32,
}

impl<'a> Floods<'a> {
    fn new(mesh: &'a ClosedMesh) -> Self {
        let (is_cut, flood_of) = (vec![false; 3 * mesh.faces.len()], vec![0; mesh.faces.len()]);
        Self { mesh, is_cut, flood_of, n_floods: 0 }
    }

    /// Whether no path leads from one side of a cut edge to the other. Floods from both sides take turns, so that the
    /// cost is that of the nearer end.
    fn are_apart(&mut self, cut: Corner) -> bool {
        let floods = [self.n_floods + 1, self.n_floods + 2];
        self.n_floods += 2;
        let Some(across) = self.mesh.opposite[cut] else { return true };
        let mut pending = [cut, across].map(|corner| VecDeque::from([corner.face()]));
        self.flood_of[cut.face()] = floods[0];
        self.flood_of[across.face()] = floods[1];
        loop {
            for side in [0, 1] {
                let Some(face) = pending[side].pop_front() else { return true };
                for corner in face.corners().into_iter().filter(|&corner| !self.is_cut[corner]) {
                    let Some(neighbor) = self.mesh.opposite[corner].map(Corner::face) else { continue };
                    if self.flood_of[neighbor] == floods[1 - side] {
                        return false;
                    }
                    if self.flood_of[neighbor] != floods[side] {
                        self.flood_of[neighbor] = floods[side];
                        pending[side].push_back(neighbor);
                    }
                }
            }
        }
    }
}

/// Cuts a surface open along a loop and closes both sides.
pub(super) fn cut_open(draft: &mut Draft, mesh: &ClosedMesh, vertices: &[Vertex]) {
    let Some(sectors) = sectors(mesh, vertices) else { return };
    // 1. The right side gets copies of the vertices; a face lies counter-clockwise from the edge that leaves at its corner
    let copies: Vec<Vertex> = vertices.iter().map(|&vertex| draft.copy_vertex(vertex)).collect();
    let is_right = |sector: &Sector| matches!(sector, Sector::Behind | Sector::Right);
    for (corner, _) in sectors.iter().filter(|(_, sector)| is_right(sector)) {
        let place = vertices.iter().position(|&vertex| vertex == corner.vertex(&mesh.faces));
        place.into_iter().for_each(|place| draft.set_corner(*corner, copies[place]));
    }
    // 2. The left side has the surface on the left of the loop, the right side on that of its reverse
    let reversed: Vec<Vertex> = copies.into_iter().rev().collect();
    for hole in [vertices, &reversed] {
        close(draft, hole, hole.len() == 3);
        draft.admit_added();
    }
}
