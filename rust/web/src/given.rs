// SPDX-License-Identifier: MIT OR Apache-2.0
//! The UVs that a file has already: their seams, and their figures for comparison.

use std::collections::HashMap;

use authalic::{Error, Surface};
use ndarray::{Array2, aview2};

use crate::figures::{Measured, measured, rows, signed_area};

/// UVs of the triangles of a surface.
#[derive(Debug, Clone, Copy)]
pub struct GivenUv<'a> {
    /// The surface, (m, 3) triangles.
    pub surface: &'a Surface,
    /// The points, (t, 2).
    pub points: &'a [[f64; 2]],
    /// The point at each corner of the triangles, (m, 3).
    pub triangles: &'a [[u32; 3]],
}

impl GivenUv<'_> {
    /// The edges at whose ends the UVs of both sides differ, (s, 2), the lower end first, ascending.
    pub fn seams(&self) -> Vec<[u32; 2]> {
        let mut sides: HashMap<[u32; 2], [[f64; 2]; 2]> = HashMap::new();
        let mut seams = Vec::new();
        for (face, uv) in self.surface.faces().rows().into_iter().zip(self.triangles) {
            for k in 0..3 {
                let next = (k + 1) % 3;
                let mut ends = [(face[k], self.point(uv[k])), (face[next], self.point(uv[next]))];
                ends.sort_by_key(|end| end.0);
                let (edge, side) = (ends.map(|end| end.0), ends.map(|end| end.1));
                if *sides.entry(edge).or_insert(side) != side {
                    seams.push(edge);
                }
            }
        }
        seams.sort_unstable();
        seams.dedup();
        seams
    }

    /// The figures. Islands that lie mirrored in the plane are turned over first, because that is no flaw.
    ///
    /// # Errors
    /// Seams along which the surface cannot be cut, faces without area, UVs that cover no area.
    pub fn measured(&self) -> Result<Measured, Error> {
        let patches = self.surface.cut(self.seam_array())?;
        let all = self.surface.vertices();
        let m = self.triangles.len();
        let (mut uv, mut places, mut faces) = (Vec::new(), Vec::new(), vec![[0; 3]; m]);
        for patch in &patches {
            let first = uv.len();
            let corners: Vec<[u32; 3]> = rows(&patch.corner_of);
            let own: Vec<[u32; 3]> = rows(&patch.surface.faces());
            uv.resize(first + patch.vertex_of.len(), [0.0; 2]);
            places.extend(patch.vertex_of.iter().map(|&v| all.row(v.into()).to_vec()));
            for (corner, face) in corners.iter().flatten().zip(own.iter().flatten()) {
                let [triangle, place] = [corner / 3, corner % 3].map(|index| index as usize);
                uv[first + *face as usize] = self.point(self.triangles[triangle][place]);
                faces[triangle][place] = first as u32 + face;
            }
            let oriented: Vec<[u32; 3]> = rows(&patch.surface.oriented_faces()?);
            let area = |face: &[u32; 3]| signed_area(face.map(|vertex| uv[first + vertex as usize]));
            if oriented.iter().map(area).sum::<f64>() < 0.0 {
                uv[first..].iter_mut().for_each(|point| point[0] = -point[0]);
            }
        }
        let places: Vec<[f64; 3]> = places.iter().map(|place| std::array::from_fn(|k| place[k])).collect();
        measured(&uv, &places, &faces, patches.len())
    }

    /// The seams as an array, (s, 2).
    pub fn seam_array(&self) -> Array2<u32> {
        aview2(&self.seams()).to_owned()
    }

    fn point(&self, point: u32) -> [f64; 2] {
        self.points[point as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLACES: [[f64; 3]; 4] = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];

    #[test]
    fn seams_are_the_edges_with_different_uvs_on_both_sides() {
        let surface = Surface::new(aview2(&PLACES), aview2(&[[0, 1, 2], [0, 2, 3]])).unwrap();
        let points = [[0., 0.], [1., 0.], [1., 1.], [0., 1.], [0., 0.], [5., 5.]];
        let seams =
            |triangles: &[[u32; 3]]| GivenUv { surface: &surface, points: &points, triangles }.seams();
        assert_eq!(seams(&[[0, 1, 2], [0, 2, 3]]), [[0; 2]; 0]);
        assert_eq!(seams(&[[0, 1, 2], [4, 2, 3]]), [[0; 2]; 0], "points at one place are one");
        assert_eq!(seams(&[[0, 1, 2], [0, 5, 3]]), [[0, 2]]);
    }

    #[test]
    fn mirrored_islands_are_not_flipped() {
        let surface = Surface::new(aview2(&PLACES), aview2(&[[0, 1, 2], [0, 2, 3]])).unwrap();
        let points = [[0., 0.], [-1., 0.], [-1., 1.], [0., 1.], [7., 7.], [8., 8.], [7., 8.]];
        let given = GivenUv { surface: &surface, points: &points, triangles: &[[0, 1, 2], [4, 5, 6]] };
        let found = given.measured().unwrap();
        assert_eq!((found.figures.islands, found.figures.flipped), (2, 0));
        assert!(found.figures.area_error < 1e-12 && (found.figures.shear - 1.0).abs() < 1e-12);
    }
}
