// SPDX-License-Identifier: MIT OR Apache-2.0
//! As-rigid-as-possible maps: every face as near to a turned copy of its rest triangle as its neighbors allow.
//!
//! L. Liu, L. Zhang, Y. Xu, C. Gotsman and S. J. Gortler, A local/global approach to mesh parameterization, SGP 2008.
//! The local step turns each rest triangle as its image is turned, the global one solves a Poisson equation for the
//! map. Cost: one factorization of one unknown per vertex, [`STEPS`] solves for both coordinates. Faces may fold.

use super::energy::Energy;
use crate::codomain::planar::PlanarMap;
use crate::control::Watch;
use crate::parallel;
use crate::sparse::{Analysis, Factor, Failure, Order};

/// Local and global steps.
const STEPS: usize = 15;

/// The shift of the Laplacian, which is blind to translations, in units of its diagonal.
const SHIFTS: [f64; 3] = [1e-10, 1e-8, 1e-6];

/// The map after [`STEPS`] local and global steps from `map`.
pub(super) fn as_rigid_as_possible(
    energy: &Energy<'_>,
    mut map: PlanarMap,
    watch: &Watch<'_>,
) -> Result<PlanarMap, Failure> {
    let (mesh, n) = (energy.mesh, energy.mesh.n_vertices());
    let analysis = Analysis::new(n, mesh.faces(), &vec![1; n], Order::AsGiven)
        .map_err(|_| Failure::NotPositiveDefinite)?;
    let factor = factored(energy, &analysis, watch)?;
    for _ in 0..STEPS {
        // 1. Local: the rotation of every face
        let turns = parallel::map(mesh.n_faces(), |face| {
            let [a, b, c, d] = energy.entries(&map, face);
            let (cosine, sine) = (a + d, c - b);
            let length = cosine.hypot(sine);
            if length > 0.0 { [cosine / length, sine / length] } else { [1.0, 0.0] }
        });
        // 2. Global: the map whose Jacobians are nearest to them
        let forces = energy.gathered(|corner| {
            let ([cosine, sine], g) = (turns[corner.face()], energy.hat(corner));
            let area = energy.targets[corner.face()];
            [area * (cosine * g[0] - sine * g[1]), area * (sine * g[0] + cosine * g[1])]
        });
        let mut columns: Vec<f64> = (0..2 * n).map(|k| forces[k % n][k / n]).collect();
        factor.solve(&analysis, &mut columns);
        map = (0..n).map(|v| [columns[v], columns[n + v]]).collect();
        if !watch.goes_on() {
            return Err(Failure::Cancelled);
        }
    }
    Ok(map)
}

fn factored(energy: &Energy<'_>, analysis: &Analysis, watch: &Watch<'_>) -> Result<Factor<f64>, Failure> {
    let mut factor = Factor::new(analysis);
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
        match factor.refactor(analysis, &element, watch) {
            Err(Failure::NotPositiveDefinite) => {}
            verdict => return verdict.map(|()| factor),
        }
    }
    Err(Failure::NotPositiveDefinite)
}
