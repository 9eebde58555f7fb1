// SPDX-License-Identifier: MIT OR Apache-2.0
//! Disk maps by their properties, on every test mesh that is a disk.

use crate::common::cancelling::cancelled_everywhere;
use crate::common::public::{disk_map, planar};
use authalic::testing::{TriangleMesh, doubled_area, folded_in_plane};
use authalic::{Boundary, DiskMap, DiskMapOptions, DiskMethod, Error, MapError, MeshError, Silent, Vertex};
use ndarray::{aview1, aview2};
use std::f64::consts::TAU;

use crate::common;
use proptest::prelude::*;

const METHODS: [DiskMethod; 3] =
    [DiskMethod::FixedPoint, DiskMethod::ConjugateGradient, DiskMethod::GaussNewton];
const BOUNDARIES: [Boundary; 2] = [Boundary::ArcLength, Boundary::Sliding];

fn mapped(mesh: &TriangleMesh, options: DiskMapOptions<'_>) -> DiskMap {
    disk_map(mesh, &options, &mut Silent).expect("a disk has a map")
}

/// A bijection onto a convex polygon in the unit disk: no fold, boundary on the circle, once around.
fn assert_bijective(mesh: &TriangleMesh, map: &DiskMap) {
    assert!(map.distortion.folded.is_empty());
    assert!(folded_in_plane(mesh.faces(), planar(&map.uv)).is_empty());
    assert!(planar(&map.uv).iter().all(|uv| uv[0].hypot(uv[1]) <= 1.0 + 1e-12));
    let boundary = &mesh.boundary_loops()[0];
    let angle = |k: usize| {
        let uv = planar(&map.uv)[boundary[k % boundary.len()]];
        assert!((uv[0].hypot(uv[1]) - 1.0).abs() < 1e-12);
        uv[1].atan2(uv[0])
    };
    let arcs: Vec<f64> = (0..boundary.len()).map(|k| (angle(k + 1) - angle(k)).rem_euclid(TAU)).collect();
    let in_order = |arc: f64| arc > 0.0 && arc < TAU / 2.0 + 1e-9;
    assert!(arcs.iter().all(|&arc| in_order(arc) || boundary.len() == 3), "{arcs:?}");
    assert!((arcs.iter().sum::<f64>() - TAU).abs() < 1e-9);
}

#[test]
fn every_disk_is_mapped_one_to_one_by_every_method() {
    for disk in common::disks() {
        let mesh = disk.mesh();
        for method in METHODS {
            for boundary in BOUNDARIES {
                let map = mapped(&mesh, DiskMapOptions { method, boundary, ..Default::default() });
                assert_bijective(&mesh, &map);
                let energies: Vec<f64> =
                    map.history.records().iter().map(|record| record.authalic_energy).collect();
                assert!(
                    map.distortion.authalic_energy <= energies[0] * (1.0 + 1e-9) + 1e-12,
                    "{method:?} {boundary:?}"
                );
            }
        }
    }
}

#[test]
fn conjugate_gradients_beat_the_fixed_point_and_a_sliding_boundary_a_held_one() {
    let mesh = common::bumpy_disk(20).mesh();
    let energy = |method, boundary| {
        mapped(&mesh, DiskMapOptions { method, boundary, ..Default::default() }).distortion.authalic_energy
    };
    let held = energy(DiskMethod::ConjugateGradient, Boundary::ArcLength);
    assert!(held < energy(DiskMethod::FixedPoint, Boundary::ArcLength));
    assert!(energy(DiskMethod::ConjugateGradient, Boundary::Sliding) < held);
}

#[test]
fn arcs_are_proportional_to_boundary_lengths() {
    let mesh = common::bumpy_disk(8).mesh();
    let map = mapped(&mesh, DiskMapOptions { boundary: Boundary::ArcLength, ..Default::default() });
    let boundary = &mesh.boundary_loops()[0];
    let pair = |k: usize| [boundary[k].index(), (boundary[(k + 1) % boundary.len()]).index()];
    let length = |k: usize| pair(k).map(|v| mesh.points()[v]);
    let lengths: Vec<f64> =
        (0..boundary.len()).map(|k| common::distance(length(k)[0], length(k)[1])).collect();
    let total: f64 = lengths.iter().sum();
    for (k, length) in lengths.iter().enumerate() {
        let [a, b] = pair(k).map(|v| planar(&map.uv)[v]);
        let arc = 2.0 * (0.5 * (a[0] - b[0]).hypot(a[1] - b[1])).asin();
        assert!((arc - TAU * length / total).abs() < 1e-12);
    }
}

#[test]
fn the_same_bits_for_any_number_of_threads() {
    let mesh = common::bumpy_disk(30).mesh();
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let run = |method| mapped(&mesh, DiskMapOptions { method, ..Default::default() }).uv;
        pool.install(|| METHODS.map(run))
    };
    let one = on(1);
    assert_eq!(one, on(2));
    assert_eq!(one, on(5));
}

#[test]
fn a_density_is_honoured() {
    let mesh = common::bumpy_disk(16).mesh();
    let density: Vec<f64> =
        mesh.faces().iter().map(|face| if mesh.points()[face[0]][0] > 0.0 { 3.0 } else { 1.0 }).collect();
    let map = mapped(&mesh, DiskMapOptions { density: Some(aview1(&density)), ..Default::default() });
    assert!(map.distortion.area_ratio_std < 0.05);
    let area = |value: f64| -> f64 {
        let part = mesh.faces().iter().zip(&density).filter(|(_, density)| **density == value);
        part.map(|(face, _)| 0.5 * doubled_area(face.map(|v| planar(&map.uv)[v]))).sum()
    };
    let count = |value: f64| density.iter().filter(|density| **density == value).count() as f64;
    let ratio = (area(3.0) / count(3.0)) / (area(1.0) / count(1.0));
    assert!((ratio - 3.0).abs() < 0.03, "{ratio}");
}

#[test]
fn holes_are_refused_or_filled() {
    for mesh in [common::annulus(24, 6).mesh(), common::holed_grid().mesh()] {
        let refused = disk_map(&mesh, &DiskMapOptions::default(), &mut Silent);
        assert!(matches!(refused, Err(Error::Mesh(MeshError::SeveralBoundaries { .. }))));
        let map = mapped(&mesh, DiskMapOptions { fill_holes: true, ..Default::default() });
        assert_eq!(map.uv.nrows(), mesh.n_vertices());
        assert!(folded_in_plane(mesh.faces(), planar(&map.uv)).is_empty());
        assert!(map.distortion.area_ratio_std < 0.1, "{}", map.distortion.area_ratio_std);
    }
}

#[test]
fn a_hole_without_area_is_filled_too() {
    // two squares joined by a slit of coinciding banks
    let slit = [
        [0., 0., 0.],
        [3., 0., 0.],
        [3., 3., 0.],
        [0., 3., 0.],
        [1., 1.5, 0.],
        [1.5, 1.5, 0.],
        [2., 1.5, 0.],
        [1.5, 1.5, 0.],
    ];
    let faces = [[0, 1, 5], [0, 5, 4], [1, 6, 5], [1, 2, 6], [2, 7, 6], [2, 3, 7], [3, 4, 7], [3, 0, 4]];
    let mesh = TriangleMesh::new(&slit, &faces).unwrap();
    assert_eq!(mesh.boundary_loops().len(), 2);
    let map = mapped(&mesh, DiskMapOptions { fill_holes: true, ..Default::default() });
    assert!(map.distortion.folded.is_empty());
}

#[test]
fn a_start_map_is_improved_and_a_folded_one_unfolded() {
    let mesh = common::bumpy_disk(10).mesh();
    let options =
        DiskMapOptions { max_iterations: Some(5), method: DiskMethod::FixedPoint, ..Default::default() };
    let first = mapped(&mesh, options);
    let mut folded = planar(&first.uv).to_vec();
    (0..folded.len()).filter(|&v| !mesh.is_boundary(Vertex::new(v))).for_each(|v| folded[v] = [0.0, 0.0]);
    for method in METHODS {
        let further =
            mapped(&mesh, DiskMapOptions { initial: Some(first.uv.view()), method, ..Default::default() });
        assert!(further.distortion.authalic_energy < first.distortion.authalic_energy, "{method:?}");
        let unfolded =
            mapped(&mesh, DiskMapOptions { initial: Some(aview2(&folded)), method, ..Default::default() });
        assert_bijective(&mesh, &unfolded);
    }
}

#[test]
fn a_start_map_off_the_circle_is_refused() {
    let mesh = common::bumpy_disk(4).mesh();
    let good = planar(&mapped(&mesh, DiskMapOptions::default()).uv).to_vec();
    let refusal = |change: &dyn Fn(&mut Vec<[f64; 2]>)| {
        let mut initial = good.clone();
        change(&mut initial);
        disk_map(
            &mesh,
            &DiskMapOptions { initial: Some(aview2(&initial)), ..Default::default() },
            &mut Silent,
        )
        .unwrap_err()
    };
    let on_boundary = mesh.boundary_loops()[0][0].index();
    assert!(matches!(
        refusal(&|map| map[on_boundary][0] *= 1.5),
        Error::Map(MapError::InitialBoundary { .. })
    ));
    assert!(matches!(
        refusal(&|map| map.iter_mut().for_each(|uv| uv[0] = -uv[0])),
        Error::Map(MapError::InitialBoundary { .. })
    ));
    assert!(matches!(refusal(&|map| map[0][0] = f64::NAN), Error::Map(MapError::NonFinite { .. })));
    assert!(matches!(refusal(&|map| map.truncate(3)), Error::InvalidArray { .. }));
}

#[test]
fn a_cancelled_run_returns_a_sound_map() {
    let mesh = common::bumpy_disk(12).mesh();
    for method in METHODS {
        let options = DiskMapOptions { method, ..Default::default() };
        cancelled_everywhere(
            |observer| disk_map(&mesh, &options, observer),
            |map, _| {
                assert_bijective(&mesh, map);
                map.status
            },
        );
    }
}

#[test]
fn progress_never_goes_back() {
    let mesh = common::bumpy_disk(12).mesh();
    for method in METHODS {
        let mut last = 0.0;
        let mut observer = |fraction: f64, _: &str| {
            assert!(fraction >= last, "{method:?}: {fraction} after {last}");
            last = fraction;
            true
        };
        let options = DiskMapOptions { max_iterations: Some(120), method, ..Default::default() };
        disk_map(&mesh, &options, &mut observer).unwrap();
        assert_eq!(last, 1.0);
    }
}

#[test]
fn options_out_of_range_are_refused() {
    let mesh = common::triangle().mesh();
    let refused = |options: DiskMapOptions<'_>| disk_map(&mesh, &options, &mut Silent).unwrap_err();
    assert!(matches!(
        refused(DiskMapOptions { tolerance: Some(f64::NAN), ..Default::default() }),
        Error::InvalidOption { .. }
    ));
    assert!(matches!(
        refused(DiskMapOptions { density: Some(aview1(&[0.0])), ..Default::default() }),
        Error::Map(MapError::Density { .. })
    ));
    assert!(matches!(
        refused(DiskMapOptions { density: Some(aview1(&[])), ..Default::default() }),
        Error::InvalidArray { .. }
    ));
}

#[test]
fn what_is_no_disk_is_refused() {
    for shape in common::all().iter().filter(|shape| !shape.is_disk()) {
        if let Ok(mesh) = TriangleMesh::new(&shape.vertices, &shape.faces) {
            assert!(disk_map(&mesh, &DiskMapOptions::default(), &mut Silent).unwrap_err().is_mesh_error());
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Disks with random heights, spikes included, and random densities never fold.
    #[test]
    fn random_disks_are_mapped_one_to_one(
        rings in 2u32..9,
        heights in prop::collection::vec(-1.0f64..1.0, 16),
        spike in 0.0f64..30.0,
        contrast in 0.0f64..6.0,
        method in prop::sample::select(METHODS.to_vec()),
        boundary in prop::sample::select(BOUNDARIES.to_vec()),
    ) {
        let base = common::bumpy_disk(rings);
        let vertices: Vec<[f64; 3]> = base.vertices.iter().enumerate()
            .map(|(v, p)| [p[0], p[1], p[2] + heights[v % heights.len()] + if v == 0 { spike } else { 0.0 }])
            .collect();
        let mesh = TriangleMesh::new(&vertices, &base.faces).unwrap();
        let density: Vec<f64> = (0..mesh.n_faces()).map(|face| (contrast * heights[face % heights.len()]).exp()).collect();
        let map = mapped(&mesh, DiskMapOptions { method, boundary, density: Some(aview1(&density)), max_iterations: Some(20), ..Default::default() });
        assert_bijective(&mesh, &map);
    }
}
