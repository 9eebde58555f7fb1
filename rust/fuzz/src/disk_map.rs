// SPDX-License-Identifier: MIT OR Apache-2.0
//! Maps to the disk: a map without folds, or an error.

use authalic::{Boundary, DiskMapOptions, DiskMethod, disk_map};

use super::Input;

/// One run of the target; whether it came to a result to look at.
pub fn check(bytes: &[u8]) -> bool {
    let mut input = Input::new(bytes);
    let density: Vec<f64> = (0..input.byte() % 4).map(|_| input.real()).collect();
    let (is_dense, angle) = (!density.is_empty(), input.option([1e-3, 0.1, 10.0]));
    let mut options = DiskMapOptions {
        method: match input.byte() % 4 {
            0 => DiskMethod::FixedPoint,
            1 => DiskMethod::ConjugateGradient,
            _ => DiskMethod::GaussNewton,
        },
        boundary: match input.byte() % 4 {
            0 => Boundary::ArcLength,
            1 => Boundary::Sliding,
            2 => Boundary::Free,
            _ => Boundary::Rectangle,
        },
        angle_weight: angle.unwrap_or(0.0),
        area_tolerance: input.option([0.05, 0.2, 0.01]),
        max_iterations: Some(input.below(20)),
        fill_holes: input.bit(),
        overlap: input.bit(),
        aspect: input.option([1.0, 2.0, 0.1]),
        ..Default::default()
    };
    let mut observer = input.patience();
    // Disks, spheres and tubes.
    let Some(surface) = input.surface(3) else { return false };
    let density: Vec<f64> =
        density.iter().copied().cycle().take(if is_dense { surface.n_faces() } else { 0 }).collect();
    options.density = is_dense.then(|| ndarray::aview1(&density));
    let Ok(map) = disk_map(&surface, &options, &mut observer) else { return false };
    assert_eq!(map.uv.shape(), [surface.n_vertices(), 2]);
    assert!(map.uv.iter().all(|x| x.is_finite()), "coordinates that are no numbers");
    assert!(map.distortion.folded.is_empty(), "folded: {:?}", map.distortion.folded);
    true
}
