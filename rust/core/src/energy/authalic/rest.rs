// SPDX-License-Identifier: MIT OR Apache-2.0
//! Cotangents of rest triangles, slivers fattened.

use crate::vector::Vector3;

/// The cotangents of a triangle whose height on the longest edge counts as at least `flattest` times that edge.
pub(crate) fn rest_cotangents(corners: [Vector3; 3], flattest: f64) -> [f64; 3] {
    let lengths = crate::mesh::geometry::edge_lengths(corners);
    let apex = (0..3).max_by(|&a, &b| lengths[a].total_cmp(&lengths[b])).expect("three edges");
    let [top, left, right] = [0, 1, 2].map(|k| corners[(apex + k) % 3]);
    let base = right - left;
    let length = base.norm();
    let foot = (top - left).dot(base) / length;
    let height = (base.cross(top - left).norm() / length).max(flattest * length);
    let (at_left, at_right) = (foot / height, (length - foot) / height);
    let at_top = (1.0 - at_left * at_right) / (at_left + at_right);
    let mut cotangents = [0.0; 3];
    for (k, value) in [at_top, at_left, at_right].into_iter().enumerate() {
        cotangents[(apex + k) % 3] = value;
    }
    cotangents
}
