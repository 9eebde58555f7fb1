// SPDX-License-Identifier: MIT OR Apache-2.0
//! The first time at which moving points meet or a face loses its area.

use crate::mesh::TriangleMesh;
use crate::parallel;

/// The first time in `0..longest` at which the moving point `c` meets the moving edge from `a` to `b`.
pub(super) fn first_meeting(
    [a, b, c]: [[f64; 2]; 3],
    [da, db, dc]: [[f64; 2]; 3],
    longest: f64,
) -> Option<f64> {
    let minus = |x: [f64; 2], y: [f64; 2]| [x[0] - y[0], x[1] - y[1]];
    let cross = |x: [f64; 2], y: [f64; 2]| x[0] * y[1] - x[1] * y[0];
    let ([edge, point], [edge_speed, point_speed]) =
        ([minus(b, a), minus(c, a)], [minus(db, da), minus(dc, da)]);
    // when the three are on one line
    let constant = cross(edge, point);
    let linear = cross(edge, point_speed) + cross(edge_speed, point);
    let quadratic = cross(edge_speed, point_speed);
    let is_between = |&time: &f64| {
        let moved = |x: [f64; 2], speed: [f64; 2]| [x[0] + time * speed[0], x[1] + time * speed[1]];
        let (edge, point) = (moved(edge, edge_speed), moved(point, point_speed));
        let (squared, along) =
            (edge[0] * edge[0] + edge[1] * edge[1], point[0] * edge[0] + point[1] * edge[1]);
        time >= 0.0 && time < longest && along >= -1e-12 * squared && along <= (1.0 + 1e-12) * squared
    };
    roots(constant, linear, quadratic, longest).into_iter().flatten().filter(is_between).reduce(f64::min)
}

/// The real roots of constant + linear t + quadratic t², where the last term counts for times up to `longest`.
pub(super) fn roots(constant: f64, linear: f64, quadratic: f64, longest: f64) -> [Option<f64>; 2] {
    if (quadratic * longest * longest).abs() <= 1e-14 * (constant.abs() + (linear * longest).abs()) {
        return [(linear != 0.0).then(|| -constant / linear), None];
    }
    let discriminant = linear * linear - 4.0 * quadratic * constant;
    if discriminant < 0.0 {
        return [None, None];
    }
    let sum = -0.5 * (linear + discriminant.sqrt().copysign(linear));
    [Some(sum / quadratic), (sum != 0.0).then(|| constant / sum)]
}

/// The first step at which a face loses its area.
pub(super) fn first_fold(mesh: &TriangleMesh, map: &[[f64; 2]], along: &[[f64; 2]]) -> f64 {
    let cross = |x: [f64; 2], y: [f64; 2]| x[0] * y[1] - x[1] * y[0];
    let first = parallel::map(mesh.n_faces(), |face| {
        let edges = |of: &[[f64; 2]]| {
            let [o, p, q] = mesh.faces()[face].map(|v| of[v]);
            [[p[0] - o[0], p[1] - o[1]], [q[0] - o[0], q[1] - o[1]]]
        };
        let ([p, q], [dp, dq]) = (edges(map), edges(along));
        let of_face = roots(cross(p, q), cross(p, dq) + cross(dp, q), cross(dp, dq), 1.0);
        of_face.into_iter().flatten().filter(|&t| t > 0.0).fold(f64::INFINITY, f64::min)
    });
    first.into_iter().fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_of_all_degrees_are_found() {
        assert_eq!(roots(1.0, 0.0, 0.0, 1.0), [None, None]);
        assert_eq!(roots(-1.0, 2.0, 0.0, 1.0), [Some(0.5), None]);
        let mut sorted = roots(2.0, -3.0, 1.0, 1.0).map(Option::unwrap);
        sorted.sort_unstable_by(f64::total_cmp);
        assert_eq!(sorted, [1.0, 2.0]);
        assert_eq!(roots(1.0, 0.0, 1.0, 1.0), [None, None]);
    }
}
