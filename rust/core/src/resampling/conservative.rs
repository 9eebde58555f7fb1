// SPDX-License-Identifier: MIT OR Apache-2.0
//! Means of values over cells, weighted by area: what conserves their integral.
//!
//! Values per vertex count on each face by the mean of its corners, values per face as they are. A cell has the sum of
//! the areas of its overlaps with the image's faces times the values there; summed over all cells that is the integral
//! over the image, whatever the cells are. Where vertices of an icosphere are asked for, each face gives a third of its
//! sum and area to each corner.
//!
//! Cost: the number of overlaps.

use ndarray::{Array1, Array2, ArrayView2};

use super::clipping;
use super::coverage::{self, Overlap};
use super::grids::Grid;
use super::icosphere::Icosphere;
use super::inverse::InverseMap;
use super::sampling::PerElement;
use crate::control::{Observer, Watch};
use crate::error::Error;
use crate::mesh::Vertex;
use crate::mesh::geometry::triangle;
use crate::parallel;
use crate::vector::Vector3;

/// An area that is as good as none, in parts of the largest of a grid.
const ROUNDING: f64 = 1e-12;

/// Faces whose overlaps are found by one task.
const BLOCK: usize = 1024;

/// Tasks between which the sums are taken and the observer is asked.
const TASKS: usize = 16;

/// The integrals of values over the cells of a grid.
#[derive(Debug, Clone)]
pub struct CellIntegrals {
    /// (c, k): the integral of each value over each cell.
    pub totals: Array2<f64>,
    /// (c,): the area of each cell that the image covers.
    pub areas: Array1<f64>,
}

impl CellIntegrals {
    fn new(n_cells: usize, width: usize) -> Self {
        Self { totals: Array2::zeros((n_cells, width)), areas: Array1::zeros(n_cells) }
    }

    /// The means over the part of each cell that the image covers; `fill` where it covers nothing, or no more than
    /// rounding makes of nothing.
    pub fn means(&self, fill: f64) -> Array2<f64> {
        let mut means = self.totals.clone();
        let nothing = ROUNDING * self.areas.fold(0.0, |most, &area| f64::max(most, area));
        for (mut row, &area) in means.rows_mut().into_iter().zip(&self.areas) {
            row.mapv_inplace(|total| if area > nothing { total / area } else { fill });
        }
        means
    }
}

impl InverseMap {
    /// The integrals over the cells of a grid of values (n, k) or (m, k) of the surface.
    ///
    /// # Errors
    /// [`Error::InvalidArray`] for another number of values, [`Error::InvalidOption`] for a grid of another domain;
    /// [`Error::CancelledEarly`].
    pub fn integrate(
        &self,
        values: ArrayView2<'_, f64>,
        per: PerElement,
        grid: &Grid,
        observer: &mut dyn Observer,
    ) -> Result<CellIntegrals, Error> {
        grid.check()?;
        if grid.is_round() == self.in_plane {
            let expected = if self.in_plane { "a planar grid" } else { "a grid of the sphere" };
            let found = format!("{grid:?}");
            return Err(Error::InvalidOption { name: "grid", found, expected: expected.into() });
        }
        let [rows, columns] = grid.shape();
        let found = |face: usize, out: &mut Vec<Overlap>| {
            coverage::overlaps(grid, self.faces[face], self.corners(face), out);
        };
        self.integrated(values, per, rows * columns, found, observer)
    }

    /// The integrals over the faces of an icosphere of values (n, k) or (m, k) of the surface.
    ///
    /// # Errors
    /// As [`Self::integrate`].
    pub fn integrate_on_icosphere(
        &self,
        values: ArrayView2<'_, f64>,
        per: PerElement,
        icosphere: &Icosphere,
        observer: &mut dyn Observer,
    ) -> Result<CellIntegrals, Error> {
        if self.in_plane {
            let (found, expected) = ("a disk".into(), "a map onto the sphere".into());
            return Err(Error::InvalidOption { name: "map", found, expected });
        }
        let found =
            |face: usize, out: &mut Vec<Overlap>| clipping::overlaps(icosphere, self.corners(face), out);
        self.integrated(values, per, icosphere.finest().len(), found, observer)
    }

    fn corners(&self, face: usize) -> [Vector3; 3] {
        triangle(&self.positions, self.faces[face])
    }

    /// The sums over the overlaps that `found(face, out)` finds.
    fn integrated(
        &self,
        values: ArrayView2<'_, f64>,
        per: PerElement,
        n_cells: usize,
        found: impl Fn(usize, &mut Vec<Overlap>) + Sync + Send,
        observer: &mut dyn Observer,
    ) -> Result<CellIntegrals, Error> {
        self.check_values(values, per)?;
        let on_faces = self.on_faces(values, per);
        let mut sums = CellIntegrals::new(n_cells, values.ncols());
        let watch = Watch::new(observer, 0.0, "Adding up areas");
        let n_blocks = self.faces.len().div_ceil(BLOCK);
        for first in (0..n_blocks).step_by(TASKS) {
            watch.reach(first as f64 / n_blocks as f64);
            if !watch.goes_on() {
                return Err(Error::CancelledEarly);
            }
            let blocks = parallel::tasks(TASKS.min(n_blocks - first), |block| {
                let faces = (first + block) * BLOCK..self.faces.len().min((first + block + 1) * BLOCK);
                let mut overlaps = Vec::new();
                let ends: Vec<(usize, usize)> = faces
                    .map(|face| {
                        found(face, &mut overlaps);
                        (face, overlaps.len())
                    })
                    .collect();
                (overlaps, ends)
            });
            // in the order of the faces, so that the sums do not depend on the threads
            for (overlaps, ends) in blocks {
                let mut next = 0;
                for (face, end) in ends {
                    let of_face = on_faces.row(face);
                    for overlap in &overlaps[next..end] {
                        sums.areas[overlap.cell] += overlap.area;
                        sums.totals.row_mut(overlap.cell).scaled_add(overlap.area, &of_face);
                    }
                    next = end;
                }
            }
        }
        Ok(sums)
    }

    /// The value of each face of the image, or part of a face.
    fn on_faces(&self, values: ArrayView2<'_, f64>, per: PerElement) -> Array2<f64> {
        let mut on_faces = Array2::zeros((self.faces.len(), values.ncols()));
        for (part, mut row) in on_faces.rows_mut().into_iter().enumerate() {
            let (face, weights) = self.middle_of(part);
            match per {
                PerElement::Face => row.assign(&values.row(face)),
                PerElement::Vertex => {
                    for (corner, weight) in self.whole_faces[face].into_iter().zip(weights) {
                        row.scaled_add(weight, &values.row(corner.index()));
                    }
                }
            }
        }
        on_faces
    }
}

impl Icosphere {
    /// Integrals over the faces, given to the vertices: a third to each corner.
    pub fn to_vertices(&self, of_faces: &CellIntegrals) -> CellIntegrals {
        let mut sums = CellIntegrals::new(self.points.len(), of_faces.totals.ncols());
        for (face, corners) in self.finest().iter().enumerate() {
            for corner in corners.map(Vertex::index) {
                sums.areas[corner] += of_faces.areas[face] / 3.0;
                sums.totals.row_mut(corner).scaled_add(1.0 / 3.0, &of_faces.totals.row(face));
            }
        }
        sums
    }
}
