// SPDX-License-Identifier: MIT OR Apache-2.0
//! Unfolds the few folded faces that an unguarded method leaves on the sphere.
//!
//! The bijectivity correction of Sutti & Yueh (2024), section 6.2, see [`mean_value`]: in the chart of either
//! hemisphere the vertices |h_i| < r are replaced by mean-value combinations of their one-rings. The
//! correction moves only folded faces, so only the vertices within a few rings of them are freed, and more where
//! that does not suffice, up to the whole hemisphere as in the paper.
//!
//! Cost: one sparse LU of the freed vertices per attempt and hemisphere.

use super::stereographic::Chart;
use crate::codomain::SpatialMap;
use crate::distortion::folded_on_sphere;
use crate::energy::mean_value;
use crate::energy::mean_value::{Weights, correct};
use crate::mesh::{TriangleMesh, Vertex};
use crate::vector::Vector3;

/// Modulus up to which a chart's vertices may be freed, a little beyond its hemisphere; the paper's r.
const RADIUS: f64 = 1.2;

/// Passes over both hemispheres with the same rings, each with the weights of the map before it.
const PASSES: usize = 3;

/// Limit of the rings, at which every vertex is free on any surface that is not a thread.
const MOST_RINGS: usize = 4096;

/// Returns `map` with its folded faces unfolded, or `None` where even whole hemispheres do not suffice.
pub(super) fn unfold(mesh: &TriangleMesh, map: &[Vector3]) -> Option<SpatialMap> {
    unfold_within(mesh, map, MOST_RINGS)
}

/// [`unfold`] with at most `most_rings` rings around the folded faces free.
pub(crate) fn unfold_within(mesh: &TriangleMesh, map: &[Vector3], most_rings: usize) -> Option<SpatialMap> {
    let mut map = map.to_vec();
    let mut folded = folded_on_sphere(mesh.faces(), &map);
    let mut rings = 2;
    while !folded.is_empty() && rings <= most_rings {
        // 1. Free a few rings around the folded faces, in both hemispheres; repeat with the new weights
        // 2. Where that gains nothing, use uniform weights
        for weights in [Weights::MeanValue, Weights::Uniform] {
            for _ in 0..PASSES {
                let mended = mend(mesh, &map, rings, weights);
                let left = folded_on_sphere(mesh.faces(), &mended);
                if left.len() >= folded.len() {
                    break;
                }
                (map, folded) = (mended, left);
            }
        }
        // 3. Repeat with twice the rings
        rings *= 2;
    }
    folded.is_empty().then_some(map)
}

/// One correction in each hemisphere's chart; omits a chart whose system is singular.
fn mend(mesh: &TriangleMesh, map: &[Vector3], rings: usize, weights: Weights) -> SpatialMap {
    let mut map = map.to_vec();
    for chart in [Chart::North, Chart::South] {
        let folded = folded_on_sphere(mesh.faces(), &map);
        let mut plane = chart.project_all(&map);
        let modulus = |vertex: Vertex| plane[vertex][0].hypot(plane[vertex][1]);
        let free = mean_value::free_within(mesh, &folded, rings, |vertex| modulus(vertex) < RADIUS);
        if !free.is_empty() && correct(mesh, &mut plane, &free, weights).is_some() {
            free.iter().for_each(|&vertex| map[vertex] = chart.lift(plane[vertex]));
        }
    }
    map
}
