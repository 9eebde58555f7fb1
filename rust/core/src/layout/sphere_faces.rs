// SPDX-License-Identifier: MIT OR Apache-2.0
//! A map onto the sphere as a surface; checks of the options that are arrays.

use std::f64::consts::PI;

use ndarray::{ArrayView1, Axis, concatenate};

use crate::codomain::spherical::onto_sphere;
use crate::distortion::normalized_density;
use crate::error::{Elements, Error, MapError};
use crate::mesh::geometry::{area, triangle};
use crate::mesh::{EdgeTable, Surface, Vertex};
use crate::parallel;
use crate::sphere::SphereFilling;
use crate::vector::Vector3;

/// A map onto the sphere as it is laid out: faces between vertices, or the parts of split faces.
#[derive(Debug, Clone)]
pub struct SphereFaces {
    /// The image: vertices on the unit sphere, faces counter-clockwise seen from outside.
    pub image: Surface,
    /// (m,): the target measure of each face, positive, on any scale.
    pub targets: Vec<f64>,
    /// (m,): the face of the map that each face is a part of, ascending. `None`: no face is split.
    pub face_of: Option<Vec<usize>>,
    /// The number of vertices of the map; the vertices of `image` after these are split points, or lie inside holes.
    pub n_vertices: usize,
    /// The number of faces of `image` that fill holes: the last ones, which are not laid out.
    pub n_filling: usize,
}

impl SphereFaces {
    /// The map of an open surface with its holes filled.
    ///
    /// # Errors
    /// Faces that do not fit the map.
    pub fn filled(&self, filling: &SphereFilling) -> Result<Self, Error> {
        let positions = concatenate![Axis(0), self.image.vertices(), filling.positions];
        let faces = concatenate![Axis(0), self.image.faces(), filling.faces];
        Ok(Self {
            image: Surface::new(positions, faces)?,
            targets: [&self.targets[..], &filling.targets].concat(),
            face_of: None,
            n_vertices: self.n_vertices,
            n_filling: filling.targets.len(),
        })
    }

    /// Checks that the arrays fit each other.
    ///
    /// # Errors
    /// [`Error::InvalidArray`] where they do not.
    pub(super) fn check(&self) -> Result<(), Error> {
        let n_points = self.image.n_vertices();
        if self.n_vertices > n_points {
            let expected = format!("at least {} rows, one per vertex", self.n_vertices);
            return Err(Error::InvalidArray { name: "image", found: n_points.to_string(), expected });
        }
        self.check_closed()?;
        let Some(face_of) = &self.face_of else { return Ok(()) };
        check_length("face_of", face_of.len(), self.image.n_faces(), "one face per part")?;
        if face_of.is_sorted() {
            return Ok(());
        }
        let (found, expected) = ("in another order".into(), "ascending".into());
        Err(Error::InvalidArray { name: "face_of", found, expected })
    }

    /// Faces around a hole could come to lie over each other, so that holes must be filled.
    fn check_closed(&self) -> Result<(), Error> {
        let table = EdgeTable::new(self.image.n_vertices(), self.image.face_rows());
        let open = table.edges().filter(|(_, corners)| corners.len() == 1);
        let mut ends: Vec<Vertex> = open.flat_map(|(ends, _)| ends).collect();
        ends.sort_unstable();
        ends.dedup();
        match Elements::collect(ends) {
            None => Ok(()),
            Some(vertices) => Err(MapError::OpenOnSphere { vertices }.into()),
        }
    }

    /// The number of faces that are laid out.
    pub fn n_laid_out(&self) -> usize {
        self.image.n_faces() - self.n_filling
    }

    /// The positions, exactly on the unit sphere.
    pub(super) fn unit_positions(&self) -> Result<Vec<Vector3>, Error> {
        let positions = self.image.vertex_rows();
        let unit = parallel::map(positions.len(), |vertex| onto_sphere(Vector3(positions[vertex])));
        match Elements::collect((0..unit.len()).filter(|&vertex| unit[vertex].is_none())) {
            Some(vertices) => Err(MapError::NoDirection { name: "positions", vertices }.into()),
            None => Ok(unit.into_iter().flatten().collect()),
        }
    }

    /// The number of faces of the map, before splitting.
    fn n_whole_faces(&self) -> usize {
        let last_part = |face_of: &Vec<usize>| face_of.last().map_or(0, |&face| face + 1);
        self.face_of.as_ref().map_or(self.n_laid_out(), last_part)
    }

    /// The face of the map that a face is a part of; one of a filling is a face of its own, after all of the map.
    fn whole(&self, part: usize) -> usize {
        self.face_of.as_ref().map_or(part, |face_of| face_of[part])
    }

    /// The label of each face's polygon; the parts of a split face have the same label, faces of fillings their own.
    pub(super) fn labels(&self, polygons: Option<&[usize]>) -> Result<Option<Vec<usize>>, Error> {
        let n_parts = self.n_laid_out();
        let Some(polygons) = polygons else { return Ok(self.face_of.clone()) };
        check_length("polygons", polygons.len(), self.n_whole_faces(), "one number per face")?;
        let mut labels: Vec<usize> = (0..n_parts).map(|part| polygons[self.whole(part)]).collect();
        let mut taken = polygons.to_vec();
        taken.sort_unstable();
        let free = (0..).filter(|label| taken.binary_search(label).is_err());
        labels.extend(free.take(self.n_filling));
        Ok(Some(labels))
    }

    /// The target areas, which add up to the area of the sphere; the parts of a split face share its density in
    /// proportion to their targets, and holes keep their share of the sphere.
    pub(super) fn areas(&self, density: Option<ArrayView1<'_, f64>>) -> Result<Vec<f64>, Error> {
        let mut areas = normalized_density(&self.targets, self.image.n_faces())?;
        if let Some(density) = density {
            let density = normalized_density(&density.to_vec(), self.n_whole_faces())?;
            let mut sums = vec![0.0; density.len()];
            let n_parts = self.n_laid_out();
            (0..n_parts).for_each(|part| sums[self.whole(part)] += areas[part]);
            let of_holes = density.iter().sum::<f64>() / sums.iter().sum::<f64>();
            for (part, area) in areas.iter_mut().enumerate() {
                *area = if part < n_parts {
                    *area / sums[self.whole(part)] * density[self.whole(part)]
                } else {
                    *area * of_holes
                };
            }
        }
        let scale = 4.0 * PI / areas.iter().sum::<f64>();
        Ok(areas.iter().map(|area| scale * area).collect())
    }

    /// √(Σ (A − a)²/a), the flat areas A of the map's faces at unit `positions` against `targets` a, over that of Σ a.
    pub(super) fn deviation(&self, positions: &[Vector3], targets: &[f64]) -> f64 {
        let area = |face: usize| area(triangle(positions, self.image.face_rows()[face]));
        let scale = targets.iter().sum::<f64>() / parallel::sum(targets.len(), area);
        let energy = |face: usize| (scale * area(face) - targets[face]).powi(2) / targets[face];
        (parallel::sum(targets.len(), energy) / targets.iter().sum::<f64>()).sqrt()
    }

    /// Which vertices may be moved onto singular points; split points may not.
    pub(super) fn candidates(
        &self,
        candidates: Option<&[bool]>,
        needed: usize,
    ) -> Result<Option<Vec<bool>>, Error> {
        let Some(candidates) = candidates else { return Ok(None) };
        check_length("candidates", candidates.len(), self.n_vertices, "one truth value per vertex")?;
        let n_candidates = candidates.iter().filter(|&&may_move| may_move).count();
        if n_candidates < needed {
            let expected = format!("at least {needed} vertices, one for each singular point");
            return Err(Error::InvalidArray {
                name: "candidates",
                found: n_candidates.to_string(),
                expected,
            });
        }
        let mut all = candidates.to_vec();
        all.resize(self.image.n_vertices(), false);
        Ok(Some(all))
    }
}

fn check_length(name: &'static str, found: usize, expected: usize, what: &str) -> Result<(), Error> {
    if found == expected {
        return Ok(());
    }
    let expected = format!("of shape ({expected},), {what}");
    Err(Error::InvalidArray { name, found: format!("of shape ({found},)"), expected })
}
