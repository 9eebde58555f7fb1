// SPDX-License-Identifier: MIT OR Apache-2.0
//! The mirror plane of a surface, and the mirror images of its vertices.
//!
//! 1. Candidates are the planes normal to the axes and to the principal directions, through the centroid and through
//!    the middle of the surface's extent.
//! 2. Iterated closest points refine each: pair vertices x with the vertices y nearest to their mirror images, keep the
//!    best pairs, and take the plane that mirrors these best. Its normal is the top eigenvector of Σ D Dᵀ − Σ m mᵀ with
//!    D = x − y and the centered midpoints m.
//! 3. All candidates are refined with few vertices, the best of them with many, if they are good.
//!
//! Input: one component. Nothing is random, and a mirrored surface has the mirrored plane. Cost: about 40,000 queries in a
//! tree of few vertices, and where these find a symmetry, O(n log² n) for a tree of all and 30,000 queries.

use crate::location::NearestPoint;
use crate::mesh::{Face, TriangleMesh, Vertex};
use crate::parallel;
use crate::sparse::top_eigenvector;
use crate::vector::Vector3;

/// Vertices by which every candidate is refined.
const ROUGH_SAMPLES: usize = 200;

/// Vertices among which those nearest to the images are sought at first.
const ROUGH_POINTS: usize = 10_000;

/// Candidates of a larger error, in units of the error accepted, are not refined by many vertices.
const ROUGH_ERROR: f64 = 2.5;

/// Vertices by which the best candidates are refined and judged.
const SAMPLES: usize = 1500;

/// Candidates that are refined by [`SAMPLES`] vertices.
const FINALISTS: usize = 3;

/// Limit of the steps of closest points with few vertices.
const ROUGH_STEPS: usize = 12;

/// Limit of the steps with many.
const STEPS: usize = 5;

/// The share of the pairs, the nearest ones, that decide on the next plane.
const KEPT_PAIRS: f64 = 0.8;

/// The share of the vertices whose mirror images must lie on the surface.
const JUDGED: f64 = 0.95;

/// The distance of a mirror image to the nearest vertex that is accepted on any mesh.
const TOLERANCE: f64 = 0.012;

/// Errors that differ by less are equal: the candidate that comes first is taken.
const EQUAL_ERRORS: f64 = 1e-9;

/// A refined plane takes the place of the one it comes from if this factor lowers its error at least: what is less, the
/// places of vertices on the surface decide.
const BETTER: f64 = 0.9;

/// Planes that differ by less are equal.
const EQUAL_PLANES: f64 = 1e-5;

/// A surface that extends less on either side of a plane, in units of the error accepted, lies in the plane.
const LEAST_EXTENT: f64 = 2.0;

/// Mirror images may miss their vertices by this part of the median edge.
const VERTEX_TOLERANCE: f64 = 0.2;

/// The plane of the points x with `normal` · x = `offset`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct MirrorPlane {
    /// The unit normal.
    pub normal: Vector3,
    /// The distance from the origin along the normal.
    pub offset: f64,
}

impl MirrorPlane {
    /// The signed distance of a point.
    pub(super) fn height(&self, x: Vector3) -> f64 {
        x.dot(self.normal) - self.offset
    }

    /// The mirror image of a point.
    pub(super) fn image(&self, x: Vector3) -> Vector3 {
        x - self.normal * (2.0 * self.height(x))
    }

    /// The point of the plane nearest to a point.
    pub(super) fn projection(&self, x: Vector3) -> Vector3 {
        x - self.normal * self.height(x)
    }

    fn is_equal(&self, other: &Self) -> bool {
        let sign = self.normal.dot(other.normal).signum();
        let apart = self.normal.distance(other.normal * sign);
        apart < EQUAL_PLANES && (self.offset - sign * other.offset).abs() < EQUAL_PLANES
    }
}

/// The mirror plane of a surface, in the coordinates of its points; `None` if it has none.
///
/// The normal points to the side of the first vertex that is far from the plane.
pub(super) fn mirror_plane(mesh: &TriangleMesh) -> Option<MirrorPlane> {
    let accepted = TOLERANCE.max(0.5 * mesh.median_edge_length());
    // 1. Candidates, refined with few vertices
    let points: Vec<Vector3> =
        evenly_sampled(mesh, ROUGH_POINTS).map(|vertex| mesh.points()[vertex]).collect();
    let samples: Vec<Vector3> =
        evenly_sampled(mesh, ROUGH_SAMPLES).map(|vertex| mesh.points()[vertex]).collect();
    let fit = Fit { points: &points, nearest: NearestPoint::new(&points), samples, steps: ROUGH_STEPS };
    let mut candidates = Vec::new();
    for plane in first_planes(mesh) {
        add(&mut candidates, fit.refined(plane));
    }
    candidates.retain(|(plane, error)| {
        *error <= ROUGH_ERROR * accepted && extends_beyond(mesh, plane, LEAST_EXTENT * accepted)
    });
    if candidates.is_empty() {
        return None;
    }
    // 2. The best of them, refined with many
    let points = mesh.points();
    let samples = evenly_sampled(mesh, SAMPLES).map(|vertex| points[vertex]).collect();
    let fit = Fit { points, nearest: NearestPoint::new(points), samples, steps: STEPS };
    let mut finalists = Vec::new();
    while finalists.len() < FINALISTS
        && let Some(best) = best_of(&candidates)
    {
        finalists.push(fit.refined(candidates.remove(best).0));
    }
    // 3. The best, if it is good enough
    let (plane, error) = finalists[best_of(&finalists)?];
    (error <= accepted).then(|| turned_to_first_side(mesh, plane))
}

/// The mirror image of every vertex, where the triangulation is symmetric: the vertex nearest to the image, which must be
/// near, and whose own image is the vertex. Cost: O(n log n), little where it is not symmetric.
pub(super) fn mirror_vertices(mesh: &TriangleMesh, plane: &MirrorPlane) -> Option<Vec<Vertex>> {
    let points = mesh.points();
    let nearest = NearestPoint::new(points);
    let largest = VERTEX_TOLERANCE * mesh.median_edge_length();
    let image = |vertex: Vertex| {
        let image = plane.image(points[vertex]);
        Some(nearest.of(image)).filter(|&nearest| points[nearest].distance(image) <= largest)
    };
    if evenly_sampled(mesh, SAMPLES).any(|vertex| image(vertex).is_none()) {
        return None;
    }
    let images = parallel::map(mesh.n_vertices(), |vertex| image(Vertex::new(vertex)));
    let images: Vec<Vertex> = images.into_iter().collect::<Option<_>>()?;
    Vertex::all(images.len()).all(|vertex| images[images[vertex]] == vertex).then_some(images)
}

/// Vertices evenly spaced in the list of all.
fn evenly_sampled(mesh: &TriangleMesh, n: usize) -> impl Iterator<Item = Vertex> {
    let (all, n) = (mesh.n_vertices(), n.min(mesh.n_vertices()));
    (0..n).map(move |k| Vertex::new(k * all / n))
}

/// The candidates before their refinement.
fn first_planes(mesh: &TriangleMesh) -> Vec<MirrorPlane> {
    let centroids: Vec<Vector3> = Face::all(mesh.n_faces()).map(|face| mesh.center(face)).collect();
    let total: f64 = mesh.face_areas().iter().sum();
    let weighted = centroids.iter().zip(mesh.face_areas());
    let center: Vector3 = weighted.clone().map(|(&x, &area)| x * (area / total)).sum();
    let mut covariance = [[0.0; 3]; 3];
    for (&x, &area) in weighted {
        add_square(&mut covariance, x - center, area / total);
    }
    let long = Vector3(top_eigenvector(&covariance));
    let flat = Vector3(top_eigenvector(&covariance.map(|row| row.map(|entry| -entry))));
    let axes = [0, 1, 2].map(Vector3::unit);
    let planes = axes.into_iter().chain([flat, flat.cross(long), long]).flat_map(|normal| {
        let [low, high] = extent(mesh, normal);
        [normal.dot(center), 0.5 * (low + high)].map(|offset| MirrorPlane { normal, offset })
    });
    planes.collect()
}

/// Adds `weight` x xᵀ to a matrix.
fn add_square(matrix: &mut [[f64; 3]; 3], x: Vector3, weight: f64) {
    for (i, row) in matrix.iter_mut().enumerate() {
        (0..3).for_each(|j| row[j] += weight * x[i] * x[j]);
    }
}

/// The least and the greatest coordinate along a direction.
fn extent(mesh: &TriangleMesh, normal: Vector3) -> [f64; 2] {
    let heights = mesh.points().iter().map(|point| point.dot(normal));
    heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], h| [low.min(h), high.max(h)])
}

fn extends_beyond(mesh: &TriangleMesh, plane: &MirrorPlane, distance: f64) -> bool {
    let [low, high] = extent(mesh, plane.normal);
    low < plane.offset - distance && high > plane.offset + distance
}

/// Adds a candidate with its error if it is new, or better than the one that it equals.
fn add(candidates: &mut Vec<(MirrorPlane, f64)>, (plane, error): (MirrorPlane, f64)) {
    match candidates.iter_mut().find(|(known, _)| known.is_equal(&plane)) {
        Some(known) if error < BETTER * known.1 => *known = (plane, error),
        Some(_) => {}
        None => candidates.push((plane, error)),
    }
}

/// The first of the candidates with the least error.
fn best_of(candidates: &[(MirrorPlane, f64)]) -> Option<usize> {
    (0..candidates.len())
        .reduce(|best, next| if candidates[next].1 < candidates[best].1 - EQUAL_ERRORS { next } else { best })
}

/// The plane with its normal towards the first vertex at least half as far away as the farthest.
fn turned_to_first_side(mesh: &TriangleMesh, plane: MirrorPlane) -> MirrorPlane {
    let heights = || mesh.points().iter().map(|&point| plane.height(point));
    let farthest = heights().fold(0.0, |farthest, height| f64::max(farthest, height.abs()));
    let first = heights().find(|height| height.abs() > 0.5 * farthest).unwrap_or(1.0);
    MirrorPlane { normal: plane.normal * first.signum(), offset: plane.offset * first.signum() }
}

/// Fits planes to the points of a surface.
struct Fit<'a> {
    points: &'a [Vector3],
    nearest: NearestPoint<'a>,
    /// The points whose images are compared with the surface.
    samples: Vec<Vector3>,
    /// Limit of the steps of closest points.
    steps: usize,
}

impl Fit<'_> {
    /// The points nearest to the images of the samples, with their distances.
    fn pairs(&self, plane: &MirrorPlane) -> Vec<(Vector3, f64)> {
        parallel::map(self.samples.len(), |sample| {
            let image = plane.image(self.samples[sample]);
            let nearest = self.points[self.nearest.of(image)];
            (nearest, nearest.distance(image))
        })
    }

    /// The distance that the images of [`JUDGED`] of the samples do not exceed.
    fn error(&self, plane: &MirrorPlane) -> f64 {
        quantile(&self.pairs(plane), JUDGED)
    }

    /// The plane after all steps of closest points, or the plane itself if that is hardly worse; with its error.
    fn refined(&self, first: MirrorPlane) -> (MirrorPlane, f64) {
        let mut plane = first;
        for _ in 0..self.steps {
            let previous = plane;
            plane = self.step(&plane);
            let moved = plane.normal.distance(previous.normal) + (plane.offset - previous.offset).abs();
            if moved < 1e-14 {
                break;
            }
        }
        let (error, first_error) = (self.error(&plane), self.error(&first));
        if error < BETTER * first_error { (plane, error) } else { (first, first_error) }
    }

    /// The plane that mirrors the best pairs of the last one best.
    fn step(&self, plane: &MirrorPlane) -> MirrorPlane {
        let pairs = self.pairs(plane);
        let farthest = quantile(&pairs, KEPT_PAIRS);
        let kept = self.samples.iter().zip(&pairs).filter(|(_, (_, distance))| *distance <= farthest);
        let ends = kept.map(|(&x, &(y, _))| [x, y]);
        let n = ends.clone().count() as f64;
        let center = ends.clone().map(|[x, y]| x + y).sum::<Vector3>() * (0.5 / n);
        let mut matrix = [[0.0; 3]; 3];
        for [x, y] in ends {
            add_square(&mut matrix, x - y, 1.0);
            add_square(&mut matrix, (x + y) * 0.5 - center, -1.0);
        }
        let normal = Vector3(top_eigenvector(&matrix));
        let normal = normal * normal.dot(plane.normal).signum();
        MirrorPlane { normal, offset: normal.dot(center) }
    }
}

/// The distance that a share of the pairs does not exceed.
fn quantile(pairs: &[(Vector3, f64)], share: f64) -> f64 {
    let mut distances: Vec<f64> = pairs.iter().map(|&(_, distance)| distance).collect();
    let rank = (share * (distances.len() - 1) as f64).round() as usize;
    *distances.select_nth_unstable_by(rank, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::alignment::rotation::{rotate, rotation_of};
    use crate::seams::sample_surfaces::{body, cup, uneven_body};
    use crate::vector::coordinates;

    /// The mesh turned by a unit quaternion.
    fn turned(mesh: &TriangleMesh, quaternion: [f64; 4]) -> (TriangleMesh, Vector3) {
        let rotation = rotation_of(quaternion);
        let points = mesh.points().iter().map(|&point| rotate(rotation, point));
        (TriangleMesh::new(&coordinates(points), mesh.faces()).unwrap(), rotate(rotation, Vector3::unit(0)))
    }

    #[test]
    fn the_plane_of_an_exactly_symmetric_mesh_is_exact_after_any_rotation() {
        let mesh = body(4);
        for quaternion in [[1.0, 0.0, 0.0, 0.0], [0.5, -0.1, 0.7, 0.5], [0.1, 0.7, -0.1, 0.7]] {
            let (mesh, normal) = turned(&mesh, quaternion);
            let plane = mirror_plane(&mesh).unwrap();
            assert!(plane.normal.cross(normal).norm() < 1e-12, "{plane:?} {normal:?}");
            let images = mirror_vertices(&mesh, &plane).unwrap();
            for vertex in Vertex::all(images.len()) {
                let image = plane.image(mesh.points()[vertex]);
                assert!(image.distance(mesh.points()[images[vertex]]) < 1e-12);
            }
        }
    }

    #[test]
    fn the_plane_does_not_need_a_symmetric_triangulation() {
        let (mesh, normal) = turned(&uneven_body(5), [0.5, -0.1, 0.7, 0.5]);
        let plane = mirror_plane(&mesh).unwrap();
        assert!(plane.normal.cross(normal).norm() < 2e-3, "{plane:?} {normal:?}");
        assert!(mirror_vertices(&mesh, &plane).is_none());
    }

    #[test]
    fn mirrored_input_has_the_mirrored_plane() {
        let (mesh, _) = turned(&uneven_body(4), [0.5, -0.1, 0.7, 0.5]);
        let mirrored: Vec<[f64; 3]> = mesh.points().iter().map(|&Vector3([x, y, z])| [x, -y, z]).collect();
        let faces: Vec<_> = mesh.faces().iter().map(|&[a, b, c]| [a, c, b]).collect();
        let [plane, mirrored] =
            [mesh, TriangleMesh::new(&mirrored, &faces).unwrap()].map(|mesh| mirror_plane(&mesh).unwrap());
        let Vector3([x, y, z]) = mirrored.normal;
        assert!(plane.normal.distance(Vector3([x, -y, z])) < 1e-12);
        assert!((plane.offset - mirrored.offset).abs() < 1e-12);
    }

    #[test]
    fn a_surface_without_symmetry_has_no_plane() {
        let bent = |mesh: &TriangleMesh, bend: &dyn Fn(Vector3) -> [f64; 3]| {
            let points: Vec<_> = mesh.points().iter().map(|&point| bend(point)).collect();
            TriangleMesh::new(&points, mesh.faces()).unwrap()
        };
        let lopsided = bent(&body(4), &|Vector3([x, y, z])| [x + 0.8 * y * y + 0.5 * x * z, y + 0.4 * x, z]);
        assert_eq!(mirror_plane(&lopsided), None);
        // a lopsided sheet is not symmetric under the plane in which it lies
        let sheet = bent(&cup(), &|Vector3([x, y, z])| {
            let radius = 2.0 + z + 0.5 * x;
            [x * radius + 0.3 * y * y, y * radius, 0.001 * z]
        });
        assert!(mirror_plane(&sheet).is_none_or(|plane| plane.normal[2].abs() < 0.5));
    }
}
