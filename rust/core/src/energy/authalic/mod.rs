// SPDX-License-Identifier: MIT OR Apache-2.0
//! The energy of the guarded Gauss–Newton method: area ratios behind a barrier, with a share of angle distortion.
//!
//! One formula serves all codomains (see [`motion`](crate::codomain::motion)). For a face with corners x_i,
//! N = (x_j − x_i) × (x_k − x_i), image area a = |N|/2, D = det(x_i, x_j, x_k), target T, ρ = a/T, and
//! Q = ½ Σ cot_c |opposite edge|² with the cotangents of the rest triangle:
//!
//! ```text
//! E = Σ T [ψ(ρ) + λ ((m − 1) + ½ β (m − 1)²)],     m = Q/D,     ψ(ρ) = ½ (ρ − 1)² (1 + 1/ρ),     β = 0.1.
//! ```
//!
//! Σ T ψ is E_A to second order. On fine meshes m = ½ (σ₁/σ₂ + σ₂/σ₁); D makes m infinite exactly at a fold, while
//! areas are the flat ones of E_A. A face is feasible where D is positive by more than its rounding error, so a finite
//! energy certifies a map without folds.
//!
//! The composite Hessian of a face is positive semidefinite: Gauss–Newton in the area, and for m − 1 = (Q − D)/D the
//! Hessian of a quadratic over a linear function. Its numerator C = Q − 2a, which is Q − D in the plane and nearly so
//! on fine meshes, is convex: half the squared distance of the face from the similarity transformations. The composite
//! Hessian omits only terms that vanish with ψ′ and with m − 1, and turning a face costs nothing. Where those do not
//! vanish, the exact Hessian, or a part of the way to it, leads to a stationary point in far fewer iterations; it may
//! be indefinite.

mod face;
mod rest;
#[cfg(test)]
mod tests;

pub(crate) use face::Element;
pub(crate) use rest::rest_cotangents;

use super::stretch::Profile;
use crate::codomain::Codomain;
use crate::codomain::motion::Frame;
use crate::mesh::geometry::triangle;
use crate::mesh::{Corner, Face, TriangleMesh, Vertex, VertexCorners};
use crate::parallel;
use crate::vector::Vector3;
use face::{Outer, STEEPNESS, Triangle, add_product, add_quadratic, angle_cost};

/// Energy of maps of one mesh.
#[derive(Debug)]
pub(crate) struct AuthalicEnergy {
    faces: Vec<[Vertex; 3]>,
    /// The corners at each vertex.
    corners: VertexCorners,
    /// Cotangents of the rest triangles, (m, 3).
    cotangents: Vec<[f64; 3]>,
    /// Target areas on any common scale, (m,).
    targets: Vec<f64>,
    /// The boundary edges of each face, bit c for the edge opposite corner c.
    boundary_edges: Vec<u8>,
    codomain: Codomain,
}

/// The weights of the terms of the energy.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Weights {
    /// The factor that makes the targets sum to the image's area.
    pub scale: f64,
    /// λ, the weight of the angle distortion.
    pub angle: f64,
    /// The cost of area ratios; the papers' profile allows folds and uses signed areas, the barrier does neither.
    pub profile: Profile,
}

/// The choices for the Hessian of a face.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Hessian {
    /// The damping of a face that is wholly off its target.
    pub damping: f64,
    /// The deviation of the area ratio that is added to every face for the damping.
    pub least: f64,
    /// The part of the way from the composite Hessian, 0, to the exact one without damping, 1.
    pub curvature: f64,
}

/// Upper bound of the deviation of a face in its damping.
const MOST_DEVIATION: f64 = 1e3;

/// Sums over the faces of a map.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sums {
    /// Area of the image.
    pub area: f64,
    /// E_A on targets rescaled to that area.
    pub authalic_energy: f64,
    /// Σ T ((m − 1) + ½ β (m − 1)²) on the same targets; infinite where a face is folded.
    pub angle_energy: f64,
    /// The penalty on landmarks away from their places, which the problem adds; 0 without landmarks.
    pub penalty: f64,
}

impl Sums {
    /// The sum that falls to zero: E_A and the penalty.
    pub(crate) fn total(&self) -> f64 {
        self.authalic_energy + self.penalty
    }
}

impl AuthalicEnergy {
    /// The energy of maps of `mesh` to `targets` (m,) on any common scale. Rest triangles flatter than `flattest`
    /// (height over longest edge) count as that flat.
    pub(crate) fn new(mesh: &TriangleMesh, targets: Vec<f64>, codomain: Codomain, flattest: f64) -> Self {
        let cotangents = parallel::map(mesh.n_faces(), |face| {
            rest_cotangents(triangle(mesh.points(), mesh.faces()[face]), flattest)
        });
        let is_boundary = |corner: Corner| u8::from(mesh.opposite(corner).is_none());
        let boundary_edges = parallel::map(mesh.n_faces(), |face| {
            (0..3).map(|c| is_boundary(Face::new(face).corner(c)) << c).fold(0, |bits, bit| bits | bit)
        });
        let faces = mesh.faces().to_vec();
        let corners = VertexCorners::new(mesh.n_vertices(), &faces);
        Self { faces, corners, cotangents, targets, boundary_edges, codomain }
    }

    /// The faces, (m, 3).
    pub(crate) fn faces(&self) -> &[[Vertex; 3]] {
        &self.faces
    }

    /// The corners at a vertex, in ascending order.
    pub(crate) fn vertex_corners(&self, vertex: Vertex) -> &[Corner] {
        self.corners.of(vertex)
    }

    /// True if no face of `map` is folded and no boundary edge turned.
    pub(crate) fn is_embedding(&self, map: &[Vector3]) -> bool {
        parallel::all(self.faces.len(), |face| self.is_open(&self.triangle(map, face), face))
    }

    /// The target areas, (m,).
    pub(crate) fn targets(&self) -> &[f64] {
        &self.targets
    }

    /// The areas of the faces of `map`, signed in the plane.
    pub(crate) fn areas(&self, map: &[Vector3]) -> Vec<f64> {
        parallel::map(self.targets.len(), |face| 0.5 * self.triangle(map, face).doubled_area)
    }

    /// The area of each face of `map`, signed in the plane, and (m − 1) + ½ β (m − 1)², infinite where the face is not
    /// open.
    pub(crate) fn costs(&self, map: &[Vector3]) -> Vec<[f64; 2]> {
        parallel::map(self.targets.len(), |face| {
            let corners = self.triangle(map, face);
            let angle = if self.is_open(&corners, face) { corners.angle() } else { f64::INFINITY };
            [0.5 * corners.doubled_area, angle_cost(angle)]
        })
    }

    /// The sums of a map with these costs.
    pub(crate) fn sums(&self, costs: &[[f64; 2]]) -> Sums {
        let n = self.targets.len();
        let [area, total] = parallel::sums(n, |face| [costs[face][0], self.targets[face]]);
        let scale = area / total;
        let [authalic_energy, angle_energy] = parallel::sums(n, |face| {
            let ([area, angle_cost], target) = (costs[face], scale * self.targets[face]);
            [(area - target) * (area - target) / target, target * angle_cost]
        });
        Sums { area, authalic_energy, angle_energy, penalty: 0.0 }
    }

    /// The energy of a map with these costs; infinite where the barrier's profile meets a face that is not open.
    pub(crate) fn value(&self, costs: &[[f64; 2]], weights: &Weights) -> f64 {
        parallel::sum(self.targets.len(), |face| {
            let ([area, angle_cost], target) = (costs[face], weights.scale * self.targets[face]);
            let of_area = target * weights.profile.cost(area / target);
            match weights.profile {
                Profile::Stretch => of_area,
                Profile::Barrier if angle_cost == f64::INFINITY => f64::INFINITY,
                Profile::Barrier => of_area + weights.angle * target * angle_cost,
            }
        })
    }

    /// The first two derivatives by t of the angle energy of the planar map (eᵗ x, e⁻ᵗ y), which has the same areas.
    pub(crate) fn angle_slopes_of_stretch(&self, map: &[Vector3], t: f64) -> [f64; 2] {
        parallel::sums(self.targets.len(), |face| {
            let corners = self.triangle(map, face);
            let along = |axis: usize| {
                let square = |c: usize| (corners.x[(c + 1) % 3][axis] - corners.x[(c + 2) % 3][axis]).powi(2);
                (0..3).map(|c| 0.5 * self.cotangents[face][c] * square(c)).sum::<f64>()
            };
            let (grown, shrunk) = ((2.0 * t).exp() * along(0), (-2.0 * t).exp() * along(1));
            let angle = (grown + shrunk) / corners.determinant;
            let slope = 2.0 * (grown - shrunk) / corners.determinant;
            let outer = 1.0 + STEEPNESS * (angle - 1.0);
            let target = self.targets[face];
            [target * outer * slope, target * (STEEPNESS * slope * slope + 4.0 * outer * angle)]
        })
    }

    /// The gradient by the unknowns of every vertex, (n, 2).
    pub(crate) fn gradient(&self, map: &[Vector3], frames: &[Frame], weights: &Weights) -> Vec<[f64; 2]> {
        self.gather(|face| {
            let corners = self.triangle(map, face);
            let outer = self.outer(&corners, face, weights);
            let slopes = corners.slopes(self.frames(frames, face), self.cotangents[face]);
            std::array::from_fn(|k| outer.along(&slopes, k))
        })
    }

    /// The right-hand side −JᵀWc of the second-order correction, c the deviation of the image areas from their linear
    /// prediction after `direction`.
    pub(crate) fn curvature(
        &self,
        map: &[Vector3],
        moved: &[Vector3],
        frames: &[Frame],
        direction: &[[f64; 2]],
        weights: &Weights,
    ) -> Vec<[f64; 2]> {
        self.gather(|face| {
            let (before, after) = (self.triangle(map, face), self.triangle(moved, face));
            let target = weights.scale * self.targets[face];
            let slopes = before.area_slopes(self.frames(frames, face));
            let corners = self.faces[face].map(|vertex| direction[vertex]);
            let predicted: f64 = (0..6).map(|k| slopes[k] * corners[k / 2][k % 2]).sum();
            let missed = 0.5 * (after.doubled_area - before.doubled_area) - predicted;
            let stiffness =
                2.0 * weights.profile.stiffness(0.5 * before.doubled_area / target) / target * missed;
            slopes.map(|slope| -stiffness * slope)
        })
    }

    /// The Hessian of one face by the unknowns of its corners, positive semidefinite where `curvature` is 0. The
    /// damping, in proportion to |ρ − 1|, is the weight of the triangle's graph Laplacian.
    pub(crate) fn element(
        &self,
        map: &[Vector3],
        frames: &[Frame],
        weights: &Weights,
        how: &Hessian,
        face: usize,
    ) -> Element {
        let (corners, target) = (self.triangle(map, face), weights.scale * self.targets[face]);
        let (frames, cotangents) = (self.frames(frames, face), self.cotangents[face]);
        let ratio = 0.5 * corners.doubled_area / target;
        let composite = 1.0 - how.curvature;
        let damping = 0.5 * how.damping * ((ratio - 1.0).abs().min(MOST_DEVIATION) + how.least) * composite;
        let stiffness = 2.0 * weights.profile.stiffness(ratio) / target;
        let mut element = [[0.0; 6]; 6];
        if weights.profile == Profile::Stretch {
            add_product(&mut element, stiffness, &corners.area_slopes(frames));
            add_quadratic(&mut element, frames, [damping; 3]);
            return element;
        }
        let slopes = corners.slopes(frames, cotangents);
        add_product(&mut element, stiffness, &slopes.area);
        let by_quadratic = corners.add_angle(&mut element, weights.angle * target, &slopes, how.curvature);
        add_quadratic(&mut element, frames, cotangents.map(|cotangent| by_quadratic * cotangent + damping));
        corners.subtract_area(&mut element, composite * by_quadratic, frames);
        if how.curvature > 0.0 {
            let outer = self.outer(&corners, face, weights).times(how.curvature);
            corners.add_curvature(&mut element, &outer, frames, cotangents);
        }
        element
    }

    fn outer(&self, corners: &Triangle, face: usize, weights: &Weights) -> Outer {
        let target = weights.scale * self.targets[face];
        let by_area = weights.profile.slope(0.5 * corners.doubled_area / target);
        if weights.profile == Profile::Stretch || weights.angle == 0.0 {
            return Outer { by_area, by_determinant: 0.0, by_quadratic: 0.0 };
        }
        let angle = corners.angle();
        let by_angle = weights.angle * target * (1.0 + STEEPNESS * (angle - 1.0)) / corners.determinant;
        Outer { by_area, by_determinant: -by_angle * angle, by_quadratic: by_angle }
    }

    /// True if the face is unfolded by more than rounding and its boundary edges run counter-clockwise around the
    /// circle.
    fn is_open(&self, corners: &Triangle, face: usize) -> bool {
        let runs_forward = |c: usize| {
            let (from, to) = (corners.x[(c + 1) % 3], corners.x[(c + 2) % 3]);
            self.boundary_edges[face] & (1 << c) == 0 || from[0] * to[1] > from[1] * to[0]
        };
        let is_free = self.boundary_edges[face] == 0 || self.codomain != Codomain::Disk;
        corners.determinant > corners.rounding && (is_free || (0..3).all(runs_forward))
    }

    #[inline(always)]
    fn triangle(&self, map: &[Vector3], face: usize) -> Triangle {
        Triangle::new(
            triangle(map, self.faces[face]),
            self.cotangents[face],
            self.codomain != Codomain::Sphere,
        )
    }

    fn frames<'f>(&self, frames: &'f [Frame], face: usize) -> [&'f Frame; 3] {
        self.faces[face].map(|vertex| &frames[vertex])
    }

    /// Sums the contributions of the faces to the unknowns of their corners.
    fn gather(&self, of_face: impl Fn(usize) -> [f64; 6] + Sync + Send) -> Vec<[f64; 2]> {
        let by_face = parallel::map(self.targets.len(), of_face);
        parallel::map(self.corners.len(), |vertex| {
            let mut sum = [0.0; 2];
            for &corner in self.corners.of(Vertex::new(vertex)) {
                let (face, k) = (corner.face(), corner.place());
                (0..2).for_each(|axis| sum[axis] += by_face[face][2 * k + axis]);
            }
            sum
        })
    }
}
