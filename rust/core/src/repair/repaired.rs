// SPDX-License-Identifier: MIT OR Apache-2.0
//! The result of a repair.

use ndarray::{Array1, ArrayView1};

use super::counts::{RepairCounts, counted};
use crate::error::Error;
use crate::mesh::geometry::face_areas;
use crate::mesh::{Face, Surface, Vertex, geometry};

/// A repaired surface, with maps between it and the mesh given.
#[derive(Debug, Clone)]
pub struct Repaired {
    /// The surface. Vertices that were kept have the coordinates given.
    pub surface: Surface,
    /// The given vertex of which each vertex is a copy, (n,); none for those that were added.
    pub vertex_of: Vec<Option<Vertex>>,
    /// The given face that each face is, or is a part of, (m,); none for those that were added.
    pub face_of: Vec<Option<Face>>,
    /// The vertex that each given vertex became, the first where it was split; none for those that were dropped.
    pub vertex_to: Vec<Option<Vertex>>,
    /// The face that each given face became, the first where it was split; none for those that were dropped.
    pub face_to: Vec<Option<Face>>,
    /// How many repairs of each kind were made.
    pub counts: RepairCounts,
}

impl Repaired {
    /// Whether the surface differs from the mesh given.
    pub fn is_changed(&self) -> bool {
        self.counts != RepairCounts::default()
    }

    /// What was done and what the surface is now, a line for each.
    pub fn report(&self) -> String {
        let mut lines = self.counts.sentences();
        if lines.is_empty() {
            lines.push("nothing to repair".into());
        }
        lines.push(self.description());
        lines.join("\n")
    }

    /// What the surface is now, and what keeps it from being mapped.
    fn description(&self) -> String {
        let [n_vertices, n_faces] = [self.surface.n_vertices(), self.surface.n_faces()];
        let size = format!("{}, {}", counted(n_vertices, "vertex"), counted(n_faces, "face"));
        let topology = match self.surface.topology() {
            Ok(topology) => topology,
            Err(error) => return format!("result: {size}; {error}"),
        };
        let pieces = counted(topology.n_components(), "piece");
        let loops = match topology.boundary_loops.len() {
            0 => "closed".into(),
            loops => counted(loops, "boundary loop"),
        };
        let handles = counted(topology.genus.unwrap_or_default(), "handle");
        format!("result: {size}; {pieces}, {loops}, {handles}")
    }

    /// A measure of each given face, (m,), as one of the faces of the surface.
    ///
    /// The parts of a face share its measure by their areas. Faces that were added have the mean measure per area.
    ///
    /// # Errors
    /// [`Error::InvalidArray`] where there is not one value for each given face.
    pub fn measure(&self, given: ArrayView1<'_, f64>) -> Result<Array1<f64>, Error> {
        if given.len() != self.face_to.len() {
            let found = format!("of shape ({},)", given.len());
            let expected = format!("of shape ({},), one value per face", self.face_to.len());
            return Err(Error::InvalidArray { name: "density", found, expected });
        }
        let (points, _) = geometry::normalized(self.surface.vertex_rows());
        let areas = face_areas(&points, self.surface.face_rows());
        let mut whole = vec![0.0; given.len()];
        let kept =
            || self.face_of.iter().zip(&areas).filter_map(|(face, area)| face.map(|face| (face, area)));
        kept().for_each(|(face, area)| whole[face] += area);
        let (total, area): (f64, f64) = (
            kept().map(|(face, area)| given[face.index()] * area / whole[face]).sum(),
            kept().map(|(_, area)| area).sum(),
        );
        let measure = |(face, part): (&Option<Face>, &f64)| match face {
            Some(face) => given[face.index()] * part / whole[*face],
            None => part * total / area,
        };
        Ok(self.face_of.iter().zip(&areas).map(measure).collect())
    }
}
