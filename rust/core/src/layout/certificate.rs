// SPDX-License-Identifier: MIT OR Apache-2.0
//! Decides which faces are folded in the precision asked for.

use super::chart::{Point, signed_area};
use crate::parallel;

/// The precision of the points of a layout, in which no face is folded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Precision {
    /// 32-bit floating point numbers.
    Single,
    /// 64-bit floating point numbers.
    #[default]
    Double,
}

impl Precision {
    /// A point rounded to this precision.
    pub fn rounded(self, point: Point) -> Point {
        match self {
            Self::Single => point.map(|x| f64::from(x as f32)),
            Self::Double => point,
        }
    }

    /// The name of the floating point type, as in NumPy.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Single => "float32",
            Self::Double => "float64",
        }
    }

    /// A bound of the rounding of the coordinates of these images, with room for moving and scaling the layout
    /// afterwards.
    pub(super) fn rounding(self, images: &[[Point; 3]]) -> f64 {
        let epsilon = match self {
            Self::Single => f64::from(f32::EPSILON),
            Self::Double => f64::EPSILON,
        };
        4.0 * epsilon * size(images)
    }
}

/// Whether each face is folded, or so thin that coordinates off by `rounding` might fold it.
pub(super) fn nearly_folded(images: &[[Point; 3]], rounding: f64) -> Vec<bool> {
    parallel::map(images.len(), |face| {
        let [a, b, c] = images[face];
        let sides: f64 = (0..2).map(|k| (b[k] - a[k]).abs().max((c[k] - a[k]).abs())).sum();
        let opens = signed_area([a, b, c]) > rounding * sides;
        !opens
    })
}

/// The longer side of the bounding box.
fn size(images: &[[Point; 3]]) -> f64 {
    let mut box_ = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    for point in images.as_flattened() {
        for axis in 0..2 {
            box_[axis] = [box_[axis][0].min(point[axis]), box_[axis][1].max(point[axis])];
        }
    }
    (box_[0][1] - box_[0][0]).max(box_[1][1] - box_[1][0])
}
