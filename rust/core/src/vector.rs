// SPDX-License-Identifier: MIT OR Apache-2.0
//! Small vectors with operators.

use std::iter::Sum;
use std::ops::{Add, AddAssign, Index, IndexMut, Mul, Neg, Sub};

/// A point or vector in space.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd, Default)]
pub struct Vector3(pub [f64; 3]);

impl Vector3 {
    /// The origin, or the vector without length.
    pub const ZERO: Self = Self([0.0; 3]);

    /// The vector with the coordinates `coordinate(0)`, `coordinate(1)` and `coordinate(2)`.
    pub fn from_fn(coordinate: impl FnMut(usize) -> f64) -> Self {
        Self(std::array::from_fn(coordinate))
    }

    /// The unit vector along an axis.
    pub fn unit(axis: usize) -> Self {
        Self::from_fn(|k| if k == axis { 1.0 } else { 0.0 })
    }

    /// The inner product with `other`.
    pub fn dot(self, other: Self) -> f64 {
        let (Self(a), Self(b)) = (self, other);
        a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    }

    /// The cross product with `other`.
    pub fn cross(self, other: Self) -> Self {
        let (Self(a), Self(b)) = (self, other);
        Self([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])
    }

    /// The length.
    pub fn norm(self) -> f64 {
        self.dot(self).sqrt()
    }

    /// The distance to the point `other`.
    pub fn distance(self, other: Self) -> f64 {
        (self - other).norm()
    }

    /// Whether no coordinate is infinite or no number.
    pub fn is_finite(self) -> bool {
        self.0.iter().all(|x| x.is_finite())
    }

    /// The largest absolute value of a coordinate.
    pub fn max_abs(self) -> f64 {
        self.0.iter().fold(0.0, |most, x| f64::max(most, x.abs()))
    }

    /// The vector whose coordinates are those of this one, each passed through `f`.
    pub fn map(self, f: impl FnMut(f64) -> f64) -> Self {
        Self(self.0.map(f))
    }
}

/// The coordinates of vectors, (n, 3).
pub fn coordinates(vectors: impl IntoIterator<Item = Vector3>) -> Vec<[f64; 3]> {
    vectors.into_iter().map(Into::into).collect()
}

impl Add for Vector3 {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let (Self(a), Self(b)) = (self, other);
        Self([a[0] + b[0], a[1] + b[1], a[2] + b[2]])
    }
}

impl Sub for Vector3 {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        let (Self(a), Self(b)) = (self, other);
        Self([a[0] - b[0], a[1] - b[1], a[2] - b[2]])
    }
}

impl Mul<f64> for Vector3 {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        self.map(|x| factor * x)
    }
}

impl Neg for Vector3 {
    type Output = Self;

    fn neg(self) -> Self {
        self.map(|x| -x)
    }
}

impl AddAssign for Vector3 {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Sum for Vector3 {
    fn sum<I: Iterator<Item = Self>>(vectors: I) -> Self {
        vectors.fold(Self::ZERO, Self::add)
    }
}

impl Index<usize> for Vector3 {
    type Output = f64;

    fn index(&self, axis: usize) -> &f64 {
        &self.0[axis]
    }
}

impl IndexMut<usize> for Vector3 {
    fn index_mut(&mut self, axis: usize) -> &mut f64 {
        &mut self.0[axis]
    }
}

impl From<[f64; 3]> for Vector3 {
    fn from(coordinates: [f64; 3]) -> Self {
        Self(coordinates)
    }
}

impl From<Vector3> for [f64; 3] {
    fn from(vector: Vector3) -> Self {
        vector.0
    }
}
