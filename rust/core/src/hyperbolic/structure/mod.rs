// SPDX-License-Identifier: MIT OR Apache-2.0
//! The hyperbolic structure of a surface with landmark curves: the objects of the paper's theory (Shi et al.
//! 2013, section 3).
//!
//! The surface sliced along its curves gets the hyperbolic metric with geodesic boundaries; a chain of arcs
//! makes it a disk, the fundamental domain of a Fuchsian group. The axes of the generators are closed geodesics
//! that cut the surface into pairs of pants, and these divide into hexagons. Registrations need none of this.
//!
//! Input: a surface of genus 0 with at least three features, open curves and boundary loops. Cost: that of
//! the metric, and B layouts of the disk for B features.

pub(crate) mod fuchsian;
pub(crate) mod pants;
#[cfg(test)]
mod tests;
mod trace;

use std::f64::consts::PI;

use ndarray::Array2;

use super::features::curves::{CurvePair, check_alone};
use super::features::piece::Piece;
use super::features::pieces::pieces;
use super::features::placement::placed;
use super::features::regions::divided;
use super::harmonic::atlas::Atlas;
use super::metric::{Metric, MetricMethod, hyperbolic_metric};
use super::moebius::{Complex, Moebius};
use super::slice::slice_alone;
use super::slice::sliced::{Side, Sliced};
use crate::arrays::{from_rows, from_vectors, vectors};
use crate::control::{Observer, Watch};
use crate::error::{CurveError, Error, NumericsError};
use crate::location::{Location, points_on};
use crate::mesh::ties::first_smallest;
use crate::mesh::{Corner, Face, Surface, TriangleMesh, Vertex, index_array};
use fuchsian::{CoverCopy, Development, cover};
use pants::{Pants, pants};
use trace::closed_geodesic;

/// A surface sliced along its features, with its hyperbolic metric, its Fuchsian group and its pants.
///
/// The chain runs through all B features, curves as given and then the other boundary loops, each with a left bank
/// (the surface on its left) and a right bank; arc k leads from the k-th feature of the chain to the next.
#[derive(Debug, Clone)]
pub struct HyperbolicStructure {
    /// (n,): the locations of the vertices of the sliced surface on the given surface.
    pub(crate) vertices: Vec<Location>,
    /// (m, 3): the faces of the sliced surface; some given faces are divided.
    pub(crate) faces: Vec<[Vertex; 3]>,
    /// (n,): the given vertex that each vertex is; `None` for midpoints of edges.
    pub vertex_of: Vec<Option<Vertex>>,
    /// (m, 3): the faces of the disk, the surface cut along the arcs too.
    pub(crate) disk_faces: Vec<[Vertex; 3]>,
    /// The positions of the vertices of the disk in the Poincaré disk: the fundamental domain.
    pub(crate) positions: Vec<Complex>,
    /// The vertex of the sliced surface that each vertex of the disk copies.
    pub disk_vertex_of: Vec<Vertex>,
    /// (B,): the features in the order of the chain, each with whether it is reversed.
    pub chain: Vec<(usize, bool)>,
    /// (B,): left and right bank of each feature of the chain, as vertices of the disk along the chain.
    pub banks: Vec<[Vec<Vertex>; 2]>,
    /// (B − 1,): left and right copy of each arc, as vertices of the disk along the chain.
    pub arcs: Vec<[Vec<Vertex>; 2]>,
    /// (B − 1,): the generators of the group; each takes the left copy of its arc to the right copy. The generator
    /// of arc k goes around the first k features of the chain.
    pub generators: Vec<Moebius>,
    /// (B,): the lengths once around the features, in the order given.
    pub boundary_lengths: Vec<f64>,
    /// (B − 2,): the pairs of pants along the chain.
    pub pants: Vec<Pants>,
    /// (B − 3,): the closed geodesics between the pants, as locations on the given surface, the first repeated at the
    /// end.
    pub(crate) pants_curves: Vec<Vec<Location>>,
    /// (B − 3,): the lengths of the closed geodesics.
    pub lengths: Vec<f64>,
    /// The largest curvature left in the metric.
    pub curvature: f64,
    /// The hyperbolic area; 2π(B − 2) up to rounding.
    pub area: f64,
    surface: Surface,
    surface_faces: Vec<[Vertex; 3]>,
}

impl HyperbolicStructure {
    /// The fundamental domain and its copies in the universal cover, from the middle outward; `count` in all at most.
    pub fn cover(&self, count: usize) -> Vec<CoverCopy> {
        cover(&self.generators, count)
    }

    /// The vertices of the sliced surface, (n, 3); those of slits stand on both banks.
    pub fn vertices(&self) -> Array2<f64> {
        self.in_space(&self.vertices)
    }

    /// The faces of the sliced surface, (m, 3); some given faces are divided.
    pub fn faces(&self) -> Array2<u32> {
        index_array(&self.faces)
    }

    /// The faces of the disk, (m, 3): the surface cut along the arcs too.
    pub fn disk_faces(&self) -> Array2<u32> {
        index_array(&self.disk_faces)
    }

    /// The positions of the vertices of the disk in the Poincaré disk, (n_disk, 2): the fundamental domain.
    pub fn positions(&self) -> Array2<f64> {
        from_rows(self.positions.iter().map(|z| [z.re, z.im]).collect())
    }

    /// The closed geodesics between the pants on the given surface, (B − 3) arrays (k, 3), the first point repeated at
    /// the end.
    pub fn pants_curves(&self) -> Vec<Array2<f64>> {
        self.pants_curves.iter().map(|curve| self.in_space(curve)).collect()
    }

    /// The points in space of locations on the given surface.
    fn in_space(&self, places: &[Location]) -> Array2<f64> {
        from_vectors(points_on(places, &vectors(self.surface.vertices()), &self.surface_faces))
    }
}

/// Computes the hyperbolic structure of a surface of genus 0, closed or with boundary, sliced along open
/// curves.
///
/// Curves are paths of vertices along edges, as for [`super::register_hyperbolic`]; closed curves must be boundary
/// loops. All boundary loops are features, named or not.
///
/// # Errors
/// Before any work: surfaces of another topology, curves that are no simple edge paths or touch,
/// [`CurveError::Divides`] for closed curves inside and [`CurveError::TooFewFeatures`] for fewer than three features.
/// [`NumericsError::NoHyperbolicMetric`] if double precision does not suffice; [`Error::CancelledEarly`].
pub fn hyperbolic_structure(
    surface: &Surface,
    curves: &[Vec<usize>],
    metric: MetricMethod,
    observer: &mut dyn Observer,
) -> Result<HyperbolicStructure, Error> {
    let mesh = surface.mesh()?;
    // 1. The surface with its features
    let pairs = checked(mesh, curves)?;
    let piece = piece(mesh, pairs, &Watch::new(observer, 0.0, "Laying out the surface"))?;
    // 2. Cut open
    let (sliced, chain) = slice_alone(&piece, &Watch::new(observer, 0.1, "Cutting open"))?;
    // 3. Its metric
    let chi = 2 - chain.len() as i64;
    let watch = Watch::new(observer, 0.15, "Hyperbolic metric");
    let metric = hyperbolic_metric(&sliced.surface_points(), &sliced.surface.faces, chi, metric, &watch);
    let face_of = |face: usize| piece.face_of[sliced.places[face].face].index();
    let metric = metric.map_err(|error| error.with_faces(face_of))?;
    // 4. The fundamental domain and the group
    let atlas = Atlas::new(&sliced.surface, &metric);
    let domain = Development::centered(&sliced, &atlas);
    // 5. The pants, and the geodesics between them
    if !observer.progress(0.9, "Pants") {
        return Err(Error::CancelledEarly);
    }
    let pants = all_pants(&domain, &sliced, &atlas);
    let (pants_curves, lengths) = pants_curves(&domain, &sliced, &atlas, &piece)?;
    // 6. The result
    let [banks, arcs] = [false, true].map(|is_arc| both_sides(&sliced.sides, is_arc));
    let structure = HyperbolicStructure {
        vertices: vertices(&piece, &sliced),
        faces: sliced.surface.faces.clone(),
        vertex_of: vertex_of(&piece, &sliced),
        disk_faces: sliced.disk.faces.clone(),
        positions: domain.positions(),
        disk_vertex_of: sliced.surface_vertices(),
        banks,
        arcs,
        generators: domain.generators(),
        boundary_lengths: boundary_lengths(&sliced, &metric, &chain),
        chain,
        pants,
        pants_curves,
        lengths,
        curvature: metric.residual,
        area: metric.angles.iter().map(|angles| PI - angles.iter().sum::<f64>()).sum(),
        surface: surface.clone(),
        surface_faces: mesh.faces().to_vec(),
    };
    observer.progress(1.0, "Done");
    Ok(structure)
}

/// The curves; an error unless they and the boundary leave a hyperbolic surface.
fn checked(mesh: &TriangleMesh, curves: &[Vec<usize>]) -> Result<Vec<CurvePair>, Error> {
    let pairs = check_alone(mesh, curves)?;
    if let Some(curve) = pairs.iter().position(|pair| pair.closed && !pair.on_boundary) {
        return Err(CurveError::Divides { curve }.into());
    }
    let slits = pairs.iter().filter(|pair| !pair.on_boundary).count();
    match slits + mesh.boundary_loops().len() {
        found if found < 3 => Err(CurveError::TooFewFeatures { found }.into()),
        _ => Ok(pairs),
    }
}

/// The surface as one piece.
fn piece(mesh: &TriangleMesh, pairs: Vec<CurvePair>, watch: &Watch<'_>) -> Result<Piece, Error> {
    let divided = divided(mesh, mesh, pairs)?;
    let placement = placed([mesh, mesh], &divided, None, watch)?;
    Ok(pieces(mesh, mesh, &divided, &placement).swap_remove(0).0)
}

/// All pairs of pants, each by a layout around the left bank of its feature, so that all are equally precise.
fn all_pants(domain: &Development<'_>, sliced: &Sliced, atlas: &Atlas<'_>) -> Vec<Pants> {
    let corners = sliced.disk.boundary_corners();
    let last = domain.generators().len();
    let of_feature = |k: usize| {
        let bank: Vec<Corner> = sliced.sides[2 * k + 2].opposite_corners(&corners).collect();
        let face = bank[bank.len() / 2].face();
        let generators = Development::around(face, sliced, atlas).generators();
        let pants = pants(generators[k], generators[k + 1]);
        Pants { placement: domain.frames[face] * pants.placement, ..pants }
    };
    (0..last - 1).map(of_feature).collect()
}

/// The closed geodesics between the pants and their lengths, each by a layout around the edge of its arc nearest
/// to it.
fn pants_curves(
    domain: &Development<'_>,
    sliced: &Sliced,
    atlas: &Atlas<'_>,
    piece: &Piece,
) -> Result<(Vec<Vec<Location>>, Vec<f64>), Error> {
    let corners = sliced.disk.boundary_corners();
    let generators = domain.generators();
    let traced = (0..generators.len() - 2).map(|k| {
        let far = |face: Face| {
            let [from, to] = generators[k + 1].fixed_points();
            let [from, to] = [from, to].map(|end| domain.frames[face].inverse().apply(end));
            (from + to).norm()
        };
        let faces: Vec<Face> = sliced.sides[2 * k + 3].opposite_corners(&corners).map(Corner::face).collect();
        let face = faces[first_smallest(faces.iter().map(|&face| far(face)))?];
        let generator = Development::around(face, sliced, atlas).generators()[k + 1];
        let line = generator.fixed_points();
        closed_geodesic(atlas, &sliced.surface, face, line, generator.translation_length())
    });
    let lost = || NumericsError::FactorizationFailed { what: "the pants curves".into() };
    let traced = traced.collect::<Option<Vec<_>>>().ok_or_else(lost)?;
    let on_given = |place: &Location| sliced.given_place(piece, place);
    Ok(traced.iter().map(|curve| (curve.places.iter().map(on_given).collect(), curve.length)).unzip())
}

/// Left and right copies of the banks, or of the arcs, along the chain.
fn both_sides(sides: &[Side], is_arc: bool) -> Vec<[Vec<Vertex>; 2]> {
    let half = sides.len() / 2;
    let left = (0..half).filter(|&side| sides[side].is_arc == is_arc);
    left.map(|side| {
        let right = sides[sides.len() - 1 - side].vertices.iter().rev().copied().collect();
        [sides[side].vertices.clone(), right]
    })
    .collect()
}

/// The lengths once around the features, in the order given.
fn boundary_lengths(sliced: &Sliced, metric: &Metric, chain: &[(usize, bool)]) -> Vec<f64> {
    let corners = sliced.disk.boundary_corners();
    let length = |corner: Corner| metric.lengths[corner.face()][corner.place()];
    let mut lengths = vec![0.0; chain.len()];
    for side in sliced.sides.iter().filter(|side| !side.is_arc) {
        lengths[chain[side.index].0] += side.opposite_corners(&corners).map(length).sum::<f64>();
    }
    lengths
}

/// The locations of the vertices of the sliced surface on the given surface.
fn vertices(piece: &Piece, sliced: &Sliced) -> Vec<Location> {
    let mut vertices = vec![Location::default(); sliced.surface.vertex_of.len()];
    for (face, corners) in sliced.surface.faces.iter().enumerate() {
        for (k, &vertex) in corners.iter().enumerate() {
            let mut barycentric = [0.0; 3];
            barycentric[k] = 1.0;
            let place = Location { triangle: Face::new(face), barycentric };
            vertices[vertex] = sliced.given_place(piece, &place);
        }
    }
    vertices
}

fn vertex_of(piece: &Piece, sliced: &Sliced) -> Vec<Option<Vertex>> {
    let copies = 0..sliced.surface.vertex_of.len();
    copies.map(|copy| sliced.given_vertex(piece, copy)).collect()
}
