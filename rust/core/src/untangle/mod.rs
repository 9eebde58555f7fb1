// SPDX-License-Identifier: MIT OR Apache-2.0
//! Removes the folds of a given map: [`untangle`].
//!
//! The outline, the pins and all vertices away from folds stay, bit for bit:
//!
//! 1. The vertices that move form patches around the folded faces ([`patches`]), as small as possible at first; only
//!    patches that stay folded grow.
//! 2. Within a patch a map without folds is found by the regularized foldover-free energy of Garanzha et al. (2021)
//!    ([`foldover`]).
//! 3. From there the vertices return to their old places as far as no face folds ([`closest`]).
//!
//! Exact predicates decide what is folded. The result is a map without folds or an error, never a map with folds.
//!
//! Input: a [`TriangleMesh`] with any number of components and boundary loops, and a map of it into the plane, or onto
//! the sphere if each tangle lies within a hemisphere. Cost: some 30 sparse factorizations of each patch.

mod checks;
mod closest;
mod foldover;
mod newton;
pub(super) mod options;
mod patch;
mod patches;
pub(super) mod positions;
mod solve;
mod triangle;

use std::collections::BTreeSet;

use ndarray::{Array2, ArrayView2};

use crate::control::{Observer, Status, Watch};
use crate::distortion::{Distortion, Image, OwnedImage, measure};
use crate::error::{Elements, Error, NumericsError};
use crate::mesh::{Surface, TriangleMesh, Vertex};
pub use options::UntangleOptions;
use patch::Patch;
use positions::Positions;
use solve::{Effort, Outcome};

const MESSAGE: &str = "Untangling";

/// A map without folds.
#[derive(Debug, Clone)]
pub struct Untangled {
    /// The map: (n, 2) or (n, 3), as given.
    pub image: Array2<f64>,
    /// The vertices that moved, ascending.
    pub moved: Vec<usize>,
    /// The faces that were folded, ascending.
    pub folded_before: Vec<usize>,
    /// [`Status::Converged`]; [`Status::Stalled`] if a face stays below the tolerance, though not folded;
    /// [`Status::Cancelled`] if vertices did not return as far as they could.
    pub status: Status,
    /// The figures of the map, mirrored components turned back.
    pub distortion: Distortion,
}

/// Removes the folds of `image`, a map of `surface` into the plane (n, 2) or onto a sphere around the origin (n, 3),
/// and changes as little as possible.
///
/// Each component keeps the orientation of most of its area. A map without folds comes back as it is.
///
/// # Errors
/// Arrays that do not fit; [`MapError::HeldFolded`](crate::MapError::HeldFolded) if the outline or the fixed vertices
/// make folds inevitable; [`NumericsError::StillFolded`] if no map without folds was found; [`Error::CancelledEarly`]
/// if the observer cancelled before there was one.
///
/// ```
/// use authalic::{Silent, Surface, UntangleOptions, untangle};
/// use ndarray::array;
///
/// let vertices = array![[0., 0., 1.], [1., 0., 0.], [0., 1., 0.], [-1., 0., 0.], [0., -1., 0.]];
/// let surface = Surface::new(vertices, array![[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]])?;
/// // the apex has left the square
/// let image = array![[2., 0.], [1., 0.], [0., 1.], [-1., 0.], [0., -1.]];
/// let map = untangle(&surface, image.view(), &UntangleOptions::default(), &mut Silent)?;
/// assert_eq!((map.folded_before, map.moved), (vec![0, 3], vec![0]));
/// assert!(map.distortion.folded.is_empty());
/// # Ok::<(), authalic::Error>(())
/// ```
pub fn untangle(
    surface: &Surface,
    image: ArrayView2<'_, f64>,
    options: &UntangleOptions<'_>,
    observer: &mut dyn Observer,
) -> Result<Untangled, Error> {
    let image = OwnedImage::new(image, surface.n_vertices())?;
    untangled(surface.mesh()?, image.view(), options, observer)
}

/// [`untangle`] of a mesh.
fn untangled(
    mesh: &TriangleMesh,
    image: Image<'_>,
    options: &UntangleOptions<'_>,
    observer: &mut dyn Observer,
) -> Result<Untangled, Error> {
    // 1. Refuse what does not fit
    checks::arguments(mesh, image, options)?;
    // 2. Components that are mirrored as a whole, turned over for the time being
    let given = Positions::new(image);
    let components = checks::components(mesh);
    let mirrored = given.mirrored(mesh, &components);
    let given = given.turned_over(&mirrored);
    let folded_before = given.folded(mesh.faces());
    // 3. Patch by patch
    let held = checks::held(mesh, options.fixed);
    checks::feasible(mesh, &given, &components, &held, &folded_before)?;
    let mut run =
        Run { mesh, given: &given, now: given.clone(), held: &held, options, status: Status::Converged };
    run.unfold(&folded_before, observer)?;
    // 4. The result, and its figures
    let Run { now, status, .. } = run;
    let moved: Vec<usize> = (0..mesh.n_vertices()).filter(|&v| now.differs(&given, v)).collect();
    let upright = now.clone().into_image();
    let distortion = measure(mesh.points(), mesh.faces(), upright.view(), mesh.face_areas())?;
    let image = now.turned_over(&mirrored).written_over(image, &moved).into_array();
    Ok(Untangled { image, moved, folded_before, status, distortion })
}

/// The state of a call.
struct Run<'a> {
    mesh: &'a TriangleMesh,
    /// The map given.
    given: &'a Positions,
    /// The map with the patches done so far.
    now: Positions,
    held: &'a [bool],
    options: &'a UntangleOptions<'a>,
    status: Status,
}

impl Run<'_> {
    /// Unfolds all faces: first to the tolerance, then those left to any positive area, at last whole components.
    fn unfold(&mut self, folded_before: &[usize], observer: &mut dyn Observer) -> Result<(), Error> {
        let mut folded = folded_before.to_vec();
        for (is_thin_enough, first_round, tries_hard) in
            [(false, 0, true), (true, 0, false), (true, patches::EVERYTHING, true)]
        {
            let effort = Effort { is_thin_enough, is_last: tries_hard };
            folded = self.rounds(folded, folded_before.len(), first_round, effort, observer)?;
        }
        match Elements::collect(folded.iter().copied()) {
            None => Ok(()),
            Some(faces) => {
                let pins = checks::pins_near(self.mesh, self.options.fixed, &folded);
                Err(NumericsError::StillFolded { folded: faces, fixed: pins }.into())
            }
        }
    }

    /// Unfolds patches that grow from round to round, with a last effort only on whole components; returns the faces
    /// that stay folded.
    fn rounds(
        &mut self,
        mut folded: Vec<usize>,
        n_before: usize,
        first_round: u32,
        effort: Effort,
        observer: &mut dyn Observer,
    ) -> Result<Vec<usize>, Error> {
        let mut failed = BTreeSet::new();
        for round in first_round.. {
            if folded.is_empty() {
                break;
            }
            // 1. The vertices that may move, in patches that do not touch
            let around = patches::around(self.mesh, &self.now, self.held, &folded, round);
            let separate = patches::separate(self.mesh, &around.free);
            let effort = Effort { is_last: effort.is_last && around.is_all, ..effort };
            let done = 1.0 - folded.len() as f64 / n_before.max(1) as f64;
            for (k, free) in separate.iter().enumerate() {
                let here = k as f64 / separate.len() as f64;
                let fraction = done.max(0.0) + (1.0 - done.max(0.0)) * 0.9 * here;
                if failed.contains(free) && !effort.is_last {
                    continue;
                }
                if !observer.progress(fraction, MESSAGE) {
                    return Err(Error::CancelledEarly);
                }
                let watch = Watch::new(observer, fraction, MESSAGE);
                if !self.unfold_patch(free, effort, &watch)? {
                    failed.insert(free.clone());
                }
            }
            // 2. The faces still folded
            folded = self.now.folded(self.mesh.faces());
            if around.is_all {
                break;
            }
        }
        Ok(folded)
    }

    /// Unfolds the patch of these free vertices; returns whether it succeeded.
    fn unfold_patch(&mut self, free: &[Vertex], effort: Effort, watch: &Watch<'_>) -> Result<bool, Error> {
        let tolerance = self.options.tolerance;
        let Some(patch) = Patch::new(self.mesh, self.given, &self.now, free, tolerance) else {
            return Ok(false);
        };
        let Outcome::Open(places, status) = patch.solved(effort, watch)? else {
            return Ok(false);
        };
        let before = self.now.at(free);
        patch.write(self.given, &places, &mut self.now);
        if !self.now.folded(&patch.faces_of(self.mesh)).is_empty() {
            self.now.put(free, &before);
            return Ok(false);
        }
        if status != Status::Converged && self.status != Status::Cancelled {
            self.status = status;
        }
        Ok(true)
    }
}

#[cfg(test)]
mod tests;
