// SPDX-License-Identifier: MIT OR Apache-2.0
//! Arrays of the public functions, and the rows of fixed length that the loops inside run over.

use ndarray::{Array2, CowArray, Ix2};

use crate::error::Error;

/// An (n, N) array in row-major order, copied only where it is borrowed or in another order.
///
/// # Errors
/// [`Error::InvalidArray`] where the rows have another length.
pub(crate) fn row_major<const N: usize, T: Clone>(
    name: &'static str,
    array: CowArray<'_, T, Ix2>,
) -> Result<Array2<T>, Error> {
    if array.ncols() != N {
        let (found, expected) =
            (format!("of shape ({}, {})", array.nrows(), array.ncols()), format!("of shape (n, {N})"));
        return Err(Error::InvalidArray { name, found, expected });
    }
    if array.is_standard_layout() {
        return Ok(array.into_owned());
    }
    Ok(array.as_standard_layout().into_owned())
}

/// The rows of an array that [`row_major`] or [`from_rows`] made.
pub(crate) fn rows<const N: usize, T>(array: &Array2<T>) -> &[[T; N]] {
    array.as_slice().expect("the array is in row-major order").as_chunks().0
}

/// Rows as an (n, N) array, without a copy.
pub(crate) fn from_rows<const N: usize, T>(rows: Vec<[T; N]>) -> Array2<T> {
    let shape = (rows.len(), N);
    Array2::from_shape_vec(shape, rows.into_flattened()).expect("the lengths agree")
}
