// SPDX-License-Identifier: MIT OR Apache-2.0
//! Spheres for the tests.

use std::collections::BTreeMap;

use crate::mesh::Vertex;
use crate::vector::Vector3;

/// An icosahedron in general position, with every face split in four `level` times on the unit sphere.
pub(super) fn turned_ball(level: usize) -> (Vec<Vector3>, Vec<[Vertex; 3]>) {
    let golden = 0.5 + 1.25f64.sqrt();
    let quarters = [[1.0, golden], [-1.0, golden], [1.0, -golden], [-1.0, -golden]];
    let mut points: Vec<Vector3> = (0..3)
        .flat_map(|axis| quarters.map(|[a, b]| Vector3::unit(axis) * a + Vector3::unit((axis + 1) % 3) * b))
        .map(Vector3::normalized)
        .collect();
    let mut faces = faces_of_icosahedron(&points);
    for _ in 0..level {
        faces = split_in_four(&mut points, &faces);
    }
    (points.into_iter().map(turned).collect(), faces)
}

/// Random triangles of the sphere, of sides 10⁻⁴, away from the planes of the axes.
pub(super) fn small_triangles() -> impl Iterator<Item = [Vector3; 3]> {
    let bases = (0..3000).map(|k| {
        let t = f64::from(k);
        Vector3([(1.3 * t).sin(), (2.1 * t).cos(), (0.7 * t).sin()]).normalized()
    });
    bases.filter(|base| base.0.iter().all(|x| x.abs() > 0.01)).map(|base| {
        let across = base.cross(Vector3([0.3, -0.2, 0.9])).normalized();
        [across, base.cross(across), -across].map(|side| (base + side * 1e-4).normalized())
    })
}

/// The triangles whose sides have the least length, counter-clockwise seen from outside.
fn faces_of_icosahedron(points: &[Vector3]) -> Vec<[Vertex; 3]> {
    let is_side = |a: usize, b: usize| points[a].distance(points[b]) < 1.1;
    let mut faces = Vec::new();
    for a in 0..points.len() {
        for b in (a + 1..points.len()).filter(|&b| is_side(a, b)) {
            for c in (b + 1..points.len()).filter(|&c| is_side(a, c) && is_side(b, c)) {
                let is_outward = points[a].cross(points[b]).dot(points[c]) > 0.0;
                faces.push((if is_outward { [a, b, c] } else { [a, c, b] }).map(Vertex::new));
            }
        }
    }
    faces
}

fn split_in_four(points: &mut Vec<Vector3>, faces: &[[Vertex; 3]]) -> Vec<[Vertex; 3]> {
    let mut middles: BTreeMap<[Vertex; 2], Vertex> = BTreeMap::new();
    let mut middle = |a: Vertex, b: Vertex| {
        *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
            points.push((points[a] + points[b]).normalized());
            Vertex::new(points.len() - 1)
        })
    };
    let mut split = Vec::new();
    for &[a, b, c] in faces {
        let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
        split.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    split
}

fn turned(Vector3([x, y, z]): Vector3) -> Vector3 {
    let ([sine, cosine], [s, c]) = ([0.4f64.sin(), 0.4f64.cos()], [1.1f64.sin(), 1.1f64.cos()]);
    let [y, z] = [cosine * y - sine * z, sine * y + cosine * z];
    Vector3([c * x - s * y, s * x + c * y, z])
}
