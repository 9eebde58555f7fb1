// SPDX-License-Identifier: MIT OR Apache-2.0
//! A start map without folds for every closed surface of genus 0: coarse to fine.
//!
//! The surface is decimated to a tetrahedron, which is laid onto the sphere, and gets its vertices back one
//! by one. The vertices around the one that comes back form a polygon that is star-shaped from the vertex it
//! went onto, so there is room for it near that one; it is placed there and then moved, with its neighbours,
//! to lower an energy of area and shape that is infinite at a fold. No face is ever folded, by a filtered
//! determinant, whatever the shape: a conformal or Tutte map shrinks a tentacle of length L and girth c by
//! exp(−2π L/c), beyond double precision, and this one does not.
//!
//! Per face with target T, D = det(x_i, x_j, x_k), ρ = D/2T and Q = Σ edge²/2√3:
//!
//! ```text
//! E = T (ρ + 1/ρ − 2) + λ T (Q/D − 1),     λ = 0.3.
//! ```
//!
//! Cost: O(n log n), some sixty one-vertex Newton steps for each vertex, on one thread.

use std::f64::consts::PI;

use super::Map;
use super::domain::is_clearly_positive;
use crate::control::{Observer, Status};
use crate::mesh::TriangleMesh;
use crate::mesh::decimation::Decimation;
use crate::mesh::geometry::{Vector, add, cross, dot, norm, scaled, sub};

/// λ, the weight of the shape in the energy.
const SHAPE: f64 = 0.3;

/// λ of the sweeps over a whole map, one after the other.
const RELAXED_SHAPES: [f64; 4] = [0.3, 0.1, 0.03, 0.01];

/// Newton steps of a vertex that has come back.
const NEWTON_STEPS: usize = 5;

/// Sweeps over all vertices whenever their number has doubled: on small meshes, and on large ones.
const SWEEPS: [usize; 2] = [10, 4];

/// Up to so many vertices a mesh is small.
const SMALL: usize = 5_000;

/// The progressive map of `mesh` for target areas on any common scale, or `None` where double precision does
/// not suffice.
pub(super) fn progressive(mesh: &TriangleMesh, targets: &[f64]) -> Option<Map> {
    // 1. Down to a tetrahedron
    let scale = 4.0 * PI / targets.iter().sum::<f64>();
    let mut decimation = Decimation::new(mesh, targets.iter().map(|target| scale * target).collect());
    decimation.coarsen(4);
    // 2. The tetrahedron on the sphere
    let mut embedding = Embedding { map: vec![[0.0; 3]; mesh.n_vertices()], decimation, shape: SHAPE };
    let mut placed = embedding.lay_base()?;
    // 3. One vertex after the other comes back
    let mut next_sweep = 2 * placed.len();
    while let Some(collapse) = embedding.decimation.refine() {
        embedding.insert(collapse.vertex, collapse.onto)?;
        placed.push(collapse.vertex);
        // 4. All vertices once more whenever their number has doubled
        if placed.len() == next_sweep || placed.len() == mesh.n_vertices() {
            next_sweep *= 2;
            for _ in 0..SWEEPS[usize::from(placed.len() > SMALL)] {
                placed.iter().for_each(|&vertex| embedding.relax(vertex));
            }
        }
    }
    Some(embedding.map)
}

/// A map without folds relaxed by sweeps of one-vertex Newton steps, none of which folds a face, the shape
/// weighing less and less; `Cancelled` where the observer ended it early.
pub(super) fn relaxed(
    mesh: &TriangleMesh,
    targets: &[f64],
    map: Map,
    observer: &mut dyn Observer,
) -> (Map, Status) {
    let scale = 4.0 * PI / targets.iter().sum::<f64>();
    let decimation = Decimation::new(mesh, targets.iter().map(|target| scale * target).collect());
    let mut embedding = Embedding { map, decimation, shape: SHAPE };
    let each = SWEEPS[usize::from(mesh.n_vertices() > SMALL)];
    let sweeps = each * RELAXED_SHAPES.len();
    for sweep in 0..sweeps {
        if !observer.progress(sweep as f64 / sweeps as f64, "Relaxing") {
            return (embedding.map, Status::Cancelled);
        }
        embedding.shape = RELAXED_SHAPES[sweep / each];
        (0..mesh.n_vertices() as u32).for_each(|vertex| embedding.relax(vertex));
    }
    (embedding.map, Status::MaxIterations)
}

/// A map of the vertices that are back, with what they are connected by.
struct Embedding<'a> {
    map: Map,
    decimation: Decimation<'a>,
    /// λ, the weight of the shape in the energy.
    shape: f64,
}

/// Two corners of a face seen from its third, with the face's target.
#[derive(Clone, Copy)]
struct Opposite {
    one: Vector,
    two: Vector,
    target: f64,
}

/// Energy, gradient and Hessian by the position of one vertex.
struct Derivatives {
    gradient: Vector,
    hessian: [Vector; 3],
}

impl Embedding<'_> {
    /// Lays the four vertices that are left onto the corners of a regular tetrahedron.
    fn lay_base(&mut self) -> Option<Vec<u32>> {
        let gone = |vertex: &u32| self.decimation.is_gone(*vertex);
        let base: Vec<u32> = (0..self.map.len() as u32).filter(|vertex| !gone(vertex)).collect();
        let third = 3f64.sqrt().recip();
        let corners = [[1., 1., 1.], [1., -1., -1.], [-1., 1., -1.], [-1., -1., 1.]];
        if base.len() != corners.len() {
            return None;
        }
        for sign in [third, -third] {
            base.iter().zip(corners).for_each(|(&v, corner)| self.map[v as usize] = scaled(corner, sign));
            if base.iter().all(|&vertex| is_open(self.map[vertex as usize], &self.star(vertex))) {
                return Some(base);
            }
        }
        None
    }

    /// Places a vertex that has come back from `onto`, and moves it and its neighbours.
    fn insert(&mut self, vertex: u32, onto: u32) -> Option<()> {
        let star = self.star(vertex);
        let centre = self.map[onto as usize];
        let mut place = kernel_centroid(centre, &star);
        // towards the vertex it went onto, where the polygon's kernel is
        let tries = (0..5).map(|_| {
            let tried = place;
            place = unit(add(scaled(centre, 0.9), scaled(tried, 0.1)));
            tried
        });
        let mut places = tries.filter(|&place| is_open(place, &star));
        self.map[vertex as usize] = places.next()?;
        for _ in 0..NEWTON_STEPS {
            self.relax(vertex);
        }
        let ring: Vec<u32> = self.decimation.star(vertex).map(|(next, _, _)| next).collect();
        ring.into_iter().chain([vertex]).for_each(|vertex| self.relax(vertex));
        Some(())
    }

    /// One Newton step of one vertex on the energy of its star, which never folds a face.
    fn relax(&mut self, vertex: u32) {
        let star = self.star(vertex);
        let x = self.map[vertex as usize];
        let basis = tangent_basis(x);
        let Some((direction, slope)) = newton_direction(x, basis, &star, self.shape) else { return };
        let energy = energy(x, &star, self.shape);
        let mut step = (0.5 / direction[0].hypot(direction[1])).min(1.0);
        for _ in 0..12 {
            let [a, b] = direction.map(|d| step * d);
            let moved = unit(add(x, add(scaled(basis[0], a), scaled(basis[1], b))));
            if is_open(moved, &star) && self::energy(moved, &star, self.shape) <= energy + 1e-4 * step * slope
            {
                self.map[vertex as usize] = moved;
                return;
            }
            step *= 0.4;
        }
    }

    fn star(&self, vertex: u32) -> Vec<Opposite> {
        let corners = self.decimation.star(vertex);
        corners
            .map(|(one, two, target)| Opposite {
                one: self.map[one as usize],
                two: self.map[two as usize],
                target,
            })
            .collect()
    }
}

/// Whether all faces of a star are positive by more than the rounding of their determinants.
fn is_open(x: Vector, star: &[Opposite]) -> bool {
    star.iter().all(|face| is_clearly_positive([x, face.one, face.two]))
}

/// det(x, one, two) in the form of differences, and Q.
fn determinant_and_size(x: Vector, face: &Opposite) -> (f64, f64) {
    let (p, q) = (sub(face.one, x), sub(face.two, x));
    let r = sub(face.two, face.one);
    (dot(x, cross(p, q)), (dot(p, p) + dot(q, q) + dot(r, r)) / (2.0 * 3f64.sqrt()))
}

/// The energy of a star, all of whose faces are positive.
fn energy(x: Vector, star: &[Opposite], shape: f64) -> f64 {
    let of_face = |face: &Opposite| {
        let (d, q) = determinant_and_size(x, face);
        let ratio = 0.5 * d / face.target;
        face.target * (ratio + 1.0 / ratio - 2.0 + shape * (q / d - 1.0))
    };
    star.iter().map(of_face).sum()
}

/// The derivatives of the energy by x in space.
fn derivatives(x: Vector, star: &[Opposite], shape: f64) -> Derivatives {
    let mut sum = Derivatives { gradient: [0.0; 3], hessian: [[0.0; 3]; 3] };
    for face in star {
        let (d, q) = determinant_and_size(x, face);
        let (target, ratio) = (face.target, 0.5 * d / face.target);
        // ∇D = one × two, by differences; ∇Q = (2x − one − two)/√3; Hess Q = 2/√3
        let (to_one, to_two) = (sub(face.one, x), sub(face.two, x));
        let by_d = cross(face.one, sub(face.two, face.one));
        let by_q = scaled(add(to_one, to_two), -1.0 / 3f64.sqrt());
        let shape = shape * target;
        let on_d = 0.5 * (1.0 - ratio.powi(-2)) - shape * q / (d * d);
        let on_dd = 0.5 * ratio.powi(-3) / target + 2.0 * shape * q / d.powi(3);
        let on_dq = -shape / (d * d);
        for row in 0..3 {
            sum.gradient[row] += on_d * by_d[row] + shape / d * by_q[row];
            for column in 0..3 {
                sum.hessian[row][column] += on_dd * by_d[row] * by_d[column]
                    + on_dq * (by_d[row] * by_q[column] + by_q[row] * by_d[column]);
            }
            sum.hessian[row][row] += shape / d * 2.0 / 3f64.sqrt();
        }
    }
    sum
}

/// The Newton direction in tangent coordinates with its slope, eigenvalues made positive; `None` at a
/// minimum.
fn newton_direction(x: Vector, basis: [Vector; 2], star: &[Opposite], shape: f64) -> Option<([f64; 2], f64)> {
    let Derivatives { gradient, hessian } = derivatives(x, star, shape);
    let times = |z: Vector| hessian.map(|row| dot(row, z));
    let curvature = dot(gradient, x);
    let g = basis.map(|axis| dot(axis, gradient));
    let [a, b, c] = [
        dot(basis[0], times(basis[0])) - curvature,
        dot(basis[0], times(basis[1])),
        dot(basis[1], times(basis[1])) - curvature,
    ];
    // eigenvalues of [[a, b], [b, c]] and the direction of the larger one
    let (mean, radius) = (0.5 * (a + c), (0.5 * (a - c)).hypot(b));
    let angle = 0.5 * (2.0 * b).atan2(a - c);
    let (sine, cosine) = angle.sin_cos();
    let largest = (mean + radius).abs().max((mean - radius).abs());
    let [one, two] = [mean + radius, mean - radius].map(|value| value.abs().max(1e-3 * largest));
    let (along, across) = (cosine * g[0] + sine * g[1], -sine * g[0] + cosine * g[1]);
    let (along, across) = (-along / one, -across / two);
    let direction = [cosine * along - sine * across, sine * along + cosine * across];
    let slope = g[0] * direction[0] + g[1] * direction[1];
    (slope < 0.0 && slope.is_finite()).then_some((direction, slope))
}

/// Two unit vectors that make an orthonormal frame with the unit vector `x`.
fn tangent_basis(x: Vector) -> [Vector; 2] {
    let smallest = (0..3).min_by(|&a, &b| x[a].abs().total_cmp(&x[b].abs())).expect("three axes");
    let axis: Vector = std::array::from_fn(|k| if k == smallest { 1.0 } else { 0.0 });
    let first = unit(cross(x, axis));
    [first, cross(x, first)]
}

/// The centroid, in the gnomonic chart at `centre`, of the points from which all edges of the star's polygon
/// run counter-clockwise.
fn kernel_centroid(centre: Vector, star: &[Opposite]) -> Vector {
    let basis = tangent_basis(centre);
    let reach = star.iter().map(|face| norm(sub(face.one, centre))).fold(0.0, f64::max);
    let mut polygon = vec![[-reach, -reach], [reach, -reach], [reach, reach], [-reach, reach]];
    for face in star {
        let (p, q) = (sub(face.one, centre), sub(face.two, centre));
        let normal = cross(face.one, sub(face.two, face.one));
        // exactly 0 for the two edges that end at the centre itself
        let constant = dot(centre, cross(p, q));
        let [a, b] = basis.map(|axis| dot(axis, normal));
        polygon = clipped(&polygon, |z| constant + a * z[0] + b * z[1]);
    }
    let [a, b] = centroid(&polygon);
    unit(add(centre, add(scaled(basis[0], a), scaled(basis[1], b))))
}

/// The part of a convex polygon where `height` is not negative.
fn clipped(polygon: &[[f64; 2]], height: impl Fn([f64; 2]) -> f64) -> Vec<[f64; 2]> {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (k, &from) in polygon.iter().enumerate() {
        let to = polygon[(k + 1) % polygon.len()];
        let (here, there) = (height(from), height(to));
        if here >= 0.0 {
            kept.push(from);
        }
        if (here > 0.0 && there < 0.0) || (here < 0.0 && there > 0.0) {
            let part = here / (here - there);
            kept.push([0, 1].map(|axis| from[axis] + part * (to[axis] - from[axis])));
        }
    }
    kept
}

/// The centroid of a convex polygon, of its corners where it has no area; the origin where it is empty.
fn centroid(polygon: &[[f64; 2]]) -> [f64; 2] {
    let Some(&first) = polygon.first() else { return [0.0; 2] };
    let (mut total, mut sum) = (0.0, [0.0; 2]);
    for pair in polygon.windows(2) {
        let [a, b] = [pair[0], pair[1]].map(|z| [z[0] - first[0], z[1] - first[1]]);
        let area = a[0] * b[1] - a[1] * b[0];
        total += area;
        (0..2).for_each(|axis| sum[axis] += area * (a[axis] + b[axis]) / 3.0);
    }
    if total > 0.0 {
        return [0, 1].map(|axis| first[axis] + sum[axis] / total);
    }
    let count = polygon.len() as f64;
    [0, 1].map(|axis| polygon.iter().map(|z| z[axis]).sum::<f64>() / count)
}

fn unit(x: Vector) -> Vector {
    scaled(x, 1.0 / norm(x))
}
