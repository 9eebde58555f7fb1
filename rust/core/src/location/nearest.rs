// SPDX-License-Identifier: MIT OR Apache-2.0
//! The nearest of many points.

use super::bvh::{Bounds, Tree};
use crate::mesh::{Face, Vertex};
use crate::parallel;
use crate::vector::Vector3;

/// Finds the nearest of given points. Cost: O(n log² n) to build, O(log n) for a query.
pub(crate) struct NearestPoint<'a> {
    points: &'a [Vector3],
    tree: Tree,
}

impl<'a> NearestPoint<'a> {
    /// Prepares to search at least one point.
    pub(crate) fn new(points: &'a [Vector3]) -> Self {
        let bounds: Vec<Bounds> = points.iter().map(|&point| Bounds::default().with(point)).collect();
        Self { points, tree: Tree::new(&bounds) }
    }

    /// The point nearest to `x`; the first of equals.
    pub(crate) fn of(&self, x: Vector3) -> Vertex {
        let squared_distance = |element: Face| {
            let away = x - self.points[element.index()];
            away.dot(away)
        };
        Vertex::new(self.tree.nearest(x, squared_distance).index())
    }

    /// The point nearest to each of `queries`.
    pub(crate) fn of_all(&self, queries: &[Vector3]) -> Vec<Vertex> {
        parallel::map(queries.len(), |query| self.of(queries[query]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_point_is_that_of_a_search_through_all() {
        let point = |k: usize| Vector3([1.3, 2.7, 3.1].map(|turn| (turn * k as f64).sin()));
        let points: Vec<Vector3> = (0..500).map(point).collect();
        let nearest = NearestPoint::new(&points);
        for query in (500..700).map(point) {
            let distance = |vertex: &Vertex| points[*vertex].distance(query);
            let expected = Vertex::all(500).min_by(|a, b| distance(a).total_cmp(&distance(b)));
            assert_eq!(Some(nearest.of(query)), expected);
        }
    }

    #[test]
    fn the_first_of_equal_points_is_nearest() {
        let points = [[1.0, 0.0, 0.0], [0.0; 3], [0.0; 3], [0.0; 3], [0.0; 3], [2.0, 0.0, 0.0]].map(Vector3);
        let queries = [[0.1, 0.0, 0.0], [1.5, 0.0, 0.0]].map(Vector3);
        assert_eq!(NearestPoint::new(&points).of_all(&queries), [Vertex(1), Vertex(0)]);
    }
}
