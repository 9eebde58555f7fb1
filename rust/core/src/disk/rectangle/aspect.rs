// SPDX-License-Identifier: MIT OR Apache-2.0
//! The aspect of a rectangle that suits angles best.

use crate::codomain::SpatialMap;
use crate::energy::authalic::AuthalicEnergy;
use crate::mesh::Vertex;
use crate::vector::Vector3;

/// Upper bound of an aspect and of its inverse.
pub(super) const MOST_ASPECT: f64 = 1e4;

/// A map stretched by `relaxation` times the way toward the aspect of least angle energy, and the logarithm by which
/// the aspect has changed; as it is where that would fold a face. `corners` are the lower left and the upper right
/// vertex.
pub(super) fn with_best_aspect(
    energy: &AuthalicEnergy,
    map: &SpatialMap,
    corners: [Vertex; 2],
    relaxation: f64,
) -> (SpatialMap, f64) {
    let [low, high] = corners.map(|corner| map[corner]);
    let now = ((high[0] - low[0]) / (high[1] - low[1])).ln();
    let bound = MOST_ASPECT.ln();
    let change = (now + 2.0 * relaxation * best_stretch(energy, map)).clamp(-bound, bound) - now;
    let factor = (0.5 * change).exp();
    let stretched: SpatialMap =
        map.iter().map(|&Vector3([x, y, z])| Vector3([x * factor, y / factor, z])).collect();
    if energy.is_embedding(&stretched) { (stretched, change) } else { (map.clone(), 0.0) }
}

/// The t for which the map (eᵗ x, e⁻ᵗ y) has the least angle energy, by Newton's method on a convex function.
fn best_stretch(energy: &AuthalicEnergy, map: &[Vector3]) -> f64 {
    let mut t = 0.0;
    for _ in 0..50 {
        let [slope, curvature] = energy.angle_slopes_of_stretch(map, t);
        let step = (-slope / curvature).clamp(-1.0, 1.0);
        if !step.is_finite() {
            return 0.0;
        }
        t += step;
        if step.abs() < 1e-14 {
            break;
        }
    }
    t
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::codomain::Codomain;
    use crate::disk::rectangle::tests::grid;

    #[test]
    fn the_best_stretch_makes_the_angle_energy_stationary() {
        let mesh = grid(4, 4, [1.0, 1.0]);
        let energy = AuthalicEnergy::new(&mesh, mesh.face_areas().to_vec(), Codomain::Plane, 0.0);
        let map: SpatialMap = mesh
            .points()
            .iter()
            .map(|p| Vector3([2.0 * p[0] + 0.3 * p[1], p[1] - 0.1 * p[0] * p[1], 1.0]))
            .collect();
        let t = best_stretch(&energy, &map);
        let angle = |t: f64| {
            let stretched: SpatialMap =
                map.iter().map(|x| Vector3([x[0] * t.exp(), x[1] / t.exp(), 1.0])).collect();
            energy.sums(&energy.costs(&stretched)).angle_energy
        };
        assert!(angle(t) < angle(t + 1e-3).min(angle(t - 1e-3)));
        assert!((t + 0.5 * 2f64.ln()).abs() < 0.1);
    }
}
