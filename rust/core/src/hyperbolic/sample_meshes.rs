// SPDX-License-Identifier: MIT OR Apache-2.0
//! Spheres with curves on them, for tests.

use std::collections::{BTreeMap, VecDeque};

use super::features::parameters::unit;
use crate::mesh::geometry::triangle;
use crate::mesh::{TriangleMesh, Vertex};
use crate::vector::{Vector3, coordinates};

/// The vertices and faces of a sphere of 8 · 4^level faces, slightly uneven so that no two faces are alike.
pub(super) fn sphere(level: u32) -> (Vec<Vector3>, Vec<[Vertex; 3]>) {
    let [x, y, z] = [0, 1, 2].map(Vector3::unit);
    let mut points = vec![x, y, -x, -y, z, -z];
    let quarters = (0..4).flat_map(|i| [[i, (i + 1) % 4, 4], [(i + 1) % 4, i, 5]]);
    let mut faces: Vec<_> = quarters.map(|face| face.map(Vertex)).collect();
    for _ in 0..level {
        let mut middles = BTreeMap::new();
        let mut middle = |a: Vertex, b: Vertex| {
            *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                points.push(unit(points[a] + points[b]));
                Vertex::new(points.len() - 1)
            })
        };
        let split = |&[a, b, c]: &[Vertex; 3]| {
            let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        faces = faces.iter().flat_map(split).collect();
    }
    let uneven = |(k, &x): (usize, &Vector3)| {
        let wave = |phase: f64| 0.2 * 0.5f64.powi(level as i32) * (1.7 * k as f64 + phase).sin();
        unit(x + Vector3([wave(0.0), wave(1.0), wave(2.0)]))
    };
    (points.iter().enumerate().map(uneven).collect(), faces)
}

/// The mesh without the faces for which `is_hole` holds at their middle.
pub(super) fn without(
    (points, faces): &(Vec<Vector3>, Vec<[Vertex; 3]>),
    is_hole: impl Fn(Vector3) -> bool,
) -> (Vec<Vector3>, Vec<[Vertex; 3]>) {
    let kept: Vec<[Vertex; 3]> =
        faces.iter().filter(|face| !is_hole(middle(points, **face))).copied().collect();
    let number: BTreeMap<Vertex, Vertex> = {
        let mut used: Vec<Vertex> = kept.as_flattened().to_vec();
        used.sort_unstable();
        used.dedup();
        let n = used.len();
        used.into_iter().zip(Vertex::all(n)).collect()
    };
    let points = number.keys().map(|&v| points[v]).collect();
    (points, kept.iter().map(|face| face.map(|v| number[&v])).collect())
}

/// A mesh with its vertices moved.
pub(super) fn mesh(
    (points, faces): &(Vec<Vector3>, Vec<[Vertex; 3]>),
    place: impl Fn(Vector3) -> Vector3,
) -> TriangleMesh {
    TriangleMesh::new(&coordinates(points.iter().map(|&x| place(x))), faces).unwrap()
}

fn middle(points: &[Vector3], face: [Vertex; 3]) -> Vector3 {
    unit(triangle(points, face).into_iter().sum::<Vector3>())
}

/// The vertex nearest to a direction.
pub(super) fn nearest_vertex(points: &[Vector3], direction: Vector3) -> usize {
    (0..points.len()).max_by(|&a, &b| points[a].dot(direction).total_cmp(&points[b].dot(direction))).unwrap()
}

/// A path of fewest edges from the vertex nearest to one direction to that nearest to another.
pub(super) fn path(
    (points, faces): &(Vec<Vector3>, Vec<[Vertex; 3]>),
    from: Vector3,
    to: Vector3,
) -> Vec<usize> {
    let [start, end] = [from, to].map(|direction| nearest_vertex(points, unit(direction)));
    let mut neighbors = vec![Vec::new(); points.len()];
    for [a, b, c] in faces.iter().map(|face| face.map(Vertex::index)) {
        [[a, b], [b, c], [c, a]].iter().for_each(|&[p, q]| neighbors[p].push(q));
    }
    let mut before = vec![usize::MAX; points.len()];
    before[end] = end;
    let mut pending = VecDeque::from([end]);
    while let Some(vertex) = pending.pop_front() {
        for &next in &neighbors[vertex] {
            if before[next] == usize::MAX {
                before[next] = vertex;
                pending.push_back(next);
            }
        }
    }
    let mut path = vec![start];
    while path[path.len() - 1] != end {
        path.push(before[path[path.len() - 1]]);
    }
    path
}

/// The closed curve around the faces within an angle of a direction, those on its left; its first vertex not
/// repeated.
pub(super) fn circle(
    (points, faces): &(Vec<Vector3>, Vec<[Vertex; 3]>),
    center: Vector3,
    angle: f64,
) -> Vec<usize> {
    let inside = faces.iter().filter(|face| middle(points, **face).dot(unit(center)) > angle.cos());
    let edges: Vec<[Vertex; 2]> = inside.flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
    let is_border = |edge: &&[Vertex; 2]| !edges.contains(&[edge[1], edge[0]]);
    let next: BTreeMap<Vertex, Vertex> = edges.iter().filter(is_border).map(|&[a, b]| (a, b)).collect();
    let first = *next.keys().next().unwrap();
    let mut curve = vec![first];
    while next[&curve[curve.len() - 1]] != first {
        curve.push(next[&curve[curve.len() - 1]]);
    }
    assert_eq!(curve.len(), next.len(), "one simple loop");
    curve.into_iter().map(Vertex::index).collect()
}
