// SPDX-License-Identifier: MIT OR Apache-2.0
//! The energy of areas and angles of maps into the plane whose outline is free.
//!
//! E = Σ T (ψ(ρ) + λ f(m − 1)), with the target T of a face, the Jacobian J = (a b; c d) of its map from its rest
//! triangle, ρ = det J, ψ(ρ) = ½ (ρ − 1)² (1 + 1/ρ), f(x) = x + β/2 x² and m − 1 = ½ [(a − d)² + (b + c)²] / ρ, which
//! is ½ (σ₁/σ₂ + σ₂/σ₁) − 1. Rest triangles have the area of their target, and targets add up to one, so there is no
//! scale to be found. ψ is infinite where a face folds.
//!
//! Near a minimum the Hessian is exact, or as much of the curvature of ρ is left out as makes it positive definite: then
//! m − 1 is taken as quadratic over linear in ((a − d, b + c), ρ). Elsewhere each face's Hessian goes without its
//! negative eigenvalues.

use super::face::{
    Derivatives, Element, Jacobian, STIFFENING, add_area_curvature, add_dirichlet, add_positive_part,
    add_square, stiffened,
};
use crate::codomain::planar::PlanarMap;
use crate::mesh::geometry::triangle;
use crate::mesh::{Corner, TriangleMesh, Vertex};
use crate::parallel;
use crate::vector::Vector3;

/// Rest triangles are fattened to a height of at least this part of their longest edge.
const FLATTEST: f64 = 1e-7;

/// A face is positive by more than its rounding error where left − right > this · (|left| + |right|): the filter of
/// Shewchuk's orient2d, (3 + 16ε)ε with ε = 2⁻⁵³.
const ROUNDING: f64 = 3.330_669_073_875_471_6e-16;

/// The rest triangles of a surface.
pub(super) struct Energy<'a> {
    pub mesh: &'a TriangleMesh,
    /// Targets, (m,), of sum one.
    pub targets: Vec<f64>,
    /// The gradients of the hat functions of each face's corners on its rest triangle.
    hats: Vec<[[f64; 2]; 3]>,
}

/// E_A and the angle term without its weight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Parts {
    /// Σ T (ρ − 1)².
    pub deviation: f64,
    /// Σ T f(m − 1).
    pub angles: f64,
}

/// The choices for the Hessian of a face.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hessian {
    /// λ.
    pub weight: f64,
    /// The damping of a face that is wholly off its target.
    pub damping: f64,
    /// Lower bound of the damping of a face, in units of the deviation of its area ratio.
    pub least: f64,
    /// The part of the curvature of the area that is added, from 0 to 1; 1 gives the exact Hessian. `None`: faces go
    /// without negative eigenvalues.
    pub curvature: Option<f64>,
}

impl<'a> Energy<'a> {
    /// The energy of maps of `mesh` with `targets`, (m,), on any scale.
    pub(super) fn new(mesh: &'a TriangleMesh, targets: &[f64]) -> Self {
        let total = parallel::sum(targets.len(), |face| targets[face]);
        let targets = parallel::map(targets.len(), |face| targets[face] / total);
        let hats = parallel::map(mesh.n_faces(), |face| {
            let corners = triangle(mesh.points(), mesh.faces()[face]);
            rest_hats(corners, targets[face])
        });
        Self { mesh, targets, hats }
    }

    /// The gradient of a corner's hat function on the rest triangle of its face.
    pub(super) fn hat(&self, corner: Corner) -> [f64; 2] {
        self.hats[corner.face()][corner.place()]
    }

    /// The gradients of the hat functions on the rest triangle of a face.
    pub(super) fn hats(&self, face: usize) -> &[[f64; 2]; 3] {
        &self.hats[face]
    }

    /// The entries (a, b, c, d) of a face's Jacobian in `map`.
    pub(super) fn entries(&self, map: &[[f64; 2]], face: usize) -> [f64; 4] {
        self.entries_of(self.mesh.faces()[face].map(|v| map[v]), face)
    }

    /// The entries of the Jacobian that takes a face's rest triangle to another triangle.
    pub(super) fn entries_of(&self, [o, p, q]: [[f64; 2]; 3], face: usize) -> [f64; 4] {
        let [_, g, h] = self.hats[face];
        let (e, f) = ([p[0] - o[0], p[1] - o[1]], [q[0] - o[0], q[1] - o[1]]);
        [
            e[0] * g[0] + f[0] * h[0],
            e[0] * g[1] + f[0] * h[1],
            e[1] * g[0] + f[1] * h[0],
            e[1] * g[1] + f[1] * h[1],
        ]
    }

    fn jacobian(&self, map: &[[f64; 2]], face: usize) -> Jacobian {
        let [o, p, q] = self.mesh.faces()[face].map(|v| map[v]);
        let (left, right) = ((p[0] - o[0]) * (q[1] - o[1]), (p[1] - o[1]) * (q[0] - o[0]));
        let area = left - right;
        let is_positive = area > ROUNDING * (left.abs() + right.abs());
        let [_, g, h] = self.hats[face];
        let ratio = if is_positive { area * (g[0] * h[1] - g[1] * h[0]) } else { 0.0 };
        Jacobian { entries: self.entries(map, face), ratio }
    }

    /// True if every face is positive by more than rounding.
    pub(super) fn is_unfolded(&self, map: &[[f64; 2]]) -> bool {
        parallel::all(self.mesh.n_faces(), |face| self.jacobian(map, face).ratio > 0.0)
    }

    /// E at a map; infinite where a face folds.
    pub(super) fn value(&self, map: &[[f64; 2]], weight: f64) -> f64 {
        parallel::sum(self.mesh.n_faces(), |face| self.of_face(map, face, weight))
    }

    /// The terms of areas and of angles.
    pub(super) fn parts(&self, map: &[[f64; 2]]) -> Parts {
        let [deviation, angles] = parallel::sums(self.mesh.n_faces(), |face| {
            let jacobian = self.jacobian(map, face);
            [(jacobian.ratio - 1.0).powi(2), stiffened(jacobian.shear())].map(|x| self.targets[face] * x)
        });
        Parts { deviation, angles }
    }

    /// E_A of a map, its targets on the scale of the image, over the area of the image.
    pub(super) fn unevenness(&self, map: &[[f64; 2]]) -> f64 {
        let ratio = |face: usize| self.jacobian(map, face).ratio;
        let area = parallel::sum(self.mesh.n_faces(), |face| self.targets[face] * ratio(face));
        parallel::sum(self.mesh.n_faces(), |face| self.targets[face] * (ratio(face) / area - 1.0).powi(2))
    }

    /// The gradient of E by the vertices, (n, 2).
    pub(super) fn gradient(&self, map: &[[f64; 2]], weight: f64) -> PlanarMap {
        let by_face = parallel::map(self.mesh.n_faces(), |face| self.slopes(map, face, weight));
        self.gathered(|corner| {
            let [a, b, c, d] = by_face[corner.face()];
            let g = self.hat(corner);
            [a * g[0] + b * g[1], c * g[0] + d * g[1]]
        })
    }

    /// Sums over the corners of every vertex.
    pub(super) fn gathered(&self, of_corner: impl Fn(Corner) -> [f64; 2] + Sync + Send) -> PlanarMap {
        parallel::map(self.mesh.n_vertices(), |v| {
            let corners = self.mesh.vertex_corners(Vertex::new(v)).iter();
            corners.map(|&corner| of_corner(corner)).fold([0.0; 2], |s, x| [s[0] + x[0], s[1] + x[1]])
        })
    }

    /// The derivatives of a face's energy by (a, b, c, d).
    fn slopes(&self, map: &[[f64; 2]], face: usize, weight: f64) -> [f64; 4] {
        let jacobian = self.jacobian(map, face);
        let (rho, by_entries) = (jacobian.ratio, jacobian.cofactors());
        let of_area = 0.5 * (2.0 * rho - 1.0 - 1.0 / (rho * rho));
        let (shear, by_shear) = (jacobian.shear(), jacobian.shear_slopes());
        let of_shear = weight * (1.0 + STIFFENING * shear);
        std::array::from_fn(|k| self.targets[face] * (of_area * by_entries[k] + of_shear * by_shear[k]))
    }

    /// The energy of each face, (m,); infinite where it folds.
    pub(super) fn of_faces(&self, map: &[[f64; 2]], weight: f64) -> Vec<f64> {
        parallel::map(self.mesh.n_faces(), |face| self.of_face(map, face, weight))
    }

    /// The part of a face in E, infinite where it folds.
    pub(super) fn of_face(&self, map: &[[f64; 2]], face: usize, weight: f64) -> f64 {
        let jacobian = self.jacobian(map, face);
        let rho = jacobian.ratio;
        if rho.is_nan() || rho <= 0.0 {
            return f64::INFINITY;
        }
        let areas = 0.5 * (rho - 1.0).powi(2) * (1.0 + 1.0 / rho);
        self.targets[face] * (areas + weight * stiffened(jacobian.shear()))
    }

    /// The Hessian of a face.
    pub(super) fn element(&self, map: &[[f64; 2]], face: usize, how: &Hessian) -> Element {
        let jacobian = self.jacobian(map, face);
        let (rho, target, hats) = (jacobian.ratio, self.targets[face], &self.hats[face]);
        let stiffness = 1.0 + STIFFENING * jacobian.shear();
        let derivatives = Derivatives {
            by_area: [0.5 * (2.0 * rho - 1.0 - 1.0 / (rho * rho)), 1.0 + rho.powi(-3)],
            by_shear: [how.weight * stiffness, how.weight * STIFFENING],
        };
        let mut element = [[0.0; 6]; 6];
        // 1. The energy
        match how.curvature {
            None => add_positive_part(&mut element, target, hats, &jacobian, &derivatives),
            Some(part) => add_partly(&mut element, target, hats, &jacobian, &derivatives, part),
        }
        // 2. Damping in proportion to how far the face is from its target
        let damping = target * how.damping * ((rho - 1.0).abs().min(1e3) + how.least);
        add_dirichlet(&mut element, damping, hats);
        element
    }
}

/// Adds `factor` times the Hessian of a face with a part of the curvature of the area.
fn add_partly(
    element: &mut Element,
    factor: f64,
    hats: &[[f64; 2]; 3],
    jacobian: &Jacobian,
    derivatives: &Derivatives,
    part: f64,
) {
    let ([stress, by_area], [by_shear, stiffening]) = (derivatives.by_area, derivatives.by_shear);
    // 1. ψ'' and f'' along the slopes of the area and of the shear
    let cofactors = jacobian.cofactors();
    add_square(element, factor * by_area, hats, &cofactors);
    add_square(element, factor * stiffening, hats, &jacobian.shear_slopes());
    // 2. Quadratic over linear
    for row in jacobian.quadratic_over_linear(&cofactors) {
        add_square(element, factor * by_shear, hats, &row);
    }
    // 3. The given part of the curvature of the area
    let stress = stress - by_shear * jacobian.shear() / jacobian.ratio;
    add_area_curvature(element, factor * part * stress, hats);
}

/// The gradients of the hat functions on a triangle in the plane, similar to the one in space and of area `target`.
fn rest_hats(corners: [Vector3; 3], target: f64) -> [[f64; 2]; 3] {
    // from the longest edge, so that the height is the least and no difference cancels
    let length = |k: usize| (corners[(k + 2) % 3] - corners[(k + 1) % 3]).norm();
    let apex = (0..3).fold(0, |best, k| if length(k) > length(best) * (1.0 + 1e-8) { k } else { best });
    let [top, left, right] = [0, 1, 2].map(|k| corners[(apex + k) % 3]);
    let base = (right - left).norm();
    let along = (right - left) * (1.0 / base);
    let foot = (top - left).dot(along);
    let height = ((right - left).cross(top - left).norm() / base).max(FLATTEST * base);
    // the size of the rest triangle, then that of the target
    let scale = (0.5 * base * height / target).sqrt();
    let of_top = [0.0, scale / height];
    let of_left = [-scale / base, -scale * (1.0 - foot / base) / height];
    let of_right = [scale / base, -scale * (foot / base) / height];
    let mut hats = [[0.0; 2]; 3];
    [of_top, of_left, of_right].into_iter().enumerate().for_each(|(k, hat)| hats[(apex + k) % 3] = hat);
    hats
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A pyramid without its base, with a map of it.
    fn pyramid() -> (TriangleMesh, PlanarMap) {
        let points = [[0., 0., 1.], [1.3, 0., 0.], [0., 1., 0.2], [-1., -0.5, 0.]];
        let mesh = TriangleMesh::new(&points, &[[0, 1, 2], [0, 2, 3], [0, 3, 1]]).unwrap();
        (mesh, vec![[0.05, -0.1], [0.9, 0.1], [-0.2, 0.8], [-0.6, -0.7]])
    }

    #[test]
    fn gradient_and_whole_hessian_are_the_differences_of_the_value() {
        let (mesh, map) = pyramid();
        let energy = Energy::new(&mesh, &[0.3, 0.5, 0.4]);
        let weight = 0.4;
        let along: PlanarMap =
            (0..4).map(|v| [(1.0 + 3.0 * v as f64).sin(), (2.0 + 5.0 * v as f64).cos()]).collect();
        let value = |step: f64| {
            let moved: PlanarMap = (0..4).map(|v| [0, 1].map(|k| map[v][k] + step * along[v][k])).collect();
            energy.value(&moved, weight)
        };
        let (h, here) = (1e-4, value(0.0));
        assert!(here.is_finite());
        let gradient = energy.gradient(&map, weight);
        let slope: f64 = (0..4).map(|v| gradient[v][0] * along[v][0] + gradient[v][1] * along[v][1]).sum();
        assert!((slope - (value(h) - value(-h)) / (2.0 * h)).abs() < 1e-5 * (1.0 + slope.abs()));
        let how = Hessian { weight, damping: 0.0, least: 0.0, curvature: Some(1.0) };
        let mut curvature = 0.0;
        for (face, corners) in mesh.faces().iter().enumerate() {
            let element = energy.element(&map, face, &how);
            let x: Vec<f64> = corners.iter().flat_map(|&v| along[v]).collect();
            for i in 0..6 {
                curvature += (0..6).map(|j| x[i] * element[i][j] * x[j]).sum::<f64>();
            }
        }
        let difference = (value(h) + value(-h) - 2.0 * here) / (h * h);
        assert!((curvature - difference).abs() < 1e-4 * (1.0 + difference.abs()), "{curvature} {difference}");
    }

    #[test]
    fn the_hessian_without_negative_eigenvalues_is_the_positive_part_of_the_hessian() {
        let (mesh, map) = pyramid();
        let energy = Energy::new(&mesh, &[0.3, 0.5, 0.4]);
        for (weight, face) in (0..9).map(|k| ([0.01, 0.4, 30.0][k / 3], k % 3)) {
            let by_entries = |curvature| {
                let how = Hessian { weight, damping: 0.0, least: 0.0, curvature };
                by_entries(&energy.element(&map, face, &how), energy.hats(face))
            };
            let (whole, positive) = (by_entries(Some(1.0)), by_entries(None));
            let square: f64 = whole.iter().flatten().map(|x| x * x).sum();
            // P is the positive part of H if P (H − P) = 0 where neither P nor P − H has a negative direction
            for (i, j) in (0..16).map(|k| (k / 4, k % 4)) {
                let entry: f64 = (0..4).map(|k| positive[i][k] * (whole[k][j] - positive[k][j])).sum();
                assert!(entry.abs() < 1e-10 * square, "weight {weight}, face {face}: {entry}");
            }
            for seed in 0..50 {
                let x: [f64; 4] = std::array::from_fn(|k| (1.7 * seed as f64 + 2.3 * k as f64).sin());
                let form = |matrix: &[[f64; 4]; 4]| -> f64 {
                    (0..16).map(|k| x[k / 4] * matrix[k / 4][k % 4] * x[k % 4]).sum()
                };
                assert!(form(&positive) > -1e-12 * square.sqrt());
                assert!(form(&positive) - form(&whole) > -1e-12 * square.sqrt());
            }
        }
    }

    /// A Hessian by the entries of the Jacobian.
    fn by_entries(element: &Element, [_, g, h]: &[[f64; 2]; 3]) -> [[f64; 4]; 4] {
        let determinant = g[0] * h[1] - g[1] * h[0];
        // how the second and the third corner move where one entry grows
        let moves = |entry: usize| {
            let by = [[h[1], -g[1]], [-h[0], g[0]]][entry % 2];
            let mut moves = [0.0; 4];
            (0..2).for_each(|corner| moves[2 * corner + entry / 2] = by[corner] / determinant);
            moves
        };
        std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let (x, y) = (moves(i), moves(j));
                (0..16).map(|k| x[k / 4] * element[2 + k / 4][2 + k % 4] * y[k % 4]).sum()
            })
        })
    }

    #[test]
    fn similar_maps_cost_nothing_and_folded_ones_infinitely_much() {
        let points = [[0., 0., 0.], [2., 0., 0.], [2., 1., 0.], [0., 1., 0.]];
        let mesh = TriangleMesh::new(&points, &[[0, 1, 2], [0, 2, 3]]).unwrap();
        let energy = Energy::new(&mesh, mesh.face_areas());
        // turned by a right angle, of area one
        let map: PlanarMap = points.iter().map(|x| [-x[1], x[0]].map(|c| c * 0.5f64.sqrt())).collect();
        assert!(energy.value(&map, 1.0) < 1e-30);
        let folded: PlanarMap = map.iter().map(|x| [-x[0], x[1]]).collect();
        assert_eq!(energy.value(&folded, 1.0), f64::INFINITY);
        assert!(!energy.is_unfolded(&folded));
    }
}
