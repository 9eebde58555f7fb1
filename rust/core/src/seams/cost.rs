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
