// SPDX-License-Identifier: MIT OR Apache-2.0
//! Bindings of the registration by curves.

use authalic::{HarmonicSolver, HyperbolicEnergy, HyperbolicOptions, LandmarkCurves, RepairOptions, Side};
use pyo3::prelude::*;

use super::features::GivenFeatures;
use super::finished::Finished;
use super::result::Registration;
use super::surfaces::{Pair, SOURCE, TARGET, vertex_paths};
use crate::arrays::real_table;
use crate::errors::bad_option;
use crate::memory;
use crate::options::{choice, metrics, parse_iterations};
use crate::provenance::options;
use crate::run::run_with_preview;
use crate::surface::Given;

/// Registers two surfaces of genus 0 by landmark curves.
///
/// The result is a one-to-one map of the source onto the target that takes curve to curve.
///
/// Both surfaces are sliced along the curves and given the hyperbolic metric in which all slits and boundary loops are
/// geodesics. The hyperbolic harmonic map between them (Shi et al. 2013, by Newton's method) is a homeomorphism
/// whatever the curves are; `certificates` prove it.
///
/// Parameters
/// ----------
/// source : Surface, or (vertices, faces)
///     (n, 3) real and (m, 3) int array: one component without handles, closed or with boundary loops.
/// target : Surface, or (vertices, faces)
///     (n_t, 3) real and (m_t, 3) int array: a surface with as many boundary loops, unless `fill_holes`.
/// source_curves : list of (k,) int arrays
///     Disjoint paths of vertices along edges of the source, each of at least two edges. Open curves are matched from
///     start to end by shares of their length. Curves are closed if the first vertex is repeated at the end, or if an
///     edge joins the last vertex (of at least 16) to the first; they have neither start nor direction. Boundary loops
///     need not be given.
/// target_curves : list of (k,) int arrays
///     Their partners on the target, in the same order.
/// energy : "surface" or "harmonic"
///     What the map keeps: areas and angles, measured in space between the two surfaces, from the harmonic map on, with
///     the curves where they are; or the harmonic energy alone, as in the paper. Default "surface".
/// area_weight : float
///     With "surface" the exponent ≥ 0 of the area factor of each face, as in `register_spheres`.
/// angle_weight : float
///     With "surface" the exponent ≥ 0 of the angle factor of each face.
/// features : (source_values, target_values), optional
///     (n,) or (n, k) and (n_t,) or (n_t, k) real arrays: signals that should agree through the map, as in
///     `register_spheres`; only with "surface".
/// feature_weight : float or (k,) real array, optional
///     How strongly the features pull, ≥ 0, all alike or each its own. Default 1.
/// position_weight : float
///     How strongly every vertex is pulled to its own position, ≥ 0, as in `register_spheres`; only with "surface".
/// fill_holes : bool
///     Fill all boundary loops, but those along which a curve and its partner run, for the time of the call: for
///     surfaces with different numbers of holes. Curves may meet the holes that are filled. The result is that of the
///     given vertices, with `in_holes` as of `register_spheres`; the certificates are those of the filled surfaces.
/// repair : bool
///     Repair both surfaces first, as the function `repair` does: their largest pieces, without pinholes and handles of
///     noise. The registration is then that of `source_repaired` and `target_repaired`, while curves and
///     features are those of the vertices given. Default False.
/// metric : "newton" or "ricci_flow"
///     The method for the hyperbolic metrics: Newton's, or the paper's Ricci flow (slow, then finished by Newton's).
/// solver : "newton" or "heat"
///     The method that minimizes the harmonic energy: Newton's, or the paper's heat diffusion (slow; on all but small
///     meshes it ends with "max_iterations").
/// max_iterations : int, optional
///     Most steps of the heat diffusion. Default 2000.
/// tolerance : float, optional
///     Largest component of the gradient at which the heat diffusion ends. Default 1e-6.
/// source_sphere : (n, 3) real array, optional
///     The source on a sphere around the origin, which lays the surfaces over each other. Default: a conformal map.
/// target_sphere : (n_t, 3) real array, optional
///     The target on such a sphere; give both or neither. They need not be aligned.
/// progress : callable(fraction, message) -> bool, optional
///     Called between steps and within long ones; False cancels.
/// preview : callable(positions), optional
///     Called after each step of the descent between the surfaces with the (n, 3) float64 images so far of the source's
///     vertices on the target.
///
/// Returns
/// -------
/// Registration
///     With `certificates`, `warnings` and `energies`. The domain of `registered` and `target_registered` is a rough
///     map of the target to the unit sphere.
///
/// Raises
/// ------
/// MeshError
///     A surface has another topology, an array does not fit, or curves are no simple edge paths, are too short, touch
///     each other or the boundary, or do not pair up. Nothing is computed.
/// ValueError
///     An option is out of its range.
/// SolverError
///     Double precision did not suffice, or the call was cancelled: only the last step yields a map without folds.
///
/// Examples
/// --------
/// >>> import authalic, numpy as np
/// >>> t = np.linspace(0, 2 * np.pi, 24, endpoint=False)
/// >>> z = np.linspace(-0.9, 0.9, 13)
/// >>> rings = [[(1 - h * h) ** 0.5 * np.cos(a), (1 - h * h) ** 0.5 * np.sin(a), h] for h in z for a in t]
/// >>> faces = [f for i in range(12) for j in range(24) for a, b in ((24 * i + j, 24 * i + (j + 1) % 24),)
/// ...          for f in ((a, b, b + 24), (a, b + 24, a + 24))]
/// >>> band = rings, faces
/// >>> curves = [[76, 100, 124, 148], [88, 112, 136, 160, 184]]
/// >>> result = authalic.register_hyperbolic(band, band, source_curves=curves, target_curves=curves)
/// >>> len(result.certificates.folded), bool(abs(result.positions - rings).max() < 0.05)
/// (0, True)
#[pyfunction]
#[pyo3(signature = (source, target, *, source_curves, target_curves, energy="surface", area_weight=1.0,
                    angle_weight=1.0, features=None, feature_weight=None, position_weight=0.0,
                    fill_holes=false, repair=false, metric="newton", solver="newton", max_iterations=None, tolerance=None,
                    source_sphere=None, target_sphere=None, progress=None, preview=None))]
#[allow(clippy::too_many_arguments)] // keyword arguments of the Python function
pub fn register_hyperbolic(
    py: Python<'_>,
    source: &Bound<'_, PyAny>,
    target: &Bound<'_, PyAny>,
    source_curves: &Bound<'_, PyAny>,
    target_curves: &Bound<'_, PyAny>,
    energy: &str,
    area_weight: f64,
    angle_weight: f64,
    features: Option<&Bound<'_, PyAny>>,
    feature_weight: Option<&Bound<'_, PyAny>>,
    position_weight: f64,
    fill_holes: bool,
    repair: bool,
    metric: &str,
    solver: &str,
    max_iterations: Option<i64>,
    tolerance: Option<f64>,
    source_sphere: Option<&Bound<'_, PyAny>>,
    target_sphere: Option<&Bound<'_, PyAny>>,
    progress: Option<&Bound<'_, PyAny>>,
    preview: Option<&Bound<'_, PyAny>>,
) -> PyResult<Py<Registration>> {
    let kept = options!(
        py; source_curves, target_curves, energy, area_weight, angle_weight, features, feature_weight, position_weight,
        fill_holes, repair, metric, solver, max_iterations, tolerance, source_sphere, target_sphere
    )?;
    let mut options = HyperbolicOptions {
        energy: choice("energy", energy, &ENERGIES)?,
        area_weight,
        angle_weight,
        position_weight,
        fill_holes,
        metric: choice("metric", metric, &metrics())?,
        solver: choice("solver", solver, &SOLVERS)?,
        ..Default::default()
    };
    options.heat_steps = max_iterations.map(parse_iterations).transpose()?.unwrap_or(options.heat_steps);
    options.heat_tolerance = tolerance.unwrap_or(options.heat_tolerance);
    let source = Given::pair(source, SOURCE)?;
    let target = Given::pair(target, TARGET)?;
    memory::check(py, memory::CURVES, source.n_vertices() + target.n_vertices())?;
    let source_curves = vertex_paths(source_curves, "source_curves", source.n_vertices())?;
    let target_curves = vertex_paths(target_curves, "target_curves", target.n_vertices())?;
    if repair && (source_sphere.is_some() || target_sphere.is_some()) {
        return Err(bad_option(
            "source_sphere and target_sphere must be left out with repair=True: they have rows for other vertices; \
             call repair first"
                .into(),
        ));
    }
    let spheres = match (source_sphere, target_sphere) {
        (None, None) => None,
        (Some(source), Some(target)) => {
            Some([real_table::<3>(source, "source_sphere")?, real_table::<3>(target, "target_sphere")?])
        }
        _ => {
            return Err(bad_option(
                "source_sphere and target_sphere go together: give both or neither".into(),
            ));
        }
    };
    let features = GivenFeatures::new(features, feature_weight)?;
    let repair = repair.then(|| RepairOptions::for_a_map(false));
    let outcome = run_with_preview(py, progress, preview, move |observer| {
        let pair = Pair::new([source, target], repair.as_ref())?;
        let source_curves = pair.source.curves(Side::Source, source_curves)?;
        let target_curves = pair.target.curves(Side::Target, target_curves)?;
        let curves = LandmarkCurves { source: &source_curves, target: &target_curves };
        let spheres = spheres.as_ref().map(|[source, target]| [source.view(), target.view()]);
        let features = features.map(|features| features.prepared(&pair)).transpose()?;
        let features = features.as_ref().map(GivenFeatures::view);
        let options = HyperbolicOptions { spheres, features, ..options };
        pair.registered(|pair| {
            let surfaces = [&pair.source.surface, &pair.target.surface];
            let registration =
                authalic::register_hyperbolic(surfaces[0], surfaces[1], &curves, &options, observer)?;
            Ok(Finished::Curves(registration.into()))
        })
    })?;
    let call = outcome.call("register_hyperbolic", &kept);
    Registration::new(py, outcome, call)
}

/// The energies, by name.
const ENERGIES: [(&str, HyperbolicEnergy); 2] =
    [("harmonic", HyperbolicEnergy::Harmonic), ("surface", HyperbolicEnergy::Surface)];

/// The methods for the harmonic map, by name.
const SOLVERS: [(&str, HarmonicSolver); 2] =
    [("newton", HarmonicSolver::Newton), ("heat", HarmonicSolver::Heat)];
