// SPDX-License-Identifier: MIT OR Apache-2.0
//! Registrations by curves by their properties: certificates, curves on curves, refusals, cancelling.

use crate::common::closed::{dot, radial, rotation};
use crate::common::public::{register_hyperbolic, spatial};
use crate::common::random::Random;
use crate::common::{TestMesh, distance, icosphere};
use authalic::testing::TriangleMesh;
use authalic::{
    CurveError, CurveRegistration, Error, HyperbolicEnergy, HyperbolicOptions, LandmarkCurves, Side, Silent,
    Status,
};
use proptest::prelude::*;

type Point = [f64; 3];

/// The paper's energy.
fn harmonic() -> HyperbolicOptions<'static> {
    HyperbolicOptions { energy: HyperbolicEnergy::Harmonic, ..Default::default() }
}

fn register(meshes: [&TriangleMesh; 2], paths: [&[Vec<usize>]; 2]) -> Result<CurveRegistration, Error> {
    let curves = LandmarkCurves { source: paths[0], target: paths[1] };
    register_hyperbolic(meshes[0], meshes[1], &curves, &harmonic(), &mut Silent)
}

/// A sphere with bumps of any direction and frequency, turned somehow.
fn bumpy(level: u32, random: &mut Random) -> TestMesh {
    let bumps: [[f64; 5]; 3] = std::array::from_fn(|_| {
        let [x, y, z] = [0; 3].map(|_| random.between(-3.0, 3.0));
        [x, y, z, random.between(0.0, 6.0), random.between(0.0, 0.2)]
    });
    let height = |x: Point| -> f64 {
        bumps.iter().map(|&[a, b, c, phase, size]| size * (dot([a, b, c], x) + phase).sin()).sum()
    };
    let mut mesh = radial("bumpy sphere", level, |x| 1.0 + height(x));
    let turn = rotation([0; 4].map(|_| random.between(-1.0, 1.0)));
    mesh.vertices.iter_mut().for_each(|x| *x = turn.map(|row| dot(row, *x)));
    mesh
}

/// Up to `count` paths that run straight on from somewhere, without a vertex in common.
fn paths(count: usize, random: &mut Random, level: u32) -> Vec<Vec<usize>> {
    let sphere = icosphere(level);
    let mut neighbors = vec![Vec::new(); sphere.vertices.len()];
    for &[a, b, c] in &sphere.faces {
        [[a, b], [b, c], [c, a]].iter().for_each(|&[p, q]| neighbors[p as usize].push(q as usize));
    }
    let mut is_free = vec![true; sphere.vertices.len()];
    let mut found = Vec::new();
    for start in random.permutation(sphere.vertices.len()).into_iter().map(|v| v as usize) {
        let (steps, towards) = (random.below(9) as usize + 2, [0; 3].map(|_| random.between(-1.0, 1.0)));
        let mut path = vec![start];
        let ahead = |&&v: &&usize| dot(sphere.vertices[v], towards);
        while path.len() <= steps && is_free[start] {
            let last = &neighbors[path[path.len() - 1]];
            let free = last.iter().filter(|&&v| is_free[v] && !path.contains(&v));
            let Some(&next) = free.max_by(|a, b| ahead(a).total_cmp(&ahead(b))) else { break };
            path.push(next);
        }
        if path.len() > 2 && found.len() < count {
            path.iter().for_each(|&v| is_free[v] = false);
            found.push(path);
        }
    }
    found
}

/// The point at a share of the length of a path.
fn at_share(path: &[Point], share: f64) -> Point {
    let lengths: Vec<f64> = path.windows(2).map(|ends| distance(ends[0], ends[1])).collect();
    let mut left = share * lengths.iter().sum::<f64>();
    for (ends, length) in path.windows(2).zip(&lengths) {
        if left <= *length {
            return [0, 1, 2].map(|k| ends[0][k] + left / length * (ends[1][k] - ends[0][k]));
        }
        left -= length;
    }
    path[path.len() - 1]
}

/// How far the images of a path's vertices are from the same shares of another path at most.
fn off(path: &[Point], images: &[Point], other: &[Point]) -> f64 {
    let whole: f64 = path.windows(2).map(|ends| distance(ends[0], ends[1])).sum();
    let mut before = 0.0;
    let mut most = 0.0f64;
    for (k, image) in images.iter().enumerate() {
        before += if k > 0 { distance(path[k - 1], path[k]) } else { 0.0 };
        most = most.max(distance(*image, at_share(other, before / whole)));
    }
    most
}

/// A homeomorphism that takes every curve to its partner.
fn assert_sound(
    found: &CurveRegistration,
    meshes: [&TriangleMesh; 2],
    paths: [&[Vec<usize>]; 2],
) -> Result<(), TestCaseError> {
    let proof = &found.certificates;
    prop_assert!(proof.folded.is_empty(), "{proof:?}");
    prop_assert_eq!(proof.outside, 0);
    prop_assert!((proof.area / proof.expected_area - 1.0).abs() < 1e-8, "{:?}", proof);
    prop_assert!(proof.curve_error.max(proof.bank_error) < 1e-11, "{:?}", proof);
    prop_assert!(proof.cocycle_error < 1e-7, "{:?}", proof);
    prop_assert_eq!(found.map.status, Status::Converged);
    let map = &found.map.correspondence;
    for (triangle, weights) in map.triangles().iter().zip(map.barycentric().rows()) {
        let sum: f64 = weights.iter().sum();
        prop_assert!((sum - 1.0).abs() < 1e-14 && weights.iter().all(|&w| w >= 0.0));
        prop_assert!(*triangle < meshes[1].n_faces());
    }
    let positions = spatial(&map.positions());
    for (ours, theirs) in paths[0].iter().zip(paths[1]) {
        let images: Vec<Point> = ours.iter().map(|&v| positions[v].into()).collect();
        let [path, other] = [(0, ours), (1, theirs)].map(|(side, path)| {
            path.iter().map(|&v| meshes[side].points()[v].into()).collect::<Vec<Point>>()
        });
        prop_assert!(off(&path, &images, &other) < 1e-11);
    }
    Ok(())
}

/// The paths without their last vertices, where they stay long enough.
fn shortened(paths: &[Vec<usize>], random: &mut Random) -> Vec<Vec<usize>> {
    let mut shorten = |path: &Vec<usize>| {
        let cut = random.below(3) as usize;
        path[..path.len().saturating_sub(cut).max(3)].to_vec()
    };
    paths.iter().map(&mut shorten).collect()
}

#[test]
fn curves_that_cannot_be_cut_along_are_refused_before_any_work() {
    let mesh = icosphere(2).mesh();
    let good = paths(2, &mut Random::new(3), 2);
    let refused = |source: &[Vec<usize>], target: &[Vec<usize>]| {
        let mut observer = |_: f64, _: &str| panic!("something was computed");
        let (curves, options) = (LandmarkCurves { source, target }, harmonic());
        register_hyperbolic(&mesh, &mesh, &curves, &options, &mut observer).unwrap_err()
    };
    assert!(matches!(
        refused(&good, &good[..1]),
        Error::Curves(CurveError::Counts { source_count: 2, target_count: 1, .. })
    ));
    assert_eq!(refused(&[], &[]), CurveError::NoCurves.into());
    let with = |path: Vec<usize>| vec![good[0].clone(), path];
    let short = refused(&good, &with(good[1][..2].to_vec()));
    assert!(matches!(
        short,
        Error::Curves(CurveError::Short { side: Some(Side::Target), curve: 1, edges: 1 })
    ));
    let meeting = refused(&with(good[0].iter().rev().copied().collect()), &good);
    assert!(matches!(
        meeting,
        Error::Curves(CurveError::Meet { side: Some(Side::Source), curves: [0, 1], .. })
    ));
    let outside = refused(&with(vec![good[1][0], good[1][1], 162]), &good);
    assert!(matches!(outside, Error::Curves(CurveError::OutOfRange { curve: 1, place: 2, value: 162, .. })));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    /// Whatever the surfaces and the curves: nothing folds, the whole target is covered, curves lie on
    /// curves.
    #[test]
    fn random_curves_on_random_spheres(seed in 0u64..100_000, count in 1usize..9) {
        let mut random = Random::new(seed);
        let (source, target) = (bumpy(3, &mut random).mesh(), bumpy(3, &mut random).mesh());
        let ours = paths(count, &mut random, 3);
        let theirs = shortened(&ours, &mut random);
        let (meshes, pairs) = ([&source, &target], [&ours[..], &theirs[..]]);
        assert_sound(&register(meshes, pairs).unwrap(), meshes, pairs)?;
    }

    /// Curves that have to travel over the whole surface are strained, but not folded.
    #[test]
    fn curves_that_do_not_belong_together(seed in 0u64..100_000, count in 2usize..6) {
        let mut random = Random::new(seed);
        let (source, target) = (bumpy(3, &mut random).mesh(), bumpy(3, &mut random).mesh());
        let (ours, theirs) = (paths(count, &mut random, 3), paths(count, &mut random, 3));
        let (meshes, pairs) = ([&source, &target], [&ours[..], &theirs[..]]);
        match register(meshes, pairs) {
            Ok(found) => assert_sound(&found, meshes, pairs)?,
            Err(error) => prop_assert!(!error.is_mesh_error() || error == CurveError::Mirrored.into(), "{}", error),
        }
    }

    /// A run that is cancelled returns a sound map, or says that there was none yet.
    #[test]
    fn cancelled_runs_are_sound(seed in 0u64..100_000, last in 0usize..40) {
        let mut random = Random::new(seed);
        let (source, target) = (bumpy(2, &mut random).mesh(), bumpy(2, &mut random).mesh());
        let ours = paths(3, &mut random, 2);
        let mut calls = 0;
        let mut observer = |_: f64, _: &str| {
            calls += 1;
            calls <= last
        };
        let (curves, options) = (LandmarkCurves { source: &ours, target: &ours }, harmonic());
        match register_hyperbolic(&source, &target, &curves, &options, &mut observer) {
            Ok(found) => prop_assert!(found.certificates.folded.is_empty()),
            Err(error) => prop_assert_eq!(error, Error::CancelledEarly),
        }
    }
}
