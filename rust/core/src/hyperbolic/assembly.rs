// SPDX-License-Identifier: MIT OR Apache-2.0
//! Assembles the maps of all pieces into a map of the surfaces, with its figures.

use ndarray::{Array1, Array2};

use super::between::Between;
use super::features::curves::LandmarkCurves;
use super::features::piece::Piece;
use super::features::placement::Placement;
use super::harmonic::certificates::{Certificates, PieceCertificates};
use super::harmonic::newton::Descent;
use super::harmonic::piece_map::PieceMap;
use super::metric::Metric;
use super::slice::sliced::SlicedPair;
use super::warnings::{Warning, warnings};
use crate::arrays::from_vectors;
use crate::control::{History, Observer, Status};
use crate::distortion::{Distortion, Image, distortion_in_space, measure};
use crate::error::Error;
use crate::location::{Location, Locator, points_on};
use crate::mesh::{Surface, TriangleMesh, Vertex};
use crate::parallel;
use crate::registration::Strain;
use crate::registration::correspondence::{Correspondence, Registered};
use crate::vector::Vector3;

/// Largest distance of a curve's image from its partner, relative to the target's size; beyond it the curve is missed.
const MISSED: f64 = 1e-9;

/// A registration by curves.
#[derive(Debug, Clone)]
pub struct CurveRegistration {
    /// The map of the source onto the target.
    pub map: CurveMap,
    /// The inverse of the map.
    pub inverse: CurveMap,
    /// The vertex paths of the curves of source and target, as given.
    pub curves: [Vec<Vec<usize>>; 2],
    /// The rough spheres by which source and target were laid over each other.
    pub spheres: [RoughSphere; 2],
    /// The proof that the map is one-to-one.
    pub certificates: Certificates,
    /// The metrics of source and target for every piece with three or more features.
    pub metrics: Vec<[Metric; 2]>,
    /// The descents of these pieces.
    pub descents: Vec<Descent>,
    /// Signs that the curves do not say what was meant.
    pub warnings: Vec<Warning>,
    /// The steps of all descents.
    pub iterations: usize,
    /// Wall time of the whole call.
    pub seconds: f64,
}

/// A one-to-one map of a surface onto another that takes curves to curves.
#[derive(Debug, Clone)]
pub struct CurveMap {
    /// The location of each vertex on the other surface.
    pub correspondence: Correspondence,
    /// (n, 3): the images of the vertices on the rough sphere of the other surface, where straight faces may fold a
    /// little along the curves.
    pub registered: Array2<f64>,
    /// (B,): the largest distance of the image of each curve from its partner, in parts of the other surface's size.
    pub curve_error: Array1<f64>,
    /// The curves that are farther than 10⁻⁹ from their partners.
    pub missed: Vec<usize>,
    /// Why the run ended; [`Status::LandmarksMissed`] if curves were missed.
    pub status: Status,
    /// The figures of the map in space, with the folds of the certificates.
    pub distortion: Distortion,
}

/// A surface laid roughly onto the unit sphere, over which its partner is laid; faces may be folded.
#[derive(Debug, Clone)]
pub struct RoughSphere {
    /// (n, 3): the vertices on the unit sphere.
    pub positions: Array2<f64>,
    /// (m,): the areas of the faces.
    pub targets: Vec<f64>,
    /// The figures of the map to the sphere.
    pub distortion: Distortion,
}

impl CurveRegistration {
    /// The registration of the target onto the source; the certificates stay those of the map as computed.
    pub fn inverted(&self) -> Self {
        let mut inverted = self.clone();
        std::mem::swap(&mut inverted.map, &mut inverted.inverse);
        inverted.spheres.reverse();
        inverted.curves.reverse();
        inverted
    }

    /// How far the map stretches and shrinks each face of the source.
    pub fn strain(&self) -> Strain {
        self.map.correspondence.strain(&self.curves[0])
    }
}

impl RoughSphere {
    fn new(mesh: &TriangleMesh, positions: &[Vector3]) -> Result<Self, Error> {
        let image = Image::Sphere(positions);
        let distortion = measure(mesh.points(), mesh.faces(), image, mesh.face_areas())?;
        let targets = mesh.face_areas().to_vec();
        Ok(Self { positions: from_vectors(positions.to_vec()), targets, distortion })
    }
}

/// The maps of the pieces so far.
pub(super) struct Assembly {
    locations: Vec<Option<Location>>,
    inverse: Vec<Option<Location>>,
    /// The folded faces of the source.
    pub folded: Vec<usize>,
    bank_error: f64,
    certificates: Vec<PieceCertificates>,
    metrics: Vec<[Metric; 2]>,
    descents: Vec<Descent>,
    /// The status of the descent between the surfaces.
    between: Option<Status>,
    is_sure: bool,
}

impl Assembly {
    pub(super) fn new([source, target]: [&TriangleMesh; 2]) -> Self {
        Self {
            locations: vec![None; source.n_vertices()],
            inverse: vec![None; target.n_vertices()],
            folded: Vec::new(),
            bank_error: 0.0,
            certificates: Vec::new(),
            metrics: Vec::new(),
            descents: Vec::new(),
            between: None,
            is_sure: true,
        }
    }

    /// Adds the map of a piece.
    pub(super) fn take(
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
            let Some(vertex) = source.given_vertex(ours, copy) else { continue };
            let location = cut.given_place(theirs, location);
            match &mut self.locations[vertex] {
                Some(first) => {
                    let gap = first
                        .point_on(target.points(), target.faces())
                        .distance(location.point_on(target.points(), target.faces()));
                    self.bank_error = self.bank_error.max(gap);
                }
                empty => *empty = Some(location),
            }
        }
        for (copy, location) in map.inverse.iter().enumerate() {
            if let (Some(vertex), Some(location)) = (cut.given_vertex(theirs, copy), location) {
                self.inverse[vertex] = Some(source.given_place(ours, location));
            }
        }
        let face_of = |face: usize| ours.face_of[source.places[face].face].index();
        self.folded.extend(map.certificates.folded.iter().map(|&face| face_of(face)));
        self.certificates.push(map.certificates);
        if let Some((metrics, descent)) = map.hyperbolic {
            self.metrics.push(metrics);
            self.descents.push(descent);
        }
    }

    /// Lowers the energy between the surfaces; a map that moves gives a new inverse.
    pub(super) fn lower(
        &mut self,
        between: Between<'_, '_>,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> Result<(), Error> {
        let start = self.given_locations();
        let (locations, status) = between.lower(start.clone(), history, observer)?;
        self.between = Some(status);
        if locations != start {
            self.locations = locations.into_iter().map(Some).collect();
            self.inverse.fill(None);
        }
        Ok(())
    }

    fn given_locations(&self) -> Vec<Location> {
        self.locations.iter().map(|location| location.unwrap_or_default()).collect()
    }

    pub(super) fn finish(
        mut self,
        surfaces: [&Surface; 2],
        meshes: [&TriangleMesh; 2],
        curves: &LandmarkCurves<'_>,
        placement: &Placement,
        history: &History,
    ) -> Result<CurveRegistration, Error> {
        self.folded.sort_unstable();
        self.folded.dedup();
        // 1. There and back
        let locations = self.given_locations();
        let registered = interpolated(&locations, meshes[1].faces(), &placement.target);
        let inverse = self.inverse_locations(meshes, &registered, placement);
        let back = interpolated(&inverse, meshes[0].faces(), &placement.source);
        // 2. The errors of the curves
        let paths = [curves.source, curves.target];
        let [there_error, back_error] =
            [(&locations, 0, 1), (&inverse, 1, 0)].map(|(locations, from, to)| -> Vec<f64> {
                let error =
                    |curve: usize| strays(&paths[from][curve], &paths[to][curve], locations, meshes[to]);
                (0..paths[0].len()).map(error).collect()
            });
        let certificates = self.certificates(&there_error);
        // 3. Figures of the map in space; the inverse folds where the map does
        let positions = points_on(&locations, meshes[1].points(), meshes[1].faces());
        let there_figures = figures(meshes[0], &positions, certificates.folded.clone())?;
        let positions = points_on(&inverse, meshes[0].points(), meshes[0].faces());
        let back_figures = figures(meshes[1], &positions, Vec::new())?;
        let warnings = warnings(meshes, placement, self.is_sure, &certificates, &there_figures);
        // 4. Both directions
        let on_sphere = [&placement.source, &placement.target];
        let onto =
            |side: usize| Registered::new(surfaces[side], meshes[side].faces(), on_sphere[side].clone());
        let from = |side: usize, registered: &[Vector3]| {
            Registered::new(surfaces[side], meshes[side].faces(), registered.to_vec())
        };
        let there = Correspondence::new(from(0, &registered), onto(1), locations);
        let way_back = Correspondence::new(from(1, &back), onto(0), inverse);
        Ok(CurveRegistration {
            map: self.map(there, registered, there_error, there_figures),
            inverse: self.map(way_back, back, back_error, back_figures),
            curves: [curves.source.to_vec(), curves.target.to_vec()],
            spheres: [
                RoughSphere::new(meshes[0], &placement.source)?,
                RoughSphere::new(meshes[1], &placement.target)?,
            ],
            certificates,
            iterations: self.descents.iter().map(|descent| descent.energies.len() - 1).sum(),
            metrics: self.metrics,
            descents: self.descents,
            warnings,
            seconds: history.seconds(),
        })
    }

    /// The locations of the target's vertices on the source; those that rounding has lost are located on the sphere.
    fn inverse_locations(
        &self,
        [source, target]: [&TriangleMesh; 2],
        registered: &[Vector3],
        placement: &Placement,
    ) -> Vec<Location> {
        let locator = self.inverse.contains(&None).then(|| Locator::new(registered, source.faces()));
        let lost = |vertex: usize| {
            let locate = |locator: &Locator<'_>| locator.locate(placement.target[vertex]);
            locator.as_ref().map_or_else(Location::default, locate)
        };
        (0..target.n_vertices()).map(|vertex| self.inverse[vertex].unwrap_or_else(|| lost(vertex))).collect()
    }

    /// A direction of the map.
    fn map(
        &self,
        correspondence: Correspondence,
        registered: Vec<Vector3>,
        curve_error: Vec<f64>,
        distortion: Distortion,
    ) -> CurveMap {
        let missed: Vec<usize> =
            (0..curve_error.len()).filter(|&curve| curve_error[curve] > MISSED).collect();
        let status = self.status(&missed);
        let (registered, curve_error) = (from_vectors(registered), curve_error.into());
        CurveMap { correspondence, registered, curve_error, missed, status, distortion }
    }

    fn status(&self, missed: &[usize]) -> Status {
        let worst = |status| self.descents.iter().any(|descent| descent.status == status);
        match () {
            () if !missed.is_empty() => Status::LandmarksMissed,
            () if worst(Status::Cancelled) => Status::Cancelled,
            () if self.folded.is_empty() && self.between.is_some() => {
                self.between.unwrap_or(Status::Converged)
            }
            () if worst(Status::Stalled) || !self.folded.is_empty() => Status::Stalled,
            () if worst(Status::MaxIterations) => Status::MaxIterations,
            () => Status::Converged,
        }
    }

    fn certificates(&self, curve_error: &[f64]) -> Certificates {
        let all = &self.certificates;
        let total = |value: fn(&PieceCertificates) -> f64| all.iter().map(value).sum::<f64>();
        let most = |value: fn(&PieceCertificates) -> f64| all.iter().map(value).fold(0.0, f64::max);
        let residual =
            |surface: usize| self.metrics.iter().map(|metrics| metrics[surface].residual).fold(0.0, f64::max);
        Certificates {
            folded: self.folded.clone(),
            area: all.iter().map(|piece| piece.area).sum(),
            expected_area: all.iter().map(|piece| piece.expected_area).sum(),
            curve_error: curve_error.iter().copied().fold(0.0, f64::max),
            bank_error: self.bank_error,
            cocycle_error: most(|piece| piece.cocycle_error),
            outside: all.iter().map(|piece| piece.outside).sum(),
            energy_ratio: total(|piece| piece.energy) / total(|piece| piece.rest_energy),
            curvature: [residual(0), residual(1)],
        }
    }
}

/// Locations as points of the unit sphere.
fn interpolated(locations: &[Location], faces: &[[Vertex; 3]], on_sphere: &[Vector3]) -> Vec<Vector3> {
    parallel::map(locations.len(), |vertex| {
        let place = locations[vertex].point_on(on_sphere, faces);
        place.normalized()
    })
}

/// The largest distance of the images of a path's vertices from its partner.
fn strays(path: &[usize], partner: &[usize], locations: &[Location], target: &TriangleMesh) -> f64 {
    let segments: Vec<[Vector3; 2]> =
        partner.windows(2).map(|ends| [target.points()[ends[0]], target.points()[ends[1]]]).collect();
    let strays = |&vertex: &usize| {
        let image = locations[vertex].point_on(target.points(), target.faces());
        segments.iter().fold(f64::INFINITY, |least, &segment| least.min(to_segment(image, segment)))
    };
    path.iter().map(strays).fold(0.0, f64::max)
}

/// The distance of a point from a segment.
fn to_segment(x: Vector3, [from, to]: [Vector3; 2]) -> f64 {
    let along = to - from;
    let t = ((x - from).dot(along) / along.dot(along)).clamp(0.0, 1.0);
    x.distance(from + along * t)
}

/// The figures of a map of a surface into space.
pub(super) fn figures(
    mesh: &TriangleMesh,
    positions: &[Vector3],
    folded: Vec<usize>,
) -> Result<Distortion, Error> {
    distortion_in_space(mesh.points(), mesh.faces(), positions, folded, mesh.face_areas())
}
