// SPDX-License-Identifier: MIT OR Apache-2.0
//! Spectral conformal maps: the outline of least conformal energy.
//!
//! P. Mullen, Y. Tong, P. Alliez and M. Desbrun, Spectral conformal parameterization, SGP 2008. Among the maps with a
//! fixed moment of inertia of their boundary the one of least conformal energy is the first eigenvector of L_C x = μ B
//! x after the constants, B the boundary's mass, here one per vertex. Inverse iteration with our own factorization
//! finds it. Cost: one factorization of two unknowns per vertex and [`ITERATIONS`] solves.

use std::f64::consts::TAU;

use super::energy::Energy;
use super::face::Element;
use crate::codomain::planar::PlanarMap;
use crate::control::Watch;
use crate::mesh::Vertex;
use crate::sparse::{Analysis, Factor, Failure};

/// Inverse iterations; a few are enough for a start.
const ITERATIONS: usize = 12;

/// Shifts of the singular matrix in units of its diagonal, tried in this order until it is positive definite.
const SHIFTS: [f64; 4] = [1e-12, 1e-10, 1e-8, 1e-6];

/// A conformal map of area one, by the system of `analysis` with two unknowns at every vertex.
pub(super) fn spectral_conformal(
    energy: &Energy<'_>,
    analysis: &Analysis,
    watch: &Watch<'_>,
) -> Result<PlanarMap, Failure> {
    // 1. The conformal energy of every face, factored
    let factor = factored(energy, analysis, watch)?;
    // 2. Inverse iteration from the outline laid around a circle
    let loops = energy.mesh.boundary_loops();
    let boundary: Vec<Vertex> = loops.iter().flatten().copied().collect();
    let mut map = around_a_circle(energy);
    for _ in 0..ITERATIONS {
        let mean = mean(boundary.iter().map(|&v| map[v]));
        let mut unknowns = vec![0.0; analysis.n_unknowns()];
        for &v in &boundary {
            (0..2).for_each(|k| unknowns[analysis.first_unknown(v) + k] = map[v][k] - mean[k]);
        }
        factor.solve(analysis, &mut unknowns);
        if !watch.goes_on() {
            return Err(Failure::Cancelled);
        }
        let largest = unknowns.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        map = (0..map.len())
            .map(|v| [0, 1].map(|k| unknowns[analysis.first_unknown(v) + k] / largest))
            .collect();
    }
    // 3. The size of the targets, the surface's orientation
    Ok(of_area_one(energy, map))
}

fn factored(energy: &Energy<'_>, analysis: &Analysis, watch: &Watch<'_>) -> Result<Factor<f64>, Failure> {
    let mut factor = Factor::new(analysis);
    for shift in SHIFTS {
        let element = |face: usize| conformal_element(energy, face, shift);
        match factor.refactor(analysis, &element, watch) {
            Err(Failure::NotPositiveDefinite) => {}
            verdict => return verdict.map(|()| factor),
        }
    }
    Err(Failure::NotPositiveDefinite)
}

/// The matrix of ½ A [(a − d)² + (b + c)²], shifted.
fn conformal_element(energy: &Energy<'_>, face: usize, shift: f64) -> Element {
    let hats = energy.hats(face);
    let stretch: [f64; 6] =
        std::array::from_fn(|k| if k % 2 == 0 { hats[k / 2][0] } else { -hats[k / 2][1] });
    let shear: [f64; 6] = std::array::from_fn(|k| hats[k / 2][1 - k % 2]);
    let area = energy.targets[face];
    let mut element: Element = std::array::from_fn(|i| {
        std::array::from_fn(|j| area * (stretch[i] * stretch[j] + shear[i] * shear[j]))
    });
    (0..6).for_each(|k| element[k][k] *= 1.0 + shift);
    element
}

/// The longest loop on a circle by its edge lengths, all other vertices at the origin.
fn around_a_circle(energy: &Energy<'_>) -> PlanarMap {
    let (mesh, outline) = (energy.mesh, &energy.mesh.boundary_loops()[0]);
    let point = |k: usize| mesh.points()[outline[k % outline.len()]];
    let lengths: Vec<f64> = (0..outline.len()).map(|k| point(k + 1).distance(point(k))).collect();
    let (total, mut traveled) = (lengths.iter().sum::<f64>(), 0.0);
    let mut map = vec![[0.0; 2]; mesh.n_vertices()];
    for (&v, length) in outline.iter().zip(lengths) {
        let angle = TAU * traveled / total;
        map[v] = [angle.cos(), angle.sin()];
        traveled += length;
    }
    map
}

/// The map scaled so that its signed area is one, mirrored where that is negative.
pub(super) fn of_area_one(energy: &Energy<'_>, mut map: PlanarMap) -> PlanarMap {
    let signed = |face: usize| {
        let [a, b, c, d] = energy.entries(&map, face);
        energy.targets[face] * (a * d - b * c)
    };
    let area: f64 = (0..energy.mesh.n_faces()).map(signed).sum();
    let scale = area.abs().sqrt().recip();
    let scale = if scale.is_finite() { scale } else { 1.0 };
    let mean = mean(map.iter().copied());
    let signs = if area < 0.0 { [-scale, scale] } else { [scale, scale] };
    map.iter_mut().for_each(|x| *x = [0, 1].map(|k| signs[k] * (x[k] - mean[k])));
    map
}

fn mean(points: impl ExactSizeIterator<Item = [f64; 2]>) -> [f64; 2] {
    let count = points.len() as f64;
    points.fold([0.0; 2], |sum, x| [sum[0] + x[0], sum[1] + x[1]]).map(|sum| sum / count)
}
