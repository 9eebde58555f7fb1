// SPDX-License-Identifier: MIT OR Apache-2.0
//! The stretch energy of a planar map, its gradient and its Laplacian L_S(f).
//!
//! Liu & Yueh (2023), equations (2.1), (2.2) and (5.2). With a_τ the signed area of the image of face τ and
//! |τ| its target area,
//!
//! ```text
//! E_S(f) = Σ a_τ² / |τ| = ½ fᵀ (I₂ ⊗ L_S(f)) f,      ∇E_S = 2 (I₂ ⊗ L_S(f)) f,
//! ```
//!
//! and the edge ij of face ijk has the weight (f_i − f_k)·(f_j − f_k) / (4|τ|) in L_S(f). The area A = Σ
//! a_τ depends on the boundary only. With targets rescaled so that |M| = A, the authalic energy is
//!
//! ```text
//! E_A(f) = E_S(f) − A = Σ (a_τ − |τ|)² / |τ| ≥ 0.
//! ```
//!
//! The objective is Σ |τ| (a_τ/|τ| − 1)²·π/A = E_A·π/A, the authalic energy of the image rescaled to
//! the unit disk's area. For a fixed boundary A is constant and this is the papers' stretch energy up to
//! constants; for a sliding one the factor removes the false minimum A → 0. The residual form is used
//! because E_S − A cancels: near the minimum E_S ≈ π and E_A ≈ 10⁻⁶.
//!
//! A descent that must not fold uses [`Profile::Barrier`] instead of (ρ − 1)² for the area ratio ρ =
//! a_τ/|τ|: it has the same minimum and the same curvature there, but becomes infinite as ρ → 0.
//!
//! Cost: one pass over the faces, one gather over the corners of each vertex.

use std::f64::consts::PI;

use crate::mesh::{TriangleMesh, Vertex};
use crate::parallel;

/// The cost ψ of an area ratio ρ, per target area.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Profile {
    /// (ρ − 1)², the papers' energy.
    #[default]
    Stretch,
    /// ½ (ρ − 1)² (1 + 1/ρ) for ρ > 0, +∞ otherwise.
    Barrier,
}

impl Profile {
    /// The cost ψ(ρ).
    pub fn cost(self, ratio: f64) -> f64 {
        match self {
            Self::Stretch => (ratio - 1.0).powi(2),
            Self::Barrier if ratio > 0.0 => 0.5 * (ratio - 1.0).powi(2) * (1.0 + 1.0 / ratio),
            Self::Barrier => f64::INFINITY,
        }
    }

    /// The second derivative of the cost over that of the papers' energy, ψ''(ρ)/2.
    pub fn stiffness(self, ratio: f64) -> f64 {
        match self {
            Self::Stretch => 1.0,
            Self::Barrier => 0.5 * (1.0 + ratio.powi(-3)),
        }
    }

    /// The derivative ψ'(ρ).
    pub fn slope(self, ratio: f64) -> f64 {
        match self {
            Self::Stretch => 2.0 * (ratio - 1.0),
            Self::Barrier => 0.5 * (2.0 * ratio - 1.0 - ratio.powi(-2)),
        }
    }
}

/// Stretch energy of maps of one mesh into the plane, for given target areas.
#[derive(Debug, Clone, Copy)]
pub struct StretchEnergy<'a> {
    mesh: &'a TriangleMesh,
    targets: &'a [f64],
    total_target: f64,
    profile: Profile,
}

/// The value of the energy with the image's area.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Value {
    /// E_A of the map, targets rescaled to its area.
    pub authalic_energy: f64,
    /// Area A of the image, signed in the plane.
    pub area: f64,
    /// The objective of the optimizers: in the plane Σ |τ| ψ(ρ)·π/A, which is E_A·π/A for the papers' profile; in space
    /// Σ |τ| ψ(ρ) + A, which is the papers' normalized energy E_A + A, or 4π/A times that.
    pub objective: f64,
}

impl<'a> StretchEnergy<'a> {
    /// The energy of maps of `mesh` with one positive target area per face, on any common scale.
    pub fn new(mesh: &'a TriangleMesh, targets: &'a [f64]) -> Self {
        assert_eq!(targets.len(), mesh.n_faces(), "one target area per face");
        let total_target = parallel::sum(targets.len(), |face| targets[face]);
        Self { mesh, targets, total_target, profile: Profile::Stretch }
    }

    /// The energy with another cost of area ratios.
    pub fn with_profile(self, profile: Profile) -> Self {
        Self { profile, ..self }
    }

    /// The target areas, one per face.
    pub fn targets(&self) -> &[f64] {
        self.targets
    }

    /// The energies and the area of the image of `map`.
    pub fn value(&self, map: &[[f64; 2]]) -> Value {
        self.value_of_areas(&self.areas(map))
    }

    /// The value at `map` and the gradient of the objective by every vertex.
    ///
    /// With c = A/|M| and ρ = a_τ/(c|τ|) the derivative by a_τ is π/A (ψ'(ρ_τ) − Σ a ψ'(ρ)/A); ∇a_τ carries
    /// it to the vertices.
    pub fn gradient(&self, map: &[[f64; 2]]) -> (Value, Vec<[f64; 2]>) {
        let areas = self.areas(map);
        let value = self.value_of_areas(&areas);
        let scale = value.area / self.total_target;
        let slope = |face: usize| self.profile.slope(areas[face] / (scale * self.targets[face]));
        let shift = parallel::sum(areas.len(), |face| areas[face] * slope(face)) / value.area;
        let by_area = parallel::map(areas.len(), |face| PI / value.area * (slope(face) - shift));
        (value, self.gather(map, &by_area))
    }

    /// The weights of L_S(f), one per corner for the edge opposite it, targets rescaled to the image's area.
    ///
    /// The barrier profile weighs each face by its stiffness ψ''(ρ)/2, so that steps stay in proportion to the faces
    /// that are nearly folded.
    pub fn laplacian_weights(&self, map: &[[f64; 2]]) -> Vec<f64> {
        let scale = self.area(map) / self.total_target;
        parallel::map(3 * self.targets.len(), |corner| {
            let (face, k) = (corner / 3, corner % 3);
            let (corners, target) = (self.corners(map, face), scale * self.targets[face]);
            let [i, j, k] = [(k + 1) % 3, (k + 2) % 3, k].map(|c| corners[c]);
            let dot = (i[0] - k[0]) * (j[0] - k[0]) + (i[1] - k[1]) * (j[1] - k[1]);
            self.profile.stiffness(0.5 * doubled_area(corners) / target) * dot / (4.0 * target)
        })
    }

    /// Signed area of the image of every face.
    pub fn areas(&self, map: &[[f64; 2]]) -> Vec<f64> {
        parallel::map(self.targets.len(), |face| 0.5 * doubled_area(self.corners(map, face)))
    }

    /// Signed area of the whole image.
    pub fn area(&self, map: &[[f64; 2]]) -> f64 {
        parallel::sum(self.targets.len(), |face| 0.5 * doubled_area(self.corners(map, face)))
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
        Value { authalic_energy, area, objective: minimized * PI / area }
    }

    fn corners(&self, map: &[[f64; 2]], face: usize) -> [[f64; 2]; 3] {
        self.mesh.faces()[face].map(|vertex| map[vertex])
    }

    /// Σ over the faces of each vertex of `by_area` times ∂a_τ/∂f_v, a quarter turn of half the opposite
    /// edge.
    fn gather(&self, map: &[[f64; 2]], by_area: &[f64]) -> Vec<[f64; 2]> {
        parallel::map(map.len(), |vertex| {
            let mut sum = [0.0; 2];
            for &corner in self.mesh.vertex_corners(Vertex::new(vertex)) {
                let (face, k) = (corner.face().index(), corner.place());
                let points = self.corners(map, face);
                let (from, to) = (points[(k + 1) % 3], points[(k + 2) % 3]);
                sum[0] += 0.5 * by_area[face] * (from[1] - to[1]);
                sum[1] += 0.5 * by_area[face] * (to[0] - from[0]);
            }
            sum
        })
    }
}

/// Twice the signed area of a plane triangle.
pub fn doubled_area([a, b, c]: [[f64; 2]; 3]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}
