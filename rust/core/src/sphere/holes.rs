// SPDX-License-Identifier: MIT OR Apache-2.0
//! Holes that are filled for the time of a map, so that an open surface maps like a closed one.
//!
//! Every boundary loop is filled by a smooth [membrane], whose vertices and faces are dropped from the result. The
//! fillings keep the holes open on the sphere, at about the size that they have on the surface.

use ndarray::Array1;

use super::options::SphereMapOptions;
use crate::error::Error;
use crate::filling::membrane;
use crate::mesh::TriangleMesh;
use crate::vector::coordinates;

/// A surface with its holes filled; the given vertices and faces come first.
pub(super) struct Filled {
    pub mesh: TriangleMesh,
    /// The target of each face; fillings have the mean density of the surface.
    pub targets: Array1<f64>,
}

/// Fills all holes. `targets` are those of the given faces.
///
/// # Errors
/// As [`TriangleMesh::new`], where a filling doubles a face.
pub(super) fn fill_holes(mesh: &TriangleMesh, targets: &[f64]) -> Result<Filled, Error> {
    let (mut points, mut faces) = (mesh.points().to_vec(), mesh.faces().to_vec());
    mesh.boundary_loops().iter().for_each(|hole| membrane(hole, &mut points, &mut faces));
    let filled = TriangleMesh::new(&coordinates(points), &faces)?;
    let (given, added) = filled.face_areas().split_at(targets.len());
    let density = targets.iter().sum::<f64>() / given.iter().sum::<f64>();
    let of_fillings = added.iter().map(|area| density * area);
    let targets = targets.iter().copied().chain(of_fillings).collect();
    Ok(Filled { mesh: filled, targets })
}

/// Refuses options that would have to know the fillings.
pub(super) fn check(options: &SphereMapOptions<'_>) -> Result<(), Error> {
    for (name, is_given) in [("initial", options.initial.is_some()), ("refine", options.refine)] {
        if is_given {
            let expected = "left out where holes are filled; close them by repair before".into();
            return Err(Error::InvalidOption { name, found: "given".into(), expected });
        }
    }
    Ok(())
}
