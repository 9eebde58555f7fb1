// SPDX-License-Identifier: MIT OR Apache-2.0
//! The codomain of a map: disk, sphere or plane, and the motions of vertices there.

pub(crate) mod motion;
pub(crate) mod planar;
pub(crate) mod spherical;

use crate::vector::Vector3;
use motion::Motion;

/// A map of the vertices in space, (n, 3): onto the unit sphere, or into the plane z = 1.
pub(crate) type SpatialMap = Vec<Vector3>;

/// The codomain of a map.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Codomain {
    /// The unit sphere.
    Sphere,
    /// The unit disk in the plane z = 1, the boundary counter-clockwise around the circle.
    Disk,
    /// The plane z = 1.
    Plane,
}

/// The codomain to which both surfaces of a registration are mapped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum CanonicalDomain {
    /// The unit disk.
    Disk,
    /// The unit sphere.
    Sphere,
}

impl CanonicalDomain {
    /// The motion that a vertex is allowed.
    pub(crate) fn motion(self, on_boundary: bool) -> Motion {
        match (self, on_boundary) {
            (Self::Sphere, _) => Motion::Sphere,
            (Self::Disk, false) => Motion::Plane,
            (Self::Disk, true) => Motion::Circle,
        }
    }
}

impl From<CanonicalDomain> for Codomain {
    fn from(domain: CanonicalDomain) -> Self {
        match domain {
            CanonicalDomain::Disk => Self::Disk,
            CanonicalDomain::Sphere => Self::Sphere,
        }
    }
}
