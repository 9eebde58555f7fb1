// SPDX-License-Identifier: MIT OR Apache-2.0
//! A surface to be mapped with a free outline, and what is computed once for it.

use super::energy::Energy;
use super::outline::Outline;
use crate::disk::options::DiskMapOptions;
use crate::mesh::TriangleMesh;
use crate::sparse::Analysis;

/// The energy, system and outline of a surface, computed once.
pub(super) struct Prepared<'a> {
    pub energy: &'a Energy<'a>,
    pub analysis: &'a Analysis,
    pub outline: &'a Outline,
}

/// How the weight of angles is chosen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::disk) enum Schedule<'a> {
    /// As the options say.
    Given,
    /// So that the deviation of areas √(E_A/A) is about a tolerance, in few iterations.
    Quick { tolerance: f64, start: Option<QuickStart<'a>> },
}

/// What a quick map starts from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::disk) enum QuickStart<'a> {
    /// The initial map of the options, whose outlines are pushed apart where they cross, with its weight of angles.
    Initial { weight: f64 },
    /// The wanted image of each face, at whatever place.
    Shapes(&'a [[[f64; 2]; 3]]),
}

/// A surface to be mapped with a free outline.
pub(in crate::disk) struct Free<'a> {
    pub mesh: &'a TriangleMesh,
    pub targets: &'a [f64],
    pub options: &'a DiskMapOptions<'a>,
    pub schedule: Schedule<'a>,
}
