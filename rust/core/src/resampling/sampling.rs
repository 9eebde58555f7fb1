// SPDX-License-Identifier: MIT OR Apache-2.0
//! Values of a surface at points of its image.

use ndarray::{Array2, ArrayView2};

use super::inverse::{InverseMap, Outside};
use crate::control::Observer;
use crate::error::Error;
use crate::location::Location;
use crate::mesh::Vertex;
use crate::parallel;

/// The elements of a surface that values belong to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PerElement {
    /// One row per vertex: linear on each face.
    Vertex,
    /// One row per face: constant on each face.
    Face,
}

impl InverseMap {
    /// The number of rows that values have.
    pub fn n_rows(&self, per: PerElement) -> usize {
        match per {
            PerElement::Vertex => self.n_vertices(),
            PerElement::Face => self.n_faces(),
        }
    }

    /// Values (n, k) or (m, k) of the surface at `points` as [`Self::locate`] takes them; `fill` where there is no
    /// place.
    ///
    /// # Errors
    /// As [`Self::locate`], and [`Error::InvalidArray`] for another number of values.
    pub fn sample(
        &self,
        values: ArrayView2<'_, f64>,
        per: PerElement,
        points: ArrayView2<'_, f64>,
        (outside, fill): (Outside, f64),
        observer: &mut dyn Observer,
    ) -> Result<Array2<f64>, Error> {
        self.check_values(values, per)?;
        let places = self.locations(&self.points(points)?, outside, observer)?;
        let (values, width) = (values.as_standard_layout(), values.ncols());
        let flat = values.as_slice().expect("in standard layout");
        let row = |index: usize| &flat[index * width..(index + 1) * width];
        let value = |place: &Location, column: usize| match per {
            PerElement::Face => row(place.triangle.index())[column],
            PerElement::Vertex => {
                let corners = self.whole_faces[place.triangle];
                (0..3).map(|k| place.barycentric[k] * row(corners[k].index())[column]).sum()
            }
        };
        let at_points = |entry: usize| match &places[entry / width] {
            Some(place) => value(place, entry % width),
            None => fill,
        };
        let sampled = parallel::map(places.len() * width, at_points);
        Ok(Array2::from_shape_vec((places.len(), width), sampled).expect("one row per point"))
    }

    /// The row that each of `points` takes of labels, which are not interpolated: the face, or the vertex of the face
    /// that is nearest by barycentric coordinates; `None` where there is no place.
    ///
    /// # Errors
    /// As [`Self::locate`].
    pub fn nearest_rows(
        &self,
        per: PerElement,
        points: ArrayView2<'_, f64>,
        outside: Outside,
        observer: &mut dyn Observer,
    ) -> Result<Vec<Option<usize>>, Error> {
        let places = self.locations(&self.points(points)?, outside, observer)?;
        let row = |place: &Location| match per {
            PerElement::Face => place.triangle.index(),
            PerElement::Vertex => self.nearest_corner(place).index(),
        };
        Ok(parallel::map(places.len(), |k| places[k].as_ref().map(row)))
    }

    fn nearest_corner(&self, place: &Location) -> Vertex {
        let weights = place.barycentric;
        let heaviest = (1..3).fold(0, |best, k| if weights[k] > weights[best] { k } else { best });
        self.whole_faces[place.triangle][heaviest]
    }

    pub(super) fn check_values(&self, values: ArrayView2<'_, f64>, per: PerElement) -> Result<(), Error> {
        let rows = self.n_rows(per);
        if values.nrows() == rows {
            return Ok(());
        }
        let (found, expected) = (format!("of {} rows", values.nrows()), format!("of {rows} rows"));
        Err(Error::InvalidArray { name: "values", found, expected })
    }
}
