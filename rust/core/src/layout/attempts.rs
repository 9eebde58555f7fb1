// SPDX-License-Identifier: MIT OR Apache-2.0
//! Computes a layout: tries choices of vertices for the singular points until one leaves no folds.

use std::marker::PhantomData;

use super::certificate::{Precision, nearly_folded};
use super::chart::{Chart, Point};
use super::development::{bring_back, develop};
use super::options::LayoutOptions;
use super::polygons::Polygons;
use super::projection::Projection;
use super::relaxation::{Goal, even_out, put_on_grid, relax};
use super::seam::{Layout, Split, split_along_seam};
use super::singular_points::{SphereMesh, place_singular_points};
use super::sphere_faces::SphereFaces;
use super::twist::Side;
use super::unfolding::unfold;
use crate::arrays::from_rows;
use crate::clock::Instant;
use crate::control::{Observer, Phase, Status, Watch};
use crate::distortion::folded_in_plane;
use crate::error::{Elements, Error, NumericsError};
use crate::mesh::corners::VertexCorners;
use crate::mesh::ties::nearest_multiple;
use crate::mesh::{Vertex, index_array};
use crate::parallel;
use crate::vector::Vector3;

/// Number of attempts, the first with the best vertices for the singular points, the second with the second best, and
/// so on; each is made by twists from either side.
const RANKS: usize = 4;

/// Number of further attempts on coarse meshes, each with the mesh turned about the pole.
const TURNS: usize = 15;

/// Angle by which each of [`TURNS`] turns the mesh further (radians).
const TURN: f64 = 2.4;

/// Largest number of vertices of a coarse mesh.
const COARSE: usize = 500;

/// Number of folded faces, beside [`FOLDED_SHARE`], above which other singular points do not help.
const FOLDED_FACES: usize = 100;

/// Fraction of all faces that is added to [`FOLDED_FACES`].
const FOLDED_SHARE: f64 = 1e-3;

/// Rounds of unfolding, each followed by a relaxation of the areas.
const UNFOLDINGS: usize = 4;

/// Tolerance of the areas relative to their targets for a map with exact areas.
const LEAST_TOLERANCE: f64 = 0.005;

/// Increase of the tolerance per unit of the map's area deviation √(E_A/A).
const OF_THE_MAP: f64 = 1.0;

/// Width of the cells of the grid of the targets, relative to the power of two below a target.
const TARGET_CELL: f64 = 1.0 / 65_536.0;

/// The input of a layout, prepared for a projection.
pub(super) struct Run<'a, P> {
    faces: &'a [[Vertex; 3]],
    face_of: Option<&'a [usize]>,
    /// The number of faces that are laid out; the others fill holes.
    n_laid_out: usize,
    /// (n, 3): points of the unit sphere in the coordinates of the projection.
    points: Vec<Vector3>,
    corners: VertexCorners,
    polygons: Polygons,
    /// (m,): target areas on the sphere, rounded; their sum is about 4π.
    targets: Vec<f64>,
    /// Tolerance of the areas relative to their targets.
    tolerance: f64,
    candidates: Option<Vec<bool>>,
    precision: Precision,
    began: Instant,
    projection: PhantomData<P>,
}

/// The outcome of one choice of vertices for the singular points.
enum Attempt {
    Done(Layout),
    Folded(Vec<usize>),
    NoRoom,
}

impl<'a, P: Projection> Run<'a, P> {
    /// Checks and prepares the input.
    ///
    /// # Errors
    /// Arrays of the wrong length, positions without a direction, options out of range.
    pub fn new(sphere: &'a SphereFaces, options: &LayoutOptions<'_>) -> Result<Self, Error> {
        let began = Instant::now();
        let [first, second, third] = options.frame()?;
        sphere.check()?;
        let (faces, positions) = (sphere.image.face_rows(), sphere.unit_positions()?);
        let turned = |point: Vector3| Vector3([first, second, third].map(|axis| axis.dot(point)));
        let labels = sphere.labels(options.polygons)?;
        let targets = sphere.areas(options.density)?;
        Ok(Self {
            faces,
            face_of: sphere.face_of.as_deref(),
            n_laid_out: sphere.n_laid_out(),
            points: parallel::map(positions.len(), |vertex| turned(positions[vertex])),
            corners: VertexCorners::new(positions.len(), faces),
            polygons: Polygons::new(faces, labels.as_deref()),
            tolerance: LEAST_TOLERANCE + OF_THE_MAP * sphere.deviation(&positions, &targets),
            targets: targets.into_iter().map(rounded_target).collect(),
            candidates: sphere.candidates(options.candidates, P::SINGULAR.len())?,
            precision: options.precision,
            began,
            projection: PhantomData,
        })
    }

    /// Tries the choices of vertices for the singular points in turn.
    ///
    /// # Errors
    /// [`NumericsError::LayoutFolds`] if every choice leaves folds, [`Error::CancelledEarly`] if the observer cancels
    /// before there is a layout without folds.
    pub fn laid_out(&self, observer: &mut dyn Observer) -> Result<Layout, Error> {
        let turns = if self.points.len() > COARSE { 0 } else { TURNS };
        let choices = (0..RANKS).map(|rank| (rank, 0.0)).chain((1..=turns).map(|k| (0, TURN * k as f64)));
        let attempts =
            choices.flat_map(|(rank, turn)| [Side::Left, Side::Right].map(|side| (rank, turn, side)));
        let mut fewest: Vec<usize> = (0..self.faces.len()).collect();
        for (rank, turn, side) in attempts {
            match self.attempt(rank, turn, side, observer)? {
                Attempt::Done(layout) => return Ok(layout),
                Attempt::NoRoom => {}
                Attempt::Folded(folded) => {
                    let is_hopeless = folded.len() > self.hopeless();
                    if folded.len() < fewest.len() {
                        fewest = folded;
                    }
                    if is_hopeless {
                        break;
                    }
                }
            }
        }
        let mut of_map = self.laid_out_beside(&fewest);
        if let Some(face_of) = self.face_of {
            of_map.iter_mut().for_each(|face| *face = face_of[*face]);
        }
        of_map.dedup();
        let faces = Elements::collect(of_map).expect("a layout without folds would have been returned");
        Err(NumericsError::LayoutFolds { faces, precision: self.precision.as_str() }.into())
    }

    /// The faces of a list that are laid out; where all of them fill holes, the faces around the holes.
    fn laid_out_beside(&self, faces: &[usize]) -> Vec<usize> {
        let laid_out: Vec<usize> = faces.iter().copied().filter(|&face| face < self.n_laid_out).collect();
        if !laid_out.is_empty() {
            return laid_out;
        }
        let (given, filling) = self.faces.split_at(self.n_laid_out);
        let mut fills = vec![false; self.points.len()];
        filling.as_flattened().iter().for_each(|&vertex| fills[vertex] = true);
        (0..given.len()).filter(|&face| given[face].iter().any(|&vertex| fills[vertex])).collect()
    }

    /// The number of folded faces above which neither unfolding nor another choice of vertices is tried.
    fn hopeless(&self) -> usize {
        FOLDED_FACES + (FOLDED_SHARE * self.faces.len() as f64) as usize
    }

    fn attempt(
        &self,
        rank: usize,
        turn: f64,
        side: Side,
        observer: &mut dyn Observer,
    ) -> Result<Attempt, Error> {
        // 1. Move vertices onto the singular points.
        let watch = begun(observer, 0.0, "Placing the poles")?;
        let Some(placed) = place_singular_points::<P>(&self.turned(turn), rank, side, &watch)? else {
            return Ok(Attempt::NoRoom);
        };
        // 2. Lay the faces out in the plane.
        let watch = begun(observer, 0.1, "Laying out faces")?;
        let mut chart = develop::<P>(&placed.points, self.faces, &self.polygons);
        let open: Vec<usize> = (0..self.faces.len()).filter(|&face| !chart.is_closed[face]).collect();
        if !open.is_empty() {
            return Ok(Attempt::Folded(open));
        }
        // 3. Correct roughly what straight edges do to areas, and remove folds.
        let targets = parallel::map(self.targets.len(), |face| self.targets[face] * P::SCALE);
        let goal = Goal {
            targets: &targets,
            fixed: &placed.is_singular,
            corners: &self.corners,
            tolerance: self.tolerance,
            rounding: self.precision.rounding(&chart.images()),
        };
        if watch.goes_on() {
            self.straighten(&mut chart, &goal, &watch);
        }
        let split = self.split(&mut chart, goal.fixed);
        let folded = folded_in_plane(&split.faces, &split.points);
        if !folded.is_empty() {
            return if watch.goes_on() { Ok(Attempt::Folded(folded)) } else { Err(Error::CancelledEarly) };
        }
        // 4. Even out the areas thoroughly.
        Ok(Attempt::Done(self.evened_out(&mut chart, split, &goal, observer)))
    }

    /// Relaxes the areas; unfolds faces unless too many are folded.
    fn straighten(&self, chart: &mut Chart<'_, P>, goal: &Goal<'_>, watch: &Watch<'_>) {
        put_on_grid(chart, goal);
        relax(chart, goal, watch);
        for _ in 0..UNFOLDINGS {
            let is_folded = nearly_folded(&chart.images(), goal.rounding);
            let n_folded = is_folded.iter().filter(|&&is_folded| is_folded).count();
            if n_folded == 0 || n_folded > self.hopeless() {
                return;
            }
            unfold(chart, goal, watch);
            relax(chart, goal, watch);
        }
    }

    /// The layout with evened-out areas, or `before` if that would fold a face in the precision asked for.
    fn evened_out(
        &self,
        chart: &mut Chart<'_, P>,
        before: Split,
        goal: &Goal<'_>,
        observer: &mut dyn Observer,
    ) -> Layout {
        let mut phase = Phase { whole: observer, from: 0.3, to: 1.0 };
        let mut status = even_out(chart, &self.polygons, goal, &mut phase);
        let mut split = self.split(chart, goal.fixed);
        if !folded_in_plane(&split.faces, &split.points).is_empty() {
            split = before;
            if status == Status::Converged {
                status = Status::Stalled;
            }
        }
        if status != Status::Cancelled && !observer.progress(1.0, "Done") {
            status = Status::Cancelled;
        }
        let Split { points, faces, vertex_of } = split.first_faces(self.n_laid_out);
        Layout {
            points: from_rows(points),
            faces: index_array(&faces),
            vertex_of,
            status,
            seconds: self.began.elapsed().as_secs_f64(),
        }
    }

    /// The mesh turned about the pole by an angle.
    fn turned(&self, angle: f64) -> SphereMesh<'_> {
        let (sine, cosine) = angle.sin_cos();
        let turned = |Vector3([x, y, z])| Vector3([cosine * x - sine * y, sine * x + cosine * y, z]);
        let is_turned = angle != 0.0;
        SphereMesh {
            points: parallel::map(self.points.len(), |vertex| {
                if is_turned { turned(self.points[vertex]) } else { self.points[vertex] }
            }),
            faces: self.faces,
            corners: &self.corners,
            polygons: &self.polygons,
            targets: &self.targets,
            candidates: self.candidates.as_deref(),
        }
    }

    /// The points of a chart, rounded to the precision asked for.
    fn split(&self, chart: &mut Chart<'_, P>, singular: &[bool]) -> Split {
        bring_back(chart, singular, &self.polygons);
        let mut split = split_along_seam(&self.corners, &chart.images());
        let finished = |_: usize, point: Point| self.precision.rounded(P::finished(point));
        parallel::fill_with_old(&mut split.points, finished);
        split
    }
}

/// A target on a grid that is fine beside [`LEAST_TOLERANCE`] and coarse beside noise, as [`put_on_grid`] does with
/// vertices.
fn rounded_target(target: f64) -> f64 {
    let cell = TARGET_CELL * target.log2().floor().exp2();
    nearest_multiple(target, cell)
}

/// Reports the beginning of a step and returns its watch.
///
/// # Errors
/// [`Error::CancelledEarly`] if the observer cancels.
fn begun<'a>(observer: &'a mut dyn Observer, fraction: f64, message: &'a str) -> Result<Watch<'a>, Error> {
    if observer.progress(fraction, message) {
        Ok(Watch::new(observer, fraction, message))
    } else {
        Err(Error::CancelledEarly)
    }
}
