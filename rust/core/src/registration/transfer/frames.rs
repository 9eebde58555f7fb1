// SPDX-License-Identifier: MIT OR Apache-2.0
//! How the surroundings of each vertex are turned and scaled from one surface to the other: what vectors of the target,
//! such as the offsets of a shape key, go through on their way to the source.
//!
//! The deformation gradients of the faces (Sumner & Popović 2004, Deformation transfer for triangle meshes) follow every
//! wrinkle of either surface and the shear of the map, and tear long offsets apart. So they are averaged over a
//! neighborhood, by one step of heat diffusion, and the best rotation of the average counts (Kabsch), with the square
//! root of the ratio of the areas as scale.
//!
//! Cost: one sparse factorization and eleven solutions.

use crate::alignment::rotation::rotation_by_covariance;
use crate::control::{Silent, Watch};
use crate::error::Error;
use crate::mesh::TriangleMesh;
use crate::mesh::geometry::{area_vector, corner_cotangents, normalized, triangle};
use crate::parallel;
use crate::sparse::{Cholesky, Laplacian};
use crate::vector::Vector3;

/// The radius of the neighborhoods, relative to the square root of the area.
///
/// Between poses of animals and men, normals arrive 7 to 11 degrees off the source's (in the world's axes 21 to 36), and
/// a limb that is moved as a whole is strained 1.3 to 2.7 times as much as on the target; by the gradients of single
/// faces, 3 to 4 degrees off and 6 to 13 times as much.
const RADIUS: f64 = 0.05;
/// Largest and smallest scale of a neighborhood, relative to that of the whole surface.
const SCALES: [f64; 2] = [0.25, 4.0];

/// The moments of a neighborhood: Σ of the area of a face times its gradient by rows, the area of the source, and that
/// of the image.
type Moments = [f64; 11];

/// For each vertex v of the source the linear part s R of the similarity, by rows, that takes the target's surroundings
/// of g(v) nearest to those of v; `positions` (n, 3) are g.
///
/// # Errors
/// [`Error::CancelledEarly`] and errors of the factorization.
pub fn local_similarities(source: &TriangleMesh, positions: &[Vector3]) -> Result<Vec<[Vector3; 3]>, Error> {
    let (images, image_scale) = normalized(positions);
    // 1. The moments of the faces at their vertices
    let mut moments = vec![[0.0; 11]; source.n_vertices()];
    for &face in source.faces() {
        let of_face = moments_of(triangle(source.points(), face), triangle(&images, face));
        for vertex in face {
            moments[vertex].iter_mut().zip(of_face).for_each(|(sum, term)| *sum += term / 3.0);
        }
    }
    let ratio = |moments: &Moments| (moments[9] / moments[10]).sqrt();
    let whole = ratio(&moments.iter().fold([0.0; 11], |sum, next| std::array::from_fn(|k| sum[k] + next[k])));
    // 2. Their means over neighborhoods
    let moments = diffused(source, &moments)?;
    // 3. The best similarities
    let units = source.scale() / image_scale;
    Ok(parallel::map(moments.len(), |vertex| {
        let moments = &moments[vertex];
        let scale = (ratio(moments) / whole).clamp(SCALES[0], SCALES[1]) * whole;
        let scale = if scale.is_finite() { scale * units } else { units };
        rotation(moments).map(|row| row * scale)
    }))
}

/// The moments of a face of the source with a positive area, and its image.
fn moments_of(face: [Vector3; 3], image: [Vector3; 3]) -> Moments {
    let (normal, image_normal) = (area_vector(face), area_vector(image));
    let (area, image_area) = (normal.norm(), image_normal.norm());
    let gradient = gradient(face, image);
    // the surface's own direction, as long as its lengths
    let across = if image_area > 0.0 {
        image_normal * ((area * image_area).sqrt() / image_area)
    } else {
        Vector3::ZERO
    };
    let normal = normal * (1.0 / area);
    std::array::from_fn(|k| match k {
        9 => area,
        10 => image_area,
        _ => area * gradient[k / 3][k % 3] + across[k / 3] * normal[k % 3],
    })
}

/// The linear map of a triangle's plane onto another's, by rows; zero across the plane.
fn gradient([a, b, c]: [Vector3; 3], [x, y, z]: [Vector3; 3]) -> [Vector3; 3] {
    let (e, f) = (b - a, c - a);
    let normal = e.cross(f);
    let square = normal.dot(normal);
    // the dual basis of e and f in the plane
    let (along, beside) = (f.cross(normal) * (1.0 / square), normal.cross(e) * (1.0 / square));
    let (p, q) = (y - x, z - x);
    std::array::from_fn(|axis| along * p[axis] + beside * q[axis])
}

/// (M + r² L)⁻¹ of moments that are integrals over the surroundings of vertices.
fn diffused(mesh: &TriangleMesh, moments: &[Moments]) -> Result<Vec<Moments>, Error> {
    let n = mesh.n_vertices();
    let area: f64 = mesh.face_areas().iter().sum();
    let cotangents = corner_cotangents(mesh.points(), mesh.faces());
    let radius = RADIUS * RADIUS * area;
    let weights: Vec<f64> = cotangents.as_flattened().iter().map(|&weight| 0.5 * radius * weight).collect();
    let mut laplacian = Laplacian::new(mesh, |_| true);
    laplacian.assemble(mesh, &weights);
    let masses: Vec<f64> = moments.iter().map(|moments| moments[9]).collect();
    laplacian.add_to_diagonal(&masses);
    let mut factor = Cholesky::analyze_on(mesh, laplacian.matrix())?;
    let mut silent = Silent;
    factor.refactor_while(laplacian.matrix(), &Watch::new(&mut silent, 0.0, ""))?;
    let mut columns: Vec<f64> = (0..11).flat_map(|k| moments.iter().map(move |moments| moments[k])).collect();
    factor.solve(&mut columns);
    Ok(parallel::map(n, |vertex| std::array::from_fn(|k| columns[k * n + vertex])))
}

/// The rotation from the image to the source that fits moments best.
fn rotation(moments: &Moments) -> [Vector3; 3] {
    let size = moments[..9].iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    if !(size > 0.0 && size.is_finite()) {
        return [0, 1, 2].map(Vector3::unit);
    }
    // row: axis of the image, column: axis of the source
    rotation_by_covariance(std::array::from_fn(|a| std::array::from_fn(|b| moments[3 * a + b] / size)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::location::tests::octasphere;
    use crate::mesh::Vertex;

    fn mesh(points: &[Vector3], faces: &[[Vertex; 3]]) -> TriangleMesh {
        let rows: Vec<[f64; 3]> = points.iter().map(|x| x.0).collect();
        TriangleMesh::new(&rows, faces).unwrap()
    }

    fn apply(matrix: [Vector3; 3], x: Vector3) -> Vector3 {
        Vector3(matrix.map(|row| row.dot(x)))
    }

    #[test]
    fn the_gradient_takes_edges_to_edges() {
        let face = [[0.0, 0.0, 1.0], [2.0, 0.5, 1.5], [0.3, 1.0, 0.0]].map(Vector3);
        let image = [[1.0, 1.0, 1.0], [0.0, 3.0, 1.0], [2.0, 1.5, -1.0]].map(Vector3);
        let gradient = gradient(face, image);
        for k in 1..3 {
            assert!(apply(gradient, face[k] - face[0]).distance(image[k] - image[0]) < 1e-12);
        }
        assert!(apply(gradient, area_vector(face)).norm() < 1e-12);
    }

    #[test]
    fn a_similarity_is_found_everywhere() {
        let (points, faces) = octasphere(3);
        // a quarter turn about z, three times as large, elsewhere
        let images: Vec<Vector3> =
            points.iter().map(|x| Vector3([-3.0 * x[1] + 5.0, 3.0 * x[0], 3.0 * x[2]])).collect();
        for matrix in local_similarities(&mesh(&points, &faces), &images).unwrap() {
            let back = apply(matrix, Vector3([0.0, 3.0, 0.0]));
            assert!(back.distance(Vector3::unit(0)) < 1e-9, "{back:?}");
        }
    }

    #[test]
    fn each_half_of_a_bent_strip_turns_with_its_half() {
        // a strip along x, of which the part x > 5 stands up in the image and is twice as large in all directions
        let (columns, rows) = (41, 5);
        let index = |i: u32, j: u32| Vertex(i * rows + j);
        let mut faces = Vec::new();
        for (i, j) in (0..columns - 1).flat_map(|i| (0..rows - 1).map(move |j| (i, j))) {
            faces.push([index(i, j), index(i + 1, j), index(i + 1, j + 1)]);
            faces.push([index(i, j), index(i + 1, j + 1), index(i, j + 1)]);
        }
        let at = |i: u32, j: u32| Vector3([0.25 * f64::from(i), 0.25 * f64::from(j), 0.0]);
        let points: Vec<Vector3> = (0..columns * rows).map(|v| at(v / rows, v % rows)).collect();
        let bent = |x: Vector3| if x[0] <= 5.0 { x } else { Vector3([5.0, x[1], x[0] - 5.0]) };
        let images: Vec<Vector3> = points.iter().map(|&x| bent(x)).collect();
        let found = local_similarities(&mesh(&points, &faces), &images).unwrap();
        // up on the standing half, toward −x, is up (+z) on the flat strip
        let end = apply(found[index(38, 2).index()], Vector3([-1.0, 0.0, 0.0]));
        let start = apply(found[index(2, 2).index()], Vector3([0.0, 0.0, 1.0]));
        assert!(end.distance(Vector3::unit(2)) < 1e-2 && start.distance(Vector3::unit(2)) < 1e-2);
    }
}
