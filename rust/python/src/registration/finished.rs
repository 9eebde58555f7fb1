// SPDX-License-Identifier: MIT OR Apache-2.0
//! A finished registration, on which the methods of its Python class call the core.

use std::sync::Arc;

use authalic::hyperbolic::CurveRegistration;
use authalic::registration::{
    DiskRegistration, GivenFaces, Location, SphereRegistration, lifted, nearest_given_corners,
    pull_given_corners,
};
use authalic::{Error, Observer, Surface as CheckedSurface, Vector3, registration};

use crate::arrays::rows;

/// A surface of a registration.
pub struct Surface {
    pub vertices: Vec<[f64; 3]>,
    /// As given: what corner data refer to.
    pub given: Vec<[u32; 3]>,
    /// As oriented.
    pub faces: Vec<[u32; 3]>,
}

/// A registration with all that its methods need.
pub struct Finished {
    pub source: Arc<Surface>,
    pub target: Arc<Surface>,
    pub outcome: Outcome,
    pub positions: Vec<Vector3>,
    pub area_ratio: Vec<f64>,
}

pub enum Outcome {
    Disk(DiskRegistration),
    Sphere(SphereRegistration),
    Curves(Box<CurveRegistration>),
}

/// Evaluates an expression of the map of the source onto the target, whatever kind of outcome it is.
macro_rules! either {
    ($outcome:expr, $map:ident => $value:expr) => {
        match $outcome {
            Outcome::Disk($map) => $value,
            Outcome::Sphere($map) => $value,
            Outcome::Curves(curves) => {
                let $map = &curves.map;
                $value
            }
        }
    };
}

pub(super) use either;

impl Surface {
    /// The surface with its vertices at places in the domain.
    fn registered<'a>(&'a self, places: &'a [Vector3]) -> GivenFaces<'a> {
        GivenFaces { given: &self.given, oriented: &self.faces, registered: places }
    }
}

impl Finished {
    /// An outcome with the surfaces as given and as oriented.
    pub fn of_surfaces(
        source: &CheckedSurface,
        target: &CheckedSurface,
        outcome: Outcome,
    ) -> Result<Self, Error> {
        let kept = |surface: &CheckedSurface, faces: &[_]| Surface {
            vertices: rows(surface.vertices()).to_vec(),
            given: rows(surface.faces()).to_vec(),
            faces: faces.to_vec(),
        };
        let target_faces = either!(&outcome, map => map.target_faces.clone());
        let surfaces = (kept(source, source.mesh()?.faces()), kept(target, &target_faces));
        Ok(Self::new(surfaces.0.into(), surfaces.1.into(), outcome))
    }

    fn new(source: Arc<Surface>, target: Arc<Surface>, outcome: Outcome) -> Self {
        let vertices: Vec<Vector3> = target.vertices.iter().copied().map(Vector3).collect();
        let positions = either!(&outcome, map => map.positions(&vertices));
        let area_ratio = registration::area_ratios(&source.vertices, &source.faces, &positions);
        Self { source, target, outcome, positions, area_ratio }
    }

    pub fn locations(&self) -> &[Location] {
        either!(&self.outcome, map => &map.locations)
    }

    /// The vertices of source and target in the domain, the disk in the plane z = 1 as the core has it.
    fn in_domain(&self) -> (Vec<Vector3>, Vec<Vector3>) {
        match &self.outcome {
            Outcome::Disk(registration) => {
                (lifted(&registration.registered), lifted(&registration.target_registered))
            }
            Outcome::Sphere(registration) => {
                (registration.registered.clone(), registration.target_registered.clone())
            }
            Outcome::Curves(curves) => (curves.map.registered.clone(), curves.spheres[1].positions.clone()),
        }
    }

    pub fn inverse(&self, observer: &mut dyn Observer) -> Result<Self, Error> {
        let faces = &self.source.faces;
        let outcome = match &self.outcome {
            Outcome::Disk(registration) => Outcome::Disk(registration.inverse(faces, observer)?),
            Outcome::Sphere(registration) => Outcome::Sphere(registration.inverse(faces, observer)?),
            Outcome::Curves(registration) => Outcome::Curves(Box::new(registration.inverted())),
        };
        Ok(Self::new(self.target.clone(), self.source.clone(), outcome))
    }

    /// The rows of per-vertex data that the vertices of the source take, or of per-corner data that its
    /// corners take, both in the order of the corners given.
    pub fn nearest_rows(&self, per: Per) -> Vec<u32> {
        if per == Per::Vertex {
            return registration::nearest_vertices(&self.target.faces, self.locations());
        }
        let (ours, theirs) = self.in_domain();
        let (source, target) = (self.source.registered(&ours), self.target.registered(&theirs));
        nearest_given_corners(&source, &target, self.locations())
    }

    /// Per-vertex or per-corner rows of the target at those of the source, interpolated.
    pub fn interpolated(&self, values: &[f64], width: usize, per: Per) -> Vec<f64> {
        if per == Per::Vertex {
            return registration::pull_vertices(values, width, &self.target.faces, self.locations());
        }
        let (ours, theirs) = self.in_domain();
        let (source, target) = (self.source.registered(&ours), self.target.registered(&theirs));
        pull_given_corners(values, width, &source, &target, self.locations())
    }

    /// (1 − t) v + t g(v); aligned, g(v) is brought onto v first.
    pub fn morphed(&self, vertices: &[Vector3], t: f64, align: bool) -> Vec<Vector3> {
        if !align {
            return registration::homotopy(vertices, &self.positions, t);
        }
        registration::aligned_homotopy(vertices, &self.positions, &self.vertex_areas(), t)
    }

    /// A third of the area of the faces at each vertex of the source.
    pub fn vertex_areas(&self) -> Vec<f64> {
        registration::vertex_areas(&self.source.vertices, &self.source.faces)
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
    pub fn of(shape: &[usize], surface: &Surface, wanted: Option<Self>) -> Option<(Self, usize)> {
        let may_be = |per| wanted.is_none_or(|wanted| wanted == per);
        match shape {
            [n, ..] if *n == surface.vertices.len() && may_be(Self::Vertex) => Some((Self::Vertex, 1)),
            [m, 3, ..] if *m == surface.given.len() && may_be(Self::Corner) => Some((Self::Corner, 2)),
            _ => None,
        }
    }

    /// The axes of the same data on another surface.
    pub fn axes(self, surface: &Surface) -> Vec<usize> {
        match self {
            Self::Vertex => vec![surface.vertices.len()],
            Self::Corner => vec![surface.given.len(), 3],
        }
    }
}
