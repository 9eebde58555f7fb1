// SPDX-License-Identifier: MIT OR Apache-2.0
//! Flat maps of pieces with one or two features, which have no hyperbolic metric: disks and cylinders.
//!
//! Both surfaces are laid out on one flat domain by weighted means, the features by their parameters on its
//! straight or round boundary, and laid over each other. One feature lies on a circle; two lie on the ends of a
//! cylinder of circumference 1, where the arc between them determines how often the map winds around.
//!
//! Without folds and with boundaries in order such layouts are one-to-one.
//!
//! Cost: a sparse Cholesky factorization for each surface and a point location for each vertex.

use std::f64::consts::PI;

use super::certificates::PieceCertificates;
use super::initial::segment;
use super::layout::{Laplace, Planar, clamped_weights, planar_layout};
use crate::codomain::planar::lifted;
use crate::control::Watch;
use crate::distortion::folded_in_plane;
use crate::error::{Elements, Error, NumericsError, Side};
use crate::hyperbolic::slice::sliced::Sliced;
use crate::location::{Location, Locator};
use crate::mesh::{Corner, Vertex};
use crate::vector::Vector3;

/// Most times that a layout may wind around the cylinder beyond its period.
const WINDINGS: i32 = 8;
/// Largest distance between a point and its location's point.
const LOCATED: f64 = 1e-9;

/// A map of a piece.
pub(crate) struct FlatMap {
    /// The location in the sliced target of each vertex of the sliced source.
    pub locations: Vec<Location>,
    /// The location in the sliced source of each vertex of the sliced target.
    pub inverse: Vec<Location>,
    /// The proof that the map is one-to-one.
    pub certificates: PieceCertificates,
}

/// A surface laid out on the flat domain.
struct Laid<'a> {
    sliced: &'a Sliced,
    layout: Vec<Planar>,
}

/// Maps a piece with one or two features.
///
/// # Errors
/// [`NumericsError::NoEmbedding`], with faces of the pieces, if a layout folds in double precision;
/// [`Error::CancelledEarly`].
pub(crate) fn flat_map(source: &Sliced, target: &Sliced, watch: &Watch<'_>) -> Result<FlatMap, Error> {
    // 1. The layouts of both surfaces
    let is_cylinder = source.sides.len() > 2;
    let theirs = if is_cylinder {
        on_cylinder(target, watch)
    } else {
        planar_layout(target, &on_circle(target), watch)
    };
    let theirs = theirs.map_err(|error| error.of_surface(Side::Target))?;
    let ours = if is_cylinder {
        on_cylinder(source, watch)
    } else {
        planar_layout(source, &on_polygon(source, target, &theirs), watch)
    };
    let ours = ours.map_err(|error| error.of_surface(Side::Source))?;
    let [ours, theirs] = [(source, ours), (target, theirs)].map(|(sliced, layout)| Laid { sliced, layout });
    // 2. The locations of the vertices of each surface on the other
    let locations = ours.places_on(&theirs, watch)?;
    let inverse = theirs.places_on(&ours, watch)?;
    // 3. Figures
    let area = ours.signed_area();
    let expected_area = if is_cylinder { 1.0 } else { ours.outline_area() };
    let folded = folded_in_plane(&source.disk.faces, &ours.layout);
    let certificates = PieceCertificates { folded, area, expected_area, ..Default::default() };
    Ok(FlatMap { locations, inverse, certificates })
}

impl Laid<'_> {
    /// The location on `target` of each vertex of the surface.
    fn places_on(&self, target: &Self, watch: &Watch<'_>) -> Result<Vec<Location>, Error> {
        let mut copies = located(target.sliced, &target.layout, &self.layout, watch)?;
        let corners = target.sliced.disk.boundary_corners();
        let sides = self.sliced.sides.iter().zip(&target.sliced.sides);
        for (side, theirs) in sides.filter(|(side, _)| !side.is_arc) {
            for (&vertex, &s) in side.vertices.iter().zip(&side.parameters) {
                let (first, t) = segment(&theirs.parameters, s);
                copies[vertex] = Location::on_edge(corners.after(theirs.vertices[first]), t);
            }
        }
        let mut locations = vec![Location::default(); self.sliced.surface.vertex_of.len()];
        for (copy, vertex) in self.sliced.surface_vertices().into_iter().enumerate() {
            locations[vertex] = copies[copy];
        }
        Ok(locations)
    }

    /// The sum of the signed areas of all faces.
    fn signed_area(&self) -> f64 {
        let area = |face: &[Vertex; 3]| {
            let [a, b, c] = face.map(|vertex| self.layout[vertex]);
            0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
        };
        self.sliced.disk.faces.iter().map(area).sum()
    }

    /// The area inside the boundary.
    fn outline_area(&self) -> f64 {
        let disk = &self.sliced.disk;
        let corners = Corner::all(disk.faces.len()).filter(|&corner| disk.opposite[corner].is_none());
        let triangle = |corner: Corner| {
            let [a, b] = corner.half_edge(&disk.faces).map(|vertex| self.layout[vertex]);
            0.5 * (a[0] * b[1] - a[1] * b[0])
        };
        corners.map(triangle).sum()
    }
}

/// The boundary laid on the unit circle by its parameters.
fn on_circle(sliced: &Sliced) -> Vec<Option<Planar>> {
    held(sliced, |side, s| {
        let (sine, cosine) = (PI * if side == 0 { s } else { 2.0 - s }).sin_cos();
        [cosine, sine]
    })
}

/// The boundary laid on the polygon of the target's layout by its parameters.
fn on_polygon(source: &Sliced, target: &Sliced, layout: &[Planar]) -> Vec<Option<Planar>> {
    held(source, |side, s| {
        let theirs = &target.sides[side];
        let (first, t) = segment(&theirs.parameters, s);
        let [from, to] = [first, first + 1].map(|k| layout[theirs.vertices[k]]);
        [0, 1].map(|axis| (1.0 - t) * from[axis] + t * to[axis])
    })
}

fn held(sliced: &Sliced, place: impl Fn(usize, f64) -> Planar) -> Vec<Option<Planar>> {
    let mut held = vec![None; sliced.disk.vertex_of.len()];
    for (number, side) in sliced.sides.iter().enumerate() {
        for (&vertex, &s) in side.vertices.iter().zip(&side.parameters) {
            held[vertex] = Some(place(number, s));
        }
    }
    held
}

/// The disk's vertices laid on the strip −½ ≤ x ≤ ½, 0 ≤ y ≤ 1, with the arc near x = ±½ free to bend.
fn on_cylinder(sliced: &Sliced, watch: &Watch<'_>) -> Result<Vec<Planar>, Error> {
    let (disk, surface) = (&sliced.disk, &sliced.surface);
    // 1. The ends of the cylinder: the sides are bank, arc and bank on the right half of the strip, then on the
    //    left half
    let x = |side: usize, s: f64| 0.5 * if side < 3 { s } else { -s };
    let y = |side: usize| if side == 0 || side == 5 { 0.0 } else { 1.0 };
    let mut place = vec![None; surface.vertex_of.len()];
    let mut shift = vec![0.0; disk.vertex_of.len()];
    let surface_vertex = sliced.surface_vertices();
    for (number, side) in sliced.sides.iter().enumerate() {
        for (&vertex, &s) in side.vertices.iter().zip(&side.parameters) {
            match (side.is_arc, number) {
                (true, 1) => {}
                // the copies on the left of the strip are one period away from those on the right
                (true, _) => shift[vertex] = -1.0,
                (false, 0 | 5) => place[surface_vertex[vertex]] = Some([x(number, s), y(number)]),
                // parameters from the arc on: the second feature starts where the first ends
                (false, _) => place[surface_vertex[vertex]] = Some([x(number, 1.0 - s), y(number)]),
            }
        }
    }
    // the tips of the arc belong to both halves and lie at ½
    for &tip in [&sliced.sides[1].vertices[0], sliced.sides[1].vertices.last().expect("an arc has vertices")]
    {
        let place = &mut place[surface_vertex[tip]];
        *place = place.map(|[_, y]| [0.5, y]);
    }
    // 2. Weighted means across the arc
    let is_held = place.iter().map(Option::is_some).collect();
    let mut map: Vec<Planar> = place.into_iter().map(Option::unwrap_or_default).collect();
    let jump = |face: usize, k: usize| {
        let [i, j] = [1, 2].map(|step| shift[disk.faces[face][(k + step) % 3]]);
        [j - i, 0.0]
    };
    let faces: Vec<[Vertex; 3]> = surface.faces.clone();
    let system = Laplace::new(&faces, is_held)?;
    system.solve(&faces, &clamped_weights(sliced), jump, &mut map, watch)?;
    let layout = |map: &[Planar]| -> Vec<Planar> {
        (0..shift.len()).map(|v| [map[surface_vertex[v]][0] + shift[v], map[surface_vertex[v]][1]]).collect()
    };
    let laid = layout(&map);
    match Elements::collect(folded_in_plane(&disk.faces, &laid)) {
        None => Ok(laid),
        Some(_) => {
            system.solve(&faces, &vec![1.0; 3 * faces.len()], jump, &mut map, watch)?;
            let laid = layout(&map);
            let folded = folded_in_plane(&disk.faces, &laid).into_iter();
            match Elements::collect(folded.map(|face| sliced.places[face].face)) {
                None => Ok(laid),
                Some(folded) => Err(NumericsError::NoEmbedding { folded }.into()),
            }
        }
    }
}

/// The locations of points among the target's faces as laid out; on a cylinder up to whole turns.
fn located(
    target: &Sliced,
    layout: &[Planar],
    points: &[Planar],
    watch: &Watch<'_>,
) -> Result<Vec<Location>, Error> {
    let theirs = lifted(layout);
    let locator = Locator::new(&theirs, &target.disk.faces);
    let mut locations = locator.locate_all(&lifted(points), watch).ok_or(Error::CancelledEarly)?;
    if target.sides.len() <= 2 {
        return Ok(locations);
    }
    let miss = |location: &Location, [x, y]: Planar| {
        let corners = target.disk.faces[location.triangle].map(|vertex| layout[vertex]);
        let coordinate =
            |axis: usize| (0..3).map(|k| location.barycentric[k] * corners[k][axis]).sum::<f64>();
        (coordinate(0) - x).hypot(coordinate(1) - y)
    };
    for (point, location) in points.iter().zip(&mut locations) {
        let mut best = miss(location, *point);
        let turns = (1..=WINDINGS).flat_map(|turn| [turn, -turn]);
        for turn in turns {
            if best < LOCATED {
                break;
            }
            let moved = [point[0] + f64::from(turn), point[1]];
            let candidate = locator.locate(Vector3([moved[0], moved[1], 1.0]));
            if miss(&candidate, moved) < best {
                (best, *location) = (miss(&candidate, moved), candidate);
            }
        }
    }
    Ok(locations)
}
