// SPDX-License-Identifier: MIT OR Apache-2.0
//! The stretch energy against independent formulas: finite differences, the assembled Laplacian, invariances.

use crate::common;
use approx::assert_relative_eq;
use authalic::Vertex;
use authalic::testing::{Laplacian, Profile, StretchEnergy, TriangleMesh};
use std::f64::consts::PI;

/// A smooth unfolded map of a mesh into the plane, different for every mesh.
fn some_map(mesh: &TriangleMesh) -> Vec<[f64; 2]> {
    let wave = |v: usize, k: f64| 0.05 * (k * v as f64).sin() / mesh.n_vertices() as f64;
    mesh.points()
        .iter()
        .enumerate()
        .map(|(v, p)| [p[0] + 0.3 * p[1] + wave(v, 1.0), 1.7 * p[1] + wave(v, 2.0)])
        .collect()
}

/// Targets that differ from the areas.
fn some_targets(mesh: &TriangleMesh) -> Vec<f64> {
    mesh.face_areas().iter().enumerate().map(|(face, area)| area * (1.5 + (face as f64).sin())).collect()
}

fn flat_disks() -> Vec<TriangleMesh> {
    common::disks().iter().map(|disk| disk.mesh()).filter(|mesh| positive(mesh, &some_map(mesh))).collect()
}

fn positive(mesh: &TriangleMesh, map: &[[f64; 2]]) -> bool {
    let energy = StretchEnergy::new(mesh, mesh.face_areas());
    energy.areas(map).iter().all(|&area| area > 0.0)
}

#[test]
fn there_are_meshes_to_test_on() {
    assert!(flat_disks().len() >= 3);
}

#[test]
fn the_gradient_is_that_of_central_differences() {
    for mesh in flat_disks() {
        let targets = some_targets(&mesh);
        for profile in [Profile::Stretch, Profile::Barrier] {
            let energy = StretchEnergy::new(&mesh, &targets).with_profile(profile);
            let map = some_map(&mesh);
            let (value, gradient) = energy.gradient(&map);
            assert_eq!(value, energy.value(&map));
            let scale = gradient.iter().flatten().fold(0.0, |most: f64, g| most.max(g.abs()));
            for v in (0..map.len()).step_by(1 + map.len() / 20) {
                for axis in 0..2 {
                    let moved = |h: f64| {
                        let mut map = map.clone();
                        map[v][axis] += h;
                        energy.value(&map).objective
                    };
                    let difference = (moved(1e-6) - moved(-1e-6)) / 2e-6;
                    assert!(
                        (gradient[v][axis] - difference).abs() < 1e-5 * scale + 1e-9,
                        "{profile:?} vertex {v}"
                    );
                }
            }
        }
    }
}

#[test]
fn the_energy_is_half_the_quadratic_form_of_the_cotangent_laplacian() {
    for mesh in flat_disks() {
        let (map, targets) = (some_map(&mesh), some_targets(&mesh));
        let value = StretchEnergy::new(&mesh, &targets).value(&map);
        // ½ Σ ω |f_i − f_j|² with ω = cot θ |f(τ)| / (2|τ|), targets rescaled to the image's area: equation
        // (2.1c)
        let scale = value.area / targets.iter().sum::<f64>();
        let mut stretch = 0.0;
        for (face, target) in mesh.faces().iter().zip(&targets) {
            let p = face.map(|v| map[v]);
            for k in 0..3 {
                let (apex, a, b) = (p[k], p[(k + 1) % 3], p[(k + 2) % 3]);
                let [u, w] = [[a[0] - apex[0], a[1] - apex[1]], [b[0] - apex[0], b[1] - apex[1]]];
                let angle = w[1].atan2(w[0]) - u[1].atan2(u[0]);
                let area = 0.5 * (u[0] * w[1] - u[1] * w[0]);
                let length2 = (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2);
                stretch += 0.5 * length2 * area / (angle.tan() * 2.0 * scale * target);
            }
        }
        assert_relative_eq!(stretch - value.area, value.authalic_energy, max_relative = 1e-8);
        assert_relative_eq!(value.objective, value.authalic_energy * PI / value.area, max_relative = 1e-14);
    }
}

#[test]
fn the_gradient_is_twice_the_laplacian_of_the_map_inside() {
    for mesh in flat_disks() {
        let (map, targets) = (some_map(&mesh), some_targets(&mesh));
        let energy = StretchEnergy::new(&mesh, &targets);
        let (value, gradient) = energy.gradient(&map);
        let laplacian = Laplacian::new(&mesh, |v| !mesh.is_boundary(v));
        let residual = laplacian.residual(&mesh, &energy.laplacian_weights(&map), &map);
        let n = laplacian.free().len();
        for (i, &v) in laplacian.free().iter().enumerate() {
            for axis in 0..2 {
                let expected = 2.0 * PI / value.area * residual[axis * n + i];
                assert_relative_eq!(gradient[v][axis], expected, epsilon = 1e-9, max_relative = 1e-7);
            }
        }
    }
}

#[test]
fn the_objective_ignores_scale_rotation_and_translation() {
    for mesh in flat_disks() {
        let targets = some_targets(&mesh);
        let energy = StretchEnergy::new(&mesh, &targets);
        let map = some_map(&mesh);
        let (value, gradient) = energy.gradient(&map);
        let (sine, cosine) = 0.7f64.sin_cos();
        let turned: Vec<_> = map
            .iter()
            .map(|[x, y]| [3.0 * (cosine * x - sine * y) + 5.0, 3.0 * (sine * x + cosine * y) - 2.0])
            .collect();
        assert_relative_eq!(energy.value(&turned).objective, value.objective, max_relative = 1e-9);
        // the same as identities of the gradient: no net force, no torque, no pressure
        let sums =
            map.iter().zip(&gradient).fold([0.0; 4], |[fx, fy, torque, pressure], ([x, y], [gx, gy])| {
                [fx + gx, fy + gy, torque + x * gy - y * gx, pressure + x * gx + y * gy]
            });
        let scale = gradient.iter().flatten().map(|g| g.abs()).sum::<f64>();
        sums.iter().for_each(|sum| assert!(sum.abs() < 1e-12 * scale + 1e-12));
    }
}

#[test]
fn an_area_preserving_map_has_no_energy_and_no_gradient() {
    for mesh in flat_disks() {
        let map = some_map(&mesh);
        let own = StretchEnergy::new(&mesh, mesh.face_areas()).areas(&map);
        let energy = StretchEnergy::new(&mesh, &own);
        let (value, gradient) = energy.gradient(&map);
        assert!(value.authalic_energy.abs() < 1e-25 * value.area);
        gradient.iter().flatten().for_each(|g| assert!(g.abs() < 1e-12));
    }
}

#[test]
fn the_assembled_laplacian_is_that_of_its_edges() {
    for disk in common::disks() {
        let mesh = disk.mesh();
        let weights: Vec<f64> = (0..3 * mesh.n_faces()).map(|corner| 1.0 + (corner as f64).sin()).collect();
        let mut laplacian = Laplacian::new(&mesh, |v| v.index() % 3 != 0);
        laplacian.assemble(&mesh, &weights);
        // dense, edge by edge
        let n = mesh.n_vertices();
        let mut dense = vec![0.0; n * n];
        for (corner, weight) in weights.iter().enumerate() {
            let face = mesh.faces()[corner / 3];
            let [i, j] = [1, 2].map(|step| (face[(corner + step) % 3]).index());
            for (r, c, sign) in [(i, i, 1.0), (j, j, 1.0), (i, j, -1.0), (j, i, -1.0)] {
                dense[r * n + c] += sign * weight;
            }
        }
        let mut stored = 0;
        for (value, (row, column)) in laplacian.matrix().iter() {
            let [r, c] = [row, column].map(|i| laplacian.free()[i].index());
            assert!(row <= column, "upper triangle");
            assert_relative_eq!(*value, dense[r * n + c], epsilon = 1e-12);
            stored += 1;
        }
        let free: Vec<usize> = laplacian.free().iter().copied().map(Vertex::index).collect();
        let nonzero = free.iter().flat_map(|&r| free.iter().map(move |&c| (r, c)));
        assert_eq!(stored, nonzero.filter(|&(r, c)| r <= c && (r == c || dense[r * n + c] != 0.0)).count());
        assert!(free.iter().enumerate().all(|(i, &v)| laplacian.unknown(Vertex::new(v)) == Some(i)));
    }
}
