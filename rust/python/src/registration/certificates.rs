// SPDX-License-Identifier: MIT OR Apache-2.0
//! The certificates of a registration by curves, for Python.

use numpy::PyArray1;
use pyo3::prelude::*;

use crate::indices::from_index_list;
use crate::result::{ResultBase, made, restorable};

/// The proof that a registration by curves is one-to-one and takes curve to curve.
///
/// A map is a homeomorphism if all its faces are positively oriented, its area is the whole, and its banks agree.
#[pyclass(frozen, get_all, extends = ResultBase, module = "authalic")]
pub struct Certificates {
    /// (j,) int64: source faces whose image is not positively oriented in the target's metric; none in a homeomorphism.
    folded: Py<PyArray1<i64>>,
    /// The sum of the signed areas of all images in the target's hyperbolic metric.
    area: f64,
    /// The area of the target: 2π(B − 2) for a surface with B curves and boundary loops.
    expected_area: f64,
    /// |area − expected_area| / expected_area.
    area_error: f64,
    /// The largest distance of a curve's image from its partner, as a fraction of the target's size.
    curve_error: f64,
    /// The largest distance between the images of the two banks of a curve, as a fraction of the target's size.
    bank_error: f64,
    /// The largest deviation from the identity of the changes of chart around a face.
    cocycle_error: f64,
    /// The number of vertices that rounding has put beyond the boundary.
    outside: usize,
    /// The harmonic energy over the target's area.
    ///
    /// It is near 1 for curves that fit, above 2 for a strained map, and NaN without a hyperbolic metric.
    energy_ratio: f64,
    /// (float, float): the largest curvature that the hyperbolic metrics of source and target have left.
    curvature: (f64, f64),
}

impl Certificates {
    pub(super) fn new(py: Python<'_>, certificates: &authalic::Certificates) -> PyResult<Py<Self>> {
        let certificates = Self {
            folded: from_index_list(py, certificates.folded.iter().copied()),
            area: certificates.area,
            expected_area: certificates.expected_area,
            area_error: (certificates.area - certificates.expected_area).abs() / certificates.expected_area,
            curve_error: certificates.curve_error,
            bank_error: certificates.bank_error,
            cocycle_error: certificates.cocycle_error,
            outside: certificates.outside,
            energy_ratio: certificates.energy_ratio,
            curvature: certificates.curvature.into(),
        };
        made(py, certificates, None)
    }
}

restorable!(Certificates {
    folded,
    area,
    expected_area,
    area_error,
    curve_error,
    bank_error,
    cocycle_error,
    outside,
    energy_ratio,
    curvature
});

#[pymethods]
impl Certificates {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!(
            "Certificates(folded={}, area_error={:.1e}, curve_error={:.1e}, bank_error={:.1e}, cocycle_error={:.1e}, \
             energy_ratio={:.3})",
            self.folded.bind(py).len()?,
            self.area_error,
            self.curve_error,
            self.bank_error,
            self.cocycle_error,
            self.energy_ratio,
        ))
    }
}
