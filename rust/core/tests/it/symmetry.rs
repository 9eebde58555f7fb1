// SPDX-License-Identifier: MIT OR Apache-2.0
//! Symmetric input leaves choices open, which noise must not make: they go to the lowest index.

use std::f64::consts::TAU;

use authalic::{
    Boundary, CloseHandles, CloseHoles, DiskMapOptions, Keep, MetricMethod, PackOptions, PlanarIsland,
    RepairOptions, Rotation, Silent, Surface, Vertex, disk_map, hyperbolic_structure, pack, repair,
};
use ndarray::aview2;

use crate::common::closed::parallels;
use crate::common::random::Random;
use crate::common::{self, TestMesh, compacted};

/// The mesh as it is, and moved by noise five times.
fn draws(mesh: &TestMesh) -> Vec<Vec<[f64; 3]>> {
    let mut random = Random::new(5);
    let mut noisy =
        || mesh.vertices.iter().map(|x| x.map(|c| c + 1e-12 * random.between(-1.0, 1.0))).collect();
    let mut all = vec![mesh.vertices.clone()];
    all.extend((0..5).map(|_| noisy()));
    all
}

/// Asserts that all are equal.
fn assert_alike<T: PartialEq + std::fmt::Debug>(results: impl IntoIterator<Item = T>) {
    let mut results = results.into_iter();
    let first = results.next().expect("there are some");
    results.enumerate().for_each(|(draw, result)| assert_eq!(result, first, "draw {draw}"));
}

/// Asserts that all are nearly equal.
fn assert_near<const N: usize>(results: &[Vec<[f64; N]>]) {
    for (draw, result) in results.iter().enumerate() {
        let pairs = result.as_flattened().iter().zip(results[0].as_flattened());
        let apart = pairs.map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
        assert!(apart < 1e-6 && result.len() == results[0].len(), "draw {draw}: {apart}");
    }
}

/// A tube of `around` by `along` cells.
fn tube(around: u32, along: u32) -> TestMesh {
    let mut mesh = common::annulus(around, along);
    for (k, vertex) in mesh.vertices.iter_mut().enumerate() {
        let radius = vertex[0].hypot(vertex[1]);
        *vertex = [vertex[0] / radius, vertex[1] / radius, 0.2 * (k as u32 % (along + 1)) as f64];
    }
    mesh
}

#[test]
fn the_first_of_boundary_loops_of_one_length_is_that_of_the_lowest_vertex() {
    for tube in [tube(12, 7), tube(9, 4)] {
        let loops = |vertices: Vec<[f64; 3]>| {
            let surface = Surface::new(aview2(&vertices), aview2(&tube.faces)).unwrap();
            surface.topology().unwrap().boundary_loops.clone()
        };
        let all: Vec<_> = draws(&tube).into_iter().map(loops).collect();
        assert_eq!(all[0][0][0], Vertex(0));
        assert_alike(all);
    }
}

#[test]
fn the_corners_of_a_disk_without_corners_do_not_depend_on_noise() {
    let cap = common::cap(6, 0.8);
    let options = DiskMapOptions { boundary: Boundary::Rectangle, angle_weight: 1.0, ..Default::default() };
    let map = |vertices: Vec<[f64; 3]>| {
        let surface = Surface::new(aview2(&vertices), aview2(&cap.faces)).unwrap();
        let map = disk_map(&surface, &options, &mut Silent).unwrap();
        map.uv.rows().into_iter().map(|x| [x[0], x[1]]).collect()
    };
    assert_near(&draws(&cap).into_iter().map(map).collect::<Vec<Vec<[f64; 2]>>>());
}

#[test]
fn of_pieces_of_one_area_the_first_is_kept() {
    let ball = common::icosphere(1);
    let n = ball.vertices.len();
    let moved = ball.vertices.iter().map(|&[x, y, z]| [x + 3.0, y, z]);
    let vertices = ball.vertices.iter().copied().chain(moved).collect();
    let faces = ball.faces.iter().copied().chain(ball.faces.iter().map(|face| face.map(|v| v + n as u32)));
    let two = TestMesh { vertices, faces: faces.collect(), ..common::icosphere(1) };
    let options = RepairOptions { keep: Keep::Largest, ..Default::default() };
    for vertices in draws(&two) {
        let kept = repair(aview2(&vertices), aview2(&two.faces), &options).unwrap();
        let given: Vec<usize> = kept.vertex_of.iter().map(|vertex| vertex.unwrap().index()).collect();
        assert_eq!(given, (0..n).collect::<Vec<_>>());
    }
}

#[test]
fn of_symmetric_loops_around_a_handle_noise_chooses_none() {
    let torus = common::torus(20, 8);
    let options = RepairOptions { close_handles: CloseHandles::All, ..Default::default() };
    let faces = |vertices: Vec<[f64; 3]>| {
        let closed = repair(aview2(&vertices), aview2(&torus.faces), &options).unwrap();
        (closed.counts.closed_handles, closed.surface.faces().to_owned())
    };
    let all: Vec<_> = draws(&torus).into_iter().map(faces).collect();
    assert_eq!(all[0].0, 1);
    assert_alike(all);
}

#[test]
fn noise_does_not_choose_the_order_in_which_holes_of_one_size_are_closed() {
    let tube = tube(12, 7);
    let options = RepairOptions { close_holes: CloseHoles::All, ..Default::default() };
    let faces = |vertices: Vec<[f64; 3]>| {
        repair(aview2(&vertices), aview2(&tube.faces), &options).unwrap().surface.faces().to_owned()
    };
    assert_alike(draws(&tube).into_iter().map(faces));
}

#[test]
fn the_structure_between_symmetric_holes_does_not_depend_on_noise() {
    let ball = parallels(12, 24);
    let is_in_hole = |face: &[u32; 3]| {
        let middle = [0, 1, 2].map(|k| face.iter().map(|&v| ball.vertices[v as usize][k]).sum::<f64>() / 3.0);
        (0..4).any(|k| {
            let angle = TAU * f64::from(k) / 4.0;
            middle[0] * angle.cos() + middle[1] * angle.sin() > 0.93
        })
    };
    let kept: Vec<[u32; 3]> = ball.faces.iter().copied().filter(|face| !is_in_hole(face)).collect();
    let (vertices, faces) = compacted(&ball.vertices, &kept);
    let holed = TestMesh { vertices, faces, ..parallels(12, 24) };
    let structure = |vertices: Vec<[f64; 3]>| {
        let surface = Surface::new(aview2(&vertices), aview2(&holed.faces)).unwrap();
        hyperbolic_structure(&surface, &[], MetricMethod::Newton, &mut Silent).unwrap()
    };
    let all: Vec<_> = draws(&holed).into_iter().map(structure).collect();
    assert_eq!(all[0].chain.len(), 4);
    assert_alike(all.iter().map(|structure| (&structure.chain, &structure.disk_vertex_of)));
    let positions = all.iter().map(|structure| structure.positions());
    let rows = positions.map(|places| places.rows().into_iter().map(|x| [x[0], x[1]]).collect());
    assert_near(&rows.collect::<Vec<Vec<[f64; 2]>>>());
    assert_alike(
        all.iter().map(|structure| structure.cover(30).into_iter().map(|copy| copy.word).collect::<Vec<_>>()),
    );
}

#[test]
fn noise_does_not_choose_the_places_of_equal_islands() {
    let faces = [[0, 1, 2].map(Vertex), [0, 2, 3].map(Vertex)];
    for (n, rotation) in [5, 40, 100, 1200]
        .into_iter()
        .flat_map(|n| [Rotation::Fixed, Rotation::Cardinal, Rotation::Free].map(|rotation| (n, rotation)))
    {
        let mut random = Random::new(n);
        let mut places = |noise: f64| -> Vec<[f64; 3]> {
            let mut square = || {
                [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
                    .map(|corner: [f64; 2]| corner.map(|x| x + noise * random.between(-1.0, 1.0)))
            };
            let squares: Vec<[[f64; 2]; 4]> = (0..n).map(|_| square()).collect();
            let islands: Vec<PlanarIsland<'_>> =
                squares.iter().map(|points| PlanarIsland { points, faces: &faces }).collect();
            let options = PackOptions { rotation, ..Default::default() };
            let packing = pack(&islands, &options, &mut Silent).unwrap();
            packing.places.iter().map(|place| [place.angle, place.offset[0], place.offset[1]]).collect()
        };
        let draws = if n > 1000 { 2 } else { 4 };
        assert_near(&(0..draws).map(|draw| places(if draw == 0 { 0.0 } else { 1e-12 })).collect::<Vec<_>>());
    }
}
