// SPDX-License-Identifier: MIT OR Apache-2.0
//! Arrays of the public functions, and the rows of fixed length that the loops inside run over.

use std::borrow::Cow;

use ndarray::{Array2, ArrayView2, CowArray, Ix2};

use crate::error::Error;
use crate::vector::{Vector3, coordinates};

/// An (n, N) array in row-major order, copied only where it is borrowed or in another order.
///
/// # Errors
/// [`Error::InvalidArray`] where the rows have another length.
pub(crate) fn row_major<const N: usize, T: Clone>(
    name: &'static str,
    array: CowArray<'_, T, Ix2>,
) -> Result<Array2<T>, Error> {
    check_width::<N>(name, array.dim())?;
    if array.is_standard_layout() {
        return Ok(array.into_owned());
    }
    Ok(array.as_standard_layout().into_owned())
}

/// The rows of an (n, N) array, copied only where it is not in row-major order.
///
/// # Errors
/// As [`row_major`].
pub(crate) fn rows_of<'a, const N: usize, T: Clone>(
    name: &'static str,
    array: ArrayView2<'a, T>,
) -> Result<Cow<'a, [[T; N]]>, Error> {
    check_width::<N>(name, array.dim())?;
    Ok(match array.to_slice() {
        Some(flat) => flat.as_chunks().0.into(),
        None => rows(array.as_standard_layout().view()).to_vec().into(),
    })
}

fn check_width<const N: usize>(name: &'static str, (length, width): (usize, usize)) -> Result<(), Error> {
    if width == N {
        return Ok(());
    }
    let (found, expected) = (format!("of shape ({length}, {width})"), format!("of shape (n, {N})"));
    Err(Error::InvalidArray { name, found, expected })
}

/// The rows of an array in row-major order, as all are that this crate returns.
pub fn rows<const N: usize, T>(array: ArrayView2<'_, T>) -> &[[T; N]] {
    array.to_slice().expect("the array is in row-major order").as_chunks().0
}

/// The rows of an (n, 3) array in row-major order as vectors.
pub fn vectors(array: ArrayView2<'_, f64>) -> Vec<Vector3> {
    rows(array).iter().copied().map(Vector3).collect()
}

/// Rows as an (n, N) array, without a copy.
pub(crate) fn from_rows<const N: usize, T>(rows: Vec<[T; N]>) -> Array2<T> {
    let shape = (rows.len(), N);
    Array2::from_shape_vec(shape, rows.into_flattened()).expect("the lengths agree")
}

/// Vectors as an (n, 3) array.
pub(crate) fn from_vectors(vectors: Vec<Vector3>) -> Array2<f64> {
    from_rows(coordinates(vectors))
}
