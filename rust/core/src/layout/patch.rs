// SPDX-License-Identifier: MIT OR Apache-2.0
//! A part of a chart whose vertices move while all others stay.

use super::chart::{Chart, Point, center_polar_corners};
use super::projection::Projection;
use crate::mesh::corners::VertexCorners;
use crate::mesh::{Corner, Face, Vertex};
use crate::parallel;

/// Vertices that move and the faces around them, both numbered within the patch.
pub(super) struct Patch {
    /// The vertices that move, ascending.
    pub vertices: Vec<Vertex>,
    /// The faces around them, ascending.
    pub faces: Vec<Face>,
    /// (faces, 3): positions in `vertices`; `vertices.len()` for every vertex that stays.
    pub corners_of_faces: Vec<[Vertex; 3]>,
    /// The corners of these faces at each vertex that moves.
    pub corners: VertexCorners,
    /// The corners at poles, as in [`Chart::polar`].
    pub polar: Vec<Vec<Corner>>,
}

impl Patch {
    /// The vertices within `rings` rings of faces around the `chosen` faces, except those `fixed`.
    pub fn around<P: Projection>(
        chart: &Chart<'_, P>,
        corners: &VertexCorners,
        fixed: &[bool],
        chosen: &[Face],
        rings: usize,
    ) -> Self {
        // 1. Collect vertices ring by ring.
        let mut vertices = Marked::new(chart.places.len());
        let mut faces = Marked::new(chart.faces.len());
        chosen.iter().for_each(|&face| faces.add(face));
        let (mut next_face, mut next_vertex) = (0, 0);
        for _ in 0..=rings {
            while let Some(&face) = faces.list.get(next_face) {
                next_face += 1;
                chart.faces[face].iter().for_each(|&vertex| vertices.add(vertex));
            }
            let border = next_vertex..vertices.list.len();
            next_vertex = border.end;
            for k in border {
                corners.of(vertices.list[k]).iter().for_each(|&corner| faces.add(corner.face()));
            }
        }
        // 2. Add faces that share a corner at a pole.
        for group in &chart.polar {
            if group.iter().any(|&corner| faces.is_marked[corner.face()]) {
                group.iter().for_each(|&corner| faces.add(corner.face()));
            }
        }
        vertices.list.retain(|&vertex| !fixed[vertex]);
        Self::of(chart, vertices.list, faces.list)
    }

    /// The patch of these vertices and faces.
    fn of<P: Projection>(chart: &Chart<'_, P>, mut vertices: Vec<Vertex>, mut faces: Vec<Face>) -> Self {
        vertices.sort_unstable();
        faces.sort_unstable();
        let none = Vertex::new(vertices.len());
        let vertex_number = numbers(&vertices, chart.places.len());
        let face_number = numbers(&faces, chart.faces.len());
        let corners_of_faces = parallel::map(faces.len(), |index| {
            chart.faces[faces[index]].map(|vertex| Vertex(vertex_number[vertex]).min(none))
        });
        let in_patch = |corner: &Corner| Face(face_number[corner.face()]).corner(corner.place());
        let polar = chart.polar.iter().filter(|group| face_number[group[0].face()] != u32::MAX);
        Self {
            corners: VertexCorners::new(vertices.len() + 1, &corners_of_faces),
            polar: polar.map(|group| group.iter().map(in_patch).collect()).collect(),
            vertices,
            faces,
            corners_of_faces,
        }
    }

    /// The images of the faces.
    pub fn images<P: Projection>(&self, chart: &Chart<'_, P>) -> Vec<[Point; 3]> {
        let mut images = parallel::map(self.faces.len(), |index| chart.corner_images(self.faces[index]));
        center_polar_corners(&self.polar, &mut images);
        images
    }

    /// Picks the values of the patch's faces out of one value per face of the chart.
    pub fn of_faces(&self, values: &[f64]) -> Vec<f64> {
        self.faces.iter().map(|&face| values[face]).collect()
    }

    /// Picks the values of the patch's vertices out of one value per vertex of the chart.
    pub fn of_vertices<T: Copy>(&self, values: &[T]) -> Vec<T> {
        self.vertices.iter().map(|&vertex| values[vertex]).collect()
    }

    /// Moves the vertices to these places.
    pub fn put<P: Projection>(&self, chart: &mut Chart<'_, P>, places: &[Point]) {
        for (&vertex, &place) in self.vertices.iter().zip(places) {
            chart.places[vertex] = place;
        }
    }

    /// Whether a corner of a face of the patch moves.
    pub fn moves(&self, face: usize, corner: usize) -> bool {
        self.corners_of_faces[face][corner].index() < self.vertices.len()
    }
}

/// A growing list of distinct indices.
struct Marked<T> {
    list: Vec<T>,
    is_marked: Vec<bool>,
}

impl<T: Copy + Into<usize>> Marked<T> {
    fn new(count: usize) -> Self {
        Self { list: Vec::new(), is_marked: vec![false; count] }
    }

    fn add(&mut self, index: T) {
        if !std::mem::replace(&mut self.is_marked[index.into()], true) {
            self.list.push(index);
        }
    }
}

/// The position of each index in a list, `u32::MAX` if it is not in it.
fn numbers(list: &[impl Copy + Into<usize>], count: usize) -> Vec<u32> {
    let mut number = vec![u32::MAX; count];
    list.iter().zip(0..).for_each(|(&index, position)| number[index.into()] = position);
    number
}
