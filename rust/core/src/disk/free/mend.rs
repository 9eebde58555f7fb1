// SPDX-License-Identifier: MIT OR Apache-2.0
//! The few folds of an almost one-to-one map removed.
//!
//! Vertices near folded faces move to the mean of their neighbors again and again, first those of the nearest rings, then
//! more. Where that does not help, the map stays as it is. Cost: linear in the vertices that move.

use std::f64::consts::TAU;

use super::energy::Energy;
use crate::codomain::planar::PlanarMap;
use crate::mesh::{Corner, Face, TriangleMesh, Vertex};
use crate::parallel;

/// Rings around folded faces whose vertices move.
const RINGS: [usize; 4] = [1, 2, 4, 8];

/// The numbers of times that they move, after each of which the map is looked at.
const SWEEPS: [usize; 6] = [1, 1, 2, 4, 8, 16];

/// Maps with more folded faces than this part of all are left as they are.
const FEW: f64 = 0.02;

/// The map without folds where they can be removed near to them.
pub(super) fn mended(energy: &Energy<'_>, map: PlanarMap) -> PlanarMap {
    let mesh = energy.mesh;
    let seeds = seeds(energy, &map);
    if seeds.is_empty() || seeds.len() as f64 > FEW * mesh.n_vertices() as f64 {
        return map;
    }
    for rings in RINGS {
        let near = grown(mesh, &seeds, rings);
        let mut smoothed = map.clone();
        for sweeps in SWEEPS {
            (0..sweeps).for_each(|_| smooth(mesh, &mut smoothed, &near));
            if energy.is_unfolded(&smoothed) && turns_once_around_every_vertex(energy, &smoothed) {
                return smoothed;
            }
        }
    }
    map
}

/// The vertices of folded faces, and those around which faces turn twice.
fn seeds(energy: &Energy<'_>, map: &[[f64; 2]]) -> Vec<Vertex> {
    let mesh = energy.mesh;
    let is_folded = |face: Face| {
        let [a, b, c, d] = energy.entries(map, face.index());
        a * d - b * c <= 0.0
    };
    let folded = Face::all(mesh.n_faces()).filter(|&face| is_folded(face));
    let mut seeds: Vec<_> = folded.flat_map(|face| mesh.faces()[face]).collect();
    let vertices = Vertex::all(mesh.n_vertices());
    seeds.extend(vertices.filter(|&vertex| !turns_once(energy, map, vertex)));
    seeds.sort_unstable();
    seeds.dedup();
    seeds
}

/// The vertices within some rings of others, ascending.
fn grown(mesh: &TriangleMesh, seeds: &[Vertex], rings: usize) -> Vec<Vertex> {
    let mut near = seeds.to_vec();
    for _ in 0..rings {
        let around: Vec<_> = near.iter().flat_map(|&vertex| neighbors(mesh, vertex)).collect();
        near.extend(around);
        near.sort_unstable();
        near.dedup();
    }
    near
}

/// The vertices that share a face with a vertex; those across inner edges come twice.
fn neighbors(mesh: &TriangleMesh, vertex: Vertex) -> impl Iterator<Item = Vertex> + '_ {
    let corners = mesh.vertex_corners(vertex).iter();
    corners.flat_map(|corner| [corner.next(), corner.previous()]).map(|corner| corner.vertex(mesh.faces()))
}

/// Moves each vertex in turn to the mean of its neighbors.
fn smooth(mesh: &TriangleMesh, map: &mut PlanarMap, vertices: &[Vertex]) {
    for &vertex in vertices {
        let mut sum = [0.0; 3];
        for neighbor in neighbors(mesh, vertex) {
            let [x, y] = map[neighbor];
            sum = [sum[0] + x, sum[1] + y, sum[2] + 1.0];
        }
        map[vertex] = [sum[0] / sum[2], sum[1] / sum[2]];
    }
}

/// True if the faces around every inner vertex turn around it once.
pub(super) fn turns_once_around_every_vertex(energy: &Energy<'_>, map: &[[f64; 2]]) -> bool {
    parallel::all(energy.mesh.n_vertices(), |vertex| turns_once(energy, map, Vertex::new(vertex)))
}

fn turns_once(energy: &Energy<'_>, map: &[[f64; 2]], vertex: Vertex) -> bool {
    let mesh = energy.mesh;
    let angle = |corner: Corner| {
        let (face, k) = (mesh.faces()[corner.face()], corner.place());
        let [o, p, q] = [0, 1, 2].map(|step| map[face[(k + step) % 3]]);
        let ([a, b], [c, d]) = ([p[0] - o[0], p[1] - o[1]], [q[0] - o[0], q[1] - o[1]]);
        (a * d - b * c).atan2(a * c + b * d)
    };
    mesh.is_boundary(vertex)
        || mesh.vertex_corners(vertex).iter().map(|&corner| angle(corner)).sum::<f64>() < 1.5 * TAU
}
