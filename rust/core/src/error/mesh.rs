// SPDX-License-Identifier: MIT OR Apache-2.0
//! What can be wrong with a mesh, or with seams on it.

use thiserror::Error;

use super::elements::{Elements, NAMED_ELEMENTS};
use super::kind::ErrorKind;

/// Why a mesh was refused.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum MeshError {
    /// The vertex array is empty.
    #[error("the mesh has no vertices: it needs at least three")]
    NoVertices,

    /// The face array is empty.
    #[error("the mesh has no faces: it needs at least one triangle")]
    NoFaces,

    /// A repair has dropped every face.
    #[error(
        "the mesh has no faces that a repair can keep: each is without area, or at a vertex that is NaN or infinite; \
         check the vertices, and the distance within which points are merged"
    )]
    NoFaceLeft,

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
        "{} out of range: {value} is not one of the {n_vertices} vertices; \
         indices start at 0, so subtract 1 if yours start at 1",
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
    #[error(
        "the mesh is {} separate pieces, first faces {faces}: {}",
        .faces.count,
        match coincident {
            0 => "map each piece by itself (cut returns them)".into(),
            points => format!("{points} points of their open edges lie at the same places, so merge equal points"),
        }
    )]
    SeveralComponents {
        /// The lowest face of each component.
        faces: Elements,
        /// The number of points of open edges that lie at the place of another one.
        coincident: usize,
    },

    /// A repair was to keep the main piece, and no piece has more than half of the area.
    #[error(
        "the mesh is {} separate pieces, first faces {faces}, and none has more than half of the area: \
         merge points within a distance if they belong together, keep the largest piece, or map each by itself",
        .faces.count
    )]
    NoMainPiece {
        /// The lowest face of each piece.
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
        "the surface has {}, at {}; a sphere has none: {}",
        match sizes.len() {
            1 => format!("a boundary loop of {} edges", sizes[0]),
            loops => format!("{loops} boundary loops of {} edges", list(sizes)),
        },
        .vertices.named("vertex"),
        match coincident {
            0 => "close the holes, or map the surface by disk_map".into(),
            points => format!("{points} points there lie at the same places, so merge equal points"),
        }
    )]
    OpenSurface {
        /// A vertex of each loop, the longest loop first.
        vertices: Elements,
        /// The edge counts of the same loops.
        sizes: Vec<usize>,
        /// The number of points of the loops that lie at the place of another one.
        coincident: usize,
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

    /// A surface that must have genus 0 has handles.
    #[error(
        "the surface has genus {genus} (handles like a torus), but may have none: \
         cut each handle open by seams, or fill it"
    )]
    GenusNotZero {
        /// The number of handles.
        genus: usize,
    },

    /// A disk was asked for and the surface has several boundary loops.
    #[error(
        "the surface has {} boundary loops of {} edges, at vertices {vertices}; a disk has one: \
         fill all but the longest, or cut them together by seams",
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
}

impl MeshError {
    /// What the error is.
    pub fn kind(&self) -> ErrorKind {
        match self {
            Self::NoVertices => ErrorKind::NoVertices,
            Self::NoFaces | Self::NoFaceLeft => ErrorKind::NoFaces,
            Self::TooManyFaces { .. } => ErrorKind::TooManyFaces,
            Self::NonFinite { .. } => ErrorKind::NotFinite,
            Self::IndexOutOfRange { .. } => ErrorKind::IndexOutOfRange,
            Self::RepeatedVertex { .. } => ErrorKind::RepeatedVertex,
            Self::DuplicateFaces { .. } => ErrorKind::DuplicateFace,
            Self::ZeroArea { .. } => ErrorKind::ZeroArea,
            Self::NonManifoldEdges { .. } => ErrorKind::NonManifoldEdge,
            Self::NotOrientable { .. } => ErrorKind::NotOrientable,
            Self::NonManifoldVertices { .. } => ErrorKind::NonManifoldVertex,
            Self::UnreferencedVertices { .. } => ErrorKind::LooseVertex,
            Self::SeveralComponents { .. } | Self::NoMainPiece { .. } => ErrorKind::SeveralComponents,
            Self::ClosedSurface { .. } => ErrorKind::ClosedSurface,
            Self::OpenSurface { .. } => ErrorKind::OpenSurface,
            Self::HasHandles { .. } | Self::SphereHasHandles { .. } | Self::GenusNotZero { .. } => {
                ErrorKind::Handles
            }
            Self::SeveralBoundaries { .. } => ErrorKind::SeveralBoundaries,
            Self::SeamOutOfRange { .. } => ErrorKind::IndexOutOfRange,
            Self::SeamNotEdge { .. } => ErrorKind::SeamNotEdge,
        }
    }

    /// The error with other numbers for the vertices and faces at fault.
    pub(super) fn renumbered(
        mut self,
        vertex_of: &dyn Fn(usize) -> usize,
        face_of: &dyn Fn(usize) -> usize,
    ) -> Self {
        match &mut self {
            Self::NonFinite { vertices }
            | Self::NonManifoldVertices { vertices }
            | Self::UnreferencedVertices { vertices }
            | Self::SeveralBoundaries { vertices, .. }
            | Self::OpenSurface { vertices, .. } => vertices.renumber(vertex_of),
            Self::NonManifoldEdges { edges } | Self::NotOrientable { edges } => edges.renumber(vertex_of),
            Self::RepeatedVertex { faces }
            | Self::DuplicateFaces { faces }
            | Self::ZeroArea { faces }
            | Self::NoMainPiece { faces }
            | Self::SeveralComponents { faces, .. } => faces.renumber(face_of),
            _ => {}
        }
        self
    }

    /// The elements at fault, where the error has any.
    pub fn elements(&self) -> Option<&Elements> {
        match self {
            Self::NonFinite { vertices }
            | Self::NonManifoldVertices { vertices }
            | Self::UnreferencedVertices { vertices }
            | Self::SeveralBoundaries { vertices, .. }
            | Self::OpenSurface { vertices, .. } => Some(vertices),
            Self::IndexOutOfRange { faces, .. }
            | Self::RepeatedVertex { faces }
            | Self::DuplicateFaces { faces }
            | Self::ZeroArea { faces }
            | Self::NoMainPiece { faces }
            | Self::SeveralComponents { faces, .. } => Some(faces),
            Self::NonManifoldEdges { edges } | Self::NotOrientable { edges } => Some(edges),
            Self::SeamOutOfRange { seams, .. } | Self::SeamNotEdge { seams } => Some(seams),
            _ => None,
        }
    }
}

/// The first few numbers of a list as text.
fn list(numbers: &[usize]) -> String {
    let named: Vec<String> = numbers.iter().take(NAMED_ELEMENTS).map(usize::to_string).collect();
    let more = if numbers.len() > NAMED_ELEMENTS { ", …" } else { "" };
    named.join(", ") + more
}
