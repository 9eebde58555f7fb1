// SPDX-License-Identifier: MIT OR Apache-2.0
//! Sparse factorisations. The only file that names the library behind them.
//!
//! A mesh's matrices share one pattern, so [`Cholesky::analyse`] orders and analyses it once and
//! [`Cholesky::refactor`] only computes numbers. Both run on one thread: the dense blocks of surface meshes are too
//! small for the library's own threads to pay.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::linalg::lu::{LuSymbolicParams, NumericLu, factorize_symbolic_lu};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side, Spec};
use sprs::CsMat;

use crate::Error;

/// A Cholesky factorisation `P A Pᵀ = L Lᵀ` with an approximate minimum degree ordering P.
#[derive(Debug)]
pub struct Cholesky {
    symbolic: SymbolicCholesky<usize>,
    values: Vec<f64>,
}

impl Cholesky {
    /// Orders and analyses the pattern of a symmetric matrix given by its upper triangle; nothing is factored yet.
    ///
    /// # Errors
    /// [`Error::FactorizationFailed`] where memory is short.
    pub fn analyse(upper: &CsMat<f64>) -> Result<Self, Error> {
        let params = CholeskySymbolicParams::default();
        let symbolic = factorize_symbolic_cholesky(pattern(upper), Side::Upper, SymmetricOrdering::Amd, params)
            .map_err(|error| failed(format!("ordering {} unknowns: {error:?}", upper.cols())))?;
        let values = vec![0.0; symbolic.len_val()];
        Ok(Self { symbolic, values })
    }

    /// Factors a matrix of the analysed pattern, given by its upper triangle.
    ///
    /// # Errors
    /// [`Error::FactorizationFailed`] where the matrix is not positive definite to working precision.
    pub fn refactor(&mut self, upper: &CsMat<f64>) -> Result<(), Error> {
        let matrix = SparseColMatRef::new(pattern(upper), upper.data());
        let params = Spec::default();
        let mut memory = MemBuffer::new(self.symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, params));
        self.symbolic
            .factorize_numeric_llt(
                &mut self.values,
                matrix,
                Side::Upper,
                LltRegularization::default(),
                Par::Seq,
                MemStack::new(&mut memory),
                params,
            )
            .map_err(|error| failed(format!("a system of {} unknowns is not positive definite: {error:?}", upper.cols())))?;
        Ok(())
    }

    /// Solves `A x = b` in place for the columns of `rhs`, each as long as the matrix and stored one after another.
    pub fn solve(&self, rhs: &mut [f64]) {
        let n = self.symbolic.nrows();
        if n == 0 {
            return;
        }
        let columns = rhs.len() / n;
        let factor = LltRef::new(&self.symbolic, &self.values);
        let mut memory = MemBuffer::new(self.symbolic.solve_in_place_scratch::<f64>(columns, Par::Seq));
        let rhs = MatMut::from_column_major_slice_mut(rhs, n, columns);
        factor.solve_in_place_with_conj(Conj::No, rhs, Par::Seq, MemStack::new(&mut memory));
    }
}

/// Solves `A x = b` in place for a general square matrix by LU with column ordering; `rhs` as in [`Cholesky::solve`].
///
/// # Errors
/// [`Error::FactorizationFailed`] where the matrix is singular to working precision.
pub fn solve_general(matrix: &CsMat<f64>, rhs: &mut [f64]) -> Result<(), Error> {
    let n = matrix.cols();
    let columns = rhs.len().checked_div(n).unwrap_or(0);
    let singular = |error: &dyn std::fmt::Debug| failed(format!("LU of {n} unknowns: {error:?}"));
    let symbolic = factorize_symbolic_lu(pattern(matrix), LuSymbolicParams::default()).map_err(|error| singular(&error))?;
    let (values, params) = (SparseColMatRef::new(pattern(matrix), matrix.data()), Spec::default());
    let mut numeric = NumericLu::new();
    let mut memory = MemBuffer::new(symbolic.factorize_numeric_lu_scratch::<f64>(Par::Seq, params));
    let factor = symbolic
        .factorize_numeric_lu(&mut numeric, values, Par::Seq, MemStack::new(&mut memory), params)
        .map_err(|error| singular(&error))?;
    let mut memory = MemBuffer::new(symbolic.solve_in_place_scratch::<f64>(columns, Par::Seq));
    let solution = MatMut::from_column_major_slice_mut(rhs, n, columns);
    factor.solve_in_place_with_conj(Conj::No, solution, Par::Seq, MemStack::new(&mut memory));
    match rhs.iter().all(|x| x.is_finite()) {
        true => Ok(()),
        false => Err(failed(format!("LU of {n} unknowns: the matrix is singular"))),
    }
}

fn pattern(matrix: &CsMat<f64>) -> SymbolicSparseColMatRef<'_, usize> {
    assert!(matrix.is_csc(), "the factorisations take compressed columns");
    let (starts, rows) = (matrix.indptr().into_raw_storage(), matrix.indices());
    SymbolicSparseColMatRef::new_checked(matrix.rows(), matrix.cols(), starts, None, rows)
}

fn failed(what: String) -> Error {
    Error::FactorizationFailed { what }
}
