// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a seam costs along each edge: its length, less where nobody looks and where the surface creases.
//!
//! The factor is (α + (1 − α) · openness) / (1 + 1.2 · concave + .8 · sharp), within [.25, 1]: concave is the dihedral
//! angle over 60° up to 1, sharp what a convex one has beyond 25° over 50°. It is .7 of that in the mirror plane, 4
//! times on diagonals of quads and on edges without a mirror image, 1 + 2 max(0, n · f) times where a front f is given,
//! and the caller's weight times.

use super::edge_mesh::EdgeMesh;
use super::symmetry::MirrorPlane;
use crate::mesh::Edge;
use crate::vector::Vector3;

/// α, the factor in a place that no light reaches.
const HIDDEN: f64 = 0.35;

/// The smallest factor, and the largest before what is dearer by its nature.
const LEAST: f64 = 0.25;
const MOST: f64 = 1.0;

/// Edges nearer to the mirror plane than this, over the diagonal of the bounding box, lie in it.
const ON_PLANE: f64 = 0.004;

/// The factor of edges in the mirror plane.
const MIRROR: f64 = 0.7;

/// The factor of diagonals of quads, and of edges without a mirror image.
const OFF_FLOW: f64 = 4.0;

/// The factor added where a face looks straight to the front.
const FACING: f64 = 2.0;

/// What the cost of seams depends on besides the mesh.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Preferences<'a> {
    /// The free share of the view at each vertex, (n,); lengths alone count where `None`.
    pub openness: Option<&'a [f64]>,
    pub plane: Option<&'a MirrorPlane>,
    /// A unit vector to the front.
    pub front: Option<Vector3>,
    /// The caller's factors, (e,); infinite where there must be no seam.
    pub weights: Option<&'a [f64]>,
    /// Whether each edge has no mirror image, (e,).
    pub lacks_image: Option<&'a [bool]>,
}

/// The cost of a seam along each edge, (e,).
pub(super) fn costs(mesh: &EdgeMesh, preferences: &Preferences<'_>) -> Vec<f64> {
    mesh.edges.all().map(|edge| mesh.lengths[edge] * factor(mesh, edge, preferences)).collect()
}

fn factor(mesh: &EdgeMesh, edge: Edge, preferences: &Preferences<'_>) -> f64 {
    let mut factor = preferences.openness.map_or(MOST, |openness| by_sight(mesh, edge, openness));
    if preferences.plane.is_some_and(|plane| is_on(mesh, edge, plane)) {
        factor = (factor * MIRROR).max(LEAST);
    }
    if mesh.is_diagonal[edge] {
        factor *= OFF_FLOW;
    }
    if preferences.lacks_image.is_some_and(|lacks_image| lacks_image[edge]) {
        factor *= OFF_FLOW;
    }
    if let Some(front) = preferences.front {
        factor *= 1.0 + FACING * normal_at(mesh, edge).dot(front).max(0.0);
    }
    factor * preferences.weights.map_or(1.0, |weights| weights[edge])
}

/// The factor by openness and crease.
fn by_sight(mesh: &EdgeMesh, edge: Edge, openness: &[f64]) -> f64 {
    let [a, b] = mesh.edges.ends(edge);
    let visible = HIDDEN + (1.0 - HIDDEN) * 0.5 * (openness[a] + openness[b]);
    let angle = mesh.dihedral_angle(edge).to_degrees();
    let concave = (angle / 60.0).clamp(0.0, 1.0);
    let sharp = ((-angle - 25.0) / 50.0).clamp(0.0, 1.0);
    (visible / (1.0 + 1.2 * concave + 0.8 * sharp)).clamp(LEAST, MOST)
}

fn is_on(mesh: &EdgeMesh, edge: Edge, plane: &MirrorPlane) -> bool {
    let points = mesh.mesh.points();
    mesh.edges.ends(edge).iter().all(|&vertex| plane.height(points[vertex]).abs() < ON_PLANE)
}

/// The mean normal of the faces beside an edge.
fn normal_at(mesh: &EdgeMesh, edge: Edge) -> Vector3 {
    let (first, second) = mesh.faces_at(edge);
    let sum = mesh.normal(first) + second.map_or(Vector3::ZERO, |second| mesh.normal(second));
    if sum == Vector3::ZERO { sum } else { sum.normalized() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seams::sample_surfaces::{cube, flat_grid};

    fn factors(mesh: &EdgeMesh, preferences: &Preferences<'_>) -> Vec<f64> {
        costs(mesh, preferences).iter().zip(&mesh.lengths).map(|(cost, length)| cost / length).collect()
    }

    fn assert_near(value: f64, expected: f64) {
        assert!((value - expected).abs() < 1e-12, "{value} {expected}");
    }

    #[test]
    fn without_preferences_the_cost_is_the_length() {
        let mesh = EdgeMesh::new(cube(2));
        assert_eq!(costs(&mesh, &Preferences::default()), mesh.lengths);
    }

    #[test]
    fn creases_and_hidden_places_are_cheap() {
        let outside = EdgeMesh::new(cube(2));
        let inside = EdgeMesh::new(cube(2).turned_over());
        let n = outside.n_vertices();
        for (mesh, crease, at_crease) in [(&outside, -90.0, 1.0 / 1.8), (&inside, 90.0, 1.0 / 2.2)] {
            for (openness, flat) in [(1.0, 1.0), (0.0, HIDDEN), (0.5, 0.675)] {
                let openness = vec![openness; n];
                let factors = factors(mesh, &Preferences { openness: Some(&openness), ..Default::default() });
                for (edge, factor) in mesh.edges.all().zip(factors) {
                    let angle = mesh.dihedral_angle(edge).to_degrees();
                    let expected = if angle.abs() < 1e-6 { flat } else { flat * at_crease };
                    assert!(angle.abs() < 1e-6 || (angle - crease).abs() < 1e-6);
                    assert_near(factor, expected.clamp(LEAST, MOST));
                }
            }
        }
    }

    #[test]
    fn the_mirror_plane_is_cheap_and_what_breaks_the_flow_is_dear() {
        let mut mesh = EdgeMesh::new(flat_grid(4, 4));
        mesh.is_diagonal[0] = true;
        let mut lacks_image = vec![false; mesh.n_edges()];
        lacks_image[1] = true;
        let plane = MirrorPlane { normal: Vector3::unit(0), offset: mesh.mesh.points()[2][0] };
        let plane = Some(&plane);
        let preferences = Preferences { plane, lacks_image: Some(&lacks_image), ..Default::default() };
        let factors = factors(&mesh, &preferences);
        for edge in mesh.edges.all() {
            let in_plane = mesh.edges.ends(edge).iter().all(|vertex| vertex.0 % 5 == 2);
            let expected = if in_plane {
                MIRROR
            } else if edge.0 < 2 {
                OFF_FLOW
            } else {
                1.0
            };
            assert_near(factors[edge], expected);
        }
    }

    #[test]
    fn edges_that_face_the_front_are_dear() {
        let mesh = EdgeMesh::new(cube(2));
        let front = Some(Vector3::unit(2));
        let factors = factors(&mesh, &Preferences { front, ..Default::default() });
        for edge in mesh.edges.all() {
            let (first, second) = mesh.faces_at(edge);
            let heights = [first, second.unwrap()].map(|face| mesh.normal(face)[2].round());
            let expected = match heights {
                [1.0, 1.0] => 1.0 + FACING,
                [1.0, _] | [_, 1.0] => 1.0 + FACING * 0.5f64.sqrt(),
                _ => 1.0,
            };
            assert_near(factors[edge], expected);
        }
    }

    #[test]
    fn weights_are_factors_and_forbid() {
        let mesh = EdgeMesh::new(flat_grid(3, 3));
        let weights: Vec<_> =
            mesh.edges.all().map(|edge| if edge.0 == 4 { f64::INFINITY } else { 1.5 }).collect();
        let factors = factors(&mesh, &Preferences { weights: Some(&weights), ..Default::default() });
        factors.iter().zip(&weights).for_each(|(factor, weight)| {
            assert!(factor == weight || (factor - weight).abs() < 1e-12);
        });
    }
}
