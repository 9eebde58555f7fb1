// SPDX-License-Identifier: MIT OR Apache-2.0
//! A surface to be mapped onto a rectangle: its sides and how its vertices move.

use crate::codomain::SpatialMap;
use crate::codomain::motion::Motion;
use crate::codomain::planar::PlanarMap;
use crate::disk::certificate;
use crate::disk::run::Run;
use crate::mesh::Vertex;
use crate::vector::Vector3;

/// A surface with its corners.
pub(super) struct Rectangle<'a> {
    pub run: Run<'a>,
    /// The boundary vertices of the bottom, right, top and left side, each without its last corner.
    pub sides: [Vec<Vertex>; 4],
    /// The given aspect.
    pub aspect: Option<f64>,
}

impl Rectangle<'_> {
    /// The motions that the vertices are allowed.
    pub(super) fn motions(&self) -> Vec<Motion> {
        let mut motions = vec![Motion::Plane; self.run.mesh.n_vertices()];
        for (k, side) in self.sides.iter().enumerate() {
            side.iter().for_each(|&vertex| motions[vertex] = Motion::Side(k % 2));
            motions[side[0]] = Motion::Held;
        }
        motions
    }

    /// The map with its lower left corner in (0, 0) and a longer side of 1, and the factor.
    pub(super) fn laid_out(&self, map: &SpatialMap) -> (PlanarMap, f64) {
        let [low, high] = [self.sides[0][0], self.sides[2][0]].map(|corner| map[corner]);
        let sides = [high[0] - low[0], high[1] - low[1]];
        let longer = sides[0].max(sides[1]);
        // the top and right sides exactly straight, the longer one exactly 1
        let place = |x: &Vector3, k: usize| if x[k] == high[k] { sides[k] } else { x[k] - low[k] } / longer;
        let moved: PlanarMap = map.iter().map(|x| [place(x, 0), place(x, 1)]).collect();
        if certificate::folded(self.run.mesh, &moved).is_empty() {
            return (moved, 1.0 / longer);
        }
        // rounding the shift has folded a tiny face; scaling by a power of two rounds nothing
        let scale = (1.0 / longer).log2().floor().exp2();
        (map.iter().map(|&Vector3([x, y, _])| [x * scale, y * scale]).collect(), scale)
    }
}
