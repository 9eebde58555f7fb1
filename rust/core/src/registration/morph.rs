// SPDX-License-Identifier: MIT OR Apache-2.0
//! The morph along a registration.

use ndarray::{Array2, ArrayView2};

use super::correspondence::Correspondence;
use crate::alignment::similarity::similarity;
use crate::arrays::{from_vectors, rows_of};
use crate::error::Error;
use crate::parallel;
use crate::vector::Vector3;

/// The morph (1 − t) v + t g(v) along a registration, (n, 3), from the source's `vertices` (n, 3) at t = 0 to their
/// places on the target at t = 1.
///
/// With `align` the places are brought onto the vertices first, by the best similarity by area, so that the shape
/// changes but does not travel.
///
/// # Errors
/// [`Error::InvalidArray`] for vertices of another shape, [`Error::InvalidOption`] for a t that is not finite.
pub fn homotopy(
    vertices: ArrayView2<'_, f64>,
    correspondence: &Correspondence,
    t: f64,
    align: bool,
) -> Result<Array2<f64>, Error> {
    let positions = correspondence.position_rows();
    let vertices: Vec<Vector3> = rows_of("vertices", vertices)?.iter().copied().map(Vector3).collect();
    if vertices.len() != positions.len() {
        let (found, expected) =
            (format!("of shape ({}, 3)", vertices.len()), format!("of shape ({}, 3)", positions.len()));
        return Err(Error::InvalidArray { name: "vertices", found, expected });
    }
    if !t.is_finite() {
        let (found, expected) = (t.to_string(), "a finite number".into());
        return Err(Error::InvalidOption { name: "t", found, expected });
    }
    let morphed = if align {
        aligned(&vertices, positions, &correspondence.vertex_areas(), t)
    } else {
        between(&vertices, positions, t)
    };
    Ok(from_vectors(morphed))
}

/// The morph from vertices to their positions.
fn between(vertices: &[Vector3], positions: &[Vector3], t: f64) -> Vec<Vector3> {
    parallel::map(vertices.len(), |v| vertices[v] * (1.0 - t) + positions[v] * t)
}

/// The morph to `positions` after the best similarity of `positions` onto `vertices`, with `weights` (n,).
fn aligned(vertices: &[Vector3], positions: &[Vector3], weights: &[f64], t: f64) -> Vec<Vector3> {
    let motion = similarity(positions, vertices, weights);
    let aligned: Vec<Vector3> = positions.iter().map(|&position| motion.apply(position)).collect();
    between(vertices, &aligned, t)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::alignment::similarity::tests::cloud;

    #[test]
    fn a_morph_begins_and_ends_exactly() {
        let (from, to) = (cloud(9), cloud(18).split_off(9));
        assert_eq!(between(&from, &to, 0.0), from);
        assert_eq!(between(&from, &to, 1.0), to);
        let middle = between(&from, &to, 0.5);
        (0..9).for_each(|v| assert!(middle[v].distance((from[v] + to[v]) * 0.5) < 1e-15));
    }
}
