// SPDX-License-Identifier: MIT OR Apache-2.0
//! The normal equations of the areas of a patch, solved roughly by conjugate gradients.
//!
//! With the residuals r of the areas ([`residual`]) and their slopes J = ∂r/∂x in the places x of the vertices, a
//! damped Gauss–Newton step d of the energy Σ r² solves
//!
//! ```text
//! (JᵀJ + μ D) d = −Jᵀ r,     D the diagonal of JᵀJ, μ the damping of each vertex
//! ```
//!
//! (Levenberg, A Method for the Solution of Certain Non-Linear Problems in Least Squares, 1944; Marquardt, An Algorithm
//! for Least-Squares Estimation of Nonlinear Parameters, 1963). D scales each axis separately: triangles at a pole are
//! a thousand times as wide as they are high. The errors are local, so a few iterations with the preconditioner D
//! suffice.

use super::chart::{Chart, Point};
use super::patch::Patch;
use super::projection::Projection;
use crate::control::Watch;
use crate::mesh::{Corner, Face, Vertex};
use crate::parallel;

/// Iteration limit.
const ITERATIONS: usize = 20;

/// Relative tolerance of the residual in the norm of the preconditioner.
const TOLERANCE: f64 = 0.06;

/// Ratio of area to target below which the residual is linear, so that it is defined for folded faces too.
const STEEPEST: f64 = 0.05;

/// One vector per vertex that moves, and one zero vector for all vertices that stay.
type Step = Vec<[f64; 2]>;

/// The normal equations at one state of a patch.
pub(super) struct AreaSystem<'a> {
    patch: &'a Patch,
    /// J at the corners of each face; 0 at vertices that stay.
    slopes: Vec<[[f64; 2]; 3]>,
    /// J in the order of the vertices, with the face of each, so that gathering reads memory in order.
    slopes_by_vertex: Vec<(Face, [f64; 2])>,
    /// The diagonal matrix D.
    diagonal: Step,
    /// The right-hand side −Jᵀ r.
    right: Step,
}

impl<'a> AreaSystem<'a> {
    /// The equations at the present `images` and `areas` of the patch's faces.
    pub fn new<P: Projection>(
        chart: &Chart<'_, P>,
        patch: &'a Patch,
        images: &[[Point; 3]],
        areas: &[f64],
        targets: &[f64],
    ) -> Self {
        let residuals = parallel::map(areas.len(), |face| residual(areas[face], targets[face]));
        let mut slopes = parallel::map(images.len(), |face| area_slopes(images[face]));
        add_slopes_of_polar_corners(&patch.polar, &mut slopes);
        parallel::fill_with_old(&mut slopes, |face, slopes| {
            let isometries = chart.isometries[patch.faces[face]];
            std::array::from_fn(|corner| {
                let is_fixed = !patch.moves(face, corner);
                let scale = if is_fixed { 0.0 } else { isometries[corner].sign() * residuals[face][1] };
                slopes[corner].map(|slope| scale * slope)
            })
        });
        let residual: Vec<f64> = parallel::map(areas.len(), |face| -residuals[face][0]);
        let corners = patch.corners.all();
        let slopes_by_vertex = parallel::map(corners.len(), |index| {
            let (face, corner) = (corners[index].face(), corners[index].place());
            (face, slopes[face][corner])
        });
        let (diagonal, right) = (Vec::new(), Vec::new());
        let mut system = Self { patch, slopes, slopes_by_vertex, diagonal, right };
        system.diagonal = system.per_vertex([1.0; 2], |vertex| {
            let squares =
                system.slopes_at(vertex).iter().map(|(_, slopes)| slopes.map(|slope| slope * slope));
            let sum = squares.fold([0.0; 2], |[u, v], [x, y]| [u + x, v + y]);
            sum.map(|x| if x > 0.0 { x } else { 1.0 })
        });
        system.right = system.per_vertex([0.0; 2], |vertex| system.gathered(&residual, vertex));
        system
    }

    /// An approximate solution for the `damping` μ of each vertex that moves; a rougher one if the watch cancels.
    pub fn step(&self, damping: &[f64], watch: &Watch<'_>) -> Step {
        let n = self.right.len();
        let mut solution = vec![[0.0; 2]; n];
        let mut residual = self.right.clone();
        let mut toward = vec![[0.0; 2]; n];
        self.precondition(&residual, &mut toward);
        let mut direction = toward.clone();
        let mut norm = product(&residual, &toward);
        let goal = TOLERANCE.powi(2) * norm;
        // buffers shared by all iterations
        let (mut image, mut change) = (vec![[0.0; 2]; n], vec![0.0; self.slopes.len()]);
        for _ in 0..ITERATIONS {
            if norm <= goal || !watch.goes_on() {
                break;
            }
            self.apply(&direction, damping, &mut change, &mut image);
            let length = norm / product(&direction, &image);
            add_scaled(&mut solution, length, &direction);
            add_scaled(&mut residual, -length, &image);
            self.precondition(&residual, &mut toward);
            let previous = std::mem::replace(&mut norm, product(&residual, &toward));
            let factor = norm / previous;
            parallel::fill_with_old(&mut direction, |vertex, [x, y]| {
                [toward[vertex][0] + factor * x, toward[vertex][1] + factor * y]
            });
        }
        solution
    }

    /// Writes (JᵀJ + μ D) x to `image`, by way of J x.
    fn apply(&self, x: &[[f64; 2]], damping: &[f64], change: &mut [f64], image: &mut [[f64; 2]]) {
        parallel::fill(change, |face| {
            let (slopes, vertices) = (&self.slopes[face], self.patch.corners_of_faces[face]);
            (0..3).map(|k| dot(slopes[k], x[vertices[k]])).sum::<f64>()
        });
        let n_moving = self.patch.vertices.len();
        parallel::fill(&mut image[..n_moving], |vertex| {
            let [u, v] = self.gathered(change, vertex);
            let [a, b] = self.diagonal[vertex].map(|x| damping[vertex] * x);
            [u + a * x[vertex][0], v + b * x[vertex][1]]
        });
    }

    /// The entry at a vertex of Jᵀ times one value per face.
    fn gathered(&self, values: &[f64], vertex: usize) -> [f64; 2] {
        self.slopes_at(vertex).iter().fold([0.0; 2], |[u, v], &(face, [x, y])| {
            let value = values[face];
            [u + x * value, v + y * value]
        })
    }

    /// The faces at a vertex, with their J there.
    fn slopes_at(&self, vertex: usize) -> &[(Face, [f64; 2])] {
        &self.slopes_by_vertex[self.patch.corners.range(Vertex::new(vertex))]
    }

    /// One value for each vertex that moves, and one `at_rest` for all vertices that stay.
    fn per_vertex<T: Copy + Default + Send + Sync>(
        &self,
        at_rest: T,
        value: impl Fn(usize) -> T + Sync + Send,
    ) -> Vec<T> {
        let n_moving = self.patch.vertices.len();
        parallel::map(n_moving + 1, |vertex| if vertex < n_moving { value(vertex) } else { at_rest })
    }

    fn precondition(&self, values: &[[f64; 2]], out: &mut [[f64; 2]]) {
        parallel::fill(out, |vertex| {
            let ([x, y], [a, b]) = (values[vertex], self.diagonal[vertex]);
            [x / a, y / b]
        });
    }
}

/// The residual √a φ(A/a) of a face of area A with the target a, and its derivative in A.
///
/// φ(x) = x − 1 above the target and ln x below: a face that gets thin counts more than one that gets large.
pub(super) fn residual(area: f64, target: f64) -> [f64; 2] {
    let ratio = area / target;
    let [value, slope] = if ratio >= 1.0 {
        [ratio - 1.0, 1.0]
    } else if ratio > STEEPEST {
        [ratio.ln(), 1.0 / ratio]
    } else {
        [STEEPEST.ln() + (ratio - STEEPEST) / STEEPEST, 1.0 / STEEPEST]
    };
    [target.sqrt() * value, slope / target.sqrt()]
}

/// The gradient of the area of a triangle with respect to its corners.
fn area_slopes([a, b, c]: [Point; 3]) -> [[f64; 2]; 3] {
    let slope = |from: Point, to: Point| [0.5 * (from[1] - to[1]), 0.5 * (to[0] - from[0])];
    [slope(b, c), slope(c, a), slope(a, b)]
}

/// Adds the slopes of corners at poles, which move with the middle of the other corners.
fn add_slopes_of_polar_corners(polar: &[Vec<Corner>], slopes: &mut [[[f64; 2]; 3]]) {
    for &corner in polar.iter().flatten() {
        let (face, corner) = (corner.face(), corner.place());
        let slope = slopes[face][corner][0];
        for k in [(corner + 1) % 3, (corner + 2) % 3] {
            slopes[face][k][0] += 0.5 * slope;
        }
    }
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn product(a: &[[f64; 2]], b: &[[f64; 2]]) -> f64 {
    parallel::sum(a.len(), |vertex| dot(a[vertex], b[vertex]))
}

/// `to += factor · step`.
fn add_scaled(to: &mut [[f64; 2]], factor: f64, step: &[[f64; 2]]) {
    parallel::fill_with_old(to, |vertex, [x, y]| {
        [x + factor * step[vertex][0], y + factor * step[vertex][1]]
    });
}
