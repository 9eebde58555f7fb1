// SPDX-License-Identifier: MIT OR Apache-2.0
//! Registration by landmark curves, the whole pipeline (Shi et al. 2013, algorithm 1).

use super::features::piece::Piece;
use super::features::pieces::pieces;
use super::features::placement::{Placement, placed};
use super::features::regions::divided;
use super::harmonic::certificates::{Certificates, PieceCertificates};
use super::harmonic::newton::Descent;
use super::harmonic::piece_map::{PieceMap, map_piece};
use super::metric::Metric;
use super::slice::isotopy::Isotopy;
use super::slice::{Sliced, SlicedPair, slice_pair};
use super::warnings::{Warning, warnings};
use super::{Curves, HyperbolicOptions, Solver};
use crate::control::{History, Observer, Phase, Status, Watch};
use crate::distortion::{Distortion, Image, distortion, distortion_in_space};
use crate::error::{CurveError, Elements, Error, NumericsError, Side};
use crate::location::{Location, Locator};
use crate::mesh::TriangleMesh;
use crate::mesh::geometry::triangle;
use crate::parallel;
use crate::registration::{Registration, SphereRegistration, inside_out};
use crate::sphere::SphereMap;
use crate::vector::{Vector, add, distance, dot, norm, scaled, sub};

/// A curve whose image strays farther than this from its partner, in parts of the target's size, was missed.
const MISSED: f64 = 1e-9;

/// A registration by curves.
#[derive(Debug, Clone)]
pub struct CurveRegistration {
    /// Where the source lies on the target. Its landmarks are the curves: the error of each is the largest
    /// distance of its image from its partner in parts of the target's size. Its figures are those of the map
    /// in space, with the folds of [`Self::certificates`]; its domain is the target's rough map to the
    /// sphere, where straight faces may fold a little along the curves.
    pub registration: SphereRegistration,
    /// The way back, where the target lies on the source, of the same map.
    pub inverse: SphereRegistration,
    /// The proof that it is one-to-one.
    pub certificates: Certificates,
    /// The metrics of source and target for every piece that has three features or more.
    pub metrics: Vec<[Metric; 2]>,
    /// The descents of the same pieces.
    pub descents: Vec<Descent>,
    /// What the caller should look at.
    pub warnings: Vec<Warning>,
}

impl CurveRegistration {
    /// The same map from the target's side; the certificates stay those of the map as computed.
    pub fn inverted(&self) -> Self {
        let mut other = self.clone();
        std::mem::swap(&mut other.registration, &mut other.inverse);
        other
    }
}

/// Registers two surfaces of genus 0, closed or with boundary, by pairs of landmark curves.
///
/// Curves run along edges from vertex to vertex; open ones are matched from start to end by shares of their
/// length, closed ones have neither start nor direction. Boundary loops are features too.
///
/// # Errors
/// Surfaces of another topology, curves that are no simple edge paths or touch each other, and features that
/// do not pair up are refused before any work. [`NumericsError::NoEmbedding`] and [`NumericsError::NoHyperbolicMetric`] where
/// double precision does not suffice; [`Error::CancelledEarly`].
pub fn register_hyperbolic(
    source: &TriangleMesh,
    target: &TriangleMesh,
    curves: &Curves<'_>,
    options: &HyperbolicOptions<'_>,
    observer: &mut dyn Observer,
) -> Result<CurveRegistration, Error> {
    let history = History::start();
    // 1. Refuse what cannot be registered before any work
    options.check()?;
    let pairs = curves.check(source, target)?;
    let same_side;
    let target = match is_closed(source) && is_closed(target) && inside_out(source, target) {
        false => target,
        true => {
            same_side = target.turned_over();
            &same_side
        }
    };
    let divided = divided(source, target, pairs)?;
    // 2. Roughly onto each other, and cut into pieces
    let watch = Watch::new(observer, 0.0, "Laying the surfaces over each other");
    let placement = placed([source, target], &divided, options.spheres, &watch)?;
    if placement.mirrored {
        return Err(CurveError::Mirrored.into());
    }
    let pieces = pieces(source, target, &divided, &placement);
    // 3. Piece by piece onto the target
    let mut found = Found::new([source, target]);
    for (at, (ours, theirs)) in pieces.iter().enumerate() {
        let part = |k: usize| 0.05 + 0.9 * k as f64 / pieces.len() as f64;
        let mut phase = Phase { whole: observer, from: part(at), to: part(at + 1) };
        let sliced = {
            let watch = Watch::new(&mut phase, 0.0, "Cutting open");
            let isotopy = Isotopy::between(ours, theirs, &watch);
            let carry = |polyline: &[Vector]| isotopy.as_ref().map(|isotopy| isotopy.carry(polyline));
            slice_pair(ours, theirs, &carry, &watch)?
        };
        let map = map_piece(&sliced, options, &mut phase);
        let map = map.map_err(|error| of_whole_surface(error, ours, theirs))?;
        found.take(ours, theirs, &sliced, map, target);
    }
    // 4. A map without folds or none; the paper's diffusion may end before it has unfolded all
    if options.solver == Solver::Newton
        && let Some(folded) = Elements::collect(found.folded.iter().copied())
    {
        return Err(Error::from(NumericsError::NoEmbedding { folded }).of_surface(Side::Source));
    }
    // 5. Figures
    let result = found.finish([source, target], curves, &placement, &history)?;
    observer.progress(1.0, "Done");
    Ok(result)
}

/// An error about faces of a piece as one about faces of its surface.
fn of_whole_surface(error: Error, source: &Piece, target: &Piece) -> Error {
    let piece = if error.side() == Some(Side::Target) { target } else { source };
    error.with_faces(|face| piece.face_of[face] as usize)
}

fn is_closed(mesh: &TriangleMesh) -> bool {
    mesh.boundary_loops().is_empty()
}

/// What the pieces have given so far.
struct Found {
    locations: Vec<Option<Location>>,
    inverse: Vec<Option<Location>>,
    folded: Vec<usize>,
    bank_error: f64,
    certificates: Vec<PieceCertificates>,
    metrics: Vec<[Metric; 2]>,
    descents: Vec<Descent>,
    is_sure: bool,
}

impl Found {
    fn new([source, target]: [&TriangleMesh; 2]) -> Self {
        Self {
            locations: vec![None; source.n_vertices()],
            inverse: vec![None; target.n_vertices()],
            folded: Vec::new(),
            bank_error: 0.0,
            certificates: Vec::new(),
            metrics: Vec::new(),
            descents: Vec::new(),
            is_sure: true,
        }
    }

    /// Brings the map of a piece back to the surfaces.
    fn take(
        &mut self,
        ours: &Piece,
        theirs: &Piece,
        sliced: &SlicedPair,
        map: PieceMap,
        target: &TriangleMesh,
    ) {
        let SlicedPair { source, target: cut, .. } = sliced;
        self.is_sure &= sliced.followed;
        for (copy, location) in map.locations.iter().enumerate() {
            let Some(vertex) = surface_vertex(ours, source, copy) else { continue };
            let location = on_surface(theirs, cut, location);
            match &mut self.locations[vertex] {
                Some(other) => {
                    let gap = distance(point(target, other), point(target, &location));
                    self.bank_error = self.bank_error.max(gap);
                }
                empty => *empty = Some(location),
            }
        }
        for (copy, location) in map.inverse.iter().enumerate() {
            if let (Some(vertex), Some(location)) = (surface_vertex(theirs, cut, copy), location) {
                self.inverse[vertex] = Some(on_surface(ours, source, location));
            }
        }
        let face_of = |face: usize| ours.face_of[source.places[face].face as usize] as usize;
        self.folded.extend(map.certificates.folded.iter().map(|&face| face_of(face)));
        self.certificates.push(map.certificates);
        if let Some((metrics, descent)) = map.hyperbolic {
            self.metrics.push(metrics);
            self.descents.push(descent);
        }
    }

    fn finish(
        mut self,
        meshes: [&TriangleMesh; 2],
        curves: &Curves<'_>,
        placement: &Placement,
        history: &History,
    ) -> Result<CurveRegistration, Error> {
        self.folded.sort_unstable();
        self.folded.dedup();
        // 1. There and back
        let locations: Vec<Location> = self.locations.iter().map(|found| found.unwrap_or_default()).collect();
        let registered = interpolated(&locations, meshes[1].faces(), &placement.target);
        let inverse = self.inverse_locations(meshes, &registered, placement);
        let back = interpolated(&inverse, meshes[0].faces(), &placement.source);
        // 2. How well the curves lie on each other
        let paths = [curves.source, curves.target];
        let [there_error, back_error] =
            [(&locations, 0, 1), (&inverse, 1, 0)].map(|(locations, from, to)| -> Vec<f64> {
                let error =
                    |curve: usize| strays(&paths[from][curve], &paths[to][curve], locations, meshes[to]);
                (0..paths[0].len()).map(error).collect()
            });
        let certificates = self.certificates(&there_error);
        // 3. Both directions as registrations
        let maps = [rough_map(meshes[0], &placement.source)?, rough_map(meshes[1], &placement.target)?];
        let parts = |from: usize, to: usize| (meshes[to], maps[from].clone(), maps[to].clone());
        let mut there = self.registration(parts(0, 1), locations, registered, there_error, history)?;
        let mut inverse = self.registration(parts(1, 0), inverse, back, back_error, history)?;
        // 4. Figures of the map in space; the way back folds what the way there folds
        there.distortion = in_space(&there, meshes, certificates.folded.clone())?;
        inverse.distortion = in_space(&inverse, [meshes[1], meshes[0]], Vec::new())?;
        there.target_distortion = inverse.distortion.clone();
        inverse.target_distortion = there.distortion.clone();
        let warnings = warnings(meshes, placement, self.is_sure, &certificates, &there.distortion);
        let Self { metrics, descents, .. } = self;
        Ok(CurveRegistration { registration: there, inverse, certificates, metrics, descents, warnings })
    }

    /// The places of the target's vertices on the source; those that rounding has lost are looked up on the
    /// sphere.
    fn inverse_locations(
        &self,
        [source, target]: [&TriangleMesh; 2],
        registered: &[Vector],
        placement: &Placement,
    ) -> Vec<Location> {
        let locator = self.inverse.contains(&None).then(|| Locator::new(registered, source.faces()));
        let lost = |vertex: usize| {
            let locate = |locator: &Locator<'_>| locator.locate(placement.target[vertex]);
            locator.as_ref().map_or_else(Location::default, locate)
        };
        (0..target.n_vertices()).map(|vertex| self.inverse[vertex].unwrap_or_else(|| lost(vertex))).collect()
    }

    fn registration(
        &self,
        (other, source_map, target_map): (&TriangleMesh, SphereMap, SphereMap),
        locations: Vec<Location>,
        registered: Vec<Vector>,
        landmark_error: Vec<f64>,
        history: &History,
    ) -> Result<SphereRegistration, Error> {
        let missed: Vec<usize> =
            (0..landmark_error.len()).filter(|&curve| landmark_error[curve] > MISSED).collect();
        Ok(Registration {
            distortion: source_map.distortion.clone(),
            registered,
            target_registered: target_map.positions.clone(),
            target_faces: other.faces().to_vec(),
            source_map,
            target_distortion: target_map.distortion.clone(),
            target_map,
            locations,
            landmark_error,
            status: self.status(&missed),
            missed,
            iterations: self.descents.iter().map(|descent| descent.energies.len() - 1).sum(),
            seconds: history.seconds(),
        })
    }

    fn status(&self, missed: &[usize]) -> Status {
        let worst = |status| self.descents.iter().any(|descent| descent.status == status);
        match () {
            () if !missed.is_empty() => Status::LandmarksMissed,
            () if worst(Status::Cancelled) => Status::Cancelled,
            () if worst(Status::Stalled) || !self.folded.is_empty() => Status::Stalled,
            () if worst(Status::MaxIterations) => Status::MaxIterations,
            () => Status::Converged,
        }
    }

    fn certificates(&self, landmark_error: &[f64]) -> Certificates {
        let all = &self.certificates;
        let total = |value: fn(&PieceCertificates) -> f64| all.iter().map(value).sum::<f64>();
        let most = |value: fn(&PieceCertificates) -> f64| all.iter().map(value).fold(0.0, f64::max);
        let residual =
            |surface: usize| self.metrics.iter().map(|metrics| metrics[surface].residual).fold(0.0, f64::max);
        Certificates {
            folded: self.folded.clone(),
            area: all.iter().map(|piece| piece.area).sum(),
            expected_area: all.iter().map(|piece| piece.expected_area).sum(),
            curve_error: landmark_error.iter().copied().fold(0.0, f64::max),
            bank_error: self.bank_error,
            cocycle_error: most(|piece| piece.cocycle_error),
            outside: all.iter().map(|piece| piece.outside).sum(),
            energy_ratio: total(|piece| piece.energy) / total(|piece| piece.rest_energy),
            curvature: [residual(0), residual(1)],
        }
    }
}

/// A place in the sliced piece as one on the surface.
pub(super) fn on_surface(piece: &Piece, cut: &Sliced, location: &Location) -> Location {
    let place = &cut.places[location.triangle as usize];
    let barycentric =
        [0, 1, 2].map(|k| (0..3).map(|corner| location.barycentric[corner] * place.corners[corner][k]).sum());
    Location { triangle: piece.face_of[place.face as usize], barycentric }
}

/// The point of a place.
fn point(mesh: &TriangleMesh, location: &Location) -> Vector {
    location.point(triangle(mesh.points(), mesh.faces()[location.triangle as usize]))
}

/// The vertex of the surface that a vertex of its slice is; midpoints of split edges are none.
pub(super) fn surface_vertex(piece: &Piece, sliced: &Sliced, copy: usize) -> Option<usize> {
    piece.vertex_of.get(sliced.surface.vertex_of[copy] as usize).map(|&vertex| vertex as usize)
}

/// Places as points of the unit sphere.
fn interpolated(locations: &[Location], faces: &[[u32; 3]], on_sphere: &[Vector]) -> Vec<Vector> {
    parallel::map(locations.len(), |vertex| {
        let location = locations[vertex];
        let place = location.point(triangle(on_sphere, faces[location.triangle as usize]));
        scaled(place, 1.0 / norm(place))
    })
}

/// How far the image of a path's vertices strays from another path at most.
fn strays(path: &[usize], other: &[usize], locations: &[Location], target: &TriangleMesh) -> f64 {
    let segments: Vec<[Vector; 2]> =
        other.windows(2).map(|ends| [target.points()[ends[0]], target.points()[ends[1]]]).collect();
    let strays = |&vertex: &usize| {
        let image = point(target, &locations[vertex]);
        segments.iter().fold(f64::INFINITY, |least, &segment| least.min(to_segment(image, segment)))
    };
    path.iter().map(strays).fold(0.0, f64::max)
}

/// The distance of a point from a segment.
fn to_segment(x: Vector, [from, to]: [Vector; 2]) -> f64 {
    let along = sub(to, from);
    let part = (dot(sub(x, from), along) / dot(along, along)).clamp(0.0, 1.0);
    distance(x, add(from, scaled(along, part)))
}

/// The figures of a map from one surface in space onto another.
fn in_space(
    found: &SphereRegistration,
    [mesh, other]: [&TriangleMesh; 2],
    folded: Vec<usize>,
) -> Result<Distortion, Error> {
    let image = found.positions(other.points());
    distortion_in_space(mesh.points(), mesh.faces(), &image, folded, mesh.face_areas())
}

/// The rough map to the sphere as a map like others.
fn rough_map(mesh: &TriangleMesh, positions: &[Vector]) -> Result<SphereMap, Error> {
    let history = History::start();
    Ok(SphereMap {
        positions: positions.to_vec(),
        status: Status::Converged,
        distortion: distortion(mesh.points(), mesh.faces(), Image::Sphere(positions), mesh.face_areas())?,
        refinement: None,
        seconds: history.seconds(),
        history,
    })
}
