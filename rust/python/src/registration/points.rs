// SPDX-License-Identifier: MIT OR Apache-2.0
//! Bindings of the registrations by points.

use authalic::{Error, Landmarks, Observer, RegistrationOptions, Side, Surface};
use pyo3::prelude::*;

use super::finished::Finished;
use super::result::Registration;
use super::surfaces::{SOURCE, TARGET, checked};
use crate::indices::index_list;
use crate::run::run;
use crate::surface::Given;

/// Registers two disks: a map of the source onto the target that preserves areas and takes landmarks to landmarks.
///
/// Both surfaces are mapped to the unit disk, the source's landmarks are carried onto the target's without folding a
/// face (Liu & Yueh 2023, section 6, by a descent of our own), and each vertex is located on the target.
///
/// Parameters
/// ----------
/// source : Surface, or (vertices, faces)
///     (n, 3) real and (m, 3) integer array: a surface with one boundary loop and no handles.
/// target : Surface, or (vertices, faces)
///     (n_t, 3) real and (m_t, 3) integer array: such a surface.
/// source_landmarks : (k,) integer array
///     Vertices of the source, at least 1, none on the boundary.
/// target_landmarks : (k,) integer array
///     Their partners on the target, in the same order.
/// weight : float
///     λ > 0, the initial weight of the landmark penalty; it grows tenfold until the landmarks meet.
/// angle_weight : float
///     λ ≥ 0, the weight of the angle distortion against that of the areas in all maps, as in `disk_map`.
/// progress : callable(fraction, message) -> bool, optional
///     Called between iterations and within long steps; False cancels and returns the best map so far.
///
/// Returns
/// -------
/// Registration
///     Its status is "landmarks_missed" if some landmarks cannot meet without folding a face; `missed` has these.
///
/// Raises
/// ------
/// MeshError
///     A surface is no disk, an array does not fit, or the landmarks are unequal in number, too few, repeated, out of
///     range or on the boundary. Nothing is computed.
/// ValueError
///     An option is out of its range.
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
    let finished = run(py, progress, move |observer| {
        arguments.register(authalic::register_disks, observer).map(Finished::Disk)
    })?;
    Registration::new(py, finished)
}

/// Registers two closed surfaces: a map of the source onto the target that preserves areas and takes landmarks to
/// landmarks.
///
/// Both surfaces are mapped to the unit sphere, the landmarks of both are carried to the middle of each pair without
/// folding a face (Sutti & Yueh 2024, section 6.6, by a descent of our own), and each vertex is located on the target.
///
/// Parameters
/// ----------
/// source : Surface, or (vertices, faces)
///     (n, 3) real and (m, 3) integer array: a closed surface without handles.
/// target : Surface, or (vertices, faces)
///     (n_t, 3) real and (m_t, 3) integer array: such a surface. If it is inside out beside the source, it is turned.
/// source_landmarks : (k,) integer array
///     Vertices of the source, at least 2.
/// target_landmarks : (k,) integer array
///     Their partners on the target, in the same order.
/// weight : float
///     λ > 0, the initial weight of the landmark penalty; it grows tenfold until the landmarks meet.
/// angle_weight : float
///     λ ≥ 0, the weight of the angle distortion against that of the areas in all maps, as in `sphere_map`.
/// progress : callable(fraction, message) -> bool, optional
///     Called between iterations and within long steps; False cancels and returns the best map so far.
///
/// Returns
/// -------
/// Registration
///     Its status is "landmarks_missed" if some landmarks cannot meet without folding a face; `missed` has these.
///
/// Raises
/// ------
/// MeshError
///     A surface is no sphere, an array does not fit, or the landmarks are unequal in number, too few, repeated or out
///     of range. Nothing is computed.
/// ValueError
///     An option is out of its range.
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
    let finished = run(py, progress, move |observer| {
        arguments.register(authalic::register_spheres, observer).map(Finished::Sphere)
    })?;
    Registration::new(py, finished)
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

    /// Checks the surfaces and registers them.
    fn register<T>(self, register: Register<T>, observer: &mut dyn Observer) -> Result<T, Error> {
        let (source, target) = (checked(self.source, Side::Source)?, checked(self.target, Side::Target)?);
        let landmarks = Landmarks { source: &self.source_landmarks, target: &self.target_landmarks };
        register(&source, &target, &landmarks, &self.options, observer)
    }
}

/// A function of the core that registers by points.
type Register<T> =
    fn(&Surface, &Surface, &Landmarks<'_>, &RegistrationOptions, &mut dyn Observer) -> Result<T, Error>;
