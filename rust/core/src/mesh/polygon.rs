// SPDX-License-Identifier: MIT OR Apache-2.0
//! Whether a closed polygon of the plane crosses or touches itself, decided exactly.
//!
//! Sweep and prune: edges sorted by where they begin from left to right, each compared with those that begin before it
//! ends. Cost: O(n log n), and one comparison for every two edges that overlap in x.

use robust::{Coord, orient2d};

/// Whether no two edges of the closed polygon meet but at a common corner. An empty polygon is simple.
pub(crate) fn is_simple_polygon(corners: &[[f64; 2]]) -> bool {
    let n = corners.len();
    let edge = |k: usize| [corners[k], corners[(k + 1) % n]];
    let span = |k: usize, axis: usize| {
        let [from, to] = edge(k);
        [from[axis].min(to[axis]), from[axis].max(to[axis])]
    };
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_unstable_by(|&a, &b| span(a, 0)[0].total_cmp(&span(b, 0)[0]).then(a.cmp(&b)));
    order.iter().enumerate().all(|(place, &one)| {
        let beside = order[place + 1..].iter().take_while(|&&other| span(other, 0)[0] <= span(one, 0)[1]);
        let overlap =
            |other: usize| span(one, 1)[0] <= span(other, 1)[1] && span(other, 1)[0] <= span(one, 1)[1];
        beside.filter(|&&other| overlap(other)).all(|&other| match (other + n - one) % n {
            1 => !turns_back(corners, other),
            step if step + 1 == n => !turns_back(corners, one),
            _ => !meet(edge(one), edge(other)),
        })
    })
}

/// Whether the polygon goes straight back at a corner.
fn turns_back(corners: &[[f64; 2]], k: usize) -> bool {
    let n = corners.len();
    let [before, here, next] = [corners[(k + n - 1) % n], corners[k], corners[(k + 1) % n]];
    let along = (here[0] - before[0]) * (next[0] - here[0]) + (here[1] - before[1]) * (next[1] - here[1]);
    side(before, here, next) == 0.0 && along <= 0.0
}

/// Whether two edges without a common corner meet; edges on one line count as meeting where their boxes overlap.
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
    use super::*;

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
}
