// SPDX-License-Identifier: MIT OR Apache-2.0
use super::*;
use crate::codomain::motion::{Motion, frames};
use crate::mesh::{Corner, Vertex};
use crate::vector::coordinates;

const FACES: [[u32; 3]; 4] = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]];
const COMPOSITE: Hessian = Hessian { damping: 0.0, least: 0.0, curvature: 0.0 };
const EXACT: Hessian = Hessian { damping: 0.0, least: 0.0, curvature: 1.0 };
const WEIGHTS: Weights = Weights { scale: 0.9, angle: 0.4, profile: Profile::Barrier };

/// A tetrahedron with its image on the sphere.
fn closed() -> (TriangleMesh, Vec<Motion>, Vec<Vector3>) {
    let corners = [[1., 1., 1.], [1.2, -1., -1.], [-1., 0.8, -1.], [-1., -1., 1.1]];
    let mesh = TriangleMesh::new(&corners, &FACES).unwrap();
    let image = [[0.6, 0.7, 0.9], [0.9, -1., -0.5], [-1., 1., -1.1], [-0.3, -1., 1.]];
    let image = image.map(Vector3).map(|x| x.normalized()).to_vec();
    (mesh, vec![Motion::Sphere; 4], image)
}

/// A pyramid without its base, with its image in the disk.
fn open() -> (TriangleMesh, Vec<Motion>, Vec<Vector3>) {
    let corners = [[0., 0., 1.], [1.3, 0., 0.], [0., 1., 0.2], [-1., -0.5, 0.]];
    let mesh = TriangleMesh::new(&corners, &FACES[..3]).unwrap();
    let on_circle = |angle: f64| Vector3([angle.cos(), angle.sin(), 1.0]);
    let image = vec![Vector3([0.2, -0.1, 1.0]), on_circle(0.3), on_circle(1.5), on_circle(4.0)];
    let motions = vec![Motion::Plane, Motion::Circle, Motion::Held, Motion::Circle];
    (mesh, motions, image)
}

fn moved(motions: &[Motion], map: &[Vector3], direction: &[[f64; 2]], step: f64) -> Vec<Vector3> {
    let frames = frames(motions, map);
    (0..map.len()).map(|v| motions[v].moved(map[v], &frames[v], direction[v].map(|d| step * d))).collect()
}

fn directions(n: usize) -> Vec<[f64; 2]> {
    (0..n).map(|v| [(1.0 + 3.0 * v as f64).sin(), (2.0 + 5.0 * v as f64).cos()]).collect()
}

#[test]
fn gradient_and_exact_hessian_are_the_differences_of_the_value() {
    for ((mesh, motions, map), codomain) in [(closed(), Codomain::Sphere), (open(), Codomain::Disk)] {
        let energy =
            AuthalicEnergy::new(&mesh, vec![0.3, 0.5, 0.4, 0.6][..mesh.n_faces()].into(), codomain, 0.0);
        let frames = frames(&motions, &map);
        let direction = directions(map.len());
        let value =
            |step: f64| energy.value(&energy.costs(&moved(&motions, &map, &direction, step)), &WEIGHTS);
        let gradient = energy.gradient(&map, &frames, &WEIGHTS);
        let along = |v: usize| gradient[v][0] * direction[v][0] + gradient[v][1] * direction[v][1];
        let slope: f64 = (0..map.len()).map(along).sum();
        let (h, there, back) = (1e-4, value(1e-4), value(-1e-4));
        assert!(value(0.0).is_finite());
        assert!((slope - (there - back) / (2.0 * h)).abs() < 1e-6 * (1.0 + slope.abs()));
        let mut curvature = 0.0;
        for face in 0..mesh.n_faces() {
            let element = energy.element(&map, &frames, &WEIGHTS, &EXACT, face);
            // a vertex that cannot leave a direction has no frame there
            let d: Vec<f64> = mesh.faces()[face].iter().flat_map(|&v| direction[v]).collect();
            curvature += (0..36).map(|k| d[k / 6] * element[k / 6][k % 6] * d[k % 6]).sum::<f64>();
        }
        let difference = (there + back - 2.0 * value(0.0)) / (h * h);
        let missing: f64 =
            (0..map.len()).map(|v| missing_pull(&energy, &map, &frames, &motions, &direction, v)).sum();
        assert!(
            (curvature + missing - difference).abs() < 1e-5 * (1.0 + difference.abs()),
            "{curvature} {difference}"
        );
    }
}

/// The diagonal entry of an unknown that does not exist, which its element carries all the same.
fn missing_pull(
    energy: &AuthalicEnergy,
    map: &[Vector3],
    frames: &[Frame],
    motions: &[Motion],
    direction: &[[f64; 2]],
    vertex: usize,
) -> f64 {
    if motions[vertex] != Motion::Circle {
        return 0.0;
    }
    let of_corner = |&corner: &Corner| {
        let (face, c) = (corner.face().index(), corner.place());
        let corners = energy.triangle(map, face);
        let outer = energy.outer(&corners, face, &WEIGHTS);
        corners.slope_in_space(&outer, energy.cotangents[face], c).dot(frames[vertex].outward)
    };
    direction[vertex][1].powi(2) * energy.corners.of(Vertex::new(vertex)).iter().map(of_corner).sum::<f64>()
}

/// dᵀ H d of a map of the plane, without damping.
fn curvature_along(
    energy: &AuthalicEnergy,
    map: &[Vector3],
    direction: &[[f64; 2]],
    weights: &Weights,
) -> f64 {
    let frames = frames(&vec![Motion::Plane; map.len()], map);
    let of_face = |face: usize| {
        let element = energy.element(map, &frames, weights, &COMPOSITE, face);
        let d: Vec<f64> = energy.faces[face].iter().flat_map(|&v| direction[v]).collect();
        (0..36).map(|k| d[k / 6] * element[k / 6][k % 6] * d[k % 6]).sum::<f64>()
    };
    (0..energy.faces.len()).map(of_face).sum()
}

#[test]
fn the_hessian_of_an_isometry_is_exact_and_turning_it_costs_nothing() {
    let (mesh, _, map) = open();
    let flat = TriangleMesh::new(&coordinates(map.clone()), mesh.faces()).unwrap();
    let energy = AuthalicEnergy::new(&flat, flat.face_areas().to_vec(), Codomain::Plane, 0.0);
    let total = |areas: &[f64]| areas.iter().sum::<f64>();
    let scale = total(&energy.areas(&map)) / total(energy.targets());
    let weights = Weights { scale, ..WEIGHTS };
    let motions = vec![Motion::Plane; map.len()];
    let direction = directions(map.len());
    let value = |step: f64| energy.value(&energy.costs(&moved(&motions, &map, &direction, step)), &weights);
    let h = 1e-4;
    let difference = (value(h) + value(-h) - 2.0 * value(0.0)) / (h * h);
    let curvature = curvature_along(&energy, &map, &direction, &weights);
    assert!((curvature - difference).abs() < 1e-5 * difference, "{curvature} {difference}");
    let turning: Vec<[f64; 2]> = map.iter().map(|x| [-x[1], x[0]]).collect();
    assert!(curvature_along(&energy, &map, &turning, &weights).abs() < 1e-10);
}

#[test]
fn the_hessian_of_a_face_is_never_negative() {
    for ((mesh, motions, map), codomain) in [(closed(), Codomain::Sphere), (open(), Codomain::Disk)] {
        let energy =
            AuthalicEnergy::new(&mesh, vec![0.3, 0.5, 0.4, 0.6][..mesh.n_faces()].into(), codomain, 0.0);
        let frames = frames(&motions, &map);
        for (face, seed) in (0..mesh.n_faces()).flat_map(|face| (0..200).map(move |seed| (face, seed))) {
            let element = energy.element(&map, &frames, &WEIGHTS, &COMPOSITE, face);
            let d: [f64; 6] = std::array::from_fn(|k| (1.7 * f64::from(seed) + (k * k) as f64).sin());
            let along: f64 = (0..36).map(|k| d[k / 6] * element[k / 6][k % 6] * d[k % 6]).sum();
            let size: f64 = (0..36).map(|k| (d[k / 6] * element[k / 6][k % 6] * d[k % 6]).abs()).sum();
            assert!(along > -1e-14 * size, "{face} {along}");
        }
    }
}

#[test]
fn in_the_plane_the_energy_is_made_of_area_ratios_and_singular_values() {
    let (mesh, _, map) = open();
    let targets = vec![0.3, 0.5, 0.4];
    let energy = AuthalicEnergy::new(&mesh, targets.clone(), Codomain::Disk, 0.0);
    let flat: Vec<[f64; 2]> = map.iter().map(|x| [x[0], x[1]]).collect();
    let image = crate::distortion::Image::Plane(&flat);
    let figures = crate::distortion::measure(mesh.points(), mesh.faces(), image, &targets).unwrap();
    let mut expected = 0.0;
    for (face, target) in targets.iter().enumerate() {
        let target = WEIGHTS.scale * target;
        let (ratio, sigma) = (energy.areas(&map)[face] / target, figures.angle_distortion[face]);
        let excess = 0.5 * (sigma + 1.0 / sigma) - 1.0;
        expected += target * 0.5 * (ratio - 1.0).powi(2) * (1.0 + 1.0 / ratio);
        expected += WEIGHTS.angle * target * (excess + 0.05 * excess * excess);
    }
    let value = energy.value(&energy.costs(&map), &WEIGHTS);
    assert!((value - expected).abs() < 1e-12 * expected, "{value} {expected}");
    assert!((energy.sums(&energy.costs(&map)).authalic_energy - figures.authalic_energy).abs() < 1e-12);
}

#[test]
fn the_second_order_correction_carries_back_what_areas_miss_of_their_prediction() {
    for ((mesh, motions, map), codomain) in [(closed(), Codomain::Sphere), (open(), Codomain::Disk)] {
        let targets = vec![0.3, 0.5, 0.4, 0.6][..mesh.n_faces()].to_vec();
        let energy = AuthalicEnergy::new(&mesh, targets.clone(), codomain, 0.0);
        let frames = frames(&motions, &map);
        let mut direction = directions(map.len());
        direction.iter_mut().for_each(|d| *d = d.map(|c| 0.1 * c));
        let after = moved(&motions, &map, &direction, 1.0);
        // areas along one unknown, by differences
        let slopes = |along: &[[f64; 2]]| -> Vec<f64> {
            let at = |step: f64| energy.areas(&moved(&motions, &map, along, step));
            at(1e-6).iter().zip(at(-1e-6)).map(|(there, back)| (there - back) / 2e-6).collect()
        };
        let (before, beyond, predicted) = (energy.areas(&map), energy.areas(&after), slopes(&direction));
        let correction = energy.curvature(&map, &after, &frames, &direction, &WEIGHTS);
        for vertex in 0..map.len() {
            for axis in 0..2 {
                let mut unit = vec![[0.0; 2]; map.len()];
                unit[vertex][axis] = 1.0;
                let expected: f64 = slopes(&unit)
                    .iter()
                    .enumerate()
                    .map(|(face, slope)| {
                        let target = WEIGHTS.scale * targets[face];
                        let stiffness = (1.0 + (before[face] / target).powi(-3)) / target;
                        -stiffness * (beyond[face] - before[face] - predicted[face]) * slope
                    })
                    .sum();
                assert!((correction[vertex][axis] - expected).abs() < 1e-7, "{vertex} {axis}");
            }
        }
    }
}

#[test]
fn a_folded_face_is_infinitely_expensive() {
    let (mesh, _, mut map) = open();
    let energy = AuthalicEnergy::new(&mesh, vec![1.0; 3], Codomain::Disk, 0.0);
    map[0] = Vector3([0.9, -0.9, 1.0]);
    assert_eq!(energy.value(&energy.costs(&map), &WEIGHTS), f64::INFINITY);
    assert_eq!(energy.sums(&energy.costs(&map)).angle_energy, f64::INFINITY);
}

#[test]
fn flat_rest_triangles_count_as_a_little_fatter() {
    let right = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]].map(Vector3);
    assert!((0..3).all(|k| (rest_cotangents(right, 1e-3)[k] - [0., 1., 1.][k]).abs() < 1e-15));
    let sliver = [[0., 0., 0.], [1., 0., 0.], [0.5, 1e-9, 0.]].map(Vector3);
    assert!((rest_cotangents(sliver, 0.01)[0] - 50.0).abs() < 1e-9);
}
