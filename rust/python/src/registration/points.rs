// SPDX-License-Identifier: MIT OR Apache-2.0
//! Bindings of the registrations by points.

use authalic::{Energy, Error, Landmarks, Observer, RegistrationOptions, RepairOptions, Side, Surface};
use pyo3::prelude::*;

use super::features::{GivenFeatures, numbers};
use super::finished::{Finished, Outcome};
use super::result::Registration;
use super::surfaces::{Pair, SOURCE, TARGET};
use crate::indices::index_list;
use crate::memory;
use crate::options::choice;
use crate::provenance::options;
use crate::run::run_with_preview;
use crate::surface::Given;

/// Registers two disks by landmarks.
///
/// The result is a one-to-one map of the source onto the target, boundary onto boundary. It keeps shapes, or with
/// `energy="area"` areas, and takes landmarks to landmarks.
///
/// Both surfaces are mapped to the unit disk, the source's landmarks are carried onto the target's without folding a
/// face (Liu & Yueh 2023, section 6, by a descent of our own), and each vertex is located on the target.
///
/// Parameters
/// ----------
/// source : Surface, or (vertices, faces)
///     (n, 3) real and (m, 3) int array: a surface with one boundary loop and no handles.
/// target : Surface, or (vertices, faces)
///     (n_t, 3) real and (m_t, 3) int array: such a surface.
/// source_landmarks : (k,) int array
///     Vertices of the source, at least 1, none on the boundary.
/// target_landmarks : (k,) int array
///     Their partners on the target, in the same order.
/// energy : "surface" or "area"
///     What the map keeps: areas and angles, measured in space between the two surfaces, from a map that keeps angles
///     on; or areas alone, as in the paper. Default "surface": areas alone do not say where what lies between landmarks
///     goes.
/// weight : float
///     Initial weight λ > 0 of the landmark penalty, which grows tenfold until the landmarks meet.
/// area_weight : float
///     With "surface" the exponent ≥ 0 of the area factor (d + 1/d)/2 of each face, d = σ₁ σ₂ with the singular values
///     of the map of the face.
/// angle_weight : float, optional
///     With "surface" the exponent ≥ 0 of the angle factor (σ₁/σ₂ + σ₂/σ₁)/2 of each face, by default 1: with both 1 the
///     product is the symmetric Dirichlet energy over 4. With "area" λ ≥ 0, the weight of the angle distortion against
///     that of the areas in all maps, as in `disk_map`, by default 0.
/// weights : (k,) real array, optional
///     How strongly each pair pulls, > 0: times the squared distance on the target over the target's area, against the
///     energy of a face averaged over the source. Infinite: exact. Default: all exact, as with "area" all must be.
/// features : (source_values, target_values), optional
///     (n,) or (n, k) and (n_t,) or (n_t, k) real arrays: any signals that should agree through the map, as curvature or
///     painted weights; only with "surface". Each is centered, and scaled by the standard deviation common to both.
/// feature_weight : float or (k,) real array, optional
///     How strongly the features pull, ≥ 0, all alike or each its own: a squared difference of one standard deviation
///     costs this much, against the energy of a face. Default 1.
/// position_weight : float
///     How strongly every vertex is pulled to its own position, ≥ 0, after the similarity that brings the source nearest
///     to its image: for bodies in like poses; only with "surface".
/// fill_holes : bool
///     Fill all boundary loops but the longest of either surface for the time of the call, so that both may have
///     different numbers of holes. The result is that of the given vertices; `in_holes` has those of the source that come
///     to lie on a filling of the target.
/// repair : bool
///     Repair both surfaces first, as the function `repair` does: their largest pieces, without pinholes and handles of
///     noise, with their longest boundary loops. The registration is then that of `source_repaired` and `target_repaired`, while landmarks and
///     features are those of the vertices given. Default False.
/// progress : callable(fraction, message) -> bool, optional
///     Called between iterations and within long steps; False cancels and returns the best map so far.
/// preview : callable(positions), optional
///     Called after each step of the descent between the surfaces with the (n, 3) float64 images so far of the source's
///     vertices on the target.
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
///     range or on the boundary; weights or features do not fit. Nothing is computed.
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
#[pyo3(signature = (source, target, *, source_landmarks, target_landmarks, energy="surface", weight=1.0, area_weight=1.0,
                    angle_weight=None, weights=None, features=None, feature_weight=None, position_weight=0.0,
                    fill_holes=false, repair=false, progress=None, preview=None))]
#[allow(clippy::too_many_arguments)] // keyword arguments of the Python function
pub fn register_disks(
    py: Python<'_>,
    source: &Bound<'_, PyAny>,
    target: &Bound<'_, PyAny>,
    source_landmarks: &Bound<'_, PyAny>,
    target_landmarks: &Bound<'_, PyAny>,
    energy: &str,
    weight: f64,
    area_weight: f64,
    angle_weight: Option<f64>,
    weights: Option<&Bound<'_, PyAny>>,
    features: Option<&Bound<'_, PyAny>>,
    feature_weight: Option<&Bound<'_, PyAny>>,
    position_weight: f64,
    fill_holes: bool,
    repair: bool,
    progress: Option<&Bound<'_, PyAny>>,
    preview: Option<&Bound<'_, PyAny>>,
) -> PyResult<Py<Registration>> {
    let kept = options!(
        py; source_landmarks, target_landmarks, energy, weight, area_weight, angle_weight, weights, features,
        feature_weight, position_weight, fill_holes, repair
    )?;
    let energy = choice("energy", energy, &ENERGIES)?;
    let options = RegistrationOptions {
        energy,
        weight,
        area_weight,
        angle_weight,
        position_weight,
        fill_holes,
        ..Default::default()
    };
    let arguments = Arguments::new(
        [source, target],
        [Some(source_landmarks), Some(target_landmarks)],
        [weights, features, feature_weight],
        options,
    )?;
    arguments.require_memory_for_maps(py)?;
    let repair = repair.then(|| RepairOptions::for_a_map(true));
    let outcome = run_with_preview(py, progress, preview, move |observer| {
        arguments.register(repair, (authalic::register_disks, Finished::Disk), observer)
    })?;
    let call = outcome.call("register_disks", &kept);
    Registration::new(py, outcome, call)
}

/// Registers two closed surfaces by landmarks or features.
///
/// The result is a one-to-one map of the source onto the target. It keeps shapes, or with `energy="area"` areas, and
/// takes landmarks to landmarks.
///
/// Both surfaces are mapped to the unit sphere, the landmarks of both are carried to the middle of each pair without
/// folding a face (Sutti & Yueh 2024, section 6.6, by a descent of our own), and each vertex is located on the target.
///
/// Parameters
/// ----------
/// source : Surface, or (vertices, faces)
///     (n, 3) real and (m, 3) int array: a closed surface without handles.
/// target : Surface, or (vertices, faces)
///     (n_t, 3) real and (m_t, 3) int array: such a surface. If it is inside out beside the source, it is turned.
/// source_landmarks : (k,) int array, optional
///     Vertices of the source, at least 2; with `features` any number.
/// target_landmarks : (k,) int array, optional
///     Their partners on the target, in the same order.
/// energy : "surface" or "area"
///     What the map keeps: areas and angles, measured in space between the two surfaces, from a map that keeps angles
///     on; or areas alone, as in the paper. Default "surface": areas alone do not say where what lies between landmarks
///     goes.
/// weight : float
///     Initial weight λ > 0 of the landmark penalty, which grows tenfold until the landmarks meet.
/// area_weight : float
///     With "surface" the exponent ≥ 0 of the area factor (d + 1/d)/2 of each face, d = σ₁ σ₂ with the singular values
///     of the map of the face.
/// angle_weight : float, optional
///     With "surface" the exponent ≥ 0 of the angle factor (σ₁/σ₂ + σ₂/σ₁)/2 of each face, by default 1: with both 1 the
///     product is the symmetric Dirichlet energy over 4. With "area" λ ≥ 0, the weight of the angle distortion against
///     that of the areas in all maps, as in `sphere_map`, by default 0.
/// weights : (k,) real array, optional
///     How strongly each pair pulls, > 0: times the squared distance on the target over the target's area, against the
///     energy of a face averaged over the source. Infinite: exact. Default: all exact, as with "area" all must be.
/// features : (source_values, target_values), optional
///     (n,) or (n, k) and (n_t,) or (n_t, k) real arrays: any signals that should agree through the map, as curvature or
///     painted weights; only with "surface". Each is centered, and scaled by the standard deviation common to both.
/// feature_weight : float or (k,) real array, optional
///     How strongly the features pull, ≥ 0, all alike or each its own: a squared difference of one standard deviation
///     costs this much, against the energy of a face. Default 1.
/// position_weight : float
///     How strongly every vertex is pulled to its own position, ≥ 0, after the similarity that brings the source nearest
///     to its image: for bodies in like poses; only with "surface".
/// fill_holes : bool
///     Fill all boundary loops of either surface for the time of the call, so that open surfaces can be registered. The
///     result is that of the given vertices; `in_holes` has those of the source that come to lie on a filling of the
///     target.
/// repair : bool
///     Repair both surfaces first, as the function `repair` does: their largest pieces, without pinholes and handles of
///     noise. The registration is then that of `source_repaired` and `target_repaired`, while landmarks and
///     features are those of the vertices given. Default False.
/// progress : callable(fraction, message) -> bool, optional
///     Called between iterations and within long steps; False cancels and returns the best map so far.
/// preview : callable(positions), optional
///     Called after each step of the descent between the surfaces with the (n, 3) float64 images so far of the source's
///     vertices on the target.
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
///     of range; weights or features do not fit. Nothing is computed.
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
#[pyo3(signature = (source, target, *, source_landmarks=None, target_landmarks=None, energy="surface", weight=1.0,
                    area_weight=1.0, angle_weight=None, weights=None, features=None, feature_weight=None,
                    position_weight=0.0, fill_holes=false, repair=false, progress=None, preview=None))]
#[allow(clippy::too_many_arguments)] // keyword arguments of the Python function
pub fn register_spheres(
    py: Python<'_>,
    source: &Bound<'_, PyAny>,
    target: &Bound<'_, PyAny>,
    source_landmarks: Option<&Bound<'_, PyAny>>,
    target_landmarks: Option<&Bound<'_, PyAny>>,
    energy: &str,
    weight: f64,
    area_weight: f64,
    angle_weight: Option<f64>,
    weights: Option<&Bound<'_, PyAny>>,
    features: Option<&Bound<'_, PyAny>>,
    feature_weight: Option<&Bound<'_, PyAny>>,
    position_weight: f64,
    fill_holes: bool,
    repair: bool,
    progress: Option<&Bound<'_, PyAny>>,
    preview: Option<&Bound<'_, PyAny>>,
) -> PyResult<Py<Registration>> {
    let kept = options!(
        py; source_landmarks, target_landmarks, energy, weight, area_weight, angle_weight, weights, features,
        feature_weight, position_weight, fill_holes, repair
    )?;
    let energy = choice("energy", energy, &ENERGIES)?;
    let options = RegistrationOptions {
        energy,
        weight,
        area_weight,
        angle_weight,
        position_weight,
        fill_holes,
        ..Default::default()
    };
    let arguments = Arguments::new(
        [source, target],
        [source_landmarks, target_landmarks],
        [weights, features, feature_weight],
        options,
    )?;
    if arguments.options.energy == Energy::Area {
        arguments.require_memory_for_maps(py)?;
    }
    let repair = repair.then(|| RepairOptions::for_a_map(false));
    let outcome = run_with_preview(py, progress, preview, move |observer| {
        arguments.register(repair, (authalic::register_spheres, Finished::Sphere), observer)
    })?;
    let call = outcome.call("register_spheres", &kept);
    Registration::new(py, outcome, call)
}

/// The energies, by name.
const ENERGIES: [(&str, Energy); 2] = [("area", Energy::Area), ("surface", Energy::Surface)];

/// The arguments of a registration as plain data.
struct Arguments {
    source: Given,
    target: Given,
    source_landmarks: Vec<usize>,
    target_landmarks: Vec<usize>,
    weights: Option<Vec<f64>>,
    features: Option<GivenFeatures>,
    options: RegistrationOptions<'static>,
}

impl Arguments {
    /// Refuses surfaces for whose maps, one after the other, there is no memory.
    fn require_memory_for_maps(&self, py: Python<'_>) -> PyResult<()> {
        memory::check(py, memory::MAP, self.source.n_vertices().max(self.target.n_vertices()))
    }

    fn new(
        [source, target]: [&Bound<'_, PyAny>; 2],
        [source_landmarks, target_landmarks]: [Option<&Bound<'_, PyAny>>; 2],
        [weights, features, feature_weight]: [Option<&Bound<'_, PyAny>>; 3],
        options: RegistrationOptions<'static>,
    ) -> PyResult<Self> {
        let py = source.py();
        let source = Given::pair(source, SOURCE)?;
        let target = Given::pair(target, TARGET)?;
        memory::check(py, memory::REGISTRATION, source.n_vertices() + target.n_vertices())?;
        let list = |landmarks: Option<&Bound<'_, PyAny>>, name, n_vertices| {
            landmarks
                .map_or_else(|| Ok(Vec::new()), |landmarks| index_list(landmarks, name, "pair", n_vertices))
        };
        let source_landmarks = list(source_landmarks, "source_landmarks", source.n_vertices())?;
        let target_landmarks = list(target_landmarks, "target_landmarks", target.n_vertices())?;
        let weights = weights.map(|weights| numbers(weights, "weights")).transpose()?;
        let features = GivenFeatures::new(features, feature_weight)?;
        Ok(Self { source, target, source_landmarks, target_landmarks, weights, features, options })
    }

    /// Repairs the surfaces if asked for, checks them and registers them.
    fn register<T>(
        self,
        repair: Option<RepairOptions>,
        (register, finished): (Register<T>, fn(T) -> Finished),
        observer: &mut dyn Observer,
    ) -> Result<Outcome, Error> {
        let pair = Pair::new([self.source, self.target], repair.as_ref())?;
        let source_landmarks = pair.source.landmarks(Side::Source, self.source_landmarks)?;
        let target_landmarks = pair.target.landmarks(Side::Target, self.target_landmarks)?;
        let features = self.features.map(|features| features.prepared(&pair)).transpose()?;
        let landmarks = Landmarks { source: &source_landmarks, target: &target_landmarks };
        let options = RegistrationOptions {
            weights: self.weights.as_deref(),
            features: features.as_ref().map(GivenFeatures::view),
            ..self.options
        };
        pair.registered(|pair| {
            let surfaces = [&pair.source.surface, &pair.target.surface];
            register(surfaces[0], surfaces[1], &landmarks, &options, observer).map(finished)
        })
    }
}

/// A function of the core that registers by points.
type Register<T> =
    fn(&Surface, &Surface, &Landmarks<'_>, &RegistrationOptions<'_>, &mut dyn Observer) -> Result<T, Error>;
