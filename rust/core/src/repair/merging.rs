// SPDX-License-Identifier: MIT OR Apache-2.0
//! Merges the points of open edges that lie on each other, or near each other.
//!
//! Points where the surface is closed, and points that touch without an edge in common, stay apart: merged they would be
//! points at which parts of the surface only touch. Points are sorted into cells whose diagonal is the distance, so that
//! those of one cell are near each other; only points of neighboring cells are compared. Cost: O(n log n), and more only
//! for crowds of points that are farther apart than the distance by little.

use std::collections::HashMap;

use super::draft::Draft;
use crate::mesh::{EdgeTable, Vertex};
use crate::sets::Sets;
use crate::vector::Vector3;

/// Smaller distances, in the size of the mesh, are within the rounding of coordinates: equal points alone are merged.
const SMALLEST_DISTANCE: f64 = 1e-15;

/// The numbers of a cell along the axes.
type Cell = [i64; 3];

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
    if distance > SMALLEST_DISTANCE {
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

/// Joins points that are no farther apart than a distance.
fn join_near(points: &[Vector3], open: &[Vertex], distance: f64, sets: &mut Sets) {
    // 1. Points of one cell are near each other: its diagonal is the distance
    let width = distance / 3.0_f64.sqrt();
    let cell_of = |vertex: Vertex| points[vertex].0.map(|x| (x / width).floor() as i64);
    let mut placed: Vec<(Cell, Vertex)> = open.iter().map(|&vertex| (cell_of(vertex), vertex)).collect();
    placed.sort_unstable();
    let cells: Vec<&[(Cell, Vertex)]> = placed.chunk_by(|one, next| one.0 == next.0).collect();
    for members in &cells {
        members[1..].iter().for_each(|(_, vertex)| _ = sets.join(members[0].1.index(), vertex.index()));
    }
    // 2. Points of cells that are near each other, once for each pair of cells
    let number_of: HashMap<Cell, usize> =
        cells.iter().enumerate().map(|(number, members)| (members[0].0, number)).collect();
    let shifts: Vec<Cell> = (-2..=2)
        .flat_map(|x| (-2..=2).flat_map(move |y| (-2..=2).map(move |z| [x, y, z])))
        .filter(|shift| *shift > [0, 0, 0])
        .collect();
    for members in &cells {
        for shift in &shifts {
            let cell = members[0].0;
            let beside = [0, 1, 2].map(|axis| cell[axis] + shift[axis]);
            let Some(&number) = number_of.get(&beside) else { continue };
            let others = cells[number];
            let [root, other_root] = [members, others].map(|each| sets.root(each[0].1.index()));
            let are_near = |(_, a): &(Cell, Vertex)| {
                others.iter().any(|(_, b)| points[*a].distance(points[*b]) <= distance)
            };
            if root != other_root && members.iter().any(are_near) {
                sets.join(root, other_root);
            }
        }
    }
}
