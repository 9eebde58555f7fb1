// SPDX-License-Identifier: MIT OR Apache-2.0
//! The targets of the fuzzer, and meshes and options out of its bytes.
//!
//! Bytes first choose a sound surface, then change it step by step, so that both sound and broken meshes are common.
//! The tests of the crate include this file too: they run each input in `corpus/` by its target, without a fuzzer.

pub mod cut;
pub mod disk_map;
pub mod mesh;
pub mod registration;
pub mod repair;
pub mod seams;
pub mod sphere_map;

use authalic::Surface;
use ndarray::{Array2, aview2};

/// Most vertices of a surface to map: a run is to take milliseconds.
const MOST_VERTICES: usize = 120;

type Vertices = Vec<[f64; 3]>;
type Faces = Vec<[u32; 3]>;

/// The name of a target, and one run of it on some bytes: whether it came to a result to look at.
pub type Target = (&'static str, fn(&[u8]) -> bool);

/// The targets by their names, which their folders in `corpus/` have too.
pub const TARGETS: [Target; 7] = [
    ("cut", cut::check),
    ("disk_map", disk_map::check),
    ("mesh", mesh::check),
    ("registration", registration::check),
    ("repair", repair::check),
    ("seams", seams::check),
    ("sphere_map", sphere_map::check),
];

/// The bytes that are left; zeros behind their end.
pub struct Input<'a>(&'a [u8]);

impl<'a> Input<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        Self(bytes)
    }

    pub fn is_over(&self) -> bool {
        self.0.is_empty()
    }

    pub fn byte(&mut self) -> u8 {
        let Some((&first, rest)) = self.0.split_first() else { return 0 };
        self.0 = rest;
        first
    }

    pub fn bit(&mut self) -> bool {
        self.byte() % 2 == 1
    }

    /// A number below a limit, 0 if that is 0.
    pub fn below(&mut self, limit: usize) -> usize {
        let number = usize::from(self.byte()) * 256 + usize::from(self.byte());
        if limit == 0 { 0 } else { number % limit }
    }

    /// A number that is usual, or seldom an extreme one.
    pub fn real(&mut self) -> f64 {
        let small = |input: &mut Self| f64::from(input.byte().cast_signed()) / 32.0;
        match self.byte() {
            0..=200 => small(self),
            201..=215 => f64::from(self.byte().cast_signed()),
            216..=225 => small(self) * 1e-8,
            226..=235 => small(self) * 1e12,
            236 => f64::NAN,
            237 => f64::INFINITY,
            238 => f64::MIN_POSITIVE,
            239 => f64::MAX,
            240 => -0.0,
            _ => f64::from_bits(u64::from_le_bytes(std::array::from_fn(|_| self.byte()))),
        }
    }

    /// A number as options have it: none, sensible, or extreme.
    pub fn option(&mut self, sensible: [f64; 3]) -> Option<f64> {
        match self.byte() % 8 {
            0..=3 => None,
            4 => Some(sensible[0]),
            5 => Some(sensible[1]),
            6 => Some(sensible[2]),
            _ => Some(self.real()),
        }
    }

    /// Vertices and faces, which need not be a surface.
    pub fn arrays(&mut self) -> (Array2<f64>, Array2<u32>) {
        let (vertices, faces) = self.mesh(6);
        (aview2(&vertices).to_owned(), aview2(&faces).to_owned())
    }

    /// A surface out of changed sound ones; None where the arrays are refused.
    pub fn surface(&mut self, kinds: u8) -> Option<Surface> {
        let (vertices, faces) = self.mesh(kinds);
        if vertices.len() > MOST_VERTICES {
            return None;
        }
        Surface::new(aview2(&vertices).to_owned(), aview2(&faces).to_owned()).ok()
    }

    /// An observer that ends a run after some reports, so that every run is short.
    pub fn patience(&mut self) -> impl FnMut(f64, &str) -> bool + Send + use<> {
        let limit = match self.byte() {
            0..=127 => 4000,
            few => usize::from(few - 128),
        };
        let mut reports = 0;
        move |fraction: f64, _: &str| {
            assert!((0.0..=1.0).contains(&fraction), "progress of {fraction}");
            reports += 1;
            reports <= limit
        }
    }

    /// One of `kinds` kinds of meshes, changed.
    fn mesh(&mut self, kinds: u8) -> (Vertices, Faces) {
        let (mut vertices, mut faces) = match self.byte() % kinds {
            0 => grid(2 + self.below(6), 2 + self.below(6), false),
            1 => sphere(self.byte() % 2),
            2 => grid(3 + self.below(4), 3 + self.below(6), true),
            3 => torus(3 + self.below(5), 3 + self.below(5)),
            4 => two_pieces(),
            _ => self.soup(),
        };
        for _ in 0..self.byte() % 10 {
            self.change(&mut vertices, &mut faces);
        }
        (vertices, faces)
    }

    /// A change of a mesh: most leave a surface as it is in the eyes of a map, some break it.
    fn change(&mut self, vertices: &mut Vertices, faces: &mut Faces) {
        let (n, m) = (vertices.len(), faces.len());
        match self.byte() % 12 {
            0..=3 if n > 0 => {
                let (vertex, axis) = (self.below(n), usize::from(self.byte() % 3));
                vertices[vertex][axis] += self.real();
            }
            4 if m > 0 => drop(faces.remove(self.below(m))),
            5 if m > 0 => faces[self.below(m)].reverse(),
            6 if m > 0 => faces.push(faces[self.below(m)]),
            7 if m > 0 => faces[self.below(m)][usize::from(self.byte() % 3)] = self.below(n + 2) as u32,
            8 if n > 0 => vertices[self.below(n)] = vertices[self.below(n)],
            9 => {
                let factor = self.real();
                vertices.iter_mut().flatten().for_each(|x| *x *= factor);
            }
            10 => vertices.push(std::array::from_fn(|_| self.real())),
            _ => {
                let axis = usize::from(self.byte() % 3);
                let factor = self.real();
                vertices.iter_mut().for_each(|vertex| vertex[axis] *= factor);
            }
        }
    }

    /// Any triangles between points of a small grid.
    fn soup(&mut self) -> (Vertices, Faces) {
        let n = 1 + self.below(20);
        let vertices = (0..n).map(|_| std::array::from_fn(|_| f64::from(self.byte() % 4))).collect();
        let m = self.below(40);
        let faces = (0..m).map(|_| std::array::from_fn(|_| self.below(n + 1) as u32)).collect();
        (vertices, faces)
    }
}

/// A bumpy square of rows and columns, or a tube if `is_ring`.
fn grid(rows: usize, columns: usize, is_ring: bool) -> (Vertices, Faces) {
    let (width, mut vertices, mut faces) = (columns + 1, Vec::new(), Vec::new());
    let across = if is_ring { columns } else { width };
    for row in 0..=rows {
        for column in 0..across {
            let (x, y) = (column as f64 / columns as f64, row as f64 / rows as f64);
            let angle = std::f64::consts::TAU * x;
            let bump = 0.3 * (3.0 * x).sin() * (2.0 * y).cos();
            vertices.push(if is_ring { [angle.cos(), angle.sin(), 2.0 * y] } else { [x, y, bump] });
        }
    }
    let at = |row: usize, column: usize| (row * across + column % across) as u32;
    for row in 0..rows {
        for column in 0..columns {
            let [a, b] = [at(row, column), at(row, column + 1)];
            let [c, d] = [at(row + 1, column + 1), at(row + 1, column)];
            faces.extend([[a, b, c], [a, c, d]]);
        }
    }
    (vertices, faces)
}

/// An octahedron whose faces are divided once or twice.
fn sphere(levels: u8) -> (Vertices, Faces) {
    let mut vertices: Vertices = vec![
        [1.0, 0.0, 0.0],
        [0.0, 1.1, 0.0],
        [0.0, 0.0, 1.2],
        [-1.0, 0.0, 0.1],
        [0.0, -1.0, 0.0],
        [0.1, 0.0, -1.0],
    ];
    let mut faces: Faces =
        vec![[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
    for _ in 0..=levels {
        let mut middles = std::collections::BTreeMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                let [p, q] = [vertices[a as usize], vertices[b as usize]];
                let sum: [f64; 3] = std::array::from_fn(|axis| p[axis] + q[axis]);
                let length = sum.iter().map(|x| x * x).sum::<f64>().sqrt();
                vertices.push(sum.map(|x| 1.05 * x / length));
                vertices.len() as u32 - 1
            })
        };
        faces = faces
            .iter()
            .flat_map(|&[a, b, c]| {
                let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
                [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
            })
            .collect();
    }
    (vertices, faces)
}

fn torus(rows: usize, columns: usize) -> (Vertices, Faces) {
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    let turn = |part: usize, whole: usize| std::f64::consts::TAU * part as f64 / whole as f64;
    for row in 0..rows {
        for column in 0..columns {
            let (u, v) = (turn(row, rows), turn(column, columns));
            let radius = 2.0 + v.cos();
            vertices.push([radius * u.cos(), radius * u.sin(), v.sin()]);
        }
    }
    let at = |row: usize, column: usize| (row % rows * columns + column % columns) as u32;
    for row in 0..rows {
        for column in 0..columns {
            let [a, b] = [at(row, column), at(row + 1, column)];
            let [c, d] = [at(row + 1, column + 1), at(row, column + 1)];
            faces.extend([[a, b, c], [a, c, d]]);
        }
    }
    (vertices, faces)
}

fn two_pieces() -> (Vertices, Faces) {
    let (mut vertices, mut faces) = grid(2, 3, false);
    let (others, more) = sphere(0);
    let first = vertices.len() as u32;
    vertices.extend(others.iter().map(|[x, y, z]| [x + 5.0, *y, *z]));
    faces.extend(more.iter().map(|face| face.map(|corner| corner + first)));
    (vertices, faces)
}
