// SPDX-License-Identifier: MIT OR Apache-2.0
//! An exact test of closed polygons in the plane for crossings and touches, of themselves and of each other.
//!
//! Sweep and prune: edges are sorted by their left ends, and each is compared with those that begin before it ends.
//! Cost: O(n log n), and one comparison for every two edges that overlap in x.

use robust::{Coord, orient2d};

/// Whether edges of one or several closed polygons meet only at common corners; the corner after corner k is `next[k]`.
pub(crate) fn is_simple_outline(corners: &[[f64; 2]], next: &[usize]) -> bool {
    let n = corners.len();
    let edge = |k: usize| [corners[k], corners[next[k]]];
    let span = |k: usize, axis: usize| {
        let [from, to] = edge(k);
        [from[axis].min(to[axis]), from[axis].max(to[axis])]
    };
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_unstable_by(|&a, &b| span(a, 0)[0].total_cmp(&span(b, 0)[0]).then(a.cmp(&b)));
    order.iter().enumerate().all(|(place, &i)| {
        let beside = order[place + 1..].iter().take_while(|&&j| span(j, 0)[0] <= span(i, 0)[1]);
        let overlap = |j: usize| span(i, 1)[0] <= span(j, 1)[1] && span(j, 1)[0] <= span(i, 1)[1];
        beside.filter(|&&j| overlap(j)).all(|&j| {
            if next[i] == j {
                !turns_back([i, j, next[j]].map(|k| corners[k]))
            } else if next[j] == i {
                !turns_back([j, i, next[i]].map(|k| corners[k]))
            } else {
                !meet(edge(i), edge(j))
            }
        })
    })
}

/// Whether a polygon turns straight back at the second of three corners.
fn turns_back([before, here, next]: [[f64; 2]; 3]) -> bool {
    let along = (here[0] - before[0]) * (next[0] - here[0]) + (here[1] - before[1]) * (next[1] - here[1]);
    side(before, here, next) == 0.0 && along <= 0.0
}

/// Whether two edges without a common corner meet, given that their boxes overlap; edges on one line then do.
fn meet([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> bool {
    side(a, b, c) * side(a, b, d) <= 0.0 && side(c, d, a) * side(c, d, b) <= 0.0
}

/// The sign of the area of a triangle.
fn side(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    let [a, b, c] = [a, b, c].map(|[x, y]| Coord { x, y });
    let area = orient2d(a, b, c);
    if area == 0.0 { 0.0 } else { area.signum() }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn is_simple_polygon(corners: &[[f64; 2]]) -> bool {
        let next: Vec<usize> = (0..corners.len()).map(|k| (k + 1) % corners.len()).collect();
        is_simple_outline(corners, &next)
    }

    #[test]
    fn simple_polygons_are_told_from_others() {
        assert!(is_simple_polygon(&[]));
        assert!(is_simple_polygon(&[[0., 0.], [1., 0.], [0., 1.]]));
        // a notch that does not reach the other side, that touches it, that crosses it
        let notched = |depth: f64| [[0., 0.], [2., 0.], [2., 1.], [1., 1. - depth], [0., 1.]];
        assert!(is_simple_polygon(&notched(0.9)));
        assert!(!is_simple_polygon(&notched(1.0)));
        assert!(!is_simple_polygon(&notched(1.1)));
        // an eight, a corner that turns straight back
        assert!(!is_simple_polygon(&[[0., 0.], [1., 1.], [1., 0.], [0., 1.]]));
        assert!(!is_simple_polygon(&[[0., 0.], [2., 0.], [1., 0.], [1., 1.]]));
    }

    #[test]
    fn several_polygons_are_simple_where_they_stay_apart() {
        let two = |shift: f64| {
            let square = [[0., 0.], [4., 0.], [4., 4.], [0., 4.]];
            let hole = [[1., 1.], [1., 2.], [2., 2.], [2., 1.]].map(|[x, y]: [f64; 2]| [x + shift, y]);
            is_simple_outline(&[square, hole].concat(), &[1, 2, 3, 0, 5, 6, 7, 4])
        };
        assert!(two(0.0) && two(1.5) && two(5.0));
        assert!(!two(2.0) && !two(2.5) && !two(-1.0));
    }

    #[test]
    fn a_star_is_simple_and_a_pentagram_is_not() {
        let star = |step: usize, inner: f64| -> Vec<[f64; 2]> {
            (0..10)
                .map(|k| {
                    let angle = std::f64::consts::TAU * (k * step) as f64 / 10.0;
                    let radius = if k % 2 == 0 { 1.0 } else { inner };
                    [radius * angle.cos(), radius * angle.sin()]
                })
                .collect()
        };
        assert!(is_simple_polygon(&star(1, 0.2)));
        assert!(!is_simple_polygon(&star(3, 0.9)));
    }

    /// Whether no two edges meet, by integers and by comparing every pair.
    fn is_simple_by_pairs(corners: &[[i64; 2]]) -> bool {
        let n = corners.len();
        let corner = |k: usize| corners[k % n];
        let to = |[a, b]: [i64; 2], [c, d]: [i64; 2]| [c - a, d - b];
        let cross = |a, b, c| to(a, b)[0] * to(a, c)[1] - to(a, b)[1] * to(a, c)[0];
        let dot = |a, b, c| to(a, b)[0] * to(a, c)[0] + to(a, b)[1] * to(a, c)[1];
        let lies_on = |a, b, x| cross(a, b, x) == 0 && dot(x, a, b) <= 0;
        let opposite = |a, b, c, d| cross(a, b, c).signum() * cross(a, b, d).signum() < 0;
        let meet = |a, b, c, d| {
            (opposite(a, b, c, d) && opposite(c, d, a, b))
                || lies_on(a, b, c)
                || lies_on(a, b, d)
                || lies_on(c, d, a)
                || lies_on(c, d, b)
        };
        let turns_back = |k: usize| {
            let [before, here, next] = [corner(k + n - 1), corner(k), corner(k + 1)];
            here == before || here == next || (cross(here, before, next) == 0 && dot(here, before, next) > 0)
        };
        let pairs = (0..n).flat_map(|i| (i + 2..n).map(move |j| (i, j)));
        let mut apart = pairs.filter(|&(i, j)| i + n != j + 1);
        !(0..n).any(turns_back)
            && apart.all(|(i, j)| !meet(corner(i), corner(i + 1), corner(j), corner(j + 1)))
    }

    proptest! {
        /// Corners on a coarse lattice, so that edges often touch and overlap.
        #[test]
        fn random_polygons_are_told_as_by_comparing_all_pairs(
            corners in prop::collection::vec([0i64..6, 0i64..6], 3..9),
        ) {
            let places: Vec<[f64; 2]> = corners.iter().map(|corner| corner.map(|c| c as f64)).collect();
            prop_assert_eq!(is_simple_polygon(&places), is_simple_by_pairs(&corners));
        }
    }
}
