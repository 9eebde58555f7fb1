// SPDX-License-Identifier: MIT OR Apache-2.0
//! The certificates that a map of sliced surfaces is a homeomorphism with the curves in place.
//!
//! If every face is positively oriented, the signed areas of the images sum to that of the surface, and both
//! banks of a slit run through the same points in order, then the map is one-to-one and onto.

use std::f64::consts::PI;

use super::chart_map::ChartMap;
use super::delaunay::Net;
use crate::hyperbolic::moebius::{Complex, Moebius, orientation, seen_from};
use crate::parallel;

/// Figures that certify a registration by curves.
#[derive(Debug, Clone, PartialEq)]
pub struct Certificates {
    /// Faces of the source whose image is not positively oriented; none in a homeomorphism.
    pub folded: Vec<usize>,
    /// The sum of the images' signed areas in the target's metric.
    pub area: f64,
    /// The value that `area` must have: 2π(B − 2) for B features; the area of the layout for a flat piece.
    pub expected_area: f64,
    /// The largest distance of a curve's image from its partner, in parts of the target's size.
    pub curve_error: f64,
    /// The largest distance of the images of the two banks of a slit, in parts of the target's size.
    pub bank_error: f64,
    /// The largest deviation from the identity of the three transitions around a face.
    pub cocycle_error: f64,
    /// Vertices that rounding has put beyond the boundary.
    pub outside: usize,
    /// The harmonic energy over that of the identity of the source: 1 for an isometry, above 2 for a strained map;
    /// NaN if no piece has a hyperbolic metric.
    pub energy_ratio: f64,
    /// The largest curvature left in the metrics of source and target.
    pub curvature: [f64; 2],
}

/// The certificates of a piece, without those of the curves.
#[derive(Debug, Clone, Default)]
pub(crate) struct PieceCertificates {
    /// The folded faces of the sliced source.
    pub folded: Vec<usize>,
    pub area: f64,
    pub expected_area: f64,
    pub cocycle_error: f64,
    pub outside: usize,
    pub energy: f64,
    /// The energy of the identity.
    pub rest_energy: f64,
}

/// Certifies a map between hyperbolic surfaces of Euler characteristic `chi`.
pub(crate) fn certify(map: &ChartMap<'_>, chi: i64) -> PieceCertificates {
    let net = &map.input;
    let images = parallel::map(net.faces.len(), |face| image(map, net, face));
    let outside = |vertex: usize| map.atlas.walk(map.places.faces[vertex], map.places.positions[vertex]);
    let is_outside = |vertex: &usize| map.places.held[*vertex].is_none() && outside(*vertex).is_outside;
    PieceCertificates {
        folded: folded_faces(map),
        area: parallel::sum(images.len(), |face| signed_area(images[face])),
        expected_area: -2.0 * PI * chi as f64,
        cocycle_error: (0..images.len()).fold(0.0, |most: f64, face| most.max(cocycle(net, face))),
        outside: (0..map.places.faces.len()).filter(is_outside).count(),
        energy: map.energy(),
        rest_energy: map.rest_energy,
    }
}

/// The faces of the sliced source whose images are not positively oriented, ascending.
pub(crate) fn folded_faces(map: &ChartMap<'_>) -> Vec<usize> {
    let is_folded = parallel::map(map.input.faces.len(), |face| {
        let [a, b, c] = image(map, &map.input, face);
        orientation(a, b, c) <= 0.0
    });
    (0..is_folded.len()).filter(|&face| is_folded[face]).collect()
}

/// The image of a face in the chart of its first vertex.
pub(crate) fn image(map: &ChartMap<'_>, net: &Net, face: usize) -> [Complex; 3] {
    let x = net.faces[face].map(|vertex| map.places.positions[vertex]);
    let [_, to_last, to_second] = [0, 1, 2].map(|k| net.transitions[3 * face + k]);
    // the edge opposite to corner 2 runs from vertex 0 to 1, that opposite to corner 1 from vertex 2 to 0
    [x[0], to_second.apply(x[1]), to_last.inverse().apply(x[2])]
}

/// The area of a geodesic triangle, negative if it is clockwise.
pub(crate) fn signed_area([a, b, c]: [Complex; 3]) -> f64 {
    let (p, q) = (seen_from(a, b), seen_from(a, c));
    let product = p.conj() * q;
    2.0 * product.im.atan2(1.0 - product.re)
}

/// The deviation from the identity of the transitions around a face.
fn cocycle(net: &Net, face: usize) -> f64 {
    let [from_second, from_third, from_first] = [0, 1, 2].map(|k| net.transitions[3 * face + k]);
    // 1 ← 2, 2 ← 0 and 0 ← 1
    let Moebius { a, b } = from_first * from_second * from_third;
    (a.re.abs() - 1.0).abs().max(a.im.abs()).max(b.norm())
}
