// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options of disk maps.

use ndarray::{ArrayView1, ArrayView2};

use crate::arrays::rows;

/// The method of a disk map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum DiskMethod {
    /// Fixed-point iteration of the stretch energy (Liu & Yueh 2023, equation (2.5)).
    FixedPoint,
    /// Preconditioned nonlinear conjugate gradients (Liu & Yueh 2023, Algorithm 3.1).
    ConjugateGradient,
    /// Guarded Gauss–Newton, our own: orders of magnitude more exact, and never folds a face on the way.
    #[default]
    GaussNewton,
}

/// The boundary condition of a disk map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Boundary {
    /// Boundary vertices are held on the circle at arcs proportional to the edge lengths, as in the papers.
    ArcLength,
    /// Boundary vertices slide along the circle in their order, so that the faces at the boundary keep their areas too.
    #[default]
    Sliding,
    /// The boundary takes any shape that does not cross itself, for Gauss–Newton only; with a weight of angles the
    /// shape that suits these. The map lies inside the unit circle.
    Free,
    /// The boundary is a rectangle, for Gauss–Newton only: four vertices lie at its corners, the others slide along its
    /// sides. The map lies in `[0, w] × [0, h]` with a longer side of 1.
    Rectangle,
}

/// Options of [`disk_map`](super::disk_map).
#[derive(Debug, Clone, Default)]
pub struct DiskMapOptions<'a> {
    /// The method; by default guarded Gauss–Newton.
    pub method: DiskMethod,
    /// The boundary; by default sliding.
    pub boundary: Boundary,
    /// Target measure of each face, (m,), positive, on any scale; the face areas where `None`.
    pub density: Option<ArrayView1<'a, f64>>,
    /// λ ≥ 0, the weight of the angle distortion against that of areas, for Gauss–Newton only; 0 preserves areas alone.
    pub angle_weight: f64,
    /// Instead of a weight: the least shear whose area deviation √(E_A/A) is within this tolerance, for Gauss–Newton
    /// only; where `None`, `angle_weight` decides.
    pub area_tolerance: Option<f64>,
    /// A start map, (n, 2): its boundary once around the unit circle, along the sides of an upright rectangle, or with
    /// a free boundary any outline that does not cross itself; the fixed-point steps from the harmonic map where
    /// `None`.
    pub initial: Option<ArrayView2<'a, f64>>,
    /// Iteration limit. `None` for Gauss–Newton: none, but with a weight of 0 and no tolerance it stops after 11
    /// iterations (33 below 10,000 vertices) once the area deviation is below .5 % (.2 %). `None` for the papers'
    /// methods: 50, as in the paper's tables. Not counted are the five fixed-point steps at the start, up to 12
    /// unguarded steps that unfold, a descent after folds were mended, and up to eight iterations per floor where
    /// targets are below 1 % of the mean.
    pub max_iterations: Option<usize>,
    /// Gauss–Newton has converged when the area deviation √(E_A/A) is below this; `None`: 2·10⁻⁴. The papers' methods
    /// have converged when √(gᵀM⁻¹g) is; `None`: 10⁻⁸.
    pub tolerance: Option<f64>,
    /// Fill holes virtually instead of refusing them; by default off. With a free boundary they stay open and are as
    /// free as the longest loop.
    pub fill_holes: bool,
    /// Let a free boundary cross itself; by default off.
    pub overlap: bool,
    /// The vertices at the corners of a rectangle, counter-clockwise from the lower left one; sought where `None`.
    pub corners: Option<[usize; 4]>,
    /// Width over height of a rectangle; whatever suits angles best where `None`.
    pub aspect: Option<f64>,
}

impl<'a> DiskMapOptions<'a> {
    /// The options for the time of a run: views of arrays do not shorten their lifetimes by themselves.
    pub(super) fn by_ref(&self) -> DiskMapOptions<'_> {
        let density = self.density.as_ref().map(|density| density.view());
        let initial = self.initial.as_ref().map(|initial| initial.view());
        DiskMapOptions { density, initial, ..*self }
    }

    /// The rows of the start map, which [`disk_map`](super::disk_map) has brought into row-major order.
    pub(super) fn initial_rows(&self) -> Option<&'a [[f64; 2]]> {
        self.initial.map(rows)
    }
}
