// SPDX-License-Identifier: MIT OR Apache-2.0
//! Area-preserving maps of closed surfaces of genus 0 onto the unit sphere.
//!
//! [`sphere_map`] is the entry. The default is guarded Gauss–Newton, our own. The papers' methods (Sutti &
//! Yueh 2024): a spherical conformal start, the fixed-point iteration of the stretch energy (Algorithm 2),
//! Riemannian gradient descent (Algorithm 1), and the bijectivity correction by mean-value weights. They
//! cannot promise an unfolded map, so where the correction does not suffice the run is repeated from a map
//! without folds and never leaves it. Every result is checked by exact predicates.
//!
//! Input: a [`TriangleMesh`] that is closed, connected and without handles. Cost: one sparse Cholesky
//! factorisation of all vertices, about ten of six tenths of them, and one gradient per iteration.

mod alignment;
mod gauss_newton;
mod published;
mod refinement;
mod start;
mod stereographic;
pub(crate) mod unfold;

use std::borrow::Cow;

use crate::control::{History, Observer, Phase, Status};
use crate::distortion::{Distortion, Image, distortion, normalized_density};
use crate::error::{Elements, Error, MapError};
use crate::mesh::TriangleMesh;
use crate::mesh::geometry::{area_vector, triangle};
use crate::optimize::published::gradient_descent::LineSearch;
use crate::options::{check_angle_weight, check_area_tolerance};
use crate::parallel;
use crate::vector::{Vector, dot, norm, scaled};

use published::run::Run;
pub use refinement::Refinement;
use refinement::refine;
pub(crate) use start::rough_conformal;

/// The part of the whole that the map takes before faces are split.
const UNREFINED: f64 = 0.4;

/// A map of the vertices onto the unit sphere.
type Map = Vec<Vector>;

/// How a sphere map is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum SphereMethod {
    /// Fixed-point iteration of the stretch energy (Sutti & Yueh 2024, Algorithm 2).
    FixedPoint,
    /// Riemannian gradient descent (Sutti & Yueh 2024, Algorithm 1) after a few fixed-point steps.
    GradientDescent,
    /// Guarded Gauss–Newton, our own: more exact by orders of magnitude, and never a folded face on the way.
    #[default]
    GaussNewton,
}

/// Options of [`sphere_map`].
#[derive(Debug, Clone)]
pub struct SphereMapOptions<'a> {
    /// The method; guarded Gauss–Newton.
    pub method: SphereMethod,
    /// The line search of the gradient descent; interpolation, which the paper found faster and no less
    /// exact.
    pub line_search: LineSearch,
    /// Target measure of each face, (m,), positive, on any scale; the face areas where `None`.
    pub density: Option<&'a [f64]>,
    /// λ ≥ 0, the weight of the angle distortion against that of areas, for Gauss–Newton only; 0 keeps areas
    /// alone.
    pub angle_weight: f64,
    /// Instead of a weight: the least shear whose area deviation √(E_A/A) is within this tolerance, for Gauss–Newton only;
    /// where `None`, `angle_weight` decides.
    pub area_tolerance: Option<f64>,
    /// A start map, (n, 3), no row zero, outward oriented; the conformal map where `None`, and but for the
    /// fixed point itself fixed-point steps from it.
    pub initial: Option<&'a [Vector]>,
    /// Iterations at the most. Gauss–Newton where neither these nor a tolerance are given: as many as it
    /// takes, with a weight of 0 17 (20 below 20,000 vertices, 40 below 10,000) where those leave the area ratio
    /// a deviation of .5 % (.2 % below 10,000 vertices); the papers' methods: 100, as in the paper's tables. The
    /// fixed-point steps before the descent and the descent that follows where folds were mended come on top. 0 with the fixed point returns the start
    /// map itself.
    pub max_iterations: Option<usize>,
    /// Gauss–Newton has converged when the deviation of the area ratio, √(E_A/A), falls below this; 2·10⁻⁴
    /// where `None`. Gradient descent has converged when ‖grad E‖ falls below this; 10⁻⁸ where `None`. For
    /// the fixed point it is ε of Algorithm 2: the iteration ends when E_S falls by no more than this; 10⁻⁶
    /// where `None`, as in the paper. −∞ asks the fixed point for all iterations, through rises, and for the
    /// last map instead of the best.
    pub tolerance: Option<f64>,
    /// Split faces that keep areas from being even, as those of long limbs do, for Gauss–Newton only; off. Iterations are
    /// counted, and limited, for each of up to four descents.
    pub refine: bool,
    /// Unfold what the papers' methods fold; on. The paper's tables count folds before that too.
    pub unfold: bool,
}

impl Default for SphereMapOptions<'_> {
    fn default() -> Self {
        Self {
            method: SphereMethod::default(),
            line_search: LineSearch::default(),
            density: None,
            angle_weight: 0.0,
            area_tolerance: None,
            initial: None,
            max_iterations: None,
            tolerance: None,
            refine: false,
            unfold: true,
        }
    }
}

/// A one-to-one map of a closed surface to the unit sphere.
#[derive(Debug, Clone)]
pub struct SphereMap {
    /// (n, 3): the image of each vertex, unit rows; positive faces are seen counter-clockwise from outside.
    /// Without a start map it is the rotated copy that lies over the surface best.
    pub positions: Vec<Vector>,
    /// Why the run ended.
    pub status: Status,
    /// The energy after every iteration, by unsigned areas as in the paper; where a mended map took the place
    /// of a folded one, a record of step 0. With [`SphereMapOptions::refine`] of all descents, those of parts of faces that
    /// came to nothing included.
    pub history: History,
    /// The figures of the map, signed. Where faces are split, the image of a face is that of its parts.
    pub distortion: Distortion,
    /// The parts of the faces, where [`SphereMapOptions::refine`] asks for them.
    pub refinement: Option<Box<Refinement>>,
    /// Wall time of the whole call.
    pub seconds: f64,
}

/// Maps a closed surface of genus 0 onto the unit sphere so that areas are kept.
///
/// # Errors
/// Input that is no sphere, and options out of range, are refused before any work.
/// [`NumericsError::NoEmbedding`](crate::NumericsError::NoEmbedding) where every start folds in double precision; never with
/// [`SphereMapOptions::unfold`] off.
///
/// ```
/// use authalic::{Silent, SphereMapOptions, mesh::TriangleMesh, sphere_map};
/// let vertices = [[3., 0., 0.], [0., 1., 0.], [0., 0., 1.], [-1., 0., 0.], [0., -1., 0.], [0., 0., -1.]];
/// let faces = [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
/// let mesh = TriangleMesh::new(&vertices, &faces)?;
/// let map = sphere_map(&mesh, &SphereMapOptions::default(), &mut Silent)?;
/// assert!(map.distortion.folded.is_empty());
/// assert!(map.positions.iter().all(|[x, y, z]| (x * x + y * y + z * z - 1.0).abs() < 1e-12));
/// # Ok::<(), authalic::Error>(())
/// ```
pub fn sphere_map(
    mesh: &TriangleMesh,
    options: &SphereMapOptions<'_>,
    observer: &mut dyn Observer,
) -> Result<SphereMap, Error> {
    let mut history = History::start();
    // 1. Refuse what is no sphere before any work
    options.check(mesh)?;
    // 2. Targets, and each vertex's share of them
    let targets: Cow<'_, [f64]> = match options.density {
        Some(density) => normalized_density(density, mesh.n_faces())?.into(),
        None => mesh.face_areas().into(),
    };
    let weights = vertex_weights(mesh, &targets);
    // 3. Minimise the energy, unfold what folded
    let run = Run { mesh, targets: &targets, weights: &weights, options };
    let to = if options.refine { UNREFINED } else { 1.0 };
    let mut phase = Phase { whole: observer, from: 0.0, to };
    let (map, status) = match options.method {
        SphereMethod::GaussNewton => run.renumbered(&mut history, &mut phase)?,
        SphereMethod::FixedPoint | SphereMethod::GradientDescent => run.solve(&mut history, &mut phase)?,
    };
    // 4. Split what keeps areas uneven
    let (refined, map, status) = if options.refine {
        let mut phase = Phase { whole: observer, from: UNREFINED, to: 1.0 };
        let (refined, map, status) = refine(mesh, &targets, (map, status), options, &mut history, &mut phase);
        (Some(refined), map, status)
    } else {
        (None, map, status)
    };
    let status = match status != Status::Cancelled && !observer.progress(1.0, "Done") {
        true => Status::Cancelled,
        false => status,
    };
    // 5. Of all rotated copies the one that lies over the surface; figures
    let (positions, distortion, refinement) = match refined {
        None => {
            let positions = over_the_surface(mesh, map, &weights, options);
            let figures = distortion(mesh.points(), mesh.faces(), Image::Sphere(&positions), &targets)?;
            (positions, figures, None)
        }
        Some(refined) => {
            let weights = vertex_weights(&refined.mesh, &refined.targets);
            let mut positions = over_the_surface(&refined.mesh, map, &weights, options);
            let (of_parts, of_faces) = refined.figures(&positions)?;
            let of_split_points = positions.split_off(mesh.n_vertices());
            (positions, of_faces, Some(Box::new(refined.into_refinement(of_split_points, of_parts))))
        }
    };
    Ok(SphereMap { positions, status, seconds: history.seconds(), history, distortion, refinement })
}

/// The map rotated over its surface, or as it is where a start was given.
fn over_the_surface(mesh: &TriangleMesh, map: Map, weights: &[f64], options: &SphereMapOptions<'_>) -> Map {
    match options.initial {
        None => alignment::aligned(mesh, map, weights),
        Some(_) => map,
    }
}

/// A third of the targets of the faces at each vertex.
pub(crate) fn vertex_weights(mesh: &TriangleMesh, targets: &[f64]) -> Vec<f64> {
    parallel::map(mesh.n_vertices(), |vertex| {
        mesh.vertex_corners(vertex).iter().map(|&corner| targets[corner as usize / 3] / 3.0).sum()
    })
}

impl SphereMapOptions<'_> {
    fn check(&self, mesh: &TriangleMesh) -> Result<(), Error> {
        mesh.require_sphere()?;
        if let Some(initial) = self.initial {
            check_initial(mesh, initial)?;
        }
        check_angle_weight(self.angle_weight, self.method == SphereMethod::GaussNewton)?;
        check_area_tolerance(
            self.area_tolerance,
            self.angle_weight,
            self.method == SphereMethod::GaussNewton,
        )?;
        if self.refine && self.method != SphereMethod::GaussNewton {
            return Err(Error::InvalidOption {
                name: "refine",
                found: "on".into(),
                expected: "off for the papers' methods; only gauss_newton splits faces".into(),
            });
        }
        let fixed_point = self.method == SphereMethod::FixedPoint;
        let in_range = |tolerance: f64| match fixed_point {
            true => tolerance < f64::INFINITY,
            false => tolerance >= 0.0 && tolerance.is_finite(),
        };
        match self.tolerance {
            Some(tolerance) if !in_range(tolerance) => Err(Error::InvalidOption {
                name: "tolerance",
                found: tolerance.to_string(),
                expected: if fixed_point { "below infinity" } else { "a finite number ≥ 0" }.into(),
            }),
            _ => Ok(()),
        }
    }
}

/// A start map must be finite, away from the origin and outward oriented on the whole; its folds are mended
/// like any others.
fn check_initial(mesh: &TriangleMesh, initial: &[Vector]) -> Result<(), Error> {
    if initial.len() != mesh.n_vertices() {
        let (found, expected) =
            (format!("of shape ({}, 3)", initial.len()), format!("of shape ({}, 3)", mesh.n_vertices()));
        return Err(Error::InvalidArray { name: "initial", found, expected });
    }
    let not_finite = |v: &usize| !initial[*v].iter().all(|x| x.is_finite());
    if let Some(vertices) = Elements::collect((0..initial.len()).filter(not_finite)) {
        return Err(MapError::NonFinite { name: "initial", vertices }.into());
    }
    let no_direction = |v: &usize| normalized(initial[*v]).is_none();
    if let Some(vertices) = Elements::collect((0..initial.len()).filter(no_direction)) {
        let reason = "it lies at the origin, and no direction leads from there to the sphere";
        return Err(MapError::InitialSphere { vertices, reason }.into());
    }
    let map: Map = initial.iter().filter_map(|&x| normalized(x)).collect();
    let volume = |face: usize| {
        let corners = triangle(&map, mesh.faces()[face]);
        dot(corners[0], area_vector(corners))
    };
    if parallel::sum(mesh.n_faces(), volume) <= 0.0 {
        let vertices = Elements::collect(0..initial.len()).expect("a mesh has vertices");
        let reason = "its faces look inward; mirror it, for instance by negating one coordinate";
        return Err(MapError::InitialSphere { vertices, reason }.into());
    }
    Ok(())
}

/// The point of the sphere in the direction of `x`, `None` at the origin.
fn normalized(x: Vector) -> Option<Vector> {
    // by the largest coordinate first, so that squares neither over- nor underflow
    let largest = x.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
    if (dot(x, x) - 1.0).abs() <= 4.0 * f64::EPSILON {
        return Some(x);
    }
    let x = scaled(x, 1.0 / largest);
    (largest > 0.0 && x.iter().all(|c| c.is_finite())).then(|| scaled(x, 1.0 / norm(x)))
}
