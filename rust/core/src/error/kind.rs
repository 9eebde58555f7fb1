// SPDX-License-Identifier: MIT OR Apache-2.0
//! What an error is, as a word that programs can rely on while messages are reworded.

/// Defines a closed list of kinds, each with the word for it and, as its documentation, what it means.
macro_rules! kinds {
    ($(#[$doc:meta])* $name:ident { $(#[doc = $meaning:literal] $kind:ident = $word:literal,)+ }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum $name { $(#[doc = $meaning] $kind,)+ }

        impl $name {
            /// All kinds, in the order of their definition.
            pub const ALL: &'static [Self] = &[$(Self::$kind),+];

            /// The word for the kind, in snake case.
            pub const fn as_str(self) -> &'static str {
                match self { $(Self::$kind => $word,)+ }
            }

            /// What the kind means, as a sentence.
            pub const fn meaning(self) -> &'static str {
                match self { $(Self::$kind => $meaning.trim_ascii_start(),)+ }
            }
        }
    };
}
pub(crate) use kinds;

kinds! {
    /// The kinds of errors, one per remedy; each says which elements its indices number.
    ErrorKind {
        /// The vertex array is empty.
        NoVertices = "no_vertices",
        /// The face array is empty.
        NoFaces = "no_faces",
        /// More faces than can be numbered.
        TooManyFaces = "too_many_faces",
        /// A coordinate is NaN or infinite: vertices.
        NotFinite = "not_finite",
        /// An index is not one of a vertex: rows of the array, as of the faces, or places in the curve.
        IndexOutOfRange = "index_out_of_range",
        /// A face has a vertex twice: faces.
        RepeatedVertex = "repeated_vertex",
        /// A face has the vertices of an earlier one: faces.
        DuplicateFace = "duplicate_face",
        /// A face has no area: faces.
        ZeroArea = "zero_area",
        /// An edge has three faces or more: edges.
        NonManifoldEdge = "non_manifold_edge",
        /// Parts of the surface touch only in a vertex: vertices.
        NonManifoldVertex = "non_manifold_vertex",
        /// The surface is one-sided: an edge.
        NotOrientable = "not_orientable",
        /// A vertex has no face: vertices.
        LooseVertex = "loose_vertex",
        /// The mesh falls into several pieces: their first faces.
        SeveralComponents = "several_components",
        /// A disk was asked for, but the surface has no boundary.
        ClosedSurface = "closed_surface",
        /// A sphere was asked for, but the surface has a boundary: a vertex of each loop.
        OpenSurface = "open_surface",
        /// The surface has handles, like a torus.
        Handles = "handles",
        /// A disk was asked for, but the surface has several boundary loops: a vertex of each.
        SeveralBoundaries = "several_boundaries",
        /// A seam is no edge: pairs of vertices.
        SeamNotEdge = "seam_not_edge",
        /// An array has the wrong shape or content: the rows, where some are at fault.
        InvalidArray = "invalid_array",
        /// An option has a value outside its range.
        InvalidOption = "invalid_option",
        /// A density is not positive: faces.
        InvalidDensity = "invalid_density",
        /// A map given has a coordinate that is NaN or infinite: vertices.
        MapNotFinite = "map_not_finite",
        /// An initial map has its boundary elsewhere than asked for: vertices.
        InitialBoundary = "initial_boundary",
        /// An initial map is no map onto the sphere: vertices.
        InitialSphere = "initial_sphere",
        /// A position on a sphere is its center or not finite: vertices.
        NoDirection = "no_direction",
        /// A boundary fits onto no rectangle: vertices.
        NoRectangle = "no_rectangle",
        /// Vertices that stay make folds inevitable: faces.
        FixedFold = "fixed_fold",
        /// An outline makes folds inevitable: faces.
        OutlineFold = "outline_fold",
        /// Source and target have different numbers of landmarks.
        LandmarkCounts = "landmark_counts",
        /// There are too few landmarks.
        TooFewLandmarks = "too_few_landmarks",
        /// A vertex is a landmark twice: pairs of landmarks.
        RepeatedLandmark = "repeated_landmark",
        /// A landmark is on the boundary: pairs of landmarks.
        LandmarkOnBoundary = "landmark_on_boundary",
        /// Source and target have different numbers of curves: the curves without a partner.
        CurveCounts = "curve_counts",
        /// Closed surfaces were given without a curve.
        NoCurves = "no_curves",
        /// A curve has too few edges.
        ShortCurve = "short_curve",
        /// A curve leaves the edges of the mesh: the two vertices that no edge joins.
        CurveOffEdges = "curve_off_edges",
        /// A curve meets itself: vertices.
        CurveMeetsItself = "curve_meets_itself",
        /// Two curves meet: vertices.
        CurvesMeet = "curves_meet",
        /// A curve meets the boundary without being a whole loop of it: vertices.
        CurveOnBoundary = "curve_on_boundary",
        /// A curve is open, but its partner is closed.
        CurveNotClosed = "curve_not_closed",
        /// A curve is a boundary loop, but its partner is not.
        CurveBoundsOneSide = "curve_bounds_one_side",
        /// A curve lies inside a closed curve on one surface only.
        CurveSides = "curve_sides",
        /// A closed curve divides a surface that has to stay in one piece.
        CurveDivides = "curve_divides",
        /// Source and target have different numbers of boundary loops.
        LoopCounts = "loop_counts",
        /// Source and target have different numbers of boundary loops inside a closed curve.
        LoopSides = "loop_sides",
        /// Too few curves and boundary loops for a hyperbolic metric.
        TooFewFeatures = "too_few_features",
        /// The curves of one surface are a mirror image of those of the other.
        Mirrored = "mirrored",
        /// The surface cannot be cut open along a curve, or along a boundary loop.
        UncuttableCurve = "uncuttable_curve",
        /// No path of edges leads from a curve, or from a boundary loop, to the next.
        NoArc = "no_arc",
        /// A linear system could not be solved.
        FactorizationFailed = "factorization_failed",
        /// No hyperbolic metric was found: faces.
        NoHyperbolicMetric = "no_hyperbolic_metric",
        /// No map without folds was found: faces.
        NoEmbedding = "no_embedding",
        /// Folds could not be removed: faces.
        StillFolded = "still_folded",
        /// A layout of a sphere would fold: faces.
        LayoutFold = "layout_fold",
        /// There is not enough memory for the run, which was not started.
        OutOfMemory = "out_of_memory",
        /// The run was cancelled before there was a map.
        Cancelled = "cancelled",
        /// A fault of the library itself.
        Internal = "internal",
    }
}

impl ErrorKind {
    /// Whether it is a fault of single elements, which [`repair`](crate::repair()) takes away by its default options where
    /// that leaves any face: vertices that are NaN or infinite, faces with a vertex twice, on the vertices of others or
    /// without area, edges with three faces or more, vertices at which parts only touch, and loose ones. No other kind is,
    /// though a repair mends some more meshes: surfaces in pieces or open ones whose vertices coincide, pinholes.
    pub const fn is_mended_by_repair(self) -> bool {
        // without a wildcard, so that each new kind is decided upon
        match self {
            Self::NotFinite
            | Self::RepeatedVertex
            | Self::DuplicateFace
            | Self::ZeroArea
            | Self::NonManifoldEdge
            | Self::NonManifoldVertex
            | Self::LooseVertex => true,
            Self::NoVertices
            | Self::NoFaces
            | Self::TooManyFaces
            | Self::IndexOutOfRange
            | Self::NotOrientable
            | Self::SeveralComponents
            | Self::ClosedSurface
            | Self::OpenSurface
            | Self::Handles
            | Self::SeveralBoundaries
            | Self::SeamNotEdge
            | Self::InvalidArray
            | Self::InvalidOption
            | Self::InvalidDensity
            | Self::MapNotFinite
            | Self::InitialBoundary
            | Self::InitialSphere
            | Self::NoDirection
            | Self::NoRectangle
            | Self::FixedFold
            | Self::OutlineFold
            | Self::LandmarkCounts
            | Self::TooFewLandmarks
            | Self::RepeatedLandmark
            | Self::LandmarkOnBoundary
            | Self::CurveCounts
            | Self::NoCurves
            | Self::ShortCurve
            | Self::CurveOffEdges
            | Self::CurveMeetsItself
            | Self::CurvesMeet
            | Self::CurveOnBoundary
            | Self::CurveNotClosed
            | Self::CurveBoundsOneSide
            | Self::CurveSides
            | Self::CurveDivides
            | Self::LoopCounts
            | Self::LoopSides
            | Self::TooFewFeatures
            | Self::Mirrored
            | Self::UncuttableCurve
            | Self::NoArc
            | Self::FactorizationFailed
            | Self::NoHyperbolicMetric
            | Self::NoEmbedding
            | Self::StillFolded
            | Self::LayoutFold
            | Self::OutOfMemory
            | Self::Cancelled
            | Self::Internal => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::ErrorKind;
    use std::collections::BTreeSet;

    #[test]
    fn words_are_distinct_and_in_snake_case() {
        let words: BTreeSet<&str> = ErrorKind::ALL.iter().map(|kind| kind.as_str()).collect();
        assert_eq!(words.len(), ErrorKind::ALL.len());
        let is_snake = |word: &&str| word.bytes().all(|b| b.is_ascii_lowercase() || b == b'_');
        assert!(words.iter().all(is_snake));
    }
}
