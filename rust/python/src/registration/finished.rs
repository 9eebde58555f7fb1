// SPDX-License-Identifier: MIT OR Apache-2.0
//! A finished registration of any kind, on which the methods of the Python class call the core.

use authalic::{Correspondence, CurveRegistration, DiskRegistration, Error, Observer, SphereRegistration};

pub enum Finished {
    Disk(DiskRegistration),
    Sphere(SphereRegistration),
    Curves(Box<CurveRegistration>),
}

impl Finished {
    /// The locations of the source's vertices on the target.
    pub fn correspondence(&self) -> &Correspondence {
        match self {
            Self::Disk(registration) => &registration.correspondence,
            Self::Sphere(registration) => &registration.correspondence,
            Self::Curves(registration) => &registration.map.correspondence,
        }
    }

    /// How far the source's faces are stretched and shrunk.
    pub fn strain(&self) -> authalic::Strain {
        match self {
            Self::Disk(registration) => registration.strain(),
            Self::Sphere(registration) => registration.strain(),
            Self::Curves(registration) => registration.strain(),
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

/// The elements of a surface that data have one row for.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Per {
    Vertex,
    Corner,
}

impl Per {
    /// The elements that data of this shape belong to on a surface, and the number of axes that number them.
    pub fn of(shape: &[usize], surface: &authalic::Surface, asked: Option<Self>) -> Option<(Self, usize)> {
        let may_be = |per| asked.is_none_or(|asked| asked == per);
        match shape {
            [n, ..] if *n == surface.n_vertices() && may_be(Self::Vertex) => Some((Self::Vertex, 1)),
            [m, 3, ..] if *m == surface.n_faces() && may_be(Self::Corner) => Some((Self::Corner, 2)),
            _ => None,
        }
    }

    /// The lengths of the axes that number the elements of a surface.
    pub fn axes(self, surface: &authalic::Surface) -> Vec<usize> {
        match self {
            Self::Vertex => vec![surface.n_vertices()],
            Self::Corner => vec![surface.n_faces(), 3],
        }
    }
}
