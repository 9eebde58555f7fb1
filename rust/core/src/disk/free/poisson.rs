// SPDX-License-Identifier: MIT OR Apache-2.0
//! The map whose Jacobians are nearest to given ones.
//!
//! It minimizes Σ T |J − J*|² over the faces, with the targets T and the Jacobians J from rest triangles: a Poisson
//! equation for each coordinate. Cost: one factorization of one unknown per vertex, and two solves for each map.

use super::energy::Energy;
use crate::codomain::planar::PlanarMap;
use crate::control::Watch;
use crate::sparse::{Analysis, Factor, Failure, Order};

/// The shift of the Laplacian, which is blind to translations, in units of its diagonal.
const SHIFTS: [f64; 3] = [1e-10, 1e-8, 1e-6];

/// The factored Laplacian of rest triangles.
pub(super) struct Poisson {
    analysis: Analysis,
    factor: Factor<f64>,
}

impl Poisson {
    pub(super) fn new(energy: &Energy<'_>, watch: &Watch<'_>) -> Result<Self, Failure> {
        let (mesh, n) = (energy.mesh, energy.mesh.n_vertices());
        let analysis = Analysis::new(n, mesh.faces(), &vec![1; n], Order::AsGiven)
            .map_err(|_| Failure::NotPositiveDefinite)?;
        let mut factor = Factor::new(&analysis);
        for shift in SHIFTS {
            let element = |face: usize| {
                let (hats, area) = (energy.hats(face), energy.targets[face]);
                let mut element = [[0.0; 6]; 6];
                for i in 0..3 {
                    for j in 0..3 {
                        let shifted = if i == j { 1.0 + shift } else { 1.0 };
                        let product = hats[i][0] * hats[j][0] + hats[i][1] * hats[j][1];
                        element[2 * i][2 * j] = area * shifted * product;
                    }
                }
                element
            };
            match factor.refactor(&analysis, &element, watch) {
                Err(Failure::NotPositiveDefinite) => {}
                verdict => return verdict.map(|()| Self { analysis, factor }),
            }
        }
        Err(Failure::NotPositiveDefinite)
    }

    /// The map whose Jacobians are nearest to those given, (a, b, c, d) for every face.
    pub(super) fn map(&self, energy: &Energy<'_>, jacobians: &[[f64; 4]]) -> PlanarMap {
        let n = energy.mesh.n_vertices();
        let forces = energy.gathered(|corner| {
            let ([a, b, c, d], g) = (jacobians[corner.face()], energy.hat(corner));
            let area = energy.targets[corner.face()];
            [area * (a * g[0] + b * g[1]), area * (c * g[0] + d * g[1])]
        });
        let mut columns: Vec<f64> = (0..2 * n).map(|k| forces[k % n][k / n]).collect();
        self.factor.solve(&self.analysis, &mut columns);
        (0..n).map(|v| [columns[v], columns[n + v]]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::Silent;
    use crate::mesh::TriangleMesh;

    #[test]
    fn the_jacobians_of_a_map_give_the_map() {
        let points = [[0., 0., 1.], [1.3, 0., 0.], [0., 1., 0.2], [-1., -0.5, 0.], [2., 1., 0.5]];
        let mesh = TriangleMesh::new(&points, &[[0, 1, 2], [0, 2, 3], [0, 3, 1], [2, 1, 4]]).unwrap();
        let energy = Energy::new(&mesh, &[0.3, 0.5, 0.4, 0.2]);
        let map = [[0.05, -0.1], [0.9, 0.1], [-0.2, 0.8], [-0.6, -0.7], [1.0, 1.1]];
        let poisson = Poisson::new(&energy, &Watch::new(&mut Silent, 0.0, "")).unwrap();
        let jacobians: Vec<_> = (0..4).map(|face| energy.entries(&map, face)).collect();
        let again = poisson.map(&energy, &jacobians);
        for (x, y) in map.iter().zip(&again) {
            for k in 0..2 {
                let moved = (x[k] - map[0][k]) - (y[k] - again[0][k]);
                assert!(moved.abs() < 1e-7, "{moved}");
            }
        }
    }
}
