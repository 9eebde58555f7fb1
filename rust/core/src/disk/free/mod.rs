// SPDX-License-Identifier: MIT OR Apache-2.0
//! Maps with a free outline, which may take any shape that does not cross itself.
//!
//! 1. A surface that bends without stretching is laid flat face by face (`development`), and done.
//! 2. Starts of free outline (`starts`): plan view, spectral conformal, as rigid as possible; the best of those that
//!    are one-to-one. Where none is, or all have collapsed, an area-preserving map to the disk, which is one-to-one
//!    always. Islands may start from another map, whose outlines are pushed apart (`apart`), or from wanted images of
//!    their faces.
//! 3. A descent (`descent`) on the energy of areas and angles (`energy`) and of contacts of the outline with itself
//!    (`contact`), first with heavier weights of angles (`stages`), until the map is stationary.
//! 4. Where contacts remain, further descents with contacts of shorter range.
//!
//! Holes are outlines like the longest loop. Cost: some four factorizations of two unknowns per vertex for the start,
//! and ten to fifty for the descent.

mod apart;
mod arap;
mod contact;
mod descent;
mod development;
mod energy;
mod face;
mod least_shear;
mod local;
mod lscm;
mod meeting;
mod mend;
mod outline;
mod poisson;
mod quick;
mod stages;
mod start;
mod starts;
mod surface;
mod sweep;
mod system;
mod within_disk;

use ndarray::aview2;

use super::options::DiskMapOptions;
use crate::codomain::planar::PlanarMap;
use crate::control::{History, Observer, Phase, Status};
use crate::error::Error;
use crate::mesh::renumbering::Renumbered;
use crate::sparse::{Analysis, Order, elimination_order};
use descent::{Descent, Goal, LowerLocally, Problem};
use development::developed;
use energy::Energy;
use least_shear::least_shear;
use local::lowered_locally;
use outline::Outline;
use quick::quickly;
use stages::by_stages;
use start::Start;
use surface::Prepared;
pub(super) use surface::{Free, QuickStart, Schedule};
use within_disk::{signed_area, turned_without_folds};

/// Ranges of the contacts, from the first descent to the last, in units of the heights beside them.
const RANGES: [f64; 4] = [0.25, 1e-2, 1e-4, 1e-6];

/// The next range follows where contacts might give away this part of the energy.
const WORTHWHILE: f64 = 3e-3;

/// The descent has converged when the decrement is below this part of the energy.
const STATIONARY: f64 = 1e-9;

/// Without a weight of angles the descent has converged when √(E_A/A) is below this.
const TOLERANCE: f64 = 2e-4;

/// First weight of angles in the search for an area tolerance.
const HEAVIEST: f64 = 1.0;

/// First weight of angles where areas alone count.
const HEAVY: f64 = 1e-3;

/// Upper bound of the weights tried where even the first keeps areas within the tolerance.
const MOST: f64 = 1e4;

impl Free<'_> {
    /// The map within the unit disk, with the last weight of angles.
    ///
    /// # Errors
    /// [`NumericsError::NoEmbedding`](crate::NumericsError::NoEmbedding) where every start folds,
    /// [`Error::CancelledEarly`] where the observer ended the run before there was a map without folds.
    pub(super) fn map(
        &self,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> Result<(PlanarMap, Status, f64), Error> {
        if let Some(map) = self.exact(history) {
            return Ok((map, Status::Converged, HEAVIEST));
        }
        let order = elimination_order(self.mesh.n_vertices(), self.mesh.faces())?;
        let by_order = Renumbered::new(self.mesh, order);
        let targets = by_order.of_faces(self.targets);
        let initial = self.options.initial_rows().map(|map| by_order.of_vertices(map));
        let options =
            DiskMapOptions { initial: initial.as_deref().map(aview2), density: None, ..*self.options };
        let shapes = self.shapes().map(|shapes| by_order.of_faces(shapes));
        let schedule = match (self.schedule, &shapes) {
            (Schedule::Quick { tolerance, .. }, Some(shapes)) => {
                Schedule::Quick { tolerance, start: Some(QuickStart::Shapes(shapes)) }
            }
            (schedule, _) => schedule,
        };
        let free = Free { mesh: &by_order.mesh, targets: &targets, options: &options, schedule };
        let (map, status, weight) = free.in_order(history, observer)?;
        Ok((by_order.given(&map), status, weight))
    }

    /// The map that stretches no face, if there is one and no start is given.
    fn exact(&self, history: &mut History) -> Option<PlanarMap> {
        let has_start = matches!(self.schedule, Schedule::Quick { start: Some(_), .. });
        if has_start || self.options.initial.is_some() {
            return None;
        }
        let energy = Energy::new(self.mesh, self.targets);
        let outline = Outline::new(&energy);
        let map = developed(&energy, (!self.options.overlap).then_some(&outline))?;
        let map = self.within_the_disk(&outline, &map);
        history.push_start(energy.unevenness(&map), 0.0);
        Some(map)
    }

    /// The map of a mesh in elimination order.
    fn in_order(
        &self,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> Result<(PlanarMap, Status, f64), Error> {
        let energy = Energy::new(self.mesh, self.targets);
        let n = self.mesh.n_vertices();
        let analysis = Analysis::new(n, self.mesh.faces(), &vec![2; n], Order::AsGiven)?;
        let outline = Outline::new(&energy);
        let prepared = Prepared { energy: &energy, analysis: &analysis, outline: &outline };
        // 1. A start
        let mut phase = Phase { whole: observer, from: 0.0, to: 0.2 };
        let start = self.start(&prepared, &mut phase)?;
        let turned =
            |map| if self.options.initial.is_none() { turned_without_folds(self.mesh, map) } else { map };
        // 2. The descent
        let mut phase = Phase { whole: observer, from: 0.2, to: 1.0 };
        let (map, status, weight) = match start {
            Start::Ended(map, status) => {
                history.push_start(energy.unevenness(&map), 0.0);
                (turned(map), status, self.options.angle_weight)
            }
            Start::Given(map) => self.descend(&prepared, (turned(map), true), history, &mut phase),
            Start::Computed(map) => self.descend(&prepared, (turned(map), false), history, &mut phase),
        };
        // 3. Into the disk
        let map = self.within_the_disk(&outline, &map);
        history.rescale(signed_area(self.mesh, &map));
        Ok((map, status, weight))
    }

    /// The wanted images of the faces, if a quick map starts from these.
    fn shapes(&self) -> Option<&[[[f64; 2]; 3]]> {
        match self.schedule {
            Schedule::Quick { start: Some(QuickStart::Shapes(shapes)), .. } => Some(shapes),
            _ => None,
        }
    }

    /// Descents with contacts of shorter and shorter range, from a start and whether it was given.
    fn descend(
        &self,
        prepared: &Prepared<'_>,
        (start, has_start): (PlanarMap, bool),
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> (PlanarMap, Status, f64) {
        let outline = (!self.options.overlap).then_some(prepared.outline);
        let (energy, analysis) = (prepared.energy, prepared.analysis);
        let lower_locally: Option<LowerLocally> = Some(lowered_locally);
        let problem = Problem { energy, analysis, outline, is_held: None, lower_locally };
        let mut descent = Descent::new(problem);
        let mut goal = Goal {
            weight: self.options.angle_weight,
            range: RANGES[0],
            most_iterations: self.options.max_iterations.unwrap_or(usize::MAX),
            precision: STATIONARY,
        };
        if let Schedule::Quick { tolerance, start: from } = self.schedule {
            let weight = match from {
                Some(QuickStart::Initial { weight }) if has_start => Some(weight),
                _ => None,
            };
            let (map, status) =
                quickly(&mut descent, start, &mut goal, (tolerance, weight), history, observer);
            return (map, status, goal.weight);
        }
        let wanted = self.wanted_deviation();
        let is_given = self.options.area_tolerance.is_some();
        goal.weight = match wanted {
            None => self.options.angle_weight,
            Some(_) if is_given => HEAVIEST,
            Some(_) => HEAVY,
        };
        let (mut map, mut status) = if has_start {
            (start, Status::Converged)
        } else {
            by_stages(&mut descent, start, &goal, history, observer)
        };
        if matches!(status, Status::Cancelled | Status::MaxIterations) {
            return (map, status, goal.weight);
        }
        if let Some(tolerance) = wanted {
            let most = if is_given { MOST } else { HEAVY };
            (map, status) = least_shear(&mut descent, map, &mut goal, (tolerance, most), history, observer);
            if status != Status::Converged || !is_given {
                return (map, status, goal.weight);
            }
        }
        for range in RANGES {
            goal.range = range;
            (map, status) = descent.run(map, &goal, history, observer);
            if status == Status::Cancelled || descent.is_worth_less(&map, &goal, WORTHWHILE) {
                break;
            }
        }
        (map, status, goal.weight)
    }

    /// The deviation of areas down to which λ falls; `None` where λ is given.
    fn wanted_deviation(&self) -> Option<f64> {
        let is_weighted = self.options.angle_weight > 0.0;
        self.options.area_tolerance.or((!is_weighted).then(|| self.options.tolerance.unwrap_or(TOLERANCE)))
    }
}
