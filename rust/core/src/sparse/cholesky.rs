// SPDX-License-Identifier: MIT OR Apache-2.0
//! Factorizations of matrices that are given entry by entry.
//!
//! A mesh's matrices share one pattern, so [`Cholesky::analyze_on`] orders and analyzes it once and
//! [`Cholesky::refactor_while`] only computes numbers. Input: the upper triangle in compressed columns. Cost and
//! method: see [`super::multifrontal`], of which each entry is an element.

use sprs::CsMat;

use super::multifrontal::dense::Failure;
use super::multifrontal::{Element, Factor, NONE, Order, Place, Symbolic};
use crate::control::Watch;
use crate::error::{Error, NumericsError};
use crate::mesh::TriangleMesh;

/// A Cholesky factorization `P A Pᵀ = L Lᵀ` with a fill-reducing ordering P.
#[derive(Debug, Clone)]
pub struct Cholesky {
    symbolic: Symbolic,
    factor: Factor<f64>,
}

impl Cholesky {
    /// [`Self::analyze_on`] for rows that are no vertices, in an order computed for them.
    ///
    /// # Errors
    /// As [`Self::analyze_on`].
    pub(crate) fn analyze(upper: &CsMat<f64>) -> Result<Self, Error> {
        Self::analyze_in(Order::Sparse, upper)
    }

    /// Orders and analyzes the pattern of a symmetric matrix given by its upper triangle; nothing is factored yet.
    /// The rows are vertices of the mesh, ascending, and its elimination order is used if it has one.
    ///
    /// # Errors
    /// [`NumericsError::FactorizationFailed`] where the matrix is too large for 32-bit indices,
    /// [`NumericsError::ArraysOutOfMemory`] where there is no memory for its factor.
    pub(crate) fn analyze_on(mesh: &TriangleMesh, upper: &CsMat<f64>) -> Result<Self, Error> {
        let order = if mesh.in_elimination_order() { Order::AsGiven } else { Order::Sparse };
        Self::analyze_in(order, upper)
    }

    fn analyze_in(order: Order, upper: &CsMat<f64>) -> Result<Self, Error> {
        assert!(upper.is_csc(), "the factorizations take compressed columns");
        let entry = |(_, (row, column)): (&f64, (usize, usize))| {
            if row == column { [row as u32, NONE, NONE] } else { [row as u32, column as u32, NONE] }
        };
        let entries: Vec<[u32; 3]> = upper.iter().map(entry).collect();
        let symbolic = Symbolic::new(&entries, &vec![1; upper.cols()], order)?;
        symbolic.require_memory(1.0)?;
        let factor = Factor::of(&symbolic);
        Ok(Self { symbolic, factor })
    }

    /// `refactor_while` that nothing cancels.
    #[cfg(test)]
    pub(crate) fn refactor(&mut self, upper: &CsMat<f64>) -> Result<(), Error> {
        let mut silent = crate::control::Silent;
        self.refactor_while(upper, &Watch::new(&mut silent, 0.0, ""))
    }

    /// Factors a matrix of the analyzed pattern, given by its upper triangle.
    ///
    /// # Errors
    /// [`NumericsError::FactorizationFailed`] where the matrix is not positive definite to working precision,
    /// [`Error::CancelledEarly`] where the watch's observer ends the run.
    pub(crate) fn refactor_while(&mut self, upper: &CsMat<f64>, watch: &Watch<'_>) -> Result<(), Error> {
        let values = upper.data();
        let assemble = |element: &Element, place: &mut Place<'_, f64>| {
            let column = if element.rows[1] == NONE { element.rows[0] } else { element.rows[1] };
            place.add(element.rows[0] as usize, column as usize, values[element.index as usize]);
        };
        self.factor.refactor_by(&self.symbolic, &assemble, watch).map_err(|failure| match failure {
            Failure::Cancelled => Error::CancelledEarly,
            Failure::NotPositiveDefinite => NumericsError::FactorizationFailed {
                what: format!("a system of {} unknowns is not positive definite", upper.cols()),
            }
            .into(),
        })
    }

    /// Solves `A x = b` in place for the columns of `rhs`, each as long as the matrix and stored one after
    /// another.
    pub fn solve(&self, rhs: &mut [f64]) {
        self.factor.solve_by(&self.symbolic, rhs);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sparse::solve_general;
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
    fn solves_one_two_and_three_columns() {
        for n in [1, 3, 30, 90] {
            let matrix = grid_laplacian(n);
            let mut factor = Cholesky::analyze(&matrix).unwrap();
            factor.refactor(&matrix).unwrap();
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
        let mut factor = Cholesky::analyze(&matrix).unwrap();
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
        assert!(Cholesky::analyze(&indefinite).unwrap().refactor(&indefinite).is_err());
        let mut singular = TriMat::new((2, 2));
        for (i, j, value) in [(0, 0, 1.0), (0, 1, 2.0), (1, 0, 2.0), (1, 1, 4.0)] {
            singular.add_triplet(i, j, value);
        }
        assert!(solve_general(&singular.to_csc(), &mut [1.0, 1.0]).is_err());
    }

    #[test]
    fn empty_systems_are_solved() {
        let empty: CsMat<f64> = TriMat::new((0, 0)).to_csc();
        let mut factor = Cholesky::analyze(&empty).unwrap();
        factor.refactor(&empty).unwrap();
        factor.solve(&mut []);
    }
}
