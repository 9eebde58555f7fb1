// SPDX-License-Identifier: MIT OR Apache-2.0
//! The positive semidefinite part of a small symmetric matrix.

/// Off-diagonal entries count as zero when their squares are below this part of the diagonal's.
const CLEAN: f64 = 1e-24;

/// Limit of the sweeps of Jacobi rotations; six or seven are usual.
const SWEEPS: usize = 30;

/// Sets the negative eigenvalues of a symmetric matrix to zero, by Jacobi rotations (Golub & Van Loan, section 8.5).
pub(crate) fn clamp_negative_eigenvalues<const N: usize>(matrix: &mut [[f64; N]; N]) {
    let mut vectors = [[0.0; N]; N];
    (0..N).for_each(|k| vectors[k][k] = 1.0);
    for _ in 0..SWEEPS {
        let diagonal: f64 = (0..N).map(|k| matrix[k][k] * matrix[k][k]).sum();
        let rest: f64 = (0..N).map(|p| (0..p).map(|q| matrix[p][q] * matrix[p][q]).sum::<f64>()).sum();
        if rest <= CLEAN * diagonal || !(rest + diagonal).is_finite() {
            break;
        }
        for p in 0..N {
            (p + 1..N).for_each(|q| rotate(matrix, &mut vectors, p, q));
        }
    }
    let values: [f64; N] = std::array::from_fn(|k| matrix[k][k].max(0.0));
    for row in 0..N {
        for column in 0..N {
            matrix[row][column] = (0..N).map(|k| values[k] * vectors[row][k] * vectors[column][k]).sum();
        }
    }
}

/// The rotation of rows and columns p and q that makes their entry vanish.
fn rotate<const N: usize>(matrix: &mut [[f64; N]; N], vectors: &mut [[f64; N]; N], p: usize, q: usize) {
    if matrix[p][q] == 0.0 {
        return;
    }
    let ratio = (matrix[q][q] - matrix[p][p]) / (2.0 * matrix[p][q]);
    let tangent = ratio.signum() / (ratio.abs() + (ratio * ratio + 1.0).sqrt());
    let cosine = (tangent * tangent + 1.0).sqrt().recip();
    let sine = tangent * cosine;
    let turn = |a: f64, b: f64| (cosine * a - sine * b, sine * a + cosine * b);
    for row in matrix.iter_mut() {
        (row[p], row[q]) = turn(row[p], row[q]);
    }
    for k in 0..N {
        (matrix[p][k], matrix[q][k]) = turn(matrix[p][k], matrix[q][k]);
        (vectors[k][p], vectors[k][q]) = turn(vectors[k][p], vectors[k][q]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_clamped_matrix_keeps_the_positive_part() {
        // 3 vvᵀ − 2 wwᵀ with orthonormal v, w
        let (v, w) = ([0.5, 0.5, 0.5, 0.5], [0.5, -0.5, 0.5, -0.5]);
        let mut matrix: [[f64; 4]; 4] =
            std::array::from_fn(|i| std::array::from_fn(|j| 3.0 * v[i] * v[j] - 2.0 * w[i] * w[j]));
        clamp_negative_eigenvalues(&mut matrix);
        for i in 0..4 {
            (0..4).for_each(|j| assert!((matrix[i][j] - 3.0 * v[i] * v[j]).abs() < 1e-11));
        }
    }
}
