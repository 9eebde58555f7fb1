// SPDX-License-Identifier: MIT OR Apache-2.0
//! Area-preserving maps of closed surfaces of genus 0 onto the unit sphere.
//!
//! [`sphere_map`] is the entry. The default is guarded Gauss–Newton, our own. The papers' methods (Sutti &
//! Yueh 2024): a spherical conformal start, the fixed-point iteration of the stretch energy (Algorithm 2),
//! Riemannian gradient descent (Algorithm 1), and the bijectivity correction by mean-value weights. They
//! cannot promise an unfolded map, so where the correction does not suffice the run is repeated from a map
//! without folds and never leaves it. Every result is checked by exact predicates.
//!
//! Input: a [`TriangleMesh`] that is closed, connected and without handles. Cost: one sparse Cholesky
//! factorization of all vertices, about ten of six tenths of them, and one gradient per iteration.

mod alignment;
mod gauss_newton;
mod holes;
mod options;
mod published;
mod refinement;
mod run;
mod start;
mod stereographic;
pub(crate) mod unfold;

use ndarray::{Array2, Axis, Slice, aview2};

use crate::arrays::{from_vectors, rows_of, vectors};
use crate::control::{History, Observer, Phase, Rising, Status};
use crate::distortion::{Distortion, Image, measure, targets};
use crate::error::Error;
use crate::mesh::{Surface, TriangleMesh, Vertex, index_array};

use crate::codomain::SpatialMap;
use crate::vector::Vector3;
pub use options::{SphereMapOptions, SphereMethod};
pub use refinement::Refinement;
use refinement::refine;
use run::Run;
pub(crate) use start::rough_conformal;

/// The part of the progress that belongs to the map before faces are split.
const UNREFINED: f64 = 0.4;

/// A one-to-one map of a closed surface to the unit sphere.
#[derive(Debug, Clone)]
pub struct SphereMap {
    /// (n, 3): the image of each vertex, unit rows; positive faces are seen counter-clockwise from outside.
    /// Without a start map, the map is rotated to align with the surface.
    pub positions: Array2<f64>,
    /// Why the run ended.
    pub status: Status,
    /// The energy after every iteration, by unsigned areas as in the paper, with a record of step 0 where a mended map
    /// replaced a folded one. With [`SphereMapOptions::refine`], the records of all descents, even discarded ones.
    pub history: History,
    /// The distortion of the map, by signed areas. The image of a split face consists of those of its parts.
    pub distortion: Distortion,
    /// (m,): the target measure of each face, on some scale.
    pub targets: Vec<f64>,
    /// The split faces, with [`SphereMapOptions::refine`].
    pub refinement: Option<Box<Refinement>>,
    /// What fills the holes of an open surface on the sphere, with [`SphereMapOptions::fill_holes`].
    pub filling: Option<Box<SphereFilling>>,
    /// Wall time of the whole call.
    pub seconds: f64,
}

/// What fills the holes of a map on the sphere, so that it can be laid out; no part of the map.
#[derive(Debug, Clone, PartialEq)]
pub struct SphereFilling {
    /// (k, 3): the vertices inside holes, numbered on from those of the map; unit rows.
    pub positions: Array2<f64>,
    /// (j, 3): the faces, counter-clockwise seen from outside.
    pub faces: Array2<u32>,
    /// (j,): their measures, on the scale of the map's targets.
    pub targets: Vec<f64>,
}

impl SphereFilling {
    /// The part of a filled map after the vertices and faces of the given surface.
    pub(crate) fn after(
        [n_vertices, n_faces]: [usize; 2],
        positions: &Array2<f64>,
        faces: &[[Vertex; 3]],
        targets: &[f64],
    ) -> Option<Box<Self>> {
        (faces.len() > n_faces).then(|| {
            Box::new(Self {
                positions: positions.slice_axis(Axis(0), Slice::from(n_vertices..)).to_owned(),
                faces: index_array(&faces[n_faces..]),
                targets: targets[n_faces..].to_vec(),
            })
        })
    }
}

impl SphereMap {
    /// A map at hand, with its figures.
    ///
    /// # Errors
    /// Faces without area.
    pub(crate) fn of_positions(
        mesh: &TriangleMesh,
        positions: Vec<Vector3>,
        status: Status,
    ) -> Result<Self, Error> {
        let history = History::start();
        let targets = mesh.face_areas().to_vec();
        let distortion = measure(mesh.points(), mesh.faces(), Image::Sphere(&positions), &targets)?;
        Ok(Self {
            positions: from_vectors(positions),
            status,
            seconds: history.seconds(),
            history,
            distortion,
            targets,
            refinement: None,
            filling: None,
        })
    }

    /// The map with figures for a surface that differs from the one that was mapped; its areas are the targets.
    ///
    /// # Errors
    /// Faces without area.
    pub(crate) fn measured_on(self, mesh: &TriangleMesh) -> Result<Self, Error> {
        let targets = mesh.face_areas().to_vec();
        let image = Image::Sphere(&vectors(self.positions.view()));
        let distortion = measure(mesh.points(), mesh.faces(), image, &targets)?;
        Ok(Self { distortion, targets, ..self })
    }
}

/// Maps a closed surface of genus 0 onto the unit sphere so that areas are preserved.
///
/// # Errors
/// Input that is no sphere, and options out of range, are refused before any work.
/// [`NumericsError::NoEmbedding`](crate::NumericsError::NoEmbedding) where every start folds in double precision; never
/// with [`SphereMapOptions::unfold`] off.
///
/// ```
/// use authalic::{Silent, SphereMapOptions, Surface, sphere_map};
/// use ndarray::array;
///
/// let vertices = array![[3., 0., 0.], [0., 1., 0.], [0., 0., 1.], [-1., 0., 0.], [0., -1., 0.], [0., 0., -1.]];
/// let faces = array![[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
/// let surface = Surface::new(vertices, faces)?;
/// let map = sphere_map(&surface, &SphereMapOptions::default(), &mut Silent)?;
/// assert!(map.distortion.folded.is_empty());
/// assert!(map.positions.rows().into_iter().all(|row| (row.dot(&row) - 1.0).abs() < 1e-12));
/// # Ok::<(), authalic::Error>(())
/// ```
pub fn sphere_map(
    surface: &Surface,
    options: &SphereMapOptions<'_>,
    observer: &mut dyn Observer,
) -> Result<SphereMap, Error> {
    let initial = options.initial.map(|initial| rows_of::<3, _>("initial", initial)).transpose()?;
    let options = SphereMapOptions { initial: initial.as_deref().map(aview2), ..*options };
    map_sphere(surface.mesh()?, &options, observer)
}

/// [`sphere_map`] of a mesh, with a start map in row-major order.
pub(crate) fn map_sphere(
    mesh: &TriangleMesh,
    options: &SphereMapOptions<'_>,
    observer: &mut dyn Observer,
) -> Result<SphereMap, Error> {
    // an observer that has cancelled the run is not asked again
    let observer: &mut dyn Observer = &mut Rising::new(observer);
    let mut history = History::start();
    let options = &options.by_ref();
    if options.fill_holes && !mesh.topology().is_closed() {
        return map_filled(mesh, options, observer);
    }
    // 1. Check the surface and the options
    options.check(mesh)?;
    // 2. Targets, and each vertex's share of them
    let targets = targets(options.density, mesh.face_areas())?;
    let weights = mesh.vertex_shares(&targets);
    // 3. Minimize the energy without folds
    let run = Run { mesh, targets: &targets, weights: &weights, options };
    let to = if options.refine { UNREFINED } else { 1.0 };
    let mut phase = Phase { whole: observer, from: 0.0, to };
    let (map, status) = match options.method {
        SphereMethod::GaussNewton => run.renumbered(&mut history, &mut phase)?,
        SphereMethod::FixedPoint | SphereMethod::GradientDescent => run.solve(&mut history, &mut phase)?,
    };
    // 4. Split the faces that keep areas uneven
    let (refined, map, status) = if options.refine {
        let mut phase = Phase { whole: observer, from: UNREFINED, to: 1.0 };
        let (refined, map, status) = refine(mesh, &targets, (map, status), options, &mut history, &mut phase);
        (Some(refined), map, status)
    } else {
        (None, map, status)
    };
    let status = if status != Status::Cancelled && !observer.progress(1.0, "Done") {
        Status::Cancelled
    } else {
        status
    };
    // 5. Align the map with the surface; figures
    let (positions, distortion, refinement) = match refined {
        None => {
            let positions = over_the_surface(mesh, map, &weights, options);
            let figures = measure(mesh.points(), mesh.faces(), Image::Sphere(&positions), &targets)?;
            (positions, figures, None)
        }
        Some(refined) => {
            let weights = refined.mesh.vertex_shares(&refined.targets);
            let mut positions = over_the_surface(&refined.mesh, map, &weights, options);
            let (of_parts, of_faces) = refined.figures(&positions)?;
            let of_split_points = positions.split_off(mesh.n_vertices());
            (positions, of_faces, Some(Box::new(refined.into_refinement(of_split_points, of_parts))))
        }
    };
    Ok(SphereMap {
        positions: from_vectors(positions),
        status,
        seconds: history.seconds(),
        history,
        distortion,
        targets: targets.into_owned(),
        refinement,
        filling: None,
    })
}

/// The map of a surface with holes, which are filled for the time of the map.
fn map_filled(
    mesh: &TriangleMesh,
    options: &SphereMapOptions<'_>,
    observer: &mut dyn Observer,
) -> Result<SphereMap, Error> {
    // 1. The filled surface
    holes::check(options)?;
    let given = targets(options.density, mesh.face_areas())?.into_owned();
    let filled = holes::fill_holes(mesh, &given)?;
    // 2. Its map
    let density = Some(filled.targets.view());
    let options = SphereMapOptions { density, fill_holes: false, ..options.by_ref() };
    let map = map_sphere(&filled.mesh, &options, observer)?;
    // 3. The part of the given surface
    let positions = map.positions.slice_axis(Axis(0), Slice::from(..mesh.n_vertices())).to_owned();
    let image = vectors(positions.view());
    let distortion = measure(mesh.points(), mesh.faces(), Image::Sphere(&image), &given)?;
    let sizes = [mesh.n_vertices(), given.len()];
    let targets = filled.targets.to_vec();
    let filling = SphereFilling::after(sizes, &map.positions, filled.mesh.faces(), &targets);
    Ok(SphereMap { positions, distortion, targets: given, filling, ..map })
}

/// The map aligned with its surface, or unchanged where a start was given.
fn over_the_surface(
    mesh: &TriangleMesh,
    map: SpatialMap,
    weights: &[f64],
    options: &SphereMapOptions<'_>,
) -> SpatialMap {
    match options.initial {
        None => alignment::aligned(mesh, map, weights),
        Some(_) => map,
    }
}
