// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the caller of a registration by curves should look at: signs that the curves do not say what was meant.
//!
//! Cost: linear.

use super::features::placement::Placement;
use super::harmonic::certificates::Certificates;
use crate::distortion::Distortion;
use crate::mesh::TriangleMesh;
use crate::mesh::geometry::{area_vector, triangle};
use crate::vector::{Vector, add, dot, norm};

/// A harmonic energy of more than this over that of the identity says that the curves hardly fit.
const STRAINED: f64 = 2.0;
/// Faces whose share of area changes more than this are stretched or squeezed beyond use,
const TENFOLD: f64 = 10.0;
/// and this share of the surface is too much of them.
const TOO_MUCH: f64 = 0.05;
/// Surfaces look to opposite sides for sure where their area vectors are longer than this part of their areas.
const FACING: f64 = 0.2;

/// One sentence for each doubt, the most likely cause first.
pub(super) fn warnings(
    meshes: [&TriangleMesh; 2],
    placement: &Placement,
    is_sure: bool,
    certificates: &Certificates,
    figures: &Distortion,
) -> Vec<String> {
    let mut warnings = Vec::new();
    if face_apart(meshes) {
        warnings.push(
            "the surfaces look to opposite sides, so the map mirrors one: flip the faces of one of them"
                .into(),
        );
    }
    let backwards = placement.backwards.iter();
    warnings.extend(backwards.map(|curve| {
        format!("curve {curve} fits far better the other way round: reverse its path on one of the surfaces")
    }));
    if !is_sure {
        warnings.push(
            "the curves move too much to tell how the surface between them goes along: it may wind around them \
             more than meant"
                .into(),
        );
    }
    let ratio = certificates.energy_ratio;
    if ratio > STRAINED {
        warnings.push(format!(
            "the map is strained, its energy is {ratio:.1} times that of the surface itself (1.0 to 1.2 is usual): \
             check that curves with the same number belong together and run the same way"
        ));
    }
    let distorted = 100.0 * distorted_share(meshes[0], figures);
    if distorted > 100.0 * TOO_MUCH {
        warnings.push(format!(
            "{distorted:.0} % of the surface is stretched or squeezed more than tenfold: limbs far from all curves \
             are loosely held, give them curves or closed rings of their own"
        ));
    }
    warnings
}

/// Whether two open surfaces look to opposite sides as they lie in space.
fn face_apart(meshes: [&TriangleMesh; 2]) -> bool {
    let facing = meshes.map(|mesh| {
        let sum = |sum: Vector, &face: &[u32; 3]| add(sum, area_vector(triangle(mesh.points(), face)));
        let area: f64 = mesh.face_areas().iter().sum();
        mesh.faces().iter().fold([0.0; 3], sum).map(|x| x / area)
    });
    let least = FACING * FACING;
    norm(facing[0]) > FACING && norm(facing[1]) > FACING && dot(facing[0], facing[1]) < -least
}

/// The share of the surface in faces whose share of area changes more than tenfold.
fn distorted_share(mesh: &TriangleMesh, figures: &Distortion) -> f64 {
    let is_distorted = |face: &usize| figures.log2_area_ratio[*face].abs() > TENFOLD.log2();
    let areas = mesh.face_areas();
    let distorted: f64 = (0..areas.len()).filter(is_distorted).map(|face| areas[face]).sum();
    distorted / areas.iter().sum::<f64>()
}
