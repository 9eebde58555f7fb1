// SPDX-License-Identifier: MIT OR Apache-2.0
//! Drops faces that have the vertices of another one.
//!
//! Of faces that run in the same direction the first stays. Two that run in opposite directions are a fold of no
//! thickness and cancel each other: the faces beside them meet when both are gone. One of them stays, however, where
//! that face closes a gap between faces that are not doubled, where it is alone, and on meshes of which most faces are
//! doubled. Cost: a sort of the faces.

use super::draft::Draft;
use crate::mesh::{EdgeTable, Vertex};

/// Drops faces that repeat another one; returns their number.
pub(super) fn drop_repeated(draft: &mut Draft) -> usize {
    // 1. Sets of faces with the same vertices
    let sets = sets_of_equal(&draft.faces);
    if sets.len() == draft.faces.len() {
        return 0;
    }
    // 2. Those that cancel each other
    let is_doubled: Vec<bool> = sets.iter().map(|set| balance(draft, set) == 0).collect();
    let firsts: Vec<[Vertex; 3]> = sets.iter().map(|set| draft.faces[set[0]]).collect();
    let table = EdgeTable::new(draft.points.len(), &firsts);
    let two_sided = 2 * is_doubled.iter().filter(|doubled| **doubled).count() > sets.len();
    let cancels =
        |set: usize| is_doubled[set] && !two_sided && !closes_gap(&firsts, &table, &is_doubled, set);
    // 3. The first in the direction of most stays of each other set
    let mut is_kept = vec![false; draft.faces.len()];
    for (_, set) in sets.iter().enumerate().filter(|(number, _)| !cancels(*number)) {
        let balance = balance(draft, set);
        let agrees = |face: &usize| balance == 0 || is_odd(draft.faces[*face]) == (balance < 0);
        set.iter().copied().find(agrees).into_iter().for_each(|face| is_kept[face] = true);
    }
    draft.keep_faces(|_, face| is_kept[face])
}

/// The faces with the same vertices, in the order of the first of each set.
fn sets_of_equal(faces: &[[Vertex; 3]]) -> Vec<Vec<usize>> {
    let key = |face: usize| {
        let mut vertices = faces[face];
        vertices.sort_unstable();
        vertices
    };
    let mut order: Vec<usize> = (0..faces.len()).collect();
    order.sort_by_key(|&face| (key(face), face));
    let mut sets: Vec<Vec<usize>> =
        order.chunk_by(|&one, &next| key(one) == key(next)).map(<[usize]>::to_vec).collect();
    sets.sort_unstable_by_key(|set| set[0]);
    sets
}

/// The number of faces in the one direction minus that in the other.
fn balance(draft: &Draft, set: &[usize]) -> i64 {
    set.iter().map(|&face| if is_odd(draft.faces[face]) { -1 } else { 1 }).sum()
}

/// Whether a face runs against the order of its vertices: whether an odd number of pairs is out of order.
fn is_odd([a, b, c]: [Vertex; 3]) -> bool {
    (a > b) ^ (b > c) ^ (a > c)
}

/// Whether a doubled face is alone, or has at each edge one other face that is not doubled.
fn closes_gap(firsts: &[[Vertex; 3]], table: &EdgeTable, is_doubled: &[bool], set: usize) -> bool {
    let [a, b, c] = firsts[set];
    let beside = [[a, b], [b, c], [c, a]].map(|edge| {
        let others = table.corners(edge).map(|corner| corner.face().index()).filter(|&other| other != set);
        others.map(|other| is_doubled[other]).collect::<Vec<_>>()
    });
    beside.iter().all(Vec::is_empty) || beside.iter().all(|others| others[..] == [false])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_direction_of_a_face_is_that_of_its_vertices() {
        let of = |a, b, c| is_odd([a, b, c].map(Vertex));
        assert!(![(3, 5, 9), (5, 9, 3), (9, 3, 5)].into_iter().any(|(a, b, c)| of(a, b, c)));
        assert!([(5, 3, 9), (3, 9, 5), (9, 5, 3)].into_iter().all(|(a, b, c)| of(a, b, c)));
    }
}
