// SPDX-License-Identifier: MIT OR Apache-2.0
//! Surfaces and landmark curves as arguments of a registration.

use authalic::{Error, RepairOptions, Side};
use pyo3::prelude::*;

use super::finished::{Finished, Outcome};
use crate::errors::bad_array;
use crate::indices::index_list;
use crate::provenance::Fingerprint;
use crate::repair::Prepared;
use crate::surface::Given;

/// The names of the source, its vertices and its faces in messages.
pub(super) const SOURCE: [&str; 3] = ["source", "source vertices", "source faces"];
/// The names of the target, its vertices and its faces in messages.
pub(super) const TARGET: [&str; 3] = ["target", "target vertices", "target faces"];

/// The two surfaces of a registration, repaired first where there are options for that.
pub(super) struct Pair {
    pub source: Prepared,
    pub target: Prepared,
    pub inputs: [Fingerprint; 2],
}

impl Pair {
    /// The surfaces, checked to be manifolds; an error carries the side.
    pub(super) fn new(given: [Given; 2], repair: Option<&RepairOptions>) -> Result<Self, Error> {
        let inputs = [given[0].fingerprint(), given[1].fingerprint()];
        let [source, target] = given;
        let prepared = |given: Given| -> Result<Prepared, Error> {
            let prepared = Prepared::new(given, None, repair)?;
            prepared.mapped(|surface| surface.topology().map(|_| ()))?;
            Ok(prepared)
        };
        let of_side = |given, side| prepared(given).map_err(|error| error.of_surface(side));
        Ok(Self { source: of_side(source, Side::Source)?, target: of_side(target, Side::Target)?, inputs })
    }

    /// The registration of the surfaces; an error has the numbers of the vertices and faces given.
    pub(super) fn registered(
        self,
        register: impl FnOnce(&Self) -> Result<Finished, Error>,
    ) -> Result<Outcome, Error> {
        let finished = register(&self).map_err(|error| {
            let side = match error.side() {
                Some(Side::Target) => &self.target,
                _ => &self.source,
            };
            side.in_given_numbers(error)
        })?;
        let Self { source, target, inputs } = self;
        Ok(Outcome { finished, inputs, repaired: [source.repaired, target.repaired] })
    }
}

/// Paths of vertices, one per curve.
pub(crate) fn vertex_paths(
    object: &Bound<'_, PyAny>,
    name: &'static str,
    n_vertices: usize,
) -> PyResult<Vec<Vec<usize>>> {
    let Ok(paths) = object.try_iter() else {
        let found = object.get_type().name()?.to_string();
        return Err(bad_array(object.py(), name, found, "a list of arrays of vertex indices".into()));
    };
    let path = |(curve, path): (usize, PyResult<Bound<'_, PyAny>>)| {
        let path = path?;
        index_list(&path, &format!("{name}: curve {curve}"), "place", n_vertices)
            .map_err(|error| of_curve(path.py(), error, curve))
    };
    paths.enumerate().map(path).collect()
}

/// The error, with the curve that it is about.
fn of_curve(py: Python<'_>, error: PyErr, curve: usize) -> PyErr {
    match error.value(py).setattr("curve", curve) {
        Ok(()) => error,
        Err(failure) => failure,
    }
}
