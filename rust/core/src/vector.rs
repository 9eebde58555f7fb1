// SPDX-License-Identifier: MIT OR Apache-2.0
//! Vectors in space, plain `[f64; 3]`.

/// A point or vector in space.
pub type Vector = [f64; 3];

/// `a + b`.
pub fn add(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// `a - b`.
pub fn sub(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `factor * a`.
pub fn scaled(a: Vector, factor: f64) -> Vector {
    a.map(|x| factor * x)
}

/// The inner product of `a` and `b`.
pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The cross product of `a` and `b`.
pub fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The length of `a`.
pub fn norm(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

/// The distance of two points.
pub fn distance(a: Vector, b: Vector) -> f64 {
    norm(sub(a, b))
}
