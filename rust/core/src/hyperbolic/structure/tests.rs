// SPDX-License-Identifier: MIT OR Apache-2.0
//! The structure of spheres with slits and holes, against its theory.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::sync::OnceLock;

use super::super::moebius::{distance, from_klein, to_hyperboloid};
use super::super::sample_meshes::{circle, mesh, path, sphere};
use super::*;
use crate::control::Silent;
use crate::mesh::Vertex;
use crate::vector::{Vector3, coordinates};

type Points = (Vec<Vector3>, Vec<[Vertex; 3]>);

/// Slits spread over a sphere along a spiral.
fn slits(ball: &Points, count: usize) -> Vec<Vec<usize>> {
    let point = |k: f64| {
        let (z, angle) = (1.0 - 2.0 * (k + 0.5) / count as f64, 2.4 * k);
        let ring = (1.0 - z * z).max(0.0).sqrt();
        [ring * angle.cos(), ring * angle.sin(), z]
    };
    let tilt = 0.6 / (count as f64).sqrt();
    let slit = |k: usize| {
        let [x, y, z] = point(k as f64);
        path(ball, Vector3([x - tilt, y, z + 0.3 * tilt]), Vector3([x + tilt, y, z - 0.3 * tilt]))
    };
    (0..count).map(slit).collect()
}

fn ellipsoid(ball: &Points) -> TriangleMesh {
    mesh(ball, |x| Vector3([x[0], 0.8 * x[1], 1.3 * x[2]]))
}

fn with_slits(count: usize) -> HyperbolicStructure {
    let ball = sphere(if count > 6 { 5 } else { 4 });
    let surface = Surface::of_mesh(&ellipsoid(&ball));
    hyperbolic_structure(&surface, &slits(&ball, count), MetricMethod::Newton, &mut Silent).unwrap()
}

/// Three, five and ten slits.
fn samples() -> &'static [HyperbolicStructure] {
    static SAMPLES: OnceLock<Vec<HyperbolicStructure>> = OnceLock::new();
    SAMPLES.get_or_init(|| [3, 5, 10].map(with_slits).into())
}

/// The edges of a side of the disk in the plane.
fn length(structure: &HyperbolicStructure, side: &[Vertex]) -> f64 {
    side.windows(2).map(|ends| distance(position(structure, ends[0]), position(structure, ends[1]))).sum()
}

fn position(structure: &HyperbolicStructure, vertex: Vertex) -> Complex {
    structure.positions[vertex]
}

#[test]
fn counts_area_and_curvature() {
    for (structure, b) in samples().iter().zip([3, 5, 10]) {
        let counts = [
            structure.generators.len(),
            structure.pants.len(),
            structure.pants_curves.len(),
            structure.arcs.len(),
        ];
        assert_eq!(counts, [b - 1, b - 2, b - 3, b - 1]);
        assert!((structure.area / (TAU * (b as f64 - 2.0)) - 1.0).abs() < 1e-11);
        assert!(structure.curvature < 1e-11);
        let mut order: Vec<usize> = structure.chain.iter().map(|&(feature, _)| feature).collect();
        order.sort_unstable();
        assert_eq!(order, (0..b).collect::<Vec<_>>());
    }
}

#[test]
fn the_domain_is_laid_out_isometrically_and_in_the_middle() {
    for structure in samples() {
        for (sides, name) in [(&structure.banks, "bank"), (&structure.arcs, "arc")] {
            for (k, [left, right]) in sides.iter().enumerate() {
                let lengths = [left, right].map(|side| length(structure, side));
                if name == "arc" {
                    assert!((lengths[0] - lengths[1]).abs() < 1e-7, "arc {k}: {lengths:?}");
                } else {
                    let whole = structure.boundary_lengths[structure.chain[k].0];
                    assert!(
                        (lengths[0] + lengths[1] - whole).abs() < 1e-7,
                        "bank {k}: {lengths:?} of {whole}"
                    );
                    // geodesics: no detour
                    let direct =
                        distance(position(structure, left[0]), position(structure, left[left.len() - 1]));
                    assert!((lengths[0] - direct).abs() < 1e-7);
                }
            }
        }
        let far = structure.positions.iter().map(|z| z.norm()).fold(0.0, f64::max);
        assert!(far < 1.0 - 1e-6, "{far}");
    }
}

#[test]
fn generators_take_left_arcs_to_right_ones() {
    for structure in samples() {
        for (generator, [left, right]) in structure.generators.iter().zip(&structure.arcs) {
            assert!(
                (generator.a.norm_sqr() - generator.b.norm_sqr() - 1.0).abs() < 1e-9 && generator.a.re > 1.0
            );
            for (&left, &right) in left.iter().zip(right) {
                let gap = distance(generator.apply(position(structure, left)), position(structure, right));
                assert!(gap < 1e-7, "{gap}");
            }
        }
    }
}

#[test]
fn traces_are_the_lengths_of_boundaries_and_curves() {
    for structure in samples() {
        let lengths: Vec<f64> = structure.generators.iter().map(|g| g.translation_length()).collect();
        let last = lengths.len() - 1;
        let of_feature = |k: usize| structure.boundary_lengths[structure.chain[k].0];
        assert!((lengths[0] - of_feature(0)).abs() < 1e-9);
        assert!((lengths[last] - of_feature(last + 1)).abs() < 1e-9);
        for (k, pants) in structure.pants.iter().enumerate() {
            let expected = [lengths[k], of_feature(k + 1), lengths[k + 1]];
            // of products of translations: the entries of one by L are of size e^(L/2), and their squares cancel
            let rounding = 1e-11 + 2e-14 * expected.into_iter().fold(0.0, f64::max).exp();
            for (length, expected) in pants.boundary_lengths.into_iter().zip(expected) {
                assert!((length - expected).abs() < rounding, "{length} instead of {expected}");
            }
        }
        (1..last).for_each(|k| assert!((structure.lengths[k - 1] - lengths[k]).abs() < 1e-9));
    }
}

#[test]
fn the_axis_of_the_first_generator_is_the_first_boundary() {
    for structure in samples() {
        let last = structure.generators.len() - 1;
        for (k, generator) in [(0, structure.generators[0]), (last + 1, structure.generators[last])] {
            let ends = generator.fixed_points();
            for &vertex in structure.banks[k].iter().flatten() {
                assert!(off_line(position(structure, vertex), ends) < 1e-7);
            }
        }
    }
}

/// sinh of the distance from a line.
fn off_line(z: Complex, [from, to]: [Complex; 2]) -> f64 {
    let chord = to - from;
    let normal = Vector3([from.re, from.im, 1.0]).cross(Vector3([chord.re, chord.im, 0.0]));
    let point = to_hyperboloid(z);
    (2.0 * normal.dot(point) / chord.norm_sqr()).abs()
}

#[test]
fn hexagons_are_right_angled_convex_and_congruent_and_fill_the_surface() {
    for structure in samples() {
        for pants in &structure.pants {
            for (hexagon, angles) in pants.hexagons.iter().zip(pants.angles) {
                assert!(angles.iter().all(|angle| (angle - FRAC_PI_2).abs() < 1e-8), "{angles:?}");
                assert!((3.0 * PI - angles.iter().sum::<f64>()).abs() < 1e-8, "the area is π");
                let corners = hexagon.map(from_klein);
                for (side, length) in pants.boundary_lengths.iter().enumerate() {
                    assert!((2.0 * distance(corners[2 * side], corners[2 * side + 1]) - length).abs() < 1e-8);
                }
            }
            let turn = |k: usize| {
                let [p, q, r] = [0, 1, 2].map(|step| pants.hexagons[0][(k + step) % 6]);
                ((q - p).conj() * (r - q)).im
            };
            assert!((0..6).all(|k| turn(k) > 0.0), "convex and counterclockwise");
            let mirrored = |k: usize| (pants.hexagons[0][k] + pants.hexagons[1][k].conj()).norm();
            assert!((0..6).all(|k| mirrored(k) < 1e-9));
        }
    }
}

#[test]
fn hexagons_lie_at_their_boundaries() {
    for structure in samples() {
        for (k, pants) in structure.pants.iter().enumerate() {
            for (bank, hexagon) in structure.banks[k + 1].iter().zip(pants.hexagons) {
                let corners = hexagon.map(|corner| pants.placement.apply(from_klein(corner)));
                let ends = [position(structure, bank[0]), position(structure, bank[bank.len() - 1])];
                // the bank and the side lie on one line
                let to_axis = Moebius::between(ends, [Complex::default(), Complex::new(0.5, 0.0)]);
                for corner in [corners[2], corners[3]] {
                    assert!(to_axis.apply(corner).im.abs() < 1e-5);
                }
                let axis = |k: usize| structure.generators[k].fixed_points();
                assert!(off_line(corners[0], axis(k)) < 1e-5 && off_line(corners[1], axis(k)) < 1e-5);
                assert!(off_line(corners[4], axis(k + 1)) < 1e-5 && off_line(corners[5], axis(k + 1)) < 1e-5);
            }
        }
    }
}

#[test]
fn axes_of_consecutive_generators_are_disjoint() {
    for structure in samples() {
        for pair in structure.generators.windows(2) {
            let [[a, b], [c, d]] = [pair[0].fixed_points(), pair[1].fixed_points()];
            let cross_ratio = ((c - a) * (d - b)) / ((c - b) * (d - a));
            // real, and positive where the ends are not linked
            assert!(cross_ratio.re > 0.0 && cross_ratio.im.abs() < 1e-6 * cross_ratio.norm());
        }
    }
}

#[test]
fn pants_curves_run_on_the_surface_and_close_up() {
    for structure in samples() {
        for (curve, points) in structure.pants_curves.iter().zip(structure.pants_curves()) {
            let points = vectors(points.view());
            assert_eq!(curve.first(), curve.last());
            assert!(points.len() > 10);
            let longest = points.windows(2).map(|ends| ends[0].distance(ends[1])).fold(0.0, f64::max);
            assert!(longest < 0.12, "{longest}");
        }
    }
}

#[test]
fn copies_of_the_domain_grow_outward() {
    let structure = &samples()[1];
    let copies = structure.cover(200);
    assert_eq!(copies.len(), 200);
    assert!(copies[0].word.is_empty() && copies[0].motion == Moebius::default());
    for (number, copy) in copies.iter().enumerate().skip(1) {
        assert!(copy.word.windows(2).all(|letters| letters[0] != -letters[1]));
        let parent = &copy.word[..copy.word.len() - 1];
        assert!(copies[..number].iter().any(|earlier| earlier.word == parent));
        let product = copy.word.iter().fold(Moebius::default(), |product, &letter| {
            let generator = structure.generators[letter.unsigned_abs() as usize - 1];
            product * if letter > 0 { generator } else { generator.inverse() }
        });
        assert!(distance(product.apply(Complex::default()), copy.motion.apply(Complex::default())) < 1e-6);
    }
    // a copy by generator k shares the right copy of arc k with the domain
    for copy in copies.iter().filter(|copy| copy.word.len() == 1 && copy.word[0] > 0) {
        let [left, right] = &structure.arcs[copy.word[0] as usize - 1];
        assert!(
            distance(copy.motion.apply(position(structure, left[1])), position(structure, right[1])) < 1e-8
        );
    }
    assert_eq!(structure.cover(1).len(), 1);
}

#[test]
fn the_result_is_the_same_every_time() {
    let again = with_slits(5);
    let first = &samples()[1];
    assert_eq!(again.positions, first.positions);
    assert_eq!(again.generators, first.generators);
    assert_eq!(again.pants, first.pants);
    assert_eq!(again.pants_curves, first.pants_curves);
}

#[test]
fn boundary_loops_are_features_named_or_not() {
    let ball = sphere(4);
    let kept: Vec<[Vertex; 3]> =
        ball.1.iter().copied().filter(|face| face.iter().all(|&v| ball.0[v][2] < 0.8)).collect();
    let used: Vec<Vertex> =
        Vertex::all(ball.0.len()).filter(|v| kept.iter().any(|face| face.contains(v))).collect();
    let number = |v: Vertex| Vertex::new(used.binary_search(&v).unwrap());
    let points: Vec<Vector3> = used.iter().map(|&v| ball.0[v]).collect();
    let faces: Vec<[Vertex; 3]> = kept.iter().map(|face| face.map(number)).collect();
    let open = (points, faces);
    let surface = TriangleMesh::new(&coordinates(open.0.clone()), &open.1).unwrap();
    let slits = [
        path(&open, Vector3([1.0, -0.3, 0.0]), Vector3([1.0, 0.3, 0.0])),
        path(&open, Vector3([-1.0, 0.0, -0.4]), Vector3([-1.0, 0.0, 0.3])),
    ];
    let whole = Surface::of_mesh(&surface);
    let structure =
        |curves: &[Vec<usize>]| hyperbolic_structure(&whole, curves, MetricMethod::Newton, &mut Silent);
    let unnamed = structure(&slits).unwrap();
    assert_eq!((unnamed.boundary_lengths.len(), unnamed.pants.len()), (3, 1));
    let around: Vec<usize> = surface.boundary_loops()[0].iter().map(|&v| v.index()).collect();
    let named = structure(&[&slits[..], std::slice::from_ref(&around)].concat()).unwrap();
    assert!((named.boundary_lengths[2] - unnamed.boundary_lengths[2]).abs() < 1e-9);
    assert_eq!(structure(&[around]).unwrap_err(), CurveError::TooFewFeatures { found: 1 }.into());
}

#[test]
fn what_is_not_hyperbolic_is_refused() {
    let ball = sphere(3);
    let surface = Surface::of_mesh(&ellipsoid(&ball));
    let refused = |curves: &[Vec<usize>]| {
        let error = hyperbolic_structure(&surface, curves, MetricMethod::Newton, &mut Silent).unwrap_err();
        assert!(error.is_mesh_error());
        error
    };
    let three = slits(&ball, 3);
    assert_eq!(refused(&[]), CurveError::TooFewFeatures { found: 0 }.into());
    assert_eq!(refused(&three[..2]), CurveError::TooFewFeatures { found: 2 }.into());
    let mut ring = circle(&ball, Vector3([1.0, 1.0, 0.3]), 0.5);
    ring.push(ring[0]);
    assert_eq!(refused(&[ring]), CurveError::Divides { curve: 0 }.into());
    assert!(refused(&[three[0].clone(), vec![0, 1]]).to_string().starts_with("curves: curve 1"));
}
