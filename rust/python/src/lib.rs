// SPDX-License-Identifier: MIT OR Apache-2.0
//! Python bindings of the crate `authalic`: the module `authalic._native`, re-exported by the package
//! `authalic`.

// The docstrings are Python's: [0] in an example is no link.
#![allow(rustdoc::broken_intra_doc_links)]

mod arrays;
mod disk;
mod distortion;
mod errors;
mod hessian;
mod hints;
mod indices;
mod layout;
mod lookup;
mod memory;
mod mesh_objects;
mod options;
mod packing;
mod provenance;
mod record;
mod registration;
mod repair;
mod restoring;
mod result;
mod run;
mod seams;
mod sphere;
mod structure;
mod surface;
mod untangle;
mod values;

use pyo3::prelude::*;

#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    errors::register(module)?;
    module.add_class::<result::ResultBase>()?;
    module.add_function(wrap_pyfunction!(restoring::_fields, module)?)?;
    module.add_function(wrap_pyfunction!(restoring::_restored, module)?)?;
    module.add_class::<surface::Surface>()?;
    module.add_class::<surface::Patch>()?;
    module.add_class::<repair::Repaired>()?;
    module.add_class::<distortion::Distortion>()?;
    module.add_class::<disk::DiskMap>()?;
    module.add_class::<sphere::SphereMap>()?;
    module.add_class::<sphere::Refinement>()?;
    module.add_class::<layout::Layout>()?;
    module.add_class::<registration::Registration>()?;
    module.add_class::<registration::Strain>()?;
    module.add_class::<registration::Certificates>()?;
    module.add_class::<structure::HyperbolicStructure>()?;
    module.add_class::<structure::Pants>()?;
    module.add_class::<untangle::Untangled>()?;
    module.add_class::<seams::Seams>()?;
    module.add_class::<seams::Unwrap>()?;
    module.add_class::<packing::Packing>()?;
    module.add_function(wrap_pyfunction!(run::set_threads, module)?)?;
    module.add_function(wrap_pyfunction!(surface::cut, module)?)?;
    module.add_function(wrap_pyfunction!(repair::repair, module)?)?;
    module.add_function(wrap_pyfunction!(distortion::distortion, module)?)?;
    module.add_function(wrap_pyfunction!(distortion::distortions, module)?)?;
    module.add_function(wrap_pyfunction!(disk::disk_map, module)?)?;
    module.add_function(wrap_pyfunction!(disk::disk_maps, module)?)?;
    module.add_function(wrap_pyfunction!(sphere::sphere_map, module)?)?;
    module.add_function(wrap_pyfunction!(hessian::stretch_hessian, module)?)?;
    module.add_function(wrap_pyfunction!(untangle::untangle, module)?)?;
    module.add_function(wrap_pyfunction!(seams::seams, module)?)?;
    module.add_function(wrap_pyfunction!(seams::unwrap, module)?)?;
    module.add_function(wrap_pyfunction!(packing::pack, module)?)?;
    module.add_function(wrap_pyfunction!(registration::register_disks, module)?)?;
    module.add_function(wrap_pyfunction!(registration::register_spheres, module)?)?;
    module.add_function(wrap_pyfunction!(registration::register_hyperbolic, module)?)?;
    module.add_function(wrap_pyfunction!(structure::hyperbolic_structure, module)?)?;
    module.add_function(wrap_pyfunction!(registration::homotopy, module)?)
}
