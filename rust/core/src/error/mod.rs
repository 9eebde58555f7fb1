// SPDX-License-Identifier: MIT OR Apache-2.0
//! What can be wrong with a mesh, with an option or with a computation.
//!
//! Every message names what failed, the elements (the first few indices and how many there are) and what
//! the caller can do about it. Only broken input and failed numerics are errors: a run that stops early
//! returns its best map with a status instead.

use std::fmt;

use thiserror::Error;

/// How many elements an [`Elements`] keeps and prints.
pub const NAMED_ELEMENTS: usize = 8;

/// Offending elements: the indices of the first few and the count of all.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Elements {
    /// The indices of the first `NAMED_ELEMENTS` elements, in the order found: `arity` numbers for each.
    pub first: Vec<usize>,
    /// How many elements offend in all.
    pub count: usize,
    /// How many indices name one element: 1 for vertices, faces and loops; 2 for edges, named by their ends.
    pub arity: usize,
}

impl Elements {
    /// Collects the indices of an iterator, or `None` where it is empty.
    pub fn collect(indices: impl IntoIterator<Item = usize>) -> Option<Self> {
        Self::gather(indices.into_iter().map(|index| [index]))
    }

    /// Collects edges, each named by its two vertices, or `None` where there are none.
    pub fn edges(edges: impl IntoIterator<Item = [u32; 2]>) -> Option<Self> {
        Self::gather(edges.into_iter().map(|edge| edge.map(|end| end as usize)))
    }

    fn gather<const ARITY: usize>(mut all: impl Iterator<Item = [usize; ARITY]>) -> Option<Self> {
        let named: Vec<_> = all.by_ref().take(NAMED_ELEMENTS).collect();
        let count = named.len() + all.count();
        (count > 0).then(|| Self { first: named.concat(), count, arity: ARITY })
    }

    /// The elements as a phrase: `face 3`, `2 edges ((0, 4), (4, 7))`, `12 vertices (0, 1, 2, …)`.
    fn named(&self, noun: &str) -> String {
        match self.count {
            1 => format!("{noun} {self}"),
            count => format!("{count} {} ({self})", plural(noun)),
        }
    }

    fn name(&self, element: &[usize]) -> String {
        let indices: Vec<String> = element.iter().map(usize::to_string).collect();
        match self.arity {
            1 => indices.concat(),
            _ => format!("({})", indices.join(", ")),
        }
    }
}

impl fmt::Display for Elements {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let named: Vec<String> = self.first.chunks(self.arity.max(1)).map(|e| self.name(e)).collect();
        write!(formatter, "{}", named.join(", "))?;
        match self.count.saturating_sub(named.len()) {
            0 => Ok(()),
            _ => write!(formatter, ", …"),
        }
    }
}

fn plural(noun: &str) -> String {
    match noun {
        "vertex" => "vertices".into(),
        _ => format!("{noun}s"),
    }
}

/// Why a call was refused or failed.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum Error {
    /// The vertex array is empty.
    #[error("the mesh has no vertices: it needs at least three")]
    NoVertices,

    /// The face array is empty.
    #[error("the mesh has no faces: it needs at least one triangle")]
    NoFaces,

    /// More faces than 32-bit corner indices can number.
    #[error(
        "the mesh has {found} faces, more than the {limit} that can be numbered: simplify it or split it"
    )]
    TooManyFaces {
        /// How many faces were given.
        found: usize,
        /// How many can be numbered.
        limit: usize,
    },

    /// A coordinate is NaN or infinite.
    #[error("NaN or infinite coordinates at {}: repair or remove them", .vertices.named("vertex"))]
    NonFinite {
        /// The vertices with such a coordinate.
        vertices: Elements,
    },

    /// A face names a vertex that does not exist.
    #[error(
        "{} out of range: {value} is not one of the {n_vertices} vertices; indices start at 0, so subtract 1 if yours start at 1",
        .faces.named("face")
    )]
    IndexOutOfRange {
        /// The faces with such an index.
        faces: Elements,
        /// The first such index.
        value: i64,
        /// How many vertices there are.
        n_vertices: usize,
    },

    /// A face has the same vertex at two of its corners.
    #[error("the same vertex twice in {}: remove these degenerate faces", .faces.named("face"))]
    RepeatedVertex {
        /// The faces that repeat a vertex.
        faces: Elements,
    },

    /// A face has the vertices of an earlier one, in any order.
    #[error("{} repeating the vertices of an earlier face: remove the duplicates", .faces.named("face"))]
    DuplicateFaces {
        /// The later ones of each set of duplicates.
        faces: Elements,
    },

    /// The corners of a face lie on a line, as far as double precision can tell.
    #[error("no area in {}: the corners lie on a line; dissolve or collapse these faces", .faces.named("face"))]
    ZeroArea {
        /// The faces without area.
        faces: Elements,
    },

    /// An edge belongs to three or more faces.
    #[error(
        "more than two faces at {}: delete the interior faces there, or mark these edges as seams",
        .edges.named("edge")
    )]
    NonManifoldEdges {
        /// The edges, each by its two vertices.
        edges: Elements,
    },

    /// The faces cannot be given one consistent orientation.
    #[error(
        "the surface is not orientable (one-sided, like a Moebius strip): crossing {} turns it inside out; \
         cut it open by a seam",
        .edges.named("edge")
    )]
    NotOrientable {
        /// An edge at which the orientation cannot be made consistent.
        edges: Elements,
    },

    /// The faces around a vertex form more than one fan.
    #[error(
        "parts of the surface that touch only in a point, at {}: split these vertices",
        .vertices.named("vertex")
    )]
    NonManifoldVertices {
        /// The vertices with several fans.
        vertices: Elements,
    },

    /// A vertex belongs to no face.
    #[error("{} without a face: remove loose vertices", .vertices.named("vertex"))]
    UnreferencedVertices {
        /// The loose vertices.
        vertices: Elements,
    },

    /// One surface was asked for and the mesh falls into several pieces.
    #[error("the mesh is {} separate pieces, first faces {faces}: map each piece by itself (cut returns them)", .faces.count)]
    SeveralComponents {
        /// The lowest face of each component.
        faces: Elements,
    },

    /// A disk was asked for and the surface has no boundary.
    #[error(
        "the surface is closed (genus {genus}), a disk needs a boundary: mark seams and cut it open{}",
        if *genus == 0 { ", or map it to the sphere by sphere_map" } else { "" }
    )]
    ClosedSurface {
        /// The number of handles.
        genus: usize,
    },

    /// A disk was asked for and the surface has handles.
    #[error(
        "the surface has genus {genus} (handles like a torus), a disk has none: cut each handle open by seams"
    )]
    HasHandles {
        /// The number of handles.
        genus: usize,
    },

    /// A sphere was asked for and the surface has a boundary.
    #[error(
        "the surface has {}, at {}; a sphere has none: close the holes, or map the surface by disk_map",
        match sizes.len() {
            1 => format!("a boundary loop of {} edges", sizes[0]),
            loops => format!("{loops} boundary loops of {} edges", list(sizes)),
        },
        .vertices.named("vertex")
    )]
    OpenSurface {
        /// A vertex of each loop, the longest loop first.
        vertices: Elements,
        /// The edge counts of the same loops.
        sizes: Vec<usize>,
    },

    /// A sphere was asked for and the surface has handles.
    #[error(
        "the surface has genus {genus} (handles like a torus), a sphere has none: \
         cut each handle open by seams and map what is left by disk_map"
    )]
    SphereHasHandles {
        /// The number of handles.
        genus: usize,
    },

    /// A disk was asked for and the surface has several boundary loops.
    #[error(
        "the surface has {} boundary loops of {} edges, at vertices {vertices}; a disk has one: \
         set fill_holes=True to fill all but the longest, or cut them together by seams",
        .vertices.count, list(sizes)
    )]
    SeveralBoundaries {
        /// A vertex of each loop, the longest loop first.
        vertices: Elements,
        /// The edge counts of the same loops.
        sizes: Vec<usize>,
    },

    /// A seam names a vertex that does not exist.
    #[error("{} out of range: there are {n_vertices} vertices (indices start at 0)", .seams.named("seam"))]
    SeamOutOfRange {
        /// The seams, each by the two vertices given.
        seams: Elements,
        /// How many vertices there are.
        n_vertices: usize,
    },

    /// A seam is not an edge of any face.
    #[error("{} not an edge of the mesh: a seam joins two vertices of one face", .seams.named("seam"))]
    SeamNotEdge {
        /// The seams, each by the two vertices given.
        seams: Elements,
    },

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
    MapNonFinite {
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

    /// A boundary cannot go onto a rectangle.
    #[error("no rectangle fits the boundary at {}: {reason}", .vertices.named("vertex"))]
    NoRectangle {
        /// The vertices at fault.
        vertices: Elements,
        /// What is wrong with them.
        reason: String,
    },

    /// An array has the wrong shape or content.
    #[error("{name} must be {expected}, but is {found}")]
    InvalidArray {
        /// The argument.
        name: &'static str,
        /// What was given.
        found: String,
        /// What is accepted.
        expected: String,
    },

    /// An option has a value outside its range.
    #[error("{name} must be {expected}, but is {found}")]
    InvalidOption {
        /// The option.
        name: &'static str,
        /// What was given.
        found: String,
        /// What is accepted.
        expected: String,
    },

    /// An initial map is no start on the sphere.
    #[error("the initial map is no start at {}: {reason}", .vertices.named("vertex"))]
    InitialSphere {
        /// The vertices at fault.
        vertices: Elements,
        /// What is wrong with them.
        reason: &'static str,
    },

    /// Positions on a sphere are not finite, or at its centre.
    #[error("{name} points nowhere at {}: give finite positions around the origin, none in it", .vertices.named("vertex"))]
    NoDirection {
        /// The argument.
        name: &'static str,
        /// The vertices with such a position.
        vertices: Elements,
    },

    /// One of two surfaces was refused or could not be mapped.
    #[error("the {surface}: {error}")]
    Surface {
        /// Source or target.
        surface: &'static str,
        /// What is wrong with it.
        error: Box<Self>,
    },

    /// The lists of landmarks do not match.
    #[error(
        "landmarks come in pairs, but there are {source_count} source and {target_count} target landmarks: \
         give as many of both"
    )]
    LandmarkCounts {
        /// How many landmarks the source has.
        source_count: usize,
        /// How many the target has.
        target_count: usize,
    },

    /// Too few landmarks to lay one surface over the other.
    #[error("{found} landmark pairs do not say how the surfaces lie over each other: give at least {needed}")]
    TooFewLandmarks {
        /// How many pairs were given.
        found: usize,
        /// How many are needed.
        needed: usize,
    },

    /// A landmark is no vertex of its mesh.
    #[error(
        "{name} out of range at {}: {value} is not one of the {n_vertices} vertices (indices start at 0)",
        .pairs.named("pair")
    )]
    LandmarkOutOfRange {
        /// The argument.
        name: &'static str,
        /// The pairs at fault.
        pairs: Elements,
        /// The first such landmark.
        value: usize,
        /// How many vertices the mesh has.
        n_vertices: usize,
    },

    /// Two pairs have the same vertex.
    #[error(
        "{name} repeat vertex {vertex} of pair {first} at {}: remove the repeated pairs",
        .pairs.named("pair")
    )]
    RepeatedLandmark {
        /// The argument.
        name: &'static str,
        /// The pair that had the vertex first.
        first: usize,
        /// The pairs that repeat a vertex.
        pairs: Elements,
        /// The first vertex that is repeated.
        vertex: usize,
    },

    /// A landmark lies on the boundary, which goes onto the boundary of the disk as a whole.
    #[error(
        "{name} on the boundary at {} (vertex {vertex}): the boundary goes onto the boundary by itself; \
         choose vertices inside",
        .pairs.named("pair")
    )]
    LandmarkOnBoundary {
        /// The argument.
        name: &'static str,
        /// The pairs at fault.
        pairs: Elements,
        /// The vertex of the first.
        vertex: usize,
    },

    /// A surface that must have genus 0 has handles.
    #[error(
        "the surface has genus {genus} (handles like a torus), but may have none: cut each handle open by seams, or fill it"
    )]
    GenusNotZero {
        /// The number of handles.
        genus: usize,
    },

    /// The lists of landmark curves do not match.
    #[error(
        "curves come in pairs, but there are {source_count} source_curves and {target_count} target_curves: \
         give a partner to {}, or leave it out",
        .unpaired.named("curve")
    )]
    CurveCounts {
        /// How many curves the source has.
        source_count: usize,
        /// How many the target has.
        target_count: usize,
        /// The curves without a partner.
        unpaired: Elements,
    },

    /// There is nothing to register closed surfaces by.
    #[error(
        "no curves on closed surfaces: give at least one pair, or use register_spheres, which needs none"
    )]
    NoCurves,

    /// A curve has too few edges.
    #[error(
        "{name}: curve {curve} has {edges} edges, but needs at least two, a closed one three: \
         lengthen it, or subdivide the mesh there"
    )]
    ShortCurve {
        /// The argument.
        name: &'static str,
        /// The curve.
        curve: usize,
        /// How many edges it has.
        edges: usize,
    },

    /// A vertex of a curve does not exist.
    #[error(
        "{name}: curve {curve} is out of range at place {place}: {value} is not one of the {n_vertices} vertices \
         (indices start at 0)"
    )]
    CurveOutOfRange {
        /// The argument.
        name: &'static str,
        /// The curve.
        curve: usize,
        /// The place in it, from 0.
        place: usize,
        /// What stands there.
        value: usize,
        /// How many vertices the mesh has.
        n_vertices: usize,
    },

    /// Two consecutive vertices of a curve are not joined by an edge.
    #[error(
        "{name}: curve {curve} leaves the edges of the mesh after place {place}: no edge joins vertices {vertices}; \
         list every vertex along the path"
    )]
    CurveOffEdges {
        /// The argument.
        name: &'static str,
        /// The curve.
        curve: usize,
        /// The place of the first of the two vertices in it, from 0.
        place: usize,
        /// The two vertices.
        vertices: Elements,
    },

    /// A curve meets itself.
    #[error(
        "{name}: curve {curve} meets itself at {}, at places {} and {}: remove the crossing \
         (only the first vertex may be repeated, at the end, to close the curve)",
        .vertices.named("vertex"), places[0], places[1]
    )]
    CurveMeetsItself {
        /// The argument.
        name: &'static str,
        /// The curve.
        curve: usize,
        /// Two places in it with the same vertex, from 0.
        places: [usize; 2],
        /// The vertex.
        vertices: Elements,
    },

    /// Two curves meet.
    #[error(
        "{name}: curves {} and {} meet at {}: shorten or move one of them, so that they have no vertex in common",
        curves[0], curves[1], .vertices.named("vertex")
    )]
    CurvesMeet {
        /// The argument.
        name: &'static str,
        /// The curves.
        curves: [usize; 2],
        /// The vertices that they share.
        vertices: Elements,
    },

    /// A curve meets the boundary without being a whole loop of it.
    #[error(
        "{name}: curve {curve} meets the boundary at {}: end it inside the surface, \
         or give a closed curve that runs along the whole boundary loop",
        .vertices.named("vertex")
    )]
    CurveOnBoundary {
        /// The argument.
        name: &'static str,
        /// The curve.
        curve: usize,
        /// Its vertices on the boundary.
        vertices: Elements,
    },

    /// Of a pair of curves only one is closed.
    #[error(
        "{name}: curve {curve} is open, but its partner is closed: close it by its first vertex at the end, or open both"
    )]
    CurveNotClosed {
        /// The argument with the open curve.
        name: &'static str,
        /// The curve.
        curve: usize,
    },

    /// Of a pair of closed curves only one runs along the boundary.
    #[error(
        "{name}: curve {curve} runs along a boundary loop, but its partner lies inside the other surface: \
         remove the faces that the partner encloses, or fill the hole"
    )]
    CurveBoundsOneSide {
        /// The argument with the curve on the boundary.
        name: &'static str,
        /// The curve.
        curve: usize,
    },

    /// The surfaces have different numbers of boundary loops.
    #[error(
        "boundary loops come in pairs too, but beside the curves the source has {source_count} and the target {target_count}: \
         fill the holes that have no partner"
    )]
    LoopCounts {
        /// How many loops the source has that are no curves.
        source_count: usize,
        /// How many the target has.
        target_count: usize,
    },

    /// A curve lies on different sides of a closed curve.
    #[error(
        "curve {curve} lies inside closed curve {closed} on the {surface} but outside on the other surface: \
         move it, or check the order of the curves"
    )]
    CurveSides {
        /// The curve.
        curve: usize,
        /// The closed curve.
        closed: usize,
        /// On which surface it lies inside, the smaller part of the source.
        surface: &'static str,
    },

    /// A closed curve has different numbers of boundary loops on its sides.
    #[error(
        "closed curve {closed} has {source_count} boundary loops inside it on the source but {target_count} on the target: \
         fill the holes that have no partner"
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
    CurveDivides {
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
        "the curves fit far better when one surface is mirrored: if they are mirror images like a left and a right hemisphere, \
         mirror one of them (negate x and flip its faces); if only the faces of an open one look to the other side, flip these; \
         or check the order of the curves"
    )]
    Mirrored,

    /// A linear system could not be factored.
    #[error("the factorisation of {what} failed: the mesh is too badly conditioned (look for slivers)")]
    FactorizationFailed {
        /// The matrix.
        what: String,
    },

    /// A curve or boundary loop does not open the surface by itself.
    #[error(
        "the surface cannot be cut open along feature {feature}: it is no path of edges, or it touches itself or another"
    )]
    Uncuttable {
        /// Which one, in the order of the slits and boundary loops of the surface.
        feature: usize,
    },

    /// Two curves that follow each other cannot be joined.
    #[error(
        "no path of edges joins feature {feature} to the next without touching a curve: refine the mesh there"
    )]
    NoArc {
        /// From which one on, in the order of the slits and boundary loops of the surface.
        feature: usize,
    },

    /// No hyperbolic metric with geodesic boundary was found.
    #[error(
        "no hyperbolic metric with these boundaries was found in double precision, left over: {}; remove the slivers there",
        .faces.named("face")
    )]
    NoHyperbolicMetric {
        /// The faces that stayed without area, or whose angles do not fit together.
        faces: Elements,
    },

    /// The observer ended the run before there was any map without folds.
    #[error("cancelled before there was a map without folds: let it run longer")]
    CancelledEarly,

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
        "the outline makes folds inevitable, at present in {}: it turns {turns} times counter-clockwise, and a map without \
         folds needs {needed}; draw the outline anew, or map the part by disk_map",
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
        "no map without folds was found in double precision, left over: {}; cut the long thin parts there open by seams",
        .folded.named("face")
    )]
    NoEmbedding {
        /// The faces that stayed folded.
        folded: Elements,
    },
}

impl Error {
    /// The elements at fault, where the error has any.
    pub fn elements(&self) -> Option<&Elements> {
        match self {
            Self::NonFinite { vertices }
            | Self::NonManifoldVertices { vertices }
            | Self::UnreferencedVertices { vertices }
            | Self::SeveralBoundaries { vertices, .. }
            | Self::OpenSurface { vertices, .. }
            | Self::InitialSphere { vertices, .. }
            | Self::MapNonFinite { vertices, .. }
            | Self::NoDirection { vertices, .. }
            | Self::NoRectangle { vertices, .. }
            | Self::InitialBoundary { vertices, .. } => Some(vertices),
            Self::IndexOutOfRange { faces, .. }
            | Self::RepeatedVertex { faces }
            | Self::DuplicateFaces { faces }
            | Self::ZeroArea { faces }
            | Self::SeveralComponents { faces }
            | Self::NoHyperbolicMetric { faces }
            | Self::HeldFolded { faces, .. }
            | Self::OutlineFolds { faces, .. }
            | Self::Density { faces, .. } => Some(faces),
            Self::NonManifoldEdges { edges } | Self::NotOrientable { edges } => Some(edges),
            Self::SeamOutOfRange { seams, .. } | Self::SeamNotEdge { seams } => Some(seams),
            Self::NoEmbedding { folded } | Self::StillFolded { folded, .. } => Some(folded),
            Self::LandmarkOutOfRange { pairs, .. }
            | Self::RepeatedLandmark { pairs, .. }
            | Self::LandmarkOnBoundary { pairs, .. } => Some(pairs),
            Self::CurveCounts { unpaired, .. } => Some(unpaired),
            Self::CurveOffEdges { vertices, .. }
            | Self::CurveMeetsItself { vertices, .. }
            | Self::CurvesMeet { vertices, .. }
            | Self::CurveOnBoundary { vertices, .. } => Some(vertices),
            Self::Surface { error, .. } => error.elements(),
            _ => None,
        }
    }

    /// Whether the arrays given are at fault: the mesh, its seams, its density, its initial map, its
    /// landmarks or curves.
    pub fn is_mesh_error(&self) -> bool {
        match self {
            Self::Surface { error, .. } => error.is_mesh_error(),
            error => !error.is_solver_error() && !matches!(error, Self::InvalidOption { .. }),
        }
    }

    /// Whether the numerics failed on good input.
    pub fn is_solver_error(&self) -> bool {
        match self {
            Self::Surface { error, .. } => error.is_solver_error(),
            Self::FactorizationFailed { .. } | Self::NoEmbedding { .. } | Self::StillFolded { .. } => true,
            Self::NoHyperbolicMetric { .. } | Self::CancelledEarly => true,
            _ => false,
        }
    }

    /// The same error, said of one of two surfaces; a cancelled run is nobody's fault.
    pub fn of_surface(self, surface: &'static str) -> Self {
        match self {
            Self::CancelledEarly => self,
            error => Self::Surface { surface, error: Box::new(error) },
        }
    }
}

/// The first few numbers of a list as text.
fn list(numbers: &[usize]) -> String {
    let named: Vec<String> = numbers.iter().take(NAMED_ELEMENTS).map(usize::to_string).collect();
    let more = if numbers.len() > NAMED_ELEMENTS { ", …" } else { "" };
    named.join(", ") + more
}
