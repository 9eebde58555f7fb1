// SPDX-License-Identifier: MIT OR Apache-2.0
//! Bindings of `authalic::registration`.

mod certificates;
mod curves;
mod found;
mod result;

use authalic::mesh::TriangleMesh;
use authalic::registration::{Landmarks, RegistrationOptions};
use authalic::{Error, Side, Vector3, registration};
use pyo3::prelude::*;

use crate::arrays::{Pairs, from_points, index_list, rows, vectors};
use crate::errors::{bad_array, bad_option};
use crate::run::run;
use crate::surface::{Given, handle};
pub use certificates::Certificates;
pub use curves::register_hyperbolic;
pub(crate) use curves::{choice, metrics, vertex_paths};
use found::{Found, Outcome, Surface};
pub use result::Registration;

/// Registers two disks: a map of the source onto the target that keeps areas and takes landmarks to
/// landmarks.
///
/// Both surfaces are mapped to the unit disk, the source's landmarks are carried onto the target's without
/// folding a face (Liu & Yueh 2023, section 6, by a descent of our own), and each vertex is looked up on the
/// target.
///
/// Parameters
/// ----------
/// source : Surface, or (vertices, faces)
///     (n, 3) real and (m, 3) integer array: a surface with one boundary loop and no handles.
/// target : Surface, or (vertices, faces)
///     Another, with (n_t, 3) and (m_t, 3).
/// source_landmarks : (k,) integer array
///     Vertices of the source, at least 1, none on the boundary.
/// target_landmarks : (k,) integer array
///     Their partners on the target, in the same order.
/// weight : float
///     λ > 0, the weight of the landmark penalty at the beginning; it grows tenfold until the landmarks meet.
/// angle_weight : float
///     λ ≥ 0, the weight of the angle distortion against that of areas in all maps, as in `disk_map`.
/// progress : callable(fraction, message) -> bool, optional
///     Called between iterations and in long steps from within; False cancels and returns the best map so
///     far.
///
/// Returns
/// -------
/// Registration
///     Its status is "landmarks_missed" where landmarks cannot be met without folding a face, and `missed`
///     says which.
///
/// Raises
/// ------
/// MeshError
///     A surface is no disk, an array does not fit, or landmarks are no pairs: unequal counts, repeated, out
///     of range, too few, on the boundary; nothing was computed.
/// ValueError
///     An option out of its range.
/// SolverError
///     A surface has no map without folds in double precision, or the call was cancelled before both had one.
///
/// Examples
/// --------
/// >>> import authalic
/// >>> pyramid = [[0, 0, 1], [1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]]
/// >>> faces = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]]
/// >>> flat = [[0, 0, 0], [1, 1, 0], [-1, 1, 0], [-1, -1, 0], [1, -1, 0]]
/// >>> result = authalic.register_disks(
/// ...     (pyramid, faces), (flat, faces), source_landmarks=(0,), target_landmarks=(0,)
/// ... )
/// >>> bool(abs(result.positions).min() < 1e-9), len(result.distortion.folded)
/// (True, 0)
#[pyfunction]
#[pyo3(signature = (source, target, *, source_landmarks, target_landmarks, weight=1.0, angle_weight=0.0,
                    progress=None))]
#[allow(clippy::too_many_arguments)] // keyword arguments of the Python function
pub fn register_disks(
    py: Python<'_>,
    source: &Bound<'_, PyAny>,
    target: &Bound<'_, PyAny>,
    source_landmarks: &Bound<'_, PyAny>,
    target_landmarks: &Bound<'_, PyAny>,
    weight: f64,
    angle_weight: f64,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Registration> {
    let options = RegistrationOptions { weight, angle_weight };
    let arguments = Arguments::new(source, target, source_landmarks, target_landmarks, options)?;
    let found = run(py, progress, move |observer| {
        arguments.register(|source, target, landmarks, options| {
            let found = registration::register_disks(source, target, landmarks, options, observer)?;
            Ok(Outcome::Disk(found))
        })
    })?;
    Registration::new(py, found)
}

/// Registers two closed surfaces: a map of the source onto the target that keeps areas and takes landmarks to
/// landmarks.
///
/// Both surfaces are mapped to the unit sphere, the landmarks of both are carried to the middle of each pair
/// without folding a face (Sutti & Yueh 2024, section 6.6, by a descent of our own), and each vertex is
/// looked up on the target.
///
/// Parameters
/// ----------
/// source : Surface, or (vertices, faces)
///     (n, 3) real and (m, 3) integer array: a closed surface without handles.
/// target : Surface, or (vertices, faces)
///     Another, with (n_t, 3) and (m_t, 3). One that is turned inside out beside the source is turned back.
/// source_landmarks : (k,) integer array
///     Vertices of the source, at least 2.
/// target_landmarks : (k,) integer array
///     Their partners on the target, in the same order.
/// weight : float
///     λ > 0, the weight of the landmark penalty at the beginning; it grows tenfold until the landmarks meet.
/// angle_weight : float
///     λ ≥ 0, the weight of the angle distortion against that of areas in all maps, as in `sphere_map`.
/// progress : callable(fraction, message) -> bool, optional
///     Called between iterations and in long steps from within; False cancels and returns the best map so
///     far.
///
/// Returns
/// -------
/// Registration
///     Its status is "landmarks_missed" where landmarks cannot be met without folding a face, and `missed`
///     says which.
///
/// Raises
/// ------
/// MeshError
///     A surface is no sphere, an array does not fit, or landmarks are no pairs: unequal counts, repeated,
///     out of range, too few; nothing was computed.
/// ValueError
///     An option out of its range.
/// SolverError
///     A surface has no map without folds in double precision, or the call was cancelled before both had one.
///
/// Examples
/// --------
/// >>> import authalic
/// >>> corners = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]
/// >>> mesh = corners, [[0, 1, 2], [0, 2, 3], [0, 3, 1], [3, 2, 1]]
/// >>> result = authalic.register_spheres(mesh, mesh, source_landmarks=[0, 1], target_landmarks=[0, 1])
/// >>> result.positions.round(6).tolist() == corners, len(result.distortion.folded)
/// (True, 0)
#[pyfunction]
#[pyo3(signature = (source, target, *, source_landmarks, target_landmarks, weight=1.0, angle_weight=0.0,
                    progress=None))]
#[allow(clippy::too_many_arguments)] // keyword arguments of the Python function
pub fn register_spheres(
    py: Python<'_>,
    source: &Bound<'_, PyAny>,
    target: &Bound<'_, PyAny>,
    source_landmarks: &Bound<'_, PyAny>,
    target_landmarks: &Bound<'_, PyAny>,
    weight: f64,
    angle_weight: f64,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Registration> {
    let options = RegistrationOptions { weight, angle_weight };
    let arguments = Arguments::new(source, target, source_landmarks, target_landmarks, options)?;
    let found = run(py, progress, move |observer| {
        arguments.register(|source, target, landmarks, options| {
            let found = registration::register_spheres(source, target, landmarks, options, observer)?;
            Ok(Outcome::Sphere(found))
        })
    })?;
    Registration::new(py, found)
}

/// The morph along a registration, from the source at t = 0 to its image on the target at t = 1.
///
/// Parameters
/// ----------
/// vertices : (n, 3) real array
///     The source's vertices. Or the source as a Surface.
/// registration : Registration
///     Where they go.
/// t : float
///     Any finite number; beyond 0 and 1 the morph goes on along the same lines.
/// align : bool
///     Move, turn and scale the image onto the source first (the best similarity by area), so that the shape
///     changes but does not travel.
///
/// Returns
/// -------
/// (n, 3) float64 array
///     (1 − t) v + t g(v).
///
/// Raises
/// ------
/// MeshError
///     An array that is not of shape (n, 3).
/// ValueError
///     A t that is not finite.
///
/// Examples
/// --------
/// >>> import authalic
/// >>> corners = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]
/// >>> faces = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [3, 2, 1]]
/// >>> large = [[3 * x for x in corner] for corner in corners]
/// >>> found = authalic.register_spheres(
/// ...     (corners, faces), (large, faces), source_landmarks=[0, 1], target_landmarks=[0, 1]
/// ... )
/// >>> authalic.homotopy(corners, found, 0.5).max().round(6).item()
/// 2.0
#[pyfunction]
#[pyo3(signature = (vertices, registration, t, *, align=false))]
pub fn homotopy(
    py: Python<'_>,
    vertices: &Bound<'_, PyAny>,
    registration: &Registration,
    t: f64,
    align: bool,
) -> PyResult<Pairs> {
    let found = registration.found.clone();
    let (vertices, n) = (vertices_of(vertices)?, found.positions.len());
    if vertices.len() != n {
        let (shape, expected) = (format!("of shape ({}, 3)", vertices.len()), format!("of shape ({n}, 3)"));
        return Err(bad_array(py, "vertices", shape, expected));
    }
    if !t.is_finite() {
        return Err(bad_option(format!("t must be a finite number, but is {t}")));
    }
    let morphed = run(py, None, move |_| Ok(found.morphed(&vertices, t, align)))?;
    Ok(from_points(py, &morphed))
}

/// Vertices, or those of a surface.
fn vertices_of(object: &Bound<'_, PyAny>) -> PyResult<Vec<Vector3>> {
    match handle(object) {
        Some(surface) => Ok(rows(surface.vertices()).iter().copied().map(Vector3).collect()),
        None => vectors(object, "vertices"),
    }
}

/// The arguments of a registration as plain data.
struct Arguments {
    source: Given,
    target: Given,
    source_landmarks: Vec<usize>,
    target_landmarks: Vec<usize>,
    options: RegistrationOptions,
}

impl Arguments {
    fn new(
        source: &Bound<'_, PyAny>,
        target: &Bound<'_, PyAny>,
        source_landmarks: &Bound<'_, PyAny>,
        target_landmarks: &Bound<'_, PyAny>,
        options: RegistrationOptions,
    ) -> PyResult<Self> {
        let source = Given::pair(source, SOURCE)?;
        let target = Given::pair(target, TARGET)?;
        let source_landmarks = index_list(source_landmarks, "source_landmarks", "pair", source.n_vertices())?;
        let target_landmarks = index_list(target_landmarks, "target_landmarks", "pair", target.n_vertices())?;
        Ok(Self { source, target, source_landmarks, target_landmarks, options })
    }

    /// Checks the meshes and registers them.
    fn register(
        self,
        register: impl FnOnce(
            &TriangleMesh,
            &TriangleMesh,
            &Landmarks<'_>,
            &RegistrationOptions,
        ) -> Result<Outcome, Error>,
    ) -> Result<Found, Error> {
        let (source, target) = (checked(self.source, Side::Source)?, checked(self.target, Side::Target)?);
        let landmarks = Landmarks { source: &self.source_landmarks, target: &self.target_landmarks };
        let outcome = register(source.mesh()?, target.mesh()?, &landmarks, &self.options)?;
        found(&source, &target, outcome)
    }
}

/// The names of a surface, of its vertices and of its faces in messages.
const SOURCE: [&str; 3] = ["source", "source vertices", "source faces"];
const TARGET: [&str; 3] = ["target", "target vertices", "target faces"];

/// A surface that is a mesh; errors say which surface is at fault.
fn checked(given: Given, side: Side) -> Result<authalic::Surface, Error> {
    let surface = given.surface().map_err(|error| error.of_surface(side))?;
    surface.mesh().map_err(|error| error.of_surface(side))?;
    Ok(surface)
}

/// An outcome with the surfaces as given and as oriented.
fn found(source: &authalic::Surface, target: &authalic::Surface, outcome: Outcome) -> Result<Found, Error> {
    let kept = |surface: &authalic::Surface, faces: &[_]| Surface {
        vertices: rows(surface.vertices()).to_vec(),
        given: rows(surface.faces()).to_vec(),
        faces: faces.to_vec(),
    };
    let target_faces = found::either!(&outcome, found => found.target_faces.clone());
    let surfaces = (kept(source, source.mesh()?.faces()), kept(target, &target_faces));
    Ok(Found::new(surfaces.0.into(), surfaces.1.into(), outcome))
}
