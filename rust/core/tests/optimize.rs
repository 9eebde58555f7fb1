// SPDX-License-Identifier: MIT OR Apache-2.0
//! The optimisers on a domain whose minimum is known: they are generic, so any domain will do.

use authalic::optimize::nonlinear_cg::{CgOptions, minimize};
use authalic::optimize::{Domain, Energies, Stopping};
use authalic::{History, Silent, Status};

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

impl Domain for Quadratic {
    type Map = Vec<f64>;

    fn objective(&self, x: &Vec<f64>) -> f64 {
        self.product(x).iter().zip(x).map(|(product, x)| 0.5 * product * x - x).sum()
    }

    fn gradient(&self, x: &Vec<f64>) -> (Energies, Vec<f64>) {
        let objective = self.objective(x);
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

fn run(domain: &Quadratic, max_iterations: usize, tolerance: f64) -> (Vec<f64>, Status, History) {
    let options = CgOptions { stopping: Stopping { max_iterations, tolerance }, ..CgOptions::default() };
    let mut history = History::start();
    let (x, status) = minimize(domain, vec![0.0; domain.n], &options, &mut history, &mut Silent);
    (x, status, history)
}

#[test]
fn conjugate_gradients_solve_a_quadratic() {
    for preconditioned in [false, true] {
        let domain = Quadratic { n: 30, preconditioned };
        let (x, status, history) = run(&domain, 200, 1e-7);
        assert_eq!(status, Status::Converged);
        domain.product(&x).iter().for_each(|product| assert!((product - 1.0).abs() < 1e-6));
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
    let domain = Quadratic { n: 30, preconditioned: false };
    let mut calls = 0;
    let mut observer = |_: f64, _: &str| {
        calls += 1;
        calls < 4
    };
    let mut history = History::start();
    let (x, status) = minimize(&domain, vec![0.0; 30], &CgOptions::default(), &mut history, &mut observer);
    assert_eq!((status, history.iterations()), (Status::Cancelled, 3));
    assert!(domain.objective(&x) < 0.0);
}

#[test]
fn no_iterations_return_the_start() {
    let (x, status, history) = run(&Quadratic { n: 3, preconditioned: true }, 0, 0.0);
    assert_eq!((x, status, history.iterations()), (vec![0.0; 3], Status::MaxIterations, 0));
}
