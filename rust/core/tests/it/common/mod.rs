// SPDX-License-Identifier: MIT OR Apache-2.0
//! Meshes of known topology, made in code. Tests loop over all that qualify.

pub mod cancelling;
pub mod closed;
pub mod planar;
pub mod public;
pub mod random;

use authalic::Vertex;
use authalic::testing::TriangleMesh;
use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

/// A mesh and what is known about it by construction.
#[derive(Debug, Clone)]
pub struct TestMesh {
    pub name: &'static str,
    pub vertices: Vec<[f64; 3]>,
    pub faces: Vec<[u32; 3]>,
    pub components: usize,
    pub euler_characteristic: i64,
    pub n_loops: usize,
    /// `None` where the surface is not orientable.
    pub genus: Option<usize>,
}

impl TestMesh {
    pub fn mesh(&self) -> TriangleMesh {
        TriangleMesh::new(&self.vertices, &self.faces).unwrap_or_else(|e| panic!("{}: {e}", self.name))
    }

    pub fn is_disk(&self) -> bool {
        self.components == 1 && self.n_loops == 1 && self.euler_characteristic == 1
    }

    pub fn is_sphere(&self) -> bool {
        self.components == 1 && self.n_loops == 0 && self.euler_characteristic == 2
    }
}

/// Every test mesh.
pub fn all() -> Vec<TestMesh> {
    vec![
        triangle(),
        grid(7, 5),
        bumpy_disk(9),
        cap(8, 2.4),
        slit_sphere(8, 13),
        holed_grid(),
        annulus(11, 3),
        icosphere(2),
        ellipsoid(2, [1.0, 2.0, 5.0]),
        closed::octahedron(),
        closed::cube(3),
        closed::parallels(5, 8),
        torus(9, 14),
        punctured_torus(),
        two_pieces(),
        moebius_strip(10, 3),
    ]
}

/// Every test mesh that can be oriented.
pub fn orientable() -> Vec<TestMesh> {
    all().into_iter().filter(|m| m.genus.is_some()).collect()
}

/// Every test mesh that is a topological disk.
pub fn disks() -> Vec<TestMesh> {
    all().into_iter().filter(TestMesh::is_disk).collect()
}

/// The faces of a lattice of `nu` by `nv` cells, two for each, where `vertex(i, j)` numbers its points.
fn lattice(nu: u32, nv: u32, vertex: impl Fn(u32, u32) -> u32) -> Vec<[u32; 3]> {
    let mut faces = Vec::new();
    for (i, j) in (0..nu).flat_map(|i| (0..nv).map(move |j| (i, j))) {
        let [a, b] = [vertex(i, j), vertex(i + 1, j)];
        let [c, d] = [vertex(i + 1, j + 1), vertex(i, j + 1)];
        faces.extend([[a, b, c], [a, c, d]]);
    }
    // Around a pole the lattice has triangles without extent.
    faces.retain(|[a, b, c]| a != b && b != c && c != a);
    faces
}

fn known(
    name: &'static str,
    (vertices, faces): (Vec<[f64; 3]>, Vec<[u32; 3]>),
    euler_characteristic: i64,
    n_loops: usize,
    genus: Option<usize>,
) -> TestMesh {
    TestMesh { name, vertices, faces, components: 1, euler_characteristic, n_loops, genus }
}

pub fn triangle() -> TestMesh {
    let vertices = vec![[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]];
    known("triangle", (vertices, vec![[0, 1, 2]]), 1, 1, Some(0))
}

/// A flat rectangle of `nu` by `nv` unit cells; vertex `i * (nv + 1) + j` lies at (i, j).
pub fn grid(nu: u32, nv: u32) -> TestMesh {
    let points = (0..=nu).flat_map(|i| (0..=nv).map(move |j| [f64::from(i), f64::from(j), 0.]));
    let faces = lattice(nu, nv, |i, j| i * (nv + 1) + j);
    known("grid", (points.collect(), faces), 1, 1, Some(0))
}

/// Rings about a center, `6 r` vertices on ring `r`, at (x, y) in the unit disk.
fn hexagonal_disk(rings: u32) -> (Vec<[f64; 2]>, Vec<[u32; 3]>) {
    let first = |ring: u32| {
        if ring == 0 { 0 } else { 1 + 3 * ring * (ring - 1) }
    };
    let on = |ring: u32, i: u32| first(ring) + if ring == 0 { 0 } else { i % (6 * ring) };
    let mut points = vec![[0., 0.]];
    let mut faces = Vec::new();
    for ring in 1..=rings {
        let radius = f64::from(ring) / f64::from(rings);
        let angle = |i: u32| TAU * f64::from(i) / f64::from(6 * ring);
        points.extend((0..6 * ring).map(|i| [radius * angle(i).cos(), radius * angle(i).sin()]));
        for (side, k) in (0..6).flat_map(|side| (0..ring).map(move |k| (side, k))) {
            let [outer, inner] = [side * ring + k, side * (ring - 1) + k];
            faces.push([on(ring - 1, inner), on(ring, outer), on(ring, outer + 1)]);
            if k + 1 < ring {
                faces.push([on(ring - 1, inner), on(ring, outer + 1), on(ring - 1, inner + 1)]);
            }
        }
    }
    (points, faces)
}

/// A disk with hills and dents.
pub fn bumpy_disk(rings: u32) -> TestMesh {
    let (plane, faces) = hexagonal_disk(rings);
    let height = |x: f64, y: f64| 0.3 * (5. * x + 1.).sin() * (4. * y).cos() + 0.4 * x * y;
    let vertices = plane.iter().map(|&[x, y]| [x, y, height(x, y)]).collect();
    known("bumpy disk", (vertices, faces), 1, 1, Some(0))
}

/// The part of the unit sphere within `opening` radians of its north pole.
pub fn cap(rings: u32, opening: f64) -> TestMesh {
    let (plane, faces) = hexagonal_disk(rings);
    let lift = |[x, y]: [f64; 2]| {
        let radius = x.hypot(y);
        let stretch = if radius > 0. { (opening * radius).sin() / radius } else { 0. };
        [stretch * x, stretch * y, (opening * radius).cos()]
    };
    known("cap", (plane.into_iter().map(lift).collect(), faces), 1, 1, Some(0))
}

/// A sphere cut open from pole to pole: `rows` by `columns` cells, the two sides of the cut apart.
pub fn slit_sphere(rows: u32, columns: u32) -> TestMesh {
    let poles = (rows - 1) * (columns + 1);
    let number = |i: u32, j: u32| match i {
        0 => poles,
        i if i == rows => poles + 1,
        i => (i - 1) * (columns + 1) + j,
    };
    let at = |i: u32, j: u32| {
        let [polar, angle] = [PI * f64::from(i) / f64::from(rows), TAU * f64::from(j) / f64::from(columns)];
        [polar.sin() * angle.cos(), polar.sin() * angle.sin(), polar.cos()]
    };
    let mut vertices: Vec<_> = (1..rows).flat_map(|i| (0..=columns).map(move |j| at(i, j))).collect();
    vertices.extend([[0., 0., 1.], [0., 0., -1.]]);
    known("slit sphere", (vertices, lattice(rows, columns, number)), 1, 1, Some(0))
}

/// A 9 by 7 grid with a window of one cell and one of two by three cells: three boundary loops.
pub fn holed_grid() -> TestMesh {
    let mut mesh = grid(9, 7);
    let cell = |face: &[u32; 3]| (face[0] / 8, face[0] % 8);
    let window = |(i, j)| (i, j) == (2, 2) || ((5..7).contains(&i) && (2..5).contains(&j));
    mesh.faces.retain(|face| !window(cell(face)));
    let (vertices, faces) = compacted(&mesh.vertices, &mesh.faces);
    known("holed grid", (vertices, faces), -1, 3, Some(0))
}

/// A flat ring of `around` by `across` cells.
pub fn annulus(around: u32, across: u32) -> TestMesh {
    let at = |i: u32, j: u32| {
        let [angle, radius] = [TAU * f64::from(i) / f64::from(around), 2. - f64::from(j) / f64::from(across)];
        [radius * angle.cos(), radius * angle.sin(), 0.]
    };
    let vertices = (0..around).flat_map(|i| (0..=across).map(move |j| at(i, j))).collect();
    let faces = lattice(around, across, |i, j| i % around * (across + 1) + j);
    known("annulus", (vertices, faces), 0, 2, Some(0))
}

/// A Moebius strip of `around` by `across` cells.
pub fn moebius_strip(around: u32, across: u32) -> TestMesh {
    let at = |i: u32, j: u32| {
        let angle = TAU * f64::from(i) / f64::from(around);
        let offset = f64::from(j) / f64::from(across) - 0.5;
        let radius = 1. + offset * (angle / 2.).cos();
        [radius * angle.cos(), radius * angle.sin(), offset * (angle / 2.).sin()]
    };
    let vertices = (0..around).flat_map(|i| (0..=across).map(move |j| at(i, j))).collect();
    let number = |i: u32, j: u32| {
        if i == around { across - j } else { i * (across + 1) + j }
    };
    known("moebius strip", (vertices, lattice(around, across, number)), 0, 1, None)
}

/// A torus of `around` by `tube` cells; vertex `i * tube + j`.
pub fn torus(around: u32, tube: u32) -> TestMesh {
    let at = |i: u32, j: u32| {
        let [u, v] = [TAU * f64::from(i) / f64::from(around), TAU * f64::from(j) / f64::from(tube)];
        let radius = 2. + 0.7 * v.cos();
        [radius * u.cos(), radius * u.sin(), 0.7 * v.sin()]
    };
    let vertices = (0..around).flat_map(|i| (0..tube).map(move |j| at(i, j))).collect();
    let faces = lattice(around, tube, |i, j| i % around * tube + j % tube);
    known("torus", (vertices, faces), 0, 0, Some(1))
}

/// A torus without one face.
pub fn punctured_torus() -> TestMesh {
    let TestMesh { vertices, mut faces, .. } = torus(6, 8);
    faces.remove(17);
    known("punctured torus", (vertices, faces), -1, 1, Some(1))
}

/// A sphere of 20 · 4^level faces.
pub fn icosphere(level: u32) -> TestMesh {
    let t = (1. + 5f64.sqrt()) / 2.;
    let mut vertices = Vec::new();
    for [a, b] in [[-1., t], [1., t], [-1., -t], [1., -t]] {
        vertices.extend([[a, b, 0.], [0., a, b], [b, 0., a]]);
    }
    // The faces of an icosahedron are its triples of mutual neighbors, seen from outside.
    let near = |a: u32, b: u32| distance(vertices[a as usize], vertices[b as usize]) < 2.1;
    let mut faces = Vec::new();
    for [a, b, c] in triples(12).filter(|&[a, b, c]| near(a, b) && near(b, c) && near(c, a)) {
        let [p, q, r] = [a, b, c].map(|v| vertices[v as usize]);
        faces.push(if determinant(p, q, r) > 0. { [a, b, c] } else { [a, c, b] });
    }
    for _ in 0..level {
        faces = subdivided(&mut vertices, &faces);
    }
    let onto_sphere = |v: [f64; 3]| v.map(|x| x / distance(v, [0.; 3]));
    let vertices = vertices.into_iter().map(onto_sphere).collect();
    known("icosphere", (vertices, faces), 2, 0, Some(0))
}

/// An icosphere stretched along the axes.
pub fn ellipsoid(level: u32, radii: [f64; 3]) -> TestMesh {
    let mut mesh = TestMesh { name: "ellipsoid", ..icosphere(level) };
    for vertex in &mut mesh.vertices {
        *vertex = [0, 1, 2].map(|axis| vertex[axis] * radii[axis]);
    }
    mesh
}

/// A cap and a torus far apart.
pub fn two_pieces() -> TestMesh {
    let (first, second) = (cap(4, 1.), torus(6, 6));
    let shift = first.vertices.len() as u32;
    let mut vertices = first.vertices;
    vertices.extend(second.vertices.iter().map(|[x, y, z]| [x + 10., *y, *z]));
    let mut faces = first.faces;
    faces.extend(second.faces.iter().map(|face| face.map(|v| v + shift)));
    TestMesh {
        name: "two pieces",
        vertices,
        faces,
        components: 2,
        euler_characteristic: 1,
        n_loops: 1,
        genus: Some(1),
    }
}

/// Drops the vertices that no face uses.
pub fn compacted(vertices: &[[f64; 3]], faces: &[[u32; 3]]) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let mut number: BTreeMap<u32, u32> = faces.iter().flatten().map(|&v| (v, 0)).collect();
    for (new, (_, slot)) in number.iter_mut().enumerate() {
        *slot = new as u32;
    }
    let kept = number.keys().map(|&v| vertices[v as usize]).collect();
    (kept, faces.iter().map(|face| face.map(|v| number[&v])).collect())
}

/// Splits every face into four.
fn subdivided(vertices: &mut Vec<[f64; 3]>, faces: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut middles = BTreeMap::new();
    let mut middle = |a: u32, b: u32| {
        *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
            let [p, q] = [vertices[a as usize], vertices[b as usize]];
            vertices.push([0, 1, 2].map(|axis| (p[axis] + q[axis]) / 2.));
            vertices.len() as u32 - 1
        })
    };
    let split = |&[a, b, c]: &[u32; 3]| {
        let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
        [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
    };
    faces.iter().flat_map(split).collect()
}

fn triples(n: u32) -> impl Iterator<Item = [u32; 3]> {
    (0..n).flat_map(move |a| (a + 1..n).flat_map(move |b| (b + 1..n).map(move |c| [a, b, c])))
}

/// Faces of the vertices with these indices.
pub fn faces_of_indices(rows: &[[u32; 3]]) -> Vec<[Vertex; 3]> {
    rows.iter().map(|row| row.map(Vertex)).collect()
}

/// The indices of the vertices of faces.
pub fn indices(faces: &[[Vertex; 3]]) -> Vec<[u32; 3]> {
    faces.iter().map(|face| face.map(|vertex| vertex.0)).collect()
}

/// A point as an array or a vector.
pub trait Coordinates: Copy + Into<[f64; 3]> {}

impl<Point: Copy + Into<[f64; 3]>> Coordinates for Point {}

pub fn distance(a: impl Coordinates, b: impl Coordinates) -> f64 {
    let (a, b) = (a.into(), b.into());
    (a[0] - b[0]).hypot(a[1] - b[1]).hypot(a[2] - b[2])
}

pub fn determinant(a: impl Coordinates, b: impl Coordinates, c: impl Coordinates) -> f64 {
    let [a, b, c]: [[f64; 3]; 3] = [a.into(), b.into(), c.into()];
    a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}
