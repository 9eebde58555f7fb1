// SPDX-License-Identifier: MIT OR Apache-2.0
//! A start map without folds for every topological sphere and disk: coarse to fine.
//!
//! The surface is decimated to a tetrahedron, which is laid onto the sphere, or to a triangle, which is laid
//! into the disk, and gets its vertices back one by one. The polygon around a vertex that comes back is
//! star-shaped from the vertex onto which it had collapsed, so there is room for it nearby. It is placed there and
//! then moved, with its neighbors, to lower an energy of area and shape that is infinite at a fold. A filtered
//! determinant keeps every face from folding, whatever the shape: a conformal or Tutte map shrinks a tentacle of
//! length L and girth c by exp(−2π L/c), beyond double precision; this map does not.
//!
//! Cost: O(n log n), some twenty one-vertex Newton steps for each vertex, on one thread.

use std::f64::consts::{PI, TAU};

use super::decimation::{Collapse, Decimation};
use super::kernel::kernel_centroid;
use super::star::{Star, angle};
use crate::codomain::motion::{Motion, rotated};
use crate::control::{Observer, Phase, Status};
use crate::mesh::ties::{first_smallest, smallest_first};
use crate::mesh::{TriangleMesh, Vertex};
use crate::vector::Vector3;

/// λ, the weight of the shape in the energy.
const SHAPE: f64 = 0.3;

/// λ of the sweeps over a whole map, from the first to the last.
const RELAXED_SHAPES: [f64; 4] = [0.3, 0.1, 0.03, 0.01];

/// Powers of the targets for which double precision may suffice where it does not for the targets themselves.
const POWERS: [f64; 3] = [0.5, 0.25, 0.0];

/// Newton steps of a vertex that comes back.
const NEWTON_STEPS: usize = 5;

/// Sweeps over all vertices whenever their number has doubled.
const SWEEPS: usize = 2;

/// Neighbors of a vertex that comes back are not moved where their own degree is higher.
const MANY_NEIGHBORS: usize = 40;

/// Vertices between two questions to the observer.
const BEAT: usize = 1024;

/// The part of the progress that belongs to the decimation.
const COARSENING: f64 = 0.35;

/// Places on its arc, as parts from either end, where a boundary vertex may come back.
const ARC_PARTS: [f64; 10] = [0.5, 0.3, 0.15, 0.05, 0.01, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7];

/// The reason why there is no map.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stop {
    /// The observer ended the run.
    Cancelled,
    /// Double precision does not suffice.
    NoRoom,
}

/// The progressive map of a closed surface of genus 0 onto the unit sphere.
///
/// `targets` (m,) are the faces' target areas on any common scale, all positive. Returns unit vectors (n, 3)
/// of which no face is folded.
///
/// # Errors
/// [`Stop`].
pub fn progressive_sphere(
    mesh: &TriangleMesh,
    targets: &[f64],
    observer: &mut dyn Observer,
) -> Result<Vec<Vector3>, Stop> {
    built(mesh, targets, observer)
}

/// The progressive map of a surface with one boundary loop and no handle onto the unit disk.
///
/// `targets` (m,) are the faces' target areas on any common scale, all positive. Returns points (n, 2) of
/// which no face is folded; the boundary runs once around the unit circle, counter-clockwise.
///
/// # Errors
/// [`Stop`].
pub fn progressive_disk(
    mesh: &TriangleMesh,
    targets: &[f64],
    observer: &mut dyn Observer,
) -> Result<Vec<[f64; 2]>, Stop> {
    let places = built(mesh, targets, observer)?;
    Ok(places.into_iter().map(|Vector3([u, v, _])| [u, v]).collect())
}

/// The places of all vertices, for the targets, or for targets nearer to each other if there is no room.
fn built(mesh: &TriangleMesh, targets: &[f64], observer: &mut dyn Observer) -> Result<Vec<Vector3>, Stop> {
    let build = |targets: &[f64], observer: &mut dyn Observer| {
        let mut embedding = Embedding::new(mesh, targets);
        embedding.build(observer).map(|()| embedding.places)
    };
    let mut places = build(targets, observer);
    for power in POWERS {
        if places != Err(Stop::NoRoom) {
            break;
        }
        let nearer: Vec<f64> = targets.iter().map(|target| target.powf(power)).collect();
        places = build(&nearer, &mut Phase { whole: observer, from: 1.0, to: 1.0 });
    }
    places
}

/// A map without folds onto the sphere, relaxed by sweeps of one-vertex Newton steps that fold no face, with a falling
/// weight of the shape.
///
/// Returns the map with [`Status::Cancelled`] where the observer ended it early.
pub fn relaxed(
    mesh: &TriangleMesh,
    targets: &[f64],
    map: Vec<Vector3>,
    observer: &mut dyn Observer,
) -> (Vec<Vector3>, Status) {
    let mut embedding = Embedding::new(mesh, targets);
    embedding.places = map;
    embedding.placed = Vertex::all(mesh.n_vertices()).collect();
    let sweeps = 4 * RELAXED_SHAPES.len();
    for sweep in 0..sweeps {
        embedding.shape = RELAXED_SHAPES[sweep / 4];
        let fraction = |sweep: usize| sweep as f64 / sweeps as f64;
        let mut phase = Phase { whole: observer, from: fraction(sweep), to: fraction(sweep + 1) };
        if embedding.sweep(&mut phase).is_err() {
            return (embedding.places, Status::Cancelled);
        }
    }
    (embedding.places, Status::MaxIterations)
}

/// A map of the vertices that are back, with their connectivity.
struct Embedding<'a> {
    mesh: &'a TriangleMesh,
    decimation: Decimation<'a>,
    /// The places of the vertices: on the unit sphere, or in the disk at z = 1.
    places: Vec<Vector3>,
    /// The length along the boundary up to each of its vertices, 2π in total; empty on the sphere.
    traveled: Vec<f64>,
    /// λ, the weight of the shape in the energy.
    shape: f64,
    star: Star,
    room: [Vec<[f64; 2]>; 2],
    /// The vertices in the order in which they came back, which does not depend on their numbering.
    placed: Vec<Vertex>,
}

impl<'a> Embedding<'a> {
    fn new(mesh: &'a TriangleMesh, targets: &[f64]) -> Self {
        let boundary = mesh.boundary_loops().first();
        let size = boundary.map_or(4.0 * PI, |boundary| polygon_area(boundary.len()));
        let scale = size / targets.iter().sum::<f64>();
        Self {
            mesh,
            decimation: Decimation::new(mesh, targets.iter().map(|target| scale * target).collect()),
            places: vec![Vector3::ZERO; mesh.n_vertices()],
            traveled: boundary.map_or(Vec::new(), |boundary| traveled(mesh, boundary)),
            shape: SHAPE,
            star: Star::default(),
            room: Default::default(),
            placed: Vec::with_capacity(mesh.n_vertices()),
        }
    }

    fn build(&mut self, observer: &mut dyn Observer) -> Result<(), Stop> {
        // 1. Decimate to a tetrahedron or a triangle
        let mut coarsening = Phase { whole: observer, from: 0.0, to: COARSENING };
        self.decimation.coarsen(&mut coarsening).ok_or(Stop::Cancelled)?;
        // 2. Lay it onto the sphere or into the disk
        let mut n_placed = self.lay_base().ok_or(Stop::NoRoom)?;
        // 3. Bring the vertices back one by one
        let mut next_sweep = 2 * n_placed;
        let n = self.mesh.n_vertices();
        let fraction = |n_placed: usize| COARSENING + (1.0 - COARSENING) * n_placed as f64 / n as f64;
        while let Some(collapse) = self.decimation.refine() {
            self.insert(collapse).ok_or(Stop::NoRoom)?;
            n_placed += 1;
            if n_placed.is_multiple_of(BEAT) && !observer.progress(fraction(n_placed), "Refining") {
                return Err(Stop::Cancelled);
            }
            // 4. Relax all vertices whenever their number has doubled
            if n_placed == next_sweep || n_placed == n {
                next_sweep *= 2;
                for _ in 0..SWEEPS {
                    self.sweep(&mut Phase {
                        whole: observer,
                        from: fraction(n_placed),
                        to: fraction(n_placed),
                    })?;
                }
            }
        }
        Ok(())
    }

    /// Lays the remaining vertices onto a regular tetrahedron or triangle; returns their number.
    fn lay_base(&mut self) -> Option<usize> {
        let all = Vertex::all(self.mesh.n_vertices());
        let mut base: Vec<Vertex> = all.filter(|&vertex| !self.decimation.is_gone(vertex)).collect();
        let preferences: Vec<f64> = base.iter().map(|&vertex| self.decimation.preference(vertex)).collect();
        base = smallest_first(&preferences).into_iter().map(|k| base[k]).collect();
        self.placed.clone_from(&base);
        let third = 3f64.sqrt().recip();
        let (c, s) = (-0.5, 0.75f64.sqrt());
        let corners: &[Vector3] = if self.traveled.is_empty() {
            &[[1., 1., 1.], [1., -1., -1.], [-1., 1., -1.], [-1., -1., 1.]].map(|x| Vector3(x) * third)
        } else {
            &[[1., 0., 1.], [c, s, 1.], [c, -s, 1.]].map(Vector3)
        };
        if base.len() != corners.len() {
            return None;
        }
        // one of the two orders has the right orientation
        let orders: [&[usize]; 2] = [&[0, 1, 2, 3], &[0, 2, 1, 3]];
        for order in orders {
            base.iter().zip(order).for_each(|(&vertex, &k)| self.places[vertex] = corners[k]);
            self.fill_star(base[0]);
            if self.star.energy(self.places[base[0]], self.shape).is_some() {
                return Some(base.len());
            }
        }
        None
    }

    /// Places a vertex that comes back, and moves it and its neighbors.
    fn insert(&mut self, collapse: Collapse) -> Option<()> {
        let Collapse { vertex, onto } = collapse;
        let motion = self.motion(vertex);
        self.fill_star(vertex);
        // 1. A place
        let mut place = match motion {
            Motion::Circle => self.place_on_arc()?,
            motion => self.place_in_kernel(self.places[onto], motion)?,
        };
        // 2. Newton steps of the vertex
        for _ in 0..NEWTON_STEPS {
            let Some(better) = self.star.improved(place, motion, self.shape) else { break };
            place = better;
        }
        self.places[vertex] = place;
        self.placed.push(vertex);
        // 3. One Newton step of each neighbor, first of the vertex onto which it had collapsed
        let mut ring: Vec<Vertex> = self.decimation.star(vertex).map(|(next, _, _)| next).collect();
        let first = ring.iter().position(|&neighbor| neighbor == onto).unwrap_or(0);
        ring.rotate_left(first);
        for neighbor in ring {
            if neighbor != self.decimation.apex() && self.decimation.degree(neighbor) <= MANY_NEIGHBORS {
                self.relax(neighbor);
            }
        }
        self.relax(vertex);
        Some(())
    }

    /// A place inside the polygon around a vertex that had collapsed onto the one at `center`.
    fn place_in_kernel(&mut self, center: Vector3, motion: Motion) -> Option<Vector3> {
        let frame = motion.frame(center);
        let centroid = kernel_centroid(center, frame.axes, self.star.edges(), &mut self.room);
        // toward the vertex it went onto, where the kernel is
        let mut places = (0..12).map(|k| motion.moved(center, &frame, centroid.map(|x| 0.1f64.powi(k) * x)));
        places.find(|&place| self.star.energy(place, self.shape).is_some())
    }

    /// The best place on the arc between the neighbors of a vertex of the boundary.
    fn place_on_arc(&self) -> Option<Vector3> {
        let [(before, _), (behind, _)] = self.star.arcs?;
        let arc = angle(before, behind);
        let places =
            ARC_PARTS.iter().flat_map(|part| [part * arc, arc - part * arc]).map(|a| rotated(before, a));
        let energies = places.filter_map(|place| Some((self.star.energy(place, self.shape)?, place)));
        // a place and its mirror image on the arc may be equally good
        let (energies, places): (Vec<f64>, Vec<Vector3>) = energies.unzip();
        first_smallest(energies.into_iter()).map(|best| places[best])
    }

    /// One Newton step of every vertex in turn.
    fn sweep(&mut self, observer: &mut dyn Observer) -> Result<(), Stop> {
        let n = self.mesh.n_vertices();
        for k in 0..self.placed.len() {
            if k.is_multiple_of(BEAT) && !observer.progress(k as f64 / n as f64, "Relaxing") {
                return Err(Stop::Cancelled);
            }
            self.relax(self.placed[k]);
        }
        Ok(())
    }

    /// One Newton step of one vertex, which never folds a face.
    fn relax(&mut self, vertex: Vertex) {
        self.fill_star(vertex);
        let place = &mut self.places[vertex];
        if let Some(better) = self.star.improved(*place, self.motion(vertex), self.shape) {
            self.places[vertex] = better;
        }
    }

    fn motion(&self, vertex: Vertex) -> Motion {
        match (self.traveled.is_empty(), self.mesh.is_boundary(vertex)) {
            (true, _) => Motion::Sphere,
            (false, false) => Motion::Plane,
            (false, true) => Motion::Circle,
        }
    }

    fn fill_star(&mut self, vertex: Vertex) {
        let apex = self.decimation.apex();
        self.star.clear();
        let (mut before, mut behind) = (None, None);
        for (next, after, target) in self.decimation.star(vertex) {
            if next == apex {
                behind = Some(after);
            } else if after == apex {
                before = Some(next);
            } else {
                self.star.push(self.places[next], self.places[after], target);
            }
        }
        if let (Some(before), Some(behind)) = (before, behind) {
            let arc = |from: Vertex, to: Vertex| {
                let share = self.traveled[to] - self.traveled[from];
                if share > 0.0 { share } else { share + TAU }
            };
            let places = [before, behind].map(|vertex| self.places[vertex]);
            self.star.arcs = Some([(places[0], arc(before, vertex)), (places[1], arc(vertex, behind))]);
        }
    }
}

/// The area of the regular polygon in the unit circle.
fn polygon_area(n: usize) -> f64 {
    0.5 * n as f64 * (TAU / n as f64).sin()
}

/// The length along the boundary up to each of its vertices, 2π in total; 0 elsewhere.
fn traveled(mesh: &TriangleMesh, boundary: &[Vertex]) -> Vec<f64> {
    let point = |k: usize| mesh.points()[boundary[k % boundary.len()]];
    let lengths: Vec<f64> = (0..boundary.len()).map(|k| point(k).distance(point(k + 1))).collect();
    let total: f64 = lengths.iter().sum();
    let (mut traveled, mut so_far) = (vec![0.0; mesh.n_vertices()], 0.0);
    for (&vertex, length) in boundary.iter().zip(lengths) {
        traveled[vertex] = TAU * so_far / total;
        so_far += length;
    }
    traveled
}
