// SPDX-License-Identifier: MIT OR Apache-2.0
//! Sparse systems on a mesh: assembly with a fixed pattern, and factorisation behind one interface.

mod dirichlet;
mod factor;
mod laplacian;
mod multifrontal;

pub(crate) use dirichlet::solve_dirichlet;
pub(crate) use factor::top_eigenvector;
pub use factor::{Cholesky, solve_general};
pub use laplacian::Laplacian;
pub(crate) use multifrontal::{Analysis, Factor, Failure};
