// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options of seams.

use ndarray::{ArrayView1, ArrayView2};

/// A target that the shear of the maps exceeds by this factor is met.
pub(super) const MET: f64 = 1.012;

/// Whether seams mirror each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Symmetry {
    /// Where the surface has a mirror plane, and symmetric seams are about as good as others.
    #[default]
    Auto,
    /// The surface may have a mirror plane, but seams need not mirror each other.
    Off,
}

/// How seams are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum SeamMethod {
    /// A search, then maps that correct what it predicted.
    #[default]
    Search,
    /// Cones joined by cheapest paths, without a map: a preview within a fraction of a second.
    Cones,
}

/// Options of [`seams`](super::seams).
#[derive(Debug, Clone)]
pub struct SeamOptions<'a> {
    /// The wanted mean of σ₁/σ₂ over the surface, above 1.
    pub target: f64,
    /// Seams that are given, (k, 2), each the two ends of an edge; others are added to them.
    pub fixed: Option<ArrayView2<'a, u32>>,
    /// Factors of the cost of a seam, (n,) at the vertices or (e,) at the edges in ascending order of their ends;
    /// above 1 keeps seams off, below 1 draws them, `inf` forbids them.
    pub weights: Option<ArrayView1<'a, f64>>,
    /// A direction in which seams are seen, of any length: they cost up to three times as much there.
    pub front: Option<[f64; 3]>,
    /// Whether seams mirror each other.
    pub symmetry: Symmetry,
    /// The most islands, where parts that the given seams separate do not make more.
    pub max_islands: Option<usize>,
    /// Let islands overlap themselves.
    pub overlap: bool,
    /// Edges that triangulate polygons, (d, 2): seams along them cost four times as much.
    pub diagonals: Option<ArrayView2<'a, u32>>,
    /// How seams are found.
    pub method: SeamMethod,
}

impl Default for SeamOptions<'_> {
    fn default() -> Self {
        Self {
            target: 1.4,
            fixed: None,
            weights: None,
            front: None,
            symmetry: Symmetry::Auto,
            max_islands: None,
            overlap: false,
            diagonals: None,
            method: SeamMethod::Search,
        }
    }
}
