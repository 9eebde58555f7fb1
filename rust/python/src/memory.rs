// SPDX-License-Identifier: MIT OR Apache-2.0
//! Whether there is memory for a run: asked before it starts, because a program that lacks it midway is ended.
//!
//! What a run takes was measured (docs/measurements.md). The figures here are below that, so that no run is refused
//! that could go through.

use authalic::memory::available;
use authalic::{Error, NumericsError};
use pyo3::prelude::*;

use crate::errors::to_python;

/// Bytes that a map, or the search for seams, takes at least for each vertex.
pub const MAP: u64 = 2500;

/// Bytes that a registration takes at least for each vertex of both surfaces.
pub const REGISTRATION: u64 = 600;

/// Bytes that a hyperbolic structure takes at least for each vertex.
pub const STRUCTURE: u64 = 1500;

/// Bytes that a map without folds takes at least for each vertex.
pub const UNTANGLING: u64 = 250;

/// Bytes that a repair takes at least for each vertex.
pub const REPAIR: u64 = 500;

/// Refuses a run for whose vertices there is no memory.
pub fn check(py: Python<'_>, bytes_per_vertex: u64, n_vertices: usize) -> PyResult<()> {
    let needed = bytes_per_vertex.saturating_mul(n_vertices as u64);
    match available() {
        Some(available) if available < needed => {
            let error = NumericsError::OutOfMemory { n_vertices, needed, available };
            Err(to_python(py, &Error::from(error)))
        }
        _ => Ok(()),
    }
}
