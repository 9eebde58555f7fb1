// SPDX-License-Identifier: MIT OR Apache-2.0
//! The stretch energy of a planar map, its gradient and its Laplacian L_S(f).
//!
//! Liu & Yueh (2023), equations (2.1), (2.2) and (5.2). With a_τ the signed area of the image of face τ and |τ| its
//! target area,
//!
//! ```text
//! E_S(f) = Σ a_τ² / |τ| = ½ fᵀ (I₂ ⊗ L_S(f)) f,      ∇E_S = 2 (I₂ ⊗ L_S(f)) f,
//! ```
//!
//! and the edge ij of face ijk has the weight (f_i − f_k)·(f_j − f_k) / (4|τ|) in L_S(f). The area A = Σ a_τ depends on
//! the boundary only. With targets rescaled so that |M| = A, the authalic energy is
//!
//! ```text
//! E_A(f) = E_S(f) − A = Σ (a_τ − |τ|)² / |τ| ≥ 0.
//! ```
//!
//! What is minimised is E_A·π/A, the authalic energy of the image rescaled to the unit disk's area. For a fixed boundary A is
//! constant and this is the papers' stretch energy up to constants; for a sliding one the factor removes the
//! false minimum A → 0. The residual form is used because E_S − A cancels: near the minimum E_S ≈ π and E_A ≈ 10⁻⁶.
//!
//! Cost: one pass over the faces, one gather over the corners of each vertex.

use std::f64::consts::PI;

use crate::mesh::TriangleMesh;
use crate::parallel;

/// Stretch energy of maps of one mesh into the plane, for given target areas.
#[derive(Debug, Clone, Copy)]
pub struct StretchEnergy<'a> {
    mesh: &'a TriangleMesh,
    targets: &'a [f64],
    total_target: f64,
}

/// The value of the energy with what it is made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Value {
    /// E_A of the map, targets rescaled to its area.
    pub authalic_energy: f64,
    /// Signed area A of the image.
    pub area: f64,
}

impl Value {
    /// E_A·π/A, the objective of the optimisers.
    pub fn objective(self) -> f64 {
        self.authalic_energy * PI / self.area
    }
}

impl<'a> StretchEnergy<'a> {
    /// The energy of maps of `mesh` with one positive target area per face, on any common scale.
    pub fn new(mesh: &'a TriangleMesh, targets: &'a [f64]) -> Self {
        assert_eq!(targets.len(), mesh.n_faces(), "one target area per face");
        let total_target = parallel::sum(targets.len(), |face| targets[face]);
        Self { mesh, targets, total_target }
    }

    /// E_A and the area of the image of `map`.
    pub fn value(&self, map: &[[f64; 2]]) -> Value {
        let areas = self.areas(map);
        self.value_of_areas(&areas)
    }

    /// The value at `map` and the gradient of the objective E_A·π/A by every vertex.
    ///
    /// With c = A/|M|: ∇E_A = Σ 2 (a_τ/(c|τ|) − 1) ∇a_τ − (E_A/A) ∇A.
    pub fn gradient(&self, map: &[[f64; 2]]) -> (Value, Vec<[f64; 2]>) {
        let areas = self.areas(map);
        let value = self.value_of_areas(&areas);
        let scale = value.area / self.total_target;
        let shift = 1.0 + value.authalic_energy / value.area;
        // ∂E_A·π/A by the area of each face; ∇A is the same sum with the factor 1
        let by_area = parallel::map(areas.len(), |face| {
            2.0 * PI / value.area * (areas[face] / (scale * self.targets[face]) - shift)
        });
        (value, self.gather(map, &by_area))
    }

    /// The weights of L_S(f), one per corner for the edge opposite it, targets rescaled to the image's area.
    pub fn laplacian_weights(&self, map: &[[f64; 2]]) -> Vec<f64> {
        let scale = self.area(map) / self.total_target;
        parallel::map(3 * self.targets.len(), |corner| {
            let (face, k) = (corner / 3, corner % 3);
            let [i, j, k] = [k + 1, k + 2, k].map(|c| map[self.mesh.faces()[face][c % 3] as usize]);
            let dot = (i[0] - k[0]) * (j[0] - k[0]) + (i[1] - k[1]) * (j[1] - k[1]);
            dot / (4.0 * scale * self.targets[face])
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
        let authalic_energy = parallel::sum(areas.len(), |face| {
            let target = scale * self.targets[face];
            (areas[face] - target).powi(2) / target
        });
        Value { authalic_energy, area }
    }

    fn corners(&self, map: &[[f64; 2]], face: usize) -> [[f64; 2]; 3] {
        self.mesh.faces()[face].map(|vertex| map[vertex as usize])
    }

    /// Σ over the faces of each vertex of `by_area` times ∂a_τ/∂f_v, a quarter turn of half the opposite edge.
    fn gather(&self, map: &[[f64; 2]], by_area: &[f64]) -> Vec<[f64; 2]> {
        parallel::map(map.len(), |vertex| {
            let mut sum = [0.0; 2];
            for &corner in self.mesh.vertex_corners(vertex) {
                let (face, k) = (corner as usize / 3, corner as usize % 3);
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
