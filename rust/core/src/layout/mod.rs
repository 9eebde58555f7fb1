// SPDX-License-Identifier: MIT OR Apache-2.0
//! Lays a map onto the sphere out in the plane, by a projection that keeps areas: [`SphereMap::layout`].
//!
//! 1. A layout has singular points: the poles of Lambert's cylinder ([`lambert`]), four points of the equator for the
//!    octahedral square ([`octahedral`]). A face with one inside would fold over, so that first a vertex is moved onto
//!    each of them by motions of the sphere that keep areas ([`singular_points`], [`twist`]).
//! 2. The mesh is laid out face by face ([`development`]). The images of one point differ by isometries of the plane
//!    ([`isometry`]), so that vertices can be moved in the plane without tearing the layout.
//! 3. What straight edges do to areas, near poles and across creases, is evened out in the plane ([`relaxation`]), and
//!    what they fold unfolded ([`unfolding`]).
//! 4. Vertices on the seam become several points ([`seam`]). Exact predicates decide, on points in the precision asked
//!    for, what is folded ([`certificate`]): there is a layout without folds or an error.
//!
//! Holes stay filled until the end, so that the faces around them keep apart.
//!
//! Input: a map without folds of a closed surface, or of one whose holes were filled. Cost: a few hundred passes over the faces near singular points and
//! creases, an eighth of the map's time as a rule.

mod area_system;
mod attempts;
mod certificate;
mod chart;
mod development;
mod isometry;
mod lambert;
mod octahedral;
mod options;
mod patch;
mod polygons;
mod projection;
mod relaxation;
#[cfg(test)]
mod sample_spheres;
mod seam;
mod singular_points;
mod sphere_faces;
mod twist;
mod unfolding;

use ndarray::{ArrayView2, Axis, concatenate};

use crate::control::Observer;
use crate::error::Error;
use crate::mesh::Surface;
use crate::parallel;
use crate::sphere::SphereMap;
use attempts::Run;
pub use certificate::Precision;
use lambert::Lambert;
use octahedral::Octahedral;
pub use options::{LayoutKind, LayoutOptions, Seam};
pub use seam::Layout;
pub use sphere_faces::SphereFaces;

impl SphereMap {
    /// Lays the map out in the plane, cut open along a seam, so that areas are kept and no face is folded.
    ///
    /// `surface` is the surface that was mapped. Where its faces were split, their parts are laid out.
    ///
    /// # Errors
    /// Arrays of the wrong length and options out of range; [`MapError::OpenOnSphere`](crate::MapError::OpenOnSphere) for
    /// holes without a filling.
    /// [`NumericsError::LayoutFolds`](crate::NumericsError::LayoutFolds) if faces fold wherever the singular points are
    /// put; [`Error::CancelledEarly`] if the observer ended the run before there was a layout without folds.
    ///
    /// ```
    /// use authalic::{LayoutOptions, Silent, SphereMapOptions, Surface, sphere_map};
    /// use ndarray::array;
    ///
    /// let vertices = array![[3., 0., 0.], [0., 1., 0.], [0., 0., 1.], [-1., 0., 0.], [0., -1., 0.], [0., 0., -1.]];
    /// let faces = array![[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
    /// let surface = Surface::new(vertices, faces)?;
    /// let map = sphere_map(&surface, &SphereMapOptions::default(), &mut Silent)?;
    /// let layout = map.layout(&surface, &LayoutOptions::default(), &mut Silent)?;
    /// assert_eq!(layout.faces.dim(), (8, 3));
    /// assert!(layout.points.nrows() > 6, "vertices on the seam are points on either side of it");
    /// # Ok::<(), authalic::Error>(())
    /// ```
    pub fn layout(
        &self,
        surface: &Surface,
        options: &LayoutOptions<'_>,
        observer: &mut dyn Observer,
    ) -> Result<Layout, Error> {
        layout(&self.faces_on_sphere(surface.oriented_faces()?.view())?, options, observer)
    }

    /// The map as it is laid out, checked once for any number of layouts. `faces` (m, 3) are those of the surface, as
    /// oriented.
    ///
    /// # Errors
    /// Faces that do not fit the map.
    pub fn faces_on_sphere(&self, faces: ArrayView2<'_, u32>) -> Result<SphereFaces, Error> {
        let n_vertices = self.positions.nrows();
        if let Some(refinement) = &self.refinement {
            let positions = concatenate![Axis(0), self.positions, refinement.positions];
            return Ok(SphereFaces {
                image: Surface::new(positions, &refinement.faces)?,
                targets: refinement.targets.clone(),
                face_of: Some(refinement.face_of.clone()),
                n_vertices,
                n_filling: 0,
            });
        }
        let whole = SphereFaces {
            image: Surface::new(&self.positions, faces)?,
            targets: self.targets.clone(),
            face_of: None,
            n_vertices,
            n_filling: 0,
        };
        self.filling.as_ref().map_or(Ok(whole.clone()), |filling| whole.filled(filling))
    }
}

/// Lays any map onto the sphere out in the plane, as [`SphereMap::layout`] does.
///
/// # Errors
/// As [`SphereMap::layout`].
pub fn layout(
    sphere: &SphereFaces,
    options: &LayoutOptions<'_>,
    observer: &mut dyn Observer,
) -> Result<Layout, Error> {
    parallel::install(|| match options.kind {
        LayoutKind::Lambert => Run::<Lambert>::new(sphere, options)?.laid_out(observer),
        LayoutKind::Octahedral => Run::<Octahedral>::new(sphere, options)?.laid_out(observer),
    })
}
