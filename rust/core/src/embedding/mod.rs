// SPDX-License-Identifier: MIT OR Apache-2.0
//! Maps without folds for every topological sphere and disk, from which a descent can start.
//!
//! [`progressive_sphere`] and [`progressive_disk`] build a map up vertex by vertex, [`relaxed`] moves its
//! vertices one at a time, [`Coarse`] takes maps of a coarse mesh to the whole surface. None of them ever folds a face, whatever the shape.

mod coarse;
mod conformal_star;
mod decimation;
mod kernel;
mod progressive;
mod star;

pub(crate) use coarse::{Coarse, NotCoarse};
pub use progressive::{Stop, progressive_disk, progressive_sphere, relaxed};
