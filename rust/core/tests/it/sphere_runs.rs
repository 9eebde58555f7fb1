// SPDX-License-Identifier: MIT OR Apache-2.0
//! How a run onto the sphere goes and ends: start maps, progress, cancel, limits and tolerances.

use crate::common::cancelling::cancelled_everywhere;
use crate::common::public::{array, spatial, sphere_map};
use authalic::testing::{TriangleMesh, Vector3};
use authalic::{Error, MapError, SphereMap, SphereMapOptions, SphereMethod, Status};
use std::f64::consts::PI;

use crate::common;
use crate::common::closed::{
    METHODS, assert_bijective, bumpy, dot, energies, energy_of, folded, image_areas, mapped, refused,
    rotation, spiky_spheres, with,
};

// Start maps

#[test]
fn a_start_map_is_improved_and_keeps_its_rotation() {
    let mesh = bumpy();
    let options = SphereMapOptions { max_iterations: Some(3), ..with(SphereMethod::FixedPoint) };
    let first = spatial(&mapped(&mesh, options).positions);
    let turn = rotation([0.3, 0.8, -0.2, 0.4]);
    let turned: Vec<Vector3> = first.iter().map(|x| Vector3(turn.map(|row| dot(row, *x)))).collect();
    for method in METHODS {
        let map = mapped(&mesh, SphereMapOptions { initial: Some(array(&turned).view()), ..with(method) });
        assert_bijective(&mesh, &spatial(&map.positions), "from a start map");
        let [before, after] =
            [&turned, &spatial(&map.positions)].map(|map| energy_of(&mesh, map, mesh.face_areas()).0);
        assert!(after < before, "{method:?}: {after} {before}");
        assert!((energies(&map)[0] - before).abs() < 1e-9 * before, "{method:?}: the history begins there");
        // it still lies nearer to the start map than to its rotated copy
        let to = |other: &[Vector3]| {
            spatial(&map.positions).iter().zip(other).map(|(a, b)| common::distance(*a, *b)).sum::<f64>()
        };
        assert!(to(&turned) < 0.5 * to(&first), "{method:?}");
    }
}

#[test]
fn a_start_map_without_iterations_is_returned_on_the_sphere() {
    let mesh = bumpy();
    let start = spatial(&mapped(&mesh, SphereMapOptions::default()).positions);
    let stretched: Vec<Vector3> =
        start.iter().enumerate().map(|(v, x)| x.map(|c| c * (1.0 + v as f64))).collect();
    for initial in [&start, &stretched] {
        for method in METHODS {
            let initial = array(initial);
            let options =
                SphereMapOptions { initial: Some(initial.view()), max_iterations: Some(0), ..with(method) };
            let map = mapped(&mesh, options);
            let furthest = spatial(&map.positions)
                .iter()
                .zip(&start)
                .map(|(a, b)| common::distance(*a, *b))
                .fold(0.0, f64::max);
            assert!(furthest < 1e-15, "{furthest}");
            assert_eq!(map.history.iterations(), 0);
        }
    }
}

/// The start map with some vertices on the other side of the sphere.
fn spoiled(mesh: &TriangleMesh, vertices: &[usize]) -> Vec<Vector3> {
    let options = SphereMapOptions { max_iterations: Some(5), ..Default::default() };
    let mut map = spatial(&mapped(mesh, options).positions);
    vertices.iter().for_each(|&v| map[v] = map[v].map(|x| -x));
    assert!(!folded(mesh, &map).is_empty());
    map
}

#[test]
fn a_folded_start_map_is_unfolded() {
    let mesh = bumpy();
    for vertices in [&[5][..], &[3, 80, 120], &[40, 41, 42, 43, 44, 45, 46, 47]] {
        let initial = array(&spoiled(&mesh, vertices));
        for method in METHODS {
            for max_iterations in [Some(0), Some(4), None] {
                let options =
                    SphereMapOptions { initial: Some(initial.view()), max_iterations, ..with(method) };
                let map = mapped(&mesh, options);
                assert_bijective(&mesh, &spatial(&map.positions), "from a folded start map");
            }
        }
    }
}

#[test]
fn a_start_map_that_is_none_is_refused() {
    let mesh = bumpy();
    let good = spatial(&mapped(&mesh, SphereMapOptions::default()).positions);
    let refusal = |change: &dyn Fn(&mut Vec<Vector3>)| {
        let mut initial = good.clone();
        change(&mut initial);
        let initial = array(&initial);
        METHODS
            .map(|method| refused(&mesh, SphereMapOptions { initial: Some(initial.view()), ..with(method) }))
    };
    let all = |errors: [Error; 2], is_right: &dyn Fn(&Error) -> bool| {
        errors.iter().for_each(|error| assert!(is_right(error) && error.is_mesh_error(), "{error}"));
    };
    all(
        refusal(&|map| map[7] = Vector3::ZERO),
        &|e| matches!(e, Error::Map(MapError::InitialSphere { vertices, .. }) if vertices.first == [7]),
    );
    all(
        refusal(&|map| map[9][1] = f64::NAN),
        &|e| matches!(e, Error::Map(MapError::NonFinite { vertices, .. }) if vertices.first == [9]),
    );
    all(refusal(&|map| map[9][1] = f64::INFINITY), &|e| matches!(e, Error::Map(MapError::NonFinite { .. })));
    all(refusal(&|map| map.truncate(20)), &|e| matches!(e, Error::InvalidArray { name: "initial", .. }));
    let mirror = |map: &mut Vec<Vector3>| map.iter_mut().for_each(|x| x[0] = -x[0]);
    all(refusal(&mirror), &|e| {
        matches!(e, Error::Map(MapError::InitialSphere { .. })) && e.to_string().contains("mirror")
    });
}

// Progress, cancel, limits

/// Runs that report different numbers of times: without folds, and with a correction and a guarded descent.
fn runs() -> Vec<(TriangleMesh, SphereMapOptions<'static>)> {
    let short = |method| SphereMapOptions { max_iterations: Some(25), ..with(method) };
    let meshes = [bumpy(), spiky_spheres()[1].mesh()];
    meshes.into_iter().flat_map(|mesh| METHODS.map(|method| (mesh.clone(), short(method)))).collect()
}

#[test]
fn progress_never_goes_back_and_ends_at_1() {
    for (mesh, options) in runs() {
        let mut heard = vec![0.0];
        let mut observer = |fraction: f64, message: &str| {
            assert!((0.0..=1.0).contains(&fraction) && !message.is_empty());
            heard.push(fraction);
            true
        };
        sphere_map(&mesh, &options, &mut observer).unwrap();
        assert!(heard.windows(2).all(|pair| pair[0] <= pair[1]), "{heard:?}");
        assert_eq!(heard.last(), Some(&1.0));
    }
}

#[test]
fn a_run_cancelled_at_any_report_returns_a_sound_map() {
    for (mesh, options) in runs() {
        cancelled_everywhere(
            |observer| sphere_map(&mesh, &options, observer),
            |map, reports| {
                assert_bijective(&mesh, &spatial(&map.positions), "cancelled");
                assert!(map.history.iterations() <= reports);
                map.status
            },
        );
    }
}

#[test]
fn the_limit_of_iterations_is_kept() {
    let mesh = bumpy();
    for limit in [0, 1, 7, 30] {
        let iterations = |method| {
            mapped(&mesh, SphereMapOptions { max_iterations: Some(limit), ..with(method) })
                .history
                .iterations()
        };
        assert!(iterations(SphereMethod::FixedPoint) <= limit);
        // at most ten steps of the fixed point come before
        let descent = iterations(SphereMethod::GradientDescent);
        assert!((limit..=limit + limit.min(10)).contains(&descent), "{descent} for {limit}");
    }
}

#[test]
fn gradient_descent_stops_at_its_tolerance() {
    let mesh = bumpy();
    let options = SphereMapOptions {
        tolerance: Some(3e-2),
        max_iterations: Some(2000),
        ..with(SphereMethod::GradientDescent)
    };
    let map = mapped(&mesh, options);
    let records = map.history.records();
    let [before, last] = [records.len() - 2, records.len() - 1].map(|i| records[i].gradient_norm);
    assert_eq!(map.status, Status::Converged);
    assert!(last <= 3e-2 && before > 3e-2);
}

#[test]
fn the_fixed_point_stops_where_the_stretch_energy_falls_too_little() {
    let mesh = bumpy();
    // E_S with image and targets on the scale of the sphere: (4π/A) (E_A + A)
    let stretch = |map: &SphereMap| {
        let area: f64 = image_areas(&mesh, &spatial(&map.positions)).iter().sum();
        4.0 * PI / area * (map.distortion.authalic_energy + area)
    };
    let run = |tolerance, limit| {
        let max_iterations = Some(limit);
        mapped(
            &mesh,
            SphereMapOptions { tolerance: Some(tolerance), max_iterations, ..with(SphereMethod::FixedPoint) },
        )
    };
    let through: Vec<f64> = (0..=20).map(|limit| stretch(&run(f64::NEG_INFINITY, limit))).collect();
    let falls: Vec<f64> = through.windows(2).map(|pair| pair[0] - pair[1]).collect();
    let mut lengths = Vec::new();
    for tolerance in [0.3, 1e-2, 1e-3, 0.0] {
        let map = run(tolerance, 20);
        // a step that falls by no more than the tolerance is the last one, a step that rises is not taken
        let last = falls.iter().position(|&fall| fall <= tolerance).expect("it stops within 20 steps");
        let expected = if falls[last] > 0.0 { last + 1 } else { last };
        assert_eq!(
            (map.status, map.history.iterations()),
            (Status::Converged, expected),
            "{tolerance} {falls:?}"
        );
        assert!((stretch(&map) - through[expected]).abs() < 1e-12);
        lengths.push(expected);
    }
    assert!(lengths[0] < lengths[1] && lengths[1] <= lengths[3], "{lengths:?}");
}

#[test]
fn the_fixed_point_without_a_stopping_rule_returns_its_last_map() {
    let mesh = bumpy();
    for unfold in [true, false] {
        let options = SphereMapOptions {
            tolerance: Some(f64::NEG_INFINITY),
            max_iterations: Some(60),
            unfold,
            ..with(SphereMethod::FixedPoint)
        };
        let map = mapped(&mesh, options);
        assert_eq!((map.status, map.history.iterations()), (Status::MaxIterations, 60));
        let last = energies(&map)[60];
        assert!((map.distortion.authalic_energy - last).abs() < 1e-9 * last);
    }
}

#[test]
fn tolerances_out_of_range_are_refused() {
    let mesh = bumpy();
    let cases = [
        (SphereMethod::FixedPoint, vec![f64::NAN, f64::INFINITY]),
        (SphereMethod::GradientDescent, vec![f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1e-9]),
    ];
    for (method, tolerances) in cases {
        for tolerance in tolerances {
            let error = refused(&mesh, SphereMapOptions { tolerance: Some(tolerance), ..with(method) });
            assert!(matches!(error, Error::InvalidOption { name: "tolerance", .. }));
            assert!(!error.is_mesh_error() && !error.is_solver_error());
        }
    }
}
