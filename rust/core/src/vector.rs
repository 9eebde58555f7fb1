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

    /// The vector of length 1 in the same direction; not finite where the length is 0.
    pub fn normalized(self) -> Self {
        self * (1.0 / self.norm())
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

#[cfg(test)]
mod tests {
    use super::*;

    const A: Vector3 = Vector3([1.0, -2.0, 0.5]);
    const B: Vector3 = Vector3([3.0, 0.25, -4.0]);

    #[test]
    fn operators_act_on_each_coordinate() {
        assert_eq!(A + B, Vector3([4.0, -1.75, -3.5]));
        assert_eq!(A - B, Vector3([-2.0, -2.25, 4.5]));
        assert_eq!(A * 2.0, Vector3([2.0, -4.0, 1.0]));
        assert_eq!(-A, Vector3([-1.0, 2.0, -0.5]));
        let mut sum = A;
        sum += B;
        assert_eq!(sum, A + B);
        assert_eq!([A, B, -B].into_iter().sum::<Vector3>(), A);
        assert_eq!(A.map(f64::abs), Vector3([1.0, 2.0, 0.5]));
    }

    #[test]
    fn products_satisfy_the_identities_of_the_textbook() {
        // Lagrange: |a × b|² + (a · b)² = |a|² |b|²
        let cross = A.cross(B);
        let squares = |x: f64| x * x;
        let difference = cross.norm().powi(2) + squares(A.dot(B)) - squares(A.norm() * B.norm());
        assert!(difference.abs() < 1e-12);
        // a × b is orthogonal to both, and the axes are right-handed
        assert!(cross.dot(A).abs() < 1e-15 && cross.dot(B).abs() < 1e-15);
        let [x, y, z] = [0, 1, 2].map(Vector3::unit);
        assert_eq!([x.cross(y), y.cross(z), z.cross(x)], [z, x, y]);
        assert_eq!(A.cross(B), -B.cross(A));
    }

    #[test]
    fn lengths_are_those_of_pythagoras() {
        assert_eq!(Vector3([2.0, -3.0, 6.0]).norm(), 7.0);
        assert_eq!(Vector3([1.0, 1.0, 1.0]).distance(Vector3([3.0, -2.0, 7.0])), 7.0);
        assert_eq!(B.max_abs(), 4.0);
        assert!(A.is_finite() && !Vector3([0.0, f64::NAN, 0.0]).is_finite());
    }

    #[test]
    fn coordinates_are_read_and_written_by_axis() {
        let mut vector = Vector3::from([1.0, 2.0, 3.0]);
        vector[1] = 5.0;
        assert_eq!([vector[0], vector[1], vector[2]], <[f64; 3]>::from(vector));
        assert_eq!(coordinates([vector, Vector3::ZERO]), [[1.0, 5.0, 3.0], [0.0; 3]]);
    }
}
