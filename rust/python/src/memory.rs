// SPDX-License-Identifier: MIT OR Apache-2.0
//! Whether there is memory for a run: asked before it starts, because a program that lacks it midway is ended.
//!
//! What a run takes was measured (`scripts/bench memory`). The figures here are a little above that for large surfaces,
//! but for maps: what they take beyond the figure here depends on their factorizations, which ask again once their size
//! is known.

use authalic::memory::{require_for_numbers, require_for_vertices};
use authalic::{Error, NumericsError};
use pyo3::prelude::*;

use crate::errors::to_python;

/// Bytes that a map, or the search for seams, takes at least for each vertex, as on thin strips.
pub const MAP: u64 = 2300;

/// Bytes that a registration takes for each vertex of both surfaces.
pub const REGISTRATION: u64 = 950;

/// Bytes that a registration by curves takes for each vertex of both surfaces.
pub const CURVES: u64 = 4600;

/// Bytes that a hyperbolic structure takes for each vertex.
pub const STRUCTURE: u64 = 3400;

/// Bytes that a map without folds takes for each vertex.
pub const UNTANGLING: u64 = 400;

/// Bytes that a repair takes for each vertex.
pub const REPAIR: u64 = 600;

/// Bytes that a cut takes for each vertex.
pub const CUT: u64 = 450;

/// Bytes that the figures of a map take for each vertex.
pub const FIGURES: u64 = 180;

/// Bytes that the Hessian of a map takes for each vertex.
pub const HESSIAN: u64 = 9500;

/// Bytes that packing takes for each vertex.
pub const PACKING: u64 = 140;

/// Bytes that each number takes while it is converted and copied.
pub const GIVEN: u64 = 16;

/// Bytes that a point takes that is looked up on a map.
pub const POINT: u64 = 120;

/// Bytes that a number of a result takes.
pub const RESULT: u64 = 8;

/// Bytes that a number of a result takes that is interpolated smoothly, with the gradients.
pub const SMOOTH: u64 = 36;

/// Refuses a run for whose vertices there is no memory.
pub fn check(py: Python<'_>, bytes_per_vertex: u64, n_vertices: usize) -> PyResult<()> {
    raised(py, require_for_vertices(bytes_per_vertex, n_vertices))
}

/// Refuses arrays for whose numbers there is no memory.
pub fn check_numbers(py: Python<'_>, bytes_per_number: u64, n_numbers: usize) -> PyResult<()> {
    raised(py, require_for_numbers(bytes_per_number, n_numbers))
}

fn raised(py: Python<'_>, outcome: Result<(), NumericsError>) -> PyResult<()> {
    outcome.map_err(|error| to_python(py, &Error::from(error)))
}
