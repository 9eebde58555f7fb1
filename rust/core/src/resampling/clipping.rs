// SPDX-License-Identifier: MIT OR Apache-2.0
//! The areas of overlaps between a face on the sphere and the faces of an icosphere, by clipping.
//!
//! A polygon of arcs of great circles is cut by the plane through an edge of the icosphere and the origin: its corners
//! stay on one side, and where an edge crosses the plane there is a corner of both parts (Sutherland & Hodgman 1974).
//! The face is cut by the icosahedron first, then by the edges between the four parts of each face, level by level. A
//! cut leaves two parts that fill the whole, so the areas add up to that of the face up to rounding.
//!
//! Cost: the number of overlaps times the levels.

use super::coverage::Overlap;
use super::icosphere::Icosphere;
use crate::mesh::Vertex;
use crate::mesh::geometry::triangle;
use crate::vector::Vector3;

/// A convex polygon on the sphere, counter-clockwise seen from outside.
type Polygon = Vec<Vector3>;

/// The overlaps of the positive face with corners `points` on the unit sphere.
pub(super) fn overlaps(icosphere: &Icosphere, points: [Vector3; 3], out: &mut Vec<Overlap>) {
    for (root, &face) in icosphere.levels[0].iter().enumerate() {
        let corners = triangle(&icosphere.points, face);
        let mut inside = points.to_vec();
        for k in 0..3 {
            inside = cut(&inside, corners[k].cross(corners[(k + 1) % 3])).0;
        }
        descend(icosphere, (0, root), inside, out);
    }
}

/// The overlaps of what lies inside one face of a level.
fn descend(icosphere: &Icosphere, (level, face): (usize, usize), polygon: Polygon, out: &mut Vec<Overlap>) {
    if polygon.len() < 3 {
        return;
    }
    let Some(finer) = icosphere.levels.get(level + 1) else {
        let area = area(&polygon);
        if area != 0.0 {
            out.push(Overlap { cell: face, area });
        }
        return;
    };
    // the edges of the part in the middle cut off the others, the first behind that from ca to ab
    let [ab, bc, ca] = triangle(&icosphere.points, middle(finer, face));
    let mut rest = polygon;
    for (part, [from, to]) in [[ca, ab], [ab, bc], [bc, ca]].into_iter().enumerate() {
        let (inside, outside) = cut(&rest, from.cross(to));
        descend(icosphere, (level + 1, 4 * face + part), outside, out);
        rest = inside;
    }
    descend(icosphere, (level + 1, 4 * face + 3), rest, out);
}

/// The part in the middle of a face.
fn middle(finer: &[[Vertex; 3]], face: usize) -> [Vertex; 3] {
    finer[4 * face + 3]
}

/// The parts of a polygon on the positive and on the negative side of a plane through the origin.
fn cut(polygon: &[Vector3], normal: Vector3) -> (Polygon, Polygon) {
    let heights: Vec<f64> = polygon.iter().map(|corner| normal.dot(*corner)).collect();
    if heights.iter().all(|&height| height >= 0.0) {
        return (polygon.to_vec(), Vec::new());
    }
    if heights.iter().all(|&height| height <= 0.0) {
        return (Vec::new(), polygon.to_vec());
    }
    let (mut above, mut below) = (Vec::new(), Vec::new());
    for (k, &corner) in polygon.iter().enumerate() {
        let next = (k + 1) % polygon.len();
        let (height, height_of_next) = (heights[k], heights[next]);
        if height >= 0.0 {
            above.push(corner);
        }
        if height <= 0.0 {
            below.push(corner);
        }
        if height * height_of_next < 0.0 {
            let t = height / (height - height_of_next);
            let crossing = (corner * (1.0 - t) + polygon[next] * t).normalized();
            above.push(crossing);
            below.push(crossing);
        }
    }
    (above, below)
}

/// The area of a polygon, as that of the triangles at its first corner (van Oosterom & Strackee 1983).
fn area(polygon: &[Vector3]) -> f64 {
    let [first, rest @ ..] = polygon else { return 0.0 };
    rest.windows(2).map(|pair| spherical_area([*first, pair[0], pair[1]])).sum()
}

/// The area of a triangle on the unit sphere, positive where it is counter-clockwise seen from outside.
pub(super) fn spherical_area([a, b, c]: [Vector3; 3]) -> f64 {
    // differences keep the digits of small triangles
    let volume = a.dot((b - a).cross(c - a));
    2.0 * volume.atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::location::tests::{number, octasphere};

    #[test]
    fn the_overlaps_of_a_face_add_up_to_its_area_and_those_of_a_cell_to_its() {
        for (level, turn) in [(0, 0.0), (2, 0.3), (4, 1.0)] {
            let icosphere = Icosphere::new(level).unwrap();
            let (points, faces) = octasphere(2);
            let (sin, cos) = f64::sin_cos(turn);
            let points: Vec<Vector3> = points
                .iter()
                .map(|&Vector3([x, y, z])| Vector3([cos * x - sin * z, y, sin * x + cos * z]))
                .collect();
            let mut cells = vec![0.0; icosphere.finest().len()];
            for &face in &faces {
                let mut found = Vec::new();
                overlaps(&icosphere, triangle(&points, face), &mut found);
                let sum: f64 = found.iter().map(|overlap| overlap.area).sum();
                assert!((sum - spherical_area(triangle(&points, face))).abs() < 1e-14);
                assert!(found.iter().all(|overlap| overlap.area > -1e-15));
                found.iter().for_each(|overlap| cells[overlap.cell] += overlap.area);
            }
            for (cell, &face) in icosphere.finest().iter().enumerate() {
                assert!((cells[cell] - spherical_area(triangle(&icosphere.points, face))).abs() < 1e-13);
            }
        }
    }

    #[test]
    fn an_octant_has_an_eighth_of_the_sphere() {
        let octant = [0, 1, 2].map(Vector3::unit);
        assert!((spherical_area(octant) - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
        let tiny = [0.0, 1e-8 * number(3).abs(), 0.0].map(|x| Vector3([1.0, x, 0.0]));
        assert_eq!(spherical_area(tiny), 0.0);
    }
}
