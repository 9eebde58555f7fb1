// SPDX-License-Identifier: MIT OR Apache-2.0
//! The four boundary vertices that go to the corners of a rectangle.
//!
//! Corners are sought where the boundary turns most, measured by the angles of the faces at each vertex. Of all sets of
//! four sharp turns the one whose sides are the most alike in pairs is taken; where there are fewer than four, the
//! longest sides are halved. An edge inside the surface between two vertices of one side would be pressed flat, so each
//! part of the boundary that such an edge cuts off must have a corner of its own.
//!
//! Scores that differ by less than [`MARGIN`] count as equal and positions decide, so that neither rounding nor the
//! numbering of vertices does. Cost: sorting the edges of the boundary, and some ten thousand sets of four.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::error::{Elements, Error, MapError};
use crate::mesh::geometry::triangle;
use crate::mesh::{Corner, TriangleMesh, Vertex};
use crate::vector::Vector3;

/// Four places along the boundary loop in cyclic order; the first goes to the lower left.
pub(super) type Corners = [usize; 4];

/// A boundary that turns by this part of a right angle may be a corner.
const SHARP: f64 = 0.35;

/// Sharp turns that are compared.
const MOST_CANDIDATES: usize = 24;

/// Radii within which turns are summed up, in units of the boundary's length: the first that leaves few enough.
const WINDOWS: [f64; 3] = [0.0, 0.01, 0.03];

/// Weight of the logarithm of the ratio of opposite sides in the score, in right angles.
const IMBALANCE: f64 = 0.2;

/// Weight of the logarithm of given aspect over aspect of the sides in the choice of the lower left corner.
const MISFIT: f64 = 4.0;

/// Scores that differ by less count as equal.
const MARGIN: f64 = 1e-7;

/// The boundary loop of a surface.
pub(super) struct Outline<'a> {
    mesh: &'a TriangleMesh,
    pub vertices: &'a [Vertex],
    /// The length up to each vertex, then the total.
    lengths: Vec<f64>,
    /// Disjoint parts of the loop (first place and number of further ones) that each need a corner.
    cut_off: Vec<[usize; 2]>,
    /// The edges that cut off these parts.
    chords: Vec<[Vertex; 2]>,
}

impl<'a> Outline<'a> {
    pub(super) fn new(mesh: &'a TriangleMesh) -> Self {
        let vertices = &mesh.boundary_loops()[0][..];
        let point = |k: usize| mesh.points()[vertices[k % vertices.len()]];
        let mut lengths = vec![0.0];
        (0..vertices.len()).for_each(|k| lengths.push(lengths[k] + point(k).distance(point(k + 1))));
        let (cut_off, chords) = smallest_parts_cut_off(mesh, vertices);
        Self { mesh, vertices, lengths, cut_off, chords }
    }

    /// The places of given corner vertices.
    ///
    /// # Errors
    /// [`MapError::NoRectangle`] where they are not on the boundary or not in its order, or press a face flat.
    pub(super) fn given(&self, corners: [usize; 4]) -> Result<Corners, Error> {
        let refuse = |reason: &str| {
            let vertices = Elements::collect(corners).expect("there are four");
            Err(MapError::NoRectangle { vertices, reason: reason.into() }.into())
        };
        let place = |vertex: usize| self.vertices.iter().position(|&v| v.index() == vertex);
        let [Some(a), Some(b), Some(c), Some(d)] = corners.map(place) else {
            return refuse("corners must be vertices of the longest boundary loop");
        };
        let n = self.vertices.len();
        let [b, c, d] = [b, c, d].map(|k| (k + n - a) % n);
        if b == c || c == d || d == b || [b, c, d].contains(&0) {
            return refuse("corners must be four different vertices");
        }
        if b > c && c > d {
            return refuse("corners run clockwise along the boundary: give them in the opposite order");
        }
        if !(b < c && c < d) {
            return refuse("corners must be in the order in which they follow each other along the boundary");
        }
        let corners = [a, a + b, a + c, a + d].map(|k| k % n);
        self.check(&corners)?;
        Ok(corners)
    }

    /// The places of the most likely corners, the first to go to the lower left.
    ///
    /// # Errors
    /// [`MapError::NoRectangle`] where any four would press a face flat.
    pub(super) fn found(&self, aspect: Option<f64>) -> Result<Corners, Error> {
        let n = self.vertices.len();
        if n < 4 || self.cut_off.len() > 4 {
            let tips = self.cut_off.iter().map(|&[first, _]| self.vertices[first]);
            let all = self.vertices.iter().copied();
            let (vertices, reason) = if n < 4 {
                (Elements::collect(all), "a rectangle needs a boundary of at least four edges")
            } else {
                (
                    Elements::collect(tips),
                    "each needs a corner of its own, because an edge inside the surface joins its neighbors along the \
                     boundary, but a rectangle has four: split these edges, or choose another boundary",
                )
            };
            return Err(MapError::NoRectangle {
                vertices: vertices.expect("there are some"),
                reason: reason.into(),
            }
            .into());
        }
        // 1. Sharp turns; in each part that needs a corner its sharpest turn
        let (candidates, turns) = self.candidates();
        // 2. The best four of them, or all of them and the middles of the longest sides
        let corners = self.best_four(&candidates, &turns).unwrap_or_else(|| self.halved(&candidates, &turns));
        self.check(&corners)?;
        // 3. Upright
        Ok(self.turned_upright(corners, aspect))
    }

    /// The aspect that the lengths of the sides suggest.
    pub(super) fn aspect(&self, corners: &Corners) -> f64 {
        let [bottom, right, top, left] = self.sides(corners);
        (bottom + top) / (right + left)
    }

    /// The length from one place to the next, along the loop.
    pub(super) fn length(&self, from: usize, to: usize) -> f64 {
        let length = self.lengths[to] - self.lengths[from];
        if to > from { length } else { length + self.lengths[self.vertices.len()] }
    }

    /// The lengths of the four sides.
    fn sides(&self, corners: &Corners) -> [f64; 4] {
        [0, 1, 2, 3].map(|k| self.length(corners[k], corners[(k + 1) % 4]))
    }

    /// Refuses corners that press a face flat.
    fn check(&self, corners: &Corners) -> Result<(), Error> {
        let missed = (0..self.cut_off.len()).filter(|&k| !self.has_corner(self.cut_off[k], corners));
        let chords: Vec<[Vertex; 2]> = missed.map(|k| self.chords[k]).collect();
        match Elements::collect(chords.iter().flatten().copied()) {
            None => Ok(()),
            Some(vertices) => Err(MapError::NoRectangle {
                vertices,
                reason: "an edge inside the surface joins them along one side, \
                         and the faces between would have no area: put a corner between them, or split the edge"
                    .into(),
            }.into()),
        }
    }

    fn has_corner(&self, [first, more]: [usize; 2], corners: &Corners) -> bool {
        let n = self.vertices.len();
        corners.iter().any(|&corner| (corner + n - first) % n <= more)
    }

    /// Places of sharp turns, ascending, and the turn at every place in right angles.
    fn candidates(&self) -> (Vec<usize>, Vec<f64>) {
        let n = self.vertices.len();
        let raw: Vec<f64> =
            self.vertices.iter().map(|&v| (PI - angle_sum(self.mesh, v)) / FRAC_PI_2).collect();
        let (mut candidates, mut turns) = (Vec::new(), raw.clone());
        for window in WINDOWS {
            (candidates, turns) = self.sharp(&raw, window * self.lengths[n]);
            if candidates.len() <= MOST_CANDIDATES {
                break;
            }
        }
        candidates = self.sharpest_first(candidates, &turns);
        candidates.truncate(MOST_CANDIDATES);
        for &[first, more] in &self.cut_off {
            candidates.push(self.best((first..=first + more).map(|k| k % n), |k| -turns[k]));
        }
        candidates.sort_unstable();
        candidates.dedup();
        (candidates, turns)
    }

    /// Places where the turns summed up within a radius are sharp and nowhere near sharper; and these sums.
    fn sharp(&self, raw: &[f64], radius: f64) -> (Vec<usize>, Vec<f64>) {
        let n = raw.len();
        let near = |k: usize| {
            let ahead = (1..n).map(move |step| (k + step) % n);
            let behind = (1..n).map(move |step| (k + n - step) % n);
            let ahead = ahead.map(move |j| (j, self.length(k, j))).take_while(move |(_, d)| *d < radius);
            let behind = behind.map(move |j| (j, self.length(j, k))).take_while(move |(_, d)| *d < radius);
            ahead.chain(behind)
        };
        let sum = |k: usize| raw[k] + near(k).map(|(j, d)| raw[j] * (1.0 - d / radius)).sum::<f64>();
        let turns: Vec<f64> = (0..n).map(sum).collect();
        let is_top = |k: usize| near(k).all(|(j, _)| turns[j] <= turns[k] + MARGIN);
        let sharp = (0..n).filter(|&k| turns[k] > SHARP && is_top(k)).collect();
        (sharp, turns)
    }

    /// The best four of the candidates; `None` where there are fewer, or none that leave no face flat.
    fn best_four(&self, candidates: &[usize], turns: &[f64]) -> Option<Corners> {
        let mut best: Option<(f64, f64, Corners)> = None;
        let m = candidates.len();
        for a in 0..m {
            for b in a + 1..m {
                for c in b + 1..m {
                    for d in c + 1..m {
                        let corners = [a, b, c, d].map(|k| candidates[k]);
                        if !self.cut_off.iter().all(|&part| self.has_corner(part, &corners)) {
                            continue;
                        }
                        let (score, height) = (self.score(&corners, turns), self.heights(&corners));
                        let is_better = best.is_none_or(|(most, lowest, _)| {
                            score > most + MARGIN || (score > most - MARGIN && height < lowest - MARGIN)
                        });
                        if is_better {
                            best = Some((score, height, corners));
                        }
                    }
                }
            }
        }
        best.map(|(_, _, corners)| corners)
    }

    /// The score of four places as corners of a rectangle.
    fn score(&self, corners: &Corners, turns: &[f64]) -> f64 {
        let sharpness: f64 = corners.iter().map(|&k| turns[k].min(1.0)).sum();
        let [bottom, right, top, left] = self.sides(corners);
        sharpness - IMBALANCE * ((bottom / top).ln().abs() + (right / left).ln().abs())
    }

    /// Candidates, sharpest first, as long as four fit, then the middles of the longest sides.
    fn halved(&self, candidates: &[usize], turns: &[f64]) -> Corners {
        let n = self.vertices.len();
        // 1. One corner for each part that needs one, then the sharpest
        let is_needed = |k: usize| self.cut_off.iter().any(|&[first, more]| (k + n - first) % n <= more);
        let mut corners = self.sharpest_first(candidates.to_vec(), turns);
        corners.sort_by_key(|&k| !is_needed(k));
        corners.truncate(4);
        if corners.is_empty() {
            corners.push(self.lowest(0..n));
        }
        // 2. The middles of the longest sides
        while corners.len() < 4 {
            let end = |from: usize| corners.iter().copied().min_by_key(|&to| (to + n - from - 1) % n);
            let end = |from: usize| end(from).expect("there is a corner");
            let with_room = corners.iter().copied().filter(|&from| (from + 1) % n != end(from));
            let from = self.best(with_room, |from| -self.length(from, end(from)));
            let (to, half) = (end(from), 0.5 * self.length(from, end(from)));
            let inside = (1..n).map(|step| (from + step) % n).take_while(|&k| k != to);
            let middle = self.best(inside, |k| (self.length(from, k) - half).abs());
            corners.push(middle);
        }
        corners.sort_unstable();
        corners.try_into().expect("four")
    }

    /// The places, the sharpest turns first; of equals the lowest.
    fn sharpest_first(&self, mut places: Vec<usize>, turns: &[f64]) -> Vec<usize> {
        places.sort_by(|&a, &b| turns[b].total_cmp(&turns[a]));
        places.chunk_by_mut(|&a, &b| (turns[a] - turns[b]).abs() <= MARGIN).for_each(|equals| {
            equals.sort_by(|&a, &b| self.height(a).total_cmp(&self.height(b)));
        });
        places
    }

    /// The place of the least value; of equals the lowest.
    fn best(&self, places: impl Iterator<Item = usize> + Clone, value: impl Fn(usize) -> f64) -> usize {
        let least = places.clone().map(&value).fold(f64::INFINITY, f64::min);
        self.lowest(places.filter(|&k| value(k) <= least + MARGIN))
    }

    /// The lowest place in a direction along no axis.
    fn lowest(&self, mut places: impl Iterator<Item = usize> + Clone) -> usize {
        let least = places.clone().map(|k| self.height(k)).fold(f64::INFINITY, f64::min);
        places.find(|&k| self.height(k) <= least + MARGIN).expect("there are places")
    }

    fn height(&self, place: usize) -> f64 {
        self.point(place).dot(Vector3([0.37, 0.61, 1.0]))
    }

    fn heights(&self, corners: &Corners) -> f64 {
        corners.iter().map(|&k| self.height(k)).sum()
    }

    fn point(&self, place: usize) -> Vector3 {
        self.mesh.points()[self.vertices[place]]
    }

    /// The corners from the lower left one, with x to the right and z up, or y where the surface lies flat; fitting a
    /// given aspect comes first.
    fn turned_upright(&self, corners: Corners, aspect: Option<f64>) -> Corners {
        let turned = |by: usize| -> Corners { [0, 1, 2, 3].map(|k| corners[(k + by) % 4]) };
        let score = |by: usize| {
            let corners = turned(by);
            let [a, b, c, d] = corners.map(|k| self.point(k));
            let [right, up] = [b + c - (a + d), c + d - (a + b)]
                .map(|axis| axis * (1.0 / axis.norm().max(f64::MIN_POSITIVE)));
            let misfit = aspect.map_or(0.0, |aspect| (aspect / self.aspect(&corners)).ln().abs());
            up[2] + 0.5 * up[1] + 0.25 * right[0] + 0.125 * right[1] - MISFIT * misfit
        };
        let best = (1..4).fold(0, |best, by| if score(by) > score(best) + MARGIN { by } else { best });
        turned(best)
    }
}

/// The sum of the angles of the faces at a vertex.
fn angle_sum(mesh: &TriangleMesh, vertex: Vertex) -> f64 {
    let angle = |&corner: &Corner| {
        let (face, k) = (corner.face(), corner.place());
        let corners = triangle(mesh.points(), mesh.faces()[face]);
        let [here, next, after] = [0, 1, 2].map(|step| corners[(k + step) % 3]);
        let (a, b) = (next - here, after - here);
        a.cross(b).norm().atan2(a.dot(b))
    };
    mesh.vertex_corners(vertex).iter().map(angle).sum()
}

/// The smallest parts of the boundary between the ends of an inner edge, these excluded, up to five of them; and the
/// edges. They are disjoint, since such edges do not cross.
fn smallest_parts_cut_off(mesh: &TriangleMesh, outline: &[Vertex]) -> (Vec<[usize; 2]>, Vec<[Vertex; 2]>) {
    let n = outline.len();
    let mut place = vec![usize::MAX; mesh.n_vertices()];
    outline.iter().enumerate().for_each(|(k, &v)| place[v] = k);
    let mut parts = Vec::new();
    for corner in Corner::all(mesh.n_faces()) {
        let ends = corner.half_edge(mesh.faces());
        let [from, to] = ends.map(|v| place[v]);
        // each inner edge is met twice, once in each direction
        if from != usize::MAX && to != usize::MAX && mesh.opposite(corner).is_some() {
            parts.push(((to + n - from) % n - 1, (from + 1) % n, ends));
        }
    }
    parts.sort_unstable();
    let mut smallest: Vec<[usize; 2]> = Vec::new();
    let mut chords = Vec::new();
    for (count, first, ends) in parts {
        let covers = |&[other, more]: &[usize; 2]| (other + n - first) % n + more < count;
        if count > 0 && smallest.len() < 5 && !smallest.iter().any(covers) {
            smallest.push([first, count - 1]);
            chords.push(ends);
        }
    }
    (smallest, chords)
}
