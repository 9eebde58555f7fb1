// SPDX-License-Identifier: MIT OR Apache-2.0
//! Carries the boundary of one disk onto the boundary of another: the step from the circle to the polygon.
//!
//! Both surfaces lie in the plane, one of them moves, the other is its *rim*. The image of the rim's boundary is a
//! polygon. Vertices of the moving surface between that polygon and the circle have no place on the other surface, and
//! snapped onto it their faces collapse. So the boundary is laid onto the polygon ([`places`]), in order, by the angle
//! about the polygon's center, and the interior follows by the mean-value combination of its neighbors, which is an
//! embedding into a convex boundary (Floater 2003).
//!
//! A face whose corners all lie on one straight side would have no area. [`ears`] finds these faces and turns the
//! boundary a little, so that a corner of the polygon comes to lie between their corners. Where there is no such corner
//! nearby, the ends of the face are set a little inside the polygon instead.
//!
//! Cost: one sparse LU of the interior vertices.

mod ears;
mod places;

use super::landmark_descent::Carrying;
use super::verdict::MISSED;
use crate::codomain::planar::{PlanarMap, flat, lifted};
use crate::codomain::{CanonicalDomain, SpatialMap};
use crate::control::{History, Observer, Phase, Status};
use crate::distortion::folded_in_plane;
use crate::energy::mean_value;
use crate::error::Error;
use crate::location::Location;
use crate::mesh::geometry::{area, triangle};
use crate::mesh::{TriangleMesh, Vertex};
use crate::parallel;
use crate::vector::Vector3;
use places::{Rim, Side};

/// Depths to which ends of flat faces are set inside the polygon, relative to the length of their side, in the order of
/// trial.
const DEPTHS: [f64; 5] = [0.1, 0.03, 0.01, 1e-3, 1e-4];

/// Rounds of carrying the boundary and the landmarks.
const ROUNDS: u32 = 5;

/// Farthest from the middle of the disk that landmarks are carried ahead.
const OUTERMOST: f64 = 0.98;

/// Rings around the faces at the boundary that follow it, in the order of trial.
const RINGS: [usize; 4] = [2, 4, 8, 16];

/// Least part of its area that a face near the boundary keeps.
const SQUEEZED: f64 = 0.1;

/// A map whose boundary lies on that of another surface.
#[derive(Debug, Clone, Default)]
pub(super) struct OnRim {
    /// The map of the moving surface, (n, 2).
    pub map: PlanarMap,
    /// Its boundary vertices on the rim, each with its place there; those at a corner of the rim are left out.
    pub on_edges: Vec<(Vertex, Location)>,
    /// Its boundary vertices inside the rim, ascending.
    pub inside: Vec<usize>,
}

impl OnRim {
    /// Puts the boundary vertices exactly on the edges of the rim.
    pub(super) fn set(&self, locations: &mut [Location]) {
        self.on_edges.iter().for_each(|&(vertex, location)| locations[vertex.index()] = location);
    }
}

/// Two disks in the plane z = 1 with their landmarks together; the boundary of the first goes onto the second's.
pub(super) struct Onto<'a> {
    pub meshes: [&'a TriangleMesh; 2],
    pub images: [&'a [Vector3]; 2],
    /// (k,) each: the landmarks of both.
    pub landmarks: [&'a [usize]; 2],
    /// The options of carrying the landmarks, see [`Carrying`].
    pub weight: f64,
    pub angle_weight: f64,
}

/// The first of two disks with its boundary on the second's.
pub(super) struct Carried {
    pub image: SpatialMap,
    pub on_rim: OnRim,
    /// Why the descent that followed ended; `None` where nothing had to move.
    pub status: Option<Status>,
}

impl Onto<'_> {
    /// Carries the boundary, then lowers the energy of the areas within it and brings the landmarks back to their
    /// places. Where they do not come back, they are carried ahead in the disk by as much as the boundary takes them
    /// along, once more. `None` where that folds faces or loses landmarks.
    ///
    /// # Errors
    /// If the system of the descent cannot be ordered.
    pub(super) fn carry(
        &self,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> Result<Option<Carried>, Error> {
        let places: Vec<Vector3> = self.landmarks[1].iter().map(|&vertex| self.images[1][vertex]).collect();
        let within = self.carrying(&places, true);
        let was_met = within.farthest(self.images[0]) <= MISSED;
        let (mut image, mut goals) = (self.images[0].to_vec(), places.clone());
        for round in 0..ROUNDS {
            // 1. The boundary onto the polygon; all else follows
            let Some(on_rim) = self.on_rim(&image) else { return Ok(None) };
            let laid = lifted(&on_rim.map);
            if laid == image {
                return Ok(Some(Carried { image, on_rim, status: None }));
            }
            // 2. The landmarks back to their places
            let from = f64::from(round) / f64::from(ROUNDS);
            let mut phase = Phase { whole: observer, from, to: from + 0.5 / f64::from(ROUNDS) };
            let (carried, status) = within.carry(laid.clone(), history, &mut phase)?;
            if !was_met || status == Status::Cancelled || within.farthest(&carried) <= MISSED {
                return Ok(Some(Carried { image: carried, on_rim, status: Some(status) }));
            }
            // 3. Or ahead of them in the disk
            for ((goal, &place), &vertex) in goals.iter_mut().zip(&places).zip(self.landmarks[0]) {
                let [x, y] = [0, 1].map(|axis| goal[axis] + place[axis] - laid[vertex][axis]);
                let shrink = (OUTERMOST / x.hypot(y)).min(1.0);
                *goal = Vector3([shrink * x, shrink * y, 1.0]);
            }
            let to = f64::from(round + 1) / f64::from(ROUNDS);
            let mut phase = Phase { whole: observer, from: from + 0.5 / f64::from(ROUNDS), to };
            (image, _) = self.carrying(&goals, false).carry(image, history, &mut phase)?;
        }
        Ok(None)
    }

    /// Carries the boundary with what is near it, and leaves the landmarks and all else in its place. `None` where that
    /// folds or squeezes faces.
    pub(super) fn carry_nearby(&self) -> Option<Carried> {
        let mesh = self.meshes[0];
        let mut may_move: Vec<bool> =
            Vertex::all(mesh.n_vertices()).map(|vertex| !mesh.is_boundary(vertex)).collect();
        self.landmarks[0].iter().for_each(|&vertex| may_move[vertex] = false);
        let on_boundary: Vec<usize> = (0..mesh.n_faces())
            .filter(|&face| mesh.faces()[face].iter().any(|&vertex| mesh.is_boundary(vertex)))
            .collect();
        RINGS.iter().find_map(|&rings| {
            let free = mean_value::free_within(mesh, &on_boundary, rings, |vertex| may_move[vertex]);
            let on_rim = self.laid(self.images[0], Some(&free))?;
            let image = lifted(&on_rim.map);
            let status = (image != self.images[0]).then_some(Status::Converged);
            let is_open = |face: usize| {
                let [before, after] =
                    [self.images[0], &image].map(|map| area(triangle(map, mesh.faces()[face])));
                after >= SQUEEZED * before
            };
            parallel::all(mesh.n_faces(), is_open).then_some(Carried { image, on_rim, status })
        })
    }

    /// The boundary of the first disk, as it lies in `image`, laid onto the second's.
    pub(super) fn on_rim(&self, image: &[Vector3]) -> Option<OnRim> {
        self.laid(image, None)
    }

    /// [`Self::on_rim`], where not all of the interior is free to follow but these vertices.
    fn laid(&self, image: &[Vector3], free: Option<&[Vertex]>) -> Option<OnRim> {
        let [map, rim] = [image, self.images[1]].map(flat);
        let [mesh, rim_mesh] = self.meshes;
        carried_onto(Side { mesh, map: &map }, Side { mesh: rim_mesh, map: &rim }, free)
    }

    fn carrying<'a>(&'a self, places: &'a [Vector3], holds_boundary: bool) -> Carrying<'a> {
        Carrying {
            mesh: self.meshes[0],
            domain: CanonicalDomain::Disk,
            holds_boundary,
            landmarks: self.landmarks[0],
            places,
            weight: self.weight,
            angle_weight: self.angle_weight,
        }
    }
}

/// The map of `moving` with its boundary carried onto that of `rim`; `None` where no such map without folds was found.
/// The interior follows, or of it the `free` vertices alone.
fn carried_onto(moving: Side<'_>, rim: Side<'_>, free: Option<&[Vertex]>) -> Option<OnRim> {
    // 1. Both boundaries by their angles about the middle of the polygon
    let rim = Rim::new(rim)?;
    let boundary = &moving.mesh.boundary_loops()[0];
    let angles = rim.angles_of(boundary.iter().map(|&vertex| moving.map[vertex]))?;
    // 2. Turned a little where faces would lose their areas
    let arcs = ears::narrow_arcs(moving.mesh, boundary);
    let angles = ears::turned(&angles, &arcs, &rim);
    // 3. The places on the polygon
    let places = rim.places(&angles);
    let flat = ears::flat_runs(&arcs, &places, &rim);
    // 4. The interior follows
    let depths = if flat.is_empty() { &[0.0][..] } else { &DEPTHS };
    let map = depths.iter().find_map(|&depth| {
        let mut points = rim.points(&places);
        ears::set_inside(&mut points, &flat, depth);
        follow(moving, boundary, &points, free)
    })?;
    let is_inside = ears::inside(&flat, &places);
    let on_edges = (0..boundary.len())
        .filter(|&k| !is_inside[k])
        .filter_map(|k| rim.location(places[k]).map(|location| (boundary[k], location)))
        .collect();
    let mut inside: Vec<usize> =
        (0..boundary.len()).filter(|&k| is_inside[k]).map(|k| boundary[k].index()).collect();
    inside.sort_unstable();
    Some(OnRim { map, on_edges, inside })
}

/// The map with its boundary moved to given points; `None` where it folds.
fn follow(
    moving: Side<'_>,
    boundary: &[Vertex],
    points: &[[f64; 2]],
    free: Option<&[Vertex]>,
) -> Option<PlanarMap> {
    let mut map = moving.map.to_vec();
    boundary.iter().zip(points).for_each(|(&vertex, &point)| map[vertex] = point);
    if map == moving.map {
        return Some(map);
    }
    let interior: Vec<Vertex> =
        Vertex::all(map.len()).filter(|&vertex| !moving.mesh.is_boundary(vertex)).collect();
    mean_value::carry(moving.mesh, moving.map, &mut map, free.unwrap_or(&interior))?;
    if is_sound(moving.mesh, &map) {
        return Some(map);
    }
    if free.is_none() {
        mean_value::correct(moving.mesh, &mut map, &interior, mean_value::Weights::Uniform)?;
    }
    is_sound(moving.mesh, &map).then_some(map)
}

fn is_sound(mesh: &TriangleMesh, map: &[[f64; 2]]) -> bool {
    map.iter().flatten().all(|x| x.is_finite()) && folded_in_plane(mesh.faces(), map).is_empty()
}

#[cfg(test)]
mod tests;
