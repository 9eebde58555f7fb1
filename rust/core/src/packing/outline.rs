// SPDX-License-Identifier: MIT OR Apache-2.0
//! An island, and its outline, which says all that packing needs to know of its faces.

use crate::mesh::Vertex;

/// A point or a vector of the plane.
pub(super) type Point = [f64; 2];

/// An island to place.
#[derive(Debug, Clone, Copy)]
pub struct Island<'a> {
    /// Points (n, 2) in a plane of its own, at the density common to all islands.
    pub points: &'a [[f64; 2]],
    /// Faces (m, 3).
    pub faces: &'a [[Vertex; 3]],
}

/// The directed edges around an island and around its holes.
///
/// Each face is turned so that it lies to the left of its edges; edges in opposite directions cancel. The winding number
/// of what remains is the number of faces that cover a point, also where an island overlaps itself or is folded.
#[derive(Debug, Clone, Default)]
pub(super) struct Outline {
    /// Start and end of each edge.
    pub edges: Vec<[Point; 2]>,
    /// The corners of the convex hull, counterclockwise.
    pub hull: Vec<Point>,
    /// The area of all faces.
    pub area: f64,
}

impl Outline {
    /// The outline of an island, in O(m log m).
    pub fn new(island: &Island<'_>) -> Self {
        let edges = uncancelled_edges(island);
        let hull = convex_hull(edges.iter().map(|edge| edge[0]).collect());
        let area = 0.5 * edges.iter().map(|&[a, b]| a[0] * b[1] - a[1] * b[0]).sum::<f64>();
        Self { edges, hull, area }
    }

    /// The outline of a box with a corner in the origin.
    pub fn of_box([width, height]: Point) -> Self {
        let hull = vec![[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]];
        let edges = (0..4).map(|k| [hull[k], hull[(k + 1) % 4]]).collect();
        Self { edges, hull, area: width * height }
    }
}

/// The edges of all faces, positively oriented, but for those that cancel.
fn uncancelled_edges(island: &Island<'_>) -> Vec<[Point; 2]> {
    let mut edges: Vec<(Vertex, Vertex, bool)> = Vec::with_capacity(3 * island.faces.len());
    for &[a, b, c] in island.faces {
        let [p, q, r] = [a, b, c].map(|vertex| island.points[vertex]);
        let [b, c] = if turn(p, q, r) < 0.0 { [c, b] } else { [b, c] };
        edges.extend([[a, b], [b, c], [c, a]].map(|[from, to]| (from.min(to), from.max(to), from < to)));
    }
    edges.sort_unstable();
    let mut kept = Vec::new();
    for edge in edges.chunk_by(|one, other| (one.0, one.1) == (other.0, other.1)) {
        let forward = edge.iter().filter(|(_, _, forward)| *forward).count();
        let backward = edge.len() - forward;
        let [low, high] = [edge[0].0, edge[0].1].map(|vertex| island.points[vertex]);
        let directed = if forward > backward { [low, high] } else { [high, low] };
        kept.extend(std::iter::repeat_n(directed, forward.abs_diff(backward)));
    }
    kept
}

/// Twice the signed area of a triangle.
fn turn(a: Point, b: Point, c: Point) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// The corners of the convex hull, counterclockwise, by Andrew's monotone chain in O(n log n).
pub(super) fn convex_hull(mut points: Vec<Point>) -> Vec<Point> {
    points.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    points.dedup();
    if points.len() < 3 {
        return points;
    }
    let mut hull = half_hull(points.iter().copied());
    hull.extend(half_hull(points.iter().rev().copied()));
    hull
}

/// The lower half of the hull of points sorted from left to right, without its last corner.
fn half_hull(points: impl Iterator<Item = Point>) -> Vec<Point> {
    let mut chain: Vec<Point> = Vec::new();
    for point in points {
        while let [.., a, b] = chain[..]
            && turn(a, b, point) <= 0.0
        {
            chain.pop();
        }
        chain.push(point);
    }
    chain.pop();
    chain
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::faces_of_indices;

    fn outline(points: &[Point], faces: &[[u32; 3]]) -> Outline {
        Outline::new(&Island { points, faces: &faces_of_indices(faces) })
    }

    #[test]
    fn edges_between_faces_cancel() {
        let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]];
        let outline = outline(&square, &[[0, 1, 2], [0, 2, 3]]);
        assert_eq!((outline.edges.len(), outline.area), (4, 2.0));
        assert_eq!(outline.hull, square);
    }

    #[test]
    fn a_folded_face_counts_as_cover() {
        let points = [[0.0, 0.0], [2.0, 0.0], [1.0, 2.0], [1.0, 1.0]];
        let outline = outline(&points, &[[0, 1, 2], [1, 0, 3]]);
        assert_eq!((outline.edges.len(), outline.area), (6, 3.0));
    }

    #[test]
    fn the_hull_of_collinear_points_has_two_corners() {
        let line = (0..5).map(|k| [f64::from(k), 2.0 * f64::from(k)]).collect();
        assert_eq!(convex_hull(line), [[0.0, 0.0], [4.0, 8.0]]);
    }
}
