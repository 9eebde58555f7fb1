// SPDX-License-Identifier: MIT OR Apache-2.0
use super::*;
use crate::control::Silent;

/// A small arc about a direction, `half` to either side along a tangent.
fn arc(center: Vector3, along: Vector3, half: f64) -> Vec<Vector3> {
    let center = unit(center);
    let normal = center.cross(unit(along));
    let side = unit(normal.cross(center));
    let point = |k: i32| {
        let (sine, cosine) = (half * f64::from(k) / 10.0).sin_cos();
        center * cosine + side * sine
    };
    (-10..=10).map(point).collect()
}

fn isotopy(source: &[Vec<Vector3>], target: &[Vec<Vector3>]) -> Option<Isotopy> {
    Isotopy::new(source, target, &Watch::new(&mut Silent, 0.0, ""))
}

fn curves() -> Vec<Vec<Vector3>> {
    vec![
        arc(Vector3([1.0, 0.0, 0.0]), Vector3([0.0, 1.0, 0.0]), 0.3),
        arc(Vector3([0.0, 1.0, 0.3]), Vector3([1.0, 0.0, 0.0]), 0.2),
        arc(Vector3([0.5, 0.3, 1.0]), Vector3([0.0, 1.0, 0.0]), 0.25),
    ]
}

#[test]
fn curves_at_rest_leave_everything_at_rest() {
    let still = isotopy(&curves(), &curves()).unwrap();
    assert_eq!(still.carry(&curves()[0]), curves()[0]);
}

#[test]
fn the_ends_of_arcs_between_features_arrive() {
    let moved = vec![
        arc(Vector3([1.0, 0.2, -0.2]), Vector3([0.2, 1.0, 0.3]), 0.35),
        arc(Vector3([-0.3, 1.0, 0.3]), Vector3([1.0, 0.3, 0.2]), 0.2),
        arc(Vector3([0.4, 0.1, 1.0]), Vector3([0.5, 1.0, 0.0]), 0.2),
    ];
    let motion = isotopy(&curves(), &moved).unwrap();
    for (from, to) in curves().iter().zip(&moved) {
        assert!(motion.carry(from).iter().zip(to).all(|(&x, &y)| x.distance(y) < 1e-4));
    }
    // nearby points stay nearby: the end of one arc to the start of the next
    let [from, to] = [curves()[0][20], curves()[1][0]];
    let line: Vec<Vector3> = (0..=100).map(|k| slerp(from, to, f64::from(k) / 100.0)).collect();
    let carried = motion.carry(&line);
    assert!(carried[0].distance(moved[0][20]) < 1e-2 && carried[100].distance(moved[1][0]) < 1e-2);
    assert!(carried.windows(2).all(|ends| ends[0].distance(ends[1]) < 0.05));
}

#[test]
fn a_curve_given_backwards_spins() {
    let target: Vec<Vec<Vector3>> = curves()
        .into_iter()
        .enumerate()
        .map(|(curve, mut points)| {
            if curve == 0 {
                points.reverse();
            }
            points
        })
        .collect();
    let motion = isotopy(&curves(), &target).unwrap();
    for (from, to) in curves().iter().zip(&target) {
        assert!(motion.carry(from).iter().zip(to).all(|(&x, &y)| x.distance(y) < 1e-2));
    }
    assert!(motion.carry(&[unit(Vector3([1.0, 0.0, 0.0]))])[0].distance(Vector3([1.0, 0.0, 0.0])) < 1e-3);
}

#[test]
fn curves_that_run_into_each_other_are_refused() {
    let [a, b] = [
        arc(Vector3([1.0, 0.0, 0.0]), Vector3([0.0, 0.0, 1.0]), 0.2),
        arc(Vector3([0.8, 0.6, 0.0]), Vector3([0.0, 0.0, 1.0]), 0.2),
    ];
    assert!(isotopy(&[a.clone(), b.clone()], &[b, a]).is_none());
}

#[test]
fn rotations_have_an_axis_and_an_angle() {
    for (axis, angle) in
        [([0.6, 0.0, 0.8], 0.7), ([0.0, -0.6, 0.8], std::f64::consts::PI), ([1.0, 0.0, 0.0], 0.0)]
    {
        let axis = Vector3(axis);
        let (its_axis, its_angle) = axis_angle(turn(axis, angle));
        assert!((its_angle - angle).abs() < 1e-7);
        let [x, y] = [turn(axis, angle), turn(its_axis, its_angle)]
            .map(|rotation| rotate(rotation, Vector3([0.3, 0.5, -0.4])));
        assert!(x.distance(y) < 1e-7);
    }
}
