// SPDX-License-Identifier: MIT OR Apache-2.0
//! Surfaces that bend without stretching, laid flat face by face.
//!
//! Each face is laid beside a neighbor that lies flat already, in its true shape. If no face is stretched in the end and
//! the outline does not cross itself, nothing better can be found: flat islands keep their shapes, and islands whose
//! vertices all lie on the boundary unroll. Cost: linear in the faces.

use std::collections::VecDeque;

use super::energy::Energy;
use super::lscm::of_area_one;
use super::mend::turns_once_around_every_vertex;
use super::outline::Outline;
use super::starts::plan_view;
use crate::codomain::planar::PlanarMap;
use crate::mesh::{Corner, Face, TriangleMesh};

/// Bounds of the energy of an isometry, of the whole surface and of each face by itself. Coordinates in single precision
/// leave about a thousandth of them.
const EXACT: f64 = 1e-12;
const EXACT_FACE: f64 = 1e-10;

/// The map that stretches no face and is one-to-one, if there is one; `outline` must not cross itself.
pub(super) fn developed(energy: &Energy<'_>, outline: Option<&Outline>) -> Option<PlanarMap> {
    let is_exact = |map: &PlanarMap| {
        energy.value(map, 1.0) < EXACT
            && (0..energy.mesh.n_faces())
                .all(|face| energy.of_face(map, face, 1.0) < EXACT_FACE * energy.targets[face])
            && turns_once_around_every_vertex(energy, map)
            && outline.is_none_or(|outline| outline.is_simple(map))
    };
    // of a flat surface the plan view, in which no errors add up
    let flat = plan_view(energy).filter(is_exact);
    flat.or_else(|| Some(of_area_one(energy, unrolled(energy.mesh))).filter(is_exact))
}

/// Every vertex where the first face beside laid-out neighbors puts it.
fn unrolled(mesh: &TriangleMesh) -> PlanarMap {
    let mut place: Vec<Option<[f64; 2]>> = vec![None; mesh.n_vertices()];
    let mut is_laid_out = vec![false; mesh.n_faces()];
    // 1. The first face, by its first edge
    let [first, second, _] = mesh.faces()[Face::new(0)];
    place[first] = Some([0.0; 2]);
    place[second] = Some([mesh.points()[first].distance(mesh.points()[second]), 0.0]);
    let mut queue = VecDeque::from([Face::new(0).corner(2)]);
    is_laid_out[Face::new(0)] = true;
    // 2. Its neighbors, by the edges that they share
    while let Some(apex) = queue.pop_front() {
        let ends = [apex.next(), apex.previous()].map(|corner| corner.vertex(mesh.faces()));
        let vertex = apex.vertex(mesh.faces());
        if place[vertex].is_none() {
            place[vertex] = third_corner(mesh, apex, ends.map(|end| place[end].unwrap_or_default()));
        }
        for across in apex.face().corners().into_iter().filter_map(|corner| mesh.opposite(corner)) {
            if !is_laid_out[across.face()] {
                is_laid_out[across.face()] = true;
                queue.push_back(across);
            }
        }
    }
    place.into_iter().map(Option::unwrap_or_default).collect()
}

/// The place of a corner of a face whose other two lie at `from` and `to`, in the order of the face.
fn third_corner(mesh: &TriangleMesh, apex: Corner, [from, to]: [[f64; 2]; 2]) -> Option<[f64; 2]> {
    let point = |corner: Corner| mesh.points()[corner.vertex(mesh.faces())];
    let (base, side) = (point(apex.previous()) - point(apex.next()), point(apex) - point(apex.next()));
    let square = base.dot(base);
    let (along, beside) = (base.dot(side) / square, base.cross(side).norm() / square);
    let [x, y] = [to[0] - from[0], to[1] - from[1]];
    Some([from[0] + along * x - beside * y, from[1] + along * y + beside * x])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folded_strip_unrolls_to_its_true_shape() {
        // unit squares around three sides of a box
        let points = [
            [0., 0., 1.],
            [0., 1., 1.],
            [0., 0., 0.],
            [0., 1., 0.],
            [1., 0., 0.],
            [1., 1., 0.],
            [1., 0., 1.],
            [1., 1., 1.],
        ];
        let faces = [[0u32, 2, 3], [0, 3, 1], [2, 4, 5], [2, 5, 3], [4, 6, 7], [4, 7, 5]];
        let mesh = TriangleMesh::new(&points, &faces).unwrap();
        let energy = Energy::new(&mesh, mesh.face_areas());
        let map = developed(&energy, Some(&Outline::new(&energy))).unwrap();
        let length = |a: usize, b: usize| (map[a][0] - map[b][0]).hypot(map[a][1] - map[b][1]);
        assert!((length(0, 6) / length(0, 1) - 3.0).abs() < 1e-14);
    }

    #[test]
    fn what_must_stretch_or_overlaps_has_no_development() {
        let pyramid = [[0., 0., 1.], [1., 0., 0.], [0., 1., 0.], [-1., 0., 0.], [0., -1., 0.]];
        let mesh = TriangleMesh::new(&pyramid, &[[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]]).unwrap();
        assert_eq!(developed(&Energy::new(&mesh, mesh.face_areas()), None), None);
        // a fan of a turn and a half around a vertex, all of whose vertices lie on the boundary
        let n = 18;
        let mut points = vec![[0., 0., 0.]];
        points.extend((0..=n).map(|k| {
            let angle = 3.0 * std::f64::consts::PI * f64::from(k) / f64::from(n);
            [angle.cos(), angle.sin(), 0.02 * angle]
        }));
        let faces: Vec<[u32; 3]> = (1..=n).map(|k| [0, k, k + 1]).collect();
        let mesh = TriangleMesh::new(&points, &faces).unwrap();
        let energy = Energy::new(&mesh, mesh.face_areas());
        assert!(developed(&energy, None).is_some(), "it overlaps only");
        assert_eq!(developed(&energy, Some(&Outline::new(&energy))), None);
    }
}
