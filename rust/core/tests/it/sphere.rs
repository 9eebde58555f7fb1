// SPDX-License-Identifier: MIT OR Apache-2.0
//! Sphere maps by their properties, on every test mesh that is a topological sphere.

use crate::common::closed::{
    LINE_SEARCHES, METHODS, assert_bijective, bumpy, dot, energies, energy_of, folded, image_areas, mapped,
    radial, refused, rotation, spheres, spiky_spheres, star, with,
};
use crate::common::public::spatial;
use crate::common::{self, TestMesh};
use authalic::testing::{TriangleMesh, Vector3, folded_on_sphere};
use authalic::{Error, MapError, MeshError, SphereMapOptions, SphereMethod, Vertex};
use ndarray::aview1;
use proptest::prelude::*;

type Point = [f64; 3];

#[test]
fn the_test_meshes_are_spheres() {
    for sphere in spheres().iter().chain(&spiky_spheres()) {
        let mesh = sphere.mesh();
        assert!(sphere.is_sphere() && mesh.require_sphere().is_ok() && mesh.flipped_faces().is_empty());
        let volume: f64 = mesh
            .faces()
            .iter()
            .map(|face| {
                let [a, b, c] = face.map(|v| mesh.points()[v]);
                common::determinant(a, b, c)
            })
            .sum();
        assert!(volume > 0.0, "{}: outward", sphere.name);
    }
}

#[test]
fn every_sphere_is_mapped_one_to_one_by_every_method() {
    for sphere in spheres().iter().chain(&spiky_spheres()) {
        let mesh = sphere.mesh();
        for (method, line_search) in METHODS.into_iter().flat_map(|m| LINE_SEARCHES.map(|l| (m, l))) {
            let map = mapped(&mesh, SphereMapOptions { method, line_search, ..Default::default() });
            let context = format!("{}, {method:?}, {line_search:?}", sphere.name);
            assert_bijective(&mesh, &spatial(&map.positions), &context);
            assert!(map.distortion.folded.is_empty(), "{context}");
            let records = map.history.records();
            assert!(records.iter().map(|record| record.iteration).eq(0..records.len()), "{context}");
            assert_eq!(records[0].step, 0.0, "{context}");
            assert!(records.iter().all(|record| record.authalic_energy.is_finite()), "{context}");
        }
    }
}

#[test]
fn the_start_map_is_one_to_one() {
    for sphere in spheres().iter().chain(&spiky_spheres()) {
        let mesh = sphere.mesh();
        for method in METHODS {
            let map = mapped(&mesh, SphereMapOptions { max_iterations: Some(0), ..with(method) });
            assert_bijective(&mesh, &spatial(&map.positions), sphere.name);
            assert_eq!(map.history.iterations(), 0, "{}", sphere.name);
        }
    }
}

#[test]
fn the_figures_are_those_of_the_map() {
    for sphere in spheres() {
        let mesh = sphere.mesh();
        for method in METHODS {
            let map = mapped(&mesh, with(method));
            let (energy, _) = energy_of(&mesh, &spatial(&map.positions), mesh.face_areas());
            let reported = map.distortion.authalic_energy;
            assert!(
                (reported - energy).abs() <= 1e-9 * energy + 1e-13,
                "{}: {reported} {energy}",
                sphere.name
            );
            if mesh.n_vertices() < 20 && method == SphereMethod::GradientDescent {
                continue; // on so few vertices faces fold on the way
            }
            // otherwise the last map is the result, up to its rotation
            let last = *energies(&map).last().expect("the start at least");
            assert!(
                (last - energy).abs() <= 1e-9 * energy + 1e-13,
                "{} {method:?}: {last} {energy}",
                sphere.name
            );
        }
    }
}

#[test]
fn gradient_descent_beats_the_fixed_point_and_both_the_start() {
    for sphere in spheres().into_iter().filter(|sphere| sphere.vertices.len() > 100) {
        let mesh = sphere.mesh();
        let energy = |options| mapped(&mesh, options).distortion.authalic_energy;
        let start =
            energy(SphereMapOptions { max_iterations: Some(0), ..with(SphereMethod::GradientDescent) });
        if start < 1e-6 {
            continue; // the icosphere itself
        }
        let [fixed_point, descent] = METHODS.map(|method| energy(with(method)));
        assert!(
            descent < fixed_point && fixed_point < start,
            "{}: {descent} {fixed_point} {start}",
            sphere.name
        );
    }
}

#[test]
fn the_normalized_energy_never_rises_in_gradient_descent() {
    let mesh = bumpy();
    for line_search in LINE_SEARCHES {
        let after = |iterations| {
            let options = SphereMapOptions {
                max_iterations: Some(iterations),
                line_search,
                ..with(SphereMethod::GradientDescent)
            };
            energy_of(&mesh, &spatial(&mapped(&mesh, options).positions), mesh.face_areas()).1
        };
        let energies: Vec<f64> = (10..30).map(after).collect();
        assert!(energies.windows(2).all(|pair| pair[1] < pair[0]), "{line_search:?}: {energies:?}");
    }
}

#[test]
fn both_line_searches_come_to_the_same_energy() {
    let mesh = bumpy();
    let [one, two] = LINE_SEARCHES.map(|line_search| {
        let options = SphereMapOptions {
            line_search,
            max_iterations: Some(300),
            ..with(SphereMethod::GradientDescent)
        };
        mapped(&mesh, options).distortion.authalic_energy
    });
    assert!((one / two).ln().abs() < 1.0, "{one} {two}");
}

#[test]
fn the_same_bits_for_any_number_of_threads() {
    // more vertices than one task takes, so that all threads have work
    let wave = |[x, y, z]: Point| 1.0 + 0.4 * (5.0 * x).sin() * (4.0 * y).cos() + 0.2 * z;
    for mesh in [radial("bumpy sphere", 5, wave).mesh(), spiky_spheres()[0].mesh()] {
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let run = |method| {
                mapped(&mesh, SphereMapOptions { max_iterations: Some(12), ..with(method) }).positions
            };
            pool.install(|| [SphereMethod::GradientDescent, SphereMethod::GaussNewton].map(run))
        };
        let one = on(1);
        assert_eq!(one, on(2));
        assert_eq!(one, on(7));
    }
}

// The surface below the map

/// Σ w (R f)·(v − c), w the vertices' shares of the targets.
fn overlap(mesh: &TriangleMesh, map: &[Vector3], targets: &[f64], rotation: [Point; 3]) -> f64 {
    let mut weights = vec![0.0; map.len()];
    for (face, target) in mesh.faces().iter().zip(targets) {
        face.iter().for_each(|&v| weights[v] += target);
    }
    let total: f64 = weights.iter().sum();
    let center = [0, 1, 2].map(|axis| {
        mesh.points().iter().zip(&weights).map(|(p, weight)| weight * p[axis]).sum::<f64>() / total
    });
    let term = |v: usize| {
        let point = mesh.points()[v];
        weights[v]
            * dot(rotation.map(|row| dot(row, map[v])), [0, 1, 2].map(|axis| point[axis] - center[axis]))
    };
    (0..map.len()).map(term).sum()
}

#[test]
fn no_rotation_lays_the_map_over_the_surface_any_better() {
    let grid = [-1.0, -0.3, 0.0, 0.02, 0.6];
    for sphere in spheres() {
        let mesh = sphere.mesh();
        for method in METHODS {
            let map = spatial(&mapped(&mesh, with(method)).positions);
            let at = |turn| overlap(&mesh, &map, mesh.face_areas(), rotation(turn));
            let best = at([1.0, 0.0, 0.0, 0.0]);
            for x in grid {
                for (y, z) in grid.into_iter().flat_map(|y| grid.map(|z| (y, z))) {
                    for w in [1.0, 0.0] {
                        let turned = if [w, x, y, z] == [0.0; 4] { best } else { at([w, x, y, z]) };
                        assert!(turned <= best + 1e-9 * best.abs(), "{}: {turned} {best}", sphere.name);
                    }
                }
            }
        }
    }
}

#[test]
fn an_icosphere_keeps_its_place() {
    for level in [2, 3] {
        let mesh = common::icosphere(level).mesh();
        let map = mapped(&mesh, SphereMapOptions::default());
        let positions = spatial(&map.positions);
        let furthest = mesh.points().iter().zip(&positions).map(|(p, x)| {
            let length = common::distance(*p, [0.0; 3]);
            common::distance(p.map(|c| c / length), *x)
        });
        assert!(furthest.fold(0.0, f64::max) < 0.06, "level {level}");
        assert!(map.distortion.area_ratio_std < 0.02, "level {level}");
    }
}

#[test]
fn the_coarsest_spheres_are_mapped_no_worse_than_by_the_start() {
    for sphere in spheres().into_iter().filter(|sphere| sphere.vertices.len() <= 20) {
        let mesh = sphere.mesh();
        let energy = |max_iterations| {
            mapped(&mesh, SphereMapOptions { max_iterations, ..Default::default() })
                .distortion
                .authalic_energy
        };
        assert!(
            energy(None) <= energy(Some(0)) + 1e-12,
            "{}: {} {}",
            sphere.name,
            energy(None),
            energy(Some(0))
        );
    }
}

#[test]
fn a_surface_turned_inside_out_is_mapped_as_its_faces_are_oriented() {
    let sphere = radial("bumpy sphere", 2, |[x, ..]| 1.0 + 0.3 * (4.0 * x).sin());
    let inward: Vec<[u32; 3]> = sphere.faces.iter().map(|&[a, b, c]| [a, c, b]).collect();
    let mesh = TriangleMesh::new(&sphere.vertices, &inward).unwrap();
    let map = mapped(&mesh, SphereMapOptions::default());
    assert_eq!(mesh.faces(), crate::common::faces_of_indices(&inward));
    assert_bijective(&mesh, &spatial(&map.positions), "inward");
}

// Density

#[test]
fn a_density_is_honoured() {
    let mesh = common::icosphere(3).mesh();
    let height = |face: &[Vertex; 3]| face.iter().map(|&v| mesh.points()[v][2]).sum::<f64>();
    let density: Vec<f64> = mesh.faces().iter().map(|face| 2.0 + height(face).signum()).collect();
    for method in METHODS {
        let options =
            SphereMapOptions { density: Some(aview1(&density)), max_iterations: Some(300), ..with(method) };
        let map = mapped(&mesh, options);
        assert_bijective(&mesh, &spatial(&map.positions), "density");
        assert!(map.distortion.area_ratio_std < 0.1, "{method:?} {}", map.distortion.area_ratio_std);
        let areas = image_areas(&mesh, &spatial(&map.positions));
        let mean = |value: f64| {
            let part = || areas.iter().zip(&density).filter(|(_, density)| **density == value);
            part().map(|(area, _)| area).sum::<f64>() / part().count() as f64
        };
        assert!((mean(3.0) / mean(1.0) - 3.0).abs() < 0.1, "{method:?} {}", mean(3.0) / mean(1.0));
        let (energy, _) = energy_of(&mesh, &spatial(&map.positions), &density);
        assert!((map.distortion.authalic_energy - energy).abs() < 1e-9 * energy);
    }
}

#[test]
fn the_scale_of_a_density_does_not_matter() {
    let mesh = bumpy();
    let on = |scale: f64, iterations| {
        let density: Vec<f64> = (0..mesh.n_faces()).map(|face| scale * (2.0 + (face as f64).sin())).collect();
        let max_iterations = Some(iterations);
        let options =
            SphereMapOptions { density: Some(aview1(&density)), max_iterations, ..Default::default() };
        spatial(&mapped(&mesh, options).positions)
    };
    assert_eq!(on(1.0, 100), on(2f64.powi(40), 100), "a power of two changes no bit");
    // rounding of the density grows with the iterations
    let plain = on(1.0, 20);
    for scale in [1e-9, 1e9] {
        let distances = on(scale, 20).into_iter().zip(&plain).map(|(a, b)| common::distance(a, *b));
        assert!(distances.fold(0.0, f64::max) < 1e-6);
    }
}

#[test]
fn bad_densities_are_refused() {
    let mesh = common::icosphere(0).mesh();
    let refusal = |density: &[f64]| {
        refused(&mesh, SphereMapOptions { density: Some(aview1(density)), ..Default::default() })
    };
    let mut density = vec![1.0; 20];
    assert!(matches!(refusal(&density[1..]), Error::InvalidArray { name: "density", .. }));
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-13] {
        density[7] = bad;
        assert!(
            matches!(refusal(&density), Error::Map(MapError::Density { faces, .. }) if faces.first == [7])
        );
    }
}

// Folds

#[test]
fn folds_are_reported_where_they_are_not_unfolded() {
    let mut found = 0;
    for sphere in spiky_spheres() {
        let mesh = sphere.mesh();
        for method in METHODS {
            let map = mapped(&mesh, SphereMapOptions { unfold: false, ..with(method) });
            assert_eq!(map.distortion.folded, folded(&mesh, &spatial(&map.positions)), "{}", sphere.name);
            assert_eq!(map.distortion.folded, folded_on_sphere(mesh.faces(), &spatial(&map.positions)));
            found += map.distortion.folded.len();
            // what is reported is what the method ended with
            let last = *energies(&map).last().expect("the start at least");
            let signed = |face: &usize| 4.0 * image_areas(&mesh, &spatial(&map.positions))[*face];
            let folds: f64 = map.distortion.folded.iter().map(signed).sum();
            assert!((map.distortion.authalic_energy - folds - last).abs() < 1e-9 * (1.0 + last));
        }
    }
    assert!(found > 0, "no mesh here folds, the tests of the correction test nothing");
}

#[test]
fn without_folds_the_correction_changes_no_bit() {
    let mesh = bumpy();
    for method in METHODS {
        let plain = mapped(&mesh, SphereMapOptions { unfold: false, ..with(method) });
        assert!(plain.distortion.folded.is_empty());
        assert_eq!(plain.positions, mapped(&mesh, with(method)).positions);
    }
}

// What is no sphere

#[test]
fn what_is_no_sphere_is_refused() {
    for shape in common::all().iter().filter(|shape| !shape.is_sphere()) {
        let Ok(mesh) = TriangleMesh::new(&shape.vertices, &shape.faces) else { continue };
        let error = refused(&mesh, SphereMapOptions::default());
        assert!(error.is_mesh_error(), "{}", shape.name);
        assert_eq!(error, mesh.require_sphere().unwrap_err());
        let is_right = match (shape.components, shape.n_loops) {
            (1, 0) => {
                matches!(error, Error::Mesh(MeshError::SphereHasHandles { genus }) if Some(genus) == shape.genus)
            }
            (1, loops) => {
                matches!(&error, Error::Mesh(MeshError::OpenSurface { sizes, .. }) if sizes.len() == loops)
            }
            (pieces, _) => {
                matches!(&error, Error::Mesh(MeshError::SeveralComponents { faces, .. }) if faces.count == pieces)
            }
        };
        assert!(is_right, "{}: {error}", shape.name);
    }
}

#[test]
fn the_refusals_say_what_to_do() {
    let message = |mesh: TestMesh| refused(&mesh.mesh(), SphereMapOptions::default()).to_string();
    let handles = message(common::torus(9, 14));
    assert!(handles.contains("genus 1") && handles.contains("seams"), "{handles}");
    let one = message(common::cap(4, 2.0));
    assert!(one.contains("a boundary loop of 24 edges") && one.contains("disk_map"), "{one}");
    let two = message(common::annulus(11, 3));
    assert!(two.contains("2 boundary loops of 11, 11 edges"), "{two}");
    let pieces = message(common::two_pieces());
    assert!(pieces.contains("2 separate pieces"), "{pieces}");
}

#[test]
fn two_spheres_are_two_pieces() {
    let [first, second] = [common::icosphere(1), common::closed::octahedron()];
    let shift = first.vertices.len() as u32;
    let vertices = [first.vertices, second.vertices].concat();
    let moved: Vec<[u32; 3]> = second.faces.iter().map(|face| face.map(|v| v + shift)).collect();
    let mesh = TriangleMesh::new(&vertices, &[first.faces, moved].concat()).unwrap();
    let error = refused(&mesh, SphereMapOptions::default());
    assert!(
        matches!(error, Error::Mesh(MeshError::SeveralComponents { faces, .. }) if faces.first == [0, 80])
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Rough star-shaped surfaces, spikes included, and random densities never fold.
    #[test]
    fn random_spheres_are_mapped_one_to_one(
        level in 0u32..4,
        mut radii in prop::collection::vec(0.4f64..1.6, 23),
        spike in 1.0f64..5.0,
        contrast in 0.0f64..4.0,
        method in prop::sample::select(METHODS.to_vec()),
        line_search in prop::sample::select(LINE_SEARCHES.to_vec()),
    ) {
        radii[7] *= spike;
        let mesh = star(level, &radii).mesh();
        // bounded, as densities too far apart are refused
        let density: Vec<f64> = mesh.face_areas().iter().enumerate()
            .map(|(face, area)| area * (contrast * radii[face % radii.len()].min(2.0)).exp()).collect();
        let options = SphereMapOptions { method, line_search, density: Some(aview1(&density)), max_iterations: Some(20), ..Default::default() };
        assert_bijective(&mesh, &spatial(&mapped(&mesh, options).positions), "random sphere");
    }
}
