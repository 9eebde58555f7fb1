// SPDX-License-Identifier: MIT OR Apache-2.0
//! The normalized stretch energy of a map into space, its gradient, its Laplacian and its Hessian.
//!
//! Sutti & Yueh (2024), equations (2.2) to (2.6) and appendices A and B. With a_τ = ½‖N_τ‖ the area of the
//! image of face τ, |τ| its target area, A = Σ a_τ and |M| = Σ |τ|,
//!
//! ```text
//! E(f) = |M|/A · E_S(f),   E_S = Σ a_τ²/|τ|,   ∇E = 2|M|/A · L_S(f) f − |M| E_S/A² · ∇A.
//! ```
//!
//! Both terms are sums of the same vectors: ∂a_τ/∂f_i = ½ (f_j − f_k) × n_τ, so one factor per face carries
//! the whole gradient. With targets rescaled so that |M| = A, E = E_A + A with the authalic energy E_A = Σ
//! (a_τ − |τ|)²/|τ|. That form is used here because E_S − A cancels near the minimum.
//!
//! A smaller image lowers E even where no area ratio improves. To avoid that drift, a descent minimizes 4π/A · E
//! ([`SpatialStretchEnergy::scale_free`]), which is 4π (1 + E_A/A).
//!
//! A descent that must not fold puts [`Profile::Barrier`] in place of (ρ − 1)² for the area ratio ρ =
//! a_τ/|τ|.
//!
//! Cost: one pass over the faces, one gather over the corners of each vertex.

use std::f64::consts::PI;

use sprs::{CsMat, TriMat};

use super::stretch::{Profile, Value};
use crate::mesh::geometry::{area_vector, triangle};
use crate::mesh::{TriangleMesh, Vertex};
use crate::parallel;
use crate::vector::Vector3;

/// Stretch energy of maps of one mesh into space, for given target areas.
#[derive(Debug, Clone, Copy)]
pub struct SpatialStretchEnergy<'a> {
    mesh: &'a TriangleMesh,
    targets: &'a [f64],
    total_target: f64,
    profile: Profile,
    scale_free: bool,
}

impl<'a> SpatialStretchEnergy<'a> {
    /// The energy of maps of `mesh` with one positive target area per face, on any common scale.
    pub fn new(mesh: &'a TriangleMesh, targets: &'a [f64]) -> Self {
        assert_eq!(targets.len(), mesh.n_faces(), "one target area per face");
        let total_target = parallel::sum(targets.len(), |face| targets[face]);
        Self { mesh, targets, total_target, profile: Profile::Stretch, scale_free: false }
    }

    /// The energy with another cost of area ratios.
    pub fn with_profile(self, profile: Profile) -> Self {
        Self { profile, ..self }
    }

    /// The energy times 4π/A, which does not fall when the image only shrinks.
    pub fn scale_free(self) -> Self {
        Self { scale_free: true, ..self }
    }

    /// The target areas, one per face.
    pub fn targets(&self) -> &'a [f64] {
        self.targets
    }

    /// The energies and the area of the image of `map`.
    pub fn value(&self, map: &[Vector3]) -> Value {
        self.value_of_areas(&self.areas(map))
    }

    /// The value at `map` and the gradient of the objective by every vertex, (n, 3).
    ///
    /// With c = A/|M| and ρ = a_τ/(c|τ|) the objective Σ c|τ| ψ(ρ) + A has the derivative ψ'(ρ_τ) + (Σ c|τ|
    /// ψ − Σ a ψ')/A + 1 by a_τ; times 4π/A it has 4π/A (ψ'(ρ_τ) − Σ a ψ'/A).
    pub fn gradient(&self, map: &[Vector3]) -> (Value, Vec<Vector3>) {
        let vectors = parallel::map(self.targets.len(), |face| area_vector(self.corners(map, face)));
        let areas = parallel::map(vectors.len(), |face| vectors[face].norm());
        let value = self.value_of_areas(&areas);
        let scale = value.area / self.total_target;
        let slope = |face: usize| self.profile.slope(areas[face] / (scale * self.targets[face]));
        let moment = parallel::sum(areas.len(), |face| areas[face] * slope(face));
        let (factor, shift) = if self.scale_free {
            (4.0 * PI / value.area, -moment / value.area)
        } else {
            (1.0, (value.objective - moment) / value.area)
        };
        // half the unit normal of each face times the derivative by its area; a face without area has none
        let pull = parallel::map(areas.len(), |face| {
            if areas[face] > 0.0 {
                vectors[face] * (0.5 * factor * (slope(face) + shift) / areas[face])
            } else {
                Vector3::ZERO
            }
        });
        (value, self.gather(map, &pull))
    }

    /// The weights of L_S(f), one per corner for the edge opposite it, targets rescaled to the image's area.
    ///
    /// The barrier profile weighs each face by its stiffness ψ''(ρ)/2, as for planar maps.
    pub fn laplacian_weights(&self, map: &[Vector3]) -> Vec<f64> {
        let scale = self.value(map).area / self.total_target;
        parallel::map(3 * self.targets.len(), |corner| {
            let (face, k) = (corner / 3, corner % 3);
            let (corners, target) = (self.corners(map, face), scale * self.targets[face]);
            let [i, j, k] = [(k + 1) % 3, (k + 2) % 3, k].map(|c| corners[c]);
            let stiffness = self.profile.stiffness(area_vector(corners).norm() / target);
            stiffness * (i - k).dot(j - k) / (4.0 * target)
        })
    }

    /// The Hessian of E_S, (3n, 3n) symmetric, unknowns ordered x of all vertices, then y, then z; targets
    /// rescaled to the image's area.
    ///
    /// Per face, appendix B: the blocks of 1/(2|τ|) [ … ] made of h^ℓ = (f_j − f_k, f_k − f_i, f_i − f_j)^ℓ.
    pub fn hessian(&self, map: &[Vector3]) -> CsMat<f64> {
        let n = map.len();
        let scale = self.value(map).area / self.total_target;
        let mut entries = TriMat::with_capacity((3 * n, 3 * n), 81 * self.targets.len());
        for (face, vertices) in self.mesh.faces().iter().enumerate() {
            let [f_i, f_j, f_k] = self.corners(map, face);
            let edges = [f_j - f_k, f_k - f_i, f_i - f_j];
            let factor = 0.5 / (scale * self.targets[face]);
            for (p, q) in (0..9).flat_map(|p| (0..9).map(move |q| (p, q))) {
                let (s, t, corner_p, corner_q) = (p / 3, q / 3, p % 3, q % 3);
                let value = factor * hessian_entry(edges[corner_p], edges[corner_q], s, t);
                let row = s * n + vertices[corner_p].index();
                entries.add_triplet(row, t * n + vertices[corner_q].index(), value);
            }
        }
        entries.to_csc()
    }

    /// Area of the image of every face.
    pub fn areas(&self, map: &[Vector3]) -> Vec<f64> {
        parallel::map(self.targets.len(), |face| area_vector(self.corners(map, face)).norm())
    }

    fn value_of_areas(&self, areas: &[f64]) -> Value {
        let area = parallel::sum(areas.len(), |face| areas[face]);
        let scale = area / self.total_target;
        let total = |profile: Profile| {
            let cost = |face: usize| profile.cost(areas[face] / (scale * self.targets[face]));
            scale * parallel::sum(areas.len(), |face| self.targets[face] * cost(face))
        };
        let authalic_energy = total(Profile::Stretch);
        let minimized = if self.profile == Profile::Stretch { authalic_energy } else { total(self.profile) };
        let factor = if self.scale_free { 4.0 * PI / area } else { 1.0 };
        Value { authalic_energy, area, objective: factor * (minimized + area) }
    }

    fn corners(&self, map: &[Vector3], face: usize) -> [Vector3; 3] {
        triangle(map, self.mesh.faces()[face])
    }

    /// Σ over the faces of each vertex of (f_j − f_k) × `pull`, jk the opposite edge.
    fn gather(&self, map: &[Vector3], pull: &[Vector3]) -> Vec<Vector3> {
        parallel::map(map.len(), |vertex| {
            let mut sum = Vector3::ZERO;
            for &corner in self.mesh.vertex_corners(Vertex::new(vertex)) {
                let (face, k) = (corner.face().index(), corner.place());
                let points = self.corners(map, face);
                let force = (points[(k + 1) % 3] - points[(k + 2) % 3]).cross(pull[face]);
                sum += force;
            }
            sum
        })
    }
}

/// Entry (s, t) of the 3 × 3 block of two corners with opposite edges `p` and `q`: Σ_{ℓ≠s} p^ℓ q^ℓ on the
/// diagonal, p^s q^t − 2 p^t q^s off it.
fn hessian_entry(p: Vector3, q: Vector3, s: usize, t: usize) -> f64 {
    if s == t { p.dot(q) - p[s] * q[s] } else { p[s] * q[t] - 2.0 * p[t] * q[s] }
}
