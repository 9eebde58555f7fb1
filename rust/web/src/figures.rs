// SPDX-License-Identifier: MIT OR Apache-2.0
//! The figures of UVs: how even the areas are, how much shapes are sheared, and which faces are flipped.

use authalic::{Error, Surface, distortion};
use ndarray::{Array2, aview2};
use wasm_bindgen::prelude::wasm_bindgen;

/// The figures of the UVs of a whole mesh.
#[wasm_bindgen]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figures {
    /// The number of islands.
    #[wasm_bindgen(readonly)]
    pub islands: usize,
    /// The standard deviation of the area ratio, weighted by area; 0: every face has exactly its share.
    #[wasm_bindgen(readonly, js_name = areaError)]
    pub area_error: f64,
    /// The mean of σ₁/σ₂ over the faces that are not flipped, weighted by area; 1 keeps all shapes.
    #[wasm_bindgen(readonly)]
    pub shear: f64,
    /// The number of flipped faces.
    #[wasm_bindgen(readonly)]
    pub flipped: usize,
}

/// The figures of UVs, and those of each face.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// The figures of all faces together.
    pub figures: Figures,
    /// log₂ of the area ratio of each face, (m,); −∞ where it is flipped.
    pub log2_area_ratio: Vec<f32>,
    /// σ₁/σ₂ of each face, (m,); ∞ where it is flipped.
    pub shear: Vec<f32>,
}

/// Measures UVs of which each point is a copy of a vertex: `uv` (k, 2), the places of the points in space (k, 3), and
/// faces between points (m, 3).
///
/// # Errors
/// Faces without area, UVs that cover no area.
pub fn measured(
    uv: &[[f64; 2]],
    places: &[[f64; 3]],
    faces: &[[u32; 3]],
    islands: usize,
) -> Result<Measured, Error> {
    let surface = Surface::new(aview2(places), aview2(faces))?;
    let found = distortion(&surface, aview2(uv), None)?;
    let covered: f64 =
        faces.iter().map(|face| signed_area(face.map(|corner| uv[corner as usize])).abs()).sum();
    let areas: Vec<f64> = faces.iter().map(|face| area(face.map(|corner| places[corner as usize]))).collect();
    let (mut shear, mut total) = (0.0, 0.0);
    for (value, area) in found.angle_distortion.iter().zip(&areas).filter(|(value, _)| value.is_finite()) {
        shear += value * area;
        total += area;
    }
    let figures = Figures {
        islands,
        // E_A is the sum of the squared deviations of the areas over the target areas, whose sum is the area covered
        area_error: (found.authalic_energy / covered).sqrt(),
        shear: shear / total,
        flipped: found.folded.len(),
    };
    let single = |values: &ndarray::Array1<f64>| values.iter().map(|&value| value as f32).collect();
    Ok(Measured {
        figures,
        log2_area_ratio: single(&found.log2_area_ratio),
        shear: single(&found.angle_distortion),
    })
}

/// Positive where the corners run counterclockwise.
pub fn signed_area([a, b, c]: [[f64; 2]; 3]) -> f64 {
    0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
}

/// The area of a triangle in space.
pub fn area([a, b, c]: [[f64; 3]; 3]) -> f64 {
    let [p, q]: [[f64; 3]; 2] = [b, c].map(|end| std::array::from_fn(|k| end[k] - a[k]));
    let normal: [f64; 3] =
        std::array::from_fn(|k| p[(k + 1) % 3] * q[(k + 2) % 3] - p[(k + 2) % 3] * q[(k + 1) % 3]);
    0.5 * normal.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// The rows of an array of three or two columns.
pub fn rows<T: Copy, const N: usize>(array: &Array2<T>) -> Vec<[T; N]> {
    array.rows().into_iter().map(|row| std::array::from_fn(|k| row[k])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_of_a_stretched_square_are_those_of_the_formulas() {
        // two squares of one area; in the plane the second has three times the area of the first
        let places = [[0., 0.], [1., 0.], [2., 0.], [0., 1.], [1., 1.], [2., 1.]].map(|[x, y]| [x, y, 0.0]);
        let uv = [[0., 0.], [1., 0.], [4., 0.], [0., 1.], [1., 1.], [4., 1.]];
        let faces = [[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4]];
        let found = measured(&uv, &places, &faces, 1).unwrap();
        // area ratios ½ and 3/2, σ₁/σ₂ 1 and 3
        assert!((found.figures.area_error - 0.5).abs() < 1e-12);
        assert!((found.figures.shear - 2.0).abs() < 1e-12);
        assert_eq!(found.log2_area_ratio[0], -1.0);
        assert_eq!(found.figures.flipped, 0);
    }

    #[test]
    fn a_flipped_face_counts_but_does_not_make_the_shear_infinite() {
        let places = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
        let uv = [[0., 0.], [1., 0.], [1., 1.], [0.9, 0.2]];
        let found = measured(&uv, &places, &[[0, 1, 2], [0, 2, 3]], 1).unwrap();
        assert_eq!(found.figures.flipped, 1);
        assert_eq!(found.shear[1], f32::INFINITY);
        assert!((found.figures.shear - 1.0).abs() < 1e-12);
    }
}
