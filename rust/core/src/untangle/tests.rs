// SPDX-License-Identifier: MIT OR Apache-2.0
use super::*;
use crate::control::Silent;
use crate::error::MapError;
use crate::mesh::Vertex;

/// A square grid of n × n vertices, one unit apart, and its places in the plane.
fn grid(n: u32) -> (TriangleMesh, Vec<[f64; 2]>) {
    let places: Vec<[f64; 2]> = (0..n * n).map(|i| [(i % n) as f64, (i / n) as f64]).collect();
    let vertices: Vec<[f64; 3]> = places.iter().map(|&[x, y]| [x, y, 0.0]).collect();
    let cells = (0..n - 1).flat_map(|row| (0..n - 1).map(move |column| row * n + column));
    let faces: Vec<[u32; 3]> = cells.flat_map(|a| [[a, a + 1, a + n + 1], [a, a + n + 1, a + n]]).collect();
    (TriangleMesh::new(&vertices, &faces).unwrap(), places)
}

fn solved(mesh: &TriangleMesh, image: &[[f64; 2]], fixed: &[usize]) -> Result<Untangled, Error> {
    let options = UntangleOptions { fixed, ..UntangleOptions::default() };
    untangled(mesh, Image::Plane(image), &options, &mut Silent)
}

fn flat(map: &Untangled) -> &[[f64; 2]] {
    crate::arrays::rows(map.image.view())
}

#[test]
fn a_map_without_folds_comes_back_bit_for_bit() {
    let (mesh, mut image) = grid(5);
    image.iter_mut().for_each(|x| *x = [0.1 * x[0] + 0.03 * x[1], 1e-7 * x[1]]);
    let map = solved(&mesh, &image, &[]).unwrap();
    assert_eq!(flat(&map), image);
    assert!(map.moved.is_empty() && map.folded_before.is_empty());
    // seen from behind
    image.iter_mut().for_each(|x| x[0] = -x[0]);
    assert_eq!(flat(&solved(&mesh, &image, &[]).unwrap()), image);
}

#[test]
fn one_vertex_that_has_left_its_star_moves_alone_and_not_farther_than_it_must() {
    let (mesh, mut image) = grid(9);
    image[4 * 9 + 4] = [7.3, 4.2];
    let map = solved(&mesh, &image, &[]).unwrap();
    assert_eq!(map.moved, [40]);
    assert_eq!(map.status, Status::Converged);
    // just inside the star's right edge, whose faces keep a hundredth of their area
    let [x, y] = flat(&map)[40];
    assert!((x - 4.99).abs() < 0.01 && (4.0..4.99).contains(&y), "{x} {y}");
}

#[test]
fn pins_and_outline_stay_and_mirrored_maps_stay_mirrored() {
    let (mesh, mut image) = grid(9);
    image[40] = [7.3, 4.2];
    image.iter_mut().for_each(|x| x[0] = -x[0]);
    let map = solved(&mesh, &image, &[40]).unwrap();
    assert_eq!(flat(&map)[40], image[40]);
    assert!(map.distortion.folded.is_empty());
    let upright: Vec<[f64; 2]> = flat(&map).iter().map(|&[x, y]| [-x, y]).collect();
    assert!(crate::distortion::folded_in_plane(mesh.faces(), &upright).is_empty());
    Vertex::all(81).filter(|&v| mesh.is_boundary(v)).for_each(|v| assert_eq!(flat(&map)[v], image[v]));
}

#[test]
fn a_shuffled_interior_is_untangled() {
    let (mesh, mut image) = grid(12);
    let interior: Vec<Vertex> = Vertex::all(144).filter(|&v| !mesh.is_boundary(v)).collect();
    let shuffled: Vec<[f64; 2]> = (0..100).map(|k| image[interior[k * 37 % 100]]).collect();
    interior.iter().zip(shuffled).for_each(|(&v, x)| image[v] = x);
    let map = solved(&mesh, &image, &[]).unwrap();
    assert!(crate::distortion::folded_in_plane(mesh.faces(), flat(&map)).is_empty());
}

#[test]
fn what_cannot_be_unfolded_is_refused_with_its_faces() {
    let (mesh, places) = grid(6);
    // the only corner of a face, drawn over its opposite edge
    let mut image = places.clone();
    image[5] = [3.5, 1.5];
    assert!(matches!(
        solved(&mesh, &image, &[]),
        Err(Error::Map(MapError::HeldFolded { .. } | MapError::OutlineFolds { .. }))
    ));
    // three pins of one face in the wrong order
    let mut image = places.clone();
    image.swap(14, 15);
    match solved(&mesh, &image, &[14, 15, 21]) {
        Err(Error::Map(MapError::HeldFolded { faces, vertices })) => {
            assert_eq!(vertices.first, [14, 15, 21]);
            assert_eq!(faces.count, 1);
        }
        other => panic!("{other:?}"),
    }
    // an outline like an eight
    let mut image = places;
    image.iter_mut().for_each(|x| x[1] = (x[1] - 2.5) * (x[0] - 2.4));
    assert!(matches!(
        solved(&mesh, &image, &[]),
        Err(Error::Map(MapError::OutlineFolds { .. } | MapError::HeldFolded { .. }))
    ));
}
