// SPDX-License-Identifier: MIT OR Apache-2.0
//! Registrations by points: places on the target and no folds but in those that say they have not converged, or an error.

use authalic::{Correspondence, Distortion, Energy, Error, Landmarks, RegistrationOptions, Status};
use authalic::{register_disks, register_spheres};

use super::Input;

/// One run of the target; whether it came to a result to look at.
pub fn check(bytes: &[u8]) -> bool {
    let mut input = Input::new(bytes);
    let weights: Vec<f64> = (0..6).map(|_| input.option([1.0, 10.0, f64::INFINITY]).unwrap_or(1.0)).collect();
    let is_soft = input.bit();
    let mut options = RegistrationOptions {
        energy: if input.bit() { Energy::Surface } else { Energy::Area },
        weight: input.option([0.1, 1.0, 100.0]).unwrap_or(1.0),
        angle_weight: input.option([0.0, 1.0, 10.0]),
        area_weight: input.option([0.0, 1.0, 3.0]).unwrap_or(1.0),
        position_weight: input.option([0.0, 1.0, 10.0]).unwrap_or(0.0),
        fill_holes: input.bit(),
        ..Default::default()
    };
    let is_closed = input.bit();
    let mut observer = input.patience();
    let (Some(source), Some(target)) = (input.surface(3), input.surface(3)) else { return false };
    let count = input.below(6);
    let [sources, targets] = [&source, &target]
        .map(|side| (0..count).map(|_| input.below(side.n_vertices() + 1)).collect::<Vec<_>>());
    options.weights = is_soft.then_some(&weights[..count]);
    let landmarks = Landmarks { source: &sources, target: &targets };
    let result = if is_closed {
        let result = register_spheres(&source, &target, &landmarks, &options, &mut observer);
        result.map(|found| (found.correspondence, found.distortion, found.status))
    } else {
        let result = register_disks(&source, &target, &landmarks, &options, &mut observer);
        result.map(|found| (found.correspondence, found.distortion, found.status))
    };
    check_result(result)
}

fn check_result(result: Result<(Correspondence, Distortion, Status), Error>) -> bool {
    let Ok((map, distortion, status)) = result else { return false };
    assert!(map.positions().iter().all(|x| x.is_finite()), "positions that are no numbers");
    let n_faces = map.target_faces().nrows();
    assert!(map.triangles().iter().all(|&triangle| triangle < n_faces));
    for weights in map.barycentric().rows() {
        assert!(
            (weights.sum() - 1.0).abs() < 1e-9 && weights.iter().all(|&weight| weight >= 0.0),
            "{weights}"
        );
    }
    assert!(
        distortion.folded.is_empty() || status != Status::Converged,
        "{status:?}, but folded: {:?}",
        distortion.folded
    );
    true
}
