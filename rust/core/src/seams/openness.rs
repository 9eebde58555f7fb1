// SPDX-License-Identifier: MIT OR Apache-2.0
//! Openness: the share of the light of an even sky that reaches a vertex of a surface.
//!
//! The mean of the cosine over the directions of the hemisphere above the vertex in which nothing blocks the view: 1 on
//! a convex surface, 0 deep inside. The directions are the 50 points of Lebedev's rule of degree 11, which the symmetries
//! of the cube map onto themselves, so that a surface mirrored along an axis is as open as before.
//!
//! Input: one component. Cost: 25 rays a vertex.

use crate::location::Obstacles;
use crate::mesh::geometry::{area_vector, triangle};
use crate::mesh::{TriangleMesh, Vertex};
use crate::parallel;
use crate::vector::Vector3;

/// The weights of Lebedev's rule (1976): of the directions to the faces of a cube, to its edges, to its corners, and of
/// those along (1, 1, 3).
const WEIGHTS: [f64; 4] =
    [0.012_698_412_698_412_698, 0.022_574_955_908_289_243, 0.021_093_75, 0.020_173_335_537_918_87];

/// The least cosine to the normal: rays below would meet the faces of the vertex itself.
const LEAST_COSINE: f64 = 0.05;

/// The distance from the surface at which rays begin.
const LIFT: f64 = 1e-4;

/// The openness of every vertex (n,), between 0 and 1; alike at both vertices of each pair of `mirror` images.
pub(super) fn openness(mesh: &TriangleMesh, mirror: Option<&[Vertex]>) -> Vec<f64> {
    let obstacles = Obstacles::new(mesh.points(), mesh.faces());
    let (normals, sky) = (vertex_normals(mesh), directions());
    let open = parallel::map(mesh.n_vertices(), |v| {
        let (point, normal) = (mesh.points()[v], normals[v]);
        let eye = point + normal * LIFT;
        let (mut free, mut total) = (0.0, 0.0);
        for &(direction, weight) in &sky {
            let cosine = normal.dot(direction);
            if cosine > LEAST_COSINE {
                total += weight * cosine;
                free += if obstacles.block(eye, direction) { 0.0 } else { weight * cosine };
            }
        }
        // no direction is above a normal that does not exist
        if total > 0.0 { free / total } else { 1.0 }
    });
    match mirror {
        Some(mirror) => Vertex::all(open.len()).map(|v| 0.5 * (open[v] + open[mirror[v]])).collect(),
        None => open,
    }
}

/// The unit normals of the vertices: the mean of those of their faces, by area.
fn vertex_normals(mesh: &TriangleMesh) -> Vec<Vector3> {
    let mut normals = vec![Vector3::ZERO; mesh.n_vertices()];
    for &face in mesh.faces() {
        let normal = area_vector(triangle(mesh.points(), face));
        face.into_iter().for_each(|vertex| normals[vertex] += normal);
    }
    normals.into_iter().map(Vector3::normalized).collect()
}

/// The directions of Lebedev's rule of 50 points with their weights.
fn directions() -> Vec<(Vector3, f64)> {
    let signs = [-1.0, 0.0, 1.0];
    let grid = signs
        .into_iter()
        .flat_map(|x| signs.into_iter().flat_map(move |y| signs.map(|z| Vector3([x, y, z]))));
    let mut rule = Vec::new();
    for direction in grid {
        let n_axes = direction.0.iter().filter(|x| **x != 0.0).count();
        if n_axes > 0 {
            rule.push((direction.normalized(), WEIGHTS[n_axes - 1]));
        }
        if n_axes == 3 {
            let stretched =
                |axis: usize| Vector3::from_fn(|k| if k == axis { 3.0 } else { 1.0 } * direction[k]);
            (0..3).for_each(|axis| rule.push((stretched(axis).normalized(), WEIGHTS[3])));
        }
    }
    rule
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seams::sample_surfaces::{body, cup, sphere};
    use crate::seams::symmetry::{mirror_plane, mirror_vertices};

    #[test]
    fn a_sphere_is_open_and_the_bottom_of_a_cup_is_not() {
        assert_eq!(openness(&sphere(4), None), vec![1.0; sphere(4).n_vertices()]);
        let inside = openness(&cup(), None);
        // a disk of the angular radius α above: sin² α of the light, here 1/37
        assert!(inside[..40].iter().all(|&open| open < 0.1), "{:?}", &inside[..40]);
        let outside = openness(&cup().turned_over(), None);
        assert!(outside.iter().all(|&open| open > 0.95));
    }

    #[test]
    fn half_of_the_sky_is_hidden_beside_a_wall() {
        // a floor and a wall that meet at a right angle, far away in all other directions
        let n = 40;
        let place = |k: usize| [(k % n) as f64 - 20.0, (k / n) as f64 - 20.0];
        let points: Vec<[f64; 3]> =
            (0..n * n).map(place).map(|[x, y]| [x.max(0.0), y, (-x).max(0.0)]).collect();
        let quads = (0..n - 1).flat_map(|j| (0..n - 1).map(move |i| (j * n + i) as u32));
        let faces: Vec<[u32; 3]> = quads.flat_map(|a| [[a, a + 1, a + 41], [a, a + 41, a + 40]]).collect();
        let mesh = TriangleMesh::new(&points, &faces).unwrap();
        let beside = openness(&mesh, None)[20 * n + 21];
        assert!((beside - 0.5).abs() < 0.1, "{beside}");
    }

    #[test]
    fn mirror_images_are_as_open() {
        let mesh = body(4);
        let mirror = mirror_vertices(&mesh, &mirror_plane(&mesh).unwrap()).unwrap();
        let open = openness(&mesh, Some(&mirror));
        assert!(Vertex::all(open.len()).all(|vertex| open[vertex] == open[mirror[vertex]]));
        // the ears hide a part of the sky
        let least = open.iter().fold(1.0, |least, &open| f64::min(least, open));
        assert!((0.5..0.97).contains(&least), "{least}");
    }

    #[test]
    fn the_directions_integrate_polynomials_up_to_degree_eleven() {
        let mean =
            |f: &dyn Fn(Vector3) -> f64| directions().iter().map(|&(x, weight)| weight * f(x)).sum::<f64>();
        assert_eq!(directions().len(), 50);
        // the mean of xᵃ yᵇ zᶜ for even exponents: (a − 1)!! (b − 1)!! (c − 1)!! / (a + b + c + 1)!!
        for (value, expected) in [
            (mean(&|_| 1.0), 1.0),
            (mean(&|x| x[0].powi(10)), 1.0 / 11.0),
            (mean(&|x| x[0].powi(4) * x[1].powi(2) * x[2].powi(4)), 9.0 / 10395.0),
            (mean(&|x| x[0].powi(2) * x[1].powi(2) * x[2].powi(2)), 1.0 / 105.0),
            (mean(&|x| x[0].powi(11) + x[0].powi(3) * x[1].powi(7)), 0.0),
        ] {
            assert!((value - expected).abs() < 1e-14, "{value} {expected}");
        }
    }
}
