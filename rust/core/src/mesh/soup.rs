// SPDX-License-Identifier: MIT OR Apache-2.0
//! Triangles that need not form a manifold, for figures that need only areas and orientations.

use super::{Vertex, geometry, orientation, validate};
use crate::error::Error;
use crate::vector::Vector3;

/// Validated triangles: finite, in range, with area, each component oriented consistently.
#[derive(Debug, Clone, PartialEq)]
pub struct TriangleSoup {
    /// The vertices, centered on their bounding box and scaled to a unit diagonal, (n, 3).
    pub points: Vec<Vector3>,
    /// The faces, (m, 3), oriented like most of their component.
    pub faces: Vec<[Vertex; 3]>,
    /// Their areas, (m,), all positive.
    pub areas: Vec<f64>,
}

impl TriangleSoup {
    /// Validates vertices (n, 3) and faces (m, 3) that have passed [`validate::arrays`]; faces may touch, cross or
    /// repeat in any way.
    ///
    /// # Errors
    /// Faces without area.
    pub fn of_checked(vertices: &[[f64; 3]], faces: &[[Vertex; 3]]) -> Result<Self, Error> {
        let (points, scale) = geometry::normalized(vertices);
        let areas = validate::positive_areas(vertices, &points, scale, faces)?;
        let flipped = orientation::consistent(points.len(), faces).flipped;
        let turned = |(&[a, b, c], flip): (&[Vertex; 3], bool)| if flip { [a, c, b] } else { [a, b, c] };
        let faces = faces.iter().zip(flipped).map(turned).collect();
        Ok(Self { points, faces, areas })
    }
}
