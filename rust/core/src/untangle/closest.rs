// SPDX-License-Identifier: MIT OR Apache-2.0
//! The nearest map without folds: vertices return to their old places as far as open faces let them.
//!
//! With x⁰ the places given, ρ the area of a face in units of its share and τ the least that it may have, an interior-point
//! method lowers
//!
//! ```text
//! Σ |x − x⁰|² − μ Σ log(ρ − τ)
//! ```
//!
//! for μ that falls towards 0 (Nocedal & Wright, section 19.6). Vertices that end next to their old place are put back
//! exactly. Lengths are in units of a mean face.
//!
//! Cost: up to [`STEPS`] factorizations of the patch for each of about eight μ.

use super::newton::{FaceEnergy, Newton};
use super::patch::Patch;
use super::triangle::{Corners, Hessian, add_less_area_curvature, add_symmetric, doubled_area};
use crate::control::Watch;

/// Newton steps for each μ at the most, and for the last.
const STEPS: usize = 6;
const LAST_STEPS: usize = 40;

/// What μ falls by.
const FALL: f64 = 0.1;

/// The last μ.
const LAST: f64 = 1e-6;

/// A μ is done when a step promises less than this times μ.
const NEAR: f64 = 0.1;

/// The last μ is done when a step promises less than this times μ.
const LAST_NEAR: f64 = 1e-6;

/// A vertex this near to its old place returns to it.
const SNAP: f64 = 1e-3;

/// The distance from the old places, behind the barrier of one μ.
struct Barrier<'a> {
    patch: &'a Patch,
    /// What each face must keep, in units of its share.
    floors: &'a [f64],
    /// One over the faces at each vertex.
    per_face: &'a [f64],
    weight: f64,
}

/// The places nearest to the old ones from `start`, where all faces are above their floors; and whether the descent was
/// not cut short.
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
    // 2. Exactly back where nothing is in the way
    (snapped(patch, floors, places), true)
}

/// Puts vertices next to their old place back into it, but for those that would close a face.
fn snapped(patch: &Patch, floors: &[f64], places: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    let is_near = |v: usize| square_distance(places[v], patch.origin[v]) < SNAP * SNAP;
    let mut returns: Vec<bool> = (0..places.len()).map(|v| patch.is_free[v] && is_near(v)).collect();
    loop {
        let trial: Vec<[f64; 2]> =
            (0..places.len()).map(|v| if returns[v] { patch.origin[v] } else { places[v] }).collect();
        let mut is_good = true;
        for (face, corners) in patch.faces.iter().enumerate() {
            let is_touched = corners.iter().any(|&v| returns[v as usize]);
            if is_touched && patch.ratio(&trial, face) < 0.99 * floors[face] {
                corners.iter().for_each(|&v| returns[v as usize] = false);
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
            let vertex = self.patch.faces[face][k] as usize;
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
            let vertex = self.patch.faces[face][k / 2] as usize;
            let factor = 2.0 * self.per_face[vertex];
            gradient[k] += factor * (corners[k / 2][k % 2] - self.patch.origin[vertex][k % 2]);
            hessian[k][k] += factor;
        }
        (gradient, hessian)
    }
}
