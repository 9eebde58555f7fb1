// SPDX-License-Identifier: MIT OR Apache-2.0
//! The proxy: a mesh of about a thousand vertices near a surface, on which seams are searched.
//!
//! - A mesh of few vertices is refined, since long triangles hide what its seams do. Seams may run only along halves of
//!   its edges then.
//! - A mesh of about the right size is its own proxy.
//! - A larger one is decimated; where it has a mirror plane, so that the proxy is exactly symmetric.
//!
//! Input: one component, in the coordinates of [`TriangleMesh::points`], which are those of the proxy too.

mod connectivity;
mod correspondence;
mod decimate;
mod quadric;
mod refine;
mod symmetric;

use super::symmetry::{MirrorPlane, mirror_vertices};
use crate::control::{Observer, Watch};
use crate::error::Error;
use crate::mesh::{EdgeTable, TriangleMesh, Vertex};
pub(super) use correspondence::nearest_vertices;
use decimate::decimate;
use refine::refine;
use symmetric::{SymmetricMesh, symmetric_mesh};

/// The vertices of a decimated proxy.
const TARGET: usize = 850;

/// Meshes of up to this many vertices are not decimated.
const LARGEST: usize = 1150;

/// Meshes of fewer vertices are refined.
const SMALL: usize = 600;

/// Meshes of fewer vertices are refined twice.
const TINY: usize = 250;

/// A mesh that stands for another one.
#[derive(Debug)]
pub(super) struct Proxy {
    /// The mesh, in the coordinates of the one it stands for.
    pub mesh: TriangleMesh,
    /// (n,): the vertex of the other mesh that each vertex stands for: at its place where there is one.
    pub nearest: Vec<Vertex>,
    /// (n,): the mirror image of each vertex, if the proxy is symmetric.
    pub mirror: Option<Vec<Vertex>>,
    /// The edges whose mirror image is no edge, each with its lower end first, in ascending order.
    pub without_image: Vec<[Vertex; 2]>,
    /// For a refined proxy the edges that are parts of edges of the other mesh, in ascending order.
    pub halves: Option<Vec<Half>>,
}

/// A half, or quarter, of an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Half {
    /// The edge of the refined mesh, its lower end first.
    pub edge: [Vertex; 2],
    /// The edge of the original mesh of which it is a part, its lower end first.
    pub of: [Vertex; 2],
}

/// The proxy of a mesh, symmetric under `plane` where that can be. Cost: O(n log n).
///
/// # Errors
/// Cancelled, or a mesh whose refinement has faces too small to have an area.
pub(super) fn proxy(
    mesh: &TriangleMesh,
    plane: Option<&MirrorPlane>,
    observer: &mut dyn Observer,
) -> Result<Proxy, Error> {
    if mesh.n_vertices() < SMALL {
        return refined(mesh, plane);
    }
    if mesh.n_vertices() > LARGEST {
        return coarser(mesh, plane, TARGET, observer);
    }
    let nearest = Vertex::all(mesh.n_vertices()).collect();
    Ok(with_mirror(mesh.clone(), plane, nearest))
}

/// A mesh of about `n_vertices` that stands for one of more, symmetric under `plane` where that can be.
///
/// # Errors
/// Cancelled.
pub(super) fn coarser(
    mesh: &TriangleMesh,
    plane: Option<&MirrorPlane>,
    n_vertices: usize,
    observer: &mut dyn Observer,
) -> Result<Proxy, Error> {
    let watch = Watch::new(observer, 0.0, "Simplifying the surface");
    if let Some(plane) = plane {
        let symmetric = symmetric_mesh(mesh, plane, n_vertices, &watch).ok_or(Error::CancelledEarly)?;
        if let Some(symmetric) = symmetric {
            return Ok(sliced(mesh, symmetric));
        }
    }
    decimated(mesh, n_vertices, &watch)
}

/// The proxy by uniform refinement.
fn refined(mesh: &TriangleMesh, plane: Option<&MirrorPlane>) -> Result<Proxy, Error> {
    let rounds = if mesh.n_vertices() < TINY { 2 } else { 1 };
    let mut current = mesh.clone();
    let mut nearest: Vec<Vertex> = Vertex::all(mesh.n_vertices()).collect();
    let mut halves: Vec<Half> = edges(mesh).map(|edge| Half { edge, of: edge }).collect();
    for _ in 0..rounds {
        let finer = refine(&current)?;
        // the halves of an edge that is a part are parts too
        halves = halves.iter().flat_map(|half| parts(half, &finer.parents, current.n_vertices())).collect();
        nearest.extend(finer.parents.iter().map(|&[a, b]| nearest[a.min(b)]).collect::<Vec<_>>());
        current = finer.mesh;
    }
    halves.sort_unstable();
    Ok(Proxy { halves: Some(halves), ..with_mirror(current, plane, nearest) })
}

/// The two parts of an edge, split at its midpoint: the first of `parents` is halved by vertex `n`, and so on.
fn parts(half: &Half, parents: &[[Vertex; 2]], n: usize) -> [Half; 2] {
    let middle = Vertex::new(n + parents.partition_point(|edge| *edge < half.edge));
    half.edge.map(|end| Half { edge: sorted([end, middle]), of: half.of })
}

/// The proxy by decimation.
fn decimated(mesh: &TriangleMesh, n_vertices: usize, watch: &Watch<'_>) -> Result<Proxy, Error> {
    let decimated = decimate(mesh, None, n_vertices, watch).ok_or(Error::CancelledEarly)?;
    let points = decimated.vertices.iter().map(|&vertex| mesh.points()[vertex]).collect();
    Ok(Proxy {
        mesh: TriangleMesh::at_given_points(points, decimated.faces)?,
        nearest: decimated.vertices,
        mirror: None,
        without_image: Vec::new(),
        halves: None,
    })
}

/// The proxy made of a half and its mirror image.
fn sliced(mesh: &TriangleMesh, symmetric: SymmetricMesh) -> Proxy {
    let mut nearest = nearest_vertices(&symmetric.mesh, mesh);
    nearest[..symmetric.nearest.len()].copy_from_slice(&symmetric.nearest);
    Proxy {
        mesh: symmetric.mesh,
        nearest,
        mirror: Some(symmetric.mirror),
        without_image: Vec::new(),
        halves: None,
    }
}

/// A proxy with the mirror images of its vertices, if its triangulation is symmetric.
fn with_mirror(mesh: TriangleMesh, plane: Option<&MirrorPlane>, nearest: Vec<Vertex>) -> Proxy {
    let mirror = plane.and_then(|plane| mirror_vertices(&mesh, plane));
    let without_image = mirror.as_ref().map_or_else(Vec::new, |mirror| {
        let table = EdgeTable::new(mesh.n_vertices(), mesh.faces());
        let has_no_image = |edge: &[Vertex; 2]| table.corners(edge.map(|end| mirror[end])).next().is_none();
        let mut without_image: Vec<_> = edges(&mesh).filter(has_no_image).collect();
        without_image.sort_unstable();
        without_image
    });
    Proxy { mesh, nearest, mirror, without_image, halves: None }
}

/// The edges of a mesh, each with its lower end first.
fn edges(mesh: &TriangleMesh) -> impl Iterator<Item = [Vertex; 2]> {
    mesh.edge_corners().map(|corner| sorted(corner.half_edge(mesh.faces())))
}

fn sorted([a, b]: [Vertex; 2]) -> [Vertex; 2] {
    [a.min(b), a.max(b)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::Silent;
    use crate::seams::sample_surfaces::{
        body, greatest_distance, plate_with_three_holes, topology, torus, uneven_body,
    };
    use crate::seams::symmetry::mirror_plane;
    use crate::vector::{Vector3, coordinates};

    fn proxy_of(mesh: &TriangleMesh) -> (Proxy, MirrorPlane) {
        let plane = mirror_plane(mesh).unwrap();
        (proxy(mesh, Some(&plane), &mut Silent).unwrap(), plane)
    }

    /// Checks that the mirror maps points to their images and faces to faces.
    fn assert_symmetric(proxy: &Proxy, plane: &MirrorPlane) {
        let (points, mirror) = (proxy.mesh.points(), proxy.mirror.as_ref().unwrap());
        for vertex in Vertex::all(points.len()) {
            assert!(points[mirror[vertex]].distance(plane.image(points[vertex])) < 1e-14);
            assert_eq!(mirror[mirror[vertex]], vertex);
        }
        let cycle = |face: [Vertex; 3]| {
            let least = (0..3).min_by_key(|&k| face[k]).unwrap();
            [0, 1, 2].map(|k| face[(least + k) % 3])
        };
        let faces: std::collections::BTreeSet<_> =
            proxy.mesh.faces().iter().map(|&face| cycle(face)).collect();
        for &[a, b, c] in proxy.mesh.faces() {
            assert!(faces.contains(&cycle([a, c, b].map(|vertex| mirror[vertex]))));
        }
    }

    #[test]
    fn a_symmetric_surface_has_an_exactly_symmetric_proxy_whatever_its_triangulation() {
        for mesh in [body(5), uneven_body(5), torus()] {
            let (proxy, plane) = proxy_of(&mesh);
            assert_symmetric(&proxy, &plane);
            assert_eq!(topology(&proxy.mesh), topology(&mesh));
            assert!((TARGET - 2..=TARGET).contains(&proxy.mesh.n_vertices()));
            assert!(greatest_distance(mesh.points(), &proxy.mesh) < 0.01);
            assert!(proxy.without_image.is_empty() && proxy.halves.is_none());
            for (&point, &nearest) in proxy.mesh.points().iter().zip(&proxy.nearest) {
                assert!(point.distance(mesh.points()[nearest]) < mesh.median_edge_length());
            }
        }
    }

    #[test]
    fn without_a_plane_the_proxy_has_vertices_of_the_mesh() {
        let mesh = uneven_body(5);
        let proxy = proxy(&mesh, None, &mut Silent).unwrap();
        assert_eq!(proxy.mesh.n_vertices(), TARGET);
        assert!(proxy.mesh.points().iter().zip(&proxy.nearest).all(|(&point, &v)| point == mesh.points()[v]));
    }

    #[test]
    fn small_meshes_are_refined_and_know_their_edges() {
        // 64 vertices: every edge is quartered
        let mesh = plate_with_three_holes();
        let (proxy, plane) = proxy_of(&mesh);
        let n_edges = edges(&mesh).count();
        assert_eq!(proxy.mesh.n_faces(), 16 * mesh.n_faces());
        let halves = proxy.halves.as_ref().unwrap();
        assert_eq!(halves.len(), 4 * n_edges);
        assert!(halves.is_sorted());
        for half in halves {
            let [a, b] = half.of.map(|end| mesh.points()[end]);
            let [p, q] = half.edge.map(|end| proxy.mesh.points()[end]);
            assert!((4.0 * p.distance(q) - a.distance(b)).abs() < 1e-14);
            assert!(
                [p, q].into_iter().all(|x| (a.distance(x) + b.distance(x) - a.distance(b)).abs() < 1e-14)
            );
        }
        // the diagonals of the squares are not symmetric
        let (points, mirror) = (proxy.mesh.points(), proxy.mirror.as_ref().unwrap());
        assert!(
            Vertex::all(points.len()).all(|v| points[mirror[v]].distance(plane.image(points[v])) < 1e-12)
        );
        assert!(!proxy.without_image.is_empty());
    }

    #[test]
    fn mirrored_and_noisy_input_has_the_proxy_of_the_same_vertices() {
        for mesh in [body(4), uneven_body(5), plate_with_three_holes()] {
            let expected = proxy_of(&mesh).0;
            let noise = |k: usize| Vector3::from_fn(|axis| 1e-12 * (7.3 * k as f64 + axis as f64).sin());
            let noisy = mesh.points().iter().enumerate().map(|(k, &point)| point + noise(k));
            let mirrored = mesh.points().iter().map(|&Vector3([x, y, z])| Vector3([x, y, -z]));
            let turned: Vec<_> = mesh.faces().iter().map(|&[a, b, c]| [a, c, b]).collect();
            for (points, faces) in [(coordinates(noisy), mesh.faces()), (coordinates(mirrored), &turned)] {
                let (proxy, _) = proxy_of(&TriangleMesh::new(&points, faces).unwrap());
                assert_eq!(
                    (proxy.nearest, proxy.mirror),
                    (expected.nearest.clone(), expected.mirror.clone())
                );
                assert_eq!(
                    (proxy.halves, proxy.without_image),
                    (expected.halves.clone(), expected.without_image.clone())
                );
            }
        }
    }

    #[test]
    fn a_cancelled_proxy_is_an_error() {
        let mesh = uneven_body(6);
        let result = proxy(&mesh, None, &mut |_: f64, _: &str| false);
        // a fast machine may be done before the first question
        assert!(matches!(result, Err(Error::CancelledEarly) | Ok(_)));
    }
}
