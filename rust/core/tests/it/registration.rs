// SPDX-License-Identifier: MIT OR Apache-2.0
//! Registrations by their properties: no folds, landmarks on landmarks, identities, refusals, inverse.

use crate::common::cancelling::CancelAt;
use crate::common::closed::{bumpy, parallels, radial, spheres};
use crate::common::public::{planar, spatial, triples};
use crate::common::public::{register_disks, register_spheres};
use crate::common::random::Random;
use crate::common::{self, bumpy_disk, cap, distance, ellipsoid, faces_of_indices};
use authalic::testing::{TriangleMesh, Vector3, folded_in_plane, folded_on_sphere};
use authalic::{
    DiskRegistration, Energy, Error, LandmarkError, Landmarks, RegistrationOptions, Silent,
    SphereRegistration, Status, Vertex,
};
use proptest::prelude::*;

/// The papers' energy.
fn areas() -> RegistrationOptions<'static> {
    RegistrationOptions { energy: Energy::Area, ..Default::default() }
}

fn disks(source: &TriangleMesh, target: &TriangleMesh, pairs: [&[usize]; 2]) -> DiskRegistration {
    let landmarks = Landmarks { source: pairs[0], target: pairs[1] };
    register_disks(source, target, &landmarks, &areas(), &mut Silent).unwrap()
}

fn closed(source: &TriangleMesh, target: &TriangleMesh, pairs: [&[usize]; 2]) -> SphereRegistration {
    let landmarks = Landmarks { source: pairs[0], target: pairs[1] };
    register_spheres(source, target, &landmarks, &areas(), &mut Silent).unwrap()
}

/// `count` different vertices inside a mesh.
fn picked(mesh: &TriangleMesh, count: usize, seed: u64) -> Vec<usize> {
    let order = Random::new(seed).permutation(mesh.n_vertices());
    order.into_iter().map(|v| v as usize).filter(|&v| !mesh.is_boundary(Vertex::new(v))).take(count).collect()
}

/// Nothing folded in either map, locations that are places, landmarks that were not missed met.
fn assert_sound(
    faces: &[[Vertex; 3]],
    found: &DiskRegistration,
    pairs: [&[usize]; 2],
) -> Result<(), TestCaseError> {
    let (registered, target_registered) = (planar(&found.registered), planar(&found.target_registered));
    let target_faces = found.correspondence.target_faces();
    prop_assert!(folded_in_plane(faces, registered).is_empty());
    prop_assert!(folded_in_plane(&faces_of_indices(triples(&target_faces)), target_registered).is_empty());
    for (triangle, weights) in
        found.correspondence.triangles().iter().zip(found.correspondence.barycentric().rows())
    {
        let sum: f64 = weights.iter().sum();
        prop_assert!((sum - 1.0).abs() < 1e-14 && weights.iter().all(|&w| w >= 0.0));
        prop_assert!(*triangle < target_faces.nrows());
    }
    for (k, error) in found.landmark_error.iter().enumerate() {
        let [[a, b], [c, d]] = [registered[pairs[0][k]], target_registered[pairs[1][k]]];
        prop_assert!((error - (a - c).hypot(b - d)).abs() < 1e-14);
        prop_assert!(*error <= 1e-3 || found.missed.contains(&k));
    }
    prop_assert_eq!(found.status == Status::LandmarksMissed, !found.missed.is_empty());
    Ok(())
}

/// The largest distance of g(v) to v, in units of the mesh, of which the bounding box has a diagonal of 1.
fn moved(mesh: &TriangleMesh, positions: &[Vector3]) -> f64 {
    positions.iter().zip(mesh.points()).map(|(a, b)| distance(*a, *b)).fold(0.0, f64::max)
}

#[test]
fn a_disk_onto_itself_is_the_identity() {
    for disk in common::disks() {
        let mesh = disk.mesh();
        let marks = picked(&mesh, 3, 1);
        if marks.is_empty() {
            continue;
        }
        let found = disks(&mesh, &mesh, [&marks, &marks]);
        assert!(moved(&mesh, &spatial(&found.correspondence.positions())) < 1e-6, "{}", disk.name);
        assert!(found.missed.is_empty() && found.distortion.folded.is_empty(), "{}", disk.name);
    }
}

#[test]
fn a_sphere_onto_itself_is_the_identity() {
    for sphere in spheres() {
        let mesh = sphere.mesh();
        let marks = picked(&mesh, 4, 2);
        let found = closed(&mesh, &mesh, [&marks, &marks]);
        assert!(moved(&mesh, &spatial(&found.correspondence.positions())) < 1e-6, "{}", sphere.name);
        assert!(found.missed.is_empty() && found.distortion.folded.is_empty(), "{}", sphere.name);
    }
}

#[test]
fn closed_surfaces_meet_in_their_landmarks() {
    let (source, target) = (bumpy(), ellipsoid(3, [1.0, 2.0, 3.0]).mesh());
    let (ours, theirs) = (picked(&source, 5, 7), picked(&target, 5, 8));
    let found = closed(&source, &target, [&ours, &theirs]);
    assert!(folded_on_sphere(source.faces(), &spatial(&found.registered)).is_empty());
    let target_faces = found.correspondence.target_faces();
    assert!(
        folded_on_sphere(&faces_of_indices(triples(&target_faces)), &spatial(&found.target_registered))
            .is_empty()
    );
    let positions = spatial(&found.correspondence.positions());
    for (k, (&p, &q)) in ours.iter().zip(&theirs).enumerate() {
        let is_there = found.landmark_error[k] <= 1e-3 && distance(positions[p], target.points()[q]) < 5e-3;
        assert!(is_there || found.missed.contains(&k), "pair {k}");
    }
}

/// From coarse to fine: more than 5,000 vertices.
#[test]
fn large_surfaces_keep_shapes_and_fold_nothing() {
    let wavy = |[x, y, z]: [f64; 3]| 1.0 + 0.15 * (3.0 * x).sin() * (2.0 * y).cos() + 0.1 * z;
    let source = radial("wavy", 5, wavy).mesh();
    let target = ellipsoid(5, [1.0, 1.2, 0.9]).mesh();
    let marks = [0, 1, 2, 3, 4, 700, 4000];
    let landmarks = Landmarks { source: &marks, target: &marks };
    let options = RegistrationOptions::default();
    let found = register_spheres(&source, &target, &landmarks, &options, &mut Silent).unwrap();
    // 1. One-to-one, landmarks exact
    assert!(folded_on_sphere(source.faces(), &spatial(&found.registered)).is_empty());
    let target_faces = faces_of_indices(triples(&found.correspondence.target_faces()));
    assert!(folded_on_sphere(&target_faces, &spatial(&found.target_registered)).is_empty());
    let positions = spatial(&found.correspondence.positions());
    assert!(found.missed.is_empty());
    for mark in marks {
        assert!(distance(positions[mark], target.points()[mark]) < 1e-9);
    }
    // 2. Shapes are kept: most faces are stretched little
    assert!(found.strain().stretched < 0.01, "{}", found.strain().stretched);
}

#[test]
fn a_large_sphere_onto_itself_is_the_identity() {
    let mesh = radial("wavy", 5, |[x, y, z]| 1.0 + 0.2 * (3.0 * x + y).sin() * z).mesh();
    let marks = [5, 900, 5000];
    let landmarks = Landmarks { source: &marks, target: &marks };
    let options = RegistrationOptions::default();
    let found = register_spheres(&mesh, &mesh, &landmarks, &options, &mut Silent).unwrap();
    assert!(moved(&mesh, &spatial(&found.correspondence.positions())) < 1e-6);
    assert_eq!(found.status, Status::Converged);
}

/// Soft landmarks need not meet for coarse meshes to be taken to the whole.
#[test]
fn large_surfaces_with_soft_landmarks_are_laid_over_each_other_once() {
    let source =
        radial("wavy", 5, |[x, y, z]| 1.0 + 0.15 * (3.0 * x).sin() * (2.0 * y).cos() + 0.1 * z).mesh();
    let target = ellipsoid(5, [1.0, 1.2, 0.9]).mesh();
    let landmarks = Landmarks { source: &[0, 1, 2, 3, 700], target: &[0, 1, 2, 3, 900] };
    let n_descents = |weights: &[f64]| {
        let (mut count, mut last) = (0, String::new());
        let mut observer = |_: f64, message: &str| {
            count += usize::from(message == "Keeping shapes" && last != message);
            last = message.to_owned();
            true
        };
        let options = RegistrationOptions { weights: Some(weights), ..Default::default() };
        register_spheres(&source, &target, &landmarks, &options, &mut observer).unwrap();
        count
    };
    let exact = f64::INFINITY;
    assert_eq!(n_descents(&[exact, exact, exact, exact, 0.1]), n_descents(&[exact; 5]));
}

#[test]
fn the_inverse_exchanges_both_surfaces() {
    let (source, target) = (bumpy_disk(7).mesh(), cap(8, 1.4).mesh());
    let (ours, theirs) = (picked(&source, 3, 3), picked(&target, 3, 4));
    let found = disks(&source, &target, [&ours, &theirs]);
    let back = found.inverse(&mut Silent).unwrap();
    let n_located = back.correspondence.triangles().len();
    assert_eq!((back.registered.nrows(), n_located), (target.n_vertices(), target.n_vertices()));
    assert_sound(&faces_of_indices(triples(&found.correspondence.target_faces())), &back, [&theirs, &ours])
        .unwrap();
    let again = back.inverse(&mut Silent).unwrap();
    assert_eq!(again.correspondence.triangles(), found.correspondence.triangles());
    assert_eq!(again.correspondence.barycentric(), found.correspondence.barycentric());
    let [before, after] = [&found, &again].map(|found| found.distortion.authalic_energy);
    assert!((after - before).abs() < 1e-9 * before, "{before} {after}");
}

#[test]
fn bad_landmarks_are_refused_before_any_work() {
    let mesh = bumpy_disk(5).mesh();
    let edge = mesh.boundary_loops()[0][0].index();
    let refused = |source: &[usize], target: &[usize]| {
        let mut observer = |_: f64, _: &str| panic!("something was computed");
        let landmarks = Landmarks { source, target };
        register_disks(&mesh, &mesh, &landmarks, &areas(), &mut observer).unwrap_err()
    };
    assert!(matches!(
        refused(&[1, 2], &[1]),
        Error::Landmarks(LandmarkError::Counts { source_count: 2, target_count: 1 })
    ));
    assert!(matches!(refused(&[], &[]), Error::Landmarks(LandmarkError::TooFew { found: 0, needed: 1 })));
    assert!(matches!(
        refused(&[1, 10_000], &[1, 2]),
        Error::Landmarks(LandmarkError::OutOfRange { value: 10_000, .. })
    ));
    assert!(matches!(
        refused(&[1, 2], &[3, 3]),
        Error::Landmarks(LandmarkError::Repeated { first: 0, vertex: 3, .. })
    ));
    assert!(
        matches!(refused(&[1, edge], &[1, 2]), Error::Landmarks(LandmarkError::OnBoundary { vertex, .. }) if vertex == edge)
    );
    let sphere = bumpy();
    let landmarks = Landmarks { source: &[1], target: &[1] };
    let error = register_disks(&mesh, &sphere, &landmarks, &areas(), &mut Silent);
    assert!(error.unwrap_err().to_string().starts_with("the target: "));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Whatever landmarks are asked for, nothing folds, and what was missed is named.
    #[test]
    fn random_landmarks_fold_nothing(seed in 0u64..1000, count in 1usize..9, rings in 3u32..8) {
        let (source, target) = (bumpy_disk(rings).mesh(), cap(rings + 1, 1.8).mesh());
        let (ours, theirs) = (picked(&source, count, seed), picked(&target, count, seed + 1));
        let pairs: [&[usize]; 2] = [&ours, &theirs];
        assert_sound(source.faces(), &disks(&source, &target, pairs), pairs)?;
    }

    /// A run that is cancelled anywhere returns a map without folds, or says that there was none yet.
    #[test]
    fn cancelled_runs_are_sound(seed in 0u64..1000, last in 0usize..60) {
        let (source, target) = (bumpy_disk(5).mesh(), cap(6, 1.8).mesh());
        let (ours, theirs) = (picked(&source, 4, seed), picked(&target, 4, seed + 1));
        let mut observer = CancelAt::after(last);
        let landmarks = Landmarks { source: &ours, target: &theirs };
        let options = areas();
        match register_disks(&source, &target, &landmarks, &options, &mut observer) {
            Ok(found) => {
                prop_assert!(folded_in_plane(source.faces(), planar(&found.registered)).is_empty());
                prop_assert_eq!(found.status == Status::Cancelled, observer.has_cancelled);
            }
            Err(error) => prop_assert_eq!(error, Error::CancelledEarly),
        }
    }
}

#[test]
fn progress_never_falls_even_where_coarse_meshes_are_of_no_use() {
    // landmarks of one face that change places meet on no coarse mesh, so that the whole surfaces begin anew
    let ball = parallels(72, 72).mesh();
    assert!(ball.n_vertices() > 5_000);
    let [a, b, c] = ball.faces()[2_600].map(Vertex::index);
    let far = [0, 1_000, 4_500];
    let (source, target) = ([&far[..], &[a, b, c]].concat(), [&far[..], &[a, c, b]].concat());
    let mut heard = Vec::new();
    let mut observer = |fraction: f64, _: &str| {
        heard.push(fraction);
        true
    };
    let landmarks = Landmarks { source: &source, target: &target };
    let found = register_spheres(&ball, &ball, &landmarks, &Default::default(), &mut observer).unwrap();
    assert_eq!(found.status, Status::LandmarksMissed);
    assert!(heard.windows(2).all(|pair| pair[0] <= pair[1]));
    assert_eq!(heard.last(), Some(&1.0));
}
