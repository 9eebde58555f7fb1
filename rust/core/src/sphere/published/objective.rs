// SPDX-License-Identifier: MIT OR Apache-2.0
//! Maps onto the unit sphere as a [`Objective`]: the power manifold (S²)ⁿ.
//!
//! Sutti & Yueh (2024), sections 4 and 5: directions are tangent, (x, y, z) of vertex 0, then of vertex 1,
//! and so on; the Riemannian gradient is the Euclidean one projected to the tangent planes (5.1), and the
//! retraction normalizes f + ξ row by row (4.3). The objective is the paper's normalized energy (2.4) times
//! 4π/A, because the paper's energy falls when the inscribed polyhedron shrinks, where descents on coarse meshes
//! end. The paper's descent has no preconditioner; the guarded one has I₃ ⊗ L_S(f⁰), projected to the
//! tangent planes.

use crate::codomain::SpatialMap;
use crate::control::Watch;
use crate::energy::SpatialStretchEnergy;
use crate::energy::stretch::{Profile, Value};
use crate::error::Error;
use crate::mesh::TriangleMesh;
use crate::mesh::geometry::{determinant_rounding, triangle};
use crate::optimize::published::{Energies, Objective};
use crate::parallel;
use crate::sparse::{Cholesky, Laplacian};
use crate::vector::{Vector3, coordinates};

/// Part of the mean diagonal that is added to L_S(f⁰), which takes constants to zero.
const SHIFT: f64 = 1e-6;

/// Maps of one mesh onto the unit sphere.
#[derive(Debug)]
pub(crate) struct SphereObjective<'a> {
    mesh: &'a TriangleMesh,
    energy: SpatialStretchEnergy<'a>,
    /// Only in a guarded descent.
    preconditioner: Option<(Laplacian, Cholesky)>,
    /// Maps with a folded face have an infinite objective.
    guarded: bool,
}

impl<'a> SphereObjective<'a> {
    pub(crate) fn new(mesh: &'a TriangleMesh, targets: &'a [f64]) -> Self {
        let energy = SpatialStretchEnergy::new(mesh, targets).scale_free();
        Self { mesh, energy, preconditioner: None, guarded: false }
    }

    pub(super) fn mesh(&self) -> &'a TriangleMesh {
        self.mesh
    }

    pub(super) fn energy(&self) -> &SpatialStretchEnergy<'a> {
        &self.energy
    }

    /// From now on a map with a folded face has an infinite objective, and one with a face near to losing its area a
    /// large one.
    pub(super) fn guard(&mut self) {
        self.guarded = true;
        self.energy = self.energy.with_profile(Profile::Barrier);
    }

    /// Sets M = 2 I₃ ⊗ L_S(f) at f = `map`, made definite by a small shift.
    ///
    /// # Errors
    /// [`NumericsError::FactorizationFailed`](crate::NumericsError::FactorizationFailed) where the weights are too far
    /// apart.
    pub(super) fn set_preconditioner(&mut self, map: &[Vector3], watch: &Watch<'_>) -> Result<(), Error> {
        let mut weights = self.energy.laplacian_weights(map);
        parallel::fill_with_old(&mut weights, |_, weight| 2.0 * weight);
        let (mut laplacian, mut factor) = match self.preconditioner.take() {
            Some(block) => block,
            None => {
                let laplacian = Laplacian::new(self.mesh, |_| true);
                let factor = Cholesky::analyze_on(self.mesh, laplacian.matrix())?;
                (laplacian, factor)
            }
        };
        laplacian.assemble(self.mesh, &weights);
        laplacian.shift_diagonal(SHIFT);
        factor.refactor_while(laplacian.matrix(), watch)?;
        self.preconditioner = Some((laplacian, factor));
        Ok(())
    }

    fn full_objective(&self, map: &[Vector3], value: Value) -> f64 {
        if self.guarded && !clearly_unfolded(self.mesh, map) { f64::INFINITY } else { value.objective }
    }
}

impl Objective for SphereObjective<'_> {
    type Map = SpatialMap;

    fn value(&self, map: &SpatialMap) -> f64 {
        self.full_objective(map, self.energy.value(map))
    }

    fn gradient(&self, map: &SpatialMap) -> (Energies, Vec<f64>) {
        let (value, mut gradient) = self.energy.gradient(map);
        parallel::fill_with_old(&mut gradient, |vertex, g| tangent(map[vertex], g));
        let energies =
            Energies { objective: self.full_objective(map, value), authalic_energy: value.authalic_energy };
        (energies, coordinates(gradient).into_flattened())
    }

    fn precondition(&self, map: &SpatialMap, gradient: &[f64]) -> Vec<f64> {
        let Some((_, factor)) = &self.preconditioner else {
            return gradient.to_vec();
        };
        let n = map.len();
        let mut columns = parallel::map(3 * n, |i| gradient[3 * (i % n) + i / n]);
        factor.solve(&mut columns);
        let column = |v: usize| Vector3::from_fn(|axis| columns[axis * n + v]);
        coordinates(parallel::map(n, |vertex| tangent(map[vertex], column(vertex)))).into_flattened()
    }

    fn retract(&self, map: &SpatialMap, direction: &[f64], step: f64) -> SpatialMap {
        parallel::map(map.len(), |vertex| {
            let moved: Vector3 =
                Vector3::from_fn(|axis| map[vertex][axis] + step * direction[3 * vertex + axis]);
            moved.normalized()
        })
    }
}

/// The projection (4.1) of `z` to the tangent plane at `x`.
fn tangent(x: Vector3, z: Vector3) -> Vector3 {
    z - x * x.dot(z)
}

/// True if every face is positive around the origin by more than its rounding error; never true for a folded
/// face.
fn clearly_unfolded(mesh: &TriangleMesh, map: &[Vector3]) -> bool {
    parallel::all(mesh.n_faces(), |face| is_clearly_positive(triangle(map, mesh.faces()[face])))
}

/// True if det(a, b, c) is positive by more than its rounding error.
fn is_clearly_positive([a, b, c]: [Vector3; 3]) -> bool {
    let (p, q) = (b - a, c - a);
    a.dot(p.cross(q)) > determinant_rounding(a, p, q)
}
