// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options of disk maps.

/// How a disk map is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Method {
    /// Fixed-point iteration of the stretch energy (Liu & Yueh 2023, equation (2.5)).
    FixedPoint,
    /// Preconditioned nonlinear conjugate gradients (Liu & Yueh 2023, Algorithm 3.1).
    ConjugateGradient,
    /// Guarded Gauss–Newton, our own: more exact by orders of magnitude, and never a folded face on the way.
    #[default]
    GaussNewton,
}

/// What the boundary vertices may do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Boundary {
    /// Held on the circle at arcs proportional to the edge lengths, as in the papers.
    ArcLength,
    /// Free to slide along the circle in their order, which lets the faces at the boundary keep their areas
    /// too.
    #[default]
    Sliding,
    /// Free to take any shape that does not cross itself, for Gauss–Newton only: with a weight of angles it
    /// takes the shape that suits these. The map lies inside the unit circle.
    Free,
    /// On the sides of a rectangle, for Gauss–Newton only: four vertices at its corners, the others sliding along its sides.
    /// The map lies in `[0, w] × [0, h]` with a longer side of 1.
    Rectangle,
}

/// Options of [`disk_map`](super::disk_map).
#[derive(Debug, Clone, Default)]
pub struct DiskMapOptions<'a> {
    /// The method; guarded Gauss–Newton.
    pub method: Method,
    /// The boundary; sliding.
    pub boundary: Boundary,
    /// Target measure of each face, (m,), positive, on any scale; the face areas where `None`.
    pub density: Option<&'a [f64]>,
    /// λ ≥ 0, the weight of the angle distortion against that of areas, for Gauss–Newton only; 0 keeps areas
    /// alone.
    pub angle_weight: f64,
    /// Instead of a weight: the least shear whose area deviation √(E_A/A) is within this tolerance, for Gauss–Newton only;
    /// where `None`, `angle_weight` decides.
    pub area_tolerance: Option<f64>,
    /// A start map, (n, 2): its boundary once around the unit circle, along the sides of an upright rectangle, or with
    /// a free boundary any outline that does not cross itself; the fixed-point steps from the harmonic map where
    /// `None`.
    pub initial: Option<&'a [[f64; 2]]>,
    /// Iterations at the most. Gauss–Newton where neither these nor a tolerance are given: as many as it
    /// takes, with a weight of 0 11 (33 below 10,000 vertices) where those leave the area ratio a deviation of
    /// .5 % (.2 % below 10,000 vertices); the papers' methods: 50, as in the paper's tables. The five fixed-point
    /// steps that come first, the unguarded steps that unfold (12 at the most) and a descent that follows where folds were mended
    /// come on top, and where some targets are below 1 % of the mean up to eight for each of the floors that
    /// are lowered step by step.
    pub max_iterations: Option<usize>,
    /// Gauss–Newton has converged when the deviation of the area ratio, √(E_A/A), falls below this; 2·10⁻⁴
    /// where `None`. For the papers' methods √(gᵀM⁻¹g); 10⁻⁸ where `None`.
    pub tolerance: Option<f64>,
    /// Fill all boundary loops but the longest virtually instead of refusing them; off. With a free boundary they stay
    /// open and are as free as the longest one.
    pub fill_holes: bool,
    /// Let a free boundary cross itself; off.
    pub overlap: bool,
    /// The vertices at the corners of a rectangle, counter-clockwise from the lower left one; sought where `None`.
    pub corners: Option<[usize; 4]>,
    /// Width over height of a rectangle; whatever suits angles best where `None`.
    pub aspect: Option<f64>,
}
