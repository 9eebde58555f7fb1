// SPDX-License-Identifier: MIT OR Apache-2.0
//! Data by vertices, carried without the facets of a coarse target.
//!
//! Linear interpolation has creases at the edges of the target. Here the data are a cubic on each third of a triangle,
//! with the values at its vertices and gradients that are estimated there (Clough & Tocher 1965, in the reduced form of
//! Bernadou & Hassan 1981, whose derivatives across edges are linear along them): differentiable on a flat mesh, and up
//! to the angle defects on a curved one. Quadratic functions of the plane are reproduced.
//!
//! A gradient is that of the quadratic function through the vertex that fits its neighbors best, in the tangent plane,
//! where neighbors keep their distance: a ring of them or, where that has fewer than six, two. Faces on which the data are constant keep that constant: where
//! weights are zero they stay zero.
//!
//! Cost: O(n) small systems for the gradients, and O(1) for each value.

use super::{heaviest, interpolated, rows};
use crate::location::Location;
use crate::mesh::geometry::{area_vector, triangle};
use crate::mesh::{Vertex, VertexCorners};
use crate::parallel;
use crate::sparse::solve_positive_definite;
use crate::vector::Vector3;

/// A term against second derivatives that few neighbors do not determine, relative to the other terms.
const CURVATURE: f64 = 1e-3;
/// The same against gradients.
const SLOPE: f64 = 1e-12;
/// The fewest neighbors that determine a quadratic function, with one to spare.
const RING: usize = 6;

/// Per-vertex data of the target at the vertices of the source, with gradients in the place of creases.
///
/// `values` are rows of `width` numbers, one per vertex of the target, `points` its vertices, `faces` its faces, and
/// `locations` (n,) those of the source vertices on them. Returns (n, width). Values that are not finite count only
/// where linear interpolation takes them.
///
/// # Panics
/// If there are too few `values` for the indices in `faces`.
pub fn pull_vertices_smoothly(
    values: &[f64],
    width: usize,
    points: &[Vector3],
    faces: &[[Vertex; 3]],
    locations: &[Location],
) -> Vec<f64> {
    // 1. Gradients at the vertices of the target
    let target = Charts::new(points, faces);
    let gradients = target.gradients(values, width);
    // 2. Their derivatives along the edges of the triangle of each vertex of the source, and the cubics there
    rows(locations.len(), width, |row, column| {
        let location = locations[row];
        let face = faces[location.triangle];
        let value = |k: usize| values[face[k].index() * width + column];
        let gradient = |k: usize| gradients[face[k].index() * width + column];
        let base = value(heaviest(location));
        let patch = Patch {
            values: std::array::from_fn(|k| value(k) - base),
            slopes: std::array::from_fn(|k| {
                let along = |end: usize| dot(gradient(k), target.place(face[k], face[end]));
                [along((k + 1) % 3), along((k + 2) % 3)]
            }),
        };
        let smooth = base + patch.at(location.barycentric, triangle(points, face));
        if smooth.is_finite() { smooth } else { interpolated(location, value) }
    })
}

fn dot([a, b]: [f64; 2], [x, y]: [f64; 2]) -> f64 {
    a * x + b * y
}

/// The tangent planes of a mesh.
struct Charts<'a> {
    points: &'a [Vector3],
    faces: &'a [[Vertex; 3]],
    corners: VertexCorners,
    /// Two orthogonal unit vectors at each vertex.
    axes: Vec<[Vector3; 2]>,
}

impl<'a> Charts<'a> {
    fn new(points: &'a [Vector3], faces: &'a [[Vertex; 3]]) -> Self {
        let corners = VertexCorners::new(points.len(), faces);
        let axes = parallel::map(points.len(), |vertex| {
            let around = corners.of(Vertex::new(vertex)).iter();
            let normals = around.map(|corner| area_vector(triangle(points, faces[corner.face()])));
            axes_across(normals.sum::<Vector3>())
        });
        Self { points, faces, corners, axes }
    }

    /// The place of a vertex in the tangent plane of another, at their distance.
    fn place(&self, at: Vertex, vertex: Vertex) -> [f64; 2] {
        let way = self.points[vertex] - self.points[at];
        let flat = self.axes[at].map(|axis| axis.dot(way));
        let length = flat[0].hypot(flat[1]);
        let scale = if length > 0.0 { way.norm() / length } else { 0.0 };
        flat.map(|x| scale * x)
    }

    /// The gradients of data at all vertices, (n, width).
    fn gradients(&self, values: &[f64], width: usize) -> Vec<[f64; 2]> {
        let mut gradients = vec![[0.0; 2]; self.points.len() * width];
        let by_vertex = parallel::tasks(self.points.len(), |vertex| {
            let vertex = Vertex::new(vertex);
            let stencil = self.stencil(vertex);
            let gradient = |column: usize| self.gradient(vertex, &stencil, values, width, column);
            (0..width).map(gradient).collect::<Vec<_>>()
        });
        for (rows, gradient) in gradients.chunks_mut(width.max(1)).zip(by_vertex) {
            rows.copy_from_slice(&gradient);
        }
        gradients
    }

    fn gradient(
        &self,
        vertex: Vertex,
        stencil: &[(Vertex, [f64; 2])],
        values: &[f64],
        width: usize,
        column: usize,
    ) -> [f64; 2] {
        let value = |vertex: Vertex| values[vertex.index() * width + column];
        let here = value(vertex);
        let is_flat = self
            .corners
            .of(vertex)
            .iter()
            .any(|corner| self.faces[corner.face()].iter().all(|&other| value(other) == here));
        if is_flat {
            return [0.0; 2];
        }
        let mut sum = [0.0; 2];
        for &(neighbor, weight) in stencil {
            let difference = value(neighbor) - here;
            (0..2).for_each(|axis| sum[axis] += weight[axis] * difference);
        }
        if sum.iter().all(|x| x.is_finite()) { sum } else { [0.0; 2] }
    }

    /// The gradient at a vertex as Σ w (f(neighbor) − f(vertex)), the w of neighbors.
    fn stencil(&self, vertex: Vertex) -> Vec<(Vertex, [f64; 2])> {
        let neighbors = self.neighbors(vertex);
        let places: Vec<[f64; 2]> = neighbors.iter().map(|&other| self.place(vertex, other)).collect();
        let lengths = places.iter().map(|x| x[0].hypot(x[1]));
        let unit = lengths.clone().sum::<f64>() / neighbors.len().max(1) as f64;
        let terms: Vec<[f64; 5]> = places.iter().map(|x| quadratic(x.map(|x| x / unit))).collect();
        // near neighbors count most: a second ring adds what the first leaves open
        let weights: Vec<f64> = lengths.map(|x| if x > 0.0 { (unit / x).powi(4) } else { 0.0 }).collect();
        let Some(inverse) = inverse_rows(&terms, &weights) else { return Vec::new() };
        let weight = |k: usize, row: &[f64; 5]| {
            weights[k] / unit * row.iter().zip(terms[k]).map(|(a, b)| a * b).sum::<f64>()
        };
        let of = |k: usize| (neighbors[k], [weight(k, &inverse[0]), weight(k, &inverse[1])]);
        (0..neighbors.len()).map(of).collect()
    }

    fn neighbors(&self, vertex: Vertex) -> Vec<Vertex> {
        let ring =
            |vertex: Vertex| self.corners.of(vertex).iter().flat_map(|corner| self.faces[corner.face()]);
        let distinct = |mut vertices: Vec<Vertex>| {
            vertices.sort_unstable();
            vertices.dedup();
            vertices.retain(|&other| other != vertex);
            vertices
        };
        let first = distinct(ring(vertex).collect());
        if first.len() >= RING { first } else { distinct(ring(vertex).flat_map(ring).collect()) }
    }
}

/// Two orthogonal unit vectors across a third of any length.
fn axes_across(normal: Vector3) -> [Vector3; 2] {
    let size = normal.norm();
    let normal = if size > 0.0 { normal * (1.0 / size) } else { Vector3::unit(2) };
    let least = (1..3).fold(0, |k, axis| if normal[axis].abs() < normal[k].abs() { axis } else { k });
    let first = normal.cross(Vector3::unit(least)).normalized();
    [first, normal.cross(first)]
}

/// The terms of a quadratic function without a constant.
fn quadratic([x, y]: [f64; 2]) -> [f64; 5] {
    [x, y, 0.5 * x * x, x * y, 0.5 * y * y]
}

/// The first two rows of (Σ w t tᵀ)⁻¹, regularized.
fn inverse_rows(terms: &[[f64; 5]], weights: &[f64]) -> Option<[[f64; 5]; 2]> {
    let mut matrix = [0.0; 25];
    for (term, weight) in terms.iter().zip(weights) {
        (0..25).for_each(|i| matrix[i] += weight * term[i / 5] * term[i % 5]);
    }
    let size = (matrix[0] + matrix[6]) / 2.0;
    (0..5).for_each(|k| matrix[6 * k] += size * if k < 2 { SLOPE } else { CURVATURE });
    let mut solution = [0.0; 10];
    (solution[0], solution[6]) = (1.0, 1.0);
    // symmetric: rows of the inverse are columns
    solve_positive_definite(&mut matrix, &mut solution)
        .then(|| std::array::from_fn(|row| std::array::from_fn(|k| solution[5 * row + k])))
}

/// A function on a triangle: its values at the corners, and its derivatives there along the edges to the next corner
/// and to the one after that.
struct Patch {
    values: [f64; 3],
    slopes: [[f64; 2]; 3],
}

impl Patch {
    /// The cubic at barycentric coordinates in a triangle in space. In each third of the triangle, between an edge and
    /// the centroid, it has the Bézier ordinates of Clough and Tocher.
    fn at(&self, barycentric: [f64; 3], corners: [Vector3; 3]) -> f64 {
        // on the edges, a third of the way from a corner to the next and to the one after that
        let near: [[f64; 2]; 3] =
            std::array::from_fn(|k| self.slopes[k].map(|slope| self.values[k] + slope / 3.0));
        // a third of the way to the centroid
        let inner: [f64; 3] = std::array::from_fn(|k| (self.values[k] + near[k][0] + near[k][1]) / 3.0);
        // amid the third at the edge opposite to a corner
        let middle: [f64; 3] = std::array::from_fn(|k| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let t = foot_of_centroid(corners, k);
            let (a, b) = (near[i][0], near[j][1]);
            let start = inner[i] - (1.0 - t) * self.values[i] - t * a;
            let end = inner[j] - (1.0 - t) * b - t * self.values[j];
            (1.0 - t) * a + t * b + 0.5 * (start + end)
        });
        // two thirds of the way to the centroid
        let deep: [f64; 3] =
            std::array::from_fn(|k| (inner[k] + middle[(k + 1) % 3] + middle[(k + 2) % 3]) / 3.0);
        let center = deep.iter().sum::<f64>() / 3.0;
        // the third with the point in it
        let k = (1..3).fold(0, |least, k| if barycentric[k] < barycentric[least] { k } else { least });
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let (x, y, z) =
            (barycentric[i] - barycentric[k], barycentric[j] - barycentric[k], 3.0 * barycentric[k]);
        let on_edge = x.powi(3) * self.values[i]
            + 3.0 * x * y * (x * near[i][0] + y * near[j][1])
            + y.powi(3) * self.values[j];
        let first = x * x * inner[i] + 2.0 * x * y * middle[k] + y * y * inner[j];
        on_edge + 3.0 * z * first + 3.0 * z * z * (x * deep[i] + y * deep[j]) + z.powi(3) * center
    }
}

/// The parameter of the point on the edge opposite to a corner that is nearest to the centroid.
fn foot_of_centroid(corners: [Vector3; 3], k: usize) -> f64 {
    let (start, end) = (corners[(k + 1) % 3], corners[(k + 2) % 3]);
    let edge = end - start;
    let way = corners.into_iter().sum::<Vector3>() * (1.0 / 3.0) - start;
    let square = edge.dot(edge);
    if square > 0.0 { way.dot(edge) / square } else { 0.5 }
}

#[cfg(test)]
mod tests {
    use super::super::pull_vertices;
    use super::*;
    use crate::location::Locator;
    use crate::location::tests::{Map, number, octasphere, rings};

    fn located(target: &Map, points: &[Vector3]) -> Vec<Location> {
        let locator = Locator::new(&target.0, &target.1);
        points.iter().map(|&x| locator.locate(x)).collect()
    }

    fn wave(Vector3([x, y, z]): Vector3) -> f64 {
        (2.0 * x + y).sin() + 0.5 * (3.0 * z - x).cos()
    }

    fn sampled(map: &Map, function: impl Fn(Vector3) -> f64) -> Vec<f64> {
        map.0.iter().map(|&x| function(x)).collect()
    }

    fn worst(values: &[f64], expected: &[f64]) -> f64 {
        values.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn smooth_functions_of_a_coarse_sphere_have_no_facets() {
        let (target, source) = (octasphere(3), octasphere(5));
        let (values, expected) = (sampled(&target, wave), sampled(&source, wave));
        let locations = located(&target, &source.0);
        let linear = worst(&pull_vertices(&values, 1, &target.1, &locations), &expected);
        let smooth = pull_vertices_smoothly(&values, 1, &target.0, &target.1, &locations);
        let smooth = worst(&smooth, &expected);
        assert!(5.0 * smooth < linear, "{smooth} and {linear}");
    }

    #[test]
    fn quadratic_functions_of_the_plane_are_reproduced() {
        let target = rings(6);
        let points: Vec<Vector3> =
            (0..200).map(|i| Vector3([0.6 * number(2 * i), 0.6 * number(2 * i + 1), 1.0])).collect();
        let functions: [fn(Vector3) -> f64; 2] =
            [|x| 3.0 * x[0] - x[1] + 2.0, |x| x[0] * x[0] - 3.0 * x[0] * x[1] + 0.5 * x[1]];
        let locations = located(&target, &points);
        for (function, tolerance) in functions.into_iter().zip([1e-11, 2e-3]) {
            let values = sampled(&target, function);
            let pulled = pull_vertices_smoothly(&values, 1, &target.0, &target.1, &locations);
            let expected: Vec<f64> = points.iter().map(|&x| function(x)).collect();
            assert!(worst(&pulled, &expected) < tolerance, "{}", worst(&pulled, &expected));
        }
    }

    #[test]
    fn there_are_no_creases() {
        // on both sides of an edge of a flat mesh, the derivatives across it agree
        let target = rings(3);
        let values = sampled(&target, |x| number((1000.0 * (x[0] + 2.0 * x[1])) as i64 as usize));
        let corners = VertexCorners::new(target.0.len(), &target.1);
        let mut n_edges = 0;
        for corner in crate::mesh::Corner::all(target.1.len()) {
            let [a, b] = corner.half_edge(&target.1);
            let is_inner = corners.of(b).iter().any(|other| other.next().vertex(&target.1) == a);
            if !is_inner {
                continue;
            }
            n_edges += 1;
            let (start, end) = (target.0[a], target.0[b]);
            let along = end - start;
            let across = Vector3([-along[1], along[0], 0.0]) * 1e-5;
            let on_edge = start + along * 0.3;
            let points = [on_edge - across, on_edge, on_edge + across];
            let pulled = pull_vertices_smoothly(&values, 1, &target.0, &target.1, &located(&target, &points));
            let jump = (pulled[2] - 2.0 * pulled[1] + pulled[0]).abs() / 1e-5;
            let slope = (pulled[2] - pulled[0]).abs() / 1e-5;
            assert!(jump < 1e-2 * slope.max(1.0), "{jump} beside {slope}");
        }
        assert!(n_edges > 40);
    }

    #[test]
    fn values_at_vertices_and_constants_stay_and_zero_faces_stay_zero() {
        let (target, source) = (octasphere(2), octasphere(4));
        let values: Vec<f64> = (0..target.0.len()).map(number).collect();
        let own = located(&target, &target.0);
        assert_eq!(pull_vertices_smoothly(&values, 1, &target.0, &target.1, &own), values);
        let locations = located(&target, &source.0);
        let constant = vec![0.3; target.0.len()];
        let pulled = pull_vertices_smoothly(&constant, 1, &target.0, &target.1, &locations);
        assert_eq!(pulled, vec![0.3; source.0.len()]);
        let half = sampled(&target, |x| if x[2] > 0.1 { 1.0 } else { 0.0 });
        let linear = pull_vertices(&half, 1, &target.1, &locations);
        let smooth = pull_vertices_smoothly(&half, 1, &target.0, &target.1, &locations);
        for (linear, smooth) in linear.iter().zip(&smooth) {
            assert!(*linear != 0.0 || *smooth == 0.0);
            assert!(*linear != 1.0 || *smooth == 1.0);
            assert!((-0.2..1.2).contains(smooth));
        }
    }

    #[test]
    fn columns_are_carried_each_for_itself() {
        let (target, source) = (octasphere(2), octasphere(3));
        let locations = located(&target, &source.0);
        let (first, second) = (sampled(&target, wave), sampled(&target, |x| x[2]));
        let both: Vec<f64> = first.iter().zip(&second).flat_map(|(&a, &b)| [a, b]).collect();
        let pulled = pull_vertices_smoothly(&both, 2, &target.0, &target.1, &locations);
        for (column, values) in [first, second].iter().enumerate() {
            let alone = pull_vertices_smoothly(values, 1, &target.0, &target.1, &locations);
            assert!((0..alone.len()).all(|row| pulled[2 * row + column] == alone[row]));
        }
        assert!(pull_vertices_smoothly(&[], 0, &target.0, &target.1, &locations).is_empty());
    }

    #[test]
    fn a_value_that_is_not_finite_stays_in_its_faces() {
        let (target, source) = (octasphere(2), octasphere(4));
        let mut values = sampled(&target, wave);
        values[7] = f64::NAN;
        let locations = located(&target, &source.0);
        let linear = pull_vertices(&values, 1, &target.1, &locations);
        let smooth = pull_vertices_smoothly(&values, 1, &target.0, &target.1, &locations);
        assert!(linear.iter().zip(&smooth).all(|(a, b)| a.is_nan() == b.is_nan()));
    }
}
