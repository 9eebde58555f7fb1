// SPDX-License-Identifier: MIT OR Apache-2.0
//! How a run of the default method goes and ends: energies, angles against areas, densities, start maps, cancel,
//! threads, and that neither place, size nor numbering of a surface matters.

use crate::common::cancelling::cancelled_everywhere;
use crate::common::closed::{
    assert_bijective, bumpy, dot, image_areas, radial, rotation, round_tube, spiky_spheres,
};
use crate::common::planar::{areas, assert_one_to_one};
use crate::common::public::{array, disk_map, planar, spatial, sphere_map};
use crate::common::random::{Random, rough_disk, without_vertex};
use crate::common::{self, TestMesh, bumpy_disk, cap, icosphere, slit_sphere};
use authalic::testing::TriangleMesh;
use authalic::{
    Boundary, DiskMap, DiskMapOptions, DiskMethod, Distortion, Error, History, MapError, Silent, SphereMap,
    SphereMapOptions, SphereMethod, Status, Vertex,
};
use ndarray::{Array1, Array2, aview1, aview2};

const BOUNDARIES: [Boundary; 3] = [Boundary::ArcLength, Boundary::Sliding, Boundary::Free];

fn disk(mesh: &TriangleMesh, options: DiskMapOptions<'_>) -> DiskMap {
    let map = disk_map(mesh, &options, &mut Silent).expect("a disk has a map");
    assert_one_to_one(mesh, planar(&map.uv), options.boundary, "disk");
    map
}

fn sphere(mesh: &TriangleMesh, options: SphereMapOptions<'_>) -> SphereMap {
    let map = sphere_map(mesh, &options, &mut Silent).expect("a sphere has a map");
    assert_bijective(mesh, &spatial(&map.positions), "sphere");
    map
}

fn wavy_ball(level: u32) -> TestMesh {
    radial("wavy ball", level, |[x, y, z]| 1.0 + 0.4 * (5.0 * x).sin() * (4.0 * y).cos() + 0.2 * z)
}

/// A finger on a disk, on which the quick start folds.
fn finger() -> TriangleMesh {
    without_vertex(round_tube(12.0, 10), 0).mesh()
}

/// A disk with noise and a spike, from a seed that makes both large.
fn rough() -> TriangleMesh {
    rough_disk(&mut Random::new(3)).mesh()
}

// Energies

/// Area and angle terms of the energy over the total target, Σ T ψ(ρ) and Σ T ((m − 1) + ½ β (m − 1)²), for areas on
/// the scale of the targets. In the plane m = ½ (σ₁/σ₂ + σ₂/σ₁).
fn energy_terms(areas: &[f64], targets: &[f64], angles: &Array1<f64>) -> [f64; 2] {
    let mut terms = [0.0; 2];
    for ((area, target), angle) in areas.iter().zip(targets).zip(angles) {
        let (ratio, excess) = (area / target, 0.5 * (angle + 1.0 / angle) - 1.0);
        terms[0] += target * 0.5 * (ratio - 1.0).powi(2) * (1.0 + 1.0 / ratio);
        terms[1] += target * (excess + 0.05 * excess * excess);
    }
    terms
}

fn scaled_to(targets: &[f64], total: f64) -> Vec<f64> {
    let sum: f64 = targets.iter().sum();
    targets.iter().map(|target| target * total / sum).collect()
}

/// The least value between two places, of a function that falls and then rises.
fn least(value: impl Fn(f64) -> f64, [mut low, mut high]: [f64; 2]) -> f64 {
    for _ in 0..100 {
        let [a, b] = [low + (high - low) / 3.0, high - (high - low) / 3.0];
        if value(a) < value(b) { high = b } else { low = a }
    }
    value(low)
}

#[test]
fn every_iteration_lowers_the_energy_where_its_weights_are_constant() {
    // λ never falls below the one given, and a free image keeps the scale of its targets
    for shape in [bumpy_disk(12), cap(10, 2.4), slit_sphere(12, 17)] {
        let mesh = shape.mesh();
        let free = DiskMapOptions { boundary: Boundary::Free, angle_weight: 1.0, ..Default::default() };
        let start = disk(&mesh, DiskMapOptions { max_iterations: Some(0), ..free.clone() });
        // a given start is left with the given weight from the first iteration on
        let run = |iterations| {
            let initial = Some(start.uv.view());
            disk(&mesh, DiskMapOptions { initial, max_iterations: Some(iterations), ..free.clone() })
        };
        let begun: f64 = areas(&mesh, planar(&start.uv)).iter().sum();
        let targets = scaled_to(mesh.face_areas(), begun);
        let value = |map: &DiskMap| {
            let areas = scaled_to(&areas(&mesh, planar(&map.uv)), begun);
            let at = |scale: f64| {
                let areas: Vec<f64> = areas.iter().map(|area| scale * area).collect();
                energy_terms(&areas, &targets, &map.distortion.angle_distortion).iter().sum::<f64>()
            };
            // the result is scaled into the unit circle, so its own scale is not known; the best one is no higher
            least(at, [0.5, 2.0])
        };
        let values: Vec<f64> = (0..8).map(|iterations| value(&run(iterations))).collect();
        assert!(
            values.windows(2).all(|pair| pair[1] <= (1.0 + 1e-9) * pair[0]),
            "{}: {values:?}",
            shape.name
        );
        assert!(values[7] < values[0], "{}: {values:?}", shape.name);
    }
}

fn assert_sound(history: &History, energy: f64, context: &str) {
    let records = history.records();
    assert!(records.iter().map(|record| record.iteration).eq(0..records.len()), "{context}");
    assert_eq!(records[0].step, 0.0, "{context}");
    for record in records {
        assert!(record.authalic_energy.is_finite() && record.step.is_finite(), "{context}: {record:?}");
        assert!(record.gradient_norm >= 0.0, "{context}: {record:?}");
    }
    assert!(energy <= records[0].authalic_energy * (1.0 + 1e-9) + 1e-9, "{context}: {energy} at last");
    let last = records[records.len() - 1].authalic_energy;
    assert!((last - energy).abs() <= 1e-6 * energy + 1e-9, "{context}: {energy} follows {last}");
}

#[test]
fn histories_are_finite_and_end_with_the_result() {
    for shape in [bumpy_disk(12), slit_sphere(12, 17)] {
        let mesh = shape.mesh();
        for boundary in [Boundary::ArcLength, Boundary::Sliding] {
            let map = disk(&mesh, DiskMapOptions { boundary, ..Default::default() });
            let context = format!("{}, {boundary:?}", shape.name);
            assert_sound(&map.history, map.distortion.authalic_energy, &context);
        }
    }
    for mesh in [wavy_ball(3).mesh(), round_tube(4.0, 10).mesh()] {
        let map = sphere(&mesh, SphereMapOptions::default());
        assert_sound(&map.history, map.distortion.authalic_energy, "sphere");
    }
}

#[test]
fn histories_of_runs_from_a_start_map_are_finite() {
    let mesh = bumpy_disk(8).mesh();
    let initial = disk(&mesh, DiskMapOptions { method: DiskMethod::FixedPoint, ..Default::default() }).uv;
    let map = disk(&mesh, DiskMapOptions { initial: Some(initial.view()), ..Default::default() });
    assert_sound(&map.history, map.distortion.authalic_energy, "disk");
    let mesh = bumpy();
    let options = SphereMapOptions { method: SphereMethod::FixedPoint, ..Default::default() };
    let initial = sphere(&mesh, options).positions;
    let map = sphere(&mesh, SphereMapOptions { initial: Some(initial.view()), ..Default::default() });
    assert_sound(&map.history, map.distortion.authalic_energy, "sphere");
}

// Angles against areas

const ANGLE_WEIGHTS: [f64; 5] = [0.0, 1e-2, 0.1, 1.0, 10.0];

/// Along rising weights areas get worse and angles better, by the energy's own terms and by the figures.
fn assert_traded(figures: &[[f64; 4]], context: &str) {
    for pair in figures.windows(2) {
        let [[area, angle, deviation, mean], next] = [pair[0], pair[1]];
        assert!(next[0] > area && next[2] > deviation, "{context}: areas {figures:?}");
        assert!(next[1] < angle && next[3] < mean, "{context}: angles {figures:?}");
    }
}

#[test]
fn more_weight_on_angles_costs_areas_and_betters_angles_on_disks() {
    for shape in [bumpy_disk(16), cap(14, 2.4)] {
        let mesh = shape.mesh();
        for boundary in BOUNDARIES {
            let figures = ANGLE_WEIGHTS.map(|angle_weight| {
                let map = disk(&mesh, DiskMapOptions { boundary, angle_weight, ..Default::default() });
                let targets = scaled_to(mesh.face_areas(), areas(&mesh, planar(&map.uv)).iter().sum());
                let total: f64 = targets.iter().sum();
                let figures = &map.distortion;
                let terms = energy_terms(&areas(&mesh, planar(&map.uv)), &targets, &figures.angle_distortion);
                let [area, angle] = terms.map(|term| term / total);
                [area, angle, figures.area_ratio_std, figures.angle_distortion_mean]
            });
            assert_traded(&figures, &format!("{}, {boundary:?}", shape.name));
        }
    }
}

#[test]
fn more_weight_on_angles_costs_areas_and_betters_angles_on_spheres() {
    for shape in [wavy_ball(3), common::ellipsoid(3, [1.0, 1.5, 3.0])] {
        let mesh = shape.mesh();
        let figures = ANGLE_WEIGHTS.map(|angle_weight| {
            let map = sphere(&mesh, SphereMapOptions { angle_weight, ..Default::default() });
            let areas = image_areas(&mesh, &spatial(&map.positions));
            let targets = scaled_to(mesh.face_areas(), areas.iter().sum());
            let figures = &map.distortion;
            let [area, angle] = energy_terms(&areas, &targets, &figures.angle_distortion);
            [area, angle, figures.area_ratio_std, figures.angle_distortion_mean]
        });
        assert_traded(&figures, shape.name);
    }
}

#[test]
fn weights_of_angles_that_make_no_sense_are_refused() {
    let (open, closed) = (bumpy_disk(3).mesh(), icosphere(1).mesh());
    let of_disk = |method, angle_weight| {
        let options = DiskMapOptions { method, angle_weight, ..Default::default() };
        disk_map(&open, &options, &mut Silent)
    };
    let of_sphere = |method, angle_weight| {
        let options = SphereMapOptions { method, angle_weight, ..Default::default() };
        sphere_map(&closed, &options, &mut Silent)
    };
    let is_right = |error: Error| {
        assert!(matches!(error, Error::InvalidOption { name: "angle_weight", .. }), "{error}");
    };
    for weight in [-1e-9, f64::NEG_INFINITY, f64::INFINITY, f64::NAN] {
        is_right(of_disk(DiskMethod::GaussNewton, weight).unwrap_err());
        is_right(of_sphere(SphereMethod::GaussNewton, weight).unwrap_err());
    }
    for (disks, spheres) in [
        (DiskMethod::FixedPoint, SphereMethod::FixedPoint),
        (DiskMethod::ConjugateGradient, SphereMethod::GradientDescent),
    ] {
        is_right(of_disk(disks, 0.1).unwrap_err());
        is_right(of_sphere(spheres, 0.1).unwrap_err());
        assert!(of_disk(disks, 0.0).is_ok() && of_sphere(spheres, 0.0).is_ok());
        let options = DiskMapOptions { method: disks, boundary: Boundary::Free, ..Default::default() };
        let error = disk_map(&open, &options, &mut Silent).unwrap_err();
        assert!(matches!(error, Error::InvalidOption { name: "boundary", .. }), "{error}");
    }
}

// Densities and start maps

#[test]
fn densities_are_honoured() {
    let open = bumpy_disk(16).mesh();
    let closed = icosphere(3).mesh();
    let density = |mesh: &TriangleMesh| -> Vec<f64> {
        let value = |face: &[Vertex; 3]| if mesh.points()[face[0]][0] > 0.0 { 3.0 } else { 1.0 };
        mesh.faces().iter().map(value).collect()
    };
    let assert_threefold = |areas: &[f64], density: &[f64]| {
        let mean = |value: f64| {
            let part = || areas.iter().zip(density).filter(|(_, density)| **density == value);
            part().map(|(area, _)| area).sum::<f64>() / part().count() as f64
        };
        assert!((mean(3.0) / mean(1.0) - 3.0).abs() < 0.01, "{}", mean(3.0) / mean(1.0));
    };
    let on_disk = density(&open);
    for boundary in BOUNDARIES {
        let options = DiskMapOptions { boundary, density: Some(aview1(&on_disk)), ..Default::default() };
        assert_threefold(&areas(&open, planar(&disk(&open, options).uv)), &on_disk);
    }
    let on_sphere = density(&closed);
    let map = sphere(&closed, SphereMapOptions { density: Some(aview1(&on_sphere)), ..Default::default() });
    assert_threefold(&image_areas(&closed, &spatial(&map.positions)), &on_sphere);
}

#[test]
fn start_maps_of_disks_are_improved_and_folded_ones_unfolded() {
    for mesh in [bumpy_disk(10).mesh(), rough(), finger()] {
        let options = DiskMapOptions { method: DiskMethod::FixedPoint, ..Default::default() };
        let first = disk(&mesh, options);
        let mut random = Random::new(11);
        let mut spoiled = |of: &dyn Fn(&mut Random) -> [f64; 2]| {
            let mut uv = planar(&first.uv).to_vec();
            (0..uv.len())
                .filter(|&v| !mesh.is_boundary(Vertex::new(v)))
                .for_each(|v| uv[v] = of(&mut random));
            uv
        };
        let folded = [
            spoiled(&|_| [0.0, 0.0]),
            spoiled(&|_| [5.0, -3.0]),
            spoiled(&|random| [0, 1].map(|_| random.between(-0.7, 0.7))),
        ];
        for boundary in BOUNDARIES {
            let from = |initial: &[[f64; 2]]| {
                disk(&mesh, DiskMapOptions { initial: Some(aview2(initial)), boundary, ..Default::default() })
            };
            let energy = from(planar(&first.uv)).distortion.authalic_energy;
            assert!(energy < first.distortion.authalic_energy, "{boundary:?}");
            folded.iter().for_each(|initial| _ = from(initial));
        }
    }
}

#[test]
fn start_maps_of_spheres_are_improved_and_folded_ones_unfolded() {
    for mesh in [bumpy(), spiky_spheres()[1].mesh()] {
        let options = SphereMapOptions { method: SphereMethod::FixedPoint, ..Default::default() };
        let first = sphere(&mesh, options);
        let from = |initial: &Array2<f64>| {
            sphere(&mesh, SphereMapOptions { initial: Some(initial.view()), ..Default::default() })
        };
        let energy = from(&first.positions).distortion.authalic_energy;
        assert!(energy < first.distortion.authalic_energy);
        for step in [2, 9, 40] {
            let mut folded = spatial(&first.positions);
            folded.iter_mut().step_by(step).for_each(|x| x[2] = -x[2]);
            if !common::closed::folded(&mesh, &folded).is_empty() {
                match sphere_map(
                    &mesh,
                    &SphereMapOptions { initial: Some(array(&folded).view()), ..Default::default() },
                    &mut Silent,
                ) {
                    Ok(map) => assert_bijective(&mesh, &spatial(&map.positions), "from a folded start map"),
                    Err(error) => {
                        assert!(matches!(error, Error::Map(MapError::InitialSphere { .. })), "{error}")
                    }
                }
            }
        }
    }
}

// Cancel, limits, threads

#[test]
fn a_run_cancelled_at_any_report_returns_a_sound_map() {
    let [rough, finger] = [rough_disk(&mut Random::new(345)), without_vertex(round_tube(12.0, 6), 0)];
    for mesh in [bumpy_disk(6), rough, finger].map(|mesh| mesh.mesh()) {
        for boundary in BOUNDARIES {
            let options = DiskMapOptions { boundary, ..Default::default() };
            cancelled_everywhere(
                |observer| disk_map(&mesh, &options, observer),
                |map, _| {
                    assert_one_to_one(&mesh, planar(&map.uv), boundary, "cancelled");
                    map.status
                },
            );
        }
    }
    for mesh in [bumpy(), spiky_spheres()[1].mesh(), round_tube(12.0, 6).mesh()] {
        cancelled_everywhere(
            |observer| sphere_map(&mesh, &SphereMapOptions::default(), observer),
            |map, _| {
                assert_bijective(&mesh, &spatial(&map.positions), "cancelled");
                map.status
            },
        );
    }
}

#[test]
fn the_limit_of_iterations_is_kept() {
    for limit in [0, 1, 3, 6] {
        let max_iterations = Some(limit);
        // beyond it at most five steps of the fixed point, and on the disk those that unfold
        let map = disk(&bumpy_disk(12).mesh(), DiskMapOptions { max_iterations, ..Default::default() });
        assert!(map.history.iterations() <= 5 + 2 * limit);
        let map = sphere(&bumpy(), SphereMapOptions { max_iterations, ..Default::default() });
        assert!(map.history.iterations() <= 5 + limit);
    }
}

#[test]
fn the_tolerance_is_that_of_the_deviation_of_the_area_ratio() {
    for tolerance in [0.1, 0.01, 1e-3] {
        let options = DiskMapOptions { tolerance: Some(tolerance), ..Default::default() };
        let map = disk(&slit_sphere(20, 30).mesh(), options);
        assert_eq!(map.status, Status::Converged);
        assert!((map.distortion.authalic_energy / std::f64::consts::PI).sqrt() < 1.01 * tolerance);
    }
}

#[test]
fn the_same_bits_for_any_number_of_threads() {
    // more faces than one task takes, so that all threads have work
    let (open, closed) = (bumpy_disk(30).mesh(), wavy_ball(4).mesh());
    assert!(open.n_faces() > 5000 && closed.n_faces() > 5000);
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let disks = BOUNDARIES.map(|boundary| {
                let angle_weight = if boundary == Boundary::Free { 0.1 } else { 0.0 };
                disk(&open, DiskMapOptions { boundary, angle_weight, ..Default::default() }).uv
            });
            (disks, sphere(&closed, SphereMapOptions::default()).positions)
        })
    };
    let one = on(1);
    assert_eq!(one, on(2));
    assert_eq!(one, on(7));
}

// Place, size and numbering

/// Copies of a surface: turned, of other sizes, with its vertices and faces in another order.
fn copies(shape: &TestMesh) -> Vec<TriangleMesh> {
    let turn = rotation([0.3, 0.8, -0.2, 0.4]);
    let moved = |of: &dyn Fn(&[f64; 3]) -> [f64; 3]| {
        TriangleMesh::new(&shape.vertices.iter().map(of).collect::<Vec<_>>(), &shape.faces).unwrap()
    };
    let mut random = Random::new(7);
    let (vertices, faces) = (random.permutation(shape.vertices.len()), random.permutation(shape.faces.len()));
    let mut places = shape.vertices.clone();
    vertices.iter().enumerate().for_each(|(old, &new)| places[new as usize] = shape.vertices[old]);
    let renumbered = |face: &u32| shape.faces[*face as usize].map(|v| vertices[v as usize]);
    let renumbered: Vec<[u32; 3]> = faces.iter().map(renumbered).map(|[a, b, c]| [b, c, a]).collect();
    vec![
        moved(&|x| turn.map(|row| dot(row, *x))),
        moved(&|x| x.map(|c| 1e8 * c + 1e8)),
        moved(&|x| x.map(|c| 1e-8 * c)),
        TriangleMesh::new(&places, &renumbered).unwrap(),
    ]
}

#[test]
fn neither_place_nor_size_nor_numbering_of_a_surface_matters() {
    let assert_alike = |one: &Distortion, other: &Distortion, context: &str| {
        let energies = one.authalic_energy / other.authalic_energy;
        let deviations = one.area_ratio_std / other.area_ratio_std;
        // E_A goes by the square of the deviation
        assert!((energies - 1.0).abs() < 0.1, "{context}: {energies}");
        assert!((deviations - 1.0).abs() < 0.05, "{context}: {deviations}");
    };
    for shape in [slit_sphere(20, 30), bumpy_disk(16)] {
        for boundary in [Boundary::ArcLength, Boundary::Sliding] {
            let options = DiskMapOptions { boundary, ..Default::default() };
            let expected = disk(&shape.mesh(), options.clone()).distortion;
            for (k, mesh) in copies(&shape).iter().enumerate() {
                let (found, context) =
                    (disk(mesh, options.clone()).distortion, format!("{}, copy {k}", shape.name));
                assert_alike(&found, &expected, &context);
            }
        }
    }
    for shape in [wavy_ball(3), round_tube(4.0, 12)] {
        let expected = sphere(&shape.mesh(), SphereMapOptions::default()).distortion;
        for (k, mesh) in copies(&shape).iter().enumerate() {
            let found = sphere(mesh, SphereMapOptions::default()).distortion;
            let context = format!("{}, copy {k}", shape.name);
            assert_alike(&found, &expected, &context);
        }
    }
}
