// SPDX-License-Identifier: MIT OR Apache-2.0
//! The isometries of the plane that glue a layout together: translations by a lattice, and half turns.
//!
//! Both layouts are flat except at a few singular points. So two images of a point of the sphere differ by a
//! translation by whole periods (Lambert's cylinder), or by a half turn and such a translation (the octahedral square).
//! In periods, the coefficients are integers, so that isometries are composed and compared exactly.

/// The map x ↦ ±x + shift, the shift in periods of the layout.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Isometry {
    /// Whether the linear part is a half turn.
    pub is_half_turn: bool,
    /// The translation, in periods.
    pub shift: [i32; 2],
}

impl Isometry {
    /// A translation by whole periods.
    pub fn translation(shift: [i32; 2]) -> Self {
        Self { is_half_turn: false, shift }
    }

    /// A half turn, then a translation by whole periods: the half turn about the point `shift / 2`.
    pub fn half_turn(shift: [i32; 2]) -> Self {
        Self { is_half_turn: true, shift }
    }

    /// `self ∘ first`.
    pub fn after(self, first: Self) -> Self {
        let turned = self.turned(first.shift);
        Self {
            is_half_turn: self.is_half_turn != first.is_half_turn,
            shift: [turned[0] + self.shift[0], turned[1] + self.shift[1]],
        }
    }

    /// The inverse.
    pub fn inverse(self) -> Self {
        let [x, y] = self.turned(self.shift);
        Self { is_half_turn: self.is_half_turn, shift: [-x, -y] }
    }

    /// The image of a point, for these `periods`.
    pub fn image(self, periods: [f64; 2], [x, y]: [f64; 2]) -> [f64; 2] {
        let sign = self.sign();
        [sign * x + f64::from(self.shift[0]) * periods[0], sign * y + f64::from(self.shift[1]) * periods[1]]
    }

    /// The linear part: 1, or −1 for half turns.
    pub fn sign(self) -> f64 {
        if self.is_half_turn { -1.0 } else { 1.0 }
    }

    fn turned(self, [x, y]: [i32; 2]) -> [i32; 2] {
        if self.is_half_turn { [-x, -y] } else { [x, y] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PERIODS: [f64; 2] = [2.0, 2.0];
    const POINT: [f64; 2] = [0.25, -0.5];

    #[test]
    fn compositions_map_as_one_after_the_other() {
        let all = [Isometry::translation([3, -1]), Isometry::half_turn([1, 2]), Isometry::default()];
        for first in all {
            for second in all {
                let one_by_one = second.image(PERIODS, first.image(PERIODS, POINT));
                assert_eq!(second.after(first).image(PERIODS, POINT), one_by_one);
            }
        }
    }

    #[test]
    fn an_inverse_leads_back() {
        for isometry in [Isometry::translation([3, -1]), Isometry::half_turn([1, 2])] {
            assert_eq!(isometry.inverse().after(isometry), Isometry::default());
            assert_eq!(isometry.after(isometry.inverse()), Isometry::default());
        }
    }

    #[test]
    fn a_half_turn_fixes_its_center() {
        assert_eq!(Isometry::half_turn([1, 0]).image(PERIODS, [1.0, 0.0]), [1.0, 0.0]);
    }
}
