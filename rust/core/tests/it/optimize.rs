// SPDX-License-Identifier: MIT OR Apache-2.0
//! The optimizers on objectives whose minimum is known: they are generic, so any objective will do.

use authalic::testing::{
    CgOptions, DescentOptions, Energies, Objective, Stopping, gradient_descent, nonlinear_cg::minimize,
};
use authalic::{History, LineSearch, Silent, Status};

/// ½ xᵀ A x − bᵀ x with A = tridiag(−1, 2 + i, −1), preconditioned by its diagonal or not at all.
struct Quadratic {
    n: usize,
    preconditioned: bool,
}

impl Quadratic {
    fn diagonal(i: usize) -> f64 {
        2.0 + i as f64
    }

    fn product(&self, x: &[f64]) -> Vec<f64> {
        let at = |i: Option<usize>| i.and_then(|i| x.get(i)).copied().unwrap_or(0.0);
        (0..self.n).map(|i| Self::diagonal(i) * x[i] - at(i.checked_sub(1)) - at(Some(i + 1))).collect()
    }
}

impl Objective for Quadratic {
    type Map = Vec<f64>;

    fn value(&self, x: &Vec<f64>) -> f64 {
        self.product(x).iter().zip(x).map(|(product, x)| 0.5 * product * x - x).sum()
    }

    fn gradient(&self, x: &Vec<f64>) -> (Energies, Vec<f64>) {
        let objective = self.value(x);
        let gradient = self.product(x).iter().map(|product| product - 1.0).collect();
        (Energies { objective, authalic_energy: objective }, gradient)
    }

    fn precondition(&self, _map: &Self::Map, gradient: &[f64]) -> Vec<f64> {
        let scale = |i| {
            if self.preconditioned { Self::diagonal(i) } else { 1.0 }
        };
        gradient.iter().enumerate().map(|(i, g)| g / scale(i)).collect()
    }

    fn retract(&self, x: &Vec<f64>, direction: &[f64], step: f64) -> Vec<f64> {
        x.iter().zip(direction).map(|(x, d)| x + step * d).collect()
    }
}

fn run(objective: &Quadratic, max_iterations: usize, tolerance: f64) -> (Vec<f64>, Status, History) {
    let options = CgOptions { stopping: Stopping { max_iterations, tolerance }, ..CgOptions::default() };
    let mut history = History::start();
    let (x, status) = minimize(objective, vec![0.0; objective.n], &options, &mut history, &mut Silent);
    (x, status, history)
}

#[test]
fn conjugate_gradients_solve_a_quadratic() {
    for preconditioned in [false, true] {
        let objective = Quadratic { n: 30, preconditioned };
        let (x, status, history) = run(&objective, 200, 1e-7);
        assert_eq!(status, Status::Converged);
        objective.product(&x).iter().for_each(|product| assert!((product - 1.0).abs() < 1e-6));
        let energies: Vec<f64> = history.records().iter().map(|record| record.authalic_energy).collect();
        assert!(energies.windows(2).all(|pair| pair[1] <= pair[0]), "the energy never rises");
    }
}

#[test]
fn a_good_preconditioner_saves_iterations() {
    let iterations = |preconditioned| run(&Quadratic { n: 60, preconditioned }, 500, 1e-8).2.iterations();
    assert!(2 * iterations(true) < iterations(false));
}

#[test]
fn an_observer_cancels_between_iterations() {
    let objective = Quadratic { n: 30, preconditioned: false };
    let mut calls = 0;
    let mut observer = |_: f64, _: &str| {
        calls += 1;
        calls < 4
    };
    let mut history = History::start();
    let (x, status) = minimize(&objective, vec![0.0; 30], &CgOptions::default(), &mut history, &mut observer);
    assert_eq!((status, history.iterations()), (Status::Cancelled, 3));
    assert!(objective.value(&x) < 0.0);
}

#[test]
fn no_iterations_return_the_start() {
    let (x, status, history) = run(&Quadratic { n: 3, preconditioned: true }, 0, 0.0);
    assert_eq!((x, status, history.iterations()), (vec![0.0; 3], Status::MaxIterations, 0));
}

// Gradient descent

const LINE_SEARCHES: [LineSearch; 2] = [LineSearch::Interpolation, LineSearch::Bounded];

/// xᵀ A x on the unit sphere of n dimensions, A = diag(1, 2, …, n): not convex; ±e₀ are its minima, of value 1.
struct Rayleigh;

impl Objective for Rayleigh {
    type Map = Vec<f64>;

    fn value(&self, x: &Vec<f64>) -> f64 {
        x.iter().enumerate().map(|(i, x)| (i + 1) as f64 * x * x).sum()
    }

    fn gradient(&self, x: &Vec<f64>) -> (Energies, Vec<f64>) {
        let objective = self.value(x);
        let tangent = x.iter().enumerate().map(|(i, x)| 2.0 * ((i + 1) as f64 - objective) * x).collect();
        (Energies { objective, authalic_energy: objective - 1.0 }, tangent)
    }

    fn precondition(&self, _map: &Self::Map, gradient: &[f64]) -> Vec<f64> {
        gradient.to_vec()
    }

    fn retract(&self, x: &Vec<f64>, direction: &[f64], step: f64) -> Vec<f64> {
        let moved: Vec<f64> = x.iter().zip(direction).map(|(x, d)| x + step * d).collect();
        let length = moved.iter().map(|x| x * x).sum::<f64>().sqrt();
        moved.into_iter().map(|x| x / length).collect()
    }
}

/// x + 1/x on the half line x > 0, the only part that is allowed; the minimum is at 1.
struct HalfLine;

impl Objective for HalfLine {
    type Map = f64;

    fn value(&self, x: &f64) -> f64 {
        if *x > 0.0 { x + 1.0 / x } else { f64::INFINITY }
    }

    fn gradient(&self, x: &f64) -> (Energies, Vec<f64>) {
        let objective = self.value(x);
        (Energies { objective, authalic_energy: objective }, vec![1.0 - 1.0 / (x * x)])
    }

    fn precondition(&self, _map: &f64, gradient: &[f64]) -> Vec<f64> {
        gradient.to_vec()
    }

    fn retract(&self, x: &f64, direction: &[f64], step: f64) -> f64 {
        x + step * direction[0]
    }
}

/// 0 at the start and 1 everywhere else, with a gradient that knows nothing of it.
struct Pit;

impl Objective for Pit {
    type Map = f64;

    fn value(&self, x: &f64) -> f64 {
        if *x == 0.0 { 0.0 } else { 1.0 }
    }

    fn gradient(&self, x: &f64) -> (Energies, Vec<f64>) {
        let objective = self.value(x);
        (Energies { objective, authalic_energy: objective }, vec![1.0])
    }

    fn precondition(&self, _map: &f64, gradient: &[f64]) -> Vec<f64> {
        gradient.to_vec()
    }

    fn retract(&self, x: &f64, direction: &[f64], step: f64) -> f64 {
        x + step * direction[0]
    }
}

fn descend<D: Objective>(
    objective: &D,
    start: D::Map,
    line_search: LineSearch,
    (max_iterations, tolerance): (usize, f64),
) -> (D::Map, Status, History) {
    let options = DescentOptions { stopping: Stopping { max_iterations, tolerance }, line_search };
    let mut history = History::start();
    let (x, status) = gradient_descent::minimize(objective, start, &options, &mut history, &mut Silent);
    (x, status, history)
}

fn energies(history: &History) -> Vec<f64> {
    history.records().iter().map(|record| record.authalic_energy).collect()
}

fn assert_never_rises(history: &History) {
    let energies = energies(history);
    let slack = 1e-14 * energies.iter().fold(0.0, |most: f64, energy| most.max(energy.abs()));
    assert!(energies.windows(2).all(|pair| pair[1] <= pair[0] + slack), "{energies:?}");
}

#[test]
fn gradient_descent_solves_a_quadratic() {
    for (line_search, preconditioned) in LINE_SEARCHES.into_iter().flat_map(|l| [(l, false), (l, true)]) {
        let objective = Quadratic { n: 8, preconditioned };
        let (x, status, history) = descend(&objective, vec![0.0; 8], line_search, (400, 1e-6));
        assert_eq!(status, Status::Converged, "{line_search:?}");
        objective.product(&x).iter().for_each(|product| assert!((product - 1.0).abs() < 1e-5));
        assert_never_rises(&history);
    }
}

#[test]
fn gradient_descent_finds_the_minimum_on_a_curved_space() {
    for line_search in LINE_SEARCHES {
        // away from ±e₀ and from the saddles between them
        let start: Vec<f64> = [0.1, -0.5, 0.5, 0.5, -0.5].map(|x: f64| x / 1.01f64.sqrt()).to_vec();
        let (x, status, history) = descend(&Rayleigh, start, line_search, (300, 1e-7));
        assert_eq!(status, Status::Converged, "{line_search:?}");
        assert!((x[0] - 1.0).abs() < 1e-12 && x[1..].iter().all(|x| x.abs() < 1e-6), "{x:?}");
        assert_never_rises(&history);
    }
}

#[test]
fn gradient_descent_stays_where_the_objective_is_finite() {
    for (line_search, start) in LINE_SEARCHES.into_iter().flat_map(|l| [(l, 0.01), (l, 30.0)]) {
        let (x, status, history) = descend(&HalfLine, start, line_search, (200, 1e-8));
        assert_eq!(status, Status::Converged, "{line_search:?} from {start}");
        assert!((x - 1.0).abs() < 1e-7);
        assert_never_rises(&history);
    }
}

#[test]
fn gradient_descent_stalls_where_no_step_decreases() {
    for line_search in LINE_SEARCHES {
        let (x, status, history) = descend(&Pit, 0.0, line_search, (50, 0.0));
        assert_eq!((x, status, history.iterations()), (0.0, Status::Stalled, 0), "{line_search:?}");
    }
}

#[test]
fn gradient_descent_is_cancelled_between_iterations() {
    for (line_search, last) in LINE_SEARCHES.into_iter().flat_map(|l| [0, 1, 5].map(|last| (l, last))) {
        let mut heard = Vec::new();
        let mut observer = |fraction: f64, _: &str| {
            heard.push(fraction);
            heard.len() <= last
        };
        let options = DescentOptions { line_search, ..DescentOptions::default() };
        let (objective, mut history) = (Quadratic { n: 12, preconditioned: false }, History::start());
        let (x, status) =
            gradient_descent::minimize(&objective, vec![0.0; 12], &options, &mut history, &mut observer);
        assert_eq!((status, history.iterations()), (Status::Cancelled, last));
        assert_eq!(objective.value(&x), energies(&history)[last], "the map of the last iteration");
        assert_eq!(heard, (0..=last).map(|done| done as f64 / 50.0).collect::<Vec<_>>());
    }
}

#[test]
fn gradient_descent_keeps_its_limit_and_records_every_iteration() {
    let objective = Quadratic { n: 12, preconditioned: false };
    for line_search in LINE_SEARCHES {
        for limit in [0, 1, 7] {
            let (x, status, history) = descend(&objective, vec![0.5; 12], line_search, (limit, 0.0));
            assert_eq!((status, history.iterations()), (Status::MaxIterations, limit));
            let records = history.records();
            assert!(records.iter().map(|record| record.iteration).eq(0..=limit));
            assert!(records[1..].iter().all(|record| record.step > 0.0) && records[0].step == 0.0);
            assert!(records.windows(2).all(|pair| pair[0].seconds <= pair[1].seconds));
            let (last, gradient) = objective.gradient(&x);
            assert_eq!(records[limit].authalic_energy, last.authalic_energy);
            let norm = gradient.iter().map(|g| g * g).sum::<f64>().sqrt();
            assert!((records[limit].gradient_norm - norm).abs() < 1e-14 * norm);
        }
    }
}

#[test]
fn gradient_descent_goes_on_with_the_history_of_an_earlier_phase() {
    let objective = Quadratic { n: 12, preconditioned: false };
    let stopping = Stopping { max_iterations: 3, tolerance: 0.0 };
    let options = DescentOptions { stopping, ..DescentOptions::default() };
    let mut history = History::start();
    let (x, _) = gradient_descent::minimize(&objective, vec![0.0; 12], &options, &mut history, &mut Silent);
    gradient_descent::minimize(&objective, x, &options, &mut history, &mut Silent);
    assert!(history.records().iter().map(|record| record.iteration).eq(0..=6));
    assert_never_rises(&history);
}

#[test]
fn a_preconditioner_saves_iterations_of_gradient_descent() {
    let iterations = |preconditioned| {
        descend(&Quadratic { n: 30, preconditioned }, vec![0.0; 30], LineSearch::Interpolation, (2000, 1e-7))
            .2
            .iterations()
    };
    assert!(2 * iterations(true) < iterations(false));
}
