// SPDX-License-Identifier: MIT OR Apache-2.0
//! Values of the given vertices or faces on the repaired surface.
//!
//! Copies have the values of their originals. Elements that a repair added are filled in rounds, from the surface around
//! them inward: each takes the mean of its neighbors that have a value. Cost: the number of values, and of the neighbors
//! of added elements.

use ndarray::{Array2, ArrayView2};

use super::repaired::Repaired;
use crate::error::Error;
use crate::mesh::{EdgeTable, Face, Vertex, VertexCorners};

/// An added element, and its neighbors that have values before it.
type Added = (usize, Vec<usize>);

impl Repaired {
    /// Values (n, k) of the given vertices, one row for each vertex of the surface.
    ///
    /// # Errors
    /// [`Error::InvalidArray`] where there is not one row for each given vertex.
    pub fn values_on_vertices(&self, given: ArrayView2<'_, f64>) -> Result<Array2<f64>, Error> {
        check_rows(given, self.vertex_to.len(), "vertex")?;
        Ok(carried(given, &numbers(&self.vertex_of), &self.added_vertices()))
    }

    /// Values (m, k) of the given faces, one row for each face of the surface.
    ///
    /// # Errors
    /// [`Error::InvalidArray`] where there is not one row for each given face.
    pub fn values_on_faces(&self, given: ArrayView2<'_, f64>) -> Result<Array2<f64>, Error> {
        check_rows(given, self.face_to.len(), "face")?;
        Ok(carried(given, &numbers(&self.face_of), &self.added_faces()))
    }

    /// The given vertex whose label each vertex takes; that of its first neighbor where it was added.
    pub fn nearest_vertices(&self) -> Vec<usize> {
        nearest(numbers(&self.vertex_of), &self.added_vertices())
    }

    /// The given face whose label each face takes; that of its first neighbor where it was added.
    pub fn nearest_faces(&self) -> Vec<usize> {
        nearest(numbers(&self.face_of), &self.added_faces())
    }

    fn added_vertices(&self) -> Vec<Added> {
        let faces = self.surface.face_rows();
        let corners = VertexCorners::new(self.surface.n_vertices(), faces);
        in_rounds(&numbers(&self.vertex_of), |vertex| {
            let around = corners.of(Vertex::new(vertex)).iter().flat_map(|corner| faces[corner.face()]);
            around.map(Vertex::index).filter(|&neighbor| neighbor != vertex).collect()
        })
    }

    fn added_faces(&self) -> Vec<Added> {
        let opposite = EdgeTable::new(self.surface.n_vertices(), self.surface.face_rows()).opposites();
        in_rounds(&numbers(&self.face_of), |face| {
            let across = Face::new(face).corners().into_iter().filter_map(|corner| opposite[corner]);
            across.map(|corner| corner.face().index()).collect()
        })
    }
}

fn numbers<T: Copy + Into<usize>>(list: &[Option<T>]) -> Vec<Option<usize>> {
    list.iter().map(|index| index.map(Into::into)).collect()
}

/// The elements that come from none, those next to others first.
fn in_rounds(sources: &[Option<usize>], neighbors: impl Fn(usize) -> Vec<usize>) -> Vec<Added> {
    let mut has_value: Vec<bool> = sources.iter().map(Option::is_some).collect();
    let mut pending: Vec<usize> = (0..sources.len()).filter(|&element| !has_value[element]).collect();
    let mut added: Vec<Added> = Vec::with_capacity(pending.len());
    while !pending.is_empty() {
        let first = added.len();
        pending.retain(|&element| {
            let mut around = neighbors(element);
            around.retain(|&neighbor| has_value[neighbor]);
            around.sort_unstable();
            around.dedup();
            let is_next = !around.is_empty();
            if is_next {
                added.push((element, around));
            }
            !is_next
        });
        if added.len() == first {
            break;
        }
        added[first..].iter().for_each(|&(element, _)| has_value[element] = true);
    }
    added
}

fn carried(given: ArrayView2<'_, f64>, sources: &[Option<usize>], added: &[Added]) -> Array2<f64> {
    let mut values = Array2::from_elem((sources.len(), given.ncols()), f64::NAN);
    for (mut row, source) in values.rows_mut().into_iter().zip(sources) {
        if let Some(source) = source {
            row.assign(&given.row(*source));
        }
    }
    for (element, neighbors) in added {
        for column in 0..given.ncols() {
            let sum: f64 = neighbors.iter().map(|&neighbor| values[[neighbor, column]]).sum();
            values[[*element, column]] = sum / neighbors.len() as f64;
        }
    }
    values
}

fn nearest(mut sources: Vec<Option<usize>>, added: &[Added]) -> Vec<usize> {
    added.iter().for_each(|(element, neighbors)| sources[*element] = sources[neighbors[0]]);
    sources.into_iter().map(Option::unwrap_or_default).collect()
}

fn check_rows(given: ArrayView2<'_, f64>, n: usize, element: &str) -> Result<(), Error> {
    if given.nrows() == n {
        return Ok(());
    }
    let found = format!("of {} rows", given.nrows());
    let expected = format!("of {n} rows, one per given {element}");
    Err(Error::InvalidArray { name: "values", found, expected })
}
