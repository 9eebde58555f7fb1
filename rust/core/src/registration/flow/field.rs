// SPDX-License-Identifier: MIT OR Apache-2.0
//! The smoothest divergence-free velocity field with given velocities at given points.
//!
//! Its stream function ψ is a Gaussian process with a Matérn kernel φ(|x − y|) of order 5/2 on the sphere, and with
//! b(x) b(y) φ(|x − y|) in the disk, where b = 1 − |x|² keeps ψ zero on the circle. The velocity is ∇ψ turned by a
//! right angle, so it changes no area, and on the circle it runs along it. Both kernels have a term for rotations of
//! the whole domain, which change no angle either: x · y on the sphere, b(x) b(y) in the disk. Given k velocities, the
//! most probable field is a sum over the k points whose weights solve a positive definite system of 2k unknowns.
//!
//! Cost: k³ for the weights, k for the velocity at a point.

use crate::codomain::CanonicalDomain;
use crate::codomain::motion::Frame;
use crate::parallel;
use crate::sparse::solve_positive_definite;
use crate::vector::Vector3;

/// Ridge on the diagonal of the system, relative to its largest entry.
const RIDGE: f64 = 1e-10;

/// Variance of the rotation of the whole domain, relative to that of the Matérn kernel.
const ROTATION: f64 = 1.0;

/// A divergence-free velocity field on the domain.
#[derive(Debug, Clone)]
pub(super) struct Field {
    domain: CanonicalDomain,
    scale: f64,
    sources: Vec<Source>,
}

/// The term of one point in the stream function: with D = scale · (x − place) and g = −φ'/|D| it is
/// `mass` φ + g `pull` · D, times b(x) in the disk.
#[derive(Debug, Clone, Copy, Default)]
struct Source {
    place: Vector3,
    pull: Vector3,
    mass: f64,
}

impl Field {
    /// The field that has `velocities` at `places`, up to the ridge; `length` is the length scale of the kernel. `None`
    /// if the places are too close to each other.
    pub(super) fn through(
        domain: CanonicalDomain,
        length: f64,
        places: &[Vector3],
        velocities: &[Vector3],
    ) -> Option<Self> {
        let scale = 5f64.sqrt() / length;
        let frames: Vec<Frame> = places.iter().map(|&x| domain.motion(false).frame(x)).collect();
        // 1. The velocities along the axes of each place, and their covariance
        let mut weights: Vec<f64> =
            (0..2 * places.len()).map(|row| velocities[row / 2].dot(frames[row / 2].axes[row % 2])).collect();
        let mut matrix = responses(domain, scale, places, &frames);
        // 2. The weights that yield these velocities
        let size = weights.len();
        let largest = (0..size).fold(0.0, |largest, i| f64::max(largest, matrix[i * (size + 1)]));
        (0..size).for_each(|i| matrix[i * (size + 1)] += RIDGE * largest);
        if !solve_positive_definite(&mut matrix, &mut weights) {
            return None;
        }
        // 3. Both weights of a place together
        let source = |i: usize| {
            let [a, b] = frames[i].axes;
            let weight = a * weights[2 * i] + b * weights[2 * i + 1];
            Source::new(domain, scale, places[i], weight)
        };
        Some(Self { domain, scale, sources: (0..places.len()).map(source).collect() })
    }

    /// The velocity at a point, which may lie slightly off the domain.
    pub(super) fn velocity(&self, x: Vector3) -> Vector3 {
        velocity(self.domain, self.scale, &self.sources, x)
    }
}

impl Source {
    /// The field of a unit covariance with the velocity at `place` along `weight`.
    fn new(domain: CanonicalDomain, scale: f64, place: Vector3, weight: Vector3) -> Self {
        match domain {
            CanonicalDomain::Sphere => Self { place, pull: weight.cross(place), mass: 0.0 },
            CanonicalDomain::Disk => {
                let turned = [weight[1], -weight[0]];
                let (bubble, slope) = bubble(place);
                let mass = turned[0] * slope[0] + turned[1] * slope[1];
                Self {
                    place,
                    pull: Vector3([scale * bubble * turned[0], scale * bubble * turned[1], 0.0]),
                    mass,
                }
            }
        }
    }
}

/// b(x), which is zero on the circle, and its gradient.
fn bubble(Vector3([u, v, _]): Vector3) -> (f64, [f64; 2]) {
    (1.0 - u * u - v * v, [-2.0 * u, -2.0 * v])
}

/// The lower triangle of the covariance of the velocities at the places along their axes, column by column.
fn responses(domain: CanonicalDomain, scale: f64, places: &[Vector3], frames: &[Frame]) -> Vec<f64> {
    let k = places.len();
    // entries [α][β]: the velocity at i along its axis α for a unit weight at j along its axis β
    let blocks = parallel::map(k * k, |pair| {
        let (j, i) = (pair / k, pair % k);
        if i < j {
            return [[0.0; 2]; 2];
        }
        let by =
            |weight| velocity(domain, scale, &[Source::new(domain, scale, places[j], weight)], places[i]);
        let answers = frames[j].axes.map(by);
        frames[i].axes.map(|axis| answers.map(|answer| axis.dot(answer)))
    });
    parallel::map(4 * k * k, |entry| {
        let (column, row) = (entry / (2 * k), entry % (2 * k));
        blocks[column / 2 * k + row / 2][row % 2][column % 2]
    })
}

fn velocity(domain: CanonicalDomain, scale: f64, sources: &[Source], x: Vector3) -> Vector3 {
    match domain {
        CanonicalDomain::Sphere => x.cross(spherical_gradient(scale, sources, x)),
        CanonicalDomain::Disk => {
            let (value, slope) = planar_stream(scale, sources, x);
            let (bubble, bubble_slope) = bubble(x);
            let gradient = [0, 1].map(|k| value * bubble_slope[k] + bubble * slope[k]);
            Vector3([-gradient[1], gradient[0], 0.0])
        }
    }
}

/// ∇ψ / scale = Σ g pull + h (pull · D) D, with h = g'/|D|.
fn spherical_gradient(scale: f64, sources: &[Source], x: Vector3) -> Vector3 {
    let mut gradient = Vector3::ZERO;
    for Source { place, pull, .. } in sources {
        let d = (x - *place) * scale;
        let (_, g, h) = matern(d.dot(d));
        let along = h * pull.dot(d);
        gradient += *pull * (g + ROTATION) + d * along;
    }
    gradient
}

/// ψ/b and its gradient.
fn planar_stream(scale: f64, sources: &[Source], x: Vector3) -> (f64, [f64; 2]) {
    let (mut value, mut gradient) = (0.0, [0.0; 2]);
    for Source { place, pull, mass } in sources {
        let d = [scale * (x[0] - place[0]), scale * (x[1] - place[1])];
        let (phi, g, h) = matern(d[0] * d[0] + d[1] * d[1]);
        let toward = pull[0] * d[0] + pull[1] * d[1];
        value += mass * (phi + ROTATION) + g * toward;
        let along = h * toward - mass * g;
        gradient = [0, 1].map(|k| gradient[k] + scale * (g * pull[k] + along * d[k]));
    }
    (value, gradient)
}

/// The Matérn kernel φ(s) of order 5/2, g = −φ'/s and h = g'/s, of s².
#[inline(always)]
fn matern(square: f64) -> (f64, f64, f64) {
    let s = square.sqrt();
    let third = (-s).exp() / 3.0;
    (third * (3.0 + 3.0 * s + square), third * (1.0 + s), -third)
}
