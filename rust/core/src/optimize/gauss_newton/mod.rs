// SPDX-License-Identifier: MIT OR Apache-2.0
//! Guarded Gauss–Newton: our own descent to an area-preserving map, on the disk and on the sphere.
//!
//! E_A is a zero-residual least-squares problem, so its Gauss–Newton Hessian suffices near the minimum. Far from it the
//! energy of [`authalic`](crate::energy::authalic) adds angle distortion with a weight λ that [falls](angle_schedule),
//! and a barrier that no step can cross. In each iteration:
//!
//! 1. targets are rescaled to the area of the image, λ is chosen;
//! 2. the Hessian is factored once, with a damping of each face in proportion to its distance from its target.
//!    Where λ stays until the map is stationary, the exact Hessian takes its place near the end, as far as that is
//!    positive definite;
//! 3. the factor gives the direction d and a second-order correction for the deviation of the areas from their linear
//!    prediction;
//! 4. the step is accepted where the energy falls.
//!
//! Area-preserving maps are a large family, and the descent's whole path decides which of them it reaches. So that
//! rounding does not, directions are solved in double precision except on the largest meshes, and nothing is repaired
//! on the way: single precision or a repair turns a change of 1e-14 of the surface into one of 1e-2 of the map.
//!
//! With [`Profile::Barrier`](crate::energy::stretch::Profile) an accepted map has no folded face: the energy of a trial
//! is infinite unless every face is positive by more than rounding.
//! [`Profile::Stretch`](crate::energy::stretch::Profile) drops the barrier and the angles (Levenberg–Marquardt on E_A);
//! in the plane, where areas have signs, it unfolds faces on its way.
//!
//! Cost of one iteration: one factorization of two unknowns per vertex, two solves, some seven passes over the faces.

pub(crate) mod angle_schedule;
pub(crate) mod area_tolerance;
mod descent;
mod problem;
mod stopping;
mod system;
pub(crate) mod target_floors;
mod trial;

pub(crate) use descent::{minimize, more_even};
pub(crate) use problem::{GaussNewtonOptions, Problem};
