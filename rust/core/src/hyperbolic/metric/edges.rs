// SPDX-License-Identifier: MIT OR Apache-2.0
//! The numbered edges of a surface, and their hyperbolic lengths as functions of factors at the vertices.
//!
//! Two kinds of discrete conformal change, both with one factor u per vertex and lengths that grow with it:
//!
//! - vertex scaling (A. Bobenko, U. Pinkall, B. Springborn, Discrete conformal maps and ideal polyhedra,
//!   Geometry & Topology 19, 2015): 2 sinh(l/2) = L e^((u_i + u_j)/2) for lengths L in space;
//! - inversive distance circle packings (P. Bowers, K. Stephenson, Uniformizing dessins and Belyĭ maps via
//!   circle packing, Memoirs AMS 805, 2004): circles of radius r, u = ln tanh(r/2) < 0, around the vertices,
//!   and cosh l = cosh r_i cosh r_j + I sinh r_i sinh r_j for the inversive distance I of two circles.
//!
//! With I = cos φ the latter is Thurston's packing of circles that meet at the angle φ. Circles that are small
//! enough for every triangle of a mesh in space hardly ever meet: I ≥ 1. Thurston's angles would then all be 0,
//! the tangential packing, which does not depend on the surface's shape; so I is kept as it is.

use crate::mesh::{EdgeTable, Vertex};
use crate::parallel;
use crate::vector::Vector3;

/// The edges of the faces.
pub(super) struct Edges {
    /// The two vertices of each edge, ascending.
    pub ends: Vec<[Vertex; 2]>,
    /// (m, 3): the edge opposite to each corner.
    pub of_face: Vec<[usize; 3]>,
    /// (n,): whether a vertex is on the boundary, an end of an edge of only one face.
    pub on_boundary: Vec<bool>,
}

impl Edges {
    /// Numbers the edges of all faces.
    pub(super) fn new(n_vertices: usize, faces: &[[Vertex; 3]]) -> Self {
        let mut edges = Self {
            ends: Vec::new(),
            of_face: vec![[0; 3]; faces.len()],
            on_boundary: vec![false; n_vertices],
        };
        for (ends, entries) in EdgeTable::new(n_vertices, faces).edges() {
            for corner in entries.iter().map(|entry| entry.corner()) {
                edges.of_face[corner.face()][corner.place()] = edges.ends.len();
            }
            if entries.len() == 1 {
                ends.iter().for_each(|&end| edges.on_boundary[end] = true);
            }
            edges.ends.push(ends);
        }
        edges
    }

    /// The number of edges.
    pub(super) fn len(&self) -> usize {
        self.ends.len()
    }

    /// The values at the two ends of an edge.
    pub(super) fn at_ends(&self, edge: usize, values: &[f64]) -> [f64; 2] {
        self.ends[edge].map(|end| values[end])
    }

    /// The values of the edges opposite to the corners of a face.
    pub(super) fn around(&self, face: usize, values: &[f64]) -> [f64; 3] {
        self.of_face[face].map(|edge| values[edge])
    }

    /// The lengths in space.
    pub(super) fn lengths(&self, points: &[Vector3]) -> Vec<f64> {
        parallel::map(self.len(), |edge| {
            let [a, b] = self.ends[edge].map(|end| points[end]);
            a.distance(b)
        })
    }
}

/// A kind of conformal change, with the quantity of each edge that it preserves.
pub(super) enum Conformal {
    /// The length L in space, scaled: the chord 2 sinh(l/2) at u = 0.
    VertexScaling(Vec<f64>),
    /// The inversive distance I ≥ 1 of the circles around the ends.
    InversiveDistance(Vec<f64>),
}

impl Conformal {
    /// The length of an edge whose ends have these factors.
    pub(super) fn length(&self, edge: usize, factors: [f64; 2]) -> f64 {
        2.0 * asinh(self.half_chord(edge, factors))
    }

    /// sinh(l/2).
    fn half_chord(&self, edge: usize, [u, v]: [f64; 2]) -> f64 {
        match self {
            Self::VertexScaling(lengths) => 0.5 * lengths[edge] * (0.5 * (u + v)).exp(),
            Self::InversiveDistance(distances) => {
                let [p, q] = [u, v].map(f64::exp);
                // (p − q)² + 2 (1 + I) p q is a sum of nonnegative terms
                let sum = (p - q) * (p - q) + 2.0 * (1.0 + distances[edge]) * p * q;
                (sum / (one_less_square(u) * one_less_square(v))).sqrt()
            }
        }
    }

    /// The derivative of the length of an edge by the factor at either end.
    pub(super) fn length_derivatives(&self, edge: usize, factors: [f64; 2]) -> [f64; 2] {
        let half_chord = self.half_chord(edge, factors);
        let cosine = (1.0 + half_chord * half_chord).sqrt();
        match self {
            Self::VertexScaling(_) => [half_chord / cosine; 2],
            Self::InversiveDistance(distances) => {
                let [[sinh_i, cosh_i], [sinh_j, cosh_j]] = factors.map(circle);
                let sinh = 2.0 * half_chord * cosine;
                let by = |[sinh_r, cosh_r]: [f64; 2], [sinh_s, cosh_s]: [f64; 2]| {
                    sinh_r * (sinh_r * cosh_s + distances[edge] * cosh_r * sinh_s) / sinh
                };
                [by([sinh_i, cosh_i], [sinh_j, cosh_j]), by([sinh_j, cosh_j], [sinh_i, cosh_i])]
            }
        }
    }

    /// The part of the step along `direction` that keeps all factors well inside their range.
    pub(super) fn longest_step(&self, factors: &[f64], direction: &[f64]) -> f64 {
        match self {
            Self::VertexScaling(_) => {
                let fastest = direction.iter().fold(0.0, |most: f64, d| most.max(d.abs()));
                (LONGEST_MOVE / fastest).min(1.0)
            }
            Self::InversiveDistance(_) => factors
                .iter()
                .zip(direction)
                .filter(|&(_, &d)| d > 0.0)
                .fold(1.0, |least: f64, (u, d)| least.min(-SHARE_OF_ROOM * u / d)),
        }
    }
}

/// Largest change of a factor of vertex scaling in one step.
const LONGEST_MOVE: f64 = 6.0;

/// Largest change of a circle's factor in one step, as a part of its distance to 0, where the radius is infinite.
const SHARE_OF_ROOM: f64 = 0.9;

/// asinh x for x ≥ 0, in half the time of the standard library's, which guards against squares that overflow.
fn asinh(x: f64) -> f64 {
    (x + x * x / (1.0 + (1.0 + x * x).sqrt())).ln_1p()
}

/// 1 − e^(2u).
fn one_less_square(u: f64) -> f64 {
    -(2.0 * u).exp_m1()
}

/// sinh r and cosh r of the circle with the factor u.
fn circle(u: f64) -> [f64; 2] {
    let tanh = u.exp();
    [2.0 * tanh, 1.0 + tanh * tanh].map(|x| x / one_less_square(u))
}

/// Circles around the vertices, with half the length of the shortest edge at the vertex as radius.
pub(super) struct Packing {
    /// (n,): u of each vertex.
    pub factors: Vec<f64>,
    /// I of each edge.
    pub distances: Vec<f64>,
}

impl Packing {
    /// The circles for given lengths of the edges.
    pub(super) fn new(n_vertices: usize, edges: &Edges, lengths: &[f64]) -> Self {
        let mut radii = vec![f64::INFINITY; n_vertices];
        for (edge, ends) in edges.ends.iter().enumerate() {
            for &end in ends {
                radii[end] = radii[end].min(0.5 * lengths[edge]);
            }
        }
        let distances = parallel::map(edges.len(), |edge| {
            let [r, s] = edges.at_ends(edge, &radii);
            // I = 1 + (L² − (r + s)²) / (2 r s)
            (1.0 + (lengths[edge] - (r + s)) * (lengths[edge] + (r + s)) / (2.0 * r * s)).max(1.0)
        });
        Self { factors: parallel::map(n_vertices, |v| factor_of_radius(radii[v])), distances }
    }
}

/// u = ln tanh(r/2).
pub(super) fn factor_of_radius(radius: f64) -> f64 {
    (0.5 * radius).tanh().ln()
}

/// The radius of the circle with the factor u.
pub(super) fn radius_of_factor(u: f64) -> f64 {
    2.0 * u.exp().atanh()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn check(conformal: &Conformal, factors: [f64; 2]) {
        let exact = conformal.length_derivatives(0, factors);
        for end in 0..2 {
            let step = 1e-6 * factors[end].abs().clamp(0.05, 1.0);
            let moved = |by: f64| {
                conformal.length(0, std::array::from_fn(|k| factors[k] + if k == end { by } else { 0.0 }))
            };
            let difference = (moved(step) - moved(-step)) / (2.0 * step);
            assert!((difference - exact[end]).abs() < 1e-6 * exact[end].abs(), "{difference} {exact:?}");
        }
    }

    proptest! {
        #[test]
        fn derivatives_are_those_of_differences(
            (length, distance) in (1e-2..3.0_f64, 1.0..50.0_f64), r in 1e-3..3.0_f64, s in 1e-3..3.0_f64,
        ) {
            check(&Conformal::VertexScaling(vec![length]), [r - 1.0, s - 1.0]);
            check(&Conformal::InversiveDistance(vec![distance]), [r, s].map(factor_of_radius));
        }

        #[test]
        fn circles_have_the_length_of_the_cosine_law(distance in 1.0..50.0_f64, r in 0.1..3.0_f64, s in 0.1..3.0_f64) {
            let length = Conformal::InversiveDistance(vec![distance]).length(0, [r, s].map(factor_of_radius));
            let cosine = r.cosh() * s.cosh() + distance * r.sinh() * s.sinh();
            prop_assert!((length.cosh() / cosine - 1.0).abs() < 1e-12);
            prop_assert!((radius_of_factor(factor_of_radius(r)) - r).abs() < 1e-12);
        }
    }

    #[test]
    fn tangential_circles_touch() {
        let tangential = Conformal::InversiveDistance(vec![1.0]);
        assert!((tangential.length(0, [0.3, 1e-9].map(factor_of_radius)) - 0.300_000_001).abs() < 1e-15);
    }
}
