// SPDX-License-Identifier: MIT OR Apache-2.0
//! Landmarks and paths of the given vertices on the repaired surface, and its errors in the numbers given.

use super::repaired::Repaired;
use crate::error::{CurveError, Elements, Error, LandmarkError, Side};
use crate::mesh::{Vertex, VertexCorners};

impl Repaired {
    /// The vertices that landmarks of one side became.
    ///
    /// # Errors
    /// [`LandmarkError::Dropped`] where a landmark is no vertex of the surface.
    pub fn landmarks(&self, side: Side, given: &[usize]) -> Result<Vec<usize>, Error> {
        let dropped = (0..given.len()).filter(|&pair| self.vertex_to[given[pair]].is_none());
        match Elements::collect(dropped) {
            Some(pairs) => {
                let vertex = given[pairs.first[0]];
                Err(LandmarkError::Dropped { side, pairs, vertex }.into())
            }
            None => Ok(given.iter().map(|&vertex| self.vertex_to[vertex].map_or(0, Vertex::index)).collect()),
        }
    }

    /// The paths of vertices that curves of one side became.
    ///
    /// Vertices that were merged are one. Of a vertex that was split, the copy beside the one before is taken.
    ///
    /// # Errors
    /// [`CurveError::Dropped`] where a vertex of a curve is none of the surface.
    pub fn curves(&self, side: Side, given: &[Vec<usize>]) -> Result<Vec<Vec<usize>>, Error> {
        let path = |(curve, path): (usize, &Vec<usize>)| {
            let dropped = (0..path.len()).find(|&place| self.vertex_to[path[place]].is_none());
            match dropped {
                Some(place) => Err(CurveError::Dropped { side, curve, place, vertex: path[place] }.into()),
                None => Ok(self.path(path)),
            }
        };
        given.iter().enumerate().map(path).collect()
    }

    /// A path along copies of the given vertices, each beside the one before where there is such a path.
    fn path(&self, given: &[usize]) -> Vec<usize> {
        // 1. The copies of each vertex
        let firsts: Vec<Vertex> = given.iter().filter_map(|&vertex| self.vertex_to[vertex]).collect();
        let is_copy = |vertex: Vertex, of: Vertex| {
            vertex == of || (self.vertex_of[vertex].is_some() && self.vertex_of[vertex] == self.vertex_of[of])
        };
        let copies = |first: &Vertex| -> Vec<Vertex> {
            let others = Vertex::all(self.vertex_of.len()).filter(|&vertex| vertex != *first);
            std::iter::once(*first).chain(others.filter(|&vertex| is_copy(vertex, *first))).collect()
        };
        let mut path = firsts.clone();
        if self.counts.split_vertices > 0 {
            let layers: Vec<Vec<Vertex>> = firsts.iter().map(copies).collect();
            path = self.joined(&layers).unwrap_or(path);
        }
        // 2. Vertices that have become one
        path.dedup();
        path.into_iter().map(Vertex::index).collect()
    }

    /// A path along edges through one vertex of each layer.
    fn joined(&self, layers: &[Vec<Vertex>]) -> Option<Vec<Vertex>> {
        let faces = self.surface.face_rows();
        let corners = VertexCorners::new(self.surface.n_vertices(), faces);
        let are_beside = |a: Vertex, b: Vertex| {
            a == b || corners.of(a).iter().any(|corner| faces[corner.face()].contains(&b))
        };
        // the place in the layer before from which each vertex is reached
        let mut before: Vec<Vec<Option<usize>>> = vec![vec![Some(0); layers.first()?.len()]];
        for (previous, layer) in layers.iter().zip(&layers[1..]) {
            let reached = before.last()?;
            let from = |&vertex: &Vertex| {
                (0..previous.len()).find(|&k| reached[k].is_some() && are_beside(previous[k], vertex))
            };
            let next = layer.iter().map(from).collect();
            before.push(next);
        }
        let mut place = before.last()?.iter().position(Option::is_some)?;
        let mut path = Vec::with_capacity(layers.len());
        for (layer, before) in layers.iter().zip(&before).rev() {
            path.push(layer[place]);
            place = before[place]?;
        }
        path.reverse();
        Some(path)
    }

    /// An error about the surface with the numbers of the given vertices and faces.
    #[must_use]
    pub fn in_given_numbers(&self, error: Error) -> Error {
        if !self.is_changed() {
            return error;
        }
        let (vertices, faces) = (self.nearest_vertices(), self.nearest_faces());
        let number = |list: &[usize], index: usize| list.get(index).copied().unwrap_or(index);
        error.renumbered(&|vertex| number(&vertices, vertex), &|face| number(&faces, face))
    }
}
