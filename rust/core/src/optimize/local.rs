// SPDX-License-Identifier: MIT OR Apache-2.0
//! Solves the few faces that carry most of the energy by themselves, all others held.
//!
//! After a Gauss–Newton step most of what is left sits in a few percent of the faces, where the linear prediction failed.
//! A small damped Gauss–Newton iteration over those faces and their one-rings costs a few percent of a step of the
//! whole and spares several of them.
//!
//! Damping after Nielsen (1999): by a third after a good step, by growing factors after a bad one.

use super::gauss_newton::{Damping, LEAST_DEVIATION, Linearised, Map, Problem};
use crate::control::Watch;
use crate::energy::authalic::Weights;
use crate::energy::motion::Motion;
use crate::parallel;
use crate::sparse::Order;

/// The worst faces are taken until they carry this part of the energy of areas,
const WORST: f64 = 0.8;

/// or are this part of all faces.
const MOST_FACES: f64 = 0.02;

/// Steps of the small iteration at the most.
const STEPS: usize = 6;

/// It ends when a step gains less than this part of the energy.
const LEAST_GAIN: f64 = 0.15;

/// Its first damping.
const DAMPING: f64 = 0.02;

/// A part of a map: what may move of it and what it touches.
struct Patch {
    problem: Problem,
    /// The vertex of each vertex of the patch.
    vertices: Vec<u32>,
}

/// Lowers the energy of `map`, which must be finite, over its worst faces; returns by how much.
pub(super) fn repair(problem: &Problem, map: &mut Map, weights: &Weights, watch: &Watch<'_>) -> f64 {
    // 1. The worst faces and their one-rings
    let worst = worst_faces(problem, map, weights);
    let Some(patch) = cut_out(problem, &worst) else { return 0.0 };
    // 2. A few damped steps over them
    let part: Map = patch.vertices.iter().map(|&vertex| map[vertex as usize]).collect();
    let (part, gain) = descend(&patch.problem, part, weights, watch);
    // 3. Back into the whole
    for (&vertex, x) in patch.vertices.iter().zip(part) {
        map[vertex as usize] = x;
    }
    gain
}

/// The faces whose areas cost most, in ascending order.
fn worst_faces(problem: &Problem, map: &Map, weights: &Weights) -> Vec<u32> {
    let n = problem.energy.faces().len();
    let costs = parallel::map(n, |face| problem.energy.area_cost(map, weights, face));
    let total = parallel::sum(n, |face| costs[face]);
    let most = (MOST_FACES * n as f64).ceil() as usize;
    let threshold = threshold(&costs, WORST * total, most);
    (0..n as u32).filter(|&face| costs[face as usize] > threshold).collect()
}

/// A power of two such that the values above it sum up to `part` or are `most` in number, whichever comes first.
fn threshold(values: &[f64], part: f64, most: usize) -> f64 {
    const BINS: usize = 256;
    let bin = |value: f64| (-value.log2()).clamp(0.0, BINS as f64 - 1.0) as usize;
    let (mut counts, mut sums) = ([0usize; BINS], [0.0; BINS]);
    for &value in values.iter().filter(|&&value| value > 0.0) {
        counts[bin(value)] += 1;
        sums[bin(value)] += value;
    }
    let (mut count, mut sum) = (0, 0.0);
    for k in 0..BINS {
        count += counts[k];
        sum += sums[k];
        if count > most {
            return (-(k as f64)).exp2();
        }
        if sum >= part {
            return (-(k as f64 + 1.0)).exp2();
        }
    }
    0.0
}

/// The patch in which the vertices of `faces` and their neighbours are free.
fn cut_out(problem: &Problem, faces: &[u32]) -> Option<Patch> {
    let energy = &problem.energy;
    let around = |vertices: &[u32]| {
        let corners = vertices.iter().flat_map(|&vertex| energy.vertex_corners(vertex as usize));
        sorted(corners.map(|corner| corner / 3).collect())
    };
    let corners_of =
        |faces: &[u32]| sorted(faces.iter().flat_map(|&face| energy.faces()[face as usize]).collect());
    let free = corners_of(&around(&corners_of(faces)));
    let inside = around(&free);
    let vertices = corners_of(&inside);
    let local = |vertex: u32| vertices.binary_search(&vertex).expect("a corner of the patch") as u32;
    let patch = energy.patch(&inside, vertices.len(), local);
    // landmarks stay: what moving them costs is not known in the patch
    let is_landmark = |vertex: &u32| problem.penalty.vertices().contains(vertex);
    let is_free = |vertex: &u32| free.binary_search(vertex).is_ok() && !is_landmark(vertex);
    let motion =
        |vertex: &u32| if is_free(vertex) { problem.motions[*vertex as usize] } else { Motion::Held };
    let motions: Vec<Motion> = vertices.iter().map(motion).collect();
    let problem = Problem::new(patch, motions, Order::Sparse).ok()?;
    (!faces.is_empty()).then_some(Patch { problem, vertices })
}

fn sorted(mut indices: Vec<u32>) -> Vec<u32> {
    indices.sort_unstable();
    indices.dedup();
    indices
}

fn descend(problem: &Problem, mut map: Map, weights: &Weights, watch: &Watch<'_>) -> (Map, f64) {
    let (mut damping, mut growth) = (DAMPING, 2.0);
    let mut linearised = Linearised::default();
    let begun = problem.energy.value(&map, weights);
    let mut value = begun;
    for _ in 0..STEPS {
        let face_damping = Damping { whole: damping, least: LEAST_DEVIATION };
        let Ok(newton) = linearised.direction(problem, &map, weights, face_damping, watch) else { break };
        let trial = problem.moved(&map, &newton.frames, &newton.direction);
        let lowered = problem.energy.value(&trial, weights);
        if lowered < value {
            let gain = (value - lowered) / value;
            let ratio = (value - lowered) / (-0.5 * newton.slope);
            damping *= (1.0 - (2.0 * ratio - 1.0).powi(3)).clamp(1.0 / 3.0, 2.0);
            (map, value, growth) = (trial, lowered, 2.0);
            if gain < LEAST_GAIN {
                break;
            }
        } else {
            damping *= growth;
            growth *= 2.0;
        }
    }
    (map, begun - value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_threshold_takes_the_largest_values() {
        let values = [0.3, 0.2, 0.1, 1e-3, 1e-4, 0.0];
        let above = |part: f64, most: usize| {
            let least = threshold(&values, part, most);
            values.iter().filter(|&&value| value > least).count()
        };
        assert_eq!(above(0.45, 6), 2);
        assert_eq!(above(0.6, 2), 2);
        assert_eq!(above(1.0, 6), 5);
    }
}
