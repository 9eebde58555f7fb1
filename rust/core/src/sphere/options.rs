// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options of sphere maps and their check.

use ndarray::{ArrayView1, ArrayView2};

use crate::arrays::vectors;
use crate::codomain::SpatialMap;
use crate::codomain::spherical::onto_sphere;
use crate::error::{Elements, Error, MapError};
use crate::mesh::TriangleMesh;
use crate::mesh::geometry::{area_vector, triangle};
use crate::optimize::published::gradient_descent::LineSearch;
use crate::options::{check_angle_weight, check_area_tolerance};
use crate::parallel;
use crate::vector::Vector3;

/// The method of a sphere map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum SphereMethod {
    /// Fixed-point iteration of the stretch energy (Sutti & Yueh 2024, Algorithm 2).
    FixedPoint,
    /// Riemannian gradient descent (Sutti & Yueh 2024, Algorithm 1) after a few fixed-point steps.
    GradientDescent,
    /// Guarded Gauss–Newton, our own: orders of magnitude more exact, and never folds a face on the way.
    #[default]
    GaussNewton,
}

/// Options of [`sphere_map`](super::sphere_map).
#[derive(Debug, Clone)]
pub struct SphereMapOptions<'a> {
    /// The method; by default guarded Gauss–Newton.
    pub method: SphereMethod,
    /// The line search of the gradient descent; by default interpolation, which the paper found faster and no less exact.
    pub line_search: LineSearch,
    /// Target measure of each face, (m,), positive, on any scale; the face areas where `None`.
    pub density: Option<ArrayView1<'a, f64>>,
    /// λ ≥ 0, the weight of the angle distortion against that of areas, for Gauss–Newton only; 0 preserves areas alone.
    pub angle_weight: f64,
    /// Instead of a weight: the least shear whose area deviation √(E_A/A) is within this tolerance, for Gauss–Newton only;
    /// where `None`, `angle_weight` decides.
    pub area_tolerance: Option<f64>,
    /// A start map, (n, 3), no row zero, outward oriented. `None`: the conformal map, followed by fixed-point steps unless
    /// these are the method.
    pub initial: Option<ArrayView2<'a, f64>>,
    /// Iteration limit. `None` for Gauss–Newton: none, but with a weight of 0 and no tolerance it stops after 17 iterations
    /// (20 below 20,000 vertices, 40 below 10,000) once the area deviation is below .5 % (.2 % below 10,000 vertices).
    /// `None` for the papers' methods: 100, as in the paper's tables. Not counted are the fixed-point steps before the
    /// descent, and a descent after folds were mended. 0 with the fixed point returns the start map.
    pub max_iterations: Option<usize>,
    /// Gauss–Newton has converged when the area deviation √(E_A/A) is below this; `None`: 2·10⁻⁴. Gradient descent has
    /// converged when ‖grad E‖ is; `None`: 10⁻⁸. For the fixed point it is ε of Algorithm 2: the iteration ends when E_S
    /// falls by no more than this; `None`: 10⁻⁶, as in the paper. −∞ makes the fixed point take all iterations, even if E_S
    /// rises, and return the last map instead of the best.
    pub tolerance: Option<f64>,
    /// Split faces that keep areas uneven, as those of long limbs do, for Gauss–Newton only; by default off. The iteration
    /// limit applies to each of up to four descents.
    pub refine: bool,
    /// Fill all holes for the time of the map instead of refusing an open surface; by default off.
    pub fill_holes: bool,
    /// Unfold the faces that the papers' methods fold; by default on. The paper's tables also count folds before that.
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
            fill_holes: false,
            unfold: true,
        }
    }
}

impl SphereMapOptions<'_> {
    /// The options for the time of a run: views of arrays do not shorten their lifetimes by themselves.
    pub(super) fn by_ref(&self) -> SphereMapOptions<'_> {
        let density = self.density.as_ref().map(|density| density.view());
        let initial = self.initial.as_ref().map(|initial| initial.view());
        SphereMapOptions { density, initial, ..*self }
    }

    /// The start map, which [`sphere_map`](super::sphere_map) has brought into row-major order.
    pub(super) fn initial_map(&self) -> Option<SpatialMap> {
        self.initial.map(vectors)
    }

    /// Refuses a surface that is no sphere, and options out of range.
    pub(super) fn check(&self, mesh: &TriangleMesh) -> Result<(), Error> {
        mesh.require_sphere()?;
        if let Some(initial) = self.initial_map() {
            check_initial(mesh, &initial)?;
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
        let in_range = |tolerance: f64| {
            if fixed_point { tolerance < f64::INFINITY } else { tolerance >= 0.0 && tolerance.is_finite() }
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

/// Refuses a start map that is not finite, meets the origin, or is not outward oriented as a whole. Folds are allowed.
fn check_initial(mesh: &TriangleMesh, initial: &[Vector3]) -> Result<(), Error> {
    if initial.len() != mesh.n_vertices() {
        let (found, expected) =
            (format!("of shape ({}, 3)", initial.len()), format!("of shape ({}, 3)", mesh.n_vertices()));
        return Err(Error::InvalidArray { name: "initial", found, expected });
    }
    let not_finite = |v: &usize| !initial[*v].is_finite();
    if let Some(vertices) = Elements::collect((0..initial.len()).filter(not_finite)) {
        return Err(MapError::NonFinite { name: "initial", vertices }.into());
    }
    let no_direction = |v: &usize| onto_sphere(initial[*v]).is_none();
    if let Some(vertices) = Elements::collect((0..initial.len()).filter(no_direction)) {
        let reason = "it lies at the origin, and no direction leads from there to the sphere";
        return Err(MapError::InitialSphere { vertices, reason }.into());
    }
    let map: SpatialMap = initial.iter().filter_map(|&x| onto_sphere(x)).collect();
    let volume = |face: usize| {
        let corners = triangle(&map, mesh.faces()[face]);
        corners[0].dot(area_vector(corners))
    };
    if parallel::sum(mesh.n_faces(), volume) <= 0.0 {
        let vertices = Elements::collect(0..initial.len()).expect("a mesh has vertices");
        let reason = "its faces look inward; mirror it, for instance by negating one coordinate";
        return Err(MapError::InitialSphere { vertices, reason }.into());
    }
    Ok(())
}
