// SPDX-License-Identifier: MIT OR Apache-2.0
//! The stretch energy of maps into space against independent formulas: cross products, cotangents, finite
//! differences, the identities that its degree of four and its invariance under rotations imply.

use authalic::Vertex;
use authalic::testing::{Profile, SpatialStretchEnergy, StretchEnergy, TriangleMesh, Vector3};
use std::f64::consts::PI;

use crate::common;
use approx::assert_relative_eq;
use sprs::CsMat;

const PROFILES: [Profile; 2] = [Profile::Stretch, Profile::Barrier];

/// Every test mesh that a map into space can be made of; flat, open and closed ones, with handles too.
fn surfaces() -> Vec<TriangleMesh> {
    common::orientable().iter().map(common::TestMesh::mesh).collect()
}

/// A smooth map whose faces have areas unlike the mesh's.
fn some_map(mesh: &TriangleMesh) -> Vec<Vector3> {
    let bent = |&Vector3([x, y, z]): &Vector3| {
        Vector3([x + 0.2 * y * y, 1.4 * y - 0.3 * z, z + 0.1 * (x + y).sin()])
    };
    mesh.points().iter().map(bent).collect()
}

/// Targets that differ from the areas.
fn some_targets(mesh: &TriangleMesh) -> Vec<f64> {
    mesh.face_areas().iter().enumerate().map(|(face, area)| area * (1.5 + (face as f64).sin())).collect()
}

fn difference(a: Vector3, b: Vector3) -> Vector3 {
    Vector3([a[0] - b[0], a[1] - b[1], a[2] - b[2]])
}

/// Image areas by Heron's formula, (m,).
fn areas(mesh: &TriangleMesh, map: &[Vector3]) -> Vec<f64> {
    let heron = |face: &[Vertex; 3]| {
        let [p, q, r] = face.map(|v| map[v]);
        let [a, b, c] = [common::distance(q, r), common::distance(r, p), common::distance(p, q)];
        0.25 * ((a + b + c) * (-a + b + c) * (a - b + c) * (a + b - c)).sqrt()
    };
    mesh.faces().iter().map(heron).collect()
}

/// Targets on the scale of the image: Σ |τ| = A.
fn rescaled(targets: &[f64], area: f64) -> Vec<f64> {
    let total: f64 = targets.iter().sum();
    targets.iter().map(|target| target * area / total).collect()
}

fn largest(values: &[Vector3]) -> f64 {
    values.iter().flat_map(|x| x.0).fold(0.0, |most: f64, x| most.max(x.abs()))
}

/// The derivative of `value` by every coordinate of some vertices, by central differences: (vertex, axis, value).
fn differences(map: &[Vector3], step: f64, value: impl Fn(&[Vector3]) -> f64) -> Vec<(usize, usize, f64)> {
    let sampled = (0..map.len()).step_by(1 + map.len() / 12);
    let derivative = |(v, axis): (usize, usize)| {
        let moved = |h: f64| {
            let mut map = map.to_vec();
            map[v][axis] += h;
            value(&map)
        };
        (v, axis, (moved(step) - moved(-step)) / (2.0 * step))
    };
    sampled.flat_map(|v| (0..3).map(move |axis| (v, axis))).map(derivative).collect()
}

/// 2 L_S f with the weights (f_i − f_k)·(f_j − f_k) / (4|τ|) of each edge ij, summed over dense edges.
fn laplacian_gradient(mesh: &TriangleMesh, map: &[Vector3], targets: &[f64]) -> Vec<Vector3> {
    let mut gradient = vec![Vector3::ZERO; map.len()];
    for (face, target) in mesh.faces().iter().zip(targets) {
        for k in 0..3 {
            let [apex, i, j] = [k, (k + 1) % 3, (k + 2) % 3].map(|corner| face[corner].index());
            let weight = common::closed::dot(difference(map[i], map[apex]), difference(map[j], map[apex]))
                / (4.0 * target);
            let edge = difference(map[i], map[j]);
            (0..3).for_each(|axis| {
                gradient[i][axis] += 2.0 * weight * edge[axis];
                gradient[j][axis] -= 2.0 * weight * edge[axis];
            });
        }
    }
    gradient
}

/// ∇A, from an energy whose targets are the image's own areas: there E_A vanishes to second order.
fn area_gradient(mesh: &TriangleMesh, map: &[Vector3]) -> Vec<Vector3> {
    let own = areas(mesh, map);
    let (value, gradient) = SpatialStretchEnergy::new(mesh, &own).gradient(map);
    assert!(value.authalic_energy < 1e-20 * value.area);
    gradient
}

#[test]
fn the_normalized_energy_is_that_of_the_papers_definition() {
    for mesh in surfaces() {
        let (map, targets) = (some_map(&mesh), some_targets(&mesh));
        let energy = SpatialStretchEnergy::new(&mesh, &targets);
        let (value, own) = (energy.value(&map), areas(&mesh, &map));
        let (area, total): (f64, f64) = (own.iter().sum(), targets.iter().sum());
        let stretch: f64 = own.iter().zip(&targets).map(|(a, target)| a * a / target).sum();
        let scaled = rescaled(&targets, area);
        let authalic: f64 = own.iter().zip(&scaled).map(|(a, target)| (a - target).powi(2) / target).sum();
        assert_relative_eq!(value.area, area, max_relative = 1e-10);
        assert_relative_eq!(value.objective, total / area * stretch, max_relative = 1e-10);
        assert_relative_eq!(value.authalic_energy, authalic, max_relative = 1e-10);
        assert_relative_eq!(value.objective, authalic + area, max_relative = 1e-10);
        let scale_free = energy.scale_free().value(&map);
        assert_relative_eq!(
            scale_free.objective,
            4.0 * PI * total / (area * area) * stretch,
            max_relative = 1e-10
        );
        assert_relative_eq!(scale_free.authalic_energy, authalic, max_relative = 1e-10);
        energy.areas(&map).iter().zip(&own).for_each(|(a, b)| assert_relative_eq!(a, b, max_relative = 1e-6));
    }
}

#[test]
fn the_stretch_energy_is_half_the_quadratic_form_of_the_cotangent_laplacian() {
    for mesh in surfaces() {
        let (map, targets) = (some_map(&mesh), some_targets(&mesh));
        let energy = SpatialStretchEnergy::new(&mesh, &targets);
        let value = energy.value(&map);
        let scaled = rescaled(&targets, value.area);
        let weights = energy.laplacian_weights(&map);
        let mut form = 0.0;
        for (face, corners) in mesh.faces().iter().enumerate() {
            let p = corners.map(|v| map[v]);
            for k in 0..3 {
                // ω = cot θ · a_τ / (2|τ|), the angle by the law of cosines
                let [c, a, b] = [(k + 1, k + 2), (k, k + 1), (k, k + 2)]
                    .map(|(i, j)| common::distance(p[i % 3], p[j % 3]));
                let cosine = (a * a + b * b - c * c) / (2.0 * a * b);
                let area = 0.5 * a * b * (1.0 - cosine * cosine).sqrt();
                let weight = cosine / (1.0 - cosine * cosine).sqrt() * area / (2.0 * scaled[face]);
                assert_relative_eq!(
                    weights[3 * face + k],
                    weight,
                    max_relative = 1e-8,
                    epsilon = 1e-8 * a * b / scaled[face]
                );
                form += 0.5 * weight * c * c;
            }
        }
        assert_relative_eq!(form, value.authalic_energy + value.area, max_relative = 1e-9);
    }
}

#[test]
fn the_gradient_is_that_of_central_differences() {
    for mesh in surfaces() {
        let (map, targets) = (some_map(&mesh), some_targets(&mesh));
        for (profile, scale_free) in
            PROFILES.into_iter().flat_map(|profile| [(profile, false), (profile, true)])
        {
            let energy = SpatialStretchEnergy::new(&mesh, &targets).with_profile(profile);
            let energy = if scale_free { energy.scale_free() } else { energy };
            let (value, gradient) = energy.gradient(&map);
            assert_eq!(value, energy.value(&map));
            for (v, axis, expected) in differences(&map, 1e-6, |map| energy.value(map).objective) {
                let error = (gradient[v][axis] - expected).abs();
                assert!(error < 1e-6 * largest(&gradient) + 1e-8, "{profile:?} vertex {v}: {error}");
            }
        }
    }
}

#[test]
fn the_gradient_is_the_papers_sum_of_the_laplacian_and_the_area() {
    // ∇E = 2 (|M|/A) L_S(f) f − (|M| E_S/A²) ∇A; with |M| = A the factors are 1 and E_S/A
    for mesh in surfaces() {
        let (map, targets) = (some_map(&mesh), some_targets(&mesh));
        let (value, gradient) = SpatialStretchEnergy::new(&mesh, &targets).gradient(&map);
        let stretch = laplacian_gradient(&mesh, &map, &rescaled(&targets, value.area));
        let area = area_gradient(&mesh, &map);
        let share = (value.authalic_energy + value.area) / value.area;
        for (v, axis) in (0..map.len()).flat_map(|v| (0..3).map(move |axis| (v, axis))) {
            let expected = stretch[v][axis] - share * area[v][axis];
            assert!((gradient[v][axis] - expected).abs() < 1e-9 * (largest(&stretch) + largest(&area)));
        }
    }
}

#[test]
fn the_gradient_of_the_area_is_that_of_central_differences() {
    for mesh in surfaces() {
        let map = some_map(&mesh);
        let gradient = area_gradient(&mesh, &map);
        for (v, axis, expected) in differences(&map, 1e-5, |map| areas(&mesh, map).iter().sum()) {
            assert!((gradient[v][axis] - expected).abs() < 1e-6 * largest(&gradient));
        }
    }
}

#[test]
fn the_energy_ignores_motions_and_has_the_degree_of_an_area() {
    for mesh in surfaces() {
        let (map, targets) = (some_map(&mesh), some_targets(&mesh));
        for profile in PROFILES {
            let energy = SpatialStretchEnergy::new(&mesh, &targets).with_profile(profile);
            let (value, gradient) = energy.gradient(&map);
            let turned = |&Vector3([x, y, z]): &Vector3| {
                Vector3([3.0 * (0.6 * y + 0.8 * z) + 2.0, 3.0 * (0.8 * y - 0.6 * z) - 1.0, 3.0 * x])
            };
            let moved: Vec<Vector3> = map.iter().map(turned).collect();
            assert_relative_eq!(energy.value(&moved).objective, 9.0 * value.objective, max_relative = 1e-10);
            // no net force, no torque; Euler's theorem: f·∇E = 2 E
            let scale = gradient.iter().flat_map(|g| g.0).map(|g| g.abs()).sum::<f64>();
            let mut sums = [0.0; 6];
            let mut pressure = 0.0;
            for (x, g) in map.iter().zip(&gradient) {
                for axis in 0..3 {
                    let [i, j] = [(axis + 1) % 3, (axis + 2) % 3];
                    sums[axis] += g[axis];
                    sums[3 + axis] += x[i] * g[j] - x[j] * g[i];
                }
                pressure += common::closed::dot(*x, *g);
            }
            sums.iter().for_each(|sum| assert!(sum.abs() < 1e-11 * scale * largest(&map)));
            assert_relative_eq!(pressure, 2.0 * value.objective, max_relative = 1e-9);
        }
    }
}

#[test]
fn a_planar_map_in_a_plane_of_space_has_the_planar_energies() {
    for mesh in common::disks().iter().map(common::TestMesh::mesh) {
        let plane: Vec<[f64; 2]> = mesh.points().iter().map(|p| [p[0] + 0.3 * p[1], 1.7 * p[1]]).collect();
        let space: Vec<Vector3> = plane.iter().map(|&[x, y]| Vector3([x, 0.6 * y, 0.8 * y])).collect();
        let targets = some_targets(&mesh);
        let planar = StretchEnergy::new(&mesh, &targets);
        if !planar.areas(&plane).iter().all(|&area| area > 0.0) {
            continue; // unsigned areas differ from signed ones
        }
        let spatial = SpatialStretchEnergy::new(&mesh, &targets);
        let (flat, flat_gradient) = planar.gradient(&plane);
        let (value, gradient) = spatial.gradient(&space);
        assert_relative_eq!(value.area, flat.area, max_relative = 1e-12);
        assert_relative_eq!(value.authalic_energy, flat.authalic_energy, max_relative = 1e-12);
        let weights = planar.laplacian_weights(&plane);
        let scale = weights.iter().fold(0.0f64, |most, w| most.max(w.abs()));
        for (a, b) in spatial.laplacian_weights(&space).iter().zip(&weights) {
            assert!((a - b).abs() < 1e-13 * scale);
        }
        // π E_A/A there, E_A + A here: ∇(E_A + A) = (A/π) ∇(π E_A/A) + (E_A/A + 1) ∇A
        let area = area_gradient(&mesh, &space);
        let share = flat.authalic_energy / flat.area + 1.0;
        for (v, g) in gradient.iter().enumerate() {
            let [x, y] = flat_gradient[v].map(|g| flat.area / PI * g);
            let expected = [x, 0.6 * y, 0.8 * y];
            for axis in 0..3 {
                let error = (g[axis] - expected[axis] - share * area[v][axis]).abs();
                assert!(error < 1e-11 * (largest(&gradient) + largest(&area)));
            }
        }
    }
}

/// A sparse matrix of the Hessian times a vector field.
fn times(hessian: &CsMat<f64>, field: &[Vector3]) -> Vec<Vector3> {
    let n = field.len();
    let mut product = vec![Vector3::ZERO; n];
    for (value, (row, column)) in hessian.iter() {
        product[row % n][row / n] += value * field[column % n][column / n];
    }
    product
}

/// The map and the Hessian there, with the targets on the scale of its area.
fn hessians() -> impl Iterator<Item = (TriangleMesh, Vec<Vector3>, Vec<f64>, CsMat<f64>)> {
    surfaces().into_iter().filter(|mesh| mesh.n_vertices() < 200).map(|mesh| {
        let (map, targets) = (some_map(&mesh), some_targets(&mesh));
        let energy = SpatialStretchEnergy::new(&mesh, &targets);
        let (scaled, hessian) = (rescaled(&targets, energy.value(&map).area), energy.hessian(&map));
        (mesh, map, scaled, hessian)
    })
}

#[test]
fn the_hessian_is_symmetric_and_couples_neighbors_only() {
    for (mesh, map, _, hessian) in hessians() {
        let n = map.len();
        assert_eq!((hessian.rows(), hessian.cols()), (3 * n, 3 * n));
        let scale = hessian.data().iter().fold(0.0f64, |most, x| most.max(x.abs()));
        for (value, (row, column)) in hessian.iter() {
            let mirrored = hessian.get(column, row).expect("a symmetric pattern");
            assert!((value - mirrored).abs() < 1e-13 * scale);
            let [a, b] = [row % n, column % n].map(Vertex::new);
            assert!(mesh.faces().iter().any(|face| face.contains(&a) && face.contains(&b)));
        }
    }
}

#[test]
fn the_hessian_is_that_of_central_differences_of_the_gradient() {
    for (mesh, map, targets, hessian) in hessians() {
        let field: Vec<Vector3> =
            (0..map.len()).map(|v| Vector3::from_fn(|axis| ((3 * v + axis) as f64 * 1.7).sin())).collect();
        let gradient = |h: f64| {
            let moved: Vec<Vector3> =
                map.iter().zip(&field).map(|(x, d)| Vector3::from_fn(|axis| x[axis] + h * d[axis])).collect();
            laplacian_gradient(&mesh, &moved, &targets)
        };
        // along a line the gradient is a cubic, of which this quotient of four values is the exact slope
        let [far_behind, behind, ahead, far_ahead] = [-0.2, -0.1, 0.1, 0.2].map(gradient);
        let product = times(&hessian, &field);
        for (v, axis) in (0..map.len()).flat_map(|v| (0..3).map(move |axis| (v, axis))) {
            let [near, far] = [ahead[v][axis] - behind[v][axis], far_ahead[v][axis] - far_behind[v][axis]];
            let expected = (8.0 * near - far) / 1.2;
            assert!((product[v][axis] - expected).abs() < 1e-11 * largest(&ahead), "vertex {v}");
        }
    }
}

#[test]
fn the_hessian_has_the_kernel_and_the_products_that_the_energy_implies() {
    for (mesh, map, targets, hessian) in hessians() {
        let gradient = laplacian_gradient(&mesh, &map, &targets);
        let scale = hessian.data().iter().fold(0.0f64, |most, x| most.max(x.abs())) * largest(&map);
        let assert_same = |a: &[Vector3], b: &[Vector3]| {
            let pairs = a.iter().flat_map(|x| x.0).zip(b.iter().flat_map(|x| x.0));
            pairs.for_each(|(a, b)| assert!((a - b).abs() < 1e-11 * scale, "{a} {b}"));
        };
        for axis in 0..3 {
            // translations cost nothing: H 1 = 0
            let mut shift = Vector3::ZERO;
            shift[axis] = 1.0;
            assert_same(&times(&hessian, &vec![shift; map.len()]), &vec![Vector3::ZERO; map.len()]);
            // ∇E_S turns with the map: H (ω × f) = ω × ∇E_S
            let turned = |x: &Vector3| {
                let [i, j] = [(axis + 1) % 3, (axis + 2) % 3];
                let mut out = Vector3::ZERO;
                (out[i], out[j]) = (-x[j], x[i]);
                out
            };
            let [spun, expected] =
                [&map, &gradient].map(|field| field.iter().map(turned).collect::<Vec<_>>());
            assert_same(&times(&hessian, &spun), &expected);
        }
        // E_S has degree 4: H f = 3 ∇E_S
        let tripled: Vec<Vector3> = gradient.iter().map(|g| g.map(|x| 3.0 * x)).collect();
        assert_same(&times(&hessian, &map), &tripled);
    }
}
