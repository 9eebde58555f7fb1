// SPDX-License-Identifier: MIT OR Apache-2.0
//! What can be wrong with a density, an initial map or an outline.

use thiserror::Error;

use super::elements::Elements;
use super::kind::ErrorKind;
use super::side::Side;

/// Why a density, an initial map or an outline was refused.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum MapError {
    /// A density is zero, negative, NaN, infinite, or too small beside the others.
    #[error(
        "density must be positive, finite and at least 1e-12 of the largest, but is {value} at {}: raise it there",
        .faces.named("face")
    )]
    Density {
        /// The faces with such a density.
        faces: Elements,
        /// The first such value.
        value: f64,
    },

    /// A map given has NaN or infinite coordinates.
    #[error("{name} is NaN or infinite at {}: give finite positions for all vertices", .vertices.named("vertex"))]
    NonFinite {
        /// The argument.
        name: &'static str,
        /// The vertices with such a coordinate.
        vertices: Elements,
    },

    /// An initial map does not put the boundary onto the unit circle.
    #[error("the initial map is no start at boundary {}: {reason}", .vertices.named("vertex"))]
    InitialBoundary {
        /// The boundary vertices at fault.
        vertices: Elements,
        /// What is wrong with them.
        reason: String,
    },

    /// An initial map is no start on the sphere.
    #[error("the initial map is no start at {}: {reason}", .vertices.named("vertex"))]
    InitialSphere {
        /// The vertices at fault.
        vertices: Elements,
        /// What is wrong with them.
        reason: &'static str,
    },

    /// Positions on a sphere are not finite, or at its center.
    #[error(
        "{name} points nowhere at {}: give finite positions around the origin, none in it",
        .vertices.named("vertex")
    )]
    NoDirection {
        /// The argument.
        name: &'static str,
        /// The vertices with such a position.
        vertices: Elements,
    },

    /// A map onto the sphere has holes, and nothing says what fills them.
    #[error(
        "the map onto the sphere has holes, at {}, around which a layout would lie over itself: \
         map the surface anew with its holes filled for the time of the map, or close them by a repair before",
        .vertices.named("vertex")
    )]
    OpenOnSphere {
        /// The vertices at the holes.
        vertices: Elements,
    },

    /// A boundary cannot go onto a rectangle.
    #[error("no rectangle fits the boundary at {}: {reason}", .vertices.named("vertex"))]
    NoRectangle {
        /// The vertices at fault.
        vertices: Elements,
        /// What is wrong with them.
        reason: String,
    },

    /// What an untangled map has to keep makes folds inevitable.
    #[error(
        "{} cannot be unfolded, because the corners stay where they are ({}): move these vertices of the image apart, \
         or leave them out of fixed; those of the outline always stay",
        .faces.named("face"), .vertices.named("vertex")
    )]
    HeldFolded {
        /// The folded faces.
        faces: Elements,
        /// Their corners that stay.
        vertices: Elements,
    },

    /// The outline of a map turns too little for what it bounds.
    #[error(
        "the outline makes folds inevitable, at present in {}: it turns {turns} times counter-clockwise, \
         and a map without folds needs {needed}; draw the outline anew, or map the part by disk_map",
        .faces.named("face")
    )]
    OutlineFolds {
        /// The folded faces of the component.
        faces: Elements,
        /// How often the outline turns, holes included.
        turns: i64,
        /// How often it has to.
        needed: i64,
    },
}

impl MapError {
    /// What the error is.
    pub fn kind(&self) -> ErrorKind {
        match self {
            Self::Density { .. } => ErrorKind::InvalidDensity,
            Self::NonFinite { .. } => ErrorKind::MapNotFinite,
            Self::InitialBoundary { .. } => ErrorKind::InitialBoundary,
            Self::InitialSphere { .. } => ErrorKind::InitialSphere,
            Self::NoDirection { .. } => ErrorKind::NoDirection,
            Self::OpenOnSphere { .. } => ErrorKind::OpenSurface,
            Self::NoRectangle { .. } => ErrorKind::NoRectangle,
            Self::HeldFolded { .. } => ErrorKind::FixedFold,
            Self::OutlineFolds { .. } => ErrorKind::OutlineFold,
        }
    }

    /// The error with other numbers for the vertices and faces at fault.
    pub(super) fn renumbered(
        mut self,
        vertex_of: &dyn Fn(usize) -> usize,
        face_of: &dyn Fn(usize) -> usize,
    ) -> Self {
        match &mut self {
            Self::NonFinite { vertices, .. }
            | Self::InitialBoundary { vertices, .. }
            | Self::InitialSphere { vertices, .. }
            | Self::NoDirection { vertices, .. }
            | Self::OpenOnSphere { vertices }
            | Self::NoRectangle { vertices, .. } => vertices.renumber(vertex_of),
            Self::Density { faces, .. } | Self::OutlineFolds { faces, .. } => faces.renumber(face_of),
            Self::HeldFolded { faces, vertices } => {
                faces.renumber(face_of);
                vertices.renumber(vertex_of);
            }
        }
        self
    }

    /// The surface that the map is of, where it is one of two.
    pub fn side(&self) -> Option<Side> {
        match self {
            Self::NonFinite { name, .. } | Self::NoDirection { name, .. } => Side::of_argument(name),
            _ => None,
        }
    }

    /// The elements at fault.
    pub fn elements(&self) -> &Elements {
        match self {
            Self::NonFinite { vertices, .. }
            | Self::InitialBoundary { vertices, .. }
            | Self::InitialSphere { vertices, .. }
            | Self::NoDirection { vertices, .. }
            | Self::OpenOnSphere { vertices }
            | Self::NoRectangle { vertices, .. } => vertices,
            Self::Density { faces, .. }
            | Self::HeldFolded { faces, .. }
            | Self::OutlineFolds { faces, .. } => faces,
        }
    }
}
