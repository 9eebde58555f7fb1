// SPDX-License-Identifier: MIT OR Apache-2.0
//! Maps to the sphere: a map without folds, or an error.

use authalic::{LineSearch, SphereMapOptions, SphereMethod, sphere_map};

use super::Input;

/// One run of the target; whether it came to a result to look at.
pub fn check(bytes: &[u8]) -> bool {
    let mut input = Input::new(bytes);
    let density: Vec<f64> = (0..input.byte() % 4).map(|_| input.real()).collect();
    let is_dense = !density.is_empty();
    let mut options = SphereMapOptions {
        method: match input.byte() % 4 {
            0 => SphereMethod::FixedPoint,
            1 => SphereMethod::GradientDescent,
            _ => SphereMethod::GaussNewton,
        },
        line_search: if input.bit() { LineSearch::Bounded } else { LineSearch::Interpolation },
        angle_weight: input.option([1e-3, 0.1, 10.0]).unwrap_or(0.0),
        area_tolerance: input.option([0.05, 0.2, 0.01]),
        max_iterations: Some(input.below(20)),
        refine: input.byte().is_multiple_of(8),
        ..Default::default()
    };
    let mut observer = input.patience();
    let mut bytes = [1].to_vec();
    while !input.is_over() {
        bytes.push(input.byte());
    }
    let Some(surface) = Input::new(&bytes).surface(3) else { return false };
    let density: Vec<f64> =
        density.iter().copied().cycle().take(if is_dense { surface.n_faces() } else { 0 }).collect();
    options.density = is_dense.then(|| ndarray::aview1(&density));
    let Ok(map) = sphere_map(&surface, &options, &mut observer) else { return false };
    assert_eq!(map.positions.shape(), [surface.n_vertices(), 3]);
    for row in map.positions.rows() {
        assert!((row.dot(&row) - 1.0).abs() < 1e-9, "a vertex off the sphere: {row}");
    }
    assert!(map.distortion.folded.is_empty(), "folded: {:?}", map.distortion.folded);
    true
}
