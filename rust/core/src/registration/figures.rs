// SPDX-License-Identifier: MIT OR Apache-2.0
//! Figures of quality of a registration: area ratios, and the agreement of data on both surfaces.

use crate::mesh::Vertex;
use crate::mesh::geometry::{face_areas, normalized};
use crate::parallel;
use crate::vector::Vector3;

/// The area of each face's image over its own, (m,), rescaled so that the whole image is as large as the surface: 1
/// everywhere if g preserves areas.
///
/// `points` (n, 3) and `faces` (m, 3) are the source, each face with an area; `positions` (n, 3) are g. All are 0 where
/// the image has no area.
pub fn area_ratios(points: &[[f64; 3]], faces: &[[Vertex; 3]], positions: &[Vector3]) -> Vec<f64> {
    let (areas, images) =
        (face_areas(&normalized(points).0, faces), face_areas(&normalized(positions).0, faces));
    let total = |areas: &[f64]| parallel::sum(areas.len(), |face| areas[face]);
    let (whole, image) = (total(&areas), total(&images));
    parallel::map(
        faces.len(),
        |face| if image > 0.0 { (images[face] / image) / (areas[face] / whole) } else { 0.0 },
    )
}

/// A third of the area of the faces at each vertex, (n,), of the surface scaled to a bounding box with a diagonal of 1.
pub fn vertex_areas(points: &[[f64; 3]], faces: &[[Vertex; 3]]) -> Vec<f64> {
    let areas = face_areas(&normalized(points).0, faces);
    let mut at_vertex = vec![0.0; points.len()];
    for (face, area) in faces.iter().zip(areas) {
        face.iter().for_each(|&vertex| at_vertex[vertex] += area / 3.0);
    }
    at_vertex
}

/// The agreement of data on the source with those `pulled` from the target, both (n,): the weighted Pearson correlation
/// and the weighted mean of the absolute difference.
///
/// The correlation is NaN, as undefined, if one side is constant.
///
/// # Panics
/// If the lengths differ.
pub fn compare(source: &[f64], pulled: &[f64], weights: &[f64]) -> (f64, f64) {
    assert!(source.len() == pulled.len() && source.len() == weights.len(), "as many values as weights");
    let [total, x, y, difference] = parallel::sums(source.len(), |v| {
        let weight = weights[v];
        [weight, weight * source[v], weight * pulled[v], weight * (source[v] - pulled[v]).abs()]
    });
    let (x, y) = (x / total, y / total);
    let [xx, yy, xy] = parallel::sums(source.len(), |v| {
        let (dx, dy) = (source[v] - x, pulled[v] - y);
        [weights[v] * dx * dx, weights[v] * dy * dy, weights[v] * dx * dy]
    });
    // the rounding of a constant is no variance
    let varies = |square: f64, mean: f64| square > total * (1e-14 * mean).powi(2);
    let correlation = if varies(xx, x) && varies(yy, y) {
        (xy / (xx.sqrt() * yy.sqrt())).clamp(-1.0, 1.0)
    } else {
        f64::NAN
    };
    (correlation, difference / total)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ratios_are_relative_to_the_whole() {
        let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let faces = [[0, 1, 2], [0, 2, 3]].map(|face| face.map(Vertex));
        let huge = square.map(|[x, y, _]| [1e200, 3e200 * x, -2e200 * y]);
        area_ratios(&square, &faces, &huge.map(Vector3))
            .iter()
            .for_each(|ratio| assert!((ratio - 1.0).abs() < 1e-14));
        // a kite of which one half is three times the other
        let kite = [square[0], [1.5, -0.5, 0.0], square[2], [0.25, 0.75, 0.0]];
        let ratios = area_ratios(&square, &faces, &kite.map(Vector3));
        assert!((ratios[0] - 1.6).abs() < 1e-14 && (ratios[1] - 0.4).abs() < 1e-14);
        assert_eq!(area_ratios(&square, &faces, &[Vector3([4.0; 3]); 4]), [0.0, 0.0]);
    }

    #[test]
    fn agreement_is_that_of_the_textbook() {
        // weights count like repeated values
        let (x, y, w) = ([1.0, 2.0, 4.0], [2.0, 1.0, 5.0], [1.0, 2.0, 1.0]);
        let (long_x, long_y) = ([1.0, 2.0, 2.0, 4.0], [2.0, 1.0, 1.0, 5.0]);
        let (correlation, difference) = compare(&x, &y, &w);
        let (n, sum) = (4.0, |values: &[f64]| values.iter().sum::<f64>());
        let product: f64 = (0..4).map(|i| long_x[i] * long_y[i]).sum();
        let square = |v: &[f64]| n * v.iter().map(|a| a * a).sum::<f64>() - sum(v).powi(2);
        let expected =
            (n * product - sum(&long_x) * sum(&long_y)) / (square(&long_x) * square(&long_y)).sqrt();
        assert!((correlation - expected).abs() < 1e-14);
        assert_eq!(difference, 1.0);
        assert!((compare(&x, &x.map(|a| 7.0 - 3.0 * a), &w).0 + 1.0).abs() < 1e-14);
        assert!(compare(&[0.1; 3], &y, &w).0.is_nan());
    }
}
