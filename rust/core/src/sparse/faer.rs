// SPDX-License-Identifier: MIT OR Apache-2.0
//! Dense kernels, orderings and general systems. The only file that names the library behind them.
//!
//! All run on one thread: threads go over the fronts of a factorization, not inside them.

use faer::diag::Diag;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::linalg::cholesky::llt::factor::{cholesky_in_place as llt_in_place, cholesky_in_place_scratch};
use faer::linalg::evd::{ComputeEigenvectors, self_adjoint_evd, self_adjoint_evd_scratch};
use faer::linalg::matmul::triangular::BlockStructure;
use faer::linalg::{matmul, triangular_solve};
use faer::sparse::linalg::amd;
use faer::sparse::linalg::lu::{LuSymbolicParams, NumericLu, factorize_symbolic_lu};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::traits::RealField;
use faer::{Accum, Conj, Mat, MatMut, MatRef, Par, Spec};
use sprs::CsMat;

use crate::error::{Error, NumericsError};

/// Solves `A x = b` in place for a general square matrix by LU with column ordering; `rhs` as in
/// [`Cholesky::solve`](super::Cholesky::solve).
///
/// # Errors
/// [`NumericsError::FactorizationFailed`] where the matrix is singular to working precision.
pub fn solve_general(matrix: &CsMat<f64>, rhs: &mut [f64]) -> Result<(), Error> {
    let n = matrix.cols();
    let columns = rhs.len().checked_div(n).unwrap_or(0);
    let singular = |error: &dyn std::fmt::Debug| failed(format!("LU of {n} unknowns: {error:?}"));
    let symbolic = factorize_symbolic_lu(pattern(matrix), LuSymbolicParams::default())
        .map_err(|error| singular(&error))?;
    let (values, params) = (SparseColMatRef::new(pattern(matrix), matrix.data()), Spec::default());
    let mut numeric = NumericLu::new();
    let mut memory = MemBuffer::new(symbolic.factorize_numeric_lu_scratch::<f64>(Par::Seq, params));
    let factor = symbolic
        .factorize_numeric_lu(&mut numeric, values, Par::Seq, MemStack::new(&mut memory), params)
        .map_err(|error| singular(&error))?;
    let mut memory = MemBuffer::new(symbolic.solve_in_place_scratch::<f64>(columns, Par::Seq));
    let solution = MatMut::from_column_major_slice_mut(rhs, n, columns);
    factor.solve_in_place_with_conj(Conj::No, solution, Par::Seq, MemStack::new(&mut memory));
    if rhs.iter().all(|x| x.is_finite()) {
        Ok(())
    } else {
        Err(failed(format!("LU of {n} unknowns: the matrix is singular")))
    }
}

/// Solves `A x = b` in place for a dense symmetric positive definite matrix, whose lower triangle is read and
/// overwritten by its Cholesky factor. `rhs` holds one or more columns, one after another. Returns false, and leaves
/// `rhs` undefined, where a pivot is not positive and finite.
pub(crate) fn solve_positive_definite(matrix: &mut [f64], rhs: &mut [f64]) -> bool {
    let n = matrix.len().isqrt();
    let columns = rhs.len().checked_div(n).unwrap_or(0);
    if !cholesky_in_place(block(matrix, n, n)) {
        return false;
    }
    let lower = block_ref(matrix, n, n);
    triangular_solve::solve_lower_triangular_in_place(lower, block(rhs, n, columns), Par::Seq);
    triangular_solve::solve_upper_triangular_in_place(lower.transpose(), block(rhs, n, columns), Par::Seq);
    rhs.iter().all(|x| x.is_finite())
}

/// A unit eigenvector of the largest eigenvalue of a symmetric matrix given by rows; the first axis where the
/// iteration fails.
pub(crate) fn top_eigenvector<const N: usize>(symmetric: &[[f64; N]; N]) -> [f64; N] {
    let matrix = Mat::from_fn(N, N, |i, j| symmetric[i][j]);
    let (mut values, mut vectors) = (Diag::zeros(N), Mat::zeros(N, N));
    // on one thread, because the library's own pool does not survive a fork
    let (want, params) = (ComputeEigenvectors::Yes, Spec::default());
    let mut memory = MemBuffer::new(self_adjoint_evd_scratch::<f64>(N, want, Par::Seq, params));
    let stack = MemStack::new(&mut memory);
    let (to, u) = (values.as_mut(), Some(vectors.as_mut()));
    match self_adjoint_evd(matrix.as_ref(), to, u, Par::Seq, stack, params) {
        // ascending eigenvalues
        Ok(()) => std::array::from_fn(|i| vectors[(i, N - 1)]),
        Err(_) => std::array::from_fn(|i| if i == 0 { 1.0 } else { 0.0 }),
    }
}

/// A real number that the dense kernels take.
pub(crate) trait Scalar: RealField + Copy + std::ops::SubAssign {
    const ZERO: Self;
    const ONE: Self;

    /// The nearest number.
    fn from_f64(value: f64) -> Self;
    fn to_f64(self) -> f64;
    fn sqrt(self) -> Self;
    fn is_finite(self) -> bool;
}

macro_rules! impl_scalar {
    ($float:ty) => {
        impl Scalar for $float {
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;

            #[inline(always)]
            fn from_f64(value: f64) -> Self {
                value as Self
            }

            #[inline(always)]
            fn to_f64(self) -> f64 {
                f64::from(self)
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                self.sqrt()
            }

            #[inline(always)]
            fn is_finite(self) -> bool {
                self.is_finite()
            }
        }
    };
}

impl_scalar!(f32);
impl_scalar!(f64);

/// A mutable column-major block of a dense matrix.
pub(super) type Block<'a, T> = MatMut<'a, T>;
/// A column-major block of a dense matrix.
pub(super) type BlockRef<'a, T> = MatRef<'a, T>;

/// The numbers as a matrix of `rows` rows, stored column by column.
pub(super) fn block<T>(values: &mut [T], rows: usize, columns: usize) -> Block<'_, T> {
    MatMut::from_column_major_slice_mut(values, rows, columns)
}

/// The numbers as a matrix of `rows` rows, stored column by column.
pub(super) fn block_ref<T>(values: &[T], rows: usize, columns: usize) -> BlockRef<'_, T> {
    MatRef::from_column_major_slice(values, rows, columns)
}

/// Overwrites the lower triangle by its Cholesky factor; false where a pivot is not positive and finite.
pub(super) fn cholesky_in_place<T: Scalar>(lower: Block<'_, T>) -> bool {
    let mut memory = MemBuffer::new(cholesky_in_place_scratch::<T>(lower.nrows(), Par::Seq, Spec::default()));
    let stack = MemStack::new(&mut memory);
    llt_in_place(lower, LltRegularization::default(), Par::Seq, stack, Spec::default()).is_ok()
}

/// `rows := rows · L⁻ᵀ` for a lower triangle L.
pub(super) fn lower_solve_rows<T: Scalar>(lower: BlockRef<'_, T>, rows: Block<'_, T>) {
    triangular_solve::solve_lower_triangular_in_place(lower, rows.transpose_mut(), Par::Seq);
}

/// `out -= a · bᵀ` or, to replace it, `out := −a · bᵀ`; for a square `out` the lower triangle only, if asked
/// for.
pub(super) fn subtract_product<T: Scalar>(
    out: Block<'_, T>,
    a: BlockRef<'_, T>,
    b: BlockRef<'_, T>,
    replace: bool,
    only_lower: bool,
) {
    let beta = if replace { Accum::Replace } else { Accum::Add };
    let of_out = if only_lower { BlockStructure::TriangularLower } else { BlockStructure::Rectangular };
    let full = BlockStructure::Rectangular;
    matmul::triangular::matmul(out, of_out, beta, a, full, b.transpose(), full, -T::ONE, Par::Seq);
}

/// An order of the nodes of a graph that keeps the factor sparse, by approximate minimum degree (Amestoy,
/// Davis and Duff 1996); the neighbors of node v are those from `starts[v]` to `starts[v + 1]`.
///
/// # Errors
/// [`NumericsError::FactorizationFailed`] where there are too many edges for 32-bit indices.
pub(super) fn minimum_degree(starts: &[u32], neighbors: &[u32]) -> Result<Vec<u32>, Error> {
    let n = starts.len() - 1;
    let graph = SymbolicSparseColMatRef::new_checked(n, n, starts, None, neighbors);
    let (mut order, mut position) = (vec![0; n], vec![0; n]);
    let mut memory = MemBuffer::new(amd::order_scratch::<u32>(n, neighbors.len()));
    amd::order(&mut order, &mut position, graph, amd::Control::default(), MemStack::new(&mut memory))
        .map_err(|error| failed(format!("ordering {n} unknowns: {error:?}")))?;
    Ok(order)
}

fn pattern(matrix: &CsMat<f64>) -> SymbolicSparseColMatRef<'_, usize> {
    assert!(matrix.is_csc(), "the factorizations take compressed columns");
    let (starts, rows) = (matrix.indptr().into_raw_storage(), matrix.indices());
    SymbolicSparseColMatRef::new_checked(matrix.rows(), matrix.cols(), starts, None, rows)
}

fn failed(what: String) -> Error {
    NumericsError::FactorizationFailed { what }.into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprs::TriMat;

    #[test]
    fn general_systems_are_solved() {
        let mut matrix = TriMat::new((3, 3));
        for (i, j, value) in [(0, 0, 2.0), (0, 2, 1.0), (1, 0, -1.0), (1, 1, 3.0), (2, 1, 4.0), (2, 2, 1.0)] {
            matrix.add_triplet(i, j, value);
        }
        let mut x = [5.0, 5.0, 11.0];
        solve_general(&matrix.to_csc(), &mut x).unwrap();
        [1.0, 2.0, 3.0].iter().zip(x).for_each(|(expected, x)| assert!((x - expected).abs() < 1e-14));
    }

    #[test]
    fn dense_positive_definite_systems_are_solved_from_the_lower_triangle() {
        let mut matrix = [4.0, 2.0, -2.0, f64::NAN, 5.0, 3.0, f64::NAN, f64::NAN, 6.0];
        let mut x = [2.0, 21.0, 22.0, 4.0, 42.0, 44.0];
        assert!(solve_positive_definite(&mut matrix, &mut x));
        [1.0, 2.0, 3.0, 2.0, 4.0, 6.0]
            .iter()
            .zip(x)
            .for_each(|(expected, x)| assert!((x - expected).abs() < 1e-14));
        assert!(!solve_positive_definite(&mut [1.0, 2.0, 2.0, 1.0], &mut [1.0, 1.0]));
    }

    #[test]
    fn empty_systems_are_solved() {
        let empty: CsMat<f64> = TriMat::new((0, 0)).to_csc();
        assert!(solve_general(&empty, &mut []).is_ok());
    }
}
