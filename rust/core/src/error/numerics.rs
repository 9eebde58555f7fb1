// SPDX-License-Identifier: MIT OR Apache-2.0
//! What can go wrong on good input, in double precision.

use thiserror::Error;

use super::elements::Elements;
use super::kind::ErrorKind;

/// Why a computation failed.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum NumericsError {
    /// A linear system could not be factored.
    #[error("the factorization of {what} failed: the mesh is too badly conditioned (look for slivers)")]
    FactorizationFailed {
        /// The matrix.
        what: String,
    },

    /// No hyperbolic metric with geodesic boundary was found.
    #[error(
        "no hyperbolic metric with these boundaries was found in double precision, left over: {}; \
         remove the slivers there",
        .faces.named("face")
    )]
    NoHyperbolicMetric {
        /// The faces that stayed without area, or whose angles do not fit together.
        faces: Elements,
    },

    /// A tangle could not be resolved.
    #[error(
        "no map without folds was found that keeps the outline{}, left over: {}; {}",
        fixed.as_ref().map_or(String::new(), |pins| format!(" and the fixed vertices ({})", pins.named("vertex"))),
        .folded.named("face"),
        if fixed.is_some() { "leave these vertices out of fixed, or move them" }
        else { "smooth the outline there, or refine the mesh; on a sphere, tangles must lie within a hemisphere" }
    )]
    StillFolded {
        /// The faces that stayed folded.
        folded: Elements,
        /// Fixed vertices that may be in the way.
        fixed: Option<Elements>,
    },

    /// No map without folded faces was found.
    #[error(
        "no map without folds was found in double precision, left over: {}; \
         cut the long thin parts there open by seams",
        .folded.named("face")
    )]
    NoEmbedding {
        /// The faces that stayed folded.
        folded: Elements,
    },

    /// A layout of a sphere folds faces, wherever its singular points are put.
    #[error(
        "{} would fold in a layout in {precision}: try another kind, pole or seam, subdivide the mesh there, \
         or map it with a larger angle_weight",
        .faces.named("face")
    )]
    LayoutFolds {
        /// The faces that fold in the best attempt.
        faces: Elements,
        /// The precision asked for.
        precision: &'static str,
    },

    /// A run would need more memory than there is.
    #[error(
        "{n_vertices} vertices take {} of memory at least, and {} are free: close other programs, or \
         map a coarser mesh",
        in_words(*needed), in_words(*available)
    )]
    OutOfMemory {
        /// The vertices of all surfaces of the run.
        n_vertices: usize,
        /// Bytes that the run takes at least, with what the process keeps for itself.
        needed: u64,
        /// Bytes that are free.
        available: u64,
    },

    /// Arrays, given or asked for, would need more memory than there is.
    #[error(
        "{n_numbers} numbers take {} of memory at least, and {} are free: close other programs, or \
         pass or ask for fewer at a time",
        in_words(*needed), in_words(*available)
    )]
    ArraysOutOfMemory {
        /// The numbers in the arrays.
        n_numbers: usize,
        /// Bytes that they take at least, with what they are computed from and what the process keeps for itself.
        needed: u64,
        /// Bytes that are free.
        available: u64,
    },
}

fn in_words(bytes: u64) -> String {
    let bytes = bytes as f64;
    if bytes < 1e9 { format!("{:.0} MB", bytes / 1e6) } else { format!("{:.1} GB", bytes / 1e9) }
}

impl NumericsError {
    /// What the error is.
    pub fn kind(&self) -> ErrorKind {
        match self {
            Self::FactorizationFailed { .. } => ErrorKind::FactorizationFailed,
            Self::NoHyperbolicMetric { .. } => ErrorKind::NoHyperbolicMetric,
            Self::StillFolded { .. } => ErrorKind::StillFolded,
            Self::NoEmbedding { .. } => ErrorKind::NoEmbedding,
            Self::LayoutFolds { .. } => ErrorKind::LayoutFold,
            Self::OutOfMemory { .. } | Self::ArraysOutOfMemory { .. } => ErrorKind::OutOfMemory,
        }
    }

    /// The error with other numbers for the faces at fault, as where they are faces of a part of the mesh.
    pub(crate) fn with_faces(mut self, face_of: impl Fn(usize) -> usize) -> Self {
        match &mut self {
            Self::FactorizationFailed { .. } | Self::OutOfMemory { .. } | Self::ArraysOutOfMemory { .. } => {}
            Self::NoHyperbolicMetric { faces }
            | Self::StillFolded { folded: faces, .. }
            | Self::NoEmbedding { folded: faces }
            | Self::LayoutFolds { faces, .. } => {
                faces.first.iter_mut().for_each(|face| *face = face_of(*face));
            }
        }
        self
    }

    /// The faces at fault, where the error has any.
    pub fn elements(&self) -> Option<&Elements> {
        match self {
            Self::FactorizationFailed { .. } | Self::OutOfMemory { .. } | Self::ArraysOutOfMemory { .. } => {
                None
            }
            Self::NoHyperbolicMetric { faces } | Self::LayoutFolds { faces, .. } => Some(faces),
            Self::StillFolded { folded, .. } | Self::NoEmbedding { folded } => Some(folded),
        }
    }
}
