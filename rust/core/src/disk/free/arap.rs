// SPDX-License-Identifier: MIT OR Apache-2.0
//! As-rigid-as-possible maps: every face as near to a turned copy of its rest triangle as its neighbors allow.
//!
//! L. Liu, L. Zhang, Y. Xu, C. Gotsman and S. J. Gortler, A local/global approach to mesh parameterization, SGP 2008.
//! The local step turns each rest triangle as its image is turned, the global one solves a Poisson equation for the
//! map. Cost of a step: one solve for both coordinates. Faces may fold.

use super::energy::Energy;
use super::poisson::Poisson;
use crate::codomain::planar::PlanarMap;
use crate::control::Watch;
use crate::parallel;
use crate::sparse::Failure;

/// The map after so many local and global steps from `map`.
pub(super) fn as_rigid_as_possible(
    energy: &Energy<'_>,
    poisson: &Poisson,
    mut map: PlanarMap,
    steps: usize,
    watch: &Watch<'_>,
) -> Result<PlanarMap, Failure> {
    for _ in 0..steps {
        // 1. Local: the rotation of every face
        let turns = parallel::map(energy.mesh.n_faces(), |face| {
            let [a, b, c, d] = energy.entries(&map, face);
            let (cosine, sine) = (a + d, c - b);
            let length = cosine.hypot(sine);
            let [cosine, sine] = if length > 0.0 { [cosine / length, sine / length] } else { [1.0, 0.0] };
            [cosine, -sine, sine, cosine]
        });
        // 2. Global: the map whose Jacobians are nearest to them
        map = poisson.map(energy, &turns);
        if !watch.goes_on() {
            return Err(Failure::Cancelled);
        }
    }
    Ok(map)
}
