// SPDX-License-Identifier: MIT OR Apache-2.0
//! The strain of a registration, for Python.

use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;

use crate::arrays::from_array;
use crate::result::{ResultBase, made, restorable};

/// How far a registration stretches and shrinks each face, with both surfaces scaled to one area.
///
/// Means and shares are by area of the source.
#[pyclass(frozen, get_all, extends = ResultBase, module = "authalic")]
pub struct Strain {
    /// (m, 2) float64: the singular values σ₁ ≥ σ₂ of g on each source face.
    sigma: Py<PyArray2<f64>>,
    /// (m,) float64: the symmetric Dirichlet energy of each source face, over 4.
    ///
    /// It is (σ₁² + σ₂² + σ₁⁻² + σ₂⁻²)/4: 1 for an isometry, infinite where the image has no area.
    symmetric_dirichlet: Py<PyArray1<f64>>,
    /// Mean of symmetric_dirichlet.
    mean: f64,
    /// Median of symmetric_dirichlet.
    median: f64,
    /// 95th percentile of symmetric_dirichlet.
    p95: f64,
    /// The share of the area in faces that are stretched or shrunk over 2×: σ₁ > 2 or σ₂ < 1/2.
    stretched: f64,
    /// Int or None: the pair (or curve) with the highest strain around it; None without landmarks.
    worst_landmark: Option<usize>,
}

impl Strain {
    pub(super) fn new(py: Python<'_>, strain: authalic::Strain) -> PyResult<Py<Self>> {
        let strain = Self {
            sigma: from_array(py, strain.sigma),
            symmetric_dirichlet: from_array(py, strain.symmetric_dirichlet),
            mean: strain.mean,
            median: strain.median,
            p95: strain.p95,
            stretched: strain.stretched,
            worst_landmark: strain.worst_landmark,
        };
        made(py, strain, None)
    }
}

restorable!(Strain { sigma, symmetric_dirichlet, mean, median, p95, stretched, worst_landmark });

#[pymethods]
impl Strain {
    fn __repr__(&self) -> String {
        let worst = self.worst_landmark.map_or("None".into(), |pair| pair.to_string());
        format!(
            "Strain(mean={:.3}, median={:.3}, p95={:.3}, stretched={:.3}, worst_landmark={worst})",
            self.mean, self.median, self.p95, self.stretched,
        )
    }
}
