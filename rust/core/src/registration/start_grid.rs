// SPDX-License-Identifier: MIT OR Apache-2.0
//! Maps to the domain on a grid, and areas on another, before landmarks are carried there.
//!
//! Hundreds of steps carry landmarks, and noise grows in them. Where only a start is sought, the maps of both surfaces may
//! as well end on a grid that is fine beside faces and coarse beside noise, and areas be rounded likewise: nearly the same
//! surfaces then have the same start, but where a number lies midway between two of the grid.

use std::borrow::Cow;

use super::options::Energy;
use crate::codomain::CanonicalDomain;
use crate::mesh::geometry::{area, triangle};
use crate::mesh::{TriangleMesh, Vertex};
use crate::parallel;
use crate::vector::Vector3;

/// Width of the cells at a vertex, relative to the least height of its faces; too narrow to fold one.
const CELL: f64 = 1.0 / 16.0;

/// Width of the cells of areas, relative to the power of two below an area.
const AREA_CELL: f64 = 1.0 / 256.0;

/// The surface that a registration begins with: with rounded areas where a descent between the surfaces follows.
pub(super) fn start_mesh(mesh: &TriangleMesh, energy: Energy) -> Cow<'_, TriangleMesh> {
    let rounded = |area: f64| {
        let cell = AREA_CELL * area.log2().floor().exp2();
        (area / cell).round() * cell
    };
    match energy {
        Energy::Surface => {
            Cow::Owned(mesh.with_areas(mesh.face_areas().iter().copied().map(rounded).collect()))
        }
        Energy::Area => Cow::Borrowed(mesh),
    }
}

/// The map that a registration begins with: on the grid where a descent between the surfaces follows, and as it is where
/// its areas are kept.
pub(super) fn start_image(
    mesh: &TriangleMesh,
    map: Vec<Vector3>,
    domain: CanonicalDomain,
    energy: Energy,
) -> Vec<Vector3> {
    match energy {
        Energy::Surface => on_grid(mesh, &map, domain),
        Energy::Area => map,
    }
}

/// The map with its points on the grid: on the sphere, or in the disk with the boundary on the circle.
fn on_grid(mesh: &TriangleMesh, map: &[Vector3], domain: CanonicalDomain) -> Vec<Vector3> {
    let heights = parallel::map(mesh.n_faces(), |face| {
        let [a, b, c] = triangle(map, mesh.faces()[face]);
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        2.0 * area([a, b, c]) / longest
    });
    parallel::map(map.len(), |vertex| {
        let around = mesh.vertex_corners(Vertex::new(vertex));
        let least = around.iter().map(|corner| heights[corner.face()]).fold(f64::INFINITY, f64::min);
        let cell = (CELL * least).log2().round().exp2();
        let rounded = map[vertex].map(|x| (x / cell).round() * cell);
        match domain {
            // a face without area is left to those who mend it
            _ if !rounded.norm().is_finite() => map[vertex],
            CanonicalDomain::Sphere => rounded.normalized(),
            CanonicalDomain::Disk if mesh.is_boundary(Vertex::new(vertex)) => {
                let [x, y] = [rounded[0], rounded[1]];
                Vector3([x / x.hypot(y), y / x.hypot(y), 1.0])
            }
            CanonicalDomain::Disk => Vector3([rounded[0], rounded[1], 1.0]),
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::codomain::planar::flat;
    use crate::distortion::{folded_in_plane, folded_on_sphere};
    use crate::location::tests::{octasphere, rings};

    /// Points moved by about 10⁻¹² along the sphere or the plane.
    fn with_noise(points: &[Vector3], domain: CanonicalDomain) -> Vec<Vector3> {
        let noise = |k: usize| 1e-12 * ((k * 7919) % 1000) as f64 / 1000.0;
        let moved = |(k, &Vector3([x, y, z])): (usize, &Vector3)| match domain {
            CanonicalDomain::Sphere => {
                Vector3([x + noise(k), y - noise(k + 1), z + noise(k + 2)]).normalized()
            }
            CanonicalDomain::Disk => Vector3([x + noise(k), y - noise(k + 1), z]),
        };
        points.iter().enumerate().map(moved).collect()
    }

    fn sample(points: &[Vector3], faces: &[[Vertex; 3]]) -> TriangleMesh {
        let vertices: Vec<[f64; 3]> = points.iter().map(|point| point.0).collect();
        TriangleMesh::new(&vertices, faces).unwrap()
    }

    /// A turned sphere and a turned disk whose faces become thin toward one side.
    fn samples() -> [(TriangleMesh, Vec<Vector3>, CanonicalDomain); 2] {
        let (points, faces) = octasphere(4);
        let crowded = |&x: &Vector3| (x + Vector3([0.5, 0.3, -0.4])).normalized();
        let sphere: Vec<Vector3> = points.iter().map(crowded).collect();
        let (points, rings) = rings(12);
        let (sine, cosine) = 0.3f64.sin_cos();
        let crowded = |&Vector3([x, y, z]): &Vector3| {
            let inward = 1.0 - 0.5 * (1.0 - x * x - y * y);
            Vector3([inward * (cosine * x - sine * y), inward * (sine * x + cosine * y), z])
        };
        let disk: Vec<Vector3> = points.iter().map(crowded).collect();
        [
            (sample(&sphere, &faces), sphere, CanonicalDomain::Sphere),
            (sample(&disk, &rings), disk, CanonicalDomain::Disk),
        ]
    }

    #[test]
    fn noise_is_forgotten_on_the_grid_and_no_face_folds() {
        for (mesh, map, domain) in samples() {
            let on_grid = start_image(&mesh, map.clone(), domain, Energy::Surface);
            let noisy = with_noise(&map, domain);
            assert!(noisy != map);
            assert!(start_image(&mesh, noisy, domain, Energy::Surface) == on_grid, "{domain:?}");
            let folded = match domain {
                CanonicalDomain::Sphere => folded_on_sphere(mesh.faces(), &on_grid),
                CanonicalDomain::Disk => folded_in_plane(mesh.faces(), &flat(&on_grid)),
            };
            assert_eq!(folded, []);
            let [near, far] =
                [1e-6, 0.02].map(|d| (0..map.len()).filter(|&v| map[v].distance(on_grid[v]) > d).count());
            assert!(near > map.len() / 2 && far == 0, "{near} moved, {far} of them far");
        }
    }

    #[test]
    fn boundary_vertices_stay_on_the_circle() {
        let [_, (mesh, map, domain)] = samples();
        let on_grid = start_image(&mesh, map, domain, Energy::Surface);
        let on_boundary = Vertex::all(on_grid.len()).filter(|&vertex| mesh.is_boundary(vertex));
        let off = on_boundary.map(|vertex| (on_grid[vertex][0].hypot(on_grid[vertex][1]) - 1.0).abs());
        assert!(off.fold(0.0, f64::max) < 1e-15);
    }

    #[test]
    fn areas_are_rounded_by_little_and_noise_in_them_is_forgotten() {
        for (mesh, map, domain) in samples() {
            let rounded = start_mesh(&mesh, Energy::Surface).face_areas().to_vec();
            let ratios = rounded.iter().zip(mesh.face_areas()).map(|(a, b)| (a / b - 1.0).abs());
            let largest = ratios.fold(0.0, f64::max);
            assert!(largest > 1e-6 && largest <= 0.5 * AREA_CELL, "{largest}");
            let noisy = sample(&with_noise(&map, domain), mesh.faces());
            assert!(noisy.face_areas() != mesh.face_areas());
            assert!(start_mesh(&noisy, Energy::Surface).face_areas() == rounded, "{domain:?}");
        }
    }

    #[test]
    fn where_areas_are_kept_nothing_is_rounded() {
        for (mesh, map, domain) in samples() {
            assert!(start_image(&mesh, map.clone(), domain, Energy::Area) == map);
            assert!(start_mesh(&mesh, Energy::Area).face_areas() == mesh.face_areas());
        }
    }
}
