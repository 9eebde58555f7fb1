// SPDX-License-Identifier: MIT OR Apache-2.0
//! Unfolds the few faces that straight edges fold in a layout.
//!
//! Local optimization (Freitag & Plassmann, Local Optimization-Based Simplicial Mesh Untangling and Improvement, 2000):
//! each vertex in turn moves to the place that maximizes the least area of its faces, relative to their targets. The
//! area of a face is linear in the place of a vertex, so the least area is concave, and a pattern search finds its
//! maximum.

use std::f64::consts::PI;

use super::certificate::nearly_folded;
use super::chart::{Chart, Point, center_polar_corners, signed_area};
use super::projection::Projection;
use super::relaxation::Goal;
use crate::control::Watch;
use crate::mesh::{Corner, Vertex};

/// Least area of its faces, relative to their targets, at which a vertex stays in its place.
const GOOD: f64 = 0.25;

/// Number of sweeps without success after which another ring of faces is included.
const GROWING: usize = 3;

/// Number of sweeps without success after which the search stops.
const PATIENCE: usize = 12;

/// Number of directions of the pattern search.
const DIRECTIONS: usize = 12;

/// Number of rounds of the pattern search; each moves the vertex or halves the step.
const TRIALS: usize = 14;

/// Moves vertices until no face is folded, or no move helps.
pub(super) fn unfold<P: Projection>(chart: &mut Chart<'_, P>, goal: &Goal<'_>, watch: &Watch<'_>) {
    let mut images = chart.images();
    let (mut fewest, mut sweeps_since) = (usize::MAX, 0);
    loop {
        // 1. Find the folded faces, and whether they have become fewer.
        let is_folded = nearly_folded(&images, goal.rounding);
        let mut faces: Vec<usize> = (0..is_folded.len()).filter(|&face| is_folded[face]).collect();
        (fewest, sweeps_since) =
            if faces.len() < fewest { (faces.len(), 0) } else { (fewest, sweeps_since + 1) };
        if faces.is_empty() || sweeps_since > PATIENCE || !watch.goes_on() {
            return;
        }
        // 2. Include rings of faces around them after sweeps without success.
        for _ in 0..sweeps_since / GROWING {
            faces = faces_around(&vertices_of(chart.faces, &faces), goal);
        }
        // 3. Move each of their vertices to its best place.
        for vertex in vertices_of(chart.faces, &faces) {
            if !goal.fixed[vertex] {
                improve(chart, &mut images, goal, vertex);
            }
        }
    }
}

fn vertices_of(faces: &[[Vertex; 3]], chosen: &[usize]) -> Vec<Vertex> {
    let mut vertices: Vec<Vertex> = chosen.iter().flat_map(|&face| faces[face]).collect();
    vertices.sort_unstable();
    vertices.dedup();
    vertices
}

fn faces_around(vertices: &[Vertex], goal: &Goal<'_>) -> Vec<usize> {
    let corners = vertices.iter().flat_map(|&vertex| goal.corners.of(vertex));
    let mut faces: Vec<usize> = corners.map(|corner| corner.face().index()).collect();
    faces.sort_unstable();
    faces.dedup();
    faces
}

/// Moves a vertex to the place that maximizes the least area of its faces relative to their targets.
fn improve<P: Projection>(
    chart: &mut Chart<'_, P>,
    images: &mut [[Point; 3]],
    goal: &Goal<'_>,
    vertex: Vertex,
) {
    let corners = goal.corners.of(vertex);
    let split = |corner: Corner| (corner.face(), corner.place());
    // 1. Search the best place.
    let worst = |place: Point| {
        if !P::is_within(place) {
            return f64::NEG_INFINITY;
        }
        let share = |&corner: &Corner| {
            let (face, k) = split(corner);
            let mut triangle = images[face];
            triangle[k] = chart.isometries[face][k].image(P::PERIODS, place);
            signed_area(triangle) / goal.targets[face]
        };
        corners.iter().map(share).fold(f64::INFINITY, f64::min)
    };
    let mut best = (worst(chart.places[vertex]), chart.places[vertex]);
    if best.0 >= GOOD {
        return;
    }
    let opposite_edge = |&corner: &Corner| {
        let (face, k) = split(corner);
        let [a, b] = [images[face][(k + 1) % 3], images[face][(k + 2) % 3]];
        (a[0] - b[0]).hypot(a[1] - b[1])
    };
    let mut step = corners.iter().map(opposite_edge).fold(0.0, f64::max);
    for _ in 0..TRIALS {
        let around = |k: usize| {
            let (sine, cosine) = (k as f64 * 2.0 * PI / DIRECTIONS as f64).sin_cos();
            let place = [best.1[0] + step * cosine, best.1[1] + step * sine];
            (worst(place), place)
        };
        let trial = (1..DIRECTIONS).map(around).fold(around(0), |a, b| if b.0 > a.0 { b } else { a });
        if trial.0 > best.0 {
            best = trial;
        } else {
            step /= 2.0;
        }
    }
    // 2. Move the vertex there.
    chart.places[vertex] = best.1;
    for &corner in corners {
        let (face, k) = split(corner);
        images[face][k] = chart.image(corner);
    }
    center_polar_corners(&chart.polar, images);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::Silent;
    use crate::layout::certificate::Precision;
    use crate::layout::chart::signed_areas;
    use crate::layout::development::develop;
    use crate::layout::lambert::Lambert;
    use crate::layout::octahedral::Octahedral;
    use crate::layout::polygons::Polygons;
    use crate::layout::sample_spheres::turned_ball;
    use crate::layout::singular_points::{Placed, SphereMesh, place_singular_points};
    use crate::layout::twist::Side;
    use crate::mesh::corners::VertexCorners;
    use crate::mesh::geometry::{area, triangle};

    fn assert_unfolds_and_leaves_the_rest<P: Projection>() {
        let (points, faces) = turned_ball(3);
        let corners = VertexCorners::new(points.len(), &faces);
        let polygons = Polygons::new(&faces, None);
        let areas: Vec<f64> = faces.iter().map(|&face| area(triangle(&points, face))).collect();
        let mesh = SphereMesh {
            points,
            faces: &faces,
            corners: &corners,
            polygons: &polygons,
            targets: &areas,
            candidates: None,
        };
        let mut silent = Silent;
        let watch = Watch::new(&mut silent, 0.0, "");
        let Placed { points, is_singular: fixed } =
            place_singular_points::<P>(&mesh, 0, Side::Left, &watch).unwrap().unwrap();
        // 1. Some vertices far from the singular points go over their faces
        let mut chart = develop::<P>(&points, &faces, &polygons);
        let before = chart.images();
        let inner = |vertex: &Vertex| (points[*vertex][2] - 0.5).abs() < 0.1;
        let moved: Vec<Vertex> = Vertex::all(points.len()).filter(inner).step_by(7).collect();
        let step = 0.35 * P::SCALE.sqrt();
        for &vertex in &moved {
            chart.places[vertex][0] += 0.8 * step;
            chart.places[vertex][1] += 0.6 * step;
        }
        let rounding = Precision::Single.rounding(&before);
        let folded = nearly_folded(&chart.images(), rounding);
        assert!(folded.iter().filter(|&&is_folded| is_folded).count() > moved.len());
        // 2. Nothing is folded any more
        let targets: Vec<f64> = areas.iter().map(|area| area * P::SCALE).collect();
        let goal = Goal { targets: &targets, fixed: &fixed, corners: &corners, tolerance: 0.01, rounding };
        unfold(&mut chart, &goal, &watch);
        let images = chart.images();
        assert!(signed_areas(&images).iter().all(|&area| area > 0.0));
        // 3. Faces far away stay
        let at_moved = |face: usize| faces[face].iter().any(|vertex| moved.contains(vertex));
        let mut is_near = vec![false; points.len()];
        for face in (0..faces.len()).filter(|&face| at_moved(face)) {
            faces[face].iter().for_each(|&vertex| is_near[vertex] = true);
        }
        let far = (0..faces.len()).filter(|&face| faces[face].iter().all(|&v| !is_near[v]));
        let (stay, count) = far.fold((0, 0), |(stay, count), face| {
            (stay + usize::from(images[face] == before[face]), count + 1)
        });
        assert!(count > faces.len() / 4);
        assert!(10 * stay > 9 * count, "{stay} of {count}");
    }

    #[test]
    fn folds_are_opened_and_the_rest_stays() {
        assert_unfolds_and_leaves_the_rest::<Lambert>();
        assert_unfolds_and_leaves_the_rest::<Octahedral>();
    }
}
