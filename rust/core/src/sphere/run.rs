// SPDX-License-Identifier: MIT OR Apache-2.0
//! One computation on a closed surface of genus 0.

use super::options::SphereMapOptions;
use crate::mesh::TriangleMesh;

/// One computation on a closed surface of genus 0.
#[derive(Clone, Copy)]
pub(super) struct Run<'a> {
    pub mesh: &'a TriangleMesh,
    pub targets: &'a [f64],
    /// The vertices' shares of the targets.
    pub weights: &'a [f64],
    pub options: &'a SphereMapOptions<'a>,
}
