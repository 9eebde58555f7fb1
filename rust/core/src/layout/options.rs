// SPDX-License-Identifier: MIT OR Apache-2.0
//! Options of a layout, and the frame that they put the sphere into.

use ndarray::ArrayView1;

use super::certificate::Precision;
use crate::codomain::spherical::onto_sphere;
use crate::error::Error;
use crate::vector::Vector3;

/// Cosine of the angle between pole and y axis above which the angles of seams count from the negative z axis.
const NEAR_Y: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Least sine of the angle between pole and seam.
const LEAST_ANGLE: f64 = 1e-6;

/// How a sphere is laid out in the plane. Both keep areas.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum LayoutKind {
    /// Lambert's cylindrical projection: a rectangle of width 2π and height 2, each pole a side of it.
    #[default]
    Lambert,
    /// The equal-area octahedral map: a square, one pole in its middle and the other in its corners.
    Octahedral,
}

/// Where a layout is cut open.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Seam {
    /// An angle about the pole (radians, counter-clockwise seen from outside above it), from the y axis; from the
    /// negative z axis for poles within 45° of the y axis.
    Angle(f64),
    /// A direction; only its component perpendicular to the pole counts.
    Direction([f64; 3]),
}

/// Options of [`SphereMap::layout`](crate::SphereMap::layout).
#[derive(Debug, Clone, Copy)]
pub struct LayoutOptions<'a> {
    /// Which layout. Default: Lambert's.
    pub kind: LayoutKind,
    /// Direction of the pole at the top (Lambert) or in the middle (octahedral). Default: the z axis.
    pub pole: [f64; 3],
    /// The left side of the rectangle (Lambert) or the upper side of the square (octahedral). Default: the y axis.
    pub seam: Seam,
    /// (m,): a number for each face; faces with the same number that meet at an edge are not cut apart. `None`: every
    /// face is a polygon.
    pub polygons: Option<&'a [usize]>,
    /// (m,): target measure of each face, positive, on any scale. `None`: the targets of the map.
    pub density: Option<ArrayView1<'a, f64>>,
    /// (n,): which vertices may be moved onto a pole, or onto one of the four singular points on the equator of the
    /// octahedral map. `None`: all.
    pub candidates: Option<&'a [bool]>,
    /// The precision of the points, in which no face is folded. Default: double.
    pub precision: Precision,
}

impl Default for LayoutOptions<'_> {
    fn default() -> Self {
        Self {
            kind: LayoutKind::default(),
            pole: [0.0, 0.0, 1.0],
            seam: Seam::Angle(0.0),
            polygons: None,
            density: None,
            candidates: None,
            precision: Precision::default(),
        }
    }
}

impl LayoutOptions<'_> {
    /// The axes of a projection: toward the seam, a quarter turn on about the pole, and toward the pole.
    ///
    /// # Errors
    /// [`Error::InvalidOption`] where pole or seam have no direction.
    pub(super) fn frame(&self) -> Result<[Vector3; 3], Error> {
        let pole =
            onto_sphere(Vector3(self.pole)).ok_or_else(|| no_direction("pole", self.pole, "not zero"))?;
        let toward_seam = match self.seam {
            Seam::Angle(angle) if angle.is_finite() => {
                let start = perpendicular(start_of_angles(pole), pole);
                let [start, quarter] = [start, pole.cross(start)];
                start * angle.cos() + quarter * angle.sin()
            }
            Seam::Angle(angle) => {
                let expected = "a finite angle in radians, or a direction".into();
                return Err(Error::InvalidOption { name: "seam", found: angle.to_string(), expected });
            }
            Seam::Direction(given) => onto_sphere(Vector3(given))
                .map(|seam| perpendicular(seam, pole))
                .filter(|seam| seam.norm() > LEAST_ANGLE)
                .ok_or_else(|| no_direction("seam", given, "not parallel to the pole"))?,
        };
        let first = toward_seam.normalized();
        Ok([first, pole.cross(first), pole])
    }
}

/// The direction from which the angles of seams are counted.
fn start_of_angles(pole: Vector3) -> Vector3 {
    if pole[1].abs() < NEAR_Y { Vector3::unit(1) } else { -Vector3::unit(2) }
}

fn perpendicular(v: Vector3, to: Vector3) -> Vector3 {
    v - to * v.dot(to)
}

fn no_direction(name: &'static str, given: [f64; 3], what: &str) -> Error {
    let expected = format!("a finite direction (x, y, z), {what}");
    Error::InvalidOption { name, found: format!("{given:?}"), expected }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(pole: [f64; 3], seam: Seam) -> Result<[Vector3; 3], Error> {
        LayoutOptions { pole, seam, ..LayoutOptions::default() }.frame()
    }

    #[test]
    fn angles_of_seams_begin_at_the_back() {
        let back = [
            ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
            ([0.0, 1.0, 0.0], [0.0, 0.0, -1.0]),
            ([0.0, 0.0, 2.0], [0.0, 1.0, 0.0]),
        ];
        for (pole, seam) in back {
            let seam = Vector3(seam);
            assert_eq!(frame(pole, Seam::Angle(0.0)).unwrap()[0], seam);
            let [first, second, third] = frame(pole, Seam::Angle(1.0)).unwrap();
            assert!((first.dot(seam) - 1f64.cos()).abs() < 1e-15);
            assert!((first.cross(second).dot(third) - 1.0).abs() < 1e-15);
            assert!((seam.cross(first).dot(third) - 1f64.sin()).abs() < 1e-15);
        }
    }

    #[test]
    fn what_is_no_direction_is_refused() {
        let z = [0.0, 0.0, 1.0];
        for pole in [[0.0; 3], [f64::NAN, 0.0, 0.0], [f64::INFINITY, 0.0, 0.0]] {
            assert!(matches!(frame(pole, Seam::Angle(0.0)), Err(Error::InvalidOption { name: "pole", .. })));
        }
        for seam in [Seam::Angle(f64::NAN), Seam::Direction([0.0, 0.0, -3.0]), Seam::Direction([0.0; 3])] {
            assert!(matches!(frame(z, seam), Err(Error::InvalidOption { name: "seam", .. })));
        }
        assert!(frame([0.0, 0.0, 1e-300], Seam::Direction([1e300, 0.0, 1e300])).is_ok());
    }
}
