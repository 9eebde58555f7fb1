// SPDX-License-Identifier: MIT OR Apache-2.0
//! An atlas of a hyperbolic surface: every face in a chart of its own, the Poincaré disk, and the isometries
//! between the charts of neighbors.
//!
//! There are no global coordinates: developed over many faces they exceed double precision, charts of single
//! faces never do. A point is a face and a place in its chart; it walks from chart to chart.
//!
//! Input: the faces of a surface with the lengths and angles of a hyperbolic [`Metric`]. Cost: O(m).

use crate::hyperbolic::metric::Metric;
use crate::hyperbolic::moebius::{
    Complex, Moebius, from_hyperboloid, orientation, seen_from, to_hyperboloid,
};
use crate::hyperbolic::slice::Opened;
use crate::mesh::{Corner, Face};
use crate::parallel;
use crate::vector::Vector3;

/// Largest distance outside an edge at which a point still counts as inside.
const INSIDE: f64 = 1e-13;
/// Distance outside a boundary edge beyond which a point has left the surface.
const OUTSIDE: f64 = 1e-7;
/// Steps after which a walk turns at random, as it may go in a circle.
const CIRCLING: usize = 50;
/// Most steps of a walk.
const MOST_STEPS: usize = 100_000;

/// Charts of all faces of a surface.
#[derive(Debug, Clone)]
pub(crate) struct Atlas<'a> {
    /// (m, 3): the corners of each face in its chart, counterclockwise.
    pub charts: Vec<[Complex; 3]>,
    /// (3 m,): the isometry from the chart of a corner's face to that of the face across the opposite edge; the
    /// identity on the boundary.
    pub transitions: Vec<Moebius>,
    /// (m, 3): μ at the corners of each face.
    pub mu: Vec<[f64; 3]>,
    opposite: &'a [Option<Corner>],
}

/// The end of a walk.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Walk {
    /// The face.
    pub face: Face,
    /// The point in its chart.
    pub x: Complex,
    /// The isometry from the chart in which the walk began to this one.
    pub motion: Moebius,
    /// Whether the point lies beyond the boundary.
    pub is_outside: bool,
}

impl<'a> Atlas<'a> {
    /// The charts of `surface` with a metric.
    pub(crate) fn new(surface: &'a Opened, metric: &Metric) -> Self {
        let opposite = &surface.opposite[..];
        let charts =
            parallel::map(surface.faces.len(), |face| chart(metric.lengths[face], metric.angles[face]));
        let transitions = parallel::map(3 * charts.len(), |corner| match opposite[corner] {
            None => Moebius::default(),
            Some(across) => {
                let [from, to] = edge(&charts, Corner::new(corner));
                let [to_from, to_to] = edge(&charts, across);
                Moebius::between([from, to], [to_to, to_from])
            }
        });
        let mu = surface.faces.iter().map(|face| face.map(|vertex| metric.mu[vertex])).collect();
        Self { charts, transitions, mu, opposite }
    }

    /// Walks from a place in the chart of `face` to the face that contains it.
    pub(crate) fn walk(&self, face: Face, x: Complex) -> Walk {
        let mut walk = Walk { face, x, motion: Moebius::default(), is_outside: false };
        let mut random = Random(0x9e37_79b9_7f4a_7c15);
        for step in 0..MOST_STEPS {
            let heights = self.heights(walk.face, walk.x);
            let crossed = |k: &usize| heights[*k] < -INSIDE && self.opposite[walk.face.corner(*k)].is_some();
            let candidates: Vec<usize> = (0..3).filter(crossed).collect();
            let lowest = || candidates.iter().copied().min_by(|&a, &b| heights[a].total_cmp(&heights[b]));
            let chosen = match candidates.len() {
                2 if step > CIRCLING => Some(candidates[random.next() as usize % 2]),
                _ => lowest(),
            };
            let Some(k) = chosen else {
                walk.is_outside = heights.iter().any(|&height| height < -OUTSIDE);
                return walk;
            };
            walk = self.across(&walk, walk.face.corner(k));
        }
        Walk { is_outside: true, ..walk }
    }

    /// The walk one face farther.
    fn across(&self, walk: &Walk, corner: Corner) -> Walk {
        let across = self.opposite[corner].expect("a walk crosses inner edges only");
        let transition = self.transitions[corner];
        let (face, x) = (across.face(), transition.apply(walk.x));
        Walk { face, x, motion: transition * walk.motion, is_outside: false }
    }

    /// About the distances of `x` inside the edges opposite to the corners of a face, negative outside.
    fn heights(&self, face: Face, x: Complex) -> [f64; 3] {
        let corners = self.charts[face];
        std::array::from_fn(|k| {
            let (from, to) = (corners[(k + 1) % 3], corners[(k + 2) % 3]);
            orientation(from, to, x) / seen_from(from, to).norm().max(f64::MIN_POSITIVE)
        })
    }

    /// The point of a face with given barycentric coordinates on the flat face in space.
    ///
    /// Neighboring faces agree on their edge. For a metric by vertex scaling this is the projective map that
    /// preserves circumcircles.
    pub(crate) fn at(&self, face: Face, barycentric: [f64; 3]) -> Complex {
        let (corners, mu) = (self.charts[face], self.mu[face]);
        let weighted = |k: usize| to_hyperboloid(corners[k]) * (barycentric[k] * mu[k]);
        from_hyperboloid(weighted(0) + (weighted(1) + weighted(2)))
    }

    /// The barycentric coordinates, on the flat face in space, of a point in the chart of the face; nonnegative,
    /// 1 in sum.
    pub(crate) fn barycentric(&self, face: Face, x: Complex) -> [f64; 3] {
        let [a, b, c] = self.charts[face].map(to_hyperboloid);
        let x = to_hyperboloid(x);
        let volumes = [determinant(b, c, x), determinant(c, a, x), determinant(a, b, x)];
        let mu = self.mu[face];
        let weights: [f64; 3] = std::array::from_fn(|k| (volumes[k] / mu[k]).max(0.0));
        let sum: f64 = weights.iter().sum();
        weights.map(|weight| weight / sum)
    }
}

/// det(a, b, x), by differences so that it keeps its digits for small triangles.
fn determinant(a: Vector3, b: Vector3, x: Vector3) -> f64 {
    x.dot((a - x).cross(b - x))
}

/// The ends of the edge opposite to a corner, in the direction of its face.
fn edge(charts: &[[Complex; 3]], corner: Corner) -> [Complex; 2] {
    [corner.next(), corner.previous()].map(|corner| charts[corner.face()][corner.place()])
}

/// A face in the Poincaré disk, with its middle at the origin.
fn chart(lengths: [f64; 3], angles: [f64; 3]) -> [Complex; 3] {
    let corners = [
        Complex::new(0.0, 0.0),
        Complex::new((0.5 * lengths[2]).tanh(), 0.0),
        Complex::from_polar((0.5 * lengths[1]).tanh(), angles[0]),
    ];
    let [a, b, c] = corners.map(to_hyperboloid);
    let middle = from_hyperboloid(a + (b + c));
    corners.map(|corner| seen_from(middle, corner))
}

/// Marsaglia's xorshift, so that every run takes the same turns.
#[derive(Debug, Clone)]
pub(crate) struct Random(pub u64);

impl Random {
    pub(crate) fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0 >> 16
    }
}
