// SPDX-License-Identifier: MIT OR Apache-2.0
//! Maps with a free outline, which may take any shape that does not cross itself.
//!
//! 1. Starts of free outline (`starts`): plan view, spectral conformal, as rigid as possible; the best of those that are
//!    one-to-one. Where none is, or all have collapsed, an area-preserving map to the disk, which is one-to-one always.
//! 2. A descent (`descent`) on the energy of areas and angles (`energy`) and of contacts of the outline with itself
//!    (`contact`), until the map is stationary.
//! 3. Where contacts remain, further descents with contacts of shorter range.
//!
//! Holes are outlines like the longest loop. Cost: some four factorizations of two unknowns per vertex for the start, and
//! ten to fifty for the descent.

mod arap;
mod contact;
mod descent;
mod energy;
mod lscm;
mod starts;

use super::options::{Boundary, DiskMapOptions};
use super::run::Run;
use super::{certificate, holes};
use crate::codomain::planar::PlanarMap;
use crate::control::{History, Observer, Phase, Status, Watch};
use crate::error::Error;
use crate::mesh::TriangleMesh;
use crate::mesh::renumbering::Renumbered;
use crate::parallel;
use crate::sparse::{Analysis, Failure, Order, elimination_order};
use contact::Outline;
use descent::{Descent, Goal, Problem};
use energy::Energy;
use lscm::of_area_one;

/// Ranges of the contacts, from the first descent to the last, in units of the heights beside them.
const RANGES: [f64; 4] = [0.25, 1e-2, 1e-4, 1e-6];

/// The next range follows where contacts might give away this part of the energy.
const WORTHWHILE: f64 = 3e-3;

/// The descent has converged when the decrement is below this part of the energy.
const STATIONARY: f64 = 1e-9;

/// Without a weight of angles the descent has converged when √(E_A/A) is below this.
const TOLERANCE: f64 = 2e-4;

/// Weight of angles of the map to the disk that takes the place of a start; it keeps the shear low.
const DISK_WEIGHT: f64 = 1.0;

/// Iteration limit of that map.
const DISK_ITERATIONS: usize = 15;

/// A start with an energy above this has collapsed, as conformal maps of long tubes do; the map to the disk is tried too.
const COLLAPSED: f64 = 1e4;

/// Starts are compared with at least this weight of angles.
const LEAST_WEIGHT: f64 = 1e-3;

/// First weight of angles in the search for an area tolerance.
const HEAVIEST: f64 = 1.0;

/// First weight of angles where areas alone count.
const HEAVY: f64 = 1e-3;

/// Upper bound of the weights tried where even the first keeps areas within the tolerance.
const MOST: f64 = 1e4;

/// Factor from one weight to the next lighter one, √0.1.
const LEVEL: f64 = 0.316_227_766_016_837_94;

/// Lower bound of the weights tried.
const LIGHTEST: f64 = 1e-7;

/// A weight of angles is judged where the decrement is below this part of the energy.
const ROUGHLY: f64 = 1e-4;

/// The energy, system and outline of a surface, computed once.
struct Prepared<'a> {
    energy: &'a Energy<'a>,
    analysis: &'a Analysis,
    outline: &'a Outline,
}

/// A surface to be mapped with a free outline.
pub(super) struct Free<'a> {
    pub mesh: &'a TriangleMesh,
    pub targets: &'a [f64],
    pub options: &'a DiskMapOptions<'a>,
}

impl Free<'_> {
    /// The map within the unit disk.
    ///
    /// # Errors
    /// [`NumericsError::NoEmbedding`](crate::NumericsError::NoEmbedding) where every start folds,
    /// [`Error::CancelledEarly`] where the observer ended the run before there was a map without folds.
    pub(super) fn map(
        &self,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> Result<(PlanarMap, Status), Error> {
        let order = elimination_order(self.mesh.n_vertices(), self.mesh.faces())?;
        let by_order = Renumbered::new(self.mesh, order);
        let targets = by_order.of_faces(self.targets);
        let initial = self.options.initial.map(|map| by_order.of_vertices(map));
        let options = DiskMapOptions { initial: initial.as_deref(), density: None, ..*self.options };
        let free = Free { mesh: &by_order.mesh, targets: &targets, options: &options };
        let (map, status) = free.in_order(history, observer)?;
        Ok((by_order.given(&map), status))
    }

    /// The map of a mesh in elimination order.
    fn in_order(
        &self,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> Result<(PlanarMap, Status), Error> {
        let energy = Energy::new(self.mesh, self.targets);
        let n = self.mesh.n_vertices();
        let analysis = Analysis::new(n, self.mesh.faces(), &vec![2; n], Order::AsGiven)?;
        let outline = Outline::new(&energy);
        let prepared = Prepared { energy: &energy, analysis: &analysis, outline: &outline };
        // 1. A start
        let mut phase = Phase { whole: observer, from: 0.0, to: 0.2 };
        let (start, is_cancelled) = self.start(&prepared, &mut phase)?;
        let start = if self.options.initial.is_none() { turned(self.mesh, start) } else { start };
        // 2. The descent
        let mut phase = Phase { whole: observer, from: 0.2, to: 1.0 };
        let (map, status) = if is_cancelled {
            history.push_start(energy.unevenness(&start), 0.0);
            (start, Status::Cancelled)
        } else {
            self.descend(&prepared, start, history, &mut phase)
        };
        // 3. Into the disk
        let map = self.within_the_disk(&outline, &map);
        history.rescale(signed_area(self.mesh, &map));
        Ok((map, status))
    }

    /// Descents with contacts of shorter and shorter range.
    fn descend(
        &self,
        prepared: &Prepared<'_>,
        start: PlanarMap,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> (PlanarMap, Status) {
        let outline = (!self.options.overlap).then_some(prepared.outline);
        let problem = Problem { energy: prepared.energy, analysis: prepared.analysis, outline };
        let mut descent = Descent::new(problem);
        let mut goal = Goal {
            weight: self.options.angle_weight,
            range: RANGES[0],
            most_iterations: self.options.max_iterations.unwrap_or(usize::MAX),
            precision: STATIONARY,
        };
        let mut map = start;
        let mut status = Status::MaxIterations;
        if let Some(tolerance) = self.wanted_deviation() {
            let is_given = self.options.area_tolerance.is_some();
            goal.weight = if is_given { HEAVIEST } else { HEAVY };
            let most = if is_given { MOST } else { HEAVY };
            (map, status) = least_shear(&mut descent, map, &mut goal, (tolerance, most), history, observer);
            if status != Status::Converged || !is_given {
                return (map, status);
            }
        }
        for range in RANGES {
            goal.range = range;
            (map, status) = descent.run(map, &goal, history, observer);
            if status == Status::Cancelled || descent.is_worth_less(&map, &goal, WORTHWHILE) {
                break;
            }
        }
        (map, status)
    }

    /// The deviation of areas down to which λ falls; `None` where λ is given.
    fn wanted_deviation(&self) -> Option<f64> {
        let is_weighted = self.options.angle_weight > 0.0;
        self.options.area_tolerance.or((!is_weighted).then(|| self.options.tolerance.unwrap_or(TOLERANCE)))
    }

    /// A one-to-one map to start from, and a flag that the observer ended the run.
    fn start(
        &self,
        prepared: &Prepared<'_>,
        observer: &mut dyn Observer,
    ) -> Result<(PlanarMap, bool), Error> {
        let outline = (!self.options.overlap).then_some(prepared.outline);
        if let Some(initial) = self.options.initial {
            let initial = of_area_one(prepared.energy, initial.to_vec());
            if let Some(map) = starts::allowed(prepared.energy, outline, initial) {
                return Ok((map, false));
            }
        }
        let watch = Watch::new(observer, 0.0, "Start map");
        let weight = self.options.angle_weight.max(LEAST_WEIGHT);
        match starts::best_start(prepared.energy, prepared.analysis, outline, weight, &watch) {
            Ok(Some((energy, map))) if energy <= COLLAPSED => Ok((map, false)),
            Ok(Some((energy, map))) => self.better_start(prepared, (energy, map), observer),
            Ok(None) | Err(Failure::NotPositiveDefinite) => self.disk_start(prepared, observer),
            Err(Failure::Cancelled) => self.disk_start(prepared, &mut |_: f64, _: &str| false),
        }
    }

    /// The given start or the map to the disk, whichever has the lower energy.
    fn better_start(
        &self,
        prepared: &Prepared<'_>,
        start: starts::Start,
        observer: &mut dyn Observer,
    ) -> Result<(PlanarMap, bool), Error> {
        let (energy, map) = start;
        let weight = self.options.angle_weight.max(LEAST_WEIGHT);
        match self.disk_start(prepared, observer) {
            Ok((disk, is_cancelled)) if prepared.energy.value(&disk, weight) < energy => {
                Ok((disk, is_cancelled))
            }
            Ok((_, is_cancelled)) => Ok((map, is_cancelled)),
            Err(_) => Ok((map, false)),
        }
    }

    /// An area-preserving map to the disk with a sliding boundary, the holes filled on the way.
    fn disk_start(
        &self,
        prepared: &Prepared<'_>,
        observer: &mut dyn Observer,
    ) -> Result<(PlanarMap, bool), Error> {
        let filled = match self.mesh.boundary_loops().len() {
            1 => None,
            _ => Some(holes::fill_holes(self.mesh, self.targets)?),
        };
        let (mesh, targets) =
            filled.as_ref().map_or((self.mesh, self.targets), |fill| (&fill.mesh, &fill.targets));
        let mut evened_out = |angle_weight: f64, max_iterations: Option<usize>| {
            let boundary = Boundary::Sliding;
            let options = DiskMapOptions { boundary, angle_weight, max_iterations, ..Default::default() };
            let run = Run { mesh, targets, options: &options, n_given_faces: self.mesh.n_faces() };
            let (mut map, status) = run.renumbered(&mut History::start(), observer)?;
            map.truncate(self.mesh.n_vertices());
            Ok((of_area_one(prepared.energy, map), status == Status::Cancelled))
        };
        let (map, is_cancelled) = evened_out(DISK_WEIGHT, Some(DISK_ITERATIONS))?;
        if is_cancelled || prepared.energy.value(&map, LEAST_WEIGHT) <= COLLAPSED {
            return Ok((map, is_cancelled));
        }
        evened_out(0.0, None)
    }

    /// The map turned, moved and scaled into the unit disk, as far as rounding folds no tiny face.
    fn within_the_disk(&self, outline: &Outline, map: &[[f64; 2]]) -> PlanarMap {
        let is_sound = |map: &PlanarMap| {
            (self.options.overlap || outline.is_simple(map)) && certificate::folded(self.mesh, map).is_empty()
        };
        // a given start keeps its rotation
        let turned = match self.options.initial {
            None => turned(self.mesh, map.to_vec()),
            Some(_) => map.to_vec(),
        };
        let candidates = [(&*turned, true), (map, true), (&*turned, false), (map, false)];
        let placed = |(map, to_rim)| scaled_into_the_disk(map, center(map), to_rim);
        let sound = candidates.into_iter().map(placed).find(is_sound);
        sound.unwrap_or_else(|| scaled_into_the_disk(map, [0.0; 2], false))
    }
}

/// The middle of the bounding box.
fn center(map: &[[f64; 2]]) -> [f64; 2] {
    let extreme =
        |axis: usize, sign: f64| map.iter().fold(f64::NEG_INFINITY, |most, x| most.max(sign * x[axis]));
    [0, 1].map(|axis| 0.5 * (extreme(axis, 1.0) - extreme(axis, -1.0)))
}

/// Lowers λ of `goal` until the deviation of areas is within `tolerance`, or raises it up to `most` while it stays within:
/// `goal` ends with the heaviest such λ. Converged where there is one.
fn least_shear(
    descent: &mut Descent<'_>,
    mut map: PlanarMap,
    goal: &mut Goal,
    (tolerance, most): (f64, f64),
    history: &mut History,
    observer: &mut dyn Observer,
) -> (PlanarMap, Status) {
    // the last λ that was too heavy, with the deviation there
    let mut heavier: Option<[f64; 2]> = None;
    let mut was_within = false;
    loop {
        let status;
        (map, status) = descent.run(map, &Goal { precision: ROUGHLY, ..*goal }, history, observer);
        let (weight, deviation) = (goal.weight, descent.deviation(&map));
        let is_within = deviation <= tolerance;
        if status == Status::Cancelled || (status == Status::MaxIterations && !is_within) {
            return (map, status);
        } else if is_within && heavier.is_none() && weight < most && status != Status::MaxIterations {
            goal.weight = weight / LEVEL.powi(2);
            continue;
        } else if is_within && (was_within || heavier.is_none() || status == Status::MaxIterations) {
            return (map, Status::Converged);
        } else if weight <= LIGHTEST {
            return (map, Status::Stalled);
        }
        goal.weight = match heavier {
            // interpolate the logarithms linearly, a little to the side of the tolerance
            Some([heavy, more]) if is_within => {
                let exponent = (more / (0.95 * tolerance)).ln() / (more / deviation).ln();
                heavy * (weight / heavy).powf(exponent.clamp(0.1, 1.0))
            }
            _ if was_within => 0.8 * weight,
            _ => LEVEL * weight,
        };
        was_within = was_within || is_within;
        if !is_within {
            heavier = Some([weight, deviation]);
        }
    }
}

/// The map turned so that the first vertex of the longest boundary loop lies to the right of the mean of all vertices.
fn turned(mesh: &TriangleMesh, map: PlanarMap) -> PlanarMap {
    let mean = parallel::sums(map.len(), |v| map[v]).map(|sum| sum / map.len() as f64);
    let first = map[mesh.boundary_loops()[0][0] as usize];
    let [x, y] = [first[0] - mean[0], first[1] - mean[1]];
    let length = x.hypot(y);
    if length.is_nan() || length <= 0.0 {
        return map;
    }
    let [cosine, sine] = [x / length, y / length];
    let around_mean = map.iter().map(|&[u, v]| [u - mean[0], v - mean[1]]);
    around_mean.map(|[u, v]| [cosine * u + sine * v, cosine * v - sine * u]).collect()
}

fn signed_area(mesh: &TriangleMesh, map: &[[f64; 2]]) -> f64 {
    parallel::sum(mesh.n_faces(), |face| {
        let [a, b, c] = mesh.faces()[face].map(|v| map[v as usize]);
        0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
    })
}

/// The map around `center`, scaled into the unit disk: to its rim, or by a power of two, which keeps the orientation of
/// every face bit for bit.
fn scaled_into_the_disk(map: &[[f64; 2]], center: [f64; 2], to_rim: bool) -> PlanarMap {
    let offset = |x: &[f64; 2]| [x[0] - center[0], x[1] - center[1]];
    let radius = map.iter().map(offset).map(|[u, v]| u.hypot(v)).fold(0.0, f64::max);
    let scale =
        if to_rim { (1.0 - 4.0 * f64::EPSILON) / radius } else { (1.0 / radius).log2().floor().exp2() };
    map.iter().map(|x| offset(x).map(|c| scale * c)).collect()
}
