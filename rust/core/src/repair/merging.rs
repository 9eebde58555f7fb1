// SPDX-License-Identifier: MIT OR Apache-2.0
//! Merges the points of open edges that lie on each other, or near each other.
//!
//! Points where the surface is closed, and points that touch without an edge in common, stay apart: merged they would be
//! points at which parts of the surface only touch. Points are sorted into cells as wide as the distance; those of
//! neighboring cells are compared. Cost: O(n log n) for points of which few are near each other.

use super::draft::Draft;
use crate::mesh::{EdgeTable, Vertex};
use crate::sets::Sets;
use crate::vector::Vector3;

/// Merges points no farther apart than `distance`; returns the number of points that vanish.
pub(super) fn merge_points(draft: &mut Draft, distance: f64) -> usize {
    // 1. Edges with a single face, and their points
    let table = EdgeTable::new(draft.points.len(), &draft.faces);
    let open = table.edges().filter(|(_, corners)| corners.len() == 1);
    let edges: Vec<[Vertex; 2]> = open.map(|(ends, _)| ends).collect();
    let mut points: Vec<Vertex> = edges.as_flattened().to_vec();
    points.sort_unstable();
    points.dedup();
    // 2. Sets of points that are near each other
    let mut near = Sets::new(draft.points.len());
    if distance > 0.0 {
        join_near(&draft.points, &points, distance, &mut near);
    } else {
        join_equal(&draft.points, &points, &mut near);
    }
    // 3. The ends of edges that lie on each other
    let mut merged = join_ends(&edges, &mut near);
    let roots: Vec<Vertex> = (0..draft.points.len()).map(|v| Vertex::new(merged.root(v))).collect();
    // 4. The first of each stays
    draft.join_vertices(|vertex| roots[vertex]);
    roots.iter().enumerate().filter(|(vertex, root)| root.index() != *vertex).count()
}

/// The points that open edges have in common, as sets: edges whose ends are near each other, or an edge that is shorter
/// than the distance.
fn join_ends(edges: &[[Vertex; 2]], near: &mut Sets) -> Sets {
    let mut placed: Vec<([usize; 2], [Vertex; 2])> = edges
        .iter()
        .map(|&[a, b]| match [a, b].map(|end| near.root(end.index())) {
            [first, second] if first > second => ([second, first], [b, a]),
            places => (places, [a, b]),
        })
        .collect();
    placed.sort_unstable();
    let mut merged = Sets::new(near.len());
    for edges in placed.chunk_by(|one, next| one.0 == next.0) {
        let [([start, end], [first, last]), ..] = edges else { continue };
        if start == end {
            merged.join(first.index(), last.index());
        }
        for (_, [a, b]) in edges {
            merged.join(first.index(), a.index());
            merged.join(last.index(), b.index());
        }
    }
    merged
}

fn join_equal(points: &[Vector3], open: &[Vertex], sets: &mut Sets) {
    // adding zero makes −0 and 0 the same
    let mut sorted: Vec<_> =
        open.iter().map(|&vertex| (points[vertex].0.map(|x| (x + 0.0).to_bits()), vertex)).collect();
    sorted.sort_unstable();
    for pair in sorted.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
        sets.join(pair[0].1.index(), pair[1].1.index());
    }
}

fn join_near(points: &[Vector3], open: &[Vertex], distance: f64, sets: &mut Sets) {
    let cell_of = |vertex: Vertex| points[vertex].0.map(|x| (x / distance).floor() as i64);
    let mut cells: Vec<_> = open.iter().map(|&vertex| (cell_of(vertex), vertex)).collect();
    cells.sort_unstable();
    for &(cell, vertex) in &cells {
        for shift in 0..27 {
            let neighbor =
                [0, 1, 2].map(|axis| cell[axis].saturating_add(shift / 3_i64.pow(axis as u32) % 3 - 1));
            let begin = cells.partition_point(|(other, _)| *other < neighbor);
            let others = cells[begin..].iter().take_while(|(other, _)| *other == neighbor);
            let near = others
                .filter(|(_, other)| *other < vertex && points[*other].distance(points[vertex]) <= distance);
            near.for_each(|(_, other)| _ = sets.join(vertex.index(), other.index()));
        }
    }
}
