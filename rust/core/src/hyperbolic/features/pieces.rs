// SPDX-License-Identifier: MIT OR Apache-2.0
//! Cuts both surfaces along closed curves into pieces with their features: slits along open curves, and loops.
//!
//! A closed curve is a loop of the pieces on both of its sides, with the same parameters on both, so that
//! maps of the pieces agree along it. A loop gets a start and an end, whose places on source and target lie as
//! near to each other as vertices can. Parameters are shares of the length in space between them.
//!
//! Input: divided and placed surfaces. Cost: linear.

use super::curves::{CurvePair, Gap};
use super::parameters::{nearest, shares};
use super::piece::{Bank, Feature, Piece};
use super::placement::Placement;
use super::regions::{Divided, Regions};
use crate::mesh::{Face, TriangleMesh, Vertex};
use crate::vector::Vector3;

/// Cuts both surfaces into pieces; returns each piece of the source with its partner on the target. Features are in
/// the same order on both: curves as given, then other boundary loops.
pub(crate) fn pieces(
    source: &TriangleMesh,
    target: &TriangleMesh,
    divided: &Divided,
    placement: &Placement,
) -> Vec<(Piece, Piece)> {
    // 1. Curves and other loops with their features on either surface
    let pairs: Vec<&CurvePair> = divided.pairs.iter().chain(&placement.loops).collect();
    let features = pairs.iter().zip(&placement.shifts).enumerate().map(|(number, (pair, &shift))| {
        let features = if pair.closed {
            loop_features(pair, [source.points(), target.points()], shift)
        } else {
            [slit(&pair.source, source.points()), slit(&pair.target, target.points())]
        };
        let curve = (number < divided.pairs.len()).then_some(number);
        features.map(|feature| Feature { curve, ..feature })
    });
    let (ours, theirs): (Vec<Feature>, Vec<Feature>) = features.map(|[ours, theirs]| (ours, theirs)).unzip();
    // 2. The pieces, each with the features at it
    let ours = Surface { mesh: source, regions: &divided.source, sphere: &placement.source, features: &ours };
    let theirs =
        Surface { mesh: target, regions: &divided.target, sphere: &placement.target, features: &theirs };
    (0..divided.source.count)
        .map(|region| {
            let partner = divided.partner[region];
            (ours.piece(region), theirs.piece(partner))
        })
        .collect()
}

/// A surface with its regions and features; the features are seen from the left of closed curves.
struct Surface<'a> {
    mesh: &'a TriangleMesh,
    regions: &'a Regions,
    sphere: &'a [Vector3],
    features: &'a [Feature],
}

impl Surface<'_> {
    fn piece(&self, region: usize) -> Piece {
        let all = Face::all(self.mesh.n_faces());
        let face_of: Vec<Face> = all.filter(|&face| self.regions.of_face[face] == region).collect();
        let (faces, vertex_of) = renumbered(self.mesh, &face_of);
        let number = |vertex: Vertex| Vertex::new(vertex_of.partition_point(|&given| given < vertex));
        let features = (0..self.features.len()).filter_map(|curve| self.seen_from(region, curve));
        let features = features.map(|feature| feature.with_vertices(number)).collect();
        let of_vertices = |values: &[Vector3]| vertex_of.iter().map(|&v| values[v]).collect();
        Piece {
            points: of_vertices(self.mesh.points()),
            on_sphere: of_vertices(self.sphere),
            faces,
            vertex_of,
            face_of,
            features,
        }
    }

    /// A feature as seen from a region; `None` if it does not border the region.
    fn seen_from(&self, region: usize, curve: usize) -> Option<Feature> {
        let feature = &self.features[curve];
        let first_loop = self.regions.sides.len();
        let [left, right] = match curve.checked_sub(first_loop) {
            None => self.regions.sides[curve],
            Some(_) => self.loop_sides(feature),
        };
        match (left == region, right == region) {
            (true, _) => Some(feature.clone()),
            (false, true) => {
                Some(Feature { left: feature.right.clone(), right: feature.left.clone(), ..*feature })
            }
            (false, false) => None,
        }
    }

    /// The region on the left of a boundary loop, twice.
    fn loop_sides(&self, feature: &Feature) -> [usize; 2] {
        let corner = self.mesh.vertex_corners(feature.start())[0];
        [self.regions.of_face[corner.face()]; 2]
    }
}

/// The faces with their vertices renumbered in ascending order, and these vertices.
fn renumbered(mesh: &TriangleMesh, face_of: &[Face]) -> (Vec<[Vertex; 3]>, Vec<Vertex>) {
    const UNUSED: Vertex = Vertex(u32::MAX);
    let mut number = vec![UNUSED; mesh.n_vertices()];
    let given = face_of.iter().map(|&face| mesh.faces()[face]);
    given.clone().flatten().for_each(|vertex| number[vertex] = Vertex::default());
    let vertex_of: Vec<Vertex> = Vertex::all(mesh.n_vertices()).filter(|&v| number[v] != UNUSED).collect();
    vertex_of.iter().zip(Vertex::all(vertex_of.len())).for_each(|(&vertex, new)| number[vertex] = new);
    (given.map(|face| face.map(|vertex| number[vertex])).collect(), vertex_of)
}

/// An open curve cut open.
fn slit(vertices: &[Vertex], points: &[Vector3]) -> Feature {
    let bank = Bank {
        vertices: vertices.to_vec(),
        parameters: shares(vertices.iter().map(|&vertex| points[vertex])),
    };
    Feature { left: bank.clone(), right: bank, is_loop: false, curve: None }
}

/// A pair of closed curves as loops around the regions on their left.
fn loop_features(pair: &CurvePair, points: [&[Vector3]; 2], shift: f64) -> [Feature; 2] {
    // 1. Both from their starts
    let [ours, theirs] = [Around::new(&pair.source, points[0]), Around::new(&pair.target, points[1])];
    let (ours, theirs) = match pair.gap {
        None => {
            let start = theirs.vertex_at(shift);
            (ours, theirs.rotated(start, points[1]))
        }
        // no vertex of the source may come to lie inside the target's gap, so both curves start at its end
        Some(_) => {
            let start = ours.vertex_at((1.0 - shift).fract());
            (ours.rotated(start, points[0]), theirs)
        }
    };
    // 2. The ends halfway
    let middle = ours.middle(pair.gap, 0.5);
    let their_middle = theirs.middle(pair.gap, ours.parameters[middle]);
    // 3. The banks, with the gap from edge to edge
    let mut features = [ours.feature(middle), theirs.feature(their_middle)];
    if let Some(gap) = pair.gap {
        share_gap(&mut features, gap);
    }
    features
}

/// A closed curve from a start vertex around and back to it.
struct Around {
    /// The first vertex again at the end.
    vertices: Vec<Vertex>,
    /// Shares of the length.
    parameters: Vec<f64>,
}

impl Around {
    fn new(closed: &[Vertex], points: &[Vector3]) -> Self {
        let vertices: Vec<Vertex> = closed.iter().chain(&closed[..1]).copied().collect();
        let parameters = shares(vertices.iter().map(|&vertex| points[vertex]));
        Self { vertices, parameters }
    }

    fn n_edges(&self) -> usize {
        self.vertices.len() - 1
    }

    /// The vertex nearest to a parameter.
    fn vertex_at(&self, s: f64) -> usize {
        nearest(&self.parameters, [0, self.n_edges()], s) % self.n_edges()
    }

    /// The curve from another vertex around.
    fn rotated(&self, start: usize, points: &[Vector3]) -> Self {
        let n = self.n_edges();
        Self::new(&[&self.vertices[start..n], &self.vertices[..start]].concat(), points)
    }

    /// The vertex nearest to a parameter that leaves an edge on either side, two on the side of a gap.
    fn middle(&self, gap: Option<Gap>, s: f64) -> usize {
        let n = self.n_edges();
        let within = match gap {
            None => [1, n - 1],
            Some(Gap::AtStart) => [2, n - 1],
            Some(Gap::AtEnd) => [1, n - 2],
        };
        nearest(&self.parameters, within, s)
    }

    /// The curve with an end at vertex `middle`.
    fn feature(&self, middle: usize) -> Feature {
        let bank = |vertices: &[Vertex], parameters: &[f64]| {
            let (first, last) = (parameters[0], parameters[parameters.len() - 1]);
            let inner = parameters.iter().map(|s| ((s - first) / (last - first)).clamp(0.0, 1.0));
            Bank { vertices: vertices.to_vec(), parameters: inner.collect() }
        };
        Feature {
            left: bank(&self.vertices[..=middle], &self.parameters[..=middle]),
            right: bank(&self.vertices[middle..], &self.parameters[middle..]).reversed(),
            is_loop: true,
            curve: None,
        }
    }
}

/// Gives the edge next to the start on the bank with the gap the same share of the bank on both surfaces.
fn share_gap(features: &mut [Feature; 2], gap: Gap) {
    let [ours, theirs] = features.each_mut().map(|feature| match gap {
        Gap::AtStart => &mut feature.left.parameters,
        Gap::AtEnd => &mut feature.right.parameters,
    });
    let share = 0.5 * (ours[1] + theirs[1]);
    for parameters in [ours, theirs] {
        let given = parameters[1];
        let rest = |s: f64| share + (s - given) / (1.0 - given) * (1.0 - share);
        let last = parameters.len() - 1;
        parameters[1..last].iter_mut().for_each(|s| *s = rest(*s));
    }
}

impl Feature {
    /// The feature with its vertices renumbered.
    fn with_vertices(mut self, number: impl Fn(Vertex) -> Vertex) -> Self {
        let banks = [&mut self.left, &mut self.right];
        banks.into_iter().flat_map(|bank| &mut bank.vertices).for_each(|vertex| *vertex = number(*vertex));
        self
    }
}

#[cfg(test)]
mod tests;
