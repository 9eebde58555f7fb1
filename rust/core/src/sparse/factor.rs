// SPDX-License-Identifier: MIT OR Apache-2.0
//! Sparse factorisations. The only file that names the library behind them.
//!
//! A mesh's matrices share one pattern, so [`Cholesky::analyse`] orders and analyses it once and
//! [`Cholesky::refactor`] only computes numbers. Both run on one thread: the dense blocks of surface meshes
//! are too small for the library's own threads to pay.

use faer::diag::Diag;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::linalg::cholesky::llt::factor::{cholesky_in_place as llt_in_place, cholesky_in_place_scratch};
use faer::linalg::evd::{ComputeEigenvectors, self_adjoint_evd, self_adjoint_evd_scratch};
use faer::linalg::matmul::triangular::BlockStructure;
use faer::linalg::{matmul, triangular_solve};
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::amd;
use faer::sparse::linalg::cholesky::supernodal::{SupernodalLltRef, SupernodeRef};
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::linalg::lu::{LuSymbolicParams, NumericLu, factorize_symbolic_lu};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::traits::RealField;
use faer::{Accum, Conj, Mat, MatMut, MatRef, Par, Side, Spec};
use sprs::CsMat;

use crate::Error;

/// A Cholesky factorisation `P A Pᵀ = L Lᵀ` with an approximate minimum degree ordering P.
#[derive(Debug)]
pub struct Cholesky {
    symbolic: SymbolicCholesky<usize>,
    values: Vec<f64>,
}

impl Cholesky {
    /// Orders and analyses the pattern of a symmetric matrix given by its upper triangle; nothing is
    /// factored yet.
    ///
    /// # Errors
    /// [`Error::FactorizationFailed`] where memory is short.
    pub fn analyse(upper: &CsMat<f64>) -> Result<Self, Error> {
        Self::analyse_by(upper, SupernodalThreshold::AUTO)
    }

    /// The threshold decides between columns one by one and supernodes.
    fn analyse_by(
        upper: &CsMat<f64>,
        supernodal_flop_ratio_threshold: SupernodalThreshold,
    ) -> Result<Self, Error> {
        let params = CholeskySymbolicParams { supernodal_flop_ratio_threshold, ..Default::default() };
        let symbolic =
            factorize_symbolic_cholesky(pattern(upper), Side::Upper, SymmetricOrdering::Amd, params)
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
            .map_err(|error| {
                failed(format!("a system of {} unknowns is not positive definite: {error:?}", upper.cols()))
            })?;
        Ok(())
    }

    /// Solves `A x = b` in place for the columns of `rhs`, each as long as the matrix and stored one after
    /// another.
    pub fn solve(&self, rhs: &mut [f64]) {
        let n = self.symbolic.nrows();
        let mut columns = rhs.chunks_mut(n.max(1));
        while let Some(one) = columns.next() {
            match columns.next() {
                Some(two) => self.solve_columns([one, two]),
                None => self.solve_columns([one]),
            }
        }
    }

    /// Solves for K columns at once, so that the factor is read once for all of them.
    fn solve_columns<const K: usize>(&self, mut columns: [&mut [f64]; K]) {
        match self.symbolic.raw() {
            SymbolicCholeskyRaw::Supernodal(symbolic) => {
                let order = self.symbolic.perm().expect("ordered by approximate minimum degree").arrays().0;
                let factor = SupernodalLltRef::new(symbolic, &self.values);
                let mut x: Vec<[f64; K]> =
                    order.iter().map(|&i| std::array::from_fn(|k| columns[k][i])).collect();
                substitute(factor, &mut x);
                for (&i, x) in order.iter().zip(&x) {
                    (0..K).for_each(|k| columns[k][i] = x[k]);
                }
            }
            SymbolicCholeskyRaw::Simplicial(_) => {
                columns.iter_mut().for_each(|column| self.solve_simplicial(column))
            }
        }
    }

    fn solve_simplicial(&self, column: &mut [f64]) {
        let n = self.symbolic.nrows();
        let mut memory = MemBuffer::new(self.symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
        let column = MatMut::from_column_major_slice_mut(column, n, 1);
        let factor = LltRef::new(&self.symbolic, &self.values);
        factor.solve_in_place_with_conj(Conj::No, column, Par::Seq, MemStack::new(&mut memory));
    }
}

/// L⁻ᵀ L⁻¹ x in place for K interleaved right-hand sides.
///
/// The supernodes of a surface mesh are a few columns wide: plain loops over their panels take half the
/// time of one dense kernel call per supernode.
fn substitute<const K: usize>(factor: SupernodalLltRef<'_, usize, f64>, x: &mut [[f64; K]]) {
    let n_supernodes = factor.symbolic().n_supernodes();
    let mut below = Vec::new();
    for s in 0..n_supernodes {
        let supernode = factor.supernode(s);
        forward(supernode, x, &mut below);
    }
    for s in (0..n_supernodes).rev() {
        let supernode = factor.supernode(s);
        backward(supernode, x, &mut below);
    }
}

/// The columns of one panel: its diagonal block on top, the rows of its pattern below.
fn panel_column<'a>(supernode: SupernodeRef<'a, usize, f64>, column: usize) -> &'a [f64] {
    let column = supernode.val().col(column).try_as_col_major().expect("panels are column-major");
    column.as_slice()
}

/// L x = b for the rows of one supernode, its part of the others subtracted.
fn forward<const K: usize>(
    supernode: SupernodeRef<'_, usize, f64>,
    x: &mut [[f64; K]],
    below: &mut Vec<[f64; K]>,
) {
    let (start, width, pattern) = (supernode.start(), supernode.val().ncols(), supernode.pattern());
    below.clear();
    below.resize(pattern.len(), [0.0; K]);
    for j in 0..width {
        let column = panel_column(supernode, j);
        let pivot = x[start + j].map(|value| value / column[j]);
        x[start + j] = pivot;
        subtract_multiple(&mut x[start + j + 1..start + width], &column[j + 1..width], pivot);
        subtract_multiple(below, &column[width..], pivot);
    }
    for (&row, part) in pattern.iter().zip(below.iter()) {
        (0..K).for_each(|k| x[row][k] += part[k]);
    }
}

/// Lᵀ x = b for the rows of one supernode, all later ones known.
fn backward<const K: usize>(
    supernode: SupernodeRef<'_, usize, f64>,
    x: &mut [[f64; K]],
    below: &mut Vec<[f64; K]>,
) {
    let (start, width, pattern) = (supernode.start(), supernode.val().ncols(), supernode.pattern());
    below.clear();
    below.extend(pattern.iter().map(|&row| x[row]));
    for j in (0..width).rev() {
        let column = panel_column(supernode, j);
        let inside = inner_products(&column[j + 1..width], &x[start + j + 1..start + width]);
        let outside = inner_products(&column[width..], below);
        x[start + j] = std::array::from_fn(|k| (x[start + j][k] - inside[k] - outside[k]) / column[j]);
    }
}

/// `out -= column · factor` for every right-hand side.
fn subtract_multiple<const K: usize>(out: &mut [[f64; K]], column: &[f64], factor: [f64; K]) {
    for (out, entry) in out.iter_mut().zip(column) {
        (0..K).for_each(|k| out[k] -= entry * factor[k]);
    }
}

/// `columnᵀ x` for every right-hand side, in four interleaved sums.
fn inner_products<const K: usize>(column: &[f64], x: &[[f64; K]]) -> [f64; K] {
    let mut sums = [[0.0; K]; 4];
    let (quads, x_quads) = (column.as_chunks::<4>(), x.as_chunks::<4>());
    for (entries, x) in quads.0.iter().zip(x_quads.0) {
        (0..4).for_each(|lane| (0..K).for_each(|k| sums[lane][k] += entries[lane] * x[lane][k]));
    }
    for (entry, x) in quads.1.iter().zip(x_quads.1) {
        (0..K).for_each(|k| sums[0][k] += entry * x[k]);
    }
    std::array::from_fn(|k| (sums[0][k] + sums[1][k]) + (sums[2][k] + sums[3][k]))
}

/// Solves `A x = b` in place for a general square matrix by LU with column ordering; `rhs` as in
/// [`Cholesky::solve`].
///
/// # Errors
/// [`Error::FactorizationFailed`] where the matrix is singular to working precision.
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
    match rhs.iter().all(|x| x.is_finite()) {
        true => Ok(()),
        false => Err(failed(format!("LU of {n} unknowns: the matrix is singular"))),
    }
}

/// A unit eigenvector of the largest eigenvalue of a symmetric matrix given by rows; the first axis where the
/// iteration fails.
pub(crate) fn top_eigenvector<const N: usize>(symmetric: &[[f64; N]; N]) -> [f64; N] {
    let matrix = Mat::from_fn(N, N, |i, j| symmetric[i][j]);
    let (mut values, mut vectors) = (Diag::zeros(N), Mat::zeros(N, N));
    // on this thread: the library's own pool does not survive a fork
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

/// A column-major part of a dense matrix that may be written.
pub(super) type Block<'a, T> = MatMut<'a, T>;
/// A column-major part of a dense matrix.
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

/// `out -= a · bᵀ` or, to replace it, `out := −a · bᵀ`; for a square `out` the lower triangle only, if asked for.
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

/// An order of the nodes of a graph that keeps the factor sparse, by approximate minimum degree (Amestoy, Davis and
/// Duff 1996); the neighbours of node v are those from `starts[v]` to `starts[v + 1]`.
///
/// # Errors
/// [`Error::FactorizationFailed`] where there are too many edges for 32-bit indices.
pub(super) fn minimum_degree(starts: &[u32], neighbours: &[u32]) -> Result<Vec<u32>, Error> {
    let n = starts.len() - 1;
    let graph = SymbolicSparseColMatRef::new_checked(n, n, starts, None, neighbours);
    let (mut order, mut position) = (vec![0; n], vec![0; n]);
    let mut memory = MemBuffer::new(amd::order_scratch::<u32>(n, neighbours.len()));
    amd::order(&mut order, &mut position, graph, amd::Control::default(), MemStack::new(&mut memory))
        .map_err(|error| failed(format!("ordering {n} unknowns: {error:?}")))?;
    Ok(order)
}

fn pattern(matrix: &CsMat<f64>) -> SymbolicSparseColMatRef<'_, usize> {
    assert!(matrix.is_csc(), "the factorisations take compressed columns");
    let (starts, rows) = (matrix.indptr().into_raw_storage(), matrix.indices());
    SymbolicSparseColMatRef::new_checked(matrix.rows(), matrix.cols(), starts, None, rows)
}

fn failed(what: String) -> Error {
    Error::FactorizationFailed { what }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprs::TriMat;

    /// The upper triangle of the five-point Laplacian of an n × n grid, shifted to be definite.
    fn grid_laplacian(n: usize) -> CsMat<f64> {
        let mut matrix = TriMat::new((n * n, n * n));
        for i in 0..n * n {
            matrix.add_triplet(i, i, 5.1 + (i as f64).sin());
            if i % n + 1 < n {
                matrix.add_triplet(i, i + 1, -1.0);
            }
            if i + n < n * n {
                matrix.add_triplet(i, i + n, -1.0);
            }
        }
        matrix.to_csc()
    }

    /// Largest entry of A x − b, A symmetric from its upper triangle.
    fn residual(upper: &CsMat<f64>, x: &[f64], b: &[f64]) -> f64 {
        let mut product = vec![0.0; x.len()];
        for (value, (row, column)) in upper.iter() {
            product[row] += value * x[column];
            if row != column {
                product[column] += value * x[row];
            }
        }
        product.iter().zip(b).map(|(p, b)| (p - b).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn solves_one_two_and_three_columns_by_either_factorisation() {
        let forced =
            [(SupernodalThreshold::FORCE_SIMPLICIAL, false), (SupernodalThreshold::FORCE_SUPERNODAL, true)];
        for (n, (threshold, supernodal)) in [3, 30].into_iter().flat_map(|n| forced.map(|by| (n, by))) {
            let matrix = grid_laplacian(n);
            let mut factor = Cholesky::analyse_by(&matrix, threshold).unwrap();
            factor.refactor(&matrix).unwrap();
            assert_eq!(matches!(factor.symbolic.raw(), SymbolicCholeskyRaw::Supernodal(_)), supernodal);
            for columns in 1..=3 {
                let b: Vec<f64> = (0..columns * n * n).map(|i| (0.37 * i as f64).cos()).collect();
                let mut x = b.clone();
                factor.solve(&mut x);
                for (x, b) in x.chunks(n * n).zip(b.chunks(n * n)) {
                    assert!(residual(&matrix, x, b) < 1e-12);
                }
            }
        }
    }

    #[test]
    fn refactoring_uses_the_new_values() {
        let mut matrix = grid_laplacian(5);
        let mut factor = Cholesky::analyse(&matrix).unwrap();
        factor.refactor(&matrix).unwrap();
        matrix.data_mut().iter_mut().for_each(|value| *value *= 2.0);
        factor.refactor(&matrix).unwrap();
        let b = vec![1.0; 25];
        let mut x = b.clone();
        factor.solve(&mut x);
        assert!(residual(&matrix, &x, &b) < 1e-13);
    }

    #[test]
    fn indefinite_and_singular_matrices_are_refused() {
        let mut indefinite = TriMat::new((2, 2));
        for (i, j, value) in [(0, 0, 1.0), (0, 1, 2.0), (1, 1, 1.0)] {
            indefinite.add_triplet(i, j, value);
        }
        let indefinite: CsMat<f64> = indefinite.to_csc();
        assert!(Cholesky::analyse(&indefinite).unwrap().refactor(&indefinite).is_err());
        let mut singular = TriMat::new((2, 2));
        for (i, j, value) in [(0, 0, 1.0), (0, 1, 2.0), (1, 0, 2.0), (1, 1, 4.0)] {
            singular.add_triplet(i, j, value);
        }
        assert!(solve_general(&singular.to_csc(), &mut [1.0, 1.0]).is_err());
    }

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
    fn empty_systems_are_solved() {
        let empty: CsMat<f64> = TriMat::new((0, 0)).to_csc();
        let mut factor = Cholesky::analyse(&empty).unwrap();
        factor.refactor(&empty).unwrap();
        factor.solve(&mut []);
        assert!(solve_general(&empty, &mut []).is_ok());
    }
}
