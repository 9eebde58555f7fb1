// SPDX-License-Identifier: MIT OR Apache-2.0
//! Types of indices, which index slices.

use std::fmt;
use std::num::NonZeroU32;
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

/// A corner of a face: corner `3 * face + k` is that at vertex `k` of the face. It also stands for the edge opposite to
/// that vertex.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(transparent)]
pub struct Corner(
    /// The index plus 1, so that an `Option<Corner>` is no larger.
    NonZeroU32,
);

/// An edge of a mesh, by its index among the edges that [`Edges`](super::Edges) numbers.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub(crate) struct Edge(pub u32);

index_slices!(Vertex);
index_slices!(Face);
index_slices!(Corner);
index_slices!(Edge);

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

impl Edge {
    /// The edge of an index below 2³².
    pub(crate) const fn new(index: usize) -> Self {
        Self(index as u32)
    }

    /// The index of the edge.
    pub(crate) const fn index(self) -> usize {
        self.0 as usize
    }

    /// The edges with the indices `0..n`.
    pub(crate) fn all(n: usize) -> impl DoubleEndedIterator<Item = Self> + ExactSizeIterator + Clone {
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

    /// The face's corner at vertex `k`.
    pub const fn corner(self, k: usize) -> Corner {
        Corner::new(3 * self.index() + k)
    }

    /// The face's three corners.
    pub const fn corners(self) -> [Corner; 3] {
        [self.corner(0), self.corner(1), self.corner(2)]
    }
}

impl Corner {
    /// The corner of an index below 2³² − 1.
    pub const fn new(index: usize) -> Self {
        Self(NonZeroU32::MIN.saturating_add(index as u32))
    }

    /// The index of the corner.
    pub const fn index(self) -> usize {
        (self.0.get() - 1) as usize
    }

    /// The corners of the first `n_faces` faces.
    pub fn all(n_faces: usize) -> impl DoubleEndedIterator<Item = Self> + ExactSizeIterator + Clone {
        (0..3 * n_faces).map(Self::new)
    }

    /// The face of the corner.
    pub const fn face(self) -> Face {
        Face((self.0.get() - 1) / 3)
    }

    /// The place of the corner in its face: 0, 1 or 2.
    pub const fn place(self) -> usize {
        self.index() % 3
    }

    /// The next corner of the same face.
    pub const fn next(self) -> Self {
        Self::new(if self.place() == 2 { self.index() - 2 } else { self.index() + 1 })
    }

    /// The previous corner of the same face.
    pub const fn previous(self) -> Self {
        Self::new(if self.place() == 0 { self.index() + 2 } else { self.index() - 1 })
    }

    /// Where the corner comes to lie when corners 1 and 2 of its face change places.
    pub const fn mirrored(self) -> Self {
        self.face().corner((3 - self.place()) % 3)
    }

    /// The vertex at the corner.
    pub fn vertex(self, faces: &[[Vertex; 3]]) -> Vertex {
        faces[self.face()][self.place()]
    }

    /// The edge opposite to the corner, in the direction of its face.
    pub fn half_edge(self, faces: &[[Vertex; 3]]) -> [Vertex; 2] {
        [self.next().vertex(faces), self.previous().vertex(faces)]
    }
}

/// Corner 0.
impl Default for Corner {
    fn default() -> Self {
        Self::new(0)
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
    fn corners_run_around_their_face() {
        for face in Face::all(5) {
            let [a, b, c] = face.corners();
            assert_eq!([a.next(), b.next(), c.next()], [b, c, a]);
            assert_eq!([a.previous(), b.previous(), c.previous()], [c, a, b]);
            assert_eq!([a.mirrored(), b.mirrored(), c.mirrored()], [a, c, b]);
            assert_eq!([a.place(), b.place(), c.place()], [0, 1, 2]);
            assert!([a, b, c].iter().all(|corner| corner.face() == face));
            assert_eq!(c.index(), 3 * face.index() + 2);
        }
        assert!(Corner::all(5).eq(Face::all(5).flat_map(Face::corners)));
    }

    #[test]
    fn corners_have_a_vertex_and_an_opposite_edge() {
        let faces = faces_of_indices(&[[0, 1, 2], [2, 1, 3]]);
        let corner = Face::new(1).corner(2);
        assert_eq!(corner.vertex(&faces), Vertex(3));
        assert_eq!(corner.half_edge(&faces), [Vertex(2), Vertex(1)]);
    }

    #[test]
    fn the_largest_corner_fits_and_an_option_takes_no_more_memory() {
        let last = u32::MAX as usize - 1;
        assert_eq!(Corner::new(last).index(), last);
        assert_eq!(size_of::<Option<Corner>>(), size_of::<u32>());
    }

    #[test]
    fn indices_read_and_write_slices_and_print_as_numbers() {
        let mut values = vec![1, 2, 3];
        values[Face(1)] += 10;
        assert_eq!((values[Vertex(1)], values.as_slice()[Face(0).corner(2)]), (12, 3));
        assert_eq!(format!("{} {:?}", Vertex(7), Face(8)), "7 8");
    }
}
