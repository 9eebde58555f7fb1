// SPDX-License-Identifier: MIT OR Apache-2.0
//! Types of indices, which index slices.

use std::fmt;
use std::ops::{Index, IndexMut};

use ndarray::Array2;

use crate::arrays::from_rows;

/// Lets a type of indices index slices, convert to its number and print as it.
macro_rules! index_slices {
    ($Index:ident) => {
        impl<T> Index<$Index> for [T] {
            type Output = T;

            fn index(&self, index: $Index) -> &T {
                &self[index.index()]
            }
        }

        impl<T> IndexMut<$Index> for [T] {
            fn index_mut(&mut self, index: $Index) -> &mut T {
                &mut self[index.index()]
            }
        }

        impl<T> Index<$Index> for Vec<T> {
            type Output = T;

            fn index(&self, index: $Index) -> &T {
                &self[index.index()]
            }
        }

        impl<T> IndexMut<$Index> for Vec<T> {
            fn index_mut(&mut self, index: $Index) -> &mut T {
                &mut self[index.index()]
            }
        }

        impl From<$Index> for usize {
            fn from(index: $Index) -> Self {
                index.index()
            }
        }

        impl fmt::Display for $Index {
            fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                self.index().fmt(formatter)
            }
        }

        impl fmt::Debug for $Index {
            fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                self.index().fmt(formatter)
            }
        }
    };
}

/// A vertex of a mesh, by its index.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct Vertex(pub u32);

/// A face of a mesh, by its index.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct Face(pub u32);

index_slices!(Vertex);
index_slices!(Face);

impl Vertex {
    /// The vertex of an index below 2³².
    pub const fn new(index: usize) -> Self {
        Self(index as u32)
    }

    /// The index of the vertex.
    pub const fn index(self) -> usize {
        self.0 as usize
    }

    /// The vertices with the indices `0..n`.
    pub fn all(n: usize) -> impl DoubleEndedIterator<Item = Self> + ExactSizeIterator + Clone {
        (0..n).map(Self::new)
    }
}

impl From<u32> for Vertex {
    fn from(index: u32) -> Self {
        Self(index)
    }
}

impl Face {
    /// The face of an index below 2³².
    pub const fn new(index: usize) -> Self {
        Self(index as u32)
    }

    /// The index of the face.
    pub const fn index(self) -> usize {
        self.0 as usize
    }

    /// The faces with the indices `0..n`.
    pub fn all(n: usize) -> impl DoubleEndedIterator<Item = Self> + ExactSizeIterator + Clone {
        (0..n).map(Self::new)
    }

    /// The face of a corner, an index `3 * face + k`.
    pub const fn of_corner(corner: u32) -> Self {
        Self(corner / 3)
    }

    /// The index of the face's corner at vertex `k`.
    pub const fn corner(self, k: usize) -> usize {
        3 * self.index() + k
    }

    /// The indices of the face's three corners.
    pub const fn corners(self) -> [usize; 3] {
        [self.corner(0), self.corner(1), self.corner(2)]
    }
}

/// Faces of the vertices with the indices in rows, (m, 3).
#[cfg(test)]
pub(crate) fn faces_of_indices(rows: &[[u32; 3]]) -> Vec<[Vertex; 3]> {
    rows.iter().map(|row| row.map(Vertex)).collect()
}

/// The indices of the vertices of each of `rows`, (m, N).
pub(crate) fn index_array<const N: usize>(rows: &[[Vertex; N]]) -> Array2<u32> {
    from_rows(rows.iter().map(|row| row.map(|vertex| vertex.0)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_belong_to_their_face() {
        for face in Face::all(5) {
            assert_eq!(face.corners(), [0, 1, 2].map(|k| face.corner(k)));
            assert!(face.corners().iter().all(|&corner| Face::of_corner(corner as u32) == face));
        }
        assert_eq!(Face(4).corners(), [12, 13, 14]);
    }

    #[test]
    fn indices_read_and_write_slices_and_print_as_numbers() {
        let mut values = vec![1, 2, 3];
        values[Face(1)] += 10;
        assert_eq!((values[Vertex(1)], values.as_slice()[Face::new(2)]), (12, 3));
        assert_eq!(format!("{} {:?}", Vertex(7), Face(8)), "7 8");
    }
}
