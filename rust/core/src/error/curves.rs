// SPDX-License-Identifier: MIT OR Apache-2.0
//! What can be wrong with landmark curves, and with boundary loops beside them.

use thiserror::Error;

use super::elements::Elements;
use super::kind::ErrorKind;
use super::side::Side;

/// Why landmark curves were refused.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum CurveError {
    /// The lists of landmark curves do not match.
    #[error(
        "curves come in pairs, but there are {source_count} on the source and {target_count} on the target: \
         give a partner to {}, or leave it out",
        .unpaired.named("curve")
    )]
    Counts {
        /// How many curves the source has.
        source_count: usize,
        /// How many the target has.
        target_count: usize,
        /// The curves without a partner.
        unpaired: Elements,
    },

    /// Closed surfaces were given without a curve.
    #[error(
        "no curves on closed surfaces: give at least one pair, or register by landmark points, which needs no curves"
    )]
    NoCurves,

    /// A curve has too few edges.
    #[error(
        "{}: curve {curve} has {edges} edges, but needs at least two, a closed one three: \
         lengthen it, or subdivide the mesh there",
        argument(*side)
    )]
    Short {
        /// The surface, where it is one of two.
        side: Option<Side>,
        /// The curve.
        curve: usize,
        /// How many edges it has.
        edges: usize,
    },

    /// A vertex of a curve does not exist.
    #[error(
        "{}: curve {curve} is out of range at place {place}: {value} is not one of the {n_vertices} vertices \
         (indices start at 0)",
        argument(*side)
    )]
    OutOfRange {
        /// The surface, where it is one of two.
        side: Option<Side>,
        /// The curve.
        curve: usize,
        /// The place in it, from 0.
        place: usize,
        /// The value found there.
        value: usize,
        /// How many vertices the mesh has.
        n_vertices: usize,
    },

    /// A vertex of a curve is none of the repaired mesh.
    #[error(
        "{side}_curves: curve {curve} is no part of the repaired surface at place {place} (vertex {vertex}): \
         choose vertices of the piece that it keeps"
    )]
    Dropped {
        /// The surface.
        side: Side,
        /// The curve.
        curve: usize,
        /// The place in it, from 0.
        place: usize,
        /// The vertex there.
        vertex: usize,
    },

    /// Two consecutive vertices of a curve are not joined by an edge.
    #[error(
        "{}: curve {curve} leaves the edges of the mesh after place {place}: no edge joins vertices {vertices}; \
         list every vertex along the path",
        argument(*side)
    )]
    OffEdges {
        /// The surface, where it is one of two.
        side: Option<Side>,
        /// The curve.
        curve: usize,
        /// The place of the first of the two vertices in it, from 0.
        place: usize,
        /// The two vertices.
        vertices: Elements,
    },

    /// A curve meets itself.
    #[error(
        "{}: curve {curve} meets itself at {}, at places {} and {}: remove the crossing \
         (only the first vertex may be repeated, at the end, to close the curve)",
        argument(*side), .vertices.named("vertex"), places[0], places[1]
    )]
    MeetsItself {
        /// The surface, where it is one of two.
        side: Option<Side>,
        /// The curve.
        curve: usize,
        /// Two places in it with the same vertex, from 0.
        places: [usize; 2],
        /// The vertex.
        vertices: Elements,
    },

    /// Two curves meet.
    #[error(
        "{}: curves {} and {} meet at {}: shorten or move one of them, so that they have no vertex in common",
        argument(*side), curves[0], curves[1], .vertices.named("vertex")
    )]
    Meet {
        /// The surface, where it is one of two.
        side: Option<Side>,
        /// The curves.
        curves: [usize; 2],
        /// The vertices that they share.
        vertices: Elements,
    },

    /// A curve meets the boundary without being a whole loop of it.
    #[error(
        "{}: curve {curve} meets the boundary at {}: end it inside the surface, \
         or give a closed curve that runs along the whole boundary loop",
        argument(*side), .vertices.named("vertex")
    )]
    OnBoundary {
        /// The surface, where it is one of two.
        side: Option<Side>,
        /// The curve.
        curve: usize,
        /// Its vertices on the boundary.
        vertices: Elements,
    },

    /// Of a pair of curves only one is closed.
    #[error(
        "{}: curve {curve} is open, but its partner is closed: close it by its first vertex at the end, or open both",
        argument(*side)
    )]
    NotClosed {
        /// The surface with the open curve, where it is one of two.
        side: Option<Side>,
        /// The curve.
        curve: usize,
    },

    /// Of a pair of closed curves only one runs along the boundary.
    #[error(
        "{}: curve {curve} runs along a boundary loop, but its partner lies inside the other surface: \
         remove the faces that the partner encloses, or fill the hole",
        argument(*side)
    )]
    BoundsOneSide {
        /// The surface with the curve on the boundary, where it is one of two.
        side: Option<Side>,
        /// The curve.
        curve: usize,
    },

    /// The surfaces have different numbers of boundary loops.
    #[error(
        "boundary loops come in pairs too, but beside the curves the source has {source_count} \
         and the target {target_count}: fill the holes that have no partner"
    )]
    LoopCounts {
        /// How many loops the source has that are no curves.
        source_count: usize,
        /// How many the target has.
        target_count: usize,
    },

    /// A curve lies on different sides of a closed curve.
    #[error(
        "curve {curve} lies inside closed curve {closed} on the {side} but outside on the other surface: \
         move it, or check the order of the curves"
    )]
    Sides {
        /// The curve.
        curve: usize,
        /// The closed curve.
        closed: usize,
        /// On which surface it lies inside, the smaller part of the source.
        side: Side,
    },

    /// A closed curve has different numbers of boundary loops on its sides.
    #[error(
        "closed curve {closed} has {source_count} boundary loops inside it on the source \
         but {target_count} on the target: fill the holes that have no partner"
    )]
    LoopSides {
        /// The closed curve.
        closed: usize,
        /// How many loops lie in it on the source.
        source_count: usize,
        /// How many on the target.
        target_count: usize,
    },

    /// A closed curve inside a surface divides it.
    #[error(
        "curves: curve {curve} is closed and divides the surface: open it, \
         or remove the faces on one side of it, which makes it a boundary loop"
    )]
    Divides {
        /// The curve.
        curve: usize,
    },

    /// Too few features for a hyperbolic metric.
    #[error(
        "the surface has {found} features (curves and boundary loops), but a hyperbolic metric with geodesic boundary \
         needs at least three: add curves"
    )]
    TooFewFeatures {
        /// How many there are.
        found: usize,
    },

    /// The curves of one surface look like a mirror image of the other's.
    #[error(
        "the curves fit far better when one surface is mirrored: \
         if they are mirror images like a left and a right hemisphere, mirror one of them (negate x and flip its faces); \
         if only the faces of an open one look to the other side, flip these; or check the order of the curves"
    )]
    Mirrored,

    /// A curve or boundary loop does not open the surface by itself.
    #[error(
        "the surface cannot be cut open along {}: it is no path of edges, or it touches itself or another",
        feature(*curve)
    )]
    Uncuttable {
        /// The curve, `None` for a boundary loop that is none.
        curve: Option<usize>,
    },

    /// Two curves that follow each other cannot be joined.
    #[error(
        "no path of edges joins {} to the next without touching a curve: refine the mesh there",
        feature(*curve)
    )]
    NoArc {
        /// The curve, `None` for a boundary loop that is none.
        curve: Option<usize>,
    },
}

impl CurveError {
    /// What the error is.
    pub fn kind(&self) -> ErrorKind {
        match self {
            Self::Counts { .. } => ErrorKind::CurveCounts,
            Self::NoCurves => ErrorKind::NoCurves,
            Self::Short { .. } => ErrorKind::ShortCurve,
            Self::OutOfRange { .. } | Self::Dropped { .. } => ErrorKind::IndexOutOfRange,
            Self::OffEdges { .. } => ErrorKind::CurveOffEdges,
            Self::MeetsItself { .. } => ErrorKind::CurveMeetsItself,
            Self::Meet { .. } => ErrorKind::CurvesMeet,
            Self::OnBoundary { .. } => ErrorKind::CurveOnBoundary,
            Self::NotClosed { .. } => ErrorKind::CurveNotClosed,
            Self::BoundsOneSide { .. } => ErrorKind::CurveBoundsOneSide,
            Self::LoopCounts { .. } => ErrorKind::LoopCounts,
            Self::Sides { .. } => ErrorKind::CurveSides,
            Self::LoopSides { .. } => ErrorKind::LoopSides,
            Self::Divides { .. } => ErrorKind::CurveDivides,
            Self::TooFewFeatures { .. } => ErrorKind::TooFewFeatures,
            Self::Mirrored => ErrorKind::Mirrored,
            Self::Uncuttable { .. } => ErrorKind::UncuttableCurve,
            Self::NoArc { .. } => ErrorKind::NoArc,
        }
    }

    /// The error with other numbers for the vertices at fault.
    pub(super) fn renumbered(mut self, vertex_of: &dyn Fn(usize) -> usize) -> Self {
        if let Self::OffEdges { vertices, .. }
        | Self::MeetsItself { vertices, .. }
        | Self::Meet { vertices, .. }
        | Self::OnBoundary { vertices, .. } = &mut self
        {
            vertices.renumber(vertex_of);
        }
        self
    }

    /// The surface on which the curves are at fault, where it is one of two.
    pub fn side(&self) -> Option<Side> {
        match self {
            Self::Short { side, .. }
            | Self::OutOfRange { side, .. }
            | Self::OffEdges { side, .. }
            | Self::MeetsItself { side, .. }
            | Self::Meet { side, .. }
            | Self::OnBoundary { side, .. }
            | Self::NotClosed { side, .. }
            | Self::BoundsOneSide { side, .. } => *side,
            Self::Sides { side, .. } | Self::Dropped { side, .. } => Some(*side),
            _ => None,
        }
    }

    /// The curve at fault, the first of two.
    pub fn curve(&self) -> Option<usize> {
        match self {
            Self::Short { curve, .. }
            | Self::OutOfRange { curve, .. }
            | Self::Dropped { curve, .. }
            | Self::OffEdges { curve, .. }
            | Self::MeetsItself { curve, .. }
            | Self::OnBoundary { curve, .. }
            | Self::NotClosed { curve, .. }
            | Self::BoundsOneSide { curve, .. }
            | Self::Sides { curve, .. }
            | Self::LoopSides { closed: curve, .. }
            | Self::Divides { curve }
            | Self::Meet { curves: [curve, _], .. } => Some(*curve),
            Self::Uncuttable { curve } | Self::NoArc { curve } => *curve,
            _ => None,
        }
    }

    /// The second of two curves at fault.
    pub fn second_curve(&self) -> Option<usize> {
        match self {
            Self::Meet { curves: [_, second], .. } | Self::Sides { closed: second, .. } => Some(*second),
            _ => None,
        }
    }

    /// The vertices, or for [`Self::Counts`] the curves, at fault.
    pub fn elements(&self) -> Option<&Elements> {
        match self {
            Self::Counts { unpaired, .. } => Some(unpaired),
            Self::OffEdges { vertices, .. }
            | Self::MeetsItself { vertices, .. }
            | Self::Meet { vertices, .. }
            | Self::OnBoundary { vertices, .. } => Some(vertices),
            _ => None,
        }
    }
}

/// The argument with the curves of a surface.
fn argument(side: Option<Side>) -> String {
    side.map_or("curves".into(), |side| format!("{side}_curves"))
}

/// A landmark curve, or a boundary loop that is none.
fn feature(curve: Option<usize>) -> String {
    curve.map_or("a boundary loop".into(), |curve| format!("curve {curve}"))
}
