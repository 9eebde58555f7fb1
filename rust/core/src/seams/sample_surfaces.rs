// SPDX-License-Identifier: MIT OR Apache-2.0
//! Surfaces of several topologies, for tests.

use std::collections::BTreeMap;

use crate::mesh::geometry::triangle;
use crate::mesh::{TriangleMesh, Vertex, faces_of_indices};
use crate::vector::{Vector3, coordinates};

/// The mesh of a grid of `columns` × `rows` quads, each split in two unless `is_hole`, bent by `place`. Opposite sides are
/// one where the grid `closes`.
fn grid(
    [columns, rows]: [u32; 2],
    closes: [bool; 2],
    is_hole: impl Fn(u32, u32) -> bool,
    place: impl Fn(f64, f64) -> [f64; 3],
) -> TriangleMesh {
    let sizes = [columns + u32::from(!closes[0]), rows + u32::from(!closes[1])];
    let vertex = |i: u32, j: u32| (j % sizes[1]) * sizes[0] + i % sizes[0];
    let quads = (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j))).filter(|&(i, j)| !is_hole(i, j));
    let faces: Vec<[u32; 3]> = quads
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)];
            [[a, b, c], [a, c, d]]
        })
        .collect();
    let at = |k: u32| {
        place(f64::from(k % sizes[0]) / f64::from(columns), f64::from(k / sizes[0]) / f64::from(rows))
    };
    let points: Vec<[f64; 3]> = (0..sizes[0] * sizes[1]).map(at).collect();
    TriangleMesh::new(&points, &faces).unwrap()
}

/// A torus of 60 × 36 vertices.
pub(super) fn torus() -> TriangleMesh {
    grid(
        [60, 36],
        [true, true],
        |_, _| false,
        |u, v| {
            let [u, v] = [u, v].map(|t| t * std::f64::consts::TAU);
            let radius = 2.0 + 0.8 * v.cos();
            [radius * u.cos(), radius * u.sin(), 0.8 * v.sin()]
        },
    )
}

/// An open cylinder with eight holes of one quad or of three: ten boundary loops.
pub(super) fn perforated_cylinder() -> TriangleMesh {
    let is_hole = |i: u32, j: u32| match j {
        10 => i % 15 == 3,
        24 => i % 15 < 3,
        _ => false,
    };
    grid([60, 40], [true, false], is_hole, |u, v| {
        let angle = u * std::f64::consts::TAU;
        [angle.cos(), angle.sin(), 4.0 * v]
    })
}

/// A cup: half of a slender ellipsoid, open at the top; its bottom is vertex 0 … 39.
pub(super) fn cup() -> TriangleMesh {
    grid(
        [40, 30],
        [true, false],
        |_, _| false,
        |u, v| {
            let (turn, height) = (u * std::f64::consts::TAU, (0.02 + 0.98 * v) * std::f64::consts::FRAC_PI_2);
            // seen from inside
            [0.5 * height.sin() * turn.sin(), 0.5 * height.sin() * turn.cos(), -3.0 * height.cos()]
        },
    )
}

/// The surface of a plate of cubes with three holes, genus 3: 64 vertices.
pub(super) fn plate_with_three_holes() -> TriangleMesh {
    plate_with_holes(3)
}

/// The surface of a plate of cubes with holes, one for each handle.
pub(super) fn plate_with_holes(n: i32) -> TriangleMesh {
    surface_of_cubes([2 * n + 1, 3, 1], |[x, y, _]| y == 1 && x % 2 == 1)
}

/// A cube of `n`³ unit cubes.
pub(super) fn cube(n: i32) -> TriangleMesh {
    surface_of_cubes([n; 3], |_| false)
}

/// The surface of a box of unit cubes without those that are missing.
fn surface_of_cubes([nx, ny, nz]: [i32; 3], is_missing: impl Fn([i32; 3]) -> bool) -> TriangleMesh {
    let is_solid = |cube: [i32; 3]| {
        cube.iter().zip([nx, ny, nz]).all(|(&k, n)| (0..n).contains(&k)) && !is_missing(cube)
    };
    let places = (0..nx).flat_map(|x| (0..ny).flat_map(move |y| (0..nz).map(move |z| [x, y, z])));
    let mut numbers = BTreeMap::new();
    let mut points = Vec::new();
    let mut faces = Vec::new();
    for cube in places.filter(|&cube| is_solid(cube)) {
        for (axis, side) in (0..3).flat_map(|axis| [(axis, 0), (axis, 1)]) {
            let mut neighbor = cube;
            neighbor[axis] += 2 * side - 1;
            if is_solid(neighbor) {
                continue;
            }
            let corners = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[s, t]| {
                let mut corner = cube;
                corner[axis] += side;
                corner[(axis + 1) % 3] += s;
                corner[(axis + 2) % 3] += t;
                *numbers.entry(corner).or_insert_with(|| {
                    points.push(corner.map(f64::from));
                    points.len() as u32 - 1
                })
            });
            let [a, b, c, d] = corners;
            faces.extend(if side == 1 { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] });
        }
    }
    TriangleMesh::new(&points, &faces).unwrap()
}

/// A flat grid of `columns` × `rows` unit quads; vertex `j * (columns + 1) + i` lies at (i, j).
pub(super) fn flat_grid(columns: u32, rows: u32) -> TriangleMesh {
    let place = |u, v| [f64::from(columns) * u, f64::from(rows) * v, 0.0];
    grid([columns, rows], [false, false], |_, _| false, place)
}

/// A disk of `n` rings around a vertex, ring k of 6 k vertices, bent by `place(radius, angle)`, the radius up to 1.
pub(super) fn rings(n: usize, place: impl Fn(f64, f64) -> [f64; 3]) -> TriangleMesh {
    let mut points = vec![place(0.0, 0.0)];
    let mut faces = Vec::new();
    let number = |ring: usize, k: usize| match ring {
        0 => 0,
        _ => (1 + 3 * ring * (ring - 1) + k % (6 * ring)) as u32,
    };
    for ring in 1..=n {
        let angle = |k: usize| std::f64::consts::TAU * k as f64 / (6 * ring) as f64;
        points.extend((0..6 * ring).map(|k| place(ring as f64 / n as f64, angle(k))));
        for (sector, k) in (0..6).flat_map(|sector| (0..ring).map(move |k| (sector, k))) {
            let outer = number(ring, sector * ring + k);
            let next_outer = number(ring, sector * ring + k + 1);
            let inner = number(ring - 1, sector * (ring - 1) + k);
            faces.push([inner, outer, next_outer]);
            if k + 1 < ring {
                faces.push([inner, next_outer, number(ring - 1, sector * (ring - 1) + k + 1)]);
            }
        }
    }
    TriangleMesh::new(&points, &faces).unwrap()
}

/// A sphere of 8 · 4^level faces; `place` moves its points.
fn bent_sphere(level: u32, place: impl Fn(usize, Vector3) -> Vector3) -> TriangleMesh {
    let [x, y, z] = [0, 1, 2].map(Vector3::unit);
    let mut points = vec![x, y, -x, -y, z, -z];
    let quarters = (0..4).flat_map(|i| [[i, (i + 1) % 4, 4], [(i + 1) % 4, i, 5]]);
    let mut faces = faces_of_indices(&quarters.collect::<Vec<_>>());
    for _ in 0..level {
        let mut middles = BTreeMap::new();
        let mut middle = |a: Vertex, b: Vertex| {
            *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                points.push((points[a] + points[b]).normalized());
                Vertex::new(points.len() - 1)
            })
        };
        let split = |&[a, b, c]: &[Vertex; 3]| {
            let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        faces = faces.iter().flat_map(split).collect();
    }
    let points = points.iter().enumerate().map(|(k, &point)| place(k, point));
    TriangleMesh::new(&coordinates(points), &faces).unwrap()
}

/// A sphere of 8 · 4^level faces.
pub(super) fn sphere(level: u32) -> TriangleMesh {
    bent_sphere(level, |_, x| x)
}

/// A body with a nose and two ears that is its own mirror image under x ↦ −x; so is its triangulation.
pub(super) fn body(level: u32) -> TriangleMesh {
    bent_sphere(level, |_, x| on_body(x))
}

/// The body in a triangulation that is not symmetric.
pub(super) fn uneven_body(level: u32) -> TriangleMesh {
    let size = 0.3 * 0.5f64.powi(level as i32);
    bent_sphere(level, |k, x| {
        let wave = [0.0, 1.0, 2.0].map(|phase| size * (1.7 * k as f64 + phase).sin());
        on_body((x + Vector3(wave)).normalized())
    })
}

/// The point of the body in a direction.
fn on_body(x: Vector3) -> Vector3 {
    let bump = |middle: [f64; 3], height: f64| {
        height * (-12.0 * (x - Vector3(middle).normalized()).dot(x - Vector3(middle).normalized())).exp()
    };
    let ears = bump([0.7, 0.5, 0.6], 0.5) + bump([-0.7, 0.5, 0.6], 0.5);
    let radius = 1.0 + 0.2 * x[1] + 0.1 * x[2] * x[1] + bump([0.0, 1.0, -0.2], 0.4) + ears;
    Vector3([1.1 * x[0], 1.3 * x[1], 0.9 * x[2]]) * radius
}

/// The greatest distance of `points` from a mesh.
pub(super) fn greatest_distance(points: &[Vector3], mesh: &TriangleMesh) -> f64 {
    let distance = |x: Vector3| {
        let faces = mesh.faces().iter().map(|&face| squared_distance(x, triangle(mesh.points(), face)));
        faces.fold(f64::INFINITY, f64::min).sqrt()
    };
    points.iter().map(|&x| distance(x)).fold(0.0, f64::max)
}

/// The squared distance of a point from a triangle: from its plane above it, else from its edges.
fn squared_distance(x: Vector3, [a, b, c]: [Vector3; 3]) -> f64 {
    let normal = (b - a).cross(c - a).normalized();
    let edges = [(a, b), (b, c), (c, a)];
    if edges.iter().all(|&(p, q)| (q - p).cross(x - p).dot(normal) >= 0.0) {
        return (x - a).dot(normal).powi(2);
    }
    let from_edge = |(p, q): (Vector3, Vector3)| {
        let t = ((x - p).dot(q - p) / (q - p).dot(q - p)).clamp(0.0, 1.0);
        let away = x - (p + (q - p) * t);
        away.dot(away)
    };
    edges.into_iter().map(from_edge).fold(f64::INFINITY, f64::min)
}

/// Number of components, Euler characteristic and number of boundary loops.
pub(super) fn topology(mesh: &TriangleMesh) -> (usize, i64, usize) {
    (mesh.n_components(), mesh.euler_characteristic(), mesh.boundary_loops().len())
}

/// Numbers in [0, 1) that look random, one after another from a seed.
pub(super) fn random_numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        // Knuth's MMIX generator
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    }
}
