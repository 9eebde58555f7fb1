// SPDX-License-Identifier: MIT OR Apache-2.0
//! The icosphere: the faces of an icosahedron on the sphere, each divided in four some times.
//!
//! Edges are arcs of great circles, and their middles lie on them, so that the four parts of a face fill it exactly.

use std::collections::HashMap;

use ndarray::Array2;

use crate::arrays::from_vectors;
use crate::error::Error;
use crate::mesh::{Surface, Vertex, index_array};
use crate::vector::Vector3;

/// The finest level: 10,485,762 vertices.
const FINEST: usize = 10;

/// An icosphere, and how its faces were divided.
#[derive(Debug, Clone)]
pub struct Icosphere {
    pub(super) points: Vec<Vector3>,
    /// The faces of each level; those of the next that face f is divided into are 4f to 4f + 3: the parts at its three
    /// corners, then that in the middle.
    pub(super) levels: Vec<Vec<[Vertex; 3]>>,
}

impl Icosphere {
    /// The icosphere of a level, with 10 · 4^level + 2 vertices and 20 · 4^level faces. The vertices of a coarser one come
    /// first.
    ///
    /// # Errors
    /// [`Error::InvalidOption`] for a level above 10.
    pub fn new(level: usize) -> Result<Self, Error> {
        if level > FINEST {
            let (found, expected) = (level.to_string(), format!("0 to {FINEST}"));
            return Err(Error::InvalidOption { name: "level", found, expected });
        }
        let (mut points, faces) = icosahedron();
        let mut levels = vec![faces];
        for _ in 0..level {
            let finer = divided(&mut points, &levels[levels.len() - 1]);
            levels.push(finer);
        }
        Ok(Self { points, levels })
    }

    /// The vertices, unit rows, (n, 3).
    pub fn positions(&self) -> Array2<f64> {
        from_vectors(self.points.clone())
    }

    /// The faces, counter-clockwise seen from outside, (m, 3).
    pub fn faces(&self) -> Array2<u32> {
        index_array(self.finest())
    }

    /// The icosphere as a surface.
    ///
    /// # Errors
    /// None: the arrays are those of a surface.
    pub fn surface(&self) -> Result<Surface, Error> {
        Surface::new(self.positions(), self.faces())
    }

    pub(super) fn finest(&self) -> &[[Vertex; 3]] {
        self.levels.last().expect("an icosphere has faces")
    }
}

/// The icosahedron with two vertices on the z axis.
fn icosahedron() -> (Vec<Vector3>, Vec<[Vertex; 3]>) {
    // the rings lie at the heights ±1/√5
    let (height, radius) = (0.2_f64.sqrt(), 0.8_f64.sqrt());
    let ring = |sign: f64, shift: f64| {
        (0..5).map(move |k| {
            let (sin, cos) = (std::f64::consts::TAU * (f64::from(k) + shift) / 5.0).sin_cos();
            Vector3([radius * cos, radius * sin, sign * height])
        })
    };
    let top = std::iter::once(Vector3::unit(2));
    let points = top.chain(ring(1.0, 0.0)).chain(ring(-1.0, 0.5)).chain([-Vector3::unit(2)]).collect();
    let faces = (0..5).flat_map(|k| {
        let next = (k + 1) % 5;
        let [upper, upper_next, lower, lower_next] = [1 + k, 1 + next, 6 + k, 6 + next];
        [
            [0, upper, upper_next],
            [upper, lower, upper_next],
            [lower, lower_next, upper_next],
            [lower, 11, lower_next],
        ]
    });
    (points, faces.map(|face| face.map(Vertex::new)).collect())
}

/// Each face in four: the parts at its three corners, then that in the middle.
fn divided(points: &mut Vec<Vector3>, faces: &[[Vertex; 3]]) -> Vec<[Vertex; 3]> {
    let mut middles: HashMap<(Vertex, Vertex), Vertex> = HashMap::with_capacity(2 * faces.len());
    let mut finer = Vec::with_capacity(4 * faces.len());
    for &[a, b, c] in faces {
        let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(p, q)| {
            *middles.entry((p.min(q), p.max(q))).or_insert_with(|| {
                points.push((points[p] + points[q]).normalized());
                Vertex::new(points.len() - 1)
            })
        });
        finer.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    finer
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::geometry::triangle;

    #[test]
    fn an_icosphere_is_a_sphere_of_even_faces() {
        for level in 0..4 {
            let icosphere = Icosphere::new(level).unwrap();
            let (n, m) = (icosphere.points.len(), icosphere.finest().len());
            assert_eq!((n, m), (10 * 4usize.pow(level as u32) + 2, 20 * 4usize.pow(level as u32)));
            assert!(icosphere.points.iter().all(|point| (point.norm() - 1.0).abs() < 1e-15));
            let topology = icosphere.surface().unwrap();
            assert_eq!(topology.topology().unwrap().euler_characteristic, 2);
            let volumes = icosphere.finest().iter().map(|&face| {
                let [a, b, c] = triangle(&icosphere.points, face);
                a.dot(b.cross(c))
            });
            let (low, high) = volumes.fold((f64::INFINITY, 0.0), |(low, high), volume: f64| {
                (f64::min(low, volume), f64::max(high, volume))
            });
            assert!(low > 0.0 && high / low < 1.6, "{low} {high}");
        }
    }

    #[test]
    fn levels_that_are_too_fine_are_refused() {
        assert!(matches!(Icosphere::new(11), Err(Error::InvalidOption { name: "level", .. })));
    }
}
