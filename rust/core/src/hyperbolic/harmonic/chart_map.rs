// SPDX-License-Identifier: MIT OR Apache-2.0
//! A map into an atlas: the chart and the place of each vertex, the harmonic energy and its derivatives.

use super::atlas::{Atlas, Walk};
use super::delaunay::{Net, Weighted, delaunay};
use super::initial::Places;
use crate::error::Error;
use crate::hyperbolic::moebius::{Complex, Moebius, exponential, seen_from};
use crate::mesh::{Corner, Vertex};
use crate::parallel;
use crate::sparse::{Analysis, Factor, Order};

/// Distance below which d coth d and d / sinh d are taken from their series.
const SERIES: f64 = 1e-4;

/// A map into the atlas of the target, by local charts.
pub(crate) struct ChartMap<'a> {
    /// The atlas of the target.
    pub atlas: &'a Atlas<'a>,
    /// The places of the vertices.
    pub places: Places,
    /// The faces of the source, with transitions between the charts of their vertices' places.
    pub input: Net,
    /// The triangulation whose edges carry the energy.
    pub intrinsic: Net,
    /// (3 m,): the weight of the edge opposite to each corner of `intrinsic`.
    pub weights: Vec<f64>,
    /// The edges of `intrinsic` between ends that are not both held, each by one corner.
    edges: Vec<Corner>,
    /// The energy of the identity of the source on these edges.
    pub rest_energy: f64,
}

/// The pull of an edge at both ends.
#[derive(Clone, Copy, Default)]
pub(super) struct Pull {
    ends: [Vertex; 2],
    weight: f64,
    distance: f64,
    /// The unit vectors at each end toward the other.
    toward: [Complex; 2],
}

impl<'a> ChartMap<'a> {
    /// The map with `places`, its energy taken on the Delaunay triangulation of the source, whose edges have these
    /// `lengths`; faces that are `kept` stay in it.
    pub(crate) fn by_delaunay(
        atlas: &'a Atlas<'a>,
        places: Places,
        input: Net,
        lengths: &[[f64; 3]],
        kept: &[bool],
    ) -> Self {
        let Weighted { net: intrinsic, weights, lengths } = delaunay(input.clone(), lengths, kept);
        let mut map = Self { atlas, places, input, intrinsic, weights, edges: Vec::new(), rest_energy: 0.0 };
        map.edges = Corner::all(map.intrinsic.faces.len()).filter(|&corner| map.counts(corner)).collect();
        let rest = |&corner: &Corner| 0.5 * map.weights[corner] * lengths[corner].powi(2);
        map.rest_energy = map.edges.iter().map(rest).sum();
        map
    }

    /// Whether the edge of a corner counts, from this side; edges between two held vertices do not.
    fn counts(&self, corner: Corner) -> bool {
        let across = self.intrinsic.opposite[corner];
        let is_held = |vertex: Vertex| self.places.held[vertex].is_some();
        let [tail, head] = self.intrinsic.ends(corner);
        across.is_none_or(|across| corner < across) && !(is_held(tail) && is_held(head))
    }

    /// E at the present places.
    pub(crate) fn energy(&self) -> f64 {
        self.energy_at(&self.places.positions)
    }

    /// E with the vertices at other positions in their charts.
    pub(crate) fn energy_at(&self, positions: &[Complex]) -> f64 {
        parallel::sum(self.edges.len(), |edge| {
            let pull = self.pull(self.edges[edge], positions);
            0.5 * pull.weight * pull.distance * pull.distance
        })
    }

    fn pull(&self, corner: Corner, positions: &[Complex]) -> Pull {
        let ends = self.intrinsic.ends(corner);
        let [a, x] = ends.map(|vertex| positions[vertex]);
        let transition = self.intrinsic.transitions[corner];
        let b = transition.apply(x);
        let (there, back) = (seen_from(a, b), seen_from(b, a));
        let size = there.norm();
        let unit = |z: Complex| if size > 0.0 { z / z.norm() } else { Complex::new(1.0, 0.0) };
        let turn = transition.derivative(x);
        let away = if size > 0.0 { unit(back) } else { Complex::new(-1.0, 0.0) };
        let toward = [unit(there), away * (turn / turn.norm()).conj()];
        Pull { ends, weight: self.weights[corner], distance: 2.0 * size.atanh(), toward }
    }

    /// The pulls of all edges.
    pub(super) fn pulls(&self) -> Vec<Pull> {
        parallel::map(self.edges.len(), |edge| self.pull(self.edges[edge], &self.places.positions))
    }

    /// (n,): the gradient of E in the orthonormal frame of each vertex; zero at held vertices.
    pub(super) fn gradient(&self, pulls: &[Pull]) -> Vec<Complex> {
        let mut gradient = vec![Complex::default(); self.places.positions.len()];
        for pull in pulls {
            for (vertex, toward) in pull.ends.into_iter().zip(pull.toward) {
                gradient[vertex] -= pull.weight * pull.distance * toward;
            }
        }
        for (slope, held) in gradient.iter_mut().zip(&self.places.held) {
            *slope = if held.is_some() { Complex::default() } else { *slope };
        }
        gradient
    }

    /// (n,): the gradient at the present places.
    pub(crate) fn gradient_now(&self) -> Vec<Complex> {
        self.gradient(&self.pulls())
    }

    /// (n,): the sum of the weights at each vertex.
    pub(super) fn stiffness(&self) -> Vec<f64> {
        let mut sums = vec![0.0; self.places.positions.len()];
        for &corner in &self.edges {
            let ends = self.intrinsic.ends(corner);
            ends.iter().for_each(|&vertex| sums[vertex] += self.weights[corner]);
        }
        sums
    }

    /// The pattern of the Hessian: two unknowns for each vertex that is not held, and an additional held vertex that
    /// makes triangles of edges.
    pub(super) fn analysis(&self) -> Result<Analysis, Error> {
        let n = self.places.positions.len();
        let mut dofs: Vec<u8> =
            self.places.held.iter().map(|held| if held.is_some() { 0 } else { 2 }).collect();
        dofs.push(0);
        let clique = |&corner: &Corner| match self.intrinsic.ends(corner) {
            [tail, head] if tail == head => [tail, Vertex::new(n), Vertex::new(n)],
            [tail, head] => [tail, head, Vertex::new(n)],
        };
        let cliques: Vec<[Vertex; 3]> = self.edges.iter().map(clique).collect();
        Analysis::new(dofs.len(), &cliques, &dofs, Order::Sparse)
    }

    pub(super) fn direction(
        &self,
        analysis: &Analysis,
        factor: &Factor<f64>,
        slopes: &[Complex],
    ) -> Vec<Complex> {
        let mut rhs = vec![0.0; analysis.n_unknowns()];
        let is_free = |vertex: usize| self.places.held[vertex].is_none();
        for vertex in (0..slopes.len()).filter(|&vertex| is_free(vertex)) {
            let first = analysis.first_unknown(vertex);
            (rhs[first], rhs[first + 1]) = (-slopes[vertex].re, -slopes[vertex].im);
        }
        factor.solve(analysis, &mut rhs);
        parallel::map(slopes.len(), |vertex| {
            if is_free(vertex) {
                let first = analysis.first_unknown(vertex);
                Complex::new(rhs[first], rhs[first + 1])
            } else {
                Complex::default()
            }
        })
    }

    /// The positions after every vertex has moved along its geodesic, by `factor` times its move.
    pub(crate) fn moved(&self, moves: &[Complex], factor: f64) -> Vec<Complex> {
        let (positions, held) = (&self.places.positions, &self.places.held);
        parallel::map(positions.len(), |vertex| match held[vertex] {
            Some(_) => positions[vertex],
            None => exponential(positions[vertex], factor * moves[vertex]),
        })
    }

    /// Takes new positions in the present charts, and changes to the charts of the faces in which they lie.
    pub(crate) fn recharted(&mut self, positions: Vec<Complex>) {
        let (atlas, places) = (self.atlas, &self.places);
        let stays = |vertex: usize| Walk {
            face: places.faces[vertex],
            x: positions[vertex],
            motion: Moebius::default(),
            is_outside: false,
        };
        let walks = parallel::map(positions.len(), |vertex| match places.held[vertex] {
            Some(_) => stays(vertex),
            None => atlas.walk(places.faces[vertex], positions[vertex]),
        });
        for net in [&mut self.input, &mut self.intrinsic] {
            let (faces, old) = (&net.faces, &net.transitions);
            net.transitions = parallel::map(old.len(), |corner| {
                let [tail, head] = Corner::new(corner).half_edge(faces).map(|vertex| walks[vertex].motion);
                if tail == Moebius::default() && head == Moebius::default() {
                    old[corner]
                } else {
                    tail * old[corner] * head.inverse()
                }
            });
        }
        self.places.faces = walks.iter().map(|walk| walk.face).collect();
        self.places.positions = walks.iter().map(|walk| walk.x).collect();
    }
}

/// The Hessian of ½ w d², two rows for each end.
pub(super) fn hessian(pull: &Pull) -> [[f64; 6]; 6] {
    let d = pull.distance;
    let (along, across) =
        if d < SERIES { (1.0 + d * d / 3.0, 1.0 - d * d / 6.0) } else { (d / d.tanh(), d / d.sinh()) };
    let [e, f] = pull.toward.map(|z| [z.re, z.im]);
    let [n, o] = pull.toward.map(|z| [-z.im, z.re]);
    let mut matrix = [[0.0; 6]; 6];
    for row in 0..2 {
        for column in 0..2 {
            let end =
                |u: [f64; 2], v: [f64; 2]| pull.weight * (u[row] * u[column] + along * v[row] * v[column]);
            // the vectors at the ends point toward each other along a geodesic, so their normals are opposite too
            let both = pull.weight * (e[row] * f[column] + across * n[row] * o[column]);
            matrix[row][column] = end(e, n);
            matrix[2 + row][2 + column] = end(f, o);
            matrix[row][2 + column] = both;
            matrix[2 + column][row] = both;
        }
    }
    if pull.ends[0] == pull.ends[1] {
        return loop_hessian(&matrix);
    }
    matrix
}

/// The Hessian of an edge from a vertex to itself.
fn loop_hessian(matrix: &[[f64; 6]; 6]) -> [[f64; 6]; 6] {
    let mut sum = [[0.0; 6]; 6];
    for row in 0..4 {
        for column in 0..4 {
            sum[row % 2][column % 2] += matrix[row][column];
        }
    }
    sum
}
