// SPDX-License-Identifier: MIT OR Apache-2.0
//! Moves a vertex onto each singular point of a layout by motions of the sphere that preserve areas.
//!
//! A face with a singular point inside would fold. A rotation takes a vertex onto the first singular point; twists that
//! keep the earlier ones take vertices onto the others. Among the vertices near a singular point, the one is chosen
//! whose faces distort areas least.
//!
//! Cost: one pass over all vertices per singular point; the choice looks at a few hundred faces.

use super::chart::signed_areas;
use super::development::develop;
use super::polygons::Polygons;
use super::projection::Projection;
use super::twist::{Motion, Side};
use crate::control::Watch;
use crate::error::Error;
use crate::mesh::Vertex;
use crate::mesh::corners::VertexCorners;
use crate::mesh::ties::rounded;
use crate::parallel;
use crate::vector::Vector3;

/// Number of vertices tried first; further ones are tried only while all fold faces.
const FIRST_CANDIDATES: usize = 6;

/// Largest number of vertices tried.
const CANDIDATES: usize = 30;

/// Largest number of vertices in the neighborhood of a singular point.
const NEIGHBORHOOD: usize = 150;

/// Radius of a neighborhood, so that on coarse meshes it does not reach the next singular point.
const FAR: f64 = 0.9;

/// Least number of vertices in a neighborhood.
const FEWEST: usize = 12;

/// Cost of a folded face.
const FOLD_PENALTY: f64 = 100.0;

/// Cost of moving a vertex, per squared distance in units of a typical face area.
const DETOUR: f64 = 0.25;

/// Squared distance, in units of a typical face area, up to which a vertex at a singular point is kept there, as on a
/// UV sphere.
const IN_PLACE: f64 = 0.1;

/// A mesh of the sphere with the targets of its layout.
pub(super) struct SphereMesh<'a> {
    /// (n, 3): points of the unit sphere in the coordinates of the projection.
    pub points: Vec<Vector3>,
    /// (m, 3), counter-clockwise from outside.
    pub faces: &'a [[Vertex; 3]],
    /// The corners at each vertex.
    pub corners: &'a VertexCorners,
    pub polygons: &'a Polygons,
    /// (m,): target areas; their sum is 4π.
    pub targets: &'a [f64],
    /// (n,): whether each vertex may be moved onto a singular point; all may if `None`.
    pub candidates: Option<&'a [bool]>,
}

/// The points of a mesh with a vertex on each singular point.
pub(super) struct Placed {
    /// (n, 3).
    pub points: Vec<Vector3>,
    /// (n,): whether each vertex lies on a singular point.
    pub is_singular: Vec<bool>,
}

/// Moves a vertex onto each singular point, the best one after skipping `rank`, by twists about centers on one `side` where
/// both are as good; `None` if there is no room for the motions.
///
/// # Errors
/// [`Error::CancelledEarly`] if the watch cancels.
pub(super) fn place_singular_points<P: Projection>(
    mesh: &SphereMesh<'_>,
    rank: usize,
    side: Side,
    watch: &Watch<'_>,
) -> Result<Option<Placed>, Error> {
    let mut points = mesh.points.clone();
    let mut is_singular = vec![false; points.len()];
    for (index, &goal) in P::SINGULAR.iter().enumerate() {
        if !watch.goes_on() {
            return Err(Error::CancelledEarly);
        }
        let placed = &P::SINGULAR[..index];
        let enough = if rank == 0 { FIRST_CANDIDATES } else { CANDIDATES };
        let part = Neighborhood::new(mesh, &points, &is_singular, goal);
        let ranked = part.ranked::<P>(goal, placed, side, enough);
        let Some(&vertex) = ranked.get(rank.min(ranked.len().saturating_sub(1))) else { return Ok(None) };
        let Some(motion) = motion(points[vertex], goal, placed, side) else { return Ok(None) };
        parallel::fill_with_old(&mut points, |_, point| motion.image(point));
        points[vertex] = goal;
        is_singular[vertex] = true;
    }
    Ok(Some(Placed { points, is_singular }))
}

/// The motion that takes a vertex to a singular point and keeps the singular points placed before.
fn motion(start: Vector3, goal: Vector3, placed: &[Vector3], side: Side) -> Option<Motion> {
    if placed.is_empty() {
        Some(Motion::rotation(start, goal))
    } else {
        Motion::twist(start, goal, placed, side)
    }
}

/// The part of a mesh around a singular point.
struct Neighborhood {
    /// Its vertices, nearest first.
    vertices: Vec<Vertex>,
    points: Vec<Vector3>,
    distances: Vec<f64>,
    /// Whether each of its vertices may be moved onto the point.
    may_move: Vec<bool>,
    faces: Vec<[Vertex; 3]>,
    polygons: Polygons,
    targets: Vec<f64>,
}

impl Neighborhood {
    fn new(mesh: &SphereMesh<'_>, points: &[Vector3], is_singular: &[bool], goal: Vector3) -> Self {
        // 1. Take the nearest vertices.
        let distances = parallel::map(points.len(), |vertex| points[vertex].distance(goal));
        let within = distances.iter().filter(|&&distance| distance < FAR).count();
        let vertices = nearest(&distances, within.clamp(FEWEST, NEIGHBORHOOD));
        // 2. Take the faces between them.
        const OUTSIDE: Vertex = Vertex(u32::MAX);
        let mut number = vec![OUTSIDE; points.len()];
        for (index, &vertex) in vertices.iter().enumerate() {
            number[vertex] = Vertex::new(index);
        }
        let corners = vertices.iter().flat_map(|&vertex| mesh.corners.of(vertex));
        let mut of_mesh: Vec<usize> = corners.map(|corner| corner.face().index()).collect();
        of_mesh.sort_unstable();
        of_mesh.dedup();
        of_mesh.retain(|&face| mesh.faces[face].iter().all(|&v| number[v] != OUTSIDE));
        let faces: Vec<[Vertex; 3]> =
            of_mesh.iter().map(|&face| mesh.faces[face].map(|v| number[v])).collect();
        let labels: Vec<usize> = of_mesh.iter().map(|&face| mesh.polygons.of[face]).collect();
        let may_move =
            |&v: &Vertex| !is_singular[v] && mesh.candidates.is_none_or(|candidates| candidates[v]);
        Self {
            points: vertices.iter().map(|&vertex| points[vertex]).collect(),
            distances: vertices.iter().map(|&vertex| distances[vertex]).collect(),
            may_move: vertices.iter().map(may_move).collect(),
            polygons: Polygons::new(&faces, Some(&labels)),
            targets: of_mesh.iter().map(|&face| mesh.targets[face]).collect(),
            faces,
            vertices,
        }
    }

    /// The vertices that may be moved onto the point, best first. Vertices beyond the `enough` nearest are tried only
    /// while all fold faces.
    fn ranked<P: Projection>(
        &self,
        goal: Vector3,
        placed: &[Vector3],
        side: Side,
        enough: usize,
    ) -> Vec<Vertex> {
        let typical_area = median(&self.targets);
        let mut costs: Vec<(f64, Vertex)> = Vec::new();
        let movable = (0..self.vertices.len()).filter(|&index| self.may_move[index]);
        for index in movable.take(CANDIDATES) {
            if costs.len() >= enough && costs.iter().any(|&(cost, _)| cost < FOLD_PENALTY) {
                break;
            }
            let detour = self.distances[index].powi(2) / typical_area;
            let cost = self.cost::<P>(index, goal, placed, side);
            let keeps_its_place = detour < IN_PLACE && cost < FOLD_PENALTY;
            costs.push((if keeps_its_place { 0.0 } else { cost } + DETOUR * detour, self.vertices[index]));
        }
        costs.retain(|&(cost, _)| cost.is_finite());
        // the sort is stable: equal costs, as of the sides of a symmetric surface, stay in the order of distances
        costs.sort_by(|a, b| rounded(a.0).total_cmp(&rounded(b.0)));
        costs.iter().map(|&(_, vertex)| vertex).collect()
    }

    /// The squared deviations of the areas, with a penalty per folded face, if a vertex is moved onto the point.
    fn cost<P: Projection>(&self, index: usize, goal: Vector3, placed: &[Vector3], side: Side) -> f64 {
        let Some(motion) = motion(self.points[index], goal, placed, side) else { return f64::INFINITY };
        let mut points: Vec<Vector3> = self.points.iter().map(|&point| motion.image(point)).collect();
        points[index] = goal;
        let chart = develop::<P>(&points, &self.faces, &self.polygons);
        let areas = signed_areas(&chart.images());
        let cost = |face: usize| {
            let ratio = areas[face] / (self.targets[face] * P::SCALE);
            if ratio > 0.0 && chart.is_closed[face] { (ratio - 1.0).powi(2) } else { FOLD_PENALTY }
        };
        (0..areas.len()).map(cost).sum()
    }
}

/// The indices of the `count` smallest distances, smallest first; of equal ones, up to rounding, the lowest first.
fn nearest(distances: &[f64], count: usize) -> Vec<Vertex> {
    let distance = |vertex: &Vertex| rounded(distances[*vertex]);
    let by_distance = |a: &Vertex, b: &Vertex| distance(a).total_cmp(&distance(b)).then(a.cmp(b));
    let mut chosen: Vec<Vertex> = Vertex::all(distances.len()).collect();
    if chosen.len() > count {
        chosen.select_nth_unstable_by(count, by_distance);
        chosen.truncate(count);
    }
    chosen.sort_unstable_by(by_distance);
    chosen
}

/// The median; NaN for an empty list.
fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    match sorted.len() {
        0 => f64::NAN,
        n => 0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]),
    }
}
