// SPDX-License-Identifier: MIT OR Apache-2.0
//! Guarded Gauss–Newton: our own descent to an area-preserving map, on the disk and on the sphere.
//!
//! E_A is a zero-residual least-squares problem, so its Gauss–Newton Hessian is all it takes near the minimum; far from
//! it the energy of [`authalic`](crate::energy::authalic) adds a share of angle distortion, whose weight λ
//! [falls](angle_schedule), and a barrier that no step can cross. In each iteration:
//!
//! 1. targets are rescaled to the area of the image, λ is chosen;
//! 2. the Hessian is factored with a damping of each face in proportion to how far it is from its target, once.
//!    Where λ stays until the map is stationary, the exact Hessian takes its place near the end, as far as that is
//!    positive definite;
//! 3. the same factor gives the direction d and a second-order correction for what the areas miss of their linear
//!    prediction;
//! 4. the step is accepted where the energy falls.
//!
//! Area-preserving maps are a large family, and where in it the descent arrives depends on all of its way. So that
//! rounding does not decide, directions are solved in double precision but on the largest meshes, and nothing is
//! repaired by the way: either of these turns a change of 1e-14 of the surface into one of 1e-2 of the map.
//!
//! With [`Profile::Barrier`] an accepted map has no folded face: the energy of every trial is infinite where a face is
//! not positive by more than rounding. [`Profile::Stretch`] drops the barrier and the angles (Levenberg–Marquardt on
//! E_A); in the plane, where areas have signs, it unfolds faces on its way.
//!
//! Cost of one iteration: one factorisation of two unknowns per vertex, two solves, some seven passes over the faces.

pub(crate) mod angle_schedule;
pub(crate) mod area_tolerance;
pub(crate) mod target_floors;

use crate::codomain::motion::{Frame, Motion, frames};
use crate::control::{History, Observer, Status, Watch};
use crate::energy::authalic::{AuthalicEnergy, Element, Hessian, Sums, Weights};
use crate::energy::landmark_penalty::LandmarkPenalty;
use crate::energy::stretch::Profile;
use crate::error::Error;
use crate::mesh::geometry::Vector;
use crate::parallel;
use crate::sparse::{Analysis, Factor, Failure, Order};
use angle_schedule::{AnglePath, AngleSchedule, MANY, Progress, SHORT};

/// A map of the vertices, in space.
pub(crate) type Map = Vec<Vector>;

/// μ, the damping of a face that is wholly off its target.
const DAMPING: f64 = 0.05;

/// What it is multiplied by after a short step, and divided by after a long one: it had better not forget too soon.
const STRAIN: f64 = 3.0;
const RELIEF: f64 = 1.3;

/// What every face is damped by at the most, in units of the deviation of its area ratio.
const LEAST_DEVIATION: f64 = 1e-3;

/// And at the least; on more than [`LARGE`] vertices, where the factor is one in single precision, at least
/// [`SINGLE_PRECISION`], or there is no factor.
const LEAST_DAMPING: f64 = 3e-4;
const SINGLE_PRECISION: f64 = 2e-3;
const LARGE: usize = 500_000;

/// No vertex moves farther than this in one step.
const LONGEST_MOVE: f64 = 0.5;

/// Steps tried along one direction.
const MOST_TRIALS: usize = 30;

/// The slope's share that a step must gain.
const SUFFICIENT: f64 = 1e-4;

/// A map is even enough to end with after the usual iterations when the deviation of its area ratio is below this: on
/// surfaces of fewer than [`MANY`] vertices, on others, and after stages, which few surfaces need.
const EVEN_ENOUGH: [f64; 3] = [0.002, 0.005, 0.003];

/// And it is good enough for a descent that has become slow when it is below this.
const GOOD_ENOUGH: f64 = 0.005;

/// And on surfaces of [`MANY`] vertices or more, where iterations cost, as soon as it is below this.
const EVEN: f64 = 7e-4;

/// The descent ends when this many iterations have lowered E_A by less than [`LEAST_GAIN`] of it.
const PATIENCE: usize = 5;
const LEAST_GAIN: f64 = 0.05;

/// Where λ stays until the map is stationary, the exact Hessian is tried once the slope promised less than this part of
/// the energy.
const NEAR: f64 = 1e-2;

/// The share of the exact Hessian is multiplied by this where it was positive definite at once.
const MORE: f64 = 1.6;

/// The share of the exact Hessian is multiplied by this where it was not positive definite.
const LESS: f64 = 0.6;

/// Shares of the exact Hessian tried in one iteration.
const ATTEMPTS: usize = 2;

/// A direction whose slope has grown by more than this comes of a Hessian that is all but singular, and would amplify
/// noise.
const MOST_GROWTH: f64 = 3.0;

/// An energy below this part of the area is as good as none.
const NOTHING: f64 = 1e-12;

/// A surface, how its vertices may move, and the energy of its maps.
pub(crate) struct Problem {
    pub energy: AuthalicEnergy,
    pub motions: Vec<Motion>,
    /// Landmarks that are wanted at places; none elsewhere.
    pub penalty: LandmarkPenalty,
    analysis: Analysis,
}

/// When and how to descend.
#[derive(Debug, Clone, Copy)]
pub(crate) struct GaussNewtonOptions {
    /// The barrier, or none.
    pub profile: Profile,
    /// λ never falls below this.
    pub angle_weight: f64,
    /// Which way it falls.
    pub path: AnglePath,
    /// Iterations after which a deviation below [`EVEN_ENOUGH`] is good enough; `usize::MAX` where a limit or a tolerance
    /// was asked for.
    pub usual_iterations: usize,
    /// Iterations at the most.
    pub most_iterations: usize,
    /// Converged when the deviation of the area ratio, √(E_A/A), is below this.
    pub tolerance: f64,
    /// Whether to end as soon as no face is folded, after so many iterations.
    pub until_open: Option<usize>,
}

impl Problem {
    /// The same with another energy of the same surface.
    pub(crate) fn with_energy(self, energy: AuthalicEnergy) -> Self {
        Self { energy, ..self }
    }

    /// Analyses the system of the energy, its vertices in an order to be found or as they come.
    pub(crate) fn new(energy: AuthalicEnergy, motions: Vec<Motion>, order: Order) -> Result<Self, Error> {
        let unknowns: Vec<u8> = motions.iter().map(|motion| motion.n_unknowns()).collect();
        let analysis = Analysis::new(motions.len(), energy.faces(), &unknowns, order)?;
        Ok(Self { energy, motions, penalty: LandmarkPenalty::default(), analysis })
    }

    /// The same with landmarks that are wanted at places.
    pub(crate) fn with_landmarks(self, penalty: LandmarkPenalty) -> Self {
        Self { penalty, ..self }
    }

    /// The energy of a map, that of landmarks included.
    fn value(&self, state: &State, weights: &Weights) -> f64 {
        self.energy.value(&state.costs, weights) + state.penalty
    }

    /// The sums of a map, that of landmarks included.
    fn sums(&self, state: &State) -> Sums {
        Sums { penalty: state.penalty, ..self.energy.sums(&state.costs) }
    }

    /// The gradient by the unknowns of every vertex, (n, 2).
    fn gradient(&self, map: &[Vector], frames: &[Frame], weights: &Weights) -> Vec<[f64; 2]> {
        let mut gradient = self.energy.gradient(map, frames, weights);
        self.penalty.add_gradient(map, frames, &mut gradient);
        gradient
    }

    /// E_A of a map over the area of its image.
    pub(crate) fn unevenness(&self, map: &[Vector]) -> f64 {
        let sums = self.energy.sums(&self.energy.costs(map));
        sums.authalic_energy / sums.area
    }

    /// The map reached from `map` by `direction` along the frames.
    pub(super) fn moved(&self, map: &[Vector], frames: &[Frame], direction: &[[f64; 2]]) -> Map {
        parallel::map(map.len(), |v| self.motions[v].moved(map[v], &frames[v], direction[v]))
    }

    /// The unknowns of values at the vertices.
    fn packed(&self, values: &[[f64; 2]]) -> Vec<f64> {
        let mut unknowns = vec![0.0; self.analysis.n_unknowns()];
        for (vertex, value) in values.iter().enumerate() {
            let (first, n) = (self.analysis.first_unknown(vertex), self.motions[vertex].n_unknowns());
            unknowns[first..first + usize::from(n)].copy_from_slice(&value[..usize::from(n)]);
        }
        unknowns
    }

    /// The values at the vertices of unknowns.
    fn unpacked(&self, unknowns: &[f64]) -> Vec<[f64; 2]> {
        parallel::map(self.motions.len(), |vertex| {
            let first = self.analysis.first_unknown(vertex);
            let n = usize::from(self.motions[vertex].n_unknowns());
            std::array::from_fn(|k| if k < n { unknowns[first + k] } else { 0.0 })
        })
    }
}

/// The more even of two results, each with how uneven it is; a second run that was cancelled says so.
pub(crate) fn more_even(first: (f64, Map, Status), second: (f64, Map, Status)) -> (Map, Status) {
    let ((unevenness, map, status), (other_unevenness, other, ended)) = (first, second);
    match other_unevenness < unevenness {
        true => (other, ended),
        false if ended == Status::Cancelled => (map, ended),
        false => (map, status),
    }
}

/// Lowers the energy from `start` and returns the last map with the status, or where the weight of angles is 0 behind
/// the barrier the one with the lowest E_A.
pub(crate) fn minimize(
    problem: &Problem,
    start: Map,
    options: &GaussNewtonOptions,
    history: &mut History,
    observer: &mut dyn Observer,
) -> (Map, Status) {
    let mut descent = Descent::new(problem, *options);
    let mut state = State::new(problem, start);
    let mut sums = problem.sums(&state);
    let mut trend = Trend::default();
    let mut best = (f64::INFINITY, Map::new());
    for done in 0.. {
        // 1. Targets on the scale of the image, λ on its way
        trend.energies.push(sums.total());
        let was_staged = descent.schedule.is_staged();
        let weights = descent.balance(&sums, &trend);
        if was_staged && !descent.schedule.is_staged() {
            trend = Trend { energies: vec![sums.total()], norms: Vec::new() };
        }
        if sums.total() < best.0 && descent.keeps_the_best() {
            best = (sums.total(), state.map.clone());
        }
        if let Some(status) = descent.verdict(done, &sums, &trend, observer) {
            history.push_start(sums.authalic_energy, 0.0);
            return (descent.best_of(best, &sums, state.map, history), status);
        }
        // 2. One factorisation, the direction
        let watch = Watch::new(observer, descent.fraction(done), MESSAGE);
        let damping = descent.damping_of(&sums);
        let is_near = descent.is_near();
        let newton =
            match descent.linearised.direction(problem, &state.map, &weights, damping, is_near, &watch) {
                Ok(newton) => newton,
                Err(failure) => {
                    history.push_start(sums.authalic_energy, 0.0);
                    let is_cancelled = failure == Failure::Cancelled;
                    let status = if is_cancelled { Status::Cancelled } else { Status::Stalled };
                    return (descent.best_of(best, &sums, state.map, history), status);
                }
            };
        let norm = (-newton.slope).max(0.0).sqrt();
        history.push_start(sums.authalic_energy, norm);
        trend.norms.push(norm);
        // 3. A step along it that lowers the energy and folds nothing
        let Some((next, step)) = descent.step(&state, &newton, &weights) else {
            let status = if descent.flat { Status::Converged } else { Status::Stalled };
            return (descent.best_of(best, &sums, state.map, history), status);
        };
        state = next;
        sums = problem.sums(&state);
        descent.adapt(step);
        history.push(sums.authalic_energy, step, norm);
    }
    unreachable!("the verdict ends the loop")
}

const MESSAGE: &str = "Evening out areas";

/// The energies and gradient norms of the iterations so far.
#[derive(Default)]
struct Trend {
    energies: Vec<f64>,
    norms: Vec<f64>,
}

impl Trend {
    /// Whether the last iterations gained next to nothing, and were not about to leave a saddle.
    fn is_slow(&self) -> bool {
        let Some(before) = self.norms.len().checked_sub(PATIENCE) else { return false };
        let [then, now] = [before, self.norms.len()].map(|k| self.energies[k]);
        let is_leaving = self.norms[self.norms.len() - 1] > self.norms[before];
        now > (1.0 - LEAST_GAIN) * then && !is_leaving
    }
}

/// What the iterations hand on.
struct Descent<'a> {
    problem: &'a Problem,
    options: GaussNewtonOptions,
    linearised: Linearised,
    schedule: AngleSchedule,
    /// The deviation to end with after the usual iterations.
    even_enough: f64,
    /// Whether iterations cost.
    is_large: bool,
    /// Whether the last second-order correction was of no use.
    is_straight: bool,
    /// What targets are multiplied by; NaN before the first iteration.
    scale: f64,
    /// μ.
    damping: f64,
    last_step: f64,
    /// Σ targets.
    total_target: f64,
    /// The part of the energy that the last slope promised.
    promise: f64,
    /// Whether it was next to nothing.
    flat: bool,
}

/// A direction with its slope.
type Direction = (Vec<[f64; 2]>, f64);

/// The direction at a map, with what was needed to find it.
pub(super) struct Newton {
    pub frames: Vec<Frame>,
    pub direction: Vec<[f64; 2]>,
    /// The directional derivative of the energy, negative.
    pub slope: f64,
}

impl<'a> Descent<'a> {
    fn new(problem: &'a Problem, options: GaussNewtonOptions) -> Self {
        let targets = problem.energy.targets();
        let is_large = problem.motions.len() >= MANY;
        let has_landmarks = !problem.penalty.vertices().is_empty();
        Self {
            problem,
            options,
            linearised: Linearised::new(problem.motions.len() >= LARGE),
            schedule: AngleSchedule::new(
                options.path,
                options.angle_weight,
                problem.motions.len(),
                has_landmarks,
            ),
            even_enough: match options.path {
                AnglePath::Staged => EVEN_ENOUGH[2],
                AnglePath::Balanced | AnglePath::Held => EVEN_ENOUGH[usize::from(is_large || has_landmarks)],
            },
            // landmarks have to meet, however even areas are
            is_large: is_large && !has_landmarks && options.profile == Profile::Barrier,
            is_straight: false,
            scale: f64::NAN,
            damping: DAMPING,
            last_step: 1.0,
            total_target: parallel::sum(targets.len(), |face| targets[face]),
            promise: f64::INFINITY,
            flat: false,
        }
    }

    /// Whether E_A alone decides which map is the best: it may rise where a barrier or angles count on the way.
    fn keeps_the_best(&self) -> bool {
        self.options.angle_weight == 0.0 && self.options.profile == Profile::Barrier
    }

    /// The map with the lowest E_A met, where that decides, else the last.
    fn best_of(&self, best: (f64, Map), sums: &Sums, last: Map, history: &mut History) -> Map {
        if !self.keeps_the_best() || best.0 >= sums.total() {
            return last;
        }
        // the history ends with the map that is returned
        history.push(self.problem.energy.sums(&self.problem.energy.costs(&best.1)).authalic_energy, 0.0, 0.0);
        best.1
    }

    /// The weights of the next iteration.
    fn balance(&mut self, sums: &Sums, trend: &Trend) -> Weights {
        let balance = sums.total() / sums.angle_energy.max(1e-3);
        let deviation = (sums.total() / sums.area).sqrt();
        // on the way to a weight that was asked for, a descent that is slow has to go on
        let is_on_its_way = self.options.angle_weight > 0.0 && !self.schedule.is_staged();
        let is_flat = self.flat || (is_on_its_way && trend.is_slow());
        let progress = Progress { balance, deviation, step: self.last_step, is_flat };
        let before = self.schedule.weight();
        let angle = self.schedule.advance(&progress);
        // what was flat need not be with another λ
        self.flat &= angle == before;
        self.scale = sums.area / self.total_target;
        Weights { scale: self.scale, angle, profile: self.options.profile }
    }

    /// The status with which to end, if any.
    fn verdict(
        &self,
        done: usize,
        sums: &Sums,
        trend: &Trend,
        observer: &mut dyn Observer,
    ) -> Option<Status> {
        let options = &self.options;
        let (is_held, is_staged) = (self.schedule.is_held(), self.schedule.is_staged());
        let is_slow = options.angle_weight == 0.0 && !is_staged && trend.is_slow();
        let deviation = (sums.total() / sums.area).sqrt();
        let is_asked = options.usual_iterations == usize::MAX;
        let is_even = deviation <= options.tolerance
            || (!is_staged && deviation <= self.even_enough && trend.norms.len() >= options.usual_iterations)
            || (!is_staged && !is_asked && self.is_large && deviation <= EVEN);
        let is_open = options.until_open.is_some_and(|least| done >= least && sums.angle_energy.is_finite());
        if (is_even && !is_held) || is_open || (is_held && self.flat) {
            Some(Status::Converged)
        } else if is_slow {
            // a minimum that is not 0, as coarse surfaces have, is stationary
            let is_at_rest = self.flat || (!is_asked && deviation <= GOOD_ENOUGH);
            Some(if is_at_rest { Status::Converged } else { Status::Stalled })
        } else if done >= options.most_iterations {
            Some(Status::MaxIterations)
        } else if observer.progress(self.fraction(done), MESSAGE) {
            None
        } else {
            Some(Status::Cancelled)
        }
    }

    /// The part done after `done` iterations.
    fn fraction(&self, done: usize) -> f64 {
        // nearly all runs end after the usual iterations, and none may seem to go back
        let usual = self.options.usual_iterations.min(self.options.most_iterations).max(1);
        1.0 - 0.1f64.powf(done as f64 / usual as f64)
    }

    /// The next map, with the step's length; `None` where no step lowers the energy.
    fn step(&mut self, state: &State, newton: &Newton, weights: &Weights) -> Option<(State, f64)> {
        let problem = self.problem;
        let value = problem.value(state, weights);
        self.promise = -newton.slope / value;
        self.flat =
            self.promise <= self.schedule.least_slope() || value <= NOTHING * self.scale * self.total_target;
        // 1. The longest step allowed, straight and corrected to second order
        let squares = newton.direction.iter().map(|d| d[0] * d[0] + d[1] * d[1]);
        let longest = squares.fold(0.0, f64::max).sqrt();
        let mut step = (LONGEST_MOVE / longest).min(1.0);
        let mut bend = None;
        let mut trial = Trial::new(problem, self.path(&state.map, newton, None, step), weights);
        // a correction that was of no use seldom is in the next iteration
        if step == 1.0 && !std::mem::take(&mut self.is_straight) {
            let correction =
                self.linearised.correction(problem, &state.map, &trial.state.map, newton, weights);
            let corrected =
                Trial::new(problem, self.path(&state.map, newton, Some(&correction), step), weights);
            self.is_straight = corrected.value >= trial.value;
            if !self.is_straight {
                (trial, bend) = (corrected, Some(correction));
            }
        }
        // 2. Shorter steps until the energy falls
        for _ in 0..MOST_TRIALS {
            if trial.value.is_finite() && trial.value <= value + SUFFICIENT * step * newton.slope {
                return Some((trial.state, step));
            }
            step *= shrinkage(trial.value - value, step * newton.slope);
            trial = Trial::new(problem, self.path(&state.map, newton, bend.as_deref(), step), weights);
        }
        None
    }

    /// The map at `step` along the direction, bent by the correction.
    fn path(&self, map: &Map, newton: &Newton, bend: Option<&[[f64; 2]]>, step: f64) -> Map {
        let along = |v: usize| match bend {
            None => newton.direction[v].map(|d| step * d),
            Some(bend) => [0, 1].map(|k| step * (newton.direction[v][k] + step * bend[v][k])),
        };
        let direction = parallel::map(map.len(), along);
        self.problem.moved(map, &newton.frames, &direction)
    }

    /// Whether λ stays until the map is stationary, which is not far.
    fn is_near(&self) -> bool {
        self.schedule.is_thorough() && self.promise < NEAR
    }

    /// The damping at a map.
    fn damping_of(&self, sums: &Sums) -> Hessian {
        // in proportion to the residual near the minimum, so that the damping does not decide how fast it is reached
        let deviation = (sums.total() / sums.area).sqrt();
        let least = deviation.clamp(LEAST_DAMPING, LEAST_DEVIATION);
        let is_large = self.problem.motions.len() >= LARGE;
        let least = if is_large { least.max(SINGLE_PRECISION) } else { least };
        Hessian { damping: self.damping, least, curvature: 0.0 }
    }

    /// A short step asks for more damping, a long one for less.
    fn adapt(&mut self, step: f64) {
        self.last_step = step;
        self.damping =
            if step < SHORT { STRAIN * self.damping } else { (self.damping / RELIEF).max(DAMPING) };
    }
}

/// A map with what its energy is made of for any weights.
struct State {
    map: Map,
    costs: Vec<[f64; 2]>,
    /// The penalty on landmarks.
    penalty: f64,
}

impl State {
    fn new(problem: &Problem, map: Map) -> Self {
        let costs = problem.energy.costs(&map);
        let penalty = problem.penalty.value(&map);
        Self { map, costs, penalty }
    }
}

struct Trial {
    state: State,
    value: f64,
}

impl Trial {
    fn new(problem: &Problem, map: Map, weights: &Weights) -> Self {
        let state = State::new(problem, map);
        Self { value: problem.value(&state, weights), state }
    }
}

/// By what to shorten a step that changed the energy by `change` where its slope promised `promised`: to the minimum of
/// the parabola through them, within limits.
fn shrinkage(change: f64, promised: f64) -> f64 {
    match change.is_finite() {
        true => (-0.5 * promised / (change - promised)).clamp(0.1, 0.6),
        false => 0.5,
    }
}

/// Where a direction starts.
struct Place<'a> {
    map: &'a [Vector],
    frames: Vec<Frame>,
    gradient: Vec<[f64; 2]>,
    weights: &'a Weights,
}

/// The factor of the Hessian at a map.
///
/// In single precision its rounding errors, some 1e-3 of a direction along the family of area-preserving maps, would
/// decide where in it the descent ends.
pub(super) struct Linearised {
    single: Option<Factor<f32>>,
    double: Option<Factor<f64>>,
    single_failed: usize,
    /// How much of the way from the composite Hessian to the exact one is tried next.
    curvature: f64,
    /// The last slope.
    slope: f64,
}

impl Linearised {
    /// None yet; in single precision while that holds where asked for.
    fn new(in_single: bool) -> Self {
        let single_failed = if in_single { 0 } else { usize::MAX };
        Self { single: None, double: None, single_failed, curvature: 1.0, slope: f64::NEG_INFINITY }
    }

    /// The direction at `map`: damped Gauss–Newton, or Newton's where a stationary point is near.
    pub(super) fn direction(
        &mut self,
        problem: &Problem,
        map: &[Vector],
        weights: &Weights,
        damping: Hessian,
        is_near: bool,
        watch: &Watch<'_>,
    ) -> Result<Newton, Failure> {
        let frames = frames(&problem.motions, map);
        let gradient = problem.gradient(map, &frames, weights);
        let place = Place { map, frames, gradient, weights };
        let exact = if is_near { self.exact_direction(problem, &place, damping, watch)? } else { None };
        let (direction, slope) = match exact {
            Some(direction) => direction,
            None => self.composite_direction(problem, &place, damping, watch)?,
        };
        self.slope = slope;
        Ok(Newton { frames: place.frames, direction, slope })
    }

    /// The direction of as much of the exact Hessian as is positive definite, with its slope; `None` where that is none.
    fn exact_direction(
        &mut self,
        problem: &Problem,
        place: &Place<'_>,
        damping: Hessian,
        watch: &Watch<'_>,
    ) -> Result<Option<Direction>, Failure> {
        let mut curvature = self.curvature;
        for _ in 0..ATTEMPTS {
            let element = |face: usize| element(problem, place, &Hessian { curvature, ..damping }, face);
            match self.refactor(problem, &element, watch) {
                Err(Failure::Cancelled) => return Err(Failure::Cancelled),
                Err(Failure::NotPositiveDefinite) => {}
                Ok(()) => {
                    let (direction, slope) = self.solved(problem, place);
                    if slope <= 0.0 && slope >= MOST_GROWTH * self.slope {
                        let is_first = curvature == self.curvature;
                        self.curvature = if is_first { (MORE * curvature).min(1.0) } else { curvature };
                        return Ok(Some((direction, slope)));
                    }
                }
            }
            curvature *= LESS;
        }
        self.curvature = curvature;
        Ok(None)
    }

    /// The damped Gauss–Newton direction with its slope.
    fn composite_direction(
        &mut self,
        problem: &Problem,
        place: &Place<'_>,
        damping: Hessian,
        watch: &Watch<'_>,
    ) -> Result<Direction, Failure> {
        for _ in 0..3 {
            self.refactor(problem, &|face: usize| element(problem, place, &damping, face), watch)?;
            let (direction, slope) = self.solved(problem, place);
            if slope <= 0.0 && slope.is_finite() {
                return Ok((direction, slope));
            }
            // single precision was not enough
            if self.single.take().is_none() {
                break;
            }
            self.single_failed = usize::MAX;
        }
        Err(Failure::NotPositiveDefinite)
    }

    /// The direction of the factor with its slope.
    fn solved(&self, problem: &Problem, place: &Place<'_>) -> Direction {
        let gradient = &place.gradient;
        let mut unknowns = problem.packed(gradient);
        self.solve(problem, &mut unknowns);
        let ascent = problem.unpacked(&unknowns);
        let slope =
            parallel::sum(ascent.len(), |v| gradient[v][0] * -ascent[v][0] + gradient[v][1] * -ascent[v][1]);
        (parallel::map(ascent.len(), |v| ascent[v].map(|d| -d)), slope)
    }

    /// Second-order correction of a full step to `moved`, by the factor of the direction.
    fn correction(
        &self,
        problem: &Problem,
        map: &[Vector],
        moved: &[Vector],
        newton: &Newton,
        weights: &Weights,
    ) -> Vec<[f64; 2]> {
        let rhs = problem.energy.curvature(map, moved, &newton.frames, &newton.direction, weights);
        let mut unknowns = problem.packed(&rhs);
        self.solve(problem, &mut unknowns);
        problem.unpacked(&unknowns)
    }

    /// Factors in single precision, in double where that fails; always in double once it failed twice.
    fn refactor(
        &mut self,
        problem: &Problem,
        element: &(dyn Fn(usize) -> Element + Sync),
        watch: &Watch<'_>,
    ) -> Result<(), Failure> {
        let analysis = &problem.analysis;
        if self.single_failed < 2 {
            self.double = None;
            let factor = self.single.get_or_insert_with(|| Factor::new(analysis));
            match factor.refactor(analysis, element, watch) {
                Err(Failure::NotPositiveDefinite) => self.single_failed += 1,
                verdict => return verdict,
            }
        }
        self.single = None;
        self.double.get_or_insert_with(|| Factor::new(analysis)).refactor(analysis, element, watch)
    }

    fn solve(&self, problem: &Problem, unknowns: &mut [f64]) {
        match (&self.single, &self.double) {
            (Some(factor), _) => factor.solve(&problem.analysis, unknowns),
            (None, Some(factor)) => factor.solve(&problem.analysis, unknowns),
            (None, None) => unreachable!("factored before"),
        }
    }
}

/// The Hessian of a face with landmarks, and with a shift that keeps rotations of the whole from being free.
fn element(problem: &Problem, place: &Place<'_>, how: &Hessian, face: usize) -> Element {
    let (energy, map) = (&problem.energy, place.map);
    let mut element = energy.element(map, &place.frames, place.weights, how, face);
    problem.penalty.add_element(map, &place.frames, face, &mut element);
    for c in 0..3 {
        // the same for both unknowns of a corner, so that turning the map turns the result
        let mut shift = 0.5e-10 * (element[2 * c][2 * c] + element[2 * c + 1][2 * c + 1]).abs() + 1e-14;
        if how.curvature > 0.0 {
            // away from a stationary point, a turn of the whole has a negative curvature of the size of the gradient
            let vertex = energy.faces()[face][c] as usize;
            let [a, b] = place.gradient[vertex];
            shift += how.curvature * a.hypot(b) / energy.vertex_corners(vertex).len() as f64;
        }
        (2 * c..2 * c + 2).for_each(|k| element[k][k] += shift);
    }
    element
}
