// SPDX-License-Identifier: MIT OR Apache-2.0
//! Types of indices, which index slices.

use std::fmt;
use std::ops::{Index, IndexMut};

/// A face of a mesh, by its index.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct Face(pub u32);

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
    pub fn all(n: usize) -> impl ExactSizeIterator<Item = Self> + Clone {
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

impl<T> Index<Face> for [T] {
    type Output = T;

    fn index(&self, face: Face) -> &T {
        &self[face.index()]
    }
}

impl<T> IndexMut<Face> for [T] {
    fn index_mut(&mut self, face: Face) -> &mut T {
        &mut self[face.index()]
    }
}

impl<T> Index<Face> for Vec<T> {
    type Output = T;

    fn index(&self, face: Face) -> &T {
        &self[face.index()]
    }
}

impl<T> IndexMut<Face> for Vec<T> {
    fn index_mut(&mut self, face: Face) -> &mut T {
        &mut self[face.index()]
    }
}

impl fmt::Display for Face {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(formatter)
    }
}

impl fmt::Debug for Face {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(formatter)
    }
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
    fn faces_index_slices_and_print_as_numbers() {
        let mut values = vec![1, 2, 3];
        values[Face(1)] += 10;
        assert_eq!((values[Face(1)], values.as_slice()[Face::new(2)]), (12, 3));
        assert_eq!(format!("{} {:?}", Face(7), Face(8)), "7 8");
    }
}
