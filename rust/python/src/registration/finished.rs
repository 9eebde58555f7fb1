// SPDX-License-Identifier: MIT OR Apache-2.0
//! A finished registration of any kind, on which the methods of the Python class call the core.

use authalic::{
    Correspondence, CurveRegistration, DiskRegistration, Error, Observer, Recorded, SphereRegistration, Tree,
};

use crate::provenance::{Call, Fingerprint, Options};

pub enum Finished {
    Disk(DiskRegistration),
    Sphere(SphereRegistration),
    Curves(Box<CurveRegistration>),
}

/// A finished registration, what it was given, and how that was repaired.
pub struct Outcome {
    pub finished: Finished,
    /// The fingerprints of source and target as given.
    pub inputs: [Fingerprint; 2],
    /// The repaired source and target.
    pub repaired: [Option<authalic::Repaired>; 2],
}

impl Outcome {
    /// The call of the function that has returned this.
    pub fn call(&self, function: &'static str, options: &Options) -> Call {
        let [source, target] = self.inputs.clone();
        Call { function, options: options.clone(), inputs: vec![("source", source), ("target", target)] }
    }
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

    /// Signs that curves are wrong.
    pub fn warnings(&self) -> &[authalic::Warning] {
        match self {
            Self::Curves(registration) => &registration.warnings,
            _ => &[],
        }
    }

    /// The registration as named arrays, without its warnings.
    pub fn record(&self) -> Tree {
        let (kind, content) = match self {
            Self::Disk(registration) => ("disk", registration.record()),
            Self::Sphere(registration) => ("sphere", registration.record()),
            Self::Curves(registration) => ("curves", registration.record()),
        };
        Tree::new().with("kind", kind).with("content", content)
    }

    /// The registration of such arrays.
    pub fn of_record(record: &Tree) -> Result<Self, Error> {
        let content = record.tree("content")?;
        Ok(match record.text("kind")? {
            "disk" => Self::Disk(Recorded::of_record(content)?),
            "sphere" => Self::Sphere(Recorded::of_record(content)?),
            _ => Self::Curves(Box::new(Recorded::of_record(content)?)),
        })
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
