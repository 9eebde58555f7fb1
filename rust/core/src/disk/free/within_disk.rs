// SPDX-License-Identifier: MIT OR Apache-2.0
//! A map with a free outline brought into the unit disk.

use super::outline::Outline;
use super::surface::Free;
use crate::codomain::planar::PlanarMap;
use crate::disk::certificate;
use crate::mesh::TriangleMesh;
use crate::parallel;

impl Free<'_> {
    /// The map turned, moved and scaled into the unit disk, as far as rounding folds no tiny face.
    pub(super) fn within_the_disk(&self, outline: &Outline, map: &[[f64; 2]]) -> PlanarMap {
        let is_sound = |map: &PlanarMap| {
            (self.options.overlap || outline.is_simple(map)) && certificate::folded(self.mesh, map).is_empty()
        };
        // a given start keeps its rotation
        let turned = match self.options.initial {
            None => turned(self.mesh, map.to_vec()),
            Some(_) => map.to_vec(),
        };
        let candidates = [(&*turned, true), (map, true), (&*turned, false), (map, false)];
        let placed = |(map, to_rim)| scaled_into_the_disk(map, center(map), to_rim);
        let sound = candidates.into_iter().map(placed).find(is_sound);
        sound.unwrap_or_else(|| scaled_into_the_disk(map, [0.0; 2], false))
    }
}

/// The middle of the bounding box.
fn center(map: &[[f64; 2]]) -> [f64; 2] {
    let extreme =
        |axis: usize, sign: f64| map.iter().fold(f64::NEG_INFINITY, |most, x| most.max(sign * x[axis]));
    [0, 1].map(|axis| 0.5 * (extreme(axis, 1.0) - extreme(axis, -1.0)))
}

/// The map turned so that the first vertex of the longest boundary loop lies to the right of the mean of all vertices;
/// unchanged where the rounding of the rotation folds a sliver.
pub(super) fn turned_without_folds(mesh: &TriangleMesh, map: PlanarMap) -> PlanarMap {
    let turned = turned(mesh, map.clone());
    if certificate::folded(mesh, &turned).is_empty() { turned } else { map }
}

fn turned(mesh: &TriangleMesh, map: PlanarMap) -> PlanarMap {
    let mean = parallel::sums(map.len(), |v| map[v]).map(|sum| sum / map.len() as f64);
    let first = map[mesh.boundary_loops()[0][0]];
    let [x, y] = [first[0] - mean[0], first[1] - mean[1]];
    let length = x.hypot(y);
    if length.is_nan() || length <= 0.0 {
        return map;
    }
    let [cosine, sine] = [x / length, y / length];
    let around_mean = map.iter().map(|&[u, v]| [u - mean[0], v - mean[1]]);
    around_mean.map(|[u, v]| [cosine * u + sine * v, cosine * v - sine * u]).collect()
}

pub(super) fn signed_area(mesh: &TriangleMesh, map: &[[f64; 2]]) -> f64 {
    parallel::sum(mesh.n_faces(), |face| {
        let [a, b, c] = mesh.faces()[face].map(|v| map[v]);
        0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
    })
}

/// The map around `center`, scaled into the unit disk: to its rim, or by a power of two, which keeps the orientation of
/// every face bit for bit.
fn scaled_into_the_disk(map: &[[f64; 2]], center: [f64; 2], to_rim: bool) -> PlanarMap {
    let offset = |x: &[f64; 2]| [x[0] - center[0], x[1] - center[1]];
    let radius = map.iter().map(offset).map(|[u, v]| u.hypot(v)).fold(0.0, f64::max);
    let scale =
        if to_rim { (1.0 - 4.0 * f64::EPSILON) / radius } else { (1.0 / radius).log2().floor().exp2() };
    map.iter().map(|x| offset(x).map(|c| scale * c)).collect()
}
