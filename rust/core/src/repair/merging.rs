// SPDX-License-Identifier: MIT OR Apache-2.0
//! Merges points of open edges that are equal, or near each other.
//!
//! Points around which the surface is closed stay apart from all others: merged with them they would be points at which
//! parts of the surface only touch. Points are sorted into cells as wide as the distance; those of neighboring cells are
//! compared. Cost: O(n log n) for points of which few are near each other.

use super::draft::Draft;
use crate::mesh::{EdgeTable, Vertex};
use crate::sets::Sets;
use crate::vector::Vector3;

/// Merges points no farther apart than `distance`; returns the number of points that vanish.
pub(super) fn merge_points(draft: &mut Draft, distance: f64) -> usize {
    // 1. The points of open edges
    let open = open_points(draft);
    // 2. Sets of points that are near each other
    let mut sets = Sets::new(draft.points.len());
    if distance > 0.0 {
        join_near(&draft.points, &open, distance, &mut sets);
    } else {
        join_equal(&draft.points, &open, &mut sets);
    }
    let roots: Vec<Vertex> = (0..draft.points.len()).map(|v| Vertex::new(sets.root(v))).collect();
    // 3. The first of each stays
    draft.join_vertices(|vertex| roots[vertex]);
    roots.iter().enumerate().filter(|(vertex, root)| root.index() != *vertex).count()
}

/// The vertices of edges with a single face.
fn open_points(draft: &Draft) -> Vec<Vertex> {
    let mut is_open = vec![false; draft.points.len()];
    let table = EdgeTable::new(draft.points.len(), &draft.faces);
    for (ends, _) in table.edges().filter(|(_, corners)| corners.len() == 1) {
        ends.into_iter().for_each(|vertex| is_open[vertex] = true);
    }
    Vertex::all(draft.points.len()).filter(|&vertex| is_open[vertex]).collect()
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
