// SPDX-License-Identifier: MIT OR Apache-2.0
//! Splits the faces that keep a sphere map from even areas.
//!
//! The limbs of a body become long thin faces on the sphere. A flat face with corners on the sphere cannot be smaller
//! than the sagitta of its longest edge l allows, about l³/16 where it is obtuse. Where that is not small beside its
//! target, no map of this mesh has even areas.
//!
//! 1. The longest edges of such faces are split at their midpoints, which does not change the surface.
//! 2. A midpoint is mapped to the midpoint of the great arc, which folds nothing, and a descent evens out areas.
//! 3. These steps repeat until areas are even, or until a round no longer halves E_A, as where angles count.
//!
//! Cost: up to three descents with an initial map, on a mesh of one and a half to four times as many faces.

use std::f64::consts::PI;

use ndarray::Array2;

use super::Run;
use super::options::SphereMapOptions;
use super::published::objective::SphereObjective;
use super::published::run::energy_share;
use crate::arrays::{from_rows, from_vectors, rows};
use crate::codomain::SpatialMap;
use crate::codomain::spherical::onto_sphere;
use crate::control::{History, Observer, Phase, Status};
use crate::distortion::{Distortion, Image, distortion_of_wholes, measure};
use crate::error::Error;
use crate::mesh::bisection::{Bisection, bisect_longest_edges};
use crate::mesh::geometry::triangle;
use crate::mesh::ties::tie_breakers;
use crate::mesh::{Face, Surface, TriangleMesh, Vertex, index_array};
use crate::parallel;
use crate::vector::{Vector3, coordinates};

/// Limit of the rounds.
const ROUNDS: usize = 3;

/// Areas are even where their deviation √(E_A/A) is below this.
const EVEN: f64 = 0.002;

/// A round is worthwhile if it lowers E_A to this part or less.
const WORTHWHILE: f64 = 0.5;

/// A face is split where the least area that its longest edge allows is more than this part of its target.
const BLOCKING: f64 = 0.1;

/// The least area of an obtuse face with corners on the unit sphere, over the cube of its longest edge.
const SAGITTA: f64 = 1.0 / 16.0;

/// The faces of a surface, some of them split, and where the split points lie.
#[derive(Debug, Clone)]
pub struct Refinement {
    /// (k, 2): the ends of the edge that each split point halves: vertices, or earlier split points, which are numbered
    /// on from the vertices.
    pub parents: Array2<u32>,
    /// (k, 3): the images of the split points, unit rows.
    pub positions: Array2<f64>,
    /// (m', 3): the faces between vertices and split points, oriented as the surface.
    pub faces: Array2<u32>,
    /// (m',): the given face that each of `faces` is a part of, ascending.
    pub face_of: Vec<usize>,
    /// (m',): the target measure of each of them, on the scale of the map's.
    pub targets: Vec<f64>,
    /// The distortion of these faces.
    pub distortion: Distortion,
}

impl Refinement {
    /// The split points on the surface that was mapped, (k, 3).
    ///
    /// # Panics
    /// Where `surface` has fewer vertices.
    pub fn vertices(&self, surface: &Surface) -> Array2<f64> {
        let mut all = rows(surface.vertices()).to_vec();
        for &[a, b] in rows(self.parents.view()) {
            let [a, b]: [[f64; 3]; 2] = [all[a as usize], all[b as usize]];
            // halves first, so that huge coordinates do not overflow
            all.push(std::array::from_fn(|k| 0.5 * a[k] + 0.5 * b[k]));
        }
        from_rows(all.split_off(surface.n_vertices()))
    }
}

/// A surface with some faces split.
#[derive(Clone)]
pub(super) struct Refined {
    pub mesh: TriangleMesh,
    pub targets: Vec<f64>,
    parents: Vec<[Vertex; 2]>,
    face_of: Vec<Face>,
}

/// Splits faces until areas are even; returns the map of the vertices and split points, with the status of the last
/// descent.
pub(super) fn refine(
    mesh: &TriangleMesh,
    targets: &[f64],
    (mut map, mut status): (SpatialMap, Status),
    options: &SphereMapOptions<'_>,
    history: &mut History,
    observer: &mut dyn Observer,
) -> (Refined, SpatialMap, Status) {
    let even = options.area_tolerance.or(options.tolerance).unwrap_or(EVEN);
    let mut refined = Refined::new(mesh, targets);
    let mut best = (refined.unevenness(&map), refined.clone(), map.clone(), status);
    for round in 0..ROUNDS {
        // a descent that was ended early says nothing about the mesh
        if matches!(status, Status::Cancelled | Status::MaxIterations) || best.0.sqrt() <= even {
            break;
        }
        // 1. Split the blocked faces
        let Some((next, start)) = refined.split(&map) else { break };
        // 2. Even out areas from there
        let fraction = |round: usize| round as f64 / ROUNDS as f64;
        let mut phase = Phase { whole: observer, from: fraction(round), to: fraction(round + 1) };
        (map, status) = match next.evened_out(&start, options, history, &mut phase) {
            Ok(result) => result,
            Err(Error::CancelledEarly) => (start, Status::Cancelled),
            Err(_) => break,
        };
        refined = next;
        // 3. Stop after a small gain, which is not worth its faces; after a loss the next round may still gain
        let unevenness = refined.unevenness(&map);
        if unevenness < WORTHWHILE * best.0 {
            best = (unevenness, refined.clone(), map.clone(), status);
        } else if status == Status::Cancelled {
            best.3 = status;
        } else if unevenness < best.0 {
            break;
        }
    }
    let (_, refined, map, status) = best;
    (refined, map, status)
}

impl Refined {
    /// The surface without splits.
    fn new(mesh: &TriangleMesh, targets: &[f64]) -> Self {
        let face_of = Face::all(mesh.n_faces()).collect();
        Self { mesh: mesh.clone(), targets: targets.to_vec(), parents: Vec::new(), face_of }
    }

    /// E_A over the area of the image.
    fn unevenness(&self, map: &SpatialMap) -> f64 {
        energy_share(&SphereObjective::new(&self.mesh, &self.targets), map)
    }

    /// The faces that cannot have their targets, as flags.
    fn blocked(&self, map: &[Vector3]) -> Vec<bool> {
        let scale = 4.0 * PI / parallel::sum(self.targets.len(), |face| self.targets[face]);
        parallel::map(self.mesh.n_faces(), |face| {
            let [a, b, c] = triangle(map, self.mesh.faces()[face]);
            let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
            SAGITTA * longest.powi(3) > BLOCKING * scale * self.targets[face]
        })
    }

    /// The surface with blocked faces split, and the map with the new midpoints; `None` where no face is blocked.
    fn split(&self, map: &[Vector3]) -> Option<(Self, SpatialMap)> {
        let blocked = self.blocked(map);
        if !blocked.contains(&true) {
            return None;
        }
        // 1. Longest edges of the image; mirrored edges differ in length by rounding only
        let points = self.mesh.points();
        let preference = tie_breakers(points);
        let length = |a: Vertex, b: Vertex| map[a].distance(map[b]) * (preference[a] + preference[b]);
        let Bisection { parents, faces, face_of, parts } = bisect_longest_edges(&self.mesh, &blocked, length);
        // 2. Midpoints on the surface and on the sphere
        let middle = |of: &[Vector3], [a, b]: [Vertex; 2]| (of[a] + of[b]) * 0.5;
        let on_surface = parents.iter().map(|&ends| middle(points, ends));
        let points: Vec<Vector3> = points.iter().copied().chain(on_surface).collect();
        let on_sphere = parents.iter().map(|&ends| onto_sphere(middle(map, ends)));
        let map: SpatialMap = map.iter().copied().map(Some).chain(on_sphere).collect::<Option<_>>()?;
        // 3. Targets
        let share = |k: usize| self.targets[face_of[k]] / f64::from(parts[k]);
        let split = Self {
            mesh: TriangleMesh::new(&coordinates(points), &faces).ok()?,
            targets: parallel::map(faces.len(), share),
            parents: self.parents.iter().copied().chain(parents).collect(),
            face_of: face_of.iter().map(|&face| self.face_of[face]).collect(),
        };
        Some((split, map))
    }

    /// A descent from a map.
    fn evened_out(
        &self,
        start: &SpatialMap,
        options: &SphereMapOptions<'_>,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> Result<(SpatialMap, Status), Error> {
        let start = from_vectors(start.clone());
        let options = SphereMapOptions { initial: Some(start.view()), density: None, ..*options };
        let weights = self.mesh.vertex_shares(&self.targets);
        let run = Run { mesh: &self.mesh, targets: &self.targets, weights: &weights, options: &options };
        run.renumbered(history, observer)
    }

    /// The distortion of the split faces, and of the given ones.
    pub(super) fn figures(&self, map: &[Vector3]) -> Result<(Distortion, Distortion), Error> {
        let (points, faces, image) = (self.mesh.points(), self.mesh.faces(), Image::Sphere(map));
        let of_parts = measure(points, faces, image, &self.targets)?;
        let of_faces = distortion_of_wholes(&of_parts, faces, image, &self.targets, &self.face_of)?;
        Ok((of_parts, of_faces))
    }

    /// The result for the caller, with the images of the split points.
    pub(super) fn into_refinement(self, positions: SpatialMap, distortion: Distortion) -> Refinement {
        Refinement {
            parents: index_array(&self.parents),
            positions: from_vectors(positions),
            faces: index_array(self.mesh.faces()),
            face_of: self.face_of.into_iter().map(Face::index).collect(),
            targets: self.targets,
            distortion,
        }
    }
}
