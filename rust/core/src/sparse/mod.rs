// SPDX-License-Identifier: MIT OR Apache-2.0
//! Sparse systems on a mesh: assembly with a fixed pattern, and factorization behind one interface.

mod cholesky;
mod dirichlet;
mod faer;
mod laplacian;
mod multifrontal;

pub use self::faer::solve_general;
pub(crate) use self::faer::{solve_positive_definite, top_eigenvector};
pub use cholesky::Cholesky;
pub(crate) use dirichlet::solve_dirichlet;
pub use laplacian::Laplacian;
#[cfg(test)]
pub(crate) use multifrontal::processor;
pub(crate) use multifrontal::{Analysis, Factor, Failure, Order, elimination_order};
