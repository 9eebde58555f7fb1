// SPDX-License-Identifier: MIT OR Apache-2.0
//! The Fuchsian group of a sliced surface: its disk laid out in the hyperbolic plane, and the isometries
//! between the sides of this layout.
//!
//! A surface with a hyperbolic metric is the hyperbolic plane (the part of it between the boundary lines)
//! modulo a group of isometries. The surface cut along B − 1 arcs is a fundamental domain, and the group is
//! free on the isometries g_k that take the left copy of arc k to the right copy (Shi et al. 2013, section 3).
//! Faces are laid out by composing the isometries between their charts, so that errors in positions do not
//! change the shapes of faces.
//!
//! Input: an atlas of a sliced surface. Cost: O(m) for a layout.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, VecDeque};

use crate::hyperbolic::harmonic::atlas::Atlas;
use crate::hyperbolic::moebius::{Complex, Moebius, distance, from_hyperboloid, to_hyperboloid};
use crate::hyperbolic::slice::BoundaryCorners;
use crate::hyperbolic::slice::sliced::{Side, Sliced};
use crate::mesh::ties::{first_smallest, rounded};
use crate::mesh::{Corner, Face};
use crate::parallel;
use crate::vector::Vector3;

/// A copy of the fundamental domain in the universal cover.
#[derive(Debug, Clone, PartialEq)]
pub struct CoverCopy {
    /// The reduced word of generators that leads to it: k for the k-th generator, counted from 1, and −k for its
    /// inverse. The last letter acts first; the word of the domain itself is empty.
    pub word: Vec<i32>,
    /// The isometry that takes the fundamental domain to the copy.
    pub motion: Moebius,
}

/// A disk laid out in the hyperbolic plane.
#[derive(Debug, Clone)]
pub(super) struct Development<'a> {
    sliced: &'a Sliced,
    atlas: &'a Atlas<'a>,
    /// (m,): the isometry from the chart of each face to the plane.
    pub frames: Vec<Moebius>,
}

impl<'a> Development<'a> {
    /// Lays the disk out around the chart of a face, which stays in place.
    pub(super) fn around(face: Face, sliced: &'a Sliced, atlas: &'a Atlas<'a>) -> Self {
        let mut frames = vec![Moebius::default(); atlas.charts.len()];
        let mut is_placed = vec![false; frames.len()];
        is_placed[face] = true;
        let mut queue = VecDeque::from([face]);
        while let Some(face) = queue.pop_front() {
            for corner in face.corners() {
                let Some(beyond) = sliced.disk.opposite[corner].map(Corner::face) else { continue };
                if is_placed[beyond] {
                    continue;
                }
                is_placed[beyond] = true;
                frames[beyond] = frames[face] * atlas.transitions[corner].inverse();
                queue.push_back(beyond);
            }
        }
        Self { sliced, atlas, frames }
    }

    /// Lays the disk out around a face in its middle, so that no part is farther out than necessary.
    pub(super) fn centered(sliced: &'a Sliced, atlas: &'a Atlas<'a>) -> Self {
        let first = Self::around(Face(0), sliced, atlas);
        // the mean on the hyperboloid is where the sum of cosh(distance) is least: the farthest count most
        let middle =
            first.frames.iter().fold(Vector3::ZERO, |sum, frame| sum + weighted(frame.apply(ORIGIN)));
        let middle = from_hyperboloid(middle);
        let far =
            parallel::map(first.frames.len(), |face| distance(middle, first.frames[face].apply(ORIGIN)));
        let nearest = first_smallest(far.into_iter()).unwrap_or(0);
        Self::around(Face::new(nearest), sliced, atlas)
    }

    /// The positions of the vertices of the disk, each by the face at it that lies nearest to the origin.
    pub(super) fn positions(&self) -> Vec<Complex> {
        let n_vertices = self.sliced.disk.vertex_of.len();
        let mut nearest = vec![f64::INFINITY; n_vertices];
        let mut positions = vec![ORIGIN; n_vertices];
        for (face, corners) in self.sliced.disk.faces.iter().enumerate() {
            let (frame, far) = (self.frames[face], self.frames[face].b.norm());
            for (k, &vertex) in corners.iter().enumerate() {
                if far < nearest[vertex] {
                    nearest[vertex] = far;
                    positions[vertex] = frame.apply(self.atlas.charts[face][k]);
                }
            }
        }
        positions
    }

    /// (B − 1,): the isometries that take the left copy of each arc to the right copy; Re a > 0.
    pub(super) fn generators(&self) -> Vec<Moebius> {
        let corners = self.sliced.disk.boundary_corners();
        let arcs = self.sliced.sides.iter().filter(|side| side.is_arc);
        arcs.take(self.sliced.sides.len() / 4).map(|side| self.generator(side, &corners)).collect()
    }

    /// The isometry from the left copy of an arc to the right copy, by the edge whose copies lie nearest to the
    /// origin.
    fn generator(&self, side: &Side, corners: &BoundaryCorners) -> Moebius {
        let candidates = side.opposite_corners(corners).map(|corner| {
            let across = self.sliced.surface.opposite[corner].expect("an arc lies inside the surface");
            let [left, right] = [corner, across].map(|corner| self.frames[corner.face()]);
            (left.b.norm() * right.b.norm(), right * self.atlas.transitions[corner] * left.inverse())
        });
        let nearest = candidates.min_by(|a, b| a.0.total_cmp(&b.0));
        let generator = nearest.map_or(Moebius::default(), |(_, generator)| generator);
        if generator.a.re < 0.0 { Moebius { a: -generator.a, b: -generator.b } } else { generator }
    }
}

const ORIGIN: Complex = Complex::new(0.0, 0.0);

/// A point on the hyperboloid, scaled so that sums do not overflow.
fn weighted(z: Complex) -> Vector3 {
    to_hyperboloid(z) * 1e-9
}

/// The fundamental domain and its copies in the universal cover, at most `count` in all.
///
/// They grow outward from the domain: of all neighbors of earlier copies, across copies of arcs, the one whose middle
/// is nearest to the origin comes next.
pub fn cover(generators: &[Moebius], count: usize) -> Vec<CoverCopy> {
    let letters: Vec<i32> = (1..=generators.len() as i32).flat_map(|k| [k, -k]).collect();
    let motion = |letter: i32| {
        let generator = generators[letter.unsigned_abs() as usize - 1];
        if letter > 0 { generator } else { generator.inverse() }
    };
    let mut copies = vec![CoverCopy { word: Vec::new(), motion: Moebius::default() }];
    let mut pending = BinaryHeap::new();
    for newest in 0.. {
        if copies.len() >= count || newest >= copies.len() {
            break;
        }
        // 1. The neighbors of the newest copy
        for &letter in &letters {
            if copies[newest].word.last() != Some(&-letter) {
                let next = copies[newest].motion * motion(letter);
                pending.push(Reverse((rounded(next.b.norm().ln_1p()).to_bits(), newest, letter)));
            }
        }
        // 2. The nearest of all neighbors
        if let Some(Reverse((_, from, letter))) = pending.pop() {
            let word = copies[from].word.iter().copied().chain([letter]).collect();
            copies.push(CoverCopy { word, motion: copies[from].motion * motion(letter) });
        }
    }
    copies.truncate(count);
    copies
}
