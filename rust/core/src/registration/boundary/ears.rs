// SPDX-License-Identifier: MIT OR Apache-2.0
//! Faces at the boundary that would lose their areas on a straight side.
//!
//! An inner edge between two boundary vertices is a chord of the surface: what it cuts off has an area on the polygon
//! only if a corner of the polygon lies between its ends. A face with two boundary edges, an ear, is the simplest case.
//! Chords do not cross, so the arcs of the boundary that they cut off are nested or disjoint, and only the narrowest
//! count. Each of these gets a corner of its own if one is near, by turning the boundary there along the polygon.
//!
//! A corner counts where the boundary bends in space: where it is straight in space, faces have no area either.

use std::collections::BTreeSet;
use std::f64::consts::TAU;

use super::places::{Place, Rim};
use crate::mesh::{TriangleMesh, Vertex};

/// A corner counts as between the ends of an arc if it is this part of the arc's width away from both.
const MARGIN: f64 = 0.05;

/// Farthest corner that an arc is turned to, in widths of the arc from its middle.
const REACH: f64 = 1.0;

/// How far beyond an arc the boundary turns with it, in widths of the arc.
const ALONG: f64 = 2.0;

/// A part of a boundary loop: `length` edges from its vertex number `from`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Arc {
    pub length: usize,
    pub from: usize,
}

/// The arcs that the chords of a surface cut off, those narrower first.
#[derive(Debug)]
pub(super) struct Arcs {
    all: Vec<Arc>,
    /// Those that contain no other, by their beginnings.
    narrow: Vec<Arc>,
}

/// The arcs that the chords of a surface cut off from its boundary loop.
pub(super) fn narrow_arcs(mesh: &TriangleMesh, boundary: &[Vertex]) -> Arcs {
    let n = boundary.len();
    let mut number = vec![usize::MAX; mesh.n_vertices()];
    boundary.iter().enumerate().for_each(|(k, &vertex)| number[vertex] = k);
    let mut all = Vec::new();
    for corner in mesh.edge_corners().filter(|&corner| mesh.opposite(corner).is_some()) {
        let [from, to] = [corner.next(), corner.previous()].map(|c| number[c.vertex(mesh.faces())]);
        if from != usize::MAX && to != usize::MAX {
            let length = (to + n - from) % n;
            all.extend([Arc { length, from }, Arc { length: n - length, from: to }]);
        }
    }
    all.sort_unstable();
    let mut beginnings = BTreeSet::new();
    let mut narrow = Vec::new();
    for &arc in &all {
        // of the narrower arcs, the first that begins in this one lies in it
        let next = beginnings.range(arc.from..).chain(beginnings.iter()).next().copied();
        if next.is_none_or(|next: usize| (next + n - arc.from) % n >= arc.length) {
            beginnings.insert(arc.from);
            narrow.push(arc);
        }
    }
    narrow.sort_unstable_by_key(|arc| arc.from);
    Arcs { all, narrow }
}

/// The angles of a boundary, turned where that brings a corner of the rim between the ends of an arc.
pub(super) fn turned(angles: &[f64], arcs: &Arcs, rim: &Rim) -> Vec<f64> {
    let anchors = Spans::new(angles, &arcs.narrow).anchors(rim);
    let is_forward = |[a, b]: [Anchor; 2]| a.angle < b.angle && a.angle + a.turn < b.angle + b.turn;
    let n = anchors.len();
    let next = |k: usize| if k + 1 < n { anchors[k + 1] } else { anchors[0].turned_once() };
    if n == 0 || !(0..n).all(|k| is_forward([anchors[k], next(k)])) {
        return angles.to_vec();
    }
    angles.iter().map(|&angle| angle + turn_at(&anchors, angle)).collect()
}

/// An angle and how far it is turned.
#[derive(Debug, Clone, Copy)]
struct Anchor {
    angle: f64,
    turn: f64,
}

impl Anchor {
    fn turned_once(self) -> Self {
        Self { angle: self.angle + TAU, ..self }
    }
}

/// The turn between anchors, linear from one to the next.
fn turn_at(anchors: &[Anchor], angle: f64) -> f64 {
    let first = anchors[0].angle;
    let angle = angle - TAU * ((angle - first) / TAU).floor();
    let after = anchors.partition_point(|anchor| anchor.angle <= angle);
    let before = anchors[after.max(1) - 1];
    let after = anchors.get(after.max(1)).copied().unwrap_or(anchors[0].turned_once());
    let share = ((angle - before.angle) / (after.angle - before.angle)).clamp(0.0, 1.0);
    before.turn + share * (after.turn - before.turn)
}

/// The narrow arcs as intervals of angles, ascending from one of them.
struct Spans<'a> {
    angles: &'a [f64],
    arcs: Vec<Arc>,
}

impl<'a> Spans<'a> {
    fn new(angles: &'a [f64], arcs: &[Arc]) -> Self {
        Self { angles, arcs: arcs.to_vec() }
    }

    /// The angle of a vertex of the loop, which may be numbered beyond its end.
    fn angle(&self, k: usize) -> f64 {
        let n = self.angles.len();
        self.angles[k % n] + TAU * (k / n) as f64
    }

    fn ends(&self, arc: &Arc) -> [f64; 2] {
        [self.angle(arc.from), self.angle(arc.from + arc.length)]
    }

    /// The inner vertex of an arc nearest to its middle.
    fn tip(&self, arc: &Arc) -> f64 {
        let [from, to] = self.ends(arc);
        let off = |k: &usize| (self.angle(*k) - 0.5 * (from + to)).abs();
        let inner = arc.from + 1..arc.from + arc.length;
        inner.min_by(|a, b| off(a).total_cmp(&off(b))).map_or(0.5 * (from + to), |k| self.angle(k))
    }

    /// Where the boundary stays and where it turns, ascending within one turn.
    fn anchors(mut self, rim: &Rim) -> Vec<Anchor> {
        let bent: Vec<f64> = (0..rim.len()).filter(|&k| rim.is_bent[k]).map(|k| rim.angles[k]).collect();
        if self.arcs.is_empty() || bent.is_empty() {
            return Vec::new();
        }
        let n_bent = bent.len();
        let corners: Vec<f64> =
            (-1..4).flat_map(|turn| bent.iter().map(move |angle| angle + TAU * f64::from(turn))).collect();
        // 1. Arcs with a corner between their ends keep it; begin with one of these
        let own = |spans: &Self, arc: &Arc| {
            let [from, to] = spans.ends(arc);
            let (margin, middle) = (MARGIN * (to - from), 0.5 * (from + to));
            nearest(&corners, middle).filter(|&k| corners[k] > from + margin && corners[k] < to - margin)
        };
        if let Some(first) = self.arcs.iter().position(|arc| own(&self, arc).is_some()) {
            let n = self.angles.len();
            self.arcs[..first].iter_mut().for_each(|arc| arc.from += n);
            self.arcs.rotate_left(first);
        }
        let mut taken: Vec<Option<usize>> = self.arcs.iter().map(|arc| own(&self, arc)).collect();
        let stays: Vec<bool> = taken.iter().map(Option::is_some).collect();
        // 2. The others take the nearest corner that is left
        let mut last: Option<usize> = None;
        for e in 0..self.arcs.len() {
            if taken[e].is_none() {
                let [from, to] = self.ends(&self.arcs[e]);
                let first = taken.iter().flatten().next().map(|first| first + n_bent);
                let limit = taken[e + 1..].iter().flatten().next().copied().or(first);
                let free = last.map_or(0, |last| last + 1)..limit.unwrap_or(corners.len()).min(corners.len());
                let middle = 0.5 * (from + to);
                taken[e] = nearest(&corners[free.start.min(free.end)..free.end], middle)
                    .map(|k| k + free.start)
                    .filter(|&k| (corners[k] - middle).abs() <= REACH * (to - from));
            }
            last = taken[e].or(last);
        }
        // 3. Turns, which end a little beyond their arcs
        let mut anchors = Vec::new();
        for (e, arc) in self.arcs.iter().enumerate() {
            match taken[e] {
                None => {}
                Some(k) if stays[e] => anchors.push(Anchor { angle: corners[k], turn: 0.0 }),
                Some(k) => anchors.push(Anchor { angle: self.tip(arc), turn: corners[k] - self.tip(arc) }),
            }
        }
        let turning: Vec<[f64; 2]> = (0..self.arcs.len())
            .filter(|&e| taken[e].is_some() && !stays[e])
            .map(|e| {
                let [from, to] = self.ends(&self.arcs[e]);
                [from - ALONG * (to - from), to + ALONG * (to - from)]
            })
            .collect();
        let is_within = |angle: f64, [from, to]: [f64; 2]| (angle - from).rem_euclid(TAU) < to - from;
        for (e, &window) in turning.iter().enumerate() {
            let is_short = window[1] - window[0] < 0.5 * TAU;
            let others = || turning.iter().enumerate().filter(|&(other, _)| other != e);
            let ends = window
                .into_iter()
                .filter(|&end| is_short && others().all(|(_, &other)| !is_within(end, other)));
            anchors.extend(ends.map(|angle| Anchor { angle, turn: 0.0 }));
        }
        let first = anchors.first().map_or(0.0, |anchor: &Anchor| anchor.angle);
        anchors.iter_mut().for_each(|anchor| anchor.angle -= TAU * ((anchor.angle - first) / TAU).floor());
        anchors.sort_by(|a, b| a.angle.total_cmp(&b.angle));
        anchors.dedup_by(|a, b| a.angle == b.angle && a.turn == b.turn);
        anchors
    }
}

/// The number of the ascending value nearest to `x`.
fn nearest(ascending: &[f64], x: f64) -> Option<usize> {
    let after = ascending.partition_point(|&value| value < x);
    let candidates = after.saturating_sub(1)..(after + 1).min(ascending.len());
    candidates.min_by(|&a, &b| (ascending[a] - x).abs().total_cmp(&(ascending[b] - x).abs()))
}

/// A part of a boundary loop that lies on one straight side though faces need room there.
#[derive(Debug, Clone, Copy)]
pub(super) struct Run {
    arc: Arc,
}

impl Run {
    /// The vertices of the loop in the run.
    fn vertices(&self, n: usize) -> impl Iterator<Item = usize> {
        let Arc { length, from } = self.arc;
        (from..=from + length).map(move |k| k % n)
    }

    /// The inner vertex in the middle, which stays.
    fn foot(&self) -> usize {
        self.arc.length / 2
    }

    /// How far each vertex is set inside, given its point on the side: on a parabola that touches the side at the foot.
    fn inward(&self, points: &[[f64; 2]], depth: f64) -> Vec<[f64; 2]> {
        let (first, last) = (points[0], points[points.len() - 1]);
        let [x, y] = [last[0] - first[0], last[1] - first[1]];
        let share = |[px, py]: [f64; 2]| ((px - first[0]) * x + (py - first[1]) * y) / (x * x + y * y);
        let foot = share(points[self.foot()]);
        let inward = |&point: &[f64; 2]| {
            let depth = 4.0 * depth * (share(point) - foot).powi(2);
            [-y * depth, x * depth]
        };
        points.iter().map(inward).collect()
    }
}

/// Sets the runs among the points of a boundary loop on shallow curves inside their sides.
pub(super) fn set_inside(points: &mut [[f64; 2]], runs: &[Run], depth: f64) {
    let n = points.len();
    let on_rim = points.to_vec();
    for run in runs {
        let side: Vec<[f64; 2]> = run.vertices(n).map(|k| on_rim[k]).collect();
        run.vertices(n).zip(run.inward(&side, depth)).for_each(|(k, [x, y])| {
            points[k][0] += x;
            points[k][1] += y;
        });
    }
}

/// The runs of a boundary on straight sides from which chords cut off faces.
pub(super) fn flat_runs(arcs: &Arcs, places: &[Place], rim: &Rim) -> Vec<Run> {
    let n = places.len();
    // 1. The edges of flat arcs
    let mut change = vec![0isize; 2 * n + 1];
    for arc in &arcs.all {
        if !bends_between(places[arc.from], places[(arc.from + arc.length) % n], rim) {
            change[arc.from] += 1;
            change[arc.from + arc.length] -= 1;
        }
    }
    let mut is_flat = vec![false; n];
    let mut open = 0;
    for k in 0..2 * n {
        open += change[k];
        is_flat[k % n] |= open > 0;
    }
    // 2. What hangs together on one side
    let is_end = |k: usize| places[k].share == 0.0 && rim.is_bent[places[k].edge];
    let begins = |k: &usize| is_flat[*k] && (!is_flat[(*k + n - 1) % n] || is_end(*k));
    let run = |from: usize| {
        let goes_on = |length: &usize| is_flat[(from + length) % n] && !is_end((from + length) % n);
        let length = (1..n).find(|length| !goes_on(length)).unwrap_or(n - 1);
        Run { arc: Arc { length, from } }
    };
    (0..n).filter(begins).map(run).collect()
}

/// Whether the rim bends at a corner between two places, counter-clockwise from the first.
fn bends_between(from: Place, to: Place, rim: &Rim) -> bool {
    let n = rim.len();
    let edges =
        if from.edge == to.edge && from.share >= to.share { n } else { (to.edge + n - from.edge) % n };
    let corners = if to.share > 0.0 { edges } else { edges.saturating_sub(1) };
    (1..=corners).any(|step| rim.is_bent[(from.edge + step) % n])
}

/// The vertices of the loop that are set inside, (n,).
pub(super) fn inside(runs: &[Run], places: &[Place]) -> Vec<bool> {
    let mut inside = vec![false; places.len()];
    for run in runs {
        let foot = run.foot();
        run.vertices(places.len())
            .enumerate()
            .filter(|&(step, _)| step != foot)
            .for_each(|(_, k)| inside[k] = true);
    }
    inside
}
