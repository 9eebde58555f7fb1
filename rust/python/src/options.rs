// SPDX-License-Identifier: MIT OR Apache-2.0
//! Options and the history, for several bindings.

use authalic::{FlowOptions, MetricMethod, Record};
use numpy::PyArray1;
use pyo3::intern;
use pyo3::prelude::*;

use crate::errors::bad_option;

/// An iteration limit.
pub fn parse_iterations(max_iterations: i64) -> PyResult<usize> {
    usize::try_from(max_iterations)
        .map_err(|_| bad_option(format!("max_iterations must be ≥ 0, but is {max_iterations}")))
}

/// The history as a numpy structured array, which cannot be written to.
pub fn history(py: Python<'_>, records: &[Record]) -> PyResult<Py<PyAny>> {
    let fields = ["iteration", "authalic_energy", "step", "gradient_norm", "seconds"];
    let dtype: Vec<(&str, &str)> =
        fields.iter().map(|&name| (name, if name == "iteration" { "i8" } else { "f8" })).collect();
    let array =
        py.import(intern!(py, "numpy"))?.call_method1(intern!(py, "zeros"), (records.len(), dtype))?;
    array.set_item(
        "iteration",
        PyArray1::from_iter(py, records.iter().map(|record| record.iteration as i64)),
    )?;
    let column = |pick: fn(&Record) -> f64| PyArray1::from_iter(py, records.iter().map(pick));
    array.set_item("authalic_energy", column(|record| record.authalic_energy))?;
    array.set_item("step", column(|record| record.step))?;
    array.set_item("gradient_norm", column(|record| record.gradient_norm))?;
    array.set_item("seconds", column(|record| record.seconds))?;
    array.call_method1(intern!(py, "setflags"), (false,))?;
    Ok(array.unbind())
}

/// The methods for the hyperbolic metric, by name.
pub fn metrics() -> [(&'static str, MetricMethod); 2] {
    [("newton", MetricMethod::Newton), ("ricci_flow", MetricMethod::RicciFlow(FlowOptions::default()))]
}

/// The value that an option names, one of a few.
pub fn choice<T: Copy>(name: &str, given: &str, choices: &[(&str, T)]) -> PyResult<T> {
    choices.iter().find(|(word, _)| *word == given).map(|&(_, value)| value).ok_or_else(|| {
        let words: Vec<String> = choices.iter().map(|(word, _)| format!("\"{word}\"")).collect();
        bad_option(format!("{name} must be {}, but is \"{given}\"", words.join(" or ")))
    })
}
