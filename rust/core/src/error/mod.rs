// SPDX-License-Identifier: MIT OR Apache-2.0
//! What can be wrong with a mesh, with an option or with a computation.
//!
//! Every message names what failed, the elements (the first few indices and how many there are) and what
//! the caller can do about it. The same facts are data: [`Error::kind`], [`Error::side`], [`Error::curve`] and
//! [`Error::elements`], so that callers can say them in words of their own. Only broken input and failed
//! numerics are errors: a run that stops early returns its best map with a status instead.

mod curves;
mod elements;
mod kind;
mod landmarks;
mod maps;
mod mesh;
mod numerics;
mod side;

use thiserror::Error;

pub use curves::CurveError;
pub use elements::Elements;
pub use kind::ErrorKind;
pub(crate) use kind::kinds;
pub use landmarks::LandmarkError;
pub use maps::MapError;
pub use mesh::MeshError;
pub use numerics::NumericsError;
pub use side::Side;

/// Why a call was refused or failed.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum Error {
    /// A mesh, or its seams.
    #[error(transparent)]
    Mesh(#[from] MeshError),

    /// A density, an initial map or an outline.
    #[error(transparent)]
    Map(#[from] MapError),

    /// Landmarks.
    #[error(transparent)]
    Landmarks(#[from] LandmarkError),

    /// Landmark curves.
    #[error(transparent)]
    Curves(#[from] CurveError),

    /// The numerics failed on good input.
    #[error(transparent)]
    Numerics(#[from] NumericsError),

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

    /// Some rows of an array have the wrong content.
    #[error("{name} must be {expected}, but is {found} at {}", .rows.named(.row))]
    InvalidRows {
        /// The argument.
        name: &'static str,
        /// What was given in the first of the rows.
        found: String,
        /// What is accepted.
        expected: String,
        /// What a row is of: "vertex", "pair" or "point".
        row: &'static str,
        /// The rows at fault.
        rows: Elements,
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

    /// One of two surfaces was refused or could not be mapped.
    #[error("the {side}: {error}")]
    OfSurface {
        /// Which of the two.
        side: Side,
        /// What is wrong with it.
        error: Box<Self>,
    },

    /// The observer ended the run before there was any map without folds.
    #[error("cancelled before there was a map without folds: let it run longer")]
    CancelledEarly,
}

impl Error {
    /// What the error is, whatever its message says.
    pub fn kind(&self) -> ErrorKind {
        match self {
            Self::Mesh(error) => error.kind(),
            Self::Map(error) => error.kind(),
            Self::Landmarks(error) => error.kind(),
            Self::Curves(error) => error.kind(),
            Self::Numerics(error) => error.kind(),
            Self::InvalidArray { .. } | Self::InvalidRows { .. } => ErrorKind::InvalidArray,
            Self::InvalidOption { .. } => ErrorKind::InvalidOption,
            Self::OfSurface { error, .. } => error.kind(),
            Self::CancelledEarly => ErrorKind::Cancelled,
        }
    }

    /// The surface at fault, where it is one of two.
    pub fn side(&self) -> Option<Side> {
        match self {
            Self::OfSurface { side, .. } => Some(*side),
            Self::Map(error) => error.side(),
            Self::Landmarks(error) => error.side(),
            Self::Curves(error) => error.side(),
            Self::InvalidArray { name, .. } | Self::InvalidRows { name, .. } => Side::of_argument(name),
            _ => None,
        }
    }

    /// The landmark curve at fault, the first of two.
    pub fn curve(&self) -> Option<usize> {
        match self {
            Self::Curves(error) => error.curve(),
            Self::OfSurface { error, .. } => error.curve(),
            _ => None,
        }
    }

    /// The second of two landmark curves at fault.
    pub fn second_curve(&self) -> Option<usize> {
        match self {
            Self::Curves(error) => error.second_curve(),
            Self::OfSurface { error, .. } => error.second_curve(),
            _ => None,
        }
    }

    /// The elements at fault, where the error has any; [`ErrorKind`] says what their indices are of.
    pub fn elements(&self) -> Option<&Elements> {
        match self {
            Self::Mesh(error) => error.elements(),
            Self::Map(error) => Some(error.elements()),
            Self::Landmarks(error) => error.elements(),
            Self::Curves(error) => error.elements(),
            Self::Numerics(error) => error.elements(),
            Self::InvalidRows { rows, .. } => Some(rows),
            Self::OfSurface { error, .. } => error.elements(),
            _ => None,
        }
    }

    /// Whether the arrays given are at fault: the mesh, its seams, its density, its initial map, its
    /// landmarks or curves.
    pub fn is_mesh_error(&self) -> bool {
        match self {
            Self::OfSurface { error, .. } => error.is_mesh_error(),
            error => !error.is_solver_error() && !matches!(error, Self::InvalidOption { .. }),
        }
    }

    /// Whether the numerics failed on good input.
    pub fn is_solver_error(&self) -> bool {
        match self {
            Self::OfSurface { error, .. } => error.is_solver_error(),
            error => matches!(error, Self::Numerics(_) | Self::CancelledEarly),
        }
    }

    /// Whether it is of a kind that [`repair`](crate::repair()) mends: see [`ErrorKind::is_mended_by_repair`].
    ///
    /// ```
    /// use authalic::{RepairOptions, Surface, repair};
    /// use ndarray::array;
    ///
    /// // the second triangle is the first one again
    /// let vertices = array![[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]];
    /// let mut surface = Surface::new(&vertices, array![[0, 1, 2], [1, 2, 0]])?;
    /// if surface.topology().is_err_and(|error| error.is_mended_by_repair()) {
    ///     surface = repair(surface.vertices(), surface.faces(), &RepairOptions::default())?.surface;
    /// }
    /// assert_eq!(surface.faces(), array![[0, 1, 2]]);
    /// # Ok::<(), authalic::Error>(())
    /// ```
    pub fn is_mended_by_repair(&self) -> bool {
        self.kind().is_mended_by_repair()
    }

    /// The error of a computation with other numbers for the faces at fault.
    pub(crate) fn with_faces(self, face_of: impl Fn(usize) -> usize) -> Self {
        match self {
            Self::Numerics(error) => error.with_faces(face_of).into(),
            Self::OfSurface { side, error } => match *error {
                Self::Numerics(error) => Self::from(error.with_faces(face_of)).of_surface(side),
                error => error.of_surface(side),
            },
            error => error,
        }
    }

    /// The error with other numbers for the vertices and faces at fault, as where they are those of a changed mesh.
    pub(crate) fn renumbered(
        self,
        vertex_of: &dyn Fn(usize) -> usize,
        face_of: &dyn Fn(usize) -> usize,
    ) -> Self {
        match self {
            Self::Mesh(error) => error.renumbered(vertex_of, face_of).into(),
            Self::Map(error) => error.renumbered(vertex_of, face_of).into(),
            Self::Landmarks(error) => error.renumbered(vertex_of).into(),
            Self::Curves(error) => error.renumbered(vertex_of).into(),
            Self::Numerics(error) => error.with_faces(face_of).into(),
            Self::InvalidRows { name, found, expected, row: "vertex", mut rows } => {
                rows.renumber(vertex_of);
                Self::InvalidRows { name, found, expected, row: "vertex", rows }
            }
            Self::OfSurface { side, error } => error.renumbered(vertex_of, face_of).of_surface(side),
            error => error,
        }
    }

    /// The error as one about one of two surfaces; a cancelled run is nobody's fault.
    pub fn of_surface(self, side: Side) -> Self {
        match self {
            Self::CancelledEarly => self,
            error => Self::OfSurface { side, error: Box::new(error) },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_of_a_surface_keeps_what_it_says_as_data() {
        let folded = Elements::collect([3usize, 5]).unwrap();
        let error = Error::from(NumericsError::NoEmbedding { folded }).of_surface(Side::Target);
        let whole = error.with_faces(|face| 10 * face);
        assert_eq!((whole.kind(), whole.side()), (ErrorKind::NoEmbedding, Some(Side::Target)));
        assert_eq!(whole.elements().unwrap().first, [30, 50]);
        assert!(whole.is_solver_error() && !whole.is_mesh_error());
        assert!(whole.to_string().starts_with("the target: ") && whole.to_string().contains("30, 50"));
        let curve = Error::from(CurveError::NoArc { curve: Some(2) }).of_surface(Side::Source);
        assert_eq!((curve.side(), curve.curve(), curve.second_curve()), (Some(Side::Source), Some(2), None));
        assert_eq!(Error::CancelledEarly.of_surface(Side::Source), Error::CancelledEarly);
    }

    #[test]
    fn a_repair_mends_a_fault_of_one_of_two_surfaces_too() {
        let faces = Elements::collect([1usize]).unwrap();
        let mended = Error::from(MeshError::ZeroArea { faces });
        assert!(mended.is_mended_by_repair() && mended.of_surface(Side::Source).is_mended_by_repair());
        let kept = Error::from(MeshError::ClosedSurface { genus: 0 });
        assert!(!kept.is_mended_by_repair() && !kept.of_surface(Side::Source).is_mended_by_repair());
    }

    #[test]
    fn arguments_say_which_surface_they_are_about() {
        let of = |name| Error::InvalidArray { name, found: String::new(), expected: String::new() }.side();
        assert_eq!(of("source_landmarks"), Some(Side::Source));
        assert_eq!(of("target faces"), Some(Side::Target));
        assert_eq!(of("faces"), None);
    }
}
