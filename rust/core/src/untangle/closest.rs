// SPDX-License-Identifier: MIT OR Apache-2.0
//! The nearest map without folds: vertices return to their old places as far as no face folds.
//!
//! With x⁰ the places given, ρ the area of a face in units of its share and τ its lower bound, an interior-point method
//! lowers
//!
//! ```text
//! Σ |x − x⁰|² − μ Σ log(ρ − τ)
//! ```
//!
//! for μ that falls toward 0 (Nocedal & Wright, section 19.6). Vertices that end next to their old places return
//! exactly. Lengths are in units of a mean face.
//!
//! Cost: up to [`STEPS`] factorizations of the patch for each of about eight μ.

use super::newton::{FaceEnergy, Newton};
use super::patch::Patch;
use super::triangle::{Corners, Hessian, add_less_area_curvature, add_symmetric, doubled_area};
use crate::control::Watch;

/// Most Newton steps for each μ but the last.
const STEPS: usize = 6;

/// Most Newton steps for the last μ.
const LAST_STEPS: usize = 40;

/// Factor from one μ to the next.
const FALL: f64 = 0.1;

/// The last μ.
const LAST: f64 = 1e-6;

/// Decrement, relative to μ, below which a μ is done.
const NEAR: f64 = 0.1;

/// Decrement, relative to μ, below which the last μ is done.
const LAST_NEAR: f64 = 1e-6;

/// Distance to its old place below which a vertex returns to it.
const SNAP: f64 = 1e-3;

/// The squared distance from the old places with the barrier of one μ.
struct Barrier<'a> {
    patch: &'a Patch,
    /// The least area of each face, in units of its share.
    floors: &'a [f64],
    /// One over the number of faces at each vertex.
    per_face: &'a [f64],
    weight: f64,
}

/// The places nearest to the old ones, by a descent from `start`, where all faces are above their floors; and whether
/// the descent ran to its end.
pub(super) fn closest(
    newton: &mut Newton<'_>,
    patch: &Patch,
    floors: &[f64],
    start: Vec<[f64; 2]>,
    watch: &Watch<'_>,
) -> (Vec<[f64; 2]>, bool) {
    let per_face = patch.faces_per_vertex().iter().map(|&count| 1.0 / count).collect::<Vec<f64>>();
    let squares = (0..start.len()).map(|v| square_distance(start[v], patch.origin[v]));
    let weight = (squares.sum::<f64>() / patch.faces.len() as f64).max(1.0);
    let mut energy = Barrier { patch, floors, per_face: &per_face, weight };
    let mut places = start;
    // 1. Along the central path
    loop {
        let is_last = energy.weight <= LAST;
        for _ in 0..if is_last { LAST_STEPS } else { STEPS } {
            let value = newton.value(&energy, &places);
            match newton.step(&energy, &places, value, watch) {
                Err(_) => return (snapped(patch, floors, places), false),
                Ok(None) => break,
                Ok(Some(step)) => {
                    places = step.places;
                    if step.decrement < energy.weight * if is_last { LAST_NEAR } else { NEAR } {
                        break;
                    }
                }
            }
        }
        if is_last {
            break;
        }
        energy.weight = (FALL * energy.weight).max(LAST);
    }
    // 2. Exactly back to the old places where no face is in the way
    (snapped(patch, floors, places), true)
}

/// Puts vertices next to their old places back onto them, except those that would close a face.
fn snapped(patch: &Patch, floors: &[f64], places: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    let is_near = |v: usize| square_distance(places[v], patch.origin[v]) < SNAP * SNAP;
    let mut returns: Vec<bool> = (0..places.len()).map(|v| patch.is_free[v] && is_near(v)).collect();
    loop {
        let trial: Vec<[f64; 2]> =
            (0..places.len()).map(|v| if returns[v] { patch.origin[v] } else { places[v] }).collect();
        let mut is_good = true;
        for (face, corners) in patch.faces.iter().enumerate() {
            let is_touched = corners.iter().any(|&v| returns[v]);
            if is_touched && patch.ratio(&trial, face) < 0.99 * floors[face] {
                corners.iter().for_each(|&v| returns[v] = false);
                is_good = false;
            }
        }
        if is_good {
            return trial;
        }
    }
}

fn square_distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2)
}

impl FaceEnergy for Barrier<'_> {
    fn value(&self, face: usize, corners: Corners) -> f64 {
        let room = 0.5 * doubled_area(corners).0 / self.patch.shares[face] - self.floors[face];
        if room <= 0.0 {
            return f64::INFINITY;
        }
        let of_corner = |k: usize| {
            let vertex = self.patch.faces[face][k];
            self.per_face[vertex] * square_distance(corners[k], self.patch.origin[vertex])
        };
        (0..3).map(of_corner).sum::<f64>() - self.weight * room.ln()
    }

    fn derivatives(&self, face: usize, corners: Corners) -> ([f64; 6], Hessian) {
        let share = self.patch.shares[face];
        let (doubled, by_doubled) = doubled_area(corners);
        let room = 0.5 * doubled / share - self.floors[face];
        let by_room: [f64; 6] = by_doubled.map(|slope| 0.5 * slope / share);
        // 1. The barrier
        let mut gradient = by_room.map(|slope| -self.weight / room * slope);
        let mut hessian = [[0.0; 6]; 6];
        add_symmetric(&mut hessian, self.weight / (room * room), &by_room, &by_room);
        add_less_area_curvature(&mut hessian, 0.5 * self.weight / (room * share));
        // 2. The distance
        for k in 0..6 {
            let vertex = self.patch.faces[face][k / 2];
            let factor = 2.0 * self.per_face[vertex];
            gradient[k] += factor * (corners[k / 2][k % 2] - self.patch.origin[vertex][k % 2]);
            hessian[k][k] += factor;
        }
        (gradient, hessian)
    }
}
