// SPDX-License-Identifier: MIT OR Apache-2.0
//! Start maps onto the sphere: conformal by Laplacian linearization, or progressive.
//!
//! Angenent, Haker, Tannenbaum & Kikinis (1999), as used by Sutti & Yueh (2024), section 6.3: one face is
//! removed, its corners are held at a triangle in the plane, all others are harmonic, and the inverse
//! stereographic projection takes the plane to the sphere. Such a map is unique up to a Möbius
//! transformation, and the raw one puts nearly all of the surface next to one point. The map chosen here has
//! the centroid of the surface's measure at the sphere's center.
//!
//! It folds a few faces where cotangents are negative, which can be mended, and shrinks long thin parts
//! beyond double precision, which cannot; there the [progressive](progressive_sphere) map takes its place.
//!
//! Cost: one sparse Cholesky factorization of all vertices but three.

use std::f64::consts::PI;

use super::stereographic::{Chart, weighted_median};
use super::unfold;
use crate::codomain::SpatialMap;
use crate::control::{Observer, Watch};
use crate::distortion::folded_on_sphere;
use crate::embedding::{Stop, progressive_sphere};
use crate::energy::SpatialStretchEnergy;
use crate::error::{Elements, Error, NumericsError};
use crate::mesh::geometry::{corner_cotangents, triangle};
use crate::mesh::ties::{first_largest, tie_breakers};
use crate::mesh::{TriangleMesh, Vertex};
use crate::parallel;
use crate::sparse::{Cholesky, Laplacian, solve_dirichlet};
use crate::vector::Vector3;

/// Limit of the Newton steps of the centering; three or four are usual.
const CENTERING_STEPS: usize = 50;

/// Distance from the center below which the centroid counts as centered.
const CENTERED: f64 = 1e-9;

/// A face of the conformal map below this part of its target has collapsed beyond what a descent can mend.
const COLLAPSED: f64 = 1e-9;

/// The central projection of the surface is the start where its E_A is below this part of the conformal map's: the
/// surface is nearly a sphere, whose vertices a conformal map moves for nothing.
const ROUND: f64 = 0.1;

/// Upper bound of the cotangents of a rough map; its inverse is the lower bound.
const LARGEST_COTANGENT: f64 = 100.0;

/// Largest relative change of the roundness of a face by its distance from given vertices.
const NEARNESS: f64 = 1e-6;

const MESSAGE: &str = "Start map";

/// A map without folds from which a descent can start: the conformal one, mended where a few faces fold, or the
/// progressive one where parts of it have collapsed; on a sphere the surface itself.
///
/// # Errors
/// [`NumericsError::NoEmbedding`] where both fold in double precision, [`Error::CancelledEarly`] by the observer.
pub(super) fn start(
    mesh: &TriangleMesh,
    targets: &[f64],
    weights: &[f64],
    observer: &mut dyn Observer,
) -> Result<SpatialMap, Error> {
    // 1. The conformal map where it is of use, else the progressive one
    let conformal = conformal(mesh, weights, &Watch::new(observer, 0.0, MESSAGE));
    if matches!(conformal, Err(Error::CancelledEarly)) {
        return conformal;
    }
    let mended = conformal.as_ref().ok().and_then(|map| unfold::unfold(mesh, map));
    let (map, part) = match mended.clone().filter(|map| !has_collapsed(mesh, targets, map)) {
        Some(map) => (Some(map), ROUND),
        None => match progressive_sphere(mesh, targets, observer) {
            Err(Stop::Cancelled) => return mended.ok_or(Error::CancelledEarly),
            map => (map.ok(), 1.0),
        },
    };
    // 2. On a sphere the surface itself
    let energy = |map: &SpatialMap| SpatialStretchEnergy::new(mesh, targets).value(map).authalic_energy;
    let is_round = |radial: &SpatialMap| map.as_ref().is_none_or(|map| energy(radial) < part * energy(map));
    if let Some(radial) = radial(mesh, weights).filter(is_round) {
        return Ok(radial);
    }
    // 3. If all else fails, any map without folds
    map.or(mended).ok_or_else(|| match conformal {
        Ok(map) => NumericsError::NoEmbedding {
            folded: Elements::collect(folded_on_sphere(mesh.faces(), &map)).expect("it could not be mended"),
        }
        .into(),
        Err(error) => error,
    })
}

/// The surface seen from its centroid, where no face is folded there.
fn radial(mesh: &TriangleMesh, weights: &[f64]) -> Option<SpatialMap> {
    let total: f64 = weights.iter().sum();
    let centroid = Vector3::from_fn(|axis| {
        parallel::sum(mesh.n_vertices(), |v| weights[v] / total * mesh.points()[v][axis])
    });
    let offset = |v: usize| mesh.points()[v] - centroid;
    if !parallel::all(mesh.n_vertices(), |v| offset(v).norm() > 1e-6) {
        return None;
    }
    let map = parallel::map(mesh.n_vertices(), |v| offset(v).normalized());
    folded_on_sphere(mesh.faces(), &map).is_empty().then_some(map)
}

/// True if some face has less than [`COLLAPSED`] of its target area.
fn has_collapsed(mesh: &TriangleMesh, targets: &[f64], map: &[Vector3]) -> bool {
    let energy = SpatialStretchEnergy::new(mesh, targets);
    let (areas, least) = (energy.areas(map), COLLAPSED * 4.0 * PI / targets.iter().sum::<f64>());
    !parallel::all(areas.len(), |face| areas[face] > least * targets[face])
}

/// The spherical conformal map, centered; it may fold where cotangents are negative.
///
/// # Errors
/// [`NumericsError::FactorizationFailed`] where slivers make the cotangents too large.
fn conformal(mesh: &TriangleMesh, weights: &[f64], watch: &Watch<'_>) -> Result<SpatialMap, Error> {
    conformal_within(f64::INFINITY, mesh, weights, &[], watch)
}

/// A nearly conformal map, centered, without folds except by rounding: cotangents are clamped to positive, moderate
/// values. The `given` vertices, if any, choose among equally round faces, as on a symmetric surface: the map begins at the
/// one nearest to them.
///
/// # Errors
/// As [`conformal`], which is not to be expected, and [`Error::CancelledEarly`].
pub(crate) fn rough_conformal(
    mesh: &TriangleMesh,
    weights: &[f64],
    given: &[Vertex],
    watch: &Watch<'_>,
) -> Result<SpatialMap, Error> {
    conformal_within(LARGEST_COTANGENT, mesh, weights, given, watch)
}

/// The map for cotangents of at most `largest`, and where that is finite, at least its inverse.
fn conformal_within(
    largest: f64,
    mesh: &TriangleMesh,
    weights: &[f64],
    given: &[Vertex],
    watch: &Watch<'_>,
) -> Result<SpatialMap, Error> {
    let least = if largest.is_finite() { 1.0 / largest } else { f64::NEG_INFINITY };
    let by_face = corner_cotangents(mesh.points(), mesh.faces());
    let half = |cotangent: &f64| 0.5 * cotangent.clamp(least, largest);
    let by_corner: Vec<f64> = by_face.iter().flatten().map(half).collect();
    let removed = roundest_face(mesh, given);
    let mut plane = harmonic(mesh, removed, &by_corner, watch)?;
    normalize(&mut plane, weights);
    let map = centered(Chart::South.lift_all(&plane), weights);
    Ok(upright(map, mesh.faces()[removed]))
}

/// The map rotated so that the removed face lies at the south pole.
fn upright(map: SpatialMap, removed: [Vertex; 3]) -> SpatialMap {
    let [a, b, c] = triangle(&map, removed);
    let face = a + (b + c);
    // a half turn about the axis between the face and the pole
    let axis = face.normalized() + Vector3([0.0, 0.0, -1.0]);
    let length = axis.norm();
    let axis = if length > 1e-6 { axis * (1.0 / length) } else { Vector3([1.0, 0.0, 0.0]) };
    parallel::map(map.len(), |v| {
        let turned = axis * (2.0 * axis.dot(map[v])) - map[v];
        turned.normalized()
    })
}

/// The face nearest to an equilateral triangle; of several, preferences ([`tie_breakers`]) and nearness to the mean of the
/// given vertices decide, then the lowest index.
fn roundest_face(mesh: &TriangleMesh, given: &[Vertex]) -> usize {
    let roundness = |face: usize| {
        let [a, b, c] = triangle(mesh.points(), mesh.faces()[face]);
        let squares = [b - a, c - b, a - c].map(|edge| edge.dot(edge));
        mesh.face_areas()[face] / squares.iter().sum::<f64>()
    };
    // symmetric surfaces have several roundest faces
    let tie_breakers = tie_breakers(mesh.points());
    let middle = given.iter().map(|&vertex| mesh.points()[vertex]).sum::<Vector3>()
        * (1.0 / given.len().max(1) as f64);
    let nearness =
        |vertex: Vertex| if given.is_empty() { 0.0 } else { -mesh.points()[vertex].distance(middle) };
    let values = parallel::map(mesh.n_faces(), |face| {
        let of_vertex = |&vertex: &Vertex| tie_breakers[vertex] + NEARNESS * nearness(vertex);
        let preference: f64 = mesh.faces()[face].iter().map(of_vertex).sum();
        preference * roundness(face)
    });
    first_largest(&values).expect("a mesh has faces")
}

/// Solves L_II h_I = −L_IB h_B with the corners of the removed face held.
///
/// The held triangle has that face's shape and is run through clockwise, so that all other faces run
/// counter-clockwise inside it.
fn harmonic(
    mesh: &TriangleMesh,
    removed: usize,
    by_corner: &[f64],
    watch: &Watch<'_>,
) -> Result<Vec<[f64; 2]>, Error> {
    let held = mesh.faces()[removed];
    let mut plane = vec![[0.0; 2]; mesh.n_vertices()];
    for (vertex, place) in held.into_iter().zip(mirrored_triangle(triangle(mesh.points(), held))) {
        plane[vertex] = place;
    }
    let mut laplacian = Laplacian::new(mesh, |vertex| !held.contains(&vertex));
    let mut factor = Cholesky::analyze_on(mesh, laplacian.matrix())?;
    solve_dirichlet(mesh, &mut laplacian, &mut factor, by_corner, &mut plane, watch)?;
    Ok(plane)
}

/// A triangle of space laid into the plane clockwise, its centroid at the origin, of size 1.
fn mirrored_triangle([a, b, c]: [Vector3; 3]) -> [[f64; 2]; 3] {
    let length = a.distance(b);
    let along = (b - a) * (1.0 / length);
    let corners = [[0.0, 0.0], [length, 0.0], [(c - a).dot(along), -along.cross(c - a).norm()]];
    let centroid = [0, 1].map(|axis| corners.iter().map(|corner| corner[axis]).sum::<f64>() / 3.0);
    corners.map(|corner| [0, 1].map(|axis| (corner[axis] - centroid[axis]) / length))
}

/// Moves the median of the measure to the origin and scales its median modulus to 1.
fn normalize(plane: &mut [[f64; 2]], weights: &[f64]) {
    let medians = [0, 1].map(|axis| {
        let values: Vec<f64> = plane.iter().map(|z| z[axis]).collect();
        weighted_median(&values, weights)
    });
    plane.iter_mut().for_each(|z| *z = [z[0] - medians[0], z[1] - medians[1]]);
    let moduli: Vec<f64> = plane.iter().map(|z| z[0].hypot(z[1])).collect();
    let scale = weighted_median(&moduli, weights);
    if scale > 0.0 {
        plane.iter_mut().for_each(|z| *z = [z[0] / scale, z[1] / scale]);
    }
}

/// Moves the centroid of the measure to the center by Möbius transformations of the sphere.
///
/// Newton's method: the boost toward −b moves x by −(b − (b·x) x) to first order, so the b that brings the
/// centroid c to the center solves (I − Σ w x xᵀ) b = c.
fn centered(mut map: SpatialMap, weights: &[f64]) -> SpatialMap {
    let total: f64 = weights.iter().sum();
    for _ in 0..CENTERING_STEPS {
        let moment = |value: &(dyn Fn(Vector3) -> f64 + Sync)| {
            parallel::sum(map.len(), |v| weights[v] / total * value(map[v]))
        };
        let centroid = Vector3::from_fn(|axis| moment(&|x| x[axis]));
        if centroid.norm() < CENTERED {
            break;
        }
        let jacobian: [Vector3; 3] = std::array::from_fn(|row| {
            Vector3::from_fn(|column| f64::from(u8::from(row == column)) - moment(&|x| x[row] * x[column]))
        });
        let Some(shift) = solve_three(jacobian, centroid) else { break };
        // a full step of more than half the radius is shortened: the ball ends at 1
        let shift = shift * (0.5 * (1.0f64).min(0.9 / shift.norm()));
        map = parallel::map(map.len(), |v| boosted(map[v], shift));
    }
    map
}

/// The Möbius transformation of the unit ball that takes `a` to the center, at a point of the sphere.
fn boosted(x: Vector3, a: Vector3) -> Vector3 {
    let offset = x - a;
    let moved = offset * ((1.0 - a.dot(a)) / offset.dot(offset)) - a;
    moved.normalized()
}

/// Cramer's rule; `None` where the three rows lie in a plane.
fn solve_three([a, b, c]: [Vector3; 3], rhs: Vector3) -> Option<Vector3> {
    let determinant = a.dot(b.cross(c));
    let sum = b.cross(c) * rhs[0] + c.cross(a) * rhs[1] + a.cross(b) * rhs[2];
    let solution = sum * (1.0 / determinant);
    solution.is_finite().then_some(solution)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::location::tests::octasphere;

    /// A ball with noise of about 10⁻¹².
    fn ball(seed: usize) -> TriangleMesh {
        let (points, faces) = octasphere(3);
        let noise = |k: usize| 1e-12 * ((k * 7919 + seed * 104_729) % 1000) as f64 / 1000.0;
        let moved =
            |(k, &Vector3([x, y, z])): (usize, &Vector3)| [x + noise(k), y - noise(k + 1), z + noise(k + 2)];
        let vertices: Vec<[f64; 3]> = points.iter().enumerate().map(moved).collect();
        TriangleMesh::new(&vertices, &faces).unwrap()
    }

    #[test]
    fn of_equally_round_faces_given_vertices_choose_and_not_noise() {
        let (points, _) = octasphere(3);
        for direction in [Vector3([0.6, 0.5, 0.7]), Vector3([-0.6, -0.5, -0.7]), Vector3([0.6, -0.7, 0.5])] {
            let away = |&a: &Vertex, &b: &Vertex| {
                points[a].distance(direction).total_cmp(&points[b].distance(direction))
            };
            let given = [Vertex::all(points.len()).min_by(away).unwrap()];
            let face = roundest_face(&ball(0), &given);
            let corners = triangle(&points, ball(0).faces()[face]);
            let middle = corners.into_iter().sum::<Vector3>();
            assert!((0..3).all(|axis| middle[axis] * direction[axis] > 0.0), "{middle:?} {direction:?}");
            assert!((1..6).all(|seed| roundest_face(&ball(seed), &given) == face));
        }
        let face = roundest_face(&ball(0), &[]);
        assert!((1..6).all(|seed| roundest_face(&ball(seed), &[]) == face));
    }
}
