// SPDX-License-Identifier: MIT OR Apache-2.0
//! Evens out the area errors that straight edges make near poles and across creases.
//!
//! Levenberg–Marquardt steps lower a sum of squares of area errors over the places of the vertices ([`AreaSystem`]).
//! The damping rises only at vertices where a step has raised the sum. A step moves only vertices near faces whose
//! areas are off, so that most of a fine mesh stays as the projection has it. Vertices of faces that would fold move
//! less far.
//!
//! Areas leave open where vertices lie, and noise in the input grows from step to step. If any area is off, the vertices
//! are first put on a grid that is fine beside faces and coarse beside noise ([`put_on_grid`]), as targets are rounded
//! before: nearly the same map is laid out in the same places.
//!
//! At first every triangle has its own target. Then only polygons have: their triangles keep the shares that they have
//! by then, so that rows of quads stay rows.
//!
//! Cost: per step about forty passes over the faces near those that are off.

use super::area_system::{AreaSystem, residual};
use super::certificate::nearly_folded;
use super::chart::{Chart, Point, signed_areas};
use super::patch::Patch;
use super::polygons::Polygons;
use super::projection::Projection;
use crate::control::{Observer, Status, Watch};
use crate::mesh::corners::VertexCorners;
use crate::mesh::ties::{nearest_multiple, nearest_power_of_two};
use crate::mesh::{Face, Vertex};
use crate::parallel;

/// The progress message.
const MESSAGE: &str = "Evening out areas";

/// Number of steps toward the targets of triangles.
const FIRST_STEPS: usize = 3;

/// Limit on the work of all further steps: the faces of their patches, as a multiple of all faces.
const WORK: usize = 4;

/// Least limit on the work, in faces, so that coarse meshes converge.
const LEAST_WORK: usize = 400_000;

/// Relative decrease of the energy below which a step counts as without effect.
const LITTLE: f64 = 4e-3;

/// Number of rings, around the faces whose areas are off, whose vertices move at first.
const RINGS: usize = 2;

/// Least damping; the first step has it.
const LEAST_DAMPING: f64 = 1e-2;

/// Factors of the damping of vertices where a rejected step raises the energy, and of all vertices after an accepted
/// one.
const DAMPING_FACTORS: [f64; 2] = [10.0, 1.0 / 3.0];

/// Number of rejected steps in a row after which the relaxation stops.
const REJECTIONS: usize = 8;

/// Limit on shortening a step at faces that would fold; in the second half of the rounds their vertices do not move.
const SHORTENINGS: usize = 20;

/// Least area of a face, as a fraction of its target.
const LEAST_AREA: f64 = 0.4;

/// Least area of a face that is already smaller than [`LEAST_AREA`], as a fraction of its present area.
const LEAST_SHRINKING: f64 = 0.9;

/// Width of the cells of the grid at a vertex, relative to the root of the least target of its faces.
const CELL: f64 = 1.0 / 65_536.0;

/// Bounds of the share that a triangle keeps of its polygon, as multiples of its share on the surface.
const SHARES: [f64; 2] = [0.6, 1.6];

/// The targets of a relaxation.
#[derive(Clone, Copy)]
pub(super) struct Goal<'a> {
    /// (m,): target areas in the plane.
    pub targets: &'a [f64],
    /// (n,): whether each vertex stays in its place.
    pub fixed: &'a [bool],
    /// The corners at each vertex.
    pub corners: &'a VertexCorners,
    /// Relative deviation from its target above which the area of a face counts as off.
    pub tolerance: f64,
    /// Bound of the rounding of coordinates in the precision asked for.
    pub rounding: f64,
}

/// Moves vertices to the nearest points of a grid, where areas are off; no face folds.
pub(super) fn put_on_grid<P: Projection>(chart: &mut Chart<'_, P>, goal: &Goal<'_>) {
    let is_off = |(face, &area): (usize, &f64)| goal.is_off(Face::new(face), area);
    if !signed_areas(&chart.images()).iter().enumerate().any(is_off) {
        return;
    }
    let all: Vec<Face> = Face::all(goal.targets.len()).collect();
    let patch = Patch::around(chart, goal.corners, goal.fixed, &all, 0);
    let targets = patch.of_faces(goal.targets);
    let start = patch.of_vertices(&chart.places);
    let to_grid = parallel::map(start.len(), |vertex| {
        let corners = patch.corners.of(Vertex::new(vertex));
        let least = corners.iter().map(|corner| targets[corner.face()]).fold(f64::INFINITY, f64::min);
        let cell = nearest_power_of_two(CELL * least.sqrt());
        start[vertex].map(|x| nearest_multiple(x, cell) - x)
    });
    let images = patch.images(chart);
    let limits = Limits::new(&images, &signed_areas(&images), &targets, goal.rounding);
    limits.moved(chart, &patch, &start, &to_grid);
}

/// Moves vertices so that the areas of triangles approach their targets. Folded faces may unfold; no other face folds.
pub(super) fn relax<P: Projection>(chart: &mut Chart<'_, P>, goal: &Goal<'_>, watch: &Watch<'_>) {
    let mut relaxation = Relaxation::new(chart, *goal);
    for _ in 0..FIRST_STEPS {
        if relaxation.off.is_empty() || !watch.goes_on() || relaxation.descend(RINGS, watch).gain <= 0.0 {
            return;
        }
    }
}

/// Continues [`relax`] until the areas of polygons are proportional to their targets, with adaptive damping.
///
/// Returns [`Status::Converged`] if no area is off in the end.
pub(super) fn even_out<P: Projection>(
    chart: &mut Chart<'_, P>,
    polygons: &Polygons,
    goal: &Goal<'_>,
    observer: &mut dyn Observer,
) -> Status {
    let targets = shared_out(&signed_areas(&chart.images()), goal.targets, polygons);
    let mut relaxation = Relaxation::new(chart, Goal { targets: &targets, ..*goal });
    let (mut rings, mut rejections) = (RINGS, 0);
    let (mut work, enough) = (0, LEAST_WORK.max(WORK * targets.len()));
    while work < enough && rejections < REJECTIONS {
        if relaxation.off.is_empty() {
            return Status::Converged;
        }
        let fraction = work as f64 / enough as f64;
        if !observer.progress(fraction, MESSAGE) {
            return Status::Cancelled;
        }
        let watch = Watch::new(observer, fraction, MESSAGE);
        let step = relaxation.descend(rings, &watch);
        work += step.n_faces;
        rejections = if step.gain > 0.0 { 0 } else { rejections + 1 };
        if rejections == 0 && step.gain < LITTLE {
            // the areas within a patch add up to too much or too little for its border
            if step.n_faces == targets.len() {
                break;
            }
            rings *= 2;
        }
    }
    Status::Stalled
}

/// Targets that add up to the sum of `areas`: each polygon keeps its share of the sum, each triangle its present share
/// of the polygon.
fn shared_out(areas: &[f64], targets: &[f64], polygons: &Polygons) -> Vec<f64> {
    let scale = areas.iter().sum::<f64>() / targets.iter().sum::<f64>();
    let [mut wanted, mut kept] = [vec![0.0; polygons.count], vec![0.0; polygons.count]];
    let share = |face: usize| {
        let target = scale * targets[face];
        areas[face].clamp(SHARES[0] * target, SHARES[1] * target)
    };
    for (face, &polygon) in polygons.of.iter().enumerate() {
        wanted[polygon] += scale * targets[face];
        kept[polygon] += share(face);
    }
    parallel::map(areas.len(), |face| {
        let polygon = polygons.of[face];
        share(face) * wanted[polygon] / kept[polygon]
    })
}

/// The outcome of a step.
struct Step {
    /// Relative decrease of the energy of the patch; 0 if the step was rejected.
    gain: f64,
    /// The number of faces of the patch.
    n_faces: usize,
}

/// A chart that is being relaxed.
struct Relaxation<'a, 'c, P> {
    chart: &'a mut Chart<'c, P>,
    goal: Goal<'a>,
    /// (m,): the areas of the faces.
    areas: Vec<f64>,
    /// (n,): the damping of each vertex.
    damping: Vec<f64>,
    /// The faces whose areas are off, ascending.
    off: Vec<Face>,
}

impl<'a, 'c, P: Projection> Relaxation<'a, 'c, P> {
    fn new(chart: &'a mut Chart<'c, P>, goal: Goal<'a>) -> Self {
        let areas = signed_areas(&chart.images());
        let off = Face::all(areas.len()).filter(|&face| goal.is_off(face, areas[face])).collect();
        let damping = vec![LEAST_DAMPING; chart.places.len()];
        Self { chart, goal, areas, damping, off }
    }

    /// Takes one step with the vertices within `rings` rings around the faces that are off, if it lowers the energy.
    fn descend(&mut self, rings: usize, watch: &Watch<'_>) -> Step {
        // 1. Choose the patch.
        let patch = Patch::around(self.chart, self.goal.corners, self.goal.fixed, &self.off, rings);
        let targets = patch.of_faces(self.goal.targets);
        let images = patch.images(self.chart);
        let areas = signed_areas(&images);
        // 2. Take the step.
        let damping = patch.of_vertices(&self.damping);
        let step = AreaSystem::new(self.chart, &patch, &images, &areas, &targets).step(&damping, watch);
        let start = patch.of_vertices(&self.chart.places);
        let limits = Limits::new(&images, &areas, &targets, self.goal.rounding);
        let moved = limits.moved(self.chart, &patch, &start, &step);
        // 3. Accept or reject it.
        let energies = |areas: &[f64]| -> Vec<f64> {
            parallel::map(areas.len(), |face| residual(areas[face], targets[face])[0].powi(2))
        };
        let before = energies(&areas);
        let after = energies(&moved);
        let total = |energies: &[f64]| parallel::sum(energies.len(), |face| energies[face]);
        let gain = (1.0 - total(&after) / total(&before)).max(0.0);
        if gain > 0.0 {
            self.accept(&patch, &moved);
        } else {
            patch.put(self.chart, &start);
            self.damp(&patch, &before, &after);
        }
        Step { gain, n_faces: patch.faces.len() }
    }

    /// Records the areas after a step, and lowers the damping.
    fn accept(&mut self, patch: &Patch, areas: &[f64]) {
        for (&face, &area) in patch.faces.iter().zip(areas) {
            self.areas[face] = area;
        }
        let is_off = |face: &Face| self.goal.is_off(*face, self.areas[*face]);
        self.off = patch.faces.iter().copied().filter(is_off).collect();
        for &vertex in &patch.vertices {
            let damping = &mut self.damping[vertex];
            *damping = (*damping * DAMPING_FACTORS[1]).max(LEAST_DAMPING);
        }
    }

    /// Raises the damping of vertices where a step has raised the energy of the faces.
    fn damp(&mut self, patch: &Patch, before: &[f64], after: &[f64]) {
        for (index, &vertex) in patch.vertices.iter().enumerate() {
            let faces = patch.corners.of(Vertex::new(index)).iter().map(|&corner| corner.face());
            if faces.map(|face| after[face] - before[face]).sum::<f64>() >= 0.0 {
                self.damping[vertex] *= DAMPING_FACTORS[0];
            }
        }
    }
}

impl Goal<'_> {
    /// Whether an area of a face is off its target.
    fn is_off(&self, face: Face, area: f64) -> bool {
        let target = self.targets[face];
        (area - target).abs() > self.tolerance * target
    }
}

/// Limits on the areas of a patch during a step.
struct Limits {
    was_folded: Vec<bool>,
    /// The least area of each face, −∞ for faces that were folded.
    least: Vec<f64>,
    rounding: f64,
}

impl Limits {
    fn new(images: &[[Point; 3]], areas: &[f64], targets: &[f64], rounding: f64) -> Self {
        let was_folded = nearly_folded(images, rounding);
        let least = parallel::map(areas.len(), |face| {
            if was_folded[face] {
                f64::NEG_INFINITY
            } else {
                (LEAST_AREA * targets[face]).min(LEAST_SHRINKING * areas[face])
            }
        });
        Self { was_folded, least, rounding }
    }

    /// Moves the vertices of a patch by a step, shortened at faces that would fold, and returns the areas. Nothing
    /// moves if no shortening helps.
    fn moved<P: Projection>(
        &self,
        chart: &mut Chart<'_, P>,
        patch: &Patch,
        start: &[Point],
        step: &[[f64; 2]],
    ) -> Vec<f64> {
        let mut lengths = vec![1.0; start.len()];
        for shortening in 0..SHORTENINGS {
            let places = parallel::map(start.len(), |vertex| {
                let ([x, y], [u, v], length) = (start[vertex], step[vertex], lengths[vertex]);
                [x + length * u, y + length * v]
            });
            patch.put(chart, &places);
            // 1. Find faces that have become too small and vertices that have left the layout.
            let images = patch.images(chart);
            let is_folded = nearly_folded(&images, self.rounding);
            let areas = signed_areas(&images);
            let is_bad = parallel::map(areas.len(), |face| {
                areas[face] < self.least[face] || (is_folded[face] && !self.was_folded[face])
            });
            let leaves = |vertex: usize| lengths[vertex] > 0.0 && !P::is_within(places[vertex]);
            let leaving = parallel::map(places.len(), leaves);
            if !is_bad.contains(&true) && !leaving.contains(&true) {
                return areas;
            }
            // 2. Shorten the steps of their vertices.
            let factor = if shortening < SHORTENINGS / 2 { 0.5 } else { 0.0 };
            parallel::fill_with_old(&mut lengths, |vertex, length| {
                let at_bad_face =
                    patch.corners.of(Vertex::new(vertex)).iter().any(|&corner| is_bad[corner.face()]);
                match (leaving[vertex], at_bad_face) {
                    (true, _) => 0.0,
                    (false, true) => factor * length,
                    (false, false) => length,
                }
            });
        }
        patch.put(chart, start);
        signed_areas(&patch.images(chart))
    }
}
