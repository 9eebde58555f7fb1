// SPDX-License-Identifier: MIT OR Apache-2.0
//! The initial map: both disks laid out on one polygon and laid over each other.
//!
//! It takes the place of the paper's harmonic maps between hexagons (section 4, step 4), is one-to-one by the
//! same theorem, and needs no coordinates of the universal cover. Both banks of a feature are laid out by the
//! same parameter, so that they agree.
//!
//! The initial map determines the homotopy class of the harmonic map by a place on the target for each vertex, and
//! for each edge the isometry between the charts of its ends, along a path of faces that the edge crosses.
//!
//! Cost: two sparse Cholesky factorizations, a point location for each vertex and a short walk for each edge.

use std::collections::VecDeque;
use std::collections::hash_map::{Entry, HashMap};
use std::f64::consts::PI;

use robust::{Coord, orient2d};

use super::atlas::{Atlas, Random};
use super::delaunay::Net;
use super::layout::{Planar, planar_layout};
use crate::codomain::planar::lifted;
use crate::control::Watch;
use crate::error::{Error, Side};
use crate::hyperbolic::moebius::{Complex, Moebius};
use crate::hyperbolic::slice::Opened;
use crate::hyperbolic::slice::sliced::Sliced;
use crate::location::{Location, Locator};
use crate::mesh::{Corner, Face, Vertex};
use crate::parallel;

/// Most faces of a walk, after which a search takes over.
const MOST_STEPS: usize = 10_000;

/// The places of the source's vertices on the target.
#[derive(Debug, Clone)]
pub(crate) struct Places {
    /// (n,): the face of the sliced target in which each vertex of the sliced source lies.
    pub faces: Vec<Face>,
    /// (n,): the position in that face's chart.
    pub positions: Vec<Complex>,
    /// (n,): the barycentric coordinates in that face for vertices of the boundary, which stay.
    pub held: Vec<Option<[f64; 3]>>,
}

/// The initial map between two surfaces sliced alike, with the transitions of the source's edges.
///
/// # Errors
/// [`NumericsError::NoEmbedding`](crate::NumericsError::NoEmbedding), with faces of the pieces, if a disk has no
/// planar layout in double precision; [`Error::CancelledEarly`].
pub(crate) fn initial_map(
    source: &Sliced,
    target: &Sliced,
    atlas: &Atlas<'_>,
    watch: &Watch<'_>,
) -> Result<(Places, Net), Error> {
    // 1. The layouts of both disks on one polygon
    let of = |side| move |error: Error| error.of_surface(side);
    let layouts = [
        layout_on_polygon(source, watch).map_err(of(Side::Source))?,
        layout_on_polygon(target, watch).map_err(of(Side::Target))?,
    ];
    // 2. The location on the target of each vertex of the source's disk
    let copies = places_of_copies(source, target, &layouts, watch)?;
    // 3. One copy of each vertex as its master
    let links = Links::new(source, target, atlas, &copies);
    let places = links.places(&copies, atlas);
    // 4. The isometries between the charts of neighbors
    let transitions = links.transitions(source, target, &layouts[1], atlas, &copies);
    Ok((places, Net::new(&source.surface, transitions)))
}

/// A Tutte layout with one side of the disk on each side of a regular polygon.
fn layout_on_polygon(sliced: &Sliced, watch: &Watch<'_>) -> Result<Vec<Planar>, Error> {
    let n_sides = sliced.sides.len();
    let corner = |side: usize| {
        let (sine, cosine) = (2.0 * PI * side as f64 / n_sides as f64).sin_cos();
        [cosine, sine]
    };
    let mut held = vec![None; sliced.disk.vertex_of.len()];
    for (number, side) in sliced.sides.iter().enumerate() {
        let (from, to) = (corner(number), corner((number + 1) % n_sides));
        let backwards = number >= n_sides / 2;
        for (&vertex, &s) in side.vertices.iter().zip(&side.parameters) {
            let t = if backwards { 1.0 - s } else { s };
            held[vertex] = Some([0, 1].map(|axis| (1.0 - t) * from[axis] + t * to[axis]));
        }
    }
    planar_layout(sliced, &held, watch)
}

/// The location in the target's disk of each vertex of the source's.
fn places_of_copies(
    source: &Sliced,
    target: &Sliced,
    layouts: &[Vec<Planar>; 2],
    watch: &Watch<'_>,
) -> Result<Vec<Location>, Error> {
    let ours = lifted(&layouts[0]);
    let theirs = lifted(&layouts[1]);
    let locator = Locator::new(&theirs, &target.disk.faces);
    let mut copies = locator.locate_all(&ours, watch).ok_or(Error::CancelledEarly)?;

    let corners = target.disk.boundary_corners();
    // arcs last: at the end of a bank the faces along the arc are those that the arc's two sides share
    for is_arc in [false, true] {
        for (ours, theirs) in source.sides.iter().zip(&target.sides).filter(|(side, _)| side.is_arc == is_arc)
        {
            for (&vertex, &s) in ours.vertices.iter().zip(&ours.parameters) {
                let (first, t) = segment(&theirs.parameters, s);
                copies[vertex] = Location::on_edge(corners.after(theirs.vertices[first]), t);
            }
        }
    }
    Ok(copies)
}

/// The segment of ascending or descending parameters in which `s` lies, and the parameter in it; of two segments the
/// one of lower parameters.
pub(crate) fn segment(parameters: &[f64], s: f64) -> (usize, f64) {
    let n = parameters.len();
    let ascends = parameters[n - 1] > parameters[0];
    let last = n - 2;
    let first = if ascends {
        parameters.partition_point(|&p| p < s).clamp(1, last + 1) - 1
    } else {
        parameters.partition_point(|&p| p >= s).clamp(1, last + 1) - 1
    };
    let (from, to) = (parameters[first], parameters[first + 1]);
    (first, ((s - from) / (to - from)).clamp(0.0, 1.0))
}

/// The master copy of each vertex, and the isometries to its chart from those of the other copies.
struct Links {
    /// (n,): the master of each vertex of the sliced source, a vertex of the disk.
    masters: Vec<Vertex>,
    /// The isometry from the chart of each vertex of the disk to its master's.
    to_master: Vec<Moebius>,
    /// (n,): whether each vertex of the sliced source lies on the boundary.
    is_boundary: Vec<bool>,
}

impl Links {
    fn new(source: &Sliced, target: &Sliced, atlas: &Atlas<'_>, copies: &[Location]) -> Self {
        let n = source.surface.vertex_of.len();
        let surface_vertex = source.surface_vertices();
        let mut masters = vec![None; n];
        // copies on the left sides, which come first, before the others
        let left = source.sides.iter().flat_map(|side| side.vertices.iter().copied());
        for copy in left.chain(Vertex::all(copies.len())) {
            masters[surface_vertex[copy]].get_or_insert(copy);
        }
        let masters: Vec<Vertex> =
            masters.into_iter().map(|copy| copy.expect("every vertex has a copy")).collect();
        let mut to_master = vec![Moebius::default(); copies.len()];
        for copy in 0..copies.len() {
            let master = masters[surface_vertex[copy]];
            let (from, to) = (copies[copy].triangle, copies[master].triangle);
            if from != to {
                to_master[copy] = path(&target.surface.opposite, atlas, from, to);
            }
        }
        let mut is_boundary = vec![false; n];
        let Opened { faces, opposite, .. } = &source.surface;
        for corner in Corner::all(faces.len()).filter(|&corner| opposite[corner].is_none()) {
            corner.half_edge(faces).iter().for_each(|&end| is_boundary[end] = true);
        }
        Self { masters, to_master, is_boundary }
    }

    fn places(&self, copies: &[Location], atlas: &Atlas<'_>) -> Places {
        let copy = |vertex: usize| copies[self.masters[vertex]];
        let n = self.masters.len();
        Places {
            faces: (0..n).map(|vertex| copy(vertex).triangle).collect(),
            positions: parallel::map(n, |vertex| atlas.at(copy(vertex).triangle, copy(vertex).barycentric)),
            held: (0..n).map(|vertex| self.is_boundary[vertex].then_some(copy(vertex).barycentric)).collect(),
        }
    }

    /// The isometry from the chart of the head to that of the tail, for the edge of each corner of the sliced source.
    fn transitions(
        &self,
        source: &Sliced,
        target: &Sliced,
        layout: &[Planar],
        atlas: &Atlas<'_>,
        copies: &[Location],
    ) -> Vec<Moebius> {
        let opposite = &source.surface.opposite;
        let along = |corner: Corner| {
            let [tail, head] = corner.half_edge(&source.disk.faces);
            let there = walk(&target.disk, layout, atlas, copies[tail].triangle, copies[head].triangle);
            self.to_master[tail] * there.inverse() * self.to_master[head].inverse()
        };
        // one path for both sides
        let first = |corner: Corner| opposite[corner].filter(|&across| across < corner);
        let by_first = parallel::map(opposite.len(), |index| match first(Corner::new(index)) {
            None => along(Corner::new(index)),
            Some(_) => Moebius::default(),
        });
        parallel::map(opposite.len(), |index| match first(Corner::new(index)) {
            None => by_first[index],
            Some(across) => by_first[across].inverse(),
        })
    }
}

/// The isometry from the chart of one face to that of another, along faces of the disk between them.
fn walk(disk: &Opened, layout: &[Planar], atlas: &Atlas<'_>, from: Face, to: Face) -> Moebius {
    let center = |face: Face| {
        let corners = disk.faces[face].map(|vertex| layout[vertex]);
        [0, 1].map(|axis| (corners[0][axis] + corners[1][axis] + corners[2][axis]) / 3.0)
    };
    let goal = center(to);
    let (mut face, mut motion) = (from, Moebius::default());
    let mut random = Random(0x2545_f491_4f6c_dd1d);
    for _ in 0..MOST_STEPS {
        if face == to {
            return motion;
        }
        let is_beyond = |&k: &usize| {
            let corner = face.corner(k);
            disk.opposite[corner].is_some() && is_right_of(edge_of(disk, layout, corner), goal)
        };
        let exits: Vec<usize> = (0..3).filter(is_beyond).collect();
        let Some(&k) = exits.get(random.next() as usize % exits.len().max(1)) else { break };
        let corner = face.corner(k);
        let Some(across) = disk.opposite[corner] else { break };
        motion = atlas.transitions[corner] * motion;
        face = across.face();
    }
    path(&disk.opposite, atlas, face, to) * motion
}

fn edge_of(disk: &Opened, layout: &[Planar], corner: Corner) -> [Planar; 2] {
    corner.half_edge(&disk.faces).map(|vertex| layout[vertex])
}

fn is_right_of([from, to]: [Planar; 2], point: Planar) -> bool {
    let [from, to, point] = [from, to, point].map(|[x, y]| Coord { x, y });
    orient2d(from, to, point) < 0.0
}

/// The isometry from the chart of one face to that of a face near it, along the shortest path of faces.
fn path(opposite: &[Option<Corner>], atlas: &Atlas<'_>, from: Face, to: Face) -> Moebius {
    let mut motions = HashMap::from([(from, Moebius::default())]);
    let mut queue = VecDeque::from([from]);
    while let Some(face) = queue.pop_front() {
        let motion = motions[&face];
        if face == to {
            return motion;
        }
        for corner in face.corners() {
            let Some(across) = opposite[corner] else { continue };
            let beyond = across.face();
            if let Entry::Vacant(unreached) = motions.entry(beyond) {
                unreached.insert(atlas.transitions[corner] * motion);
                queue.push_back(beyond);
            }
        }
    }
    Moebius::default()
}
