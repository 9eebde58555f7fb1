// SPDX-License-Identifier: MIT OR Apache-2.0
//! Random surfaces of the kinds on which maps fold, each from a seed.

use authalic::testing::TriangleMesh;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

use robust::{Coord, incircle};

use super::closed::{dot, radial, round_tube};
use super::planar::side;
use super::{TestMesh, bumpy_disk, compacted, icosphere};

type Point = [f64; 3];

/// A generator of numbers (SplitMix64, Steele et al. 2014).
#[derive(Debug, Clone)]
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// A number in [from, to).
    pub fn between(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A number in [from, to), its logarithm evenly distributed.
    pub fn of_any_size(&mut self, from: f64, to: f64) -> f64 {
        self.between(from.ln(), to.ln()).exp()
    }

    /// One of 0, …, n − 1.
    pub fn below(&mut self, n: u32) -> u32 {
        (self.bits() % u64::from(n)) as u32
    }

    fn direction(&mut self) -> Point {
        loop {
            let x = [0; 3].map(|_| self.between(-1.0, 1.0));
            let length = dot(x, x).sqrt();
            if length > 0.1 && length < 1.0 {
                return x.map(|c| c / length);
            }
        }
    }

    /// 0, …, n − 1 in random order.
    pub fn permutation(&mut self, n: usize) -> Vec<u32> {
        let mut order: Vec<u32> = (0..n as u32).collect();
        for k in (1..n).rev() {
            order.swap(k, self.below(k as u32 + 1) as usize);
        }
        order
    }
}

/// A surface of any kind, sphere or disk, and what it is.
pub fn surface(seed: u64) -> (String, TriangleMesh) {
    let mut random = Random::new(seed);
    let (kind, shape) = match random.below(7) {
        0 => ("noisy icosphere", noisy_icosphere(&mut random)),
        1 => ("bumpy disk", rough_disk(&mut random)),
        2 => ("random Delaunay cap", delaunay_cap(&mut random)),
        3 => ("horned ball", horned_ball(&mut random)),
        4 => ("capsule", capsule(&mut random)),
        5 => ("horned ball with a hole", opened(horned_ball(&mut random), &mut random)),
        _ => ("capsule with a hole", opened(capsule(&mut random), &mut random)),
    };
    (format!("{kind}, seed {seed}, {} vertices", shape.vertices.len()), shape.mesh())
}

/// A sphere whose vertices are off by up to their own distance.
pub fn noisy_icosphere(random: &mut Random) -> TestMesh {
    let mut mesh = icosphere(random.below(4) + 1);
    let edge = (16.0 / mesh.vertices.len() as f64).sqrt();
    let size = random.between(0.0, 1.0) * edge;
    for vertex in &mut mesh.vertices {
        *vertex = vertex.map(|c| c + size * random.between(-1.0, 1.0));
    }
    mesh
}

/// A disk with waves, noise and a spike.
pub fn rough_disk(random: &mut Random) -> TestMesh {
    let mut mesh = bumpy_disk(random.below(20) + 2);
    let [steepness, noise, spike] = [1.5, 0.1, 5.0].map(|most| random.between(0.0, most));
    let [phase, wave] = [6.0, 8.0].map(|most| random.between(0.0, most));
    let tip = random.below(mesh.vertices.len() as u32) as usize;
    for [x, y, z] in &mut mesh.vertices {
        *z += steepness * (wave * *x + phase).sin() * (wave * *y).cos() + noise * random.between(-1.0, 1.0);
    }
    mesh.vertices[tip][2] += spike;
    mesh
}

/// A part of a sphere or less curved, its vertices at random and their triangulation Delaunay's in the plane.
pub fn delaunay_cap(random: &mut Random) -> TestMesh {
    let (inside, outside) = (random.below(500) + 1, random.below(60) + 3);
    let (plane, faces) = delaunay(random, inside, outside);
    let opening = random.between(0.0, 3.0);
    let lift = |[x, y]: [f64; 2]| {
        let radius = x.hypot(y);
        let stretch = if opening * radius > 1e-9 { (opening * radius).sin() / radius } else { 1.0 };
        [stretch * x, stretch * y, (opening * radius).cos()]
    };
    let vertices = plane.into_iter().map(lift).collect();
    TestMesh {
        name: "cap",
        components: 1,
        euler_characteristic: 1,
        n_loops: 1,
        genus: Some(0),
        vertices,
        faces,
    }
}

/// A ball with a thin horn.
pub fn horned_ball(random: &mut Random) -> TestMesh {
    let (level, tip) = (random.below(2) + 3, random.direction());
    let [length, sharpness] = [random.of_any_size(1.0, 20.0), random.of_any_size(10.0, 400.0)];
    radial("horned ball", level, |x| 1.0 + length * (-sharpness * (1.0 - dot(x, tip))).exp())
}

/// A capsule 2 to 100 times longer than wide.
pub fn capsule(random: &mut Random) -> TestMesh {
    round_tube(random.of_any_size(2.0, 100.0), random.below(9) + 4)
}

/// A sphere without the faces around one of its vertices.
pub fn opened(mesh: TestMesh, random: &mut Random) -> TestMesh {
    let gone = random.below(mesh.vertices.len() as u32);
    without_vertex(mesh, gone)
}

/// A sphere without the faces around one vertex.
pub fn without_vertex(mesh: TestMesh, gone: u32) -> TestMesh {
    let faces: Vec<_> = mesh.faces.into_iter().filter(|face| !face.contains(&gone)).collect();
    let (vertices, faces) = compacted(&mesh.vertices, &faces);
    TestMesh { euler_characteristic: 1, n_loops: 1, vertices, faces, ..mesh }
}

/// Random points of the unit disk, the last `outside` of them on the circle, and their Delaunay triangulation.
fn delaunay(random: &mut Random, inside: u32, outside: u32) -> (Vec<[f64; 2]>, Vec<[u32; 3]>) {
    let mut points = Vec::new();
    for _ in 0..inside {
        let (radius, angle) = (0.99 * random.between(0.0, 1.0).sqrt(), random.between(0.0, TAU));
        points.push([radius * angle.cos(), radius * angle.sin()]);
    }
    // points outside of the polygon are left out
    let angle =
        |k: u32, random: &mut Random| TAU * (f64::from(k) + random.between(0.0, 0.6)) / f64::from(outside);
    points.extend((0..outside).map(|k| angle(k, random)).map(|angle| [angle.cos(), angle.sin()]));
    let mut triangulation = Triangulation { points, apex: BTreeMap::new() };
    for k in 1..outside - 1 {
        triangulation.add([inside, inside + k, inside + k + 1]);
    }
    (0..inside).for_each(|vertex| triangulation.insert(vertex));
    let faces = triangulation.faces();
    let space: Vec<Point> = triangulation.points.iter().map(|&[x, y]| [x, y, 0.0]).collect();
    let (kept, faces) = compacted(&space, &faces);
    (kept.into_iter().map(|[x, y, _]| [x, y]).collect(), faces)
}

/// Triangles by their directed edges.
struct Triangulation {
    points: Vec<[f64; 2]>,
    /// The corner opposite to each directed edge of a triangle.
    apex: BTreeMap<[u32; 2], u32>,
}

impl Triangulation {
    fn add(&mut self, [a, b, c]: [u32; 3]) {
        self.apex.extend([([a, b], c), ([b, c], a), ([c, a], b)]);
    }

    fn remove(&mut self, [a, b, c]: [u32; 3]) {
        [[a, b], [b, c], [c, a]].iter().for_each(|edge| _ = self.apex.remove(edge));
    }

    /// Puts a point into the triangle around it; nothing happens where no triangle has it in its interior.
    fn insert(&mut self, vertex: u32) {
        let at = |v: u32| self.points[v as usize];
        let inside = |a: u32, b: u32| side([at(a), at(b), at(vertex)]) > 0;
        let around = self.apex.iter().map(|(&[a, b], &c)| [a, b, c]);
        let Some([a, b, c]) =
            around.into_iter().find(|&[a, b, c]| inside(a, b) && inside(b, c) && inside(c, a))
        else {
            return;
        };
        self.remove([a, b, c]);
        [[a, b], [b, c], [c, a]].iter().for_each(|&[from, to]| self.add([from, to, vertex]));
        [[a, b], [b, c], [c, a]].iter().for_each(|&edge| self.legalize(edge));
    }

    /// Flips an edge, and those around it, until the circle around each triangle is empty (Lawson 1977).
    fn legalize(&mut self, [a, b]: [u32; 2]) {
        let (Some(&c), Some(&d)) = (self.apex.get(&[a, b]), self.apex.get(&[b, a])) else { return };
        let [p, q, r, s] = [a, b, c, d].map(|v| self.points[v as usize]).map(|[x, y]| Coord { x, y });
        if incircle(p, q, r, s) > 0.0 {
            self.remove([a, b, c]);
            self.remove([b, a, d]);
            self.add([a, d, c]);
            self.add([d, b, c]);
            [[a, d], [d, b]].iter().for_each(|&edge| self.legalize(edge));
        }
    }

    fn faces(&self) -> Vec<[u32; 3]> {
        let all = self.apex.iter().map(|(&[a, b], &c)| [a, b, c]);
        all.filter(|[a, b, c]| a < b && a < c).collect()
    }
}
