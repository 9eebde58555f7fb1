// SPDX-License-Identifier: MIT OR Apache-2.0
//! Area-preserving maps of disks to the unit disk.
//!
//! [`disk_map`] is the entry. The default is guarded Gauss–Newton, our own. The papers' methods (Liu & Yueh
//! 2023) start from a harmonic map with an arc-length boundary, take fixed-point steps and conjugate
//! gradients. They cannot promise an unfolded map, so folds are unfolded, and where that fails the run is
//! repeated from Tutte's embedding without ever leaving it. Every result is checked by exact predicates.
//!
//! Input: a [`TriangleMesh`] that is a disk, or one with holes and [`DiskMapOptions::fill_holes`]. Cost:
//! about 5 sparse Cholesky factorizations of the interior vertices, then about 12 with two unknowns per
//! vertex (Gauss–Newton) or one solve per iteration (conjugate gradients).

mod boundary;
mod certificate;
mod checks;
mod free;
mod gauss_newton;
mod holes;
mod many;
mod options;
mod published;
mod rectangle;
mod run;
mod start;
pub(crate) mod unfold;

use ndarray::{Array2, aview2};

use crate::arrays::{from_rows, rows, rows_of};
use crate::control::{History, Observer, Rising, Status};
use crate::distortion::{Distortion, Image, measure, targets};
use crate::error::Error;
use crate::mesh::{Surface, TriangleMesh};
use crate::parallel;

use crate::codomain::planar::PlanarMap;
use free::QuickStart;
pub(crate) use holes::closed;
pub use many::disk_maps;
pub use options::{Boundary, DiskMapOptions, DiskMethod};
use run::Run;

/// A map of a disk to the unit disk or onto a rectangle, one-to-one but for `overlap`.
#[derive(Debug, Clone)]
pub struct DiskMap {
    /// (n, 2): the image of each vertex in the unit disk, or on the rectangle asked for; positive faces run
    /// counter-clockwise. Without a start map the lowest boundary vertex lies at (1, 0) of the disk, and with a free
    /// boundary to the right of the mean of all vertices.
    pub uv: Array2<f64>,
    /// Why the run ended.
    pub status: Status,
    /// The energy after every iteration; where holes were filled, that of the filled surface.
    pub history: History,
    /// The distortion of the map on the given faces.
    pub distortion: Distortion,
    /// Wall time of the whole call.
    pub seconds: f64,
}

impl DiskMap {
    /// The map with figures for a surface that differs from the one that was mapped; its areas are the targets.
    ///
    /// # Errors
    /// Faces without area.
    pub(crate) fn measured_on(self, mesh: &TriangleMesh) -> Result<Self, Error> {
        let image = Image::Plane(rows(self.uv.view()));
        let distortion = measure(mesh.points(), mesh.faces(), image, mesh.face_areas())?;
        Ok(Self { distortion, ..self })
    }
}

/// Maps a disk to the unit disk so that areas are preserved.
///
/// # Errors
/// Input that is no disk, and options out of range, are refused before any work.
/// [`NumericsError::NoEmbedding`](crate::NumericsError::NoEmbedding) where every start folds in double precision.
///
/// ```
/// use authalic::{DiskMapOptions, Silent, Surface, disk_map};
/// use ndarray::array;
///
/// let vertices = array![[0., 0., 1.], [1., 0., 0.], [0., 1., 0.], [-1., 0., 0.], [0., -1., 0.]];
/// let surface = Surface::new(vertices, array![[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]])?;
/// let map = disk_map(&surface, &DiskMapOptions::default(), &mut Silent)?;
/// assert!(map.distortion.folded.is_empty());
/// assert!(map.distortion.area_ratio_std < 1e-6);
/// # Ok::<(), authalic::Error>(())
/// ```
pub fn disk_map(
    surface: &Surface,
    options: &DiskMapOptions<'_>,
    observer: &mut dyn Observer,
) -> Result<DiskMap, Error> {
    let initial = options.initial.map(|initial| rows_of::<2, _>("initial", initial)).transpose()?;
    let options = DiskMapOptions { initial: initial.as_deref().map(aview2), ..*options };
    map_disk(surface.mesh()?, &options, observer)
}

/// [`disk_map`] of a mesh, with a start map in row-major order.
pub(crate) fn map_disk(
    mesh: &TriangleMesh,
    options: &DiskMapOptions<'_>,
    observer: &mut dyn Observer,
) -> Result<DiskMap, Error> {
    // an observer that has cancelled the run is not asked again
    let observer: &mut dyn Observer = &mut Rising::new(observer);
    let mut history = History::start();
    let options = &options.by_ref();
    // 1. Check the surface and the options
    checks::check(mesh, options)?;
    // 2. Targets; holes filled virtually
    let given = targets(options.density, mesh.face_areas())?;
    let filled = match mesh.boundary_loops().len() {
        1 => None,
        _ if options.boundary == Boundary::Free => None,
        _ => Some(holes::fill_holes(mesh, &given)?),
    };
    let (surface, targets) = filled.as_ref().map_or((mesh, &*given), |fill| (&fill.mesh, &fill.targets));
    // 3. Minimize the energy without folds
    let run = Run { mesh: surface, targets, options, n_given_faces: mesh.n_faces() };
    let (mut uv, status) = match options.method {
        DiskMethod::GaussNewton if options.boundary == Boundary::Rectangle => {
            rectangle::solve(&run, &mut history, observer)?
        }
        DiskMethod::GaussNewton if options.boundary == Boundary::Free => {
            let free = free::Free { mesh, targets: &given, options, schedule: free::Schedule::Given };
            let (map, status, _) = free.map(&mut history, observer)?;
            (map, status)
        }
        DiskMethod::GaussNewton => run.renumbered(&mut history, observer)?,
        DiskMethod::FixedPoint | DiskMethod::ConjugateGradient => run.solve(&mut history, observer)?,
    };
    let status = if status != Status::Cancelled && !observer.progress(1.0, "Done") {
        Status::Cancelled
    } else {
        status
    };
    // 4. Choose the rotation that does not depend on the run
    if options.boundary == Boundary::Sliding && options.initial.is_none() {
        uv = turned(surface, uv);
    }
    // 5. Figures of the given faces
    uv.truncate(mesh.n_vertices());
    let distortion = measure(mesh.points(), mesh.faces(), Image::Plane(&uv), &given)?;
    Ok(DiskMap { uv: from_rows(uv), status, seconds: history.seconds(), history, distortion })
}

/// How an island is mapped.
#[derive(Debug, Clone, Copy)]
pub(crate) struct IslandGoal<'a> {
    /// The deviation √(E_A/A) of areas.
    pub tolerance: f64,
    /// Let the outline cross itself.
    pub overlap: bool,
    pub max_iterations: Option<usize>,
    pub start: Option<IslandStart<'a>>,
}

/// What an island is mapped from, at whatever scale.
#[derive(Debug, Clone, Copy)]
pub(crate) enum IslandStart<'a> {
    /// A map without folds that met the tolerance, with its weight of angles.
    Map(&'a [[f64; 2]], f64),
    /// The wanted image of each face, at whatever place.
    Shapes(&'a [[[f64; 2]; 3]]),
}

/// The map of an island.
pub(crate) struct MappedIsland {
    /// The image of each vertex, at whatever scale.
    pub uv: PlanarMap,
    /// [`Status::Converged`] where the tolerance is met; [`Status::Stalled`] with the given start where its outlines
    /// cross too far.
    pub status: Status,
    /// The weight of angles, λ.
    pub weight: f64,
}

/// A map of an island to the plane whose areas are even within a tolerance, with little shear. Some twenty
/// factorizations, a few from a given start; outlines of a map are pushed apart where they cross.
///
/// # Errors
/// As [`disk_map`].
pub(crate) fn map_island(
    mesh: &TriangleMesh,
    goal: &IslandGoal<'_>,
    observer: &mut dyn Observer,
) -> Result<MappedIsland, Error> {
    let IslandGoal { tolerance, overlap, max_iterations, start } = *goal;
    let boundary = Boundary::Free;
    let (initial, start) = match start {
        None => (None, None),
        Some(IslandStart::Map(map, weight)) => (Some(aview2(map)), Some(QuickStart::Initial { weight })),
        Some(IslandStart::Shapes(shapes)) => (None, Some(QuickStart::Shapes(shapes))),
    };
    let options = DiskMapOptions { boundary, overlap, max_iterations, initial, ..Default::default() };
    let schedule = free::Schedule::Quick { tolerance, start };
    let free = free::Free { mesh, targets: mesh.face_areas(), options: &options, schedule };
    let (uv, status, weight) = free.map(&mut History::start(), observer)?;
    Ok(MappedIsland { uv, status, weight })
}

/// The map turned so that the first vertex of the boundary loop lies at (1, 0); unchanged where the rounding of the
/// rotation folds a sliver.
fn turned(mesh: &TriangleMesh, map: PlanarMap) -> PlanarMap {
    let boundary = &mesh.boundary_loops()[0];
    let [x, y] = map[boundary[0]];
    let mut turned = parallel::map(map.len(), |v| {
        let [u, w] = map[v];
        [x * u + y * w, x * w - y * u]
    });
    for &v in boundary {
        let [u, w] = turned[v];
        // rounding may leave no coordinate beyond the circle
        turned[v] = [u, w].map(|c| c / u.hypot(w));
    }
    turned[boundary[0]] = [1.0, 0.0];
    let was_sound = certificate::is_bijective(mesh, &map);
    if was_sound && !certificate::is_bijective(mesh, &turned) { map } else { turned }
}
