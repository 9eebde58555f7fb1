// SPDX-License-Identifier: MIT OR Apache-2.0
//! The order and direction in which features are joined by arcs.
//!
//! Every feature but the last is joined from its end to the start of the next, so that all features and arcs
//! together are one simple path and cutting along it leaves a disk. The order affects only the lengths of the
//! arcs: each of the 2 B first features with a direction starts a chain that goes on to the nearest remaining
//! tip, on both spheres together; the shortest of these chains is taken.
//!
//! Cost: O(B³) for B features.

use std::f64::consts::FRAC_PI_2;

use crate::hyperbolic::features::piece::{Feature, Piece};
use crate::mesh::Vertex;
use crate::mesh::ties::first_smallest;
use crate::vector::Vector3;

/// A link from the end of a feature to the start of the next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Link {
    /// The landmark curve from which it comes; `None` for a boundary loop that is no landmark curve.
    pub curve: Option<usize>,
    /// The end of that feature.
    pub from: Vertex,
    /// The start of the next feature.
    pub to: Vertex,
}

/// The features in order, each with whether it is reversed; one order for both pieces.
pub(super) fn order(source: &Piece, target: &Piece) -> Vec<(usize, bool)> {
    let tips: Vec<Tips> = source
        .features
        .iter()
        .zip(&target.features)
        .map(|(s, t)| [tips(source, s), tips(target, t)])
        .collect();
    let starts = (0..2 * tips.len()).map(|start| (start / 2, start % 2 == 1));
    let mut chains: Vec<_> = starts.map(|start| nearest_neighbors(&tips, start)).collect();
    let shortest = first_smallest(chains.iter().map(|(_, length)| *length));
    shortest.map_or(Vec::new(), |shortest| chains.swap_remove(shortest).0)
}

/// The features of a piece in the order and the directions of a chain.
pub(super) fn features(piece: &Piece, chain: &[(usize, bool)]) -> Vec<Feature> {
    let directed = |&(feature, reversed): &(usize, bool)| match &piece.features[feature] {
        feature if reversed => feature.reversed(),
        feature => feature.clone(),
    };
    chain.iter().map(directed).collect()
}

/// The links between the features of a chain, in order.
pub(super) fn links(features: &[Feature]) -> Vec<Link> {
    let link = |pair: &[Feature]| Link { curve: pair[0].curve, from: pair[0].end(), to: pair[1].start() };
    features.windows(2).map(link).collect()
}

/// The start and the end of a feature on each sphere.
type Tips = [[Vector3; 2]; 2];

fn tips(piece: &Piece, feature: &Feature) -> [Vector3; 2] {
    [feature.start(), feature.end()].map(|vertex| piece.on_sphere[vertex])
}

/// The chain from a feature with a direction on to the nearest ones, and its length.
fn nearest_neighbors(tips: &[Tips], start: (usize, bool)) -> (Vec<(usize, bool)>, f64) {
    let mut chain = vec![start];
    let mut length = 0.0;
    let mut last = start;
    while chain.len() < tips.len() {
        let remaining = (0..tips.len()).filter(|&k| chain.iter().all(|&(used, _)| used != k));
        let directed: Vec<_> = remaining.flat_map(|k| [(k, false), (k, true)]).collect();
        let gap = |&next: &(usize, bool)| gap(tips, last, next);
        let Some(nearest) = first_smallest(directed.iter().map(gap)) else { break };
        length += gap(&directed[nearest]);
        last = directed[nearest];
        chain.push(last);
    }
    (chain, length)
}

/// The angle between the end of a feature and the start of the next, summed over both spheres.
fn gap(tips: &[Tips], (last, last_reversed): (usize, bool), (next, next_reversed): (usize, bool)) -> f64 {
    let angle = |sphere: usize| {
        let end = tips[last][sphere][usize::from(!last_reversed)];
        let start = tips[next][sphere][usize::from(next_reversed)];
        let half_chord = 0.5 * end.distance(start);
        if half_chord < 1.0 { half_chord.asin() } else { FRAC_PI_2 }
    };
    2.0 * (angle(0) + angle(1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hyperbolic::features::piece::Bank;

    /// Features of two vertices each, at the given angles along the equator.
    fn piece(angles: &[[f64; 2]]) -> Piece {
        let bank = |k: usize| Bank {
            vertices: [2 * k, 2 * k + 1].map(Vertex::new).to_vec(),
            parameters: vec![0.0, 1.0],
        };
        let feature = |k: usize| Feature { left: bank(k), right: bank(k), is_loop: false, curve: Some(k) };
        let on_sphere: Vec<Vector3> =
            angles.as_flattened().iter().map(|a| Vector3([a.cos(), a.sin(), 0.0])).collect();
        Piece {
            points: on_sphere.clone(),
            faces: Vec::new(),
            vertex_of: Vertex::all(on_sphere.len()).collect(),
            face_of: Vec::new(),
            features: (0..angles.len()).map(feature).collect(),
            on_sphere,
        }
    }

    #[test]
    fn features_along_a_line_are_joined_in_their_order() {
        let piece = piece(&[[0.0, 0.2], [1.2, 1.0], [0.4, 0.7]]);
        let chain = order(&piece, &piece);
        assert_eq!(chain, [(0, false), (2, false), (1, true)]);
        let features = features(&piece, &chain);
        let links = links(&features);
        let link = |curve, from, to| Link { curve: Some(curve), from: Vertex(from), to: Vertex(to) };
        let expected = [link(0, 1, 4), link(2, 5, 3)];
        assert_eq!(links, expected);
    }

    #[test]
    fn of_chains_of_one_length_noise_chooses_none() {
        let third = std::f64::consts::TAU / 3.0;
        let around = |noise: &dyn Fn(u32) -> f64| {
            let tips = [0, 1, 2].map(|k| [0.0, 0.5].map(|x| third * f64::from(k) + x));
            piece(
                &[0, 1, 2]
                    .map(|k| [tips[k as usize][0] + noise(2 * k), tips[k as usize][1] + noise(2 * k + 1)]),
            )
        };
        let expected = [(0, false), (1, false), (2, false)];
        for seed in 0..20 {
            let piece = around(&|k| 1e-13 * (f64::from(k + 6 * seed) * 7.3).sin());
            assert_eq!(order(&piece, &piece), expected, "{seed}");
        }
    }

    #[test]
    fn one_feature_or_none_needs_no_link() {
        let one = piece(&[[0.0, 0.2]]);
        assert_eq!(order(&one, &one), [(0, false)]);
        assert!(links(&features(&one, &[(0, false)])).is_empty());
        assert!(order(&piece(&[]), &piece(&[])).is_empty());
    }

    #[test]
    fn both_spheres_count() {
        let source = piece(&[[0.0, 0.1], [0.3, 0.4], [0.6, 0.7]]);
        let target = piece(&[[0.0, 0.1], [2.0, 2.2], [0.2, 0.4]]);
        assert_eq!(order(&source, &target), [(0, false), (2, false), (1, false)]);
    }
}
