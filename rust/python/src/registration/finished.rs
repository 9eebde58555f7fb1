// SPDX-License-Identifier: MIT OR Apache-2.0
//! A finished registration of any kind, on which the methods of its Python class call the core.

use authalic::{Correspondence, CurveRegistration, DiskRegistration, Error, Observer, SphereRegistration};

pub enum Finished {
    Disk(DiskRegistration),
    Sphere(SphereRegistration),
    Curves(Box<CurveRegistration>),
}

impl Finished {
    /// Where each vertex of the source lies on the target.
    pub fn correspondence(&self) -> &Correspondence {
        match self {
            Self::Disk(registration) => &registration.correspondence,
            Self::Sphere(registration) => &registration.correspondence,
            Self::Curves(registration) => &registration.map.correspondence,
        }
    }

    pub fn inverse(&self, observer: &mut dyn Observer) -> Result<Self, Error> {
        match self {
            Self::Disk(registration) => registration.inverse(observer).map(Self::Disk),
            Self::Sphere(registration) => registration.inverse(observer).map(Self::Sphere),
            Self::Curves(registration) => Ok(Self::Curves(Box::new(registration.inverted()))),
        }
    }
}

/// What there is one row of data for.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Per {
    Vertex,
    Corner,
}

impl Per {
    /// What data of this shape belong to on a surface, with the number of axes that say so.
    pub fn of(shape: &[usize], surface: &authalic::Surface, wanted: Option<Self>) -> Option<(Self, usize)> {
        let may_be = |per| wanted.is_none_or(|wanted| wanted == per);
        match shape {
            [n, ..] if *n == surface.n_vertices() && may_be(Self::Vertex) => Some((Self::Vertex, 1)),
            [m, 3, ..] if *m == surface.n_faces() && may_be(Self::Corner) => Some((Self::Corner, 2)),
            _ => None,
        }
    }

    /// The axes of the same data on another surface.
    pub fn axes(self, surface: &authalic::Surface) -> Vec<usize> {
        match self {
            Self::Vertex => vec![surface.n_vertices()],
            Self::Corner => vec![surface.n_faces(), 3],
        }
    }
}
