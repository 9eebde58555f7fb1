// SPDX-License-Identifier: MIT OR Apache-2.0
//! Places are rounded to a grid on each face of the target, by which most noise in the input is forgotten.
//!
//! What is nearly the same at first grows apart from step to step, and once two candidates of a search change places, two
//! descents end in different minima. A grid whose cells are small beside faces and large beside noise gives both the same
//! places again, but for the few that lie midway between two points of the grid.
//!
//! Cost: the energy of a star for each vertex, more where faces are thin.

use super::newton::Moving;
use super::sweep::Colors;
use super::target::Placed;
use crate::location::Location;
use crate::mesh::ties::nearest_power_of_two;
use crate::mesh::{Face, Vertex};
use crate::parallel;

/// Cells along an edge of a target that is as fine as the source; a coarser one has more.
const CELLS: f64 = 256.0;

/// Coordinates up to this are 0: the place lies on an edge up to rounding.
const ON_EDGE: f64 = 1e-9;

/// Factors of the number of cells that are tried in turn: where faces are thin, only a finer grid keeps them.
const FINER: [f64; 3] = [1.0, 8.0, 64.0];

/// Factor by which the energy around a vertex may rise.
const MOST_RISE: f64 = 1.1;

impl Moving<'_, '_> {
    /// Rounds the places of all vertices that may move, those of one color side by side.
    pub(super) fn round(&mut self, colors: &Colors) {
        let energy = self.energy;
        let n_faces = [energy.source.n_faces(), energy.target.mesh().n_faces()];
        let density = (n_faces[0] as f64 / n_faces[1] as f64).sqrt();
        let cells = CELLS * nearest_power_of_two(density.max(1.0));
        let before = energy.face_values(&self.map);
        for group in colors.groups() {
            let rounded = parallel::map(group.len(), |k| self.rounded(group[k], cells, &before));
            for (&vertex, rounded) in group.iter().zip(rounded) {
                self.map[vertex] = rounded;
            }
        }
    }

    /// The rounded place of a vertex; its own where the energy would rise even on the finest grid.
    fn rounded(&self, vertex: Vertex, cells: f64, before: &[f64]) -> Placed {
        let (energy, here) = (self.energy, &self.map[vertex]);
        let of_face = |face: Face| energy.areas[face] * before[face];
        let around: f64 =
            energy.source.vertex_corners(vertex).iter().map(|corner| of_face(corner.face())).sum();
        let limit = MOST_RISE * (around + energy.vertex_value(vertex, here));
        for finer in FINER {
            let location = rounded(here.location, finer * cells);
            if location == here.location {
                break;
            }
            let there = energy.target.placed(location);
            if energy.star_value(&self.map, vertex, &there, limit) < limit {
                return there;
            }
        }
        *here
    }
}

/// The place with its coordinates rounded to whole numbers of cells; those that are more than 0 stay so.
fn rounded(location: Location, cells: f64) -> Location {
    let mut whole =
        location.barycentric.map(|x| if x > ON_EDGE { (cells * x).round().max(1.0) } else { 0.0 });
    let sum: f64 = whole.iter().sum();
    let largest = (0..3).fold(0, |best, k| if whole[k] > whole[best] { k } else { best });
    whole[largest] += cells - sum;
    Location { barycentric: whole.map(|n| n / cells), ..location }
}

#[cfg(test)]
mod tests {
    use super::super::energy::{Guard, SurfaceEnergy};
    use super::super::newton::Motion;
    use super::super::sample_maps::Sample;
    use super::*;

    const GUARD: Guard = Guard { weight: 0.1, slack: 3.0 };

    #[test]
    fn noise_is_gone_after_it() {
        for sample in [Sample::spheres(), Sample::disks()] {
            let problem = sample.problem();
            let energy = SurfaceEnergy::new(&problem, GUARD);
            let motions = vec![Motion::Free; sample.start.len()];
            let colors = Colors::new(&sample.source, &motions);
            let rounded = |noise: f64| {
                let places = sample.start_with_noise(noise);
                let map: Vec<Placed> = places.into_iter().map(|place| energy.target.placed(place)).collect();
                let before = energy.value(&map);
                let mut moving = Moving::new(&energy, &motions, map);
                moving.round(&colors);
                assert!(energy.value(&moving.map) < MOST_RISE * before);
                moving.map
            };
            assert!(rounded(1e-9) == rounded(0.0));
        }
    }

    #[test]
    fn a_place_on_an_edge_up_to_rounding_comes_to_lie_on_it() {
        let place = |x: f64| Location { triangle: Face(3), barycentric: [x, 0.3, 0.7 - x] };
        assert_eq!(rounded(place(1e-13), 256.0), rounded(place(0.0), 256.0));
        assert_eq!(rounded(place(1e-13), 256.0).barycentric[0], 0.0);
    }

    #[test]
    fn vertices_that_are_held_stay() {
        let sample = Sample::spheres();
        let problem = sample.problem();
        let energy = SurfaceEnergy::new(&problem, GUARD);
        let mut motions = vec![Motion::Free; sample.start.len()];
        motions[5] = Motion::Held;
        let map = sample.placed_on(&energy.target);
        let mut moving = Moving::new(&energy, &motions, map.clone());
        moving.round(&Colors::new(&sample.source, &motions));
        assert_eq!(moving.map[5], map[5]);
        assert!(Vertex::all(map.len()).any(|vertex| moving.map[vertex] != map[vertex]));
    }

    #[test]
    fn coordinates_are_whole_numbers_of_cells_with_sum_1_and_zeros_stay() {
        let places =
            [[0.2, 0.3, 0.5], [1e-6, 0.4, 0.6 - 1e-6], [0.0, 0.25, 0.75], [0.0, 1.0, 0.0], [1.0 / 3.0; 3]];
        for barycentric in places {
            let place = Location { triangle: Face(7), barycentric };
            let Location { triangle, barycentric: after } = rounded(place, 64.0);
            assert_eq!(triangle, Face(7));
            assert_eq!(after.iter().sum::<f64>(), 1.0);
            for (before, after) in barycentric.into_iter().zip(after) {
                assert_eq!((after * 64.0).fract(), 0.0);
                assert_eq!(before == 0.0, after == 0.0);
                assert!((before - after).abs() <= 1.5 / 64.0, "{before} {after}");
            }
        }
    }
}
