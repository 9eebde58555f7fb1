// SPDX-License-Identifier: MIT OR Apache-2.0
//! The tests of the crate from outside, in one binary.

mod common;

mod cut;
mod disk;
mod embedding;
mod energy;
mod fuzzing;
mod gauss_newton;
mod gauss_newton_runs;
mod hyperbolic;
mod layout;
mod mesh;
mod optimize;
mod packing;
mod registration;
mod repair;
mod seams;
mod spatial_energy;
mod sphere;
mod sphere_runs;
mod symmetry;
