// SPDX-License-Identifier: MIT OR Apache-2.0
//! Area-preserving maps of disks to the unit disk.
//!
//! [`disk_map`] is the entry. The default is guarded Gauss–Newton, our own. The papers' methods (Liu & Yueh
//! 2023) start from a harmonic map with an arc-length boundary, take fixed-point steps and conjugate
//! gradients. They cannot promise an unfolded map, so folds are unfolded, and where that fails the run is
//! repeated from Tutte's embedding without ever leaving it. Every result is checked by exact predicates.
//!
//! Input: a [`TriangleMesh`] that is a disk, or one with holes and [`DiskMapOptions::fill_holes`]. Cost:
//! about 5 sparse Cholesky factorisations of the interior vertices, then about 12 with two unknowns per
//! vertex (Gauss–Newton) or one solve per iteration (conjugate gradients).

mod boundary;
mod certificate;
mod free;
mod gauss_newton;
mod holes;
mod published;
mod rectangle;
mod start;
pub(crate) mod unfold;

use std::borrow::Cow;

use crate::control::{History, Observer, Status};
use crate::distortion::{Distortion, Image, distortion, normalized_density};
use crate::error::{Elements, Error, MapError, MeshError};
use crate::mesh::TriangleMesh;
use crate::options::{check_angle_weight, check_area_tolerance};
use crate::parallel;

pub(crate) use holes::closed;
use published::run::Run;

/// A map of the vertices into the plane.
type Map = Vec<[f64; 2]>;

/// How a disk map is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Method {
    /// Fixed-point iteration of the stretch energy (Liu & Yueh 2023, equation (2.5)).
    FixedPoint,
    /// Preconditioned nonlinear conjugate gradients (Liu & Yueh 2023, Algorithm 3.1).
    ConjugateGradient,
    /// Guarded Gauss–Newton, our own: more exact by orders of magnitude, and never a folded face on the way.
    #[default]
    GaussNewton,
}

/// What the boundary vertices may do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Boundary {
    /// Held on the circle at arcs proportional to the edge lengths, as in the papers.
    ArcLength,
    /// Free to slide along the circle in their order, which lets the faces at the boundary keep their areas
    /// too.
    #[default]
    Sliding,
    /// Free to take any shape that does not cross itself, for Gauss–Newton only: with a weight of angles it
    /// takes the shape that suits these. The map lies inside the unit circle.
    Free,
    /// On the sides of a rectangle, for Gauss–Newton only: four vertices at its corners, the others sliding along its sides.
    /// The map lies in `[0, w] × [0, h]` with a longer side of 1.
    Rectangle,
}

/// Options of [`disk_map`].
#[derive(Debug, Clone, Default)]
pub struct DiskMapOptions<'a> {
    /// The method; guarded Gauss–Newton.
    pub method: Method,
    /// The boundary; sliding.
    pub boundary: Boundary,
    /// Target measure of each face, (m,), positive, on any scale; the face areas where `None`.
    pub density: Option<&'a [f64]>,
    /// λ ≥ 0, the weight of the angle distortion against that of areas, for Gauss–Newton only; 0 keeps areas
    /// alone.
    pub angle_weight: f64,
    /// Instead of a weight: the least shear whose area deviation √(E_A/A) is within this tolerance, for Gauss–Newton only;
    /// where `None`, `angle_weight` decides.
    pub area_tolerance: Option<f64>,
    /// A start map, (n, 2): its boundary once around the unit circle, along the sides of an upright rectangle, or with
    /// a free boundary any outline that does not cross itself; the fixed-point steps from the harmonic map where
    /// `None`.
    pub initial: Option<&'a [[f64; 2]]>,
    /// Iterations at the most. Gauss–Newton where neither these nor a tolerance are given: as many as it
    /// takes, with a weight of 0 11 (33 below 10,000 vertices) where those leave the area ratio a deviation of
    /// .5 % (.2 % below 10,000 vertices); the papers' methods: 50, as in the paper's tables. The five fixed-point
    /// steps that come first, the unguarded steps that unfold (12 at the most) and a descent that follows where folds were mended
    /// come on top, and where some targets are below 1 % of the mean up to eight for each of the floors that
    /// are lowered step by step.
    pub max_iterations: Option<usize>,
    /// Gauss–Newton has converged when the deviation of the area ratio, √(E_A/A), falls below this; 2·10⁻⁴
    /// where `None`. For the papers' methods √(gᵀM⁻¹g); 10⁻⁸ where `None`.
    pub tolerance: Option<f64>,
    /// Fill all boundary loops but the longest virtually instead of refusing them; off. With a free boundary they stay
    /// open and are as free as the longest one.
    pub fill_holes: bool,
    /// Let a free boundary cross itself; off.
    pub overlap: bool,
    /// The vertices at the corners of a rectangle, counter-clockwise from the lower left one; sought where `None`.
    pub corners: Option<[usize; 4]>,
    /// Width over height of a rectangle; whatever suits angles best where `None`.
    pub aspect: Option<f64>,
}

/// A map of a disk to the unit disk or onto a rectangle, one-to-one but for `overlap`.
#[derive(Debug, Clone)]
pub struct DiskMap {
    /// (n, 2): the image of each vertex in the unit disk, or on the rectangle asked for; positive faces run
    /// counter-clockwise. Without a start map the lowest boundary vertex lies at (1, 0) of the disk, and with a free
    /// boundary to the right of the mean of all vertices.
    pub uv: Vec<[f64; 2]>,
    /// Why the run ended.
    pub status: Status,
    /// The energy after every iteration, that of the virtually filled surface where holes were filled.
    pub history: History,
    /// The figures of the map on the faces given.
    pub distortion: Distortion,
    /// Wall time of the whole call.
    pub seconds: f64,
}

/// Maps a disk to the unit disk so that areas are kept.
///
/// # Errors
/// Input that is no disk, and options out of range, are refused before any work. [`NumericsError::NoEmbedding`](crate::NumericsError::NoEmbedding) where
/// every start folds in double precision.
///
/// ```
/// use authalic::{DiskMapOptions, Silent, disk_map, mesh::TriangleMesh};
/// let vertices = [[0., 0., 1.], [1., 0., 0.], [0., 1., 0.], [-1., 0., 0.], [0., -1., 0.]];
/// let faces = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]];
/// let mesh = TriangleMesh::new(&vertices, &faces)?;
/// let map = disk_map(&mesh, &DiskMapOptions::default(), &mut Silent)?;
/// assert!(map.distortion.folded.is_empty());
/// assert!(map.distortion.area_ratio_std < 1e-6);
/// # Ok::<(), authalic::Error>(())
/// ```
pub fn disk_map(
    mesh: &TriangleMesh,
    options: &DiskMapOptions<'_>,
    observer: &mut dyn Observer,
) -> Result<DiskMap, Error> {
    let mut history = History::start();
    // 1. Refuse what is no disk before any work
    options.check(mesh)?;
    // 2. Targets; holes filled virtually
    let given: Cow<'_, [f64]> = match options.density {
        Some(density) => normalized_density(density, mesh.n_faces())?.into(),
        None => mesh.face_areas().into(),
    };
    let filled = match mesh.boundary_loops().len() {
        1 => None,
        _ if options.boundary == Boundary::Free => None,
        _ => Some(holes::fill_holes(mesh, &given)?),
    };
    let (surface, targets) = filled.as_ref().map_or((mesh, &*given), |fill| (&fill.mesh, &fill.targets));
    // 3. Minimise the energy, unfold what folded
    let run = Run { mesh: surface, targets, options, n_given_faces: mesh.n_faces() };
    let (mut uv, status) = match options.method {
        Method::GaussNewton if options.boundary == Boundary::Rectangle => {
            rectangle::solve(&run, &mut history, observer)?
        }
        Method::GaussNewton if options.boundary == Boundary::Free => {
            let free = free::Free { mesh, targets: &given, options };
            free.map(&mut history, observer)?
        }
        Method::GaussNewton => run.renumbered(&mut history, observer)?,
        Method::FixedPoint | Method::ConjugateGradient => run.solve(&mut history, observer)?,
    };
    let status = match status != Status::Cancelled && !observer.progress(1.0, "Done") {
        true => Status::Cancelled,
        false => status,
    };
    // 4. Of all rotated copies the one that does not depend on the way there
    if options.boundary == Boundary::Sliding && options.initial.is_none() {
        uv = turned(surface, uv);
    }
    // 5. Figures of the faces given
    uv.truncate(mesh.n_vertices());
    let distortion = distortion(mesh.points(), mesh.faces(), Image::Plane(&uv), &given)?;
    Ok(DiskMap { uv, status, seconds: history.seconds(), history, distortion })
}

/// The map turned so that the first vertex of the boundary loop lies at (1, 0); as it was where the rounding of the
/// rotation folds a sliver.
fn turned(mesh: &TriangleMesh, map: Map) -> Map {
    let boundary = &mesh.boundary_loops()[0];
    let [x, y] = map[boundary[0] as usize];
    let mut turned = parallel::map(map.len(), |v| {
        let [u, w] = map[v];
        [x * u + y * w, x * w - y * u]
    });
    for &v in boundary {
        let [u, w] = turned[v as usize];
        // no coordinate beyond the circle by rounding
        turned[v as usize] = [u, w].map(|c| c / u.hypot(w));
    }
    turned[boundary[0] as usize] = [1.0, 0.0];
    let was_sound = certificate::is_bijective(mesh, &map);
    if was_sound && !certificate::is_bijective(mesh, &turned) { map } else { turned }
}

impl DiskMapOptions<'_> {
    fn check(&self, mesh: &TriangleMesh) -> Result<(), Error> {
        match mesh.require_disk() {
            Err(Error::Mesh(MeshError::SeveralBoundaries { .. })) if self.fill_holes => {}
            verdict => verdict?,
        }
        if let Some(initial) = self.initial {
            check_initial(mesh, self, initial)?;
        }
        if self.boundary == Boundary::Rectangle && self.method != Method::GaussNewton {
            let expected =
                "arc_length or sliding for the papers' methods; only gauss_newton has rectangles".into();
            return Err(Error::InvalidOption { name: "boundary", found: "rectangle".into(), expected });
        }
        if self.overlap && self.boundary != Boundary::Free {
            let (found, expected) = ("true".into(), "false unless the boundary is free".into());
            return Err(Error::InvalidOption { name: "overlap", found, expected });
        }
        if self.boundary == Boundary::Free && self.method != Method::GaussNewton {
            let expected = "arc_length or sliding for the papers' methods; only gauss_newton frees it".into();
            return Err(Error::InvalidOption { name: "boundary", found: "free".into(), expected });
        }
        rectangle::check(mesh, self)?;
        check_angle_weight(self.angle_weight, self.method == Method::GaussNewton)?;
        check_area_tolerance(self.area_tolerance, self.angle_weight, self.method == Method::GaussNewton)?;
        match self.tolerance {
            Some(tolerance) if !(tolerance >= 0.0 && tolerance.is_finite()) => Err(Error::InvalidOption {
                name: "tolerance",
                found: tolerance.to_string(),
                expected: "a finite number ≥ 0".into(),
            }),
            _ => Ok(()),
        }
    }
}

/// A start map must be finite and run once around the unit circle; its folds are mended like any others. With a free
/// boundary it may have any outline.
fn check_initial(
    mesh: &TriangleMesh,
    options: &DiskMapOptions<'_>,
    initial: &[[f64; 2]],
) -> Result<(), Error> {
    let is_free = options.boundary == Boundary::Free;
    if initial.len() != mesh.n_vertices() || (mesh.boundary_loops().len() != 1 && !is_free) {
        let where_from = if is_free { "" } else { " on a surface with one boundary loop" };
        let expected = format!("of shape ({}, 2){where_from}", mesh.n_vertices());
        let found = format!("of shape ({}, 2) with {} loops", initial.len(), mesh.boundary_loops().len());
        return Err(Error::InvalidArray { name: "initial", found, expected });
    }
    let not_finite = |v: &usize| !initial[*v].iter().all(|x| x.is_finite());
    if let Some(vertices) = Elements::collect((0..initial.len()).filter(not_finite)) {
        return Err(MapError::NonFinite { name: "initial", vertices }.into());
    }
    if options.boundary == Boundary::Rectangle {
        return rectangle::check_initial(mesh, options, initial);
    }
    if is_free {
        return Ok(());
    }
    let boundary = &mesh.boundary_loops()[0];
    let off_circle = |&v: &usize| (initial[v][0].hypot(initial[v][1]) - 1.0).abs() > 1e-6;
    if let Some(vertices) = Elements::collect(boundary.iter().map(|&v| v as usize).filter(off_circle)) {
        return Err(
            MapError::InitialBoundary { vertices, reason: "it must lie on the unit circle".into() }.into()
        );
    }
    if !boundary::runs_once_around(boundary, initial) {
        let vertices = Elements::collect(boundary.iter().map(|&v| v as usize)).expect("a loop has vertices");
        return Err(MapError::InitialBoundary {
            vertices,
            reason: "it must run once around the unit circle, counter-clockwise (mirror the map if it runs clockwise)".into(),
        }.into());
    }
    Ok(())
}
