// SPDX-License-Identifier: MIT OR Apache-2.0
//! Holes that are filled for the time of a registration, so that surfaces with different numbers of holes, and open and
//! closed ones, can be registered.
//!
//! A hole is filled by a smooth [membrane]. The filled surfaces are registered; the result is that of the given vertices
//! and faces. Where a vertex of the source comes to lie on a filling of the target, it has a position there and its data
//! from the nearest place of the surface.
//!
//! Cost: one sparse LU with some three unknowns per vertex of a hole.

use std::sync::Arc;

use ndarray::{Array2, ArrayView2, Axis, Slice, concatenate};

use super::Landmarks;
use super::features::Features;
use super::options::RegistrationOptions;
use super::result::Registration;
use crate::arrays::{rows, vectors};
use crate::control::Observer;
use crate::disk::DiskMap;
use crate::distortion::{Distortion, Image, measure};
use crate::error::{Error, Side};
use crate::filling::membrane;
use crate::mesh::{Surface, TriangleMesh, Vertex};
use crate::sphere::{SphereFilling, SphereMap};
use crate::vector::coordinates;

/// Which holes are filled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Filling {
    /// All boundary loops but the longest.
    Disks,
    /// All boundary loops.
    Spheres,
}

/// A registration by points, as [`register_disks`](super::register_disks).
type Register<Map> = fn(
    &Surface,
    &Surface,
    &Landmarks<'_>,
    &RegistrationOptions<'_>,
    &mut dyn Observer,
) -> Result<Registration<Map>, Error>;

impl Filling {
    /// The registration of two surfaces by that of the filled ones.
    ///
    /// # Errors
    /// Those of the registration.
    pub(super) fn registered<Map: OfGiven>(
        self,
        given: [&Surface; 2],
        landmarks: &Landmarks<'_>,
        options: &RegistrationOptions<'_>,
        observer: &mut dyn Observer,
        register: Register<Map>,
    ) -> Result<Registration<Map>, Error> {
        landmarks.check_range(given.map(Surface::n_vertices))?;
        let fill =
            |surface: &Surface, side| self.filled(surface).map_err(|error: Error| error.of_surface(side));
        let [source, target] = [fill(given[0], Side::Source)?, fill(given[1], Side::Target)?];
        let signals = options
            .features
            .map(|features| [source.extended(features.source), target.extended(features.target)]);
        let features = options.features.zip(signals.as_ref()).map(|(features, [ours, theirs])| Features {
            source: ours.view(),
            target: theirs.view(),
            ..features
        });
        let options = RegistrationOptions { features, fill_holes: false, ..*options };
        let mut observer = PreviewOfGiven { whole: observer, n_vertices: given[0].n_vertices() };
        let whole = register(&source.surface, &target.surface, landmarks, &options, &mut observer)?;
        if source.holes.is_empty() && target.holes.is_empty() {
            return Ok(whole);
        }
        whole.of_given(given)
    }

    /// A surface with its holes filled.
    fn filled(self, surface: &Surface) -> Result<Filled, Error> {
        let mesh = surface.mesh()?;
        let loops = match self {
            Self::Disks => mesh.boundary_loops().get(1..).unwrap_or_default(),
            Self::Spheres => mesh.boundary_loops(),
        };
        Ok(Filled::of(surface, mesh, loops))
    }
}

/// Passes on what a run on filled surfaces reports, previews without the vertices inside the holes.
pub(crate) struct PreviewOfGiven<'a> {
    pub whole: &'a mut dyn Observer,
    /// The number of the source's vertices as given, which come first.
    pub n_vertices: usize,
}

impl Observer for PreviewOfGiven<'_> {
    fn progress(&mut self, fraction: f64, message: &str) -> bool {
        self.whole.progress(fraction, message)
    }

    fn preview(&mut self, positions: &dyn Fn() -> Array2<f64>) {
        let n = self.n_vertices;
        self.whole.preview(&|| positions().slice_axis(Axis(0), Slice::from(..n)).to_owned());
    }
}

/// A surface with its holes filled; the given vertices and faces come first.
pub(crate) struct Filled {
    pub surface: Surface,
    pub holes: Vec<Hole>,
}

/// A filled hole: its boundary loop and the number of vertices inside.
pub(crate) struct Hole {
    rim: Vec<Vertex>,
    n_vertices: usize,
}

impl Filled {
    /// A surface, of this mesh, with the holes within some of its boundary loops filled.
    pub(crate) fn of<'a>(
        surface: &Surface,
        mesh: &TriangleMesh,
        loops: impl IntoIterator<Item = &'a Vec<Vertex>>,
    ) -> Self {
        let (mut points, mut faces) = (vectors(surface.vertices()), mesh.faces().to_vec());
        let mut holes = Vec::new();
        for hole in loops {
            let before = points.len();
            membrane(hole, &mut points, &mut faces);
            holes.push(Hole { rim: hole.clone(), n_vertices: points.len() - before });
        }
        if holes.is_empty() {
            return Self { surface: surface.clone(), holes };
        }
        Self { surface: Surface::of_checked_rows(coordinates(points), faces), holes }
    }

    /// Signals of the given vertices, (n, k), for the filled surface: each hole has the mean of its rim.
    pub(crate) fn extended(&self, signals: ArrayView2<'_, f64>) -> Array2<f64> {
        let mut extended = signals.to_owned();
        for hole in &self.holes {
            if hole.rim.iter().any(|vertex| vertex.index() >= signals.nrows()) {
                return signals.to_owned();
            }
            let rim: Vec<usize> = hole.rim.iter().map(|vertex| vertex.index()).collect();
            let mean = signals.select(Axis(0), &rim).mean_axis(Axis(0)).expect("a rim has vertices");
            let inside =
                mean.broadcast((hole.n_vertices, mean.len())).expect("one row per vertex").to_owned();
            extended = concatenate![Axis(0), extended, inside];
        }
        extended
    }
}

/// What a filled surface has for the given vertices and faces, which come first.
pub trait OfGiven: Clone {
    /// The part of the given surface, from a map of the one with the faces `filled`, as oriented.
    #[doc(hidden)]
    fn of_given(&self, given: &TriangleMesh, filled: &[[Vertex; 3]]) -> Result<Self, Error>;
}

impl OfGiven for DiskMap {
    fn of_given(&self, given: &TriangleMesh, filled: &[[Vertex; 3]]) -> Result<Self, Error> {
        let (uv, distortion) = part(&self.uv, given, &filled[..given.faces().len()])?;
        Ok(Self { uv, distortion, ..self.clone() })
    }
}

impl OfGiven for SphereMap {
    fn of_given(&self, given: &TriangleMesh, filled: &[[Vertex; 3]]) -> Result<Self, Error> {
        let n_faces = given.faces().len();
        let (positions, distortion) = part(&self.positions, given, &filled[..n_faces])?;
        let sizes = [given.n_vertices(), n_faces];
        let filling = SphereFilling::after(sizes, &self.positions, filled, &self.targets);
        let targets = self.targets[..n_faces].to_vec();
        Ok(Self { positions, distortion, targets, refinement: None, filling, ..self.clone() })
    }
}

/// The rows of the given vertices in the disk, (n, 2), or on the sphere, (n, 3), and their figures.
pub(crate) fn part(
    image: &Array2<f64>,
    given: &TriangleMesh,
    faces: &[[Vertex; 3]],
) -> Result<(Array2<f64>, Distortion), Error> {
    let part = image.slice_axis(Axis(0), Slice::from(..given.n_vertices())).to_owned();
    let distortion = if part.ncols() == 2 {
        measure(given.points(), faces, Image::Plane(rows(part.view())), given.face_areas())?
    } else {
        measure(given.points(), faces, Image::Sphere(&vectors(part.view())), given.face_areas())?
    };
    Ok((part, distortion))
}

impl<Map: OfGiven> Registration<Map> {
    /// The registration of two given surfaces, as this is that of the same with their holes filled.
    pub(super) fn of_given(self, given: [&Surface; 2]) -> Result<Self, Error> {
        let correspondence = self.correspondence.of_given(given);
        let [source, target] = [given[0].mesh()?, given[1].mesh()?];
        let [filled, target_filled] = self.correspondence.sides().map(|side| &side.faces[..]);
        let [faces, target_faces] = correspondence.sides().map(|side| &side.faces[..]);
        let (registered, distortion) = part(&self.registered, source, faces)?;
        let (target_registered, target_distortion) = part(&self.target_registered, target, target_faces)?;
        Ok(Self {
            registered,
            target_registered,
            distortion,
            target_distortion,
            source_map: self.source_map.of_given(source, filled)?,
            target_map: self.target_map.of_given(target, target_filled)?,
            landmark_error: self.landmark_error.clone(),
            missed: self.missed.clone(),
            off_boundary: self.off_boundary.clone(),
            landmarks: self.landmarks.clone(),
            original: None,
            correspondence,
            whole: Some(Arc::new(self.clone())),
            ..self
        })
    }
}
