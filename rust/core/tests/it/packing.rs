// SPDX-License-Identifier: MIT OR Apache-2.0
//! Packing: every pair of islands is checked edge by edge.

use std::collections::BTreeSet;
use std::f64::consts::{FRAC_PI_2, TAU};

use authalic::{
    Error, ErrorKind, Margin, PackOptions, Packing, PlanarIsland as Island, Rotation, Silent, Vertex, pack,
};

use super::common::planar::side;
use super::common::random::Random;

type Point = [f64; 2];

/// An island that owns its arrays.
#[derive(Debug, Clone)]
struct Shape {
    points: Vec<Point>,
    faces: Vec<[Vertex; 3]>,
}

impl Shape {
    fn island(&self) -> Island<'_> {
        Island { points: &self.points, faces: &self.faces }
    }

    fn area(&self) -> f64 {
        let corners = self.faces.iter().map(|face| face.map(|v| self.points[v]));
        corners.map(|[a, b, c]| 0.5 * cross(minus(b, a), minus(c, a)).abs()).sum()
    }

    /// The edges of one face only.
    fn outline(&self) -> Vec<[usize; 2]> {
        let half_edges = self.faces.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let half_edges: BTreeSet<[usize; 2]> = half_edges.map(|edge| edge.map(usize::from)).collect();
        half_edges.iter().filter(|&&[a, b]| !half_edges.contains(&[b, a])).copied().collect()
    }
}

fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

fn cross(a: Point, b: Point) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// A fan whose rim has the given radii.
fn fan(radius: impl Fn(f64) -> f64, n: u32) -> Shape {
    let rim = (0..n).map(|k| {
        let angle = TAU * f64::from(k) / f64::from(n);
        [radius(angle) * angle.cos(), radius(angle) * angle.sin()]
    });
    let points = std::iter::once([0.0; 2]).chain(rim).collect();
    let faces = (0..n).map(|k| [0, 1 + k, 1 + (k + 1) % n].map(Vertex)).collect();
    Shape { points, faces }
}

/// A ring of quads, each as two faces, turned from the first to the last by the given angle.
fn ring(radii: [f64; 2], turn: f64, n: u32, is_closed: bool) -> Shape {
    let n_columns = if is_closed { n } else { n + 1 };
    let points = (0..2 * n_columns).map(|k| {
        let angle = turn * f64::from(k / 2) / f64::from(n);
        [angle.cos(), angle.sin()].map(|x| radii[(k % 2) as usize] * x)
    });
    let faces = (0..n).flat_map(|k| {
        let [a, b] = [k, (k + 1) % n_columns].map(|column| 2 * column);
        [[a, a + 1, b + 1], [a, b + 1, b]].map(|face| face.map(Vertex))
    });
    Shape { points: points.collect(), faces: faces.collect() }
}

fn rectangle([width, height]: Point, angle: f64) -> Shape {
    let corners = [[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]];
    let turned = |[x, y]: Point| [angle.cos() * x - angle.sin() * y, angle.sin() * x + angle.cos() * y];
    Shape { points: corners.map(turned).to_vec(), faces: vec![[0, 1, 2].map(Vertex), [0, 2, 3].map(Vertex)] }
}

/// Stars with few or many arms, and arcs, of very different sizes.
fn mixed(n: usize, seed: u64) -> Vec<Shape> {
    let mut random = Random::new(seed);
    let shapes = (0..n).map(|k| {
        let [arms, depth, size] =
            [random.between(2.0, 8.0).floor(), random.between(0.0, 0.7), random.of_any_size(0.08, 1.0)];
        if k % 4 == 3 {
            ring([0.7 * size, size], random.between(2.0, 5.0), 40, false)
        } else {
            fan(|angle| size * (1.0 + depth * (arms * angle).cos()), 90)
        }
    });
    shapes.collect()
}

fn packed(shapes: &[Shape], options: &PackOptions) -> Result<Packing, Error> {
    let islands: Vec<Island<'_>> = shapes.iter().map(Shape::island).collect();
    pack(&islands, options, &mut Silent)
}

fn placed(shapes: &[Shape], packing: &Packing) -> Vec<Shape> {
    let place = |(k, shape): (usize, &Shape)| Shape {
        points: shape.points.iter().map(|&point| packing.apply(k, point)).collect(),
        faces: shape.faces.clone(),
    };
    shapes.iter().enumerate().map(place).collect()
}

/// Distance of a point from a segment.
fn distance(point: Point, [a, b]: [Point; 2]) -> f64 {
    let [along, to] = [minus(b, a), minus(point, a)];
    let share = (along[0] * to[0] + along[1] * to[1]) / (along[0] * along[0] + along[1] * along[1]);
    let share = share.clamp(0.0, 1.0);
    (to[0] - share * along[0]).hypot(to[1] - share * along[1])
}

fn segments_cross([a, b]: [Point; 2], [c, d]: [Point; 2]) -> bool {
    side([a, b, c]) * side([a, b, d]) < 0 && side([c, d, a]) * side([c, d, b]) < 0
}

fn covers(shape: &Shape, point: Point) -> bool {
    shape.faces.iter().any(|face| {
        let [a, b, c] = face.map(|v| shape.points[v]);
        let sides = [[a, b, point], [b, c, point], [c, a, point]].map(side);
        sides.iter().all(|&s| s >= 0) || sides.iter().all(|&s| s <= 0)
    })
}

/// Inside of the square and apart from each other, by the margin; no corner of one island lies in another.
fn assert_apart(shapes: &[Shape], margin: f64, context: &str) {
    let margin = margin - 1e-9;
    let outlines: Vec<Vec<[Point; 2]>> =
        shapes.iter().map(|s| s.outline().iter().map(|edge| edge.map(|v| s.points[v])).collect()).collect();
    for (k, shape) in shapes.iter().enumerate() {
        let is_inside = |point: &Point| point.iter().all(|&x| x >= margin && x <= 1.0 - margin);
        assert!(shape.points.iter().all(is_inside), "{context}: island {k} leaves the square");
        for other in (0..shapes.len()).filter(|&other| other != k) {
            assert!(!covers(&shapes[other], outlines[k][0][0]), "{context}: {k} lies in {other}");
            for one in &outlines[k] {
                for edge in &outlines[other] {
                    assert!(distance(one[0], *edge) >= margin, "{context}: {k} and {other} are too close");
                    assert!(!segments_cross(*one, *edge), "{context}: {k} and {other} overlap");
                }
            }
        }
    }
}

#[test]
fn islands_lie_apart_in_the_square_and_fill_it() {
    for (n, share, margin) in [(1, 0.3, 0.002), (2, 0.4, 0.0), (7, 0.5, 0.002), (25, 0.5, 0.01)] {
        let shapes = mixed(n, 7 + n as u64);
        let packing =
            packed(&shapes, &PackOptions { margin: Margin::OfSquare(margin), ..PackOptions::default() })
                .unwrap();
        let placed = placed(&shapes, &packing);
        assert_apart(&placed, margin, &format!("{n} islands"));
        let covered: f64 = placed.iter().map(Shape::area).sum();
        assert!(covered > share && covered < 1.0, "{n} islands cover {covered}");
        let scaled: f64 = shapes.iter().map(|shape| shape.area() * packing.scale.powi(2)).sum();
        assert!((covered - scaled).abs() < 1e-12);
    }
}

#[test]
fn equal_squares_fill_the_square() {
    for rotation in [Rotation::Fixed, Rotation::Cardinal, Rotation::Free] {
        let shapes = vec![rectangle([1.0, 1.0], 0.0); 9];
        let packing =
            packed(&shapes, &PackOptions { margin: Margin::OfSquare(0.0), rotation, aspect: 1.0 }).unwrap();
        assert_apart(&placed(&shapes, &packing), 0.0, "squares");
        assert!(packing.scale > 0.98 / 3.0, "{}", packing.scale);
        let is_allowed = |angle: f64| match rotation {
            Rotation::Fixed => angle == 0.0,
            Rotation::Cardinal => (angle / FRAC_PI_2).fract() == 0.0,
            Rotation::Free => true,
        };
        assert!(packing.places.iter().all(|place| is_allowed(place.angle)));
    }
}

#[test]
fn a_margin_without_room_is_refused() {
    let shapes = vec![rectangle([1.0, 1.0], 0.0); 9];
    let options = |margin| PackOptions { margin: Margin::OfSquare(margin), ..PackOptions::default() };
    for margin in [0.3, 0.4, 0.49, 0.4999] {
        assert_eq!(packed(&shapes, &options(margin)).unwrap_err().kind(), ErrorKind::InvalidOption);
    }
    // 9 points at a distance of .2 have room in a square of side .6
    assert!(packed(&shapes, &options(0.2)).is_ok());
}

#[test]
fn a_margin_may_be_a_length_of_the_islands() {
    for n in [1, 6] {
        let shapes = vec![rectangle([1.0, 2.0], 0.0); n];
        let options = PackOptions { margin: Margin::OfIslands(0.1), ..PackOptions::default() };
        let packing = packed(&shapes, &options).unwrap();
        assert_apart(&placed(&shapes, &packing), 0.1 * packing.scale, &format!("{n} rectangles"));
    }
}

#[test]
fn one_island_lies_in_the_smallest_square() {
    // the square around a rectangle that stands on its corner has the side (a + b)/√2, which is less than a for a > 2.4 b
    for (size, square) in [([1.0, 1.0], 1.0), ([1.0, 0.5], 1.0), ([1.0, 0.1], 1.1 * 0.5_f64.sqrt())] {
        let shape = [rectangle(size, 0.4)];
        let packing =
            packed(&shape, &PackOptions { margin: Margin::OfSquare(0.05), ..PackOptions::default() })
                .unwrap();
        assert!((packing.scale - 0.9 / square).abs() < 1e-12, "{size:?}: {}", packing.scale);
        assert_apart(&placed(&shape, &packing), 0.05, "one island");
    }
}

#[test]
fn no_rounding_leads_out_of_the_square() {
    let mut random = Random::new(11);
    for k in 0..400 {
        let distance = random.of_any_size(1.0, 1e6);
        let n = if k % 10 == 0 { 3 } else { 1 };
        let mut shapes: Vec<Shape> = (0..n)
            .map(|_| rectangle([random.of_any_size(0.1, 1.0), 1.0], random.between(0.0, TAU)))
            .collect();
        for point in shapes.iter_mut().flat_map(|shape| &mut shape.points) {
            *point = point.map(|x| x + distance);
        }
        let rotation = [Rotation::Fixed, Rotation::Cardinal, Rotation::Free][k % 3];
        let options = PackOptions { margin: Margin::OfSquare(0.0), rotation, ..PackOptions::default() };
        let packing = packed(&shapes, &options).unwrap();
        let points: Vec<Point> =
            placed(&shapes, &packing).into_iter().flat_map(|shape| shape.points).collect();
        assert!(points.as_flattened().iter().all(|x| (0.0..=1.0).contains(x)), "{k}: {points:?}");
        let most = points.as_flattened().iter().copied().fold(0.0, f64::max);
        assert!(n > 1 || most > 1.0 - 1e-8, "{k}: only up to {most}");
    }
}

#[test]
fn islands_keep_their_shapes_on_a_wide_or_a_high_texture() {
    for aspect in [2.0, 0.5] {
        let options = PackOptions { margin: Margin::OfSquare(0.01), aspect, ..PackOptions::default() };
        for shapes in [mixed(1, 5), mixed(9, 6)] {
            let packing = packed(&shapes, &options).unwrap();
            let placed = placed(&shapes, &packing);
            assert_apart(&placed, 0.01, &format!("aspect {aspect}"));
            for (shape, on_square) in shapes.iter().zip(&placed) {
                let on_texture = on_square.points.iter().map(|&[u, v]| [aspect * u, v]).collect::<Vec<_>>();
                for [a, b] in shape.outline() {
                    let [before, after] =
                        [&shape.points, &on_texture].map(|p| (p[b][0] - p[a][0]).hypot(p[b][1] - p[a][1]));
                    assert!((after - packing.scale * before).abs() < 1e-12);
                }
            }
        }
        // twice as wide as high: two squares side by side
        let squares = vec![rectangle([1.0, 1.0], 0.0); 2];
        let packing = packed(
            &squares,
            &PackOptions { margin: Margin::OfSquare(0.0), aspect, ..PackOptions::default() },
        )
        .unwrap();
        let best = if aspect > 1.0 { 1.0 } else { 0.5 };
        assert!(packing.scale > 0.99 * best, "{aspect}: {}", packing.scale);
    }
}

#[test]
fn small_islands_go_into_holes_and_bays() {
    let large = ring([0.8, 1.0], TAU, 80, true);
    let alone = packed(std::slice::from_ref(&large), &PackOptions::default()).unwrap();
    let shapes = [large, fan(|_| 0.5, 40), ring([0.07, 0.1], 4.0, 40, false)];
    let packing = packed(&shapes, &PackOptions::default()).unwrap();
    assert_apart(&placed(&shapes, &packing), 0.002, "ring");
    assert!(packing.scale > 0.99 * alone.scale, "{} {}", packing.scale, alone.scale);
}

#[test]
fn islands_that_overlap_themselves_or_fold_are_packed() {
    let spiral = ring([0.6, 1.0], 1.6 * TAU, 60, false);
    let mut folded = fan(|angle| 1.0 + 0.3 * (3.0 * angle).cos(), 40);
    folded.points[0] = [2.0, 0.5];
    let shapes = [spiral, folded, rectangle([1.0, 0.3], 0.2)];
    let packing = packed(&shapes, &PackOptions::default()).unwrap();
    assert_apart(&placed(&shapes, &packing), 0.002, "overlapping islands");
}

#[test]
fn one_result_for_any_number_of_threads() {
    let shapes = mixed(12, 3);
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| packed(&shapes, &PackOptions::default()).unwrap())
    };
    let packing = on(1);
    assert_eq!(packing, on(2));
    assert_eq!(packing, on(5));
    assert_eq!(packing, packed(&shapes, &PackOptions::default()).unwrap());
}

#[test]
fn a_cancelled_run_asks_no_more() {
    let shapes = mixed(60, 5);
    let islands: Vec<Island<'_>> = shapes.iter().map(Shape::island).collect();
    for patience in [0, 2, 8] {
        let mut reports = 0;
        let mut observer = |_: f64, _: &str| {
            reports += 1;
            reports <= patience
        };
        let result = pack(&islands, &PackOptions::default(), &mut observer);
        assert_eq!(result, Err(Error::CancelledEarly), "after {patience} reports");
        assert_eq!(reports, patience + 1);
    }
}

#[test]
fn progress_rises_from_zero_to_one() {
    let shapes = mixed(10, 9);
    let islands: Vec<Island<'_>> = shapes.iter().map(Shape::island).collect();
    let mut fractions = Vec::new();
    let mut observer = |fraction: f64, _: &str| {
        fractions.push(fraction);
        true
    };
    pack(&islands, &PackOptions::default(), &mut observer).unwrap();
    assert!(fractions.is_sorted() && fractions[0] >= 0.0 && fractions[fractions.len() - 1] <= 1.0);
}

#[test]
fn nothing_and_islands_without_faces_are_no_errors() {
    assert_eq!(packed(&[], &PackOptions::default()).unwrap().places, []);
    let empty = Shape { points: Vec::new(), faces: Vec::new() };
    let shapes = [empty.clone(), rectangle([1.0, 0.9], 0.0), empty];
    let packing = packed(&shapes, &PackOptions::default()).unwrap();
    assert_eq!(packing.places.len(), 3);
    assert!(packing.scale > 0.9);
}

#[test]
fn what_cannot_be_packed_is_refused() {
    let kind = |shapes: &[Shape], margin| {
        packed(shapes, &PackOptions { margin: Margin::OfSquare(margin), ..PackOptions::default() })
            .unwrap_err()
            .kind()
    };
    let square = rectangle([1.0, 1.0], 0.0);
    for aspect in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let options = PackOptions { aspect, ..PackOptions::default() };
        let error = packed(std::slice::from_ref(&square), &options).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::InvalidOption);
    }
    for margin in [-0.1, 0.5, f64::NAN] {
        assert_eq!(kind(std::slice::from_ref(&square), margin), ErrorKind::InvalidOption);
    }
    assert_eq!(kind(&vec![square.clone(); 30], 0.3), ErrorKind::InvalidOption);
    let mut broken = square.clone();
    broken.points[2][1] = f64::INFINITY;
    assert_eq!(kind(&[square, broken], 0.0), ErrorKind::InvalidArray);
    assert_eq!(kind(&[rectangle([1.0, 0.0], 0.0)], 0.0), ErrorKind::InvalidArray);
}

#[test]
fn thousands_of_islands_keep_the_margin() {
    let mut random = Random::new(8);
    let shapes: Vec<Shape> = (0..5000)
        .map(|k| {
            let size = if k < 3 { 12.0 } else { random.of_any_size(0.3, 1.0) };
            rectangle([size * random.between(1.0, 3.0), size], random.between(0.0, TAU))
        })
        .collect();
    for (rotation, aspect) in [(Rotation::Free, 1.0), (Rotation::Cardinal, 2.0), (Rotation::Fixed, 0.5)] {
        let options = PackOptions { margin: Margin::OfSquare(0.001), rotation, aspect };
        let packing = packed(&shapes, &options).unwrap();
        let shapes = placed(&shapes, &packing);
        // neighbors by a grid of cells no smaller than the largest of the small islands
        let boxes: Vec<[Point; 2]> = shapes
            .iter()
            .map(|shape| {
                let low =
                    shape.points.iter().fold([1.0; 2], |low: Point, p| [low[0].min(p[0]), low[1].min(p[1])]);
                let high = shape
                    .points
                    .iter()
                    .fold([0.0; 2], |high: Point, p| [high[0].max(p[0]), high[1].max(p[1])]);
                [low, high]
            })
            .collect();
        assert!(boxes.iter().flatten().flatten().all(|x| (0.001 - 1e-9..=0.999 + 1e-9).contains(x)));
        let mut order: Vec<usize> = (0..shapes.len()).collect();
        order.sort_by(|&one, &other| boxes[one][0][0].total_cmp(&boxes[other][0][0]));
        for (k, &one) in order.iter().enumerate() {
            for &other in
                order[k + 1..].iter().take_while(|&&other| boxes[other][0][0] < boxes[one][1][0] + 0.001)
            {
                let is_above = boxes[other][0][1] > boxes[one][1][1] + 0.001 - 1e-9;
                let is_below = boxes[one][0][1] > boxes[other][1][1] + 0.001 - 1e-9;
                if !is_above && !is_below {
                    let pair = [shapes[one].clone(), shapes[other].clone()];
                    assert_apart(&pair, 0.001, &format!("{rotation:?}: {one} and {other}"));
                }
            }
        }
        let area: f64 = shapes.iter().map(Shape::area).sum();
        let least = if rotation == Rotation::Free { 0.7 } else { 0.3 };
        assert!(area > least, "{rotation:?}: {area}");
    }
}
