// SPDX-License-Identifier: MIT OR Apache-2.0
//! A finished registration and what its methods compute, in plain Rust.

use std::sync::Arc;

use authalic::hyperbolic::CurveRegistration;
use authalic::mesh::geometry::{face_areas, normalized};
use authalic::registration::{DiskRegistration, Location, SphereRegistration, similarity};
use authalic::{Error, Observer, registration};

/// A surface of a registration.
pub struct Surface {
    pub vertices: Vec<[f64; 3]>,
    /// As given: what corner data refer to.
    pub given: Vec<[u32; 3]>,
    /// As oriented.
    pub faces: Vec<[u32; 3]>,
}

/// A registration with all that its methods need.
pub struct Found {
    pub source: Arc<Surface>,
    pub target: Arc<Surface>,
    pub outcome: Outcome,
    pub positions: Vec<[f64; 3]>,
    pub area_ratio: Vec<f64>,
}

pub enum Outcome {
    Disk(DiskRegistration),
    Sphere(SphereRegistration),
    Curves(Box<CurveRegistration>),
}

/// Evaluates an expression for either kind of outcome.
macro_rules! either {
    ($outcome:expr, $found:ident => $value:expr) => {
        match $outcome {
            Outcome::Disk($found) => $value,
            Outcome::Sphere($found) => $value,
            Outcome::Curves(curves) => {
                let $found = &curves.registration;
                $value
            }
        }
    };
}

pub(super) use either;

impl Surface {
    /// The corner given, 3 × face + corner, that has become each corner as oriented, (3 m,).
    fn corner_of(&self) -> Vec<u32> {
        let given = |corner: usize| {
            let (face, vertex) = (corner / 3, self.faces[corner / 3][corner % 3]);
            let place = self.given[face].iter().position(|&other| other == vertex);
            (3 * face + place.expect("a face keeps its vertices")) as u32
        };
        (0..3 * self.faces.len()).map(given).collect()
    }
}

impl Found {
    pub fn new(source: Arc<Surface>, target: Arc<Surface>, outcome: Outcome) -> Self {
        let positions = either!(&outcome, found => found.positions(&target.vertices));
        let area_ratio = registration::area_ratios(&source.vertices, &source.faces, &positions);
        Self { source, target, outcome, positions, area_ratio }
    }

    pub fn locations(&self) -> &[Location] {
        either!(&self.outcome, found => &found.locations)
    }

    /// The vertices of source and target in the domain, the disk in the plane z = 1 as the core has it.
    fn in_domain(&self) -> (Vec<[f64; 3]>, Vec<[f64; 3]>) {
        match &self.outcome {
            Outcome::Disk(found) => (lifted(&found.registered), lifted(&found.target_registered)),
            Outcome::Sphere(found) => (found.registered.clone(), found.target_registered.clone()),
            Outcome::Curves(found) => {
                (found.registration.registered.clone(), found.registration.target_registered.clone())
            }
        }
    }

    pub fn inverse(&self, observer: &mut dyn Observer) -> Result<Self, Error> {
        let faces = &self.source.faces;
        let outcome = match &self.outcome {
            Outcome::Disk(found) => Outcome::Disk(found.inverse(faces, observer)?),
            Outcome::Sphere(found) => Outcome::Sphere(found.inverse(faces, observer)?),
            Outcome::Curves(found) => Outcome::Curves(Box::new(found.inverted())),
        };
        Ok(Self::new(self.target.clone(), self.source.clone(), outcome))
    }

    /// The rows of per-vertex data that the vertices of the source take, or of per-corner data that its
    /// corners take, both in the order of the corners given.
    pub fn nearest_rows(&self, per: Per) -> Vec<u32> {
        if per == Per::Vertex {
            return registration::nearest_vertices(&self.target.faces, self.locations());
        }
        let ((ours, theirs), (faces, target_faces)) =
            (self.in_domain(), (&self.source.faces, &self.target.faces));
        let sides = registration::corner_sides(faces, &ours, target_faces, &theirs, self.locations());
        let nearest = registration::nearest_corners(&sides);
        let corner_of = self.target.corner_of();
        let mut rows = vec![0; nearest.len()];
        for (corner, given) in self.source.corner_of().into_iter().enumerate() {
            rows[given as usize] = corner_of[nearest[corner] as usize];
        }
        rows
    }

    /// Per-vertex or per-corner rows of the target at those of the source, interpolated.
    pub fn interpolated(&self, values: &[f64], width: usize, per: Per) -> Vec<f64> {
        let (faces, target_faces) = (&self.source.faces, &self.target.faces);
        if per == Per::Vertex {
            return registration::pull_vertices(values, width, target_faces, self.locations());
        }
        let (ours, theirs) = self.in_domain();
        let oriented = registration::pull_rows(values, width, &self.target.corner_of());
        let pulled = registration::pull_corners(
            &oriented,
            width,
            faces,
            &ours,
            target_faces,
            &theirs,
            self.locations(),
        );
        let mut place_of = vec![0; 3 * faces.len()];
        self.source.corner_of().iter().enumerate().for_each(|(corner, &given)| {
            place_of[given as usize] = corner as u32;
        });
        registration::pull_rows(&pulled, width, &place_of)
    }

    /// (1 − t) v + t g(v); aligned, g(v) is brought onto v first.
    pub fn morphed(&self, vertices: &[[f64; 3]], t: f64, align: bool) -> Vec<[f64; 3]> {
        if !align {
            return registration::homotopy(vertices, &self.positions, t);
        }
        let motion = similarity(&self.positions, vertices, &self.vertex_areas());
        let aligned: Vec<_> = self.positions.iter().map(|&position| motion.apply(position)).collect();
        registration::homotopy(vertices, &aligned, t)
    }

    /// A third of the area of the faces at each vertex of the source.
    pub fn vertex_areas(&self) -> Vec<f64> {
        let points = normalized(&self.source.vertices).0;
        let areas = face_areas(&points, &self.source.faces);
        let mut at_vertex = vec![0.0; points.len()];
        for (face, area) in self.source.faces.iter().zip(areas) {
            face.iter().for_each(|&vertex| at_vertex[vertex as usize] += area / 3.0);
        }
        at_vertex
    }
}

/// Points of the disk in the plane z = 1, where the core has them.
fn lifted(points: &[[f64; 2]]) -> Vec<[f64; 3]> {
    points.iter().map(|&[u, v]| [u, v, 1.0]).collect()
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
