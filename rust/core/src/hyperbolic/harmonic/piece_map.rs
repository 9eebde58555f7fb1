// SPDX-License-Identifier: MIT OR Apache-2.0
//! The map of a sliced piece onto its partner.
//!
//! Pieces with three or more features have a hyperbolic metric and a hyperbolic harmonic map (Shi et al. 2013,
//! algorithm 1); pieces with fewer are laid out flat.

use super::atlas::Atlas;
use super::certificates::{PieceCertificates, certify, folded_faces};
use super::chart_map::ChartMap;
use super::flat::flat_map;
use super::heat::diffuse;
use super::initial::initial_map;
use super::inverse::inverse;
use super::newton::{Descent, newton};
use crate::control::{Observer, Phase, Watch};
use crate::error::{Error, Side};
use crate::hyperbolic::metric::{Metric, hyperbolic_metric};
use crate::hyperbolic::options::{HarmonicSolver, HyperbolicOptions};
use crate::hyperbolic::slice::sliced::{Sliced, SlicedPair};
use crate::location::Location;
use crate::mesh::Vertex;

/// A map between two sliced pieces.
pub(crate) struct PieceMap {
    /// The location in the sliced target of each vertex of the sliced source.
    pub locations: Vec<Location>,
    /// The location in the sliced source of each vertex of the sliced target; `None` if rounding has lost it.
    pub inverse: Vec<Option<Location>>,
    /// The proof that the map is one-to-one.
    pub certificates: PieceCertificates,
    /// The metrics of source and target, and the descent; `None` for a flat piece.
    pub hyperbolic: Option<([Metric; 2], Descent)>,
}

/// Maps a piece.
///
/// # Errors
/// The errors of metric, layout and harmonic map, with faces of the pieces; [`Error::CancelledEarly`].
pub(crate) fn map_piece(
    sliced: &SlicedPair,
    options: &HyperbolicOptions<'_>,
    observer: &mut dyn Observer,
) -> Result<PieceMap, Error> {
    let [source, target] = [&sliced.source, &sliced.target];
    let n_features = source.sides.len().div_ceil(4);
    let chi = 2 - n_features as i64;
    ask(observer)?;
    if chi >= 0 {
        let flat = flat_map(source, target, &Watch::new(observer, 0.0, "Flat map"))?;
        let inverse = flat.inverse.into_iter().map(Some).collect();
        let (locations, certificates) = (flat.locations, flat.certificates);
        return Ok(PieceMap { locations, inverse, certificates, hyperbolic: None });
    }
    // 1. Hyperbolic metrics with geodesic boundaries: the target's as the codomain, the source's for the weights
    let metric = |surface: usize, observer: &mut dyn Observer| {
        ask(observer)?;
        let sliced = [source, target][surface];
        let points = sliced.surface_points();
        let watch = Watch::new(observer, 0.0, "Hyperbolic metric");
        let metric = hyperbolic_metric(&points, &sliced.surface.faces, chi, options.metric, &watch);
        let side = [Side::Source, Side::Target][surface];
        metric.map_err(|error| error.with_faces(|face| sliced.places[face].face.index()).of_surface(side))
    };
    let ours = metric(0, &mut Phase { whole: observer, from: 0.0, to: 0.3 })?;
    let theirs = metric(1, &mut Phase { whole: observer, from: 0.3, to: 0.6 })?;
    // 2. A first homeomorphism
    let atlas = Atlas::new(&target.surface, &theirs);
    let mut phase = Phase { whole: observer, from: 0.6, to: 0.75 };
    ask(&mut phase)?;
    let (places, input) = initial_map(source, target, &atlas, &Watch::new(&mut phase, 0.0, "Initial map"))?;
    // 3. The harmonic map
    let none_kept = vec![false; source.faces.len()];
    let mut map = ChartMap::by_delaunay(&atlas, places, input, &ours.lengths, &none_kept);
    let mut phase = Phase { whole: observer, from: 0.75, to: 1.0 };
    let descent = match options.solver {
        HarmonicSolver::Newton => {
            let descent = newton(&mut map, &mut phase)?;
            unfolded(&mut map, &ours.lengths, descent, &mut phase)?
        }
        HarmonicSolver::Heat => {
            let areas = vertex_areas(source, &ours);
            diffuse(&mut map, &areas, options.heat_steps, options.heat_tolerance, &mut phase)
        }
    };
    // 4. The locations, and the proof
    let certificates = certify(&map, chi);
    let (locations, inverse) = (locations(&map), inverse(&map, source, target));
    Ok(PieceMap { locations, inverse, certificates, hyperbolic: Some(([ours, theirs], descent)) })
}

/// Tells the observer that a step begins.
fn ask(observer: &mut dyn Observer) -> Result<(), Error> {
    if observer.progress(0.0, "Hyperbolic metric") { Ok(()) } else { Err(Error::CancelledEarly) }
}

/// Rounds of unfolding, each of which keeps faces within one more ring; the last keeps all.
const ROUNDS: usize = 6;

/// Moves to a minimum in which no face of the source is folded.
///
/// The harmonic map embeds the triangulation that carries its energy. If edges were flipped, this is not the
/// source's, and very flat faces of the source may be slightly folded. Faces around these are kept in the
/// triangulation.
fn unfolded(
    map: &mut ChartMap<'_>,
    lengths: &[[f64; 3]],
    mut descent: Descent,
    observer: &mut dyn Observer,
) -> Result<Descent, Error> {
    let n_vertices = map.places.faces.len();
    let mut is_near = vec![false; n_vertices];
    for round in 1..=ROUNDS {
        let folded = folded_faces(map);
        if folded.is_empty() {
            break;
        }
        folded.iter().for_each(|&face| mark(&mut is_near, map.input.faces[face]));
        for _ in 0..round {
            grow(&mut is_near, &map.input.faces);
        }
        let is_kept = |face: &[Vertex; 3]| round == ROUNDS || face.iter().all(|&v| is_near[v]);
        let kept: Vec<bool> = map.input.faces.iter().map(is_kept).collect();
        *map = ChartMap::by_delaunay(map.atlas, map.places.clone(), map.input.clone(), lengths, &kept);
        let again = newton(map, observer)?;
        descent.energies.extend(&again.energies[1..]);
        (descent.gradient, descent.status) = (again.gradient, again.status);
    }
    Ok(descent)
}

fn mark(is_near: &mut [bool], face: [Vertex; 3]) {
    face.iter().for_each(|&vertex| is_near[vertex] = true);
}

/// Marks the neighbors of marked vertices.
fn grow(is_near: &mut [bool], faces: &[[Vertex; 3]]) {
    let before = is_near.to_vec();
    let touches = |face: &&[Vertex; 3]| face.iter().any(|&vertex| before[vertex]);
    faces.iter().filter(touches).for_each(|&face| mark(is_near, face));
}

/// A third of the hyperbolic area of the faces at each vertex.
pub(crate) fn vertex_areas(sliced: &Sliced, metric: &Metric) -> Vec<f64> {
    let mut areas = vec![0.0; sliced.surface.vertex_of.len()];
    for (face, angles) in sliced.surface.faces.iter().zip(&metric.angles) {
        let area = std::f64::consts::PI - angles.iter().sum::<f64>();
        face.iter().for_each(|&vertex| areas[vertex] += area / 3.0);
    }
    areas
}

fn locations(map: &ChartMap<'_>) -> Vec<Location> {
    let places = &map.places;
    crate::parallel::map(places.faces.len(), |vertex| Location {
        triangle: places.faces[vertex],
        barycentric: match places.held[vertex] {
            Some(barycentric) => barycentric,
            None => map.atlas.barycentric(places.faces[vertex], places.positions[vertex]),
        },
    })
}
