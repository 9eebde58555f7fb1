// SPDX-License-Identifier: MIT OR Apache-2.0
//! Places are rounded to a grid on each face of the target, by which noise in the input is forgotten.
//!
//! What is nearly the same at first grows apart from step to step, and once two candidates of a search change places, two
//! descents end in different minima. A grid whose cells are small beside faces and large beside noise gives both the same
//! places again: all that is left of the noise is that of the target itself.
//!
//! Cost: two energies of a star for each vertex.

use super::newton::{Motion, Moving};
use crate::location::Location;
use crate::mesh::Vertex;

/// Cells along an edge of the target, where it has as many faces as the source; more where it has fewer.
const CELLS: f64 = 256.0;

/// Factor by which the energy around a vertex may rise; else it stays.
const MOST_RISE: f64 = 1.1;

impl Moving<'_, '_> {
    /// Rounds the places of all vertices that may move, one after the other.
    pub(super) fn round(&mut self) {
        let energy = self.energy;
        let n_faces = [energy.source.n_faces(), energy.target.mesh().n_faces()];
        let cells = CELLS * (n_faces[0] as f64 / n_faces[1] as f64).sqrt().ceil();
        for vertex in Vertex::all(self.map.len()) {
            if self.motions[vertex] == Motion::Held {
                continue;
            }
            let here = &self.map[vertex];
            let rounded = energy.target.placed(rounded(here.location, cells));
            let limit = MOST_RISE * energy.star_value(&self.map, vertex, here, f64::INFINITY);
            if energy.star_value(&self.map, vertex, &rounded, limit) < limit {
                self.map[vertex] = rounded;
            }
        }
    }
}

/// The place with its coordinates rounded to whole numbers of cells; those that are not 0 stay so.
fn rounded(location: Location, cells: f64) -> Location {
    let mut whole = location.barycentric.map(|x| if x > 0.0 { (cells * x).round().max(1.0) } else { 0.0 });
    let sum: f64 = whole.iter().sum();
    let largest = (0..3).fold(0, |best, k| if whole[k] > whole[best] { k } else { best });
    whole[largest] += cells - sum;
    Location { barycentric: whole.map(|n| n / cells), ..location }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Face;

    #[test]
    fn coordinates_are_whole_numbers_of_cells_with_sum_1_and_zeros_stay() {
        let places = [[0.2, 0.3, 0.5], [1e-9, 0.4, 0.6 - 1e-9], [0.0, 0.25, 0.75], [0.0, 1.0, 0.0], [1.0 / 3.0; 3]];
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
