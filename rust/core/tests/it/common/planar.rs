// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a one-to-one map of a disk into the plane is, and its energy, by other formulas than the library's.

use authalic::Boundary;
use authalic::testing::TriangleMesh;
use std::f64::consts::TAU;

use robust::{Coord, orient2d};

type Point = [f64; 2];

/// No face folded, and a boundary that runs once around: on the unit circle in its order, or, where it is free, inside
/// of it without meeting itself.
pub fn assert_one_to_one(mesh: &TriangleMesh, uv: &[Point], boundary: Boundary, context: &str) {
    assert_eq!(uv.len(), mesh.n_vertices());
    let corners = |face: usize| mesh.faces()[face].map(|v| uv[v]);
    let folded: Vec<usize> = (0..mesh.n_faces()).filter(|&face| side(corners(face)) <= 0).collect();
    assert_eq!(folded, [0usize; 0], "{context}: folded faces");
    assert!(uv.iter().all(|x| x[0].hypot(x[1]) <= 1.0 + 1e-12), "{context}: outside of the disk");
    let outline: Vec<Point> = mesh.boundary_loops()[0].iter().map(|&v| uv[v]).collect();
    match boundary {
        Boundary::Free => assert_eq!(crossing(&outline), None, "{context}: edges of the outline that meet"),
        _ => assert_once_around(&outline, context),
    }
    // both hold for every map without folds whose outline is simple, so this checks the checks
    let inside: f64 = (0..mesh.n_faces()).map(|face| signed_area(&corners(face))).sum();
    assert!((inside - signed_area(&outline)).abs() < 1e-9, "{context}: {inside} inside of the outline");
}

fn assert_once_around(outline: &[Point], context: &str) {
    let arc = |k: usize| {
        let [a, b] = [outline[k], outline[(k + 1) % outline.len()]];
        assert!((a[0].hypot(a[1]) - 1.0).abs() < 1e-12, "{context}: off the circle");
        let arc = (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1]);
        if arc > 0.0 { arc } else { arc + TAU }
    };
    let turn: f64 = (0..outline.len()).map(arc).sum();
    assert!((turn - TAU).abs() < 1e-9, "{context}: the boundary turns by {turn}");
}

/// Two edges of a closed polygon that meet elsewhere than at a common corner; every pair is compared.
pub fn crossing(corners: &[Point]) -> Option<[usize; 2]> {
    let n = corners.len();
    let edge = |k: usize| [corners[k], corners[(k + 1) % n]];
    let pairs = (0..n).flat_map(|one| (one + 1..n).map(move |other| [one, other]));
    pairs.into_iter().find(|&[one, other]| {
        let ([a, b], [c, d]) = (edge(one), edge(other));
        if other == one + 1 {
            return lies_on(c, d, a) || lies_on(a, b, d);
        }
        if one == 0 && other + 1 == n {
            return lies_on(a, b, c) || lies_on(c, d, b);
        }
        let crosses = side([a, b, c]) * side([a, b, d]) < 0 && side([c, d, a]) * side([c, d, b]) < 0;
        crosses || lies_on(a, b, c) || lies_on(a, b, d) || lies_on(c, d, a) || lies_on(c, d, b)
    })
}

/// Whether `x` lies on the closed segment from `a` to `b`.
fn lies_on(a: Point, b: Point, x: Point) -> bool {
    let between = |axis: usize| a[axis].min(b[axis]) <= x[axis] && x[axis] <= a[axis].max(b[axis]);
    side([a, b, x]) == 0 && between(0) && between(1)
}

/// The exact orientation of a triangle: 1, 0 or −1.
pub fn side(corners: [Point; 3]) -> i32 {
    let [a, b, c] = corners.map(|[x, y]| Coord { x, y });
    orient2d(a, b, c).partial_cmp(&0.0).expect("finite coordinates") as i32
}

/// The sum of the areas that every two of some counterclockwise triangles share.
pub fn shared_area(triangles: &[[Point; 3]]) -> f64 {
    let span = |triangle: &[Point; 3], axis: usize| {
        let [a, b, c] = triangle.map(|point| point[axis]);
        [a.min(b).min(c), a.max(b).max(c)]
    };
    let mut sum = 0.0;
    for (k, first) in triangles.iter().enumerate() {
        for second in &triangles[k + 1..] {
            let overlap = |axis: usize| {
                let ([low, high], [from, to]) = (span(first, axis), span(second, axis));
                low < to && from < high
            };
            if overlap(0) && overlap(1) {
                let sides = (0..3).map(|k| [first[k], first[(k + 1) % 3]]);
                let shared = sides.fold(second.to_vec(), |polygon, line| left_of(line, &polygon));
                sum += signed_area(&shared).max(0.0);
            }
        }
    }
    sum
}

/// What of a convex polygon lies on the left of a line.
fn left_of([from, to]: [Point; 2], polygon: &[Point]) -> Vec<Point> {
    let height = |x: Point| (to[0] - from[0]) * (x[1] - from[1]) - (to[1] - from[1]) * (x[0] - from[0]);
    let mut kept = Vec::new();
    for (k, &here) in polygon.iter().enumerate() {
        let next = polygon[(k + 1) % polygon.len()];
        let heights = [height(here), height(next)];
        if heights[0] >= 0.0 {
            kept.push(here);
        }
        if heights[0] * heights[1] < 0.0 {
            let t = heights[0] / (heights[0] - heights[1]);
            kept.push([0, 1].map(|axis| here[axis] + t * (next[axis] - here[axis])));
        }
    }
    kept
}

/// The signed area of a polygon.
pub fn signed_area(corners: &[Point]) -> f64 {
    let next = |k: usize| corners[(k + 1) % corners.len()];
    let term = |(k, a): (usize, &Point)| 0.5 * (a[0] * next(k)[1] - a[1] * next(k)[0]);
    corners.iter().enumerate().map(term).sum()
}

/// The areas of the faces.
pub fn areas(mesh: &TriangleMesh, uv: &[Point]) -> Vec<f64> {
    mesh.faces().iter().map(|face| signed_area(&face.map(|v| uv[v]))).collect()
}

/// E_A of a map to `targets`, rescaled to its area.
pub fn authalic_energy(mesh: &TriangleMesh, uv: &[Point], targets: &[f64]) -> f64 {
    let areas = areas(mesh, uv);
    let scale = areas.iter().sum::<f64>() / targets.iter().sum::<f64>();
    areas.iter().zip(targets).map(|(area, target)| (area - scale * target).powi(2) / (scale * target)).sum()
}
