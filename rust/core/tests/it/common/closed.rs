// SPDX-License-Identifier: MIT OR Apache-2.0
//! Closed surfaces without handles, and what a one-to-one map of one onto the sphere is, by other formulas
//! than the library's.

use super::public::sphere_map;
use authalic::testing::TriangleMesh;
use authalic::{Error, LineSearch, Silent, SphereMap, SphereMapOptions, SphereMethod, Vertex};
use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

use super::{Coordinates, TestMesh, determinant, distance, ellipsoid, icosphere, known, lattice};

type Point = [f64; 3];

pub const METHODS: [SphereMethod; 2] = [SphereMethod::FixedPoint, SphereMethod::GradientDescent];
pub const LINE_SEARCHES: [LineSearch; 2] = [LineSearch::Interpolation, LineSearch::Bounded];

/// Every test mesh that is a topological sphere.
pub fn spheres() -> Vec<TestMesh> {
    vec![
        tetrahedron(),
        octahedron(),
        cube(1),
        cube(5),
        icosphere(0),
        icosphere(2),
        ellipsoid(2, [1.0, 2.0, 5.0]),
        radial("bumpy sphere", 3, |[x, y, z]| 1.0 + 0.3 * (4.0 * x + 1.0).sin() * (3.0 * y).cos() + 0.1 * z),
        radial("dented sphere", 3, |[_, _, z]| 1.0 - 0.85 * (-8.0 * (1.0 - z)).exp()),
        parallels(9, 16),
        capsule(24, 10),
    ]
}

/// Spheres on which the paper's methods fold faces.
pub fn spiky_spheres() -> Vec<TestMesh> {
    let spike = |length: f64| {
        move |[x, y, z]: Point| {
            1.0 + length * ((-40.0 * (1.0 - z)).exp() + (-60.0 * (1.0 - 0.6 * x - 0.8 * y)).exp())
        }
    };
    vec![radial("spiky sphere", 3, spike(5.0)), radial("hedgehog", 2, |[x, y, z]| 1.0 + 4.0 * noise(x, y, z))]
}

/// A number in [0, 1) that jumps from point to point.
fn noise(x: f64, y: f64, z: f64) -> f64 {
    (127.1 * x + 311.7 * y + 74.7 * z).sin().abs().powi(6)
}

pub fn tetrahedron() -> TestMesh {
    let vertices = vec![[1., 1., 1.], [1., -1., -1.], [-1., 1., -1.], [-1., -1., 1.]];
    known("tetrahedron", (vertices, vec![[0, 1, 2], [0, 2, 3], [0, 3, 1], [3, 2, 1]]), 2, 0, Some(0))
}

pub fn octahedron() -> TestMesh {
    let vertices =
        vec![[1., 0., 0.], [0., 1., 0.], [-1., 0., 0.], [0., -1., 0.], [0., 0., 1.], [0., 0., -1.]];
    let upper = (0..4).map(|i| [i, (i + 1) % 4, 4]);
    let faces = upper.clone().chain(upper.map(|[a, b, _]| [b, a, 5])).collect();
    known("octahedron", (vertices, faces), 2, 0, Some(0))
}

/// A cube whose sides are lattices of `cells` by `cells` squares.
pub fn cube(cells: u32) -> TestMesh {
    let mut numbers = BTreeMap::new();
    let mut vertices = Vec::new();
    let mut faces = Vec::new();
    for (axis, side) in (0..3usize).flat_map(|axis| [(axis, 0), (axis, cells)]) {
        // the two other axes in the order that makes the side's lattice face outward
        let [u, v] =
            if side > 0 { [(axis + 1) % 3, (axis + 2) % 3] } else { [(axis + 2) % 3, (axis + 1) % 3] };
        let mut number = |i: u32, j: u32| {
            let mut place = [side; 3];
            (place[u], place[v]) = (i, j);
            *numbers.entry(place).or_insert_with(|| {
                vertices.push(place.map(f64::from));
                vertices.len() as u32 - 1
            })
        };
        let numbered: Vec<Vec<u32>> =
            (0..=cells).map(|i| (0..=cells).map(|j| number(i, j)).collect()).collect();
        faces.extend(lattice(cells, cells, |i, j| numbered[i as usize][j as usize]));
    }
    known("cube", (vertices, faces), 2, 0, Some(0))
}

/// The surface of a plate of unit cubes with holes, one for each handle.
pub fn plate_with_holes(n: i32) -> TestMesh {
    let is_solid = |[x, y, z]: [i32; 3]| {
        (0..2 * n + 1).contains(&x) && (0..3).contains(&y) && z == 0 && !(y == 1 && x % 2 == 1)
    };
    let mut numbers = BTreeMap::new();
    let mut vertices = Vec::new();
    let mut faces = Vec::new();
    let places = (0..2 * n + 1).flat_map(|x| (0..3).map(move |y| [x, y, 0]));
    for (cube, axis) in
        places.filter(|&place| is_solid(place)).flat_map(|place| [0, 1, 2].map(|axis| (place, axis)))
    {
        for side in [0, 1] {
            let mut neighbor = cube;
            neighbor[axis] += 2 * side - 1;
            if is_solid(neighbor) {
                continue;
            }
            let [a, b, c, d] = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[s, t]| {
                let mut corner = cube;
                corner[axis] += side;
                corner[(axis + 1) % 3] += s;
                corner[(axis + 2) % 3] += t;
                *numbers.entry(corner).or_insert_with(|| {
                    vertices.push(corner.map(f64::from));
                    vertices.len() as u32 - 1
                })
            });
            faces.extend(if side == 1 { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] });
        }
    }
    known("plate with holes", (vertices, faces), 2 - 2 * i64::from(n), 0, Some(n as usize))
}

/// A sphere of meridians and parallels, with `columns` faces around each pole.
pub fn parallels(rows: u32, columns: u32) -> TestMesh {
    let polar = |i: u32| PI * f64::from(i) / f64::from(rows);
    revolved("parallels", rows, columns, |i| [polar(i).sin(), polar(i).cos()])
}

/// A long thin tube with round ends.
pub fn capsule(rows: u32, columns: u32) -> TestMesh {
    revolved("capsule", rows, columns, |i| {
        let polar = PI * f64::from(i) / f64::from(rows);
        [0.5 * polar.sin().powf(0.4), 5.0 * polar.cos()]
    })
}

/// A tube with round ends, `aspect` times longer than wide, its faces about equilateral.
pub fn round_tube(aspect: f64, columns: u32) -> TestMesh {
    let (round, straight) = (1 + columns / 4, (aspect - 1.0).max(0.0));
    let cells = (2.0 * straight * f64::from(columns) / TAU).ceil() as u32;
    revolved("capsule", 2 * round + cells, columns, |i| {
        let polar = 0.5 * PI / f64::from(round);
        match i {
            i if i < round => [(polar * f64::from(i)).sin(), straight + (polar * f64::from(i)).cos()],
            i if i <= round + cells => {
                [1.0, straight * (1.0 - 2.0 * f64::from(i - round) / f64::from(cells.max(1)))]
            }
            i => {
                let polar = polar * f64::from(2 * round + cells - i);
                [polar.sin(), -straight - polar.cos()]
            }
        }
    })
}

/// A tube of constant width with flat ends, `length` times longer than wide, its faces about equilateral.
pub fn flat_tube(length: f64, columns: u32) -> TestMesh {
    let cells = (2.0 * length * f64::from(columns) / TAU).ceil() as u32;
    let height = move |i: u32| length * (1.0 - 2.0 * f64::from(i - 1) / f64::from(cells));
    revolved("tube", cells + 2, columns, |i| match i {
        0 => [0.0, length],
        i if i == cells + 2 => [0.0, -length],
        i => [1.0, height(i)],
    })
}

/// The surface of revolution about z of a profile [radius, height] from the upper pole to the lower one.
fn revolved(name: &'static str, rows: u32, columns: u32, profile: impl Fn(u32) -> [f64; 2]) -> TestMesh {
    let poles = (rows - 1) * columns;
    let number = |i: u32, j: u32| match i {
        0 => poles,
        i if i == rows => poles + 1,
        i => (i - 1) * columns + j % columns,
    };
    let at = |i: u32, j: u32| {
        let ([radius, height], angle) = (profile(i), TAU * f64::from(j) / f64::from(columns));
        [radius * angle.cos(), radius * angle.sin(), height]
    };
    let mut vertices: Vec<_> = (1..rows).flat_map(|i| (0..columns).map(move |j| at(i, j))).collect();
    vertices.extend([0, rows].map(|i| [0.0, 0.0, profile(i)[1]]));
    known(name, (vertices, lattice(rows, columns, number)), 2, 0, Some(0))
}

/// An icosphere with every vertex moved along its ray to the given distance.
pub fn radial(name: &'static str, level: u32, mut radius: impl FnMut(Point) -> f64) -> TestMesh {
    let mut mesh = TestMesh { name, ..icosphere(level) };
    for vertex in &mut mesh.vertices {
        let r = radius(*vertex);
        *vertex = vertex.map(|x| r * x);
    }
    mesh
}

/// The given sphere with random distances of its vertices, one after another from `radii`.
pub fn star(level: u32, radii: &[f64]) -> TestMesh {
    let mut next = radii.iter().cycle();
    radial("star", level, |_| *next.next().expect("a cycle has no end"))
}

/// A bijection onto the sphere: unit rows, every face positive around the center, the sphere covered once.
pub fn assert_bijective(mesh: &TriangleMesh, map: &[impl Coordinates], context: &str) {
    assert_eq!(map.len(), mesh.n_vertices());
    for &x in map {
        assert!((distance(x, [0.0; 3]) - 1.0).abs() < 1e-14, "{context}: a row of another length than 1");
    }
    assert_eq!(folded(mesh, map), [0usize; 0], "{context}: folded faces");
    let covered: f64 = mesh.faces().iter().map(|face| solid_angle(face.map(|v| map[v]))).sum();
    assert!((covered - 4.0 * PI).abs() < 1e-9, "{context}: covers {covered} instead of 4π");
}

/// Faces whose determinant is not positive, in exact arithmetic.
pub fn folded(mesh: &TriangleMesh, map: &[impl Coordinates]) -> Vec<usize> {
    let is_folded = |face: &usize| !is_positive(mesh.faces()[*face].map(|v| map[v].into()));
    (0..mesh.n_faces()).filter(is_folded).collect()
}

/// The signed solid angle of a triangle seen from the origin (Van Oosterom & Strackee 1983).
pub fn solid_angle([a, b, c]: [impl Coordinates; 3]) -> f64 {
    2.0 * determinant(a, b, c).atan2(1.0 + dot(a, b) + dot(b, c) + dot(c, a))
}

pub fn dot(a: impl Coordinates, b: impl Coordinates) -> f64 {
    let (a, b): (Point, Point) = (a.into(), b.into());
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Whether det(a, b, c) > 0 exactly: the six products as sums of four numbers without error, added up
/// without error.
fn is_positive([a, b, c]: [Point; 3]) -> bool {
    let mut sum = Vec::new();
    for (k, &first) in a.iter().enumerate() {
        let [i, j] = [(k + 1) % 3, (k + 2) % 3];
        for (x, y, z) in [(first, b[i], c[j]), (-first, b[j], c[i])] {
            let (high, low) = product(x, y);
            for part in [product(high, z), product(low, z)] {
                add(&mut sum, part.0);
                add(&mut sum, part.1);
            }
        }
    }
    // the last of the non-overlapping parts that is not zero outweighs the ones before it
    sum.into_iter().rev().find(|part| *part != 0.0).is_some_and(|part| part > 0.0)
}

/// x y = high + low without error.
fn product(x: f64, y: f64) -> (f64, f64) {
    (x * y, x.mul_add(y, -(x * y)))
}

/// Adds a number to a sum kept as parts that do not overlap, the smallest first (Shewchuk 1997).
fn add(sum: &mut Vec<f64>, x: f64) {
    let mut carry = x;
    for part in sum.iter_mut() {
        let total = carry + *part;
        let taken = total - carry;
        *part = (carry - (total - taken)) + (*part - taken);
        carry = total;
    }
    sum.push(carry);
}

pub fn mapped(mesh: &TriangleMesh, options: SphereMapOptions<'_>) -> SphereMap {
    sphere_map(mesh, &options, &mut Silent).expect("a sphere has a map")
}

pub fn refused(mesh: &TriangleMesh, options: SphereMapOptions<'_>) -> Error {
    sphere_map(mesh, &options, &mut Silent).expect_err("a refusal")
}

pub fn with(method: SphereMethod) -> SphereMapOptions<'static> {
    SphereMapOptions { method, ..Default::default() }
}

pub fn energies(map: &SphereMap) -> Vec<f64> {
    map.history.records().iter().map(|record| record.authalic_energy).collect()
}

/// Areas of the image's flat faces.
pub fn image_areas(mesh: &TriangleMesh, map: &[impl Coordinates]) -> Vec<f64> {
    let area = |face: &[Vertex; 3]| {
        let [a, b, c] = face.map(|v| map[v]);
        let [p, q, r] = [distance(b, c), distance(c, a), distance(a, b)];
        0.25 * ((p + q + r) * (-p + q + r) * (p - q + r) * (p + q - r)).max(0.0).sqrt()
    };
    mesh.faces().iter().map(area).collect()
}

/// (E_A, E): the authalic energy and the normalized stretch energy (|M|/A) Σ a²/|τ|, scaled to |M| = A.
pub fn energy_of(mesh: &TriangleMesh, map: &[impl Coordinates], targets: &[f64]) -> (f64, f64) {
    let areas = image_areas(mesh, map);
    let (area, total): (f64, f64) = (areas.iter().sum(), targets.iter().sum());
    let scaled: Vec<f64> = targets.iter().map(|target| target * area / total).collect();
    let authalic = areas.iter().zip(&scaled).map(|(a, target)| (a - target).powi(2) / target).sum();
    (authalic, areas.iter().zip(&scaled).map(|(a, target)| a * a / target).sum())
}

/// A mesh on which gradient descent takes all its iterations.
pub fn bumpy() -> TriangleMesh {
    radial("bumpy sphere", 2, |[x, y, z]| 1.0 + 0.4 * (3.0 * x + 1.0).sin() * (2.0 * y).cos() + 0.2 * z)
        .mesh()
}

/// The rotation of a quaternion of any length, by rows.
pub fn rotation([w, x, y, z]: [f64; 4]) -> [Point; 3] {
    let scale = 2.0 / (w * w + x * x + y * y + z * z);
    let [wx, wy, wz] = [w * x, w * y, w * z].map(|p| scale * p);
    let [xx, yy, zz] = [x * x, y * y, z * z].map(|p| scale * p);
    let [xy, yz, zx] = [x * y, y * z, z * x].map(|p| scale * p);
    [[1.0 - yy - zz, xy - wz, zx + wy], [xy + wz, 1.0 - zz - xx, yz - wx], [zx - wy, yz + wx, 1.0 - xx - yy]]
}
