// SPDX-License-Identifier: MIT OR Apache-2.0
//! A search around each vertex of faces that are badly distorted: it jumps to the best place nearby.
//!
//! Newton's steps end where single vertices lie at kinks of the energy, and at faces that lie turned over in space,
//! which have to collapse before they can turn back. A search by single vertices gets past both: what is not smooth
//! about the energy is a matter of each vertex by itself, so that vertices that none of them can better by itself, and
//! that no common step betters, are at a stationary point.
//!
//! Vertices without a common face are searched side by side. Cost: 72 walks and as many energies of a star for each
//! vertex that is searched.

use std::f64::consts::TAU;

use super::newton::{Motion, Moving};
use super::target::Placed;
use crate::mesh::{TriangleMesh, Vertex};
use crate::parallel;

/// Energy of a face above which its vertices are searched.
const DISTORTED: f64 = 1.3;

/// Part of the energy around it that a vertex must gain by a jump: what is less is left to Newton's steps, since which of
/// many small jumps is taken depends on rounding.
const LEAST_GAIN: f64 = 1e-3;

/// Directions and radii of the search, the factor from radius to radius, and the turn of the directions with it. The
/// first are turned by half of that, so that in regular faces no walk runs along an edge or ends at a corner.
const DIRECTIONS: usize = 12;
const RADII: usize = 6;
const SHRINKING: f64 = 0.4;
const TURN: f64 = 0.37;

/// First radius, in mean edge lengths of the image; at least this part of the mean distance of the source's vertices.
const LEAST_RADIUS: f64 = 0.2;

/// Vertices in groups of which no two have a common face.
pub(super) struct Colors(Vec<Vec<Vertex>>);

impl Colors {
    /// Colors the vertices in their order, each with the first color that none of its neighbors has.
    pub(super) fn new(mesh: &TriangleMesh, motions: &[Motion]) -> Self {
        let mut color_of = vec![usize::MAX; mesh.n_vertices()];
        let mut groups: Vec<Vec<Vertex>> = Vec::new();
        for vertex in Vertex::all(mesh.n_vertices()) {
            if motions[vertex] == Motion::Held {
                continue;
            }
            let neighbors = mesh.vertex_corners(vertex).iter().flat_map(|corner| mesh.faces()[corner.face()]);
            let taken: Vec<usize> = neighbors.map(|neighbor| color_of[neighbor]).collect();
            let color = (0..).find(|color| !taken.contains(color)).expect("one more than all neighbors have");
            color_of[vertex] = color;
            if color == groups.len() {
                groups.push(Vec::new());
            }
            groups[color].push(vertex);
        }
        Self(groups)
    }

    pub(super) fn groups(&self) -> &[Vec<Vertex>] {
        &self.0
    }
}

impl Moving<'_, '_> {
    /// Searches around each vertex with a distorted face.
    pub(super) fn sweep(&mut self, colors: &Colors) {
        for group in colors.groups() {
            let better = parallel::map(group.len(), |k| self.best_nearby(group[k]));
            for (&vertex, better) in group.iter().zip(better) {
                if let Some(better) = better {
                    self.map[vertex] = better;
                    self.left[vertex] = None;
                }
            }
        }
    }

    /// The best place around a vertex that is better than its own, if one of its faces is distorted.
    fn best_nearby(&self, vertex: Vertex) -> Option<Placed> {
        if !self.is_distorted(vertex) {
            return None;
        }
        let (energy, placed) = (self.energy, &self.map[vertex]);
        let frame = self.frame(vertex.index());
        let mut least = (1.0 - LEAST_GAIN) * energy.star_value(&self.map, vertex, placed, f64::INFINITY);
        let mut best = None;
        let mut radius = self.first_radius(vertex);
        for ring in 0..RADII {
            for k in 0..DIRECTIONS {
                let angle = TAU * (k as f64 + TURN * (ring as f64 + 0.5)) / DIRECTIONS as f64;
                let (sine, cosine) = angle.sin_cos();
                let along = frame[0] * (radius * cosine) + frame[1] * (radius * sine);
                let there = self.walked(vertex.index(), along, radius * cosine);
                let value = energy.star_value(&self.map, vertex, &there, least);
                if value < least {
                    (least, best) = (value, Some(there));
                }
            }
            radius *= SHRINKING;
        }
        best
    }

    fn is_distorted(&self, vertex: Vertex) -> bool {
        let energy = self.energy;
        let guard = energy.guard;
        // a guard without slack counts isometric faces too
        let limit = if guard.slack > 0.0 { DISTORTED } else { DISTORTED * (1.0 + guard.weight) };
        energy.source.vertex_corners(vertex).iter().any(|corner| {
            let face = corner.face().index();
            energy.face_value(face, energy.corners(&self.map, face)) > limit
        })
    }

    fn first_radius(&self, vertex: Vertex) -> f64 {
        let source = self.energy.source;
        let (mut sum, mut count) = (0.0, 0);
        for corner in source.vertex_corners(vertex) {
            let next = corner.next().vertex(source.faces());
            sum += self.map[vertex].point.distance(self.map[next].point);
            count += 1;
        }
        (sum / f64::from(count)).max(LEAST_RADIUS / (source.n_vertices() as f64).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::super::energy::{Guard, SurfaceEnergy};
    use super::super::sample_maps::Sample;
    use super::*;

    const GUARD: Guard = Guard { weight: 0.1, slack: 3.0 };

    #[test]
    fn vertices_of_one_color_have_no_common_face() {
        let source = Sample::disks().source;
        let mut motions = vec![Motion::Free; source.n_vertices()];
        motions[7] = Motion::Held;
        let colors = Colors::new(&source, &motions);
        let mut color_of = vec![None; source.n_vertices()];
        for (color, group) in colors.0.iter().enumerate() {
            for &vertex in group {
                assert_eq!(color_of[vertex].replace(color), None, "once");
            }
        }
        for vertex in Vertex::all(source.n_vertices()) {
            assert_eq!(color_of[vertex].is_none(), vertex == Vertex(7));
        }
        for [a, b, c] in source.faces() {
            for [v, w] in [[a, b], [b, c], [c, a]] {
                assert!(color_of[*v].is_none() || color_of[*v] != color_of[*w]);
            }
        }
    }

    #[test]
    fn a_vertex_put_aside_is_brought_back() {
        let sample = Sample::turned_ball();
        let problem = sample.problem();
        let energy = SurfaceEnergy::new(&problem, GUARD);
        let right = sample.placed_on(&energy.target);
        for vertex in Vertex::all(right.len()) {
            // 1. Most of the way to a neighbor
            let mut aside = right.clone();
            let mut location = sample.start[vertex];
            let place = (0..3).find(|&k| location.barycentric[k] == 1.0).unwrap();
            (location.barycentric[place], location.barycentric[(place + 1) % 3]) = (0.3, 0.7);
            aside[vertex] = energy.target.placed(location);
            // 2. It alone may move
            let mut motions = vec![Motion::Held; right.len()];
            motions[vertex] = Motion::Free;
            let colors = Colors::new(&sample.source, &motions);
            let mut moving = Moving::new(&energy, &motions, aside.clone());
            (0..3).for_each(|_| moving.sweep(&colors));
            let away = |map: &[Placed]| map[vertex].point.distance(right[vertex].point);
            assert!(away(&moving.map) < 0.5 * away(&aside), "{vertex}");
            assert!(energy.value(&moving.map) < energy.value(&aside));
            assert!(Vertex::all(right.len()).all(|v| v == vertex || moving.map[v] == right[v]));
        }
    }

    #[test]
    fn an_isometry_is_left_alone() {
        let sample = Sample::turned_ball();
        let problem = sample.problem();
        let energy = SurfaceEnergy::new(&problem, GUARD);
        let map = sample.placed_on(&energy.target);
        let motions = vec![Motion::Free; map.len()];
        let mut moving = Moving::new(&energy, &motions, map.clone());
        moving.sweep(&Colors::new(&sample.source, &motions));
        assert_eq!(moving.map, map);
    }
}
