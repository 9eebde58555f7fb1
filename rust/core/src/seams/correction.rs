// SPDX-License-Identifier: MIT OR Apache-2.0
//! Corrections of what the plate predicts by maps.
//!
//! Where the maps of a cut are sheared more than was wanted, the search goes on from the last cut that was not enough,
//! for a lower predicted shear: by the rule of three, then by secants. From a cut that was more than enough, it goes on
//! for a higher one.

use super::cut::Cut;
use super::maps::{self, Outlines};
use super::one_to_one::{Limits, Seamed, chords, one_to_one};
use super::options::MET;
use super::prepared::{Prepared, Wishes};
use super::search::Solution;
use crate::control::{Observer, Phase};
use crate::error::Error;
use crate::mesh::Edge;

/// The shear of the maps may exceed the target by this factor.
const NEARLY: f64 = 1.011;

/// Seams are too long where the excess of the maps' shear over 1 is below this part of the target's: for the first maps,
/// and for later ones.
const GENEROUS: [f64; 2] = [0.97, 0.9];

/// The most corrections, where maps have met the target.
const MOST: usize = 3;

/// The most corrections where none have.
const MOST_MISSED: usize = 5;

/// Where a lower prediction leaves a cut as it is, its excess is lowered further, by this factor and so many times.
const LOWER: f64 = 0.8;
const MOST_REPEATS: usize = 4;

/// The most rounds of chords.
const MOST_CHORDS: usize = 8;

/// Bounds of the slope of shear over predicted shear.
const SLOPES: [f64; 2] = [0.4, 3.0];

/// Bounds of the excess of a predicted shear over 1 in units of that of the target.
const EXCESSES: [f64; 2] = [0.25, 1.5];

/// What corrections have found so far.
pub(super) struct Correction<'a> {
    prepared: &'a Prepared<'a>,
    target: f64,
    /// The most islands; `None` where islands may overlap themselves.
    max_islands: Option<usize>,
    tries_other_starts: bool,
    /// Seams of the proxy that stay.
    given: Cut,
    /// The wanted prediction.
    aim: f64,
    /// The predicted shear of each cut, with that of its maps.
    history: Vec<[f64; 2]>,
    /// The last cut of the proxy that was not enough.
    insufficient: Option<Cut>,
}

impl<'a> Correction<'a> {
    /// Corrections of a first prediction `aim`.
    pub(super) fn new(prepared: &'a Prepared<'a>, wishes: &Wishes<'_>, aim: f64) -> Self {
        let target = wishes.target;
        let given = Cut::none(&prepared.proxy);
        let max_islands = (!wishes.overlap).then_some(wishes.max_islands);
        let tries_other_starts = wishes.tries_other_starts;
        Self {
            prepared,
            target,
            max_islands,
            tries_other_starts,
            given,
            aim,
            history: Vec::new(),
            insufficient: None,
        }
    }

    /// The seams that are enough by the maps.
    pub(super) fn run(mut self, solution: Solution, observer: &mut dyn Observer) -> Result<Seamed, Error> {
        // 1. Chords through the proxy's islands that overlap themselves
        let mut phase = Phase { whole: &mut *observer, from: 0.0, to: 0.3 };
        let solution = self.with_chords(solution, &mut phase)?;
        // 2. Corrections by maps
        let mut phase = Phase { whole: &mut *observer, from: 0.3, to: 0.8 };
        let mut seamed = self.corrected(solution, &mut phase)?;
        // 3. One-to-one maps
        if let Some(max_islands) = self.max_islands {
            let tries_other_starts = self.tries_other_starts;
            let limits = Limits { shear: MET * self.target, max_islands, tries_other_starts };
            let mut phase = Phase { whole: observer, from: 0.8, to: 1.0 };
            one_to_one(&mut seamed, &self.prepared.component, limits, &mut phase)?;
        }
        Ok(seamed)
    }

    /// The cut of the proxy with chords where islands overlap themselves, drawn back.
    fn with_chords(
        &mut self,
        mut solution: Solution,
        observer: &mut dyn Observer,
    ) -> Result<Solution, Error> {
        let Some(max_islands) = self.max_islands else { return Ok(solution) };
        let prepared = self.prepared;
        for round in 0..MOST_CHORDS {
            let observer = &mut Phase::of_sequence(&mut *observer, round);
            let chords = chords(&prepared.proxy, &solution.state.cut, &prepared.cost, max_islands, observer)?;
            let Some(chord) = chords.first() else { break };
            let all = prepared.with_partners(&chords.concat());
            let sound = [all, prepared.with_partners(chord), chord.clone()];
            let is_sound = |edges: &Vec<Edge>| {
                let islands = solution.state.cut.with(edges).islands(&prepared.proxy);
                islands.are_disks() && islands.len() <= max_islands
            };
            let Some(edges) = sound.into_iter().find(is_sound) else { break };
            self.given.add(&edges);
            let cut = solution.state.cut.with(&edges);
            solution = prepared.go_on(cut, &self.given, [self.aim, self.target], observer)?;
        }
        Ok(solution)
    }

    /// The cheapest cut found whose maps meet the target; the one of least shear where none does.
    fn corrected(&mut self, mut solution: Solution, observer: &mut dyn Observer) -> Result<Seamed, Error> {
        let mut best: Option<(bool, f64, Seamed)> = None;
        for correction in 0..=MOST_MISSED {
            let observer = &mut Phase::of_sequence(&mut *observer, correction);
            let seamed = self.mapped(&solution, observer)?;
            let shear = seamed.shear();
            let is_enough = shear <= NEARLY * self.target;
            let rank = if is_enough { seamed.cut.sum(&self.prepared.component.cost) } else { shear };
            if is_first(&best, is_enough, rank) {
                best = Some((is_enough, rank, seamed));
            }
            let most =
                if best.as_ref().is_some_and(|(is_enough, ..)| *is_enough) { MOST } else { MOST_MISSED };
            if self.is_done(shear) || correction >= most {
                break;
            }
            let next = self.next(&solution, shear, observer)?;
            if next.state.cut == solution.state.cut {
                break;
            }
            solution = next;
        }
        best.map(|(_, _, seamed)| seamed).ok_or(Error::CancelledEarly)
    }

    fn mapped(&self, solution: &Solution, observer: &mut dyn Observer) -> Result<Seamed, Error> {
        let cut = self.prepared.lifted(&solution.state.cut, observer)?;
        let mut islands = maps::islands(self.prepared.component.mesh, &cut)?;
        maps::map_all(&mut islands, Outlines::MayCross, observer)?;
        let measured = Some(maps::figures(&islands));
        Ok(Seamed { cut, islands, predicted: self.prepared.predicted(solution), measured })
    }

    /// Whether maps of a shear are sheared enough and not too much.
    fn is_done(&self, shear: f64) -> bool {
        let generous = GENEROUS[usize::from(!self.history.is_empty())];
        let is_generous = shear < 1.0 + generous * (self.target - 1.0);
        shear <= NEARLY * self.target && !is_generous
    }

    /// The cut for the next prediction, given the shear of the maps of the last one.
    fn next(
        &mut self,
        solution: &Solution,
        shear: f64,
        observer: &mut dyn Observer,
    ) -> Result<Solution, Error> {
        let predicted = self.prepared.predicted(solution).mean;
        self.history.push([predicted, shear]);
        if shear > NEARLY * self.target {
            self.insufficient = Some(solution.state.cut.clone());
        }
        let cut = self.insufficient.as_ref().unwrap_or(&solution.state.cut);
        self.aim = self.next_aim();
        let mut next = self.prepared.go_on(cut.clone(), &self.given, [self.aim, self.target], observer)?;
        for _ in 0..MOST_REPEATS {
            if shear <= NEARLY * self.target || next.state.cut != solution.state.cut {
                break;
            }
            self.aim = 1.0 + LOWER * (self.aim - 1.0);
            next = self.prepared.go_on(cut.clone(), &self.given, [self.aim, self.target], observer)?;
        }
        Ok(next)
    }

    /// The predicted shear for which maps would have the wanted one: between the last prediction that was enough and
    /// the last that was not, where there are both.
    fn next_aim(&self) -> f64 {
        let excess = self.target - 1.0;
        let aimed = 0.995 * self.target;
        let is_enough = |[_, shear]: &&[f64; 2]| *shear <= NEARLY * self.target;
        let enough = self.history.iter().rev().find(is_enough);
        let too_little = self.history.iter().rev().find(|point| !is_enough(point));
        let next = match (enough, too_little, &self.history[..]) {
            (Some([low, less]), Some([high, more]), _) if low < high => {
                low + (high - low) * ((aimed - less) / (more - less)).clamp(0.2, 0.8)
            }
            (_, _, [.., [aim_before, shear_before], [aim, shear]]) => {
                let (by_aim, by_shear) = (aim - aim_before, shear - shear_before);
                let slope = if by_aim.abs() > 1e-6 { by_shear / by_aim } else { 1.0 };
                aim + (aimed - shear) / slope.clamp(SLOPES[0], SLOPES[1])
            }
            (_, _, [[aim, shear]]) => 1.0 + 0.98 * (aim - 1.0) * excess / (shear - 1.0).max(0.1 * excess),
            _ => self.aim,
        };
        next.clamp(1.0 + EXCESSES[0] * excess, 1.0 + EXCESSES[1] * excess)
    }
}

/// Whether a cut is better than the best so far: one that is enough, then that of lowest rank.
fn is_first<T>(best: &Option<(bool, f64, T)>, is_enough: bool, rank: f64) -> bool {
    best.as_ref().is_none_or(|(was_enough, best_rank, _)| match (is_enough, *was_enough) {
        (true, false) => true,
        (false, true) => false,
        _ => rank < *best_rank,
    })
}
