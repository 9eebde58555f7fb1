// SPDX-License-Identifier: MIT OR Apache-2.0
//! What can be wrong with landmarks.

use thiserror::Error;

use super::elements::Elements;
use super::kind::ErrorKind;
use super::side::Side;

/// Why landmarks were refused.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum LandmarkError {
    /// The lists of landmarks do not match.
    #[error(
        "landmarks come in pairs, but there are {source_count} source and {target_count} target landmarks: \
         give as many of both"
    )]
    Counts {
        /// How many landmarks the source has.
        source_count: usize,
        /// How many the target has.
        target_count: usize,
    },

    /// Too few landmarks to lay one surface over the other.
    #[error(
        "too few landmark pairs to say how the surfaces lie over each other: {found}, give at least {needed}"
    )]
    TooFew {
        /// How many pairs were given.
        found: usize,
        /// How many are needed.
        needed: usize,
    },

    /// A landmark is no vertex of its mesh.
    #[error(
        "{side}_landmarks out of range at {}: {value} is not one of the {n_vertices} vertices (indices start at 0)",
        .pairs.named("pair")
    )]
    OutOfRange {
        /// The surface that they are on.
        side: Side,
        /// The pairs at fault.
        pairs: Elements,
        /// The first such landmark.
        value: usize,
        /// How many vertices the mesh has.
        n_vertices: usize,
    },

    /// A landmark is no vertex of the repaired mesh.
    #[error(
        "{side}_landmarks are no part of the repaired surface at {} (vertex {vertex}): \
         choose vertices of the piece that it keeps",
        .pairs.named("pair")
    )]
    Dropped {
        /// The surface that they are on.
        side: Side,
        /// The pairs at fault.
        pairs: Elements,
        /// The vertex of the first.
        vertex: usize,
    },

    /// Two pairs have the same vertex.
    #[error(
        "{side}_landmarks repeat vertex {vertex} of pair {first} at {}: remove the repeated pairs",
        .pairs.named("pair")
    )]
    Repeated {
        /// The surface that they are on.
        side: Side,
        /// The pair that had the vertex first.
        first: usize,
        /// The pairs that repeat a vertex.
        pairs: Elements,
        /// The first vertex that is repeated.
        vertex: usize,
    },

    /// A landmark lies on the boundary, which goes onto the boundary of the disk as a whole.
    #[error(
        "{side}_landmarks on the boundary at {} (vertex {vertex}): the boundary goes onto the boundary by itself; \
         choose vertices inside",
        .pairs.named("pair")
    )]
    OnBoundary {
        /// The surface that they are on.
        side: Side,
        /// The pairs at fault.
        pairs: Elements,
        /// The vertex of the first.
        vertex: usize,
    },
}

impl LandmarkError {
    /// What the error is.
    pub fn kind(&self) -> ErrorKind {
        match self {
            Self::Counts { .. } => ErrorKind::LandmarkCounts,
            Self::TooFew { .. } => ErrorKind::TooFewLandmarks,
            Self::OutOfRange { .. } | Self::Dropped { .. } => ErrorKind::IndexOutOfRange,
            Self::Repeated { .. } => ErrorKind::RepeatedLandmark,
            Self::OnBoundary { .. } => ErrorKind::LandmarkOnBoundary,
        }
    }

    /// The error with other numbers for vertices.
    pub(super) fn renumbered(mut self, vertex_of: &dyn Fn(usize) -> usize) -> Self {
        if let Self::Repeated { vertex, .. } | Self::OnBoundary { vertex, .. } = &mut self {
            *vertex = vertex_of(*vertex);
        }
        self
    }

    /// The surface whose landmarks are at fault.
    pub fn side(&self) -> Option<Side> {
        match self {
            Self::Counts { .. } | Self::TooFew { .. } => None,
            Self::OutOfRange { side, .. }
            | Self::Dropped { side, .. }
            | Self::Repeated { side, .. }
            | Self::OnBoundary { side, .. } => Some(*side),
        }
    }

    /// The pairs at fault, where there are any.
    pub fn elements(&self) -> Option<&Elements> {
        match self {
            Self::Counts { .. } | Self::TooFew { .. } => None,
            Self::OutOfRange { pairs, .. }
            | Self::Dropped { pairs, .. }
            | Self::Repeated { pairs, .. }
            | Self::OnBoundary { pairs, .. } => Some(pairs),
        }
    }
}
