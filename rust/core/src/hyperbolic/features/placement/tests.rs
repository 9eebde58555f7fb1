// SPDX-License-Identifier: MIT OR Apache-2.0
use super::*;
use crate::alignment::rotation::rotation_of;
use crate::control::Silent;
use crate::hyperbolic::features::curves::LandmarkCurves;
use crate::hyperbolic::features::regions::divided;
use crate::hyperbolic::sample_meshes::{circle, mesh, path, sphere, without};

fn ellipsoid(Vector3([x, y, z]): Vector3) -> Vector3 {
    Vector3([x, 0.8 * y + 0.1 * x * x, 0.6 * z])
}

fn place(
    source: &TriangleMesh,
    target: &TriangleMesh,
    ours: &[Vec<usize>],
    theirs: &[Vec<usize>],
) -> Placement {
    let pairs = LandmarkCurves { source: ours, target: theirs }.check(source, target).unwrap();
    let divided = divided(source, target, pairs).unwrap();
    placed([source, target], &divided, None, &Watch::new(&mut Silent, 0.0, "")).unwrap()
}

fn arcs() -> Vec<Vec<usize>> {
    let sphere = sphere(3);
    let arc = |from, to| path(&sphere, from, to);
    vec![
        arc(Vector3([1.0, 0.2, 0.3]), Vector3([0.3, 1.0, 0.2])),
        arc(Vector3([-1.0, 0.0, 0.2]), Vector3([-0.5, 0.4, 1.0])),
        arc(Vector3([0.2, -1.0, -0.4]), Vector3([0.6, -0.2, -1.0])),
    ]
}

#[test]
fn a_turned_copy_is_laid_over_its_original() {
    let turn = rotation_of([0.5, -0.1, 0.7, 0.5]);
    let source = mesh(&sphere(3), ellipsoid);
    let target = mesh(&sphere(3), |x| rotate(turn, ellipsoid(x)));
    let ring = circle(&sphere(3), Vector3([0.3, -1.0, 0.8]), 0.4);
    for curves in [arcs(), vec![arcs()[0].clone(), ring.clone()]] {
        let placement = place(&source, &target, &curves, &curves);
        let apart = |v: usize| placement.source[v].distance(placement.target[v]);
        assert!((0..source.n_vertices()).all(|v| apart(v) < 1e-6));
        assert!(!placement.mirrored && placement.backwards.is_empty());
        // the open curve comes first
        assert_eq!(placement.shifts[0], 0.0);
    }
}

#[test]
fn curves_that_fit_the_other_way_round_and_mirrored_surfaces_are_told() {
    let source = mesh(&sphere(3), ellipsoid);
    let mut curves = arcs();
    curves.push(path(&sphere(3), Vector3([1.0, -0.7, 0.5]), Vector3([0.2, -0.9, 0.8])));
    let mut turned = curves.clone();
    turned[1].reverse();
    let placement = place(&source, &source, &curves, &turned);
    assert_eq!((placement.backwards, placement.mirrored), (vec![1], false));
    let (points, faces) = sphere(3);
    let flipped = (points, faces.iter().map(|&[a, b, c]| [a, c, b]).collect());
    let mirrored = mesh(&flipped, |x| ellipsoid(x).map(|x| -x));
    assert!(place(&source, &mirrored, &curves, &curves).mirrored);
}

#[test]
fn boundary_loops_find_their_partners() {
    let holes = |Vector3([x, y, z]): Vector3| x > 0.9 || y > 0.93 || z < -0.91;
    let raw = without(&sphere(3), holes);
    let [source, target] = [mesh(&raw, ellipsoid), mesh(&raw, |x| ellipsoid(x).map(|x| 2.0 * x))];
    let placement = place(&source, &target, &[], &[]);
    assert_eq!(placement.loops.len(), 3);
    for (pair, loop_vertices) in placement.loops.iter().zip(source.boundary_loops()) {
        assert!(pair.source == *loop_vertices && pair.target == *loop_vertices && pair.on_boundary);
    }
}

#[test]
fn given_spheres_are_taken_and_checked() {
    let source = mesh(&sphere(3), ellipsoid);
    let pairs = LandmarkCurves { source: &arcs(), target: &arcs() }.check(&source, &source).unwrap();
    let divided = divided(&source, &source, pairs).unwrap();
    let turn = rotation_of([0.6, 0.0, 0.0, 0.8]);
    let theirs = sphere(3).0;
    let ours: Vec<Vector3> = theirs.iter().map(|&x| rotate(turn, x) * 7.0).collect();
    let place = |spheres| placed([&source; 2], &divided, Some(spheres), &Watch::new(&mut Silent, 0.0, ""));
    let placement = place([&ours[..], &theirs]).unwrap();
    assert!(placement.source.iter().zip(&theirs).all(|(&x, &y)| x.distance(y) < 1e-7));
    let short = place([&ours[1..], &theirs[..]]);
    assert!(matches!(short, Err(Error::InvalidArray { name: "source_sphere", .. })));
    let zeros = vec![Vector3::ZERO; ours.len()];
    let error = place([&ours[..], &zeros]).unwrap_err();
    assert!(error.to_string().starts_with("target_sphere points nowhere"), "{error}");
}
