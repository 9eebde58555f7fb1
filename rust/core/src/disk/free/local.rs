// SPDX-License-Identifier: MIT OR Apache-2.0
//! The energy lowered near the few faces that hold much of it, all other vertices held.
//!
//! Around the ends of slits a few faces are far from their rest shapes, and the steps of the whole map must be short for
//! their sake. A descent on these faces with some rings around them costs little, and lets the whole map take long steps:
//! nonlinear elimination, as in F.-N. Hwang, Y.-C. Su and X.-C. Cai, A parallel adaptive nonlinear elimination
//! preconditioned inexact Newton method for transonic full potential equation, Computers & Fluids 110 (2015).
//!
//! Cost: some ten factorizations of two unknowns for each vertex that moves.

use super::descent::{Descent, Goal, Problem};
use super::energy::Energy;
use crate::codomain::planar::PlanarMap;
use crate::control::{History, Observer};
use crate::mesh::{Face, TriangleMesh, Vertex};
use crate::sparse::{Analysis, Order};

/// Faces have a high energy where it is this many times the mean per area.
const HIGH: f64 = 8.0;

/// They must hold this part of the energy.
const LEAST_SHARE: f64 = 0.2;

/// They must be no more than this part of all faces.
const MOST_FACES: f64 = 0.1;

/// The numbers of rings around them whose faces may change: the first that make a manifold.
const RINGS: [usize; 4] = [4, 5, 6, 7];

/// The most iterations.
const ITERATIONS: usize = 15;

/// The decrement in units of the energy that ends them.
const PRECISION: f64 = 1e-2;

/// The map after a descent of the faces of high energy; `None` where there are none, too many, or no rings around them
/// that make a manifold.
pub(super) fn lowered_locally(
    energy: &Energy<'_>,
    map: &[[f64; 2]],
    goal: &Goal,
    observer: &mut dyn Observer,
) -> Option<PlanarMap> {
    // 1. The faces of high energy with some rings around them
    let mut is_chosen = high(energy, map, goal.weight)?;
    let mut n_rings = 0;
    let part = RINGS.into_iter().find_map(|rings| {
        (n_rings..rings).for_each(|_| is_chosen = grown(energy.mesh, &is_chosen));
        n_rings = rings;
        Part::new(energy, &is_chosen)
    })?;
    // 2. A descent of these faces
    part.lowered(map, goal, observer)
}

/// A part of a surface whose rim is held.
struct Part {
    mesh: TriangleMesh,
    /// The vertex of the surface that each vertex is.
    vertex_of: Vec<Vertex>,
    targets: Vec<f64>,
    is_held: Vec<bool>,
}

impl Part {
    /// The chosen faces; `None` where they are no manifold.
    fn new(energy: &Energy<'_>, is_chosen: &[bool]) -> Option<Self> {
        let mesh = energy.mesh;
        let chosen: Vec<Face> = Face::all(mesh.n_faces()).filter(|&face| is_chosen[face]).collect();
        let mut vertex_of: Vec<Vertex> = chosen.iter().flat_map(|&face| mesh.faces()[face]).collect();
        vertex_of.sort_unstable();
        vertex_of.dedup();
        let number = |vertex: Vertex| Vertex::new(vertex_of.partition_point(|&before| before < vertex));
        let faces = chosen.iter().map(|&face| mesh.faces()[face].map(number)).collect();
        let points = vertex_of.iter().map(|&vertex| mesh.points()[vertex]).collect();
        let is_held = |&vertex: &Vertex| mesh.vertex_corners(vertex).iter().any(|c| !is_chosen[c.face()]);
        Some(Self {
            mesh: TriangleMesh::at_given_points(points, faces).ok()?,
            targets: chosen.iter().map(|&face| energy.targets[face]).collect(),
            is_held: vertex_of.iter().map(is_held).collect(),
            vertex_of,
        })
    }

    /// The map after a descent of the part.
    fn lowered(&self, map: &[[f64; 2]], goal: &Goal, observer: &mut dyn Observer) -> Option<PlanarMap> {
        let n = self.mesh.n_vertices();
        let energy = Energy::new(&self.mesh, &self.targets);
        let analysis = Analysis::new(n, self.mesh.faces(), &vec![2; n], Order::Sparse).ok()?;
        let is_held = Some(&self.is_held[..]);
        let mut descent = Descent::new(Problem {
            energy: &energy,
            analysis: &analysis,
            outline: None,
            is_held,
            lower_locally: None,
        });
        // the energy of the part takes its targets to add up to one
        let scale = self.targets.iter().sum::<f64>().sqrt().recip();
        let start = self.vertex_of.iter().map(|&vertex| map[vertex].map(|x| scale * x)).collect();
        let goal = Goal { most_iterations: ITERATIONS, precision: PRECISION, ..*goal };
        let (lowered, _) = descent.run(start, &goal, &mut History::start(), observer);
        let mut map = map.to_vec();
        for (k, &vertex) in self.vertex_of.iter().enumerate().filter(|&(k, _)| !self.is_held[k]) {
            map[vertex] = lowered[k].map(|x| x / scale);
        }
        Some(map)
    }
}

/// The faces of high energy, where they are few and hold much of it.
fn high(energy: &Energy<'_>, map: &[[f64; 2]], weight: f64) -> Option<Vec<bool>> {
    let of_faces = energy.of_faces(map, weight);
    let total: f64 = of_faces.iter().sum();
    let is_high: Vec<bool> = of_faces
        .iter()
        .zip(&energy.targets)
        .map(|(energy, target)| *energy > HIGH * total * target)
        .collect();
    let high = of_faces.iter().zip(&is_high).filter(|(_, is_high)| **is_high).map(|(energy, _)| *energy);
    let (n_high, held) = high.fold((0.0, 0.0), |(count, sum), energy| (count + 1.0, sum + energy));
    (held > LEAST_SHARE * total && n_high < MOST_FACES * is_high.len() as f64).then_some(is_high)
}

/// The chosen faces with all that share a vertex with them.
fn grown(mesh: &TriangleMesh, is_chosen: &[bool]) -> Vec<bool> {
    let mut grown = is_chosen.to_vec();
    for face in Face::all(mesh.n_faces()).filter(|&face| is_chosen[face]) {
        for corner in mesh.faces()[face].into_iter().flat_map(|vertex| mesh.vertex_corners(vertex)) {
            grown[corner.face()] = true;
        }
    }
    grown
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::Silent;

    /// A flat grid of `n` by `n` squares, of area one, with its map to itself.
    fn grid(n: u32) -> (TriangleMesh, PlanarMap) {
        let side = n + 1;
        let at = |k: u32| [k % side, k / side].map(|x| f64::from(x) / f64::from(n) - 0.5);
        let map: PlanarMap = (0..side * side).map(at).collect();
        let points: Vec<[f64; 3]> = map.iter().map(|&[x, y]| [x, y, 0.0]).collect();
        let squares = (0..n * n).map(|k| k % n + side * (k / n));
        let faces: Vec<[u32; 3]> =
            squares.flat_map(|a| [[a, a + 1, a + side + 1], [a, a + side + 1, a + side]]).collect();
        (TriangleMesh::new(&points, &faces).unwrap(), map)
    }

    #[test]
    fn a_place_of_high_energy_is_lowered_and_the_rest_stays() {
        let (mesh, mut map) = grid(40);
        let energy = Energy::new(&mesh, mesh.face_areas());
        let moved = 20 * 41 + 20;
        map[moved][0] += 0.9 / 40.0;
        let goal = Goal { weight: 0.1, range: 0.25, most_iterations: usize::MAX, precision: 1e-9 };
        let lowered = lowered_locally(&energy, &map, &goal, &mut Silent).unwrap();
        let [before, after] = [&map, &lowered].map(|map| energy.value(map, goal.weight));
        assert!(after < 1e-3 * before, "{before} {after}");
        let far = |k: usize| (k / 41).abs_diff(20).max((k % 41).abs_diff(20)) > 8;
        assert!((0..map.len()).filter(|&k| far(k)).all(|k| map[k] == lowered[k]));
    }

    #[test]
    fn energy_that_is_spread_evenly_is_left_alone() {
        let (mesh, map) = grid(10);
        let energy = Energy::new(&mesh, mesh.face_areas());
        let sheared: PlanarMap = map.iter().map(|&[x, y]| [x + 0.5 * y, y]).collect();
        let goal = Goal { weight: 0.1, range: 0.25, most_iterations: usize::MAX, precision: 1e-9 };
        assert_eq!(lowered_locally(&energy, &sheared, &goal, &mut Silent), None);
    }
}
