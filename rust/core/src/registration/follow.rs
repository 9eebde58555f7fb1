// SPDX-License-Identifier: MIT OR Apache-2.0
//! Points beside a registered surface that follow it: the eyes, teeth and clothes of a body.
//!
//! Each point moves by the similarity x ↦ s R x + b that brings the surface around it nearest to its place on the
//! target, by moving least squares (Schaefer, McPhail, Warren 2006, *Image deformation using moving least squares*;
//! Umeyama 1991 for the similarity). A vertex at distance d counts with its area times (1 + d²/h²)⁻³, so that only the
//! surroundings count: the integral of d² over a plane is finite. A small piece moves by one similarity, d being the
//! distance from the piece and h its radius, and so keeps its shape: an eye stays a ball. Points of a large piece each
//! have a similarity of their own, with a small h, so that the piece bends with the surface, and points on the surface
//! go where it goes.
//!
//! Cost: points times vertices for pieces that bend, pieces times vertices for the others. Where that is too much, the
//! surface is represented by fewer points, the centroids of its vertices in the cells of a grid.

use std::collections::BTreeMap;

use ndarray::{Array2, ArrayView1, ArrayView2};

use super::correspondence::Correspondence;
use crate::alignment::rotation::{rotate, rotation_by_covariance};
use crate::arrays::{from_vectors, rows_of, vectors};
use crate::error::{Elements, Error};
use crate::location::NearestPoint;
use crate::parallel;
use crate::vector::Vector3;

/// Distances at which points that bend stop to be nearer to a vertex, as a part of the mean distance of neighbors.
const CONTACT: f64 = 1e-4;

/// Pairs of a vertex and a point or piece that are summed up at the most, about a second on a core.
const MOST_PAIRS: usize = 400_000_000;

/// The surface is represented by this many points at least.
const FEWEST_SAMPLES: usize = 2000;

/// The places (k, 3) that `points` (k, 3) beside the source go to when the source goes to its place on the target.
///
/// Points with the same number ≥ 0 in `pieces` (k,) are a piece. One whose bounding box has a diagonal up to
/// `rigid_size` times that of the source moves by a similarity and keeps its shape; larger ones, and all points with
/// negative numbers, bend. A quarter is larger than the teeth of a head, and smaller than its hair.
///
/// # Errors
/// [`Error::InvalidArray`] for points of another shape or that are not finite, and for as many pieces not;
/// [`Error::InvalidOption`] for a size that is negative or no number.
pub fn follow(
    correspondence: &Correspondence,
    points: ArrayView2<'_, f64>,
    pieces: ArrayView1<'_, i64>,
    rigid_size: f64,
) -> Result<Array2<f64>, Error> {
    let points: Vec<Vector3> = rows_of("points", points)?.iter().copied().map(Vector3).collect();
    check(&points, pieces, rigid_size)?;
    let body = Body::of(correspondence);
    // 1. The pieces that keep their shapes; all other points bend
    let (rigid, bent) = sorted(&points, pieces, rigid_size * body.size());
    let mut places = points.clone();
    // 2. One similarity for each of the former
    let whole = body.thinned(MOST_PAIRS / rigid.len().max(1));
    for piece in &rigid {
        let corners: Vec<Vector3> = piece.iter().map(|&point| points[point]).collect();
        let motion = whole.motion_of_piece(&corners);
        piece.iter().for_each(|&point| places[point] = motion.apply(points[point]));
    }
    // 3. One for each of the latter
    let whole = body.thinned(MOST_PAIRS / bent.len().max(1));
    let moved = parallel::tasks(bent.len().div_ceil(BLOCK), |block| {
        let of_block = &bent[block * BLOCK..bent.len().min((block + 1) * BLOCK)];
        of_block.iter().map(|&point| whole.place_of(points[point])).collect::<Vec<_>>()
    });
    bent.iter().zip(moved.into_iter().flatten()).for_each(|(&point, place)| places[point] = place);
    Ok(from_vectors(places))
}

/// Points per task.
const BLOCK: usize = 64;

fn check(points: &[Vector3], pieces: ArrayView1<'_, i64>, rigid_size: f64) -> Result<(), Error> {
    let invalid = |name, found: String, expected: String| Err(Error::InvalidArray { name, found, expected });
    if pieces.len() != points.len() {
        let expected = format!("of shape ({},), one number per point", points.len());
        return invalid("pieces", format!("of shape ({},)", pieces.len()), expected);
    }
    if let Some(rows) = Elements::collect((0..points.len()).filter(|&point| !points[point].is_finite())) {
        let (found, expected) = ("NaN or infinite".into(), "finite".into());
        return Err(Error::InvalidRows { name: "points", found, expected, row: "point", rows });
    }
    if rigid_size >= 0.0 {
        return Ok(());
    }
    let (found, expected) = (rigid_size.to_string(), "a number ≥ 0".into());
    Err(Error::InvalidOption { name: "rigid_size", found, expected })
}

/// The pieces whose size is at most `limit`, each as its points, and all other points.
fn sorted(points: &[Vector3], pieces: ArrayView1<'_, i64>, limit: f64) -> (Vec<Vec<usize>>, Vec<usize>) {
    let mut by_piece: BTreeMap<i64, Vec<usize>> = BTreeMap::new();
    pieces.iter().enumerate().for_each(|(point, &piece)| by_piece.entry(piece).or_default().push(point));
    let is_rigid = |piece: i64, members: &[usize]| {
        piece >= 0 && diagonal(members.iter().map(|&point| points[point])) <= limit
    };
    let rigid: Vec<i64> = by_piece
        .iter()
        .filter(|(piece, members)| is_rigid(**piece, members))
        .map(|(piece, _)| *piece)
        .collect();
    let rigid = rigid.iter().filter_map(|piece| by_piece.remove(piece)).collect();
    (rigid, by_piece.into_values().flatten().collect())
}

/// The diagonal of the bounding box.
fn diagonal(points: impl Iterator<Item = Vector3>) -> f64 {
    let (low, high) = points.fold(([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]), |(low, high), point| {
        let at = |axis: usize| point[axis];
        (
            std::array::from_fn(|axis| low[axis].min(at(axis))),
            std::array::from_fn(|axis| high[axis].max(at(axis))),
        )
    });
    (Vector3(high) - Vector3(low)).norm()
}

/// The surface that is followed: points on the source, their places on the target, and the area around each.
struct Body {
    from: Vec<Vector3>,
    to: Vec<Vector3>,
    areas: Vec<f64>,
}

impl Body {
    fn of(correspondence: &Correspondence) -> Self {
        let from = vectors(correspondence.source().vertices());
        let size = diagonal(from.iter().copied());
        let areas = correspondence.vertex_areas().into_iter().map(|area| area * size * size).collect();
        Self { from, to: correspondence.position_rows().to_vec(), areas }
    }

    fn size(&self) -> f64 {
        diagonal(self.from.iter().copied())
    }

    /// About the mean distance of neighbors.
    fn spacing(&self) -> f64 {
        (self.areas.iter().sum::<f64>() / self.from.len() as f64).sqrt()
    }

    /// The surface by about `most` points, or by the fewest that will do.
    fn thinned(&self, most: usize) -> Self {
        let most = most.max(FEWEST_SAMPLES);
        if self.from.len() <= most {
            return Self { from: self.from.clone(), to: self.to.clone(), areas: self.areas.clone() };
        }
        // a cell of a surface is crossed by about 1.5 faces of the grid's size
        let side = 1.5 * (self.areas.iter().sum::<f64>() / most as f64).sqrt();
        let mut cells: BTreeMap<[i64; 3], [f64; 7]> = BTreeMap::new();
        for ((x, y), area) in self.from.iter().zip(&self.to).zip(&self.areas) {
            let cell = cells.entry(x.0.map(|x| (x / side).floor() as i64)).or_default();
            let terms = [1.0, x[0], x[1], x[2], y[0], y[1], y[2]];
            std::iter::zip(cell, terms).for_each(|(sum, term)| *sum += area * term);
        }
        let filled = || cells.values().filter(|cell| cell[0] > 0.0);
        let mean = |first: usize| {
            filled().map(|cell| Vector3::from_fn(|axis| cell[first + axis] / cell[0])).collect()
        };
        Self { from: mean(1), to: mean(4), areas: filled().map(|cell| cell[0]).collect() }
    }

    /// The similarity of a piece.
    fn motion_of_piece(&self, piece: &[Vector3]) -> Motion {
        let h = (0.5 * diagonal(piece.iter().copied())).max(self.spacing());
        let nearest = NearestPoint::new(piece);
        let square = |v: usize| {
            let away = self.from[v] - piece[nearest.of(self.from[v]).index()];
            away.dot(away)
        };
        self.motion(&parallel::map(self.from.len(), square), h)
    }

    /// Where a point goes that bends with the surface.
    fn place_of(&self, point: Vector3) -> Vector3 {
        let square = |x: &Vector3| {
            let away = *x - point;
            away.dot(away)
        };
        let squares: Vec<f64> = self.from.iter().map(square).collect();
        self.motion(&squares, self.spacing() * CONTACT).apply(point)
    }

    /// The similarity of the surroundings, vertices at distances with `squares` (n,), within about `h` or as far as
    /// the nearest vertex.
    fn motion(&self, squares: &[f64], h: f64) -> Motion {
        let (nearest, least) = squares
            .iter()
            .enumerate()
            .fold((0, f64::INFINITY), |best, (v, &square)| if square < best.1 { (v, square) } else { best });
        // relative to the nearest vertex, which may outweigh all others by far; the scale of weights is free
        let [from, to] = [self.from[nearest], self.to[nearest]];
        let closest = least + h * h;
        let mut moments = Moments::default();
        for (v, square) in squares.iter().enumerate() {
            let falling = closest / (square + h * h);
            let weight = self.areas[v] * falling * falling * falling;
            moments.add(weight, self.from[v] - from, self.to[v] - to);
        }
        moments.motion(from, to)
    }
}

/// Σ w, Σ w x, Σ w y, Σ w x·x and Σ w x yᵀ.
#[derive(Default)]
struct Moments {
    weight: f64,
    x: Vector3,
    y: Vector3,
    square: f64,
    products: [Vector3; 3],
}

impl Moments {
    fn add(&mut self, weight: f64, x: Vector3, y: Vector3) {
        let weighted = x * weight;
        self.weight += weight;
        self.x += weighted;
        self.y += y * weight;
        self.square += weighted.dot(x);
        for axis in 0..3 {
            self.products[axis] += y * weighted[axis];
        }
    }

    /// The best similarity of all x + `from` onto y + `to`; its scale is 1 where all x are one point.
    fn motion(&self, from: Vector3, to: Vector3) -> Motion {
        let [x, y] = [self.x, self.y].map(|sum| sum * (1.0 / self.weight));
        let covariance: [Vector3; 3] = std::array::from_fn(|axis| self.products[axis] - y * self.x[axis]);
        let largest = covariance.iter().fold(0.0, |most, row| f64::max(most, row.max_abs()));
        let unit = if largest > 0.0 { 1.0 / largest } else { 1.0 };
        let rotation = rotation_by_covariance(covariance.map(|row| (row * unit).0));
        let along: f64 = (0..3).map(|b| (0..3).map(|a| rotation[b][a] * covariance[a][b]).sum::<f64>()).sum();
        let square = self.square - self.x.dot(x);
        let scale = if square > 0.0 { along.max(0.0) / square } else { 1.0 };
        Motion { scale, rotation, from: from + x, to: to + y }
    }
}

/// The similarity x ↦ s R (x − from) + to.
struct Motion {
    scale: f64,
    rotation: [Vector3; 3],
    from: Vector3,
    to: Vector3,
}

impl Motion {
    fn apply(&self, x: Vector3) -> Vector3 {
        rotate(self.rotation, x - self.from) * self.scale + self.to
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::alignment::rotation::rotation_of;

    /// A ball of `n` points, evenly spread, and where `map` takes it.
    fn ball(n: usize, map: impl Fn(Vector3) -> Vector3) -> Body {
        let from: Vec<Vector3> = (0..n)
            .map(|i| {
                let (turn, height) = (2.399_963 * i as f64, 1.0 - (2 * i + 1) as f64 / n as f64);
                let radius = (1.0 - height * height).sqrt();
                Vector3([radius * turn.cos(), radius * turn.sin(), height])
            })
            .collect();
        let to = from.iter().map(|&x| map(x)).collect();
        Body { from, to, areas: vec![4.0 * std::f64::consts::PI / n as f64; n] }
    }

    fn turned(x: Vector3) -> Vector3 {
        rotate(rotation_of([0.5, -0.1, 0.7, 0.5]), x) * 2.5 + Vector3([3.0, -1.0, 7.0])
    }

    fn bent(x: Vector3) -> Vector3 {
        Vector3([1.4 * x[0] + 0.2 * x[2] * x[2], x[1], 0.8 * x[2]])
    }

    #[test]
    fn points_beside_a_similar_surface_move_by_its_similarity() {
        let body = ball(500, turned);
        let piece = [[0.1, 0.0, 0.6], [0.2, 0.1, 0.6], [0.1, 0.1, 0.7]].map(Vector3);
        let motion = body.motion_of_piece(&piece);
        for point in [piece[0], piece[1], Vector3([3.0, 1.0, 0.0]), body.from[17]] {
            assert!(motion.apply(point).distance(turned(point)) < 1e-12);
            assert!(body.place_of(point).distance(turned(point)) < 1e-12);
        }
    }

    #[test]
    fn points_that_bend_leave_the_surface_without_a_jump() {
        let body = ball(2000, bent);
        for v in [3, 500, 1999] {
            assert!(body.place_of(body.from[v]).distance(body.to[v]) < 1e-6);
            let [inside, outside] = [0.999, 1.001].map(|r| body.place_of(body.from[v] * r));
            assert!(inside.distance(outside) < 0.01);
        }
    }

    #[test]
    fn fewer_points_of_the_surface_move_a_piece_alike() {
        let (body, piece) = (ball(20_000, bent), [[0.0, 0.4, 0.8], [0.1, 0.4, 0.8]].map(Vector3));
        let thin = body.thinned(2000);
        assert!((1000..4000).contains(&thin.from.len()), "{}", thin.from.len());
        assert!((thin.areas.iter().sum::<f64>() / body.areas.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        let [whole, fewer] = [&body, &thin].map(|body| body.motion_of_piece(&piece).apply(piece[0]));
        assert!(whole.distance(fewer) < 0.01);
    }

    #[test]
    fn a_surface_that_shrinks_to_a_point_takes_its_surroundings_along() {
        let body = ball(100, |_| Vector3([1.0, 2.0, 3.0]));
        assert_eq!(body.place_of(Vector3([0.3, 0.0, 0.0])), Vector3([1.0, 2.0, 3.0]));
    }
}
