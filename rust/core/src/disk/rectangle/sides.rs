// SPDX-License-Identifier: MIT OR Apache-2.0
//! The corners and sides of a rectangle along the boundary of a surface.

use super::corners::Outline;
use crate::disk::options::DiskMapOptions;
use crate::error::Error;
use crate::mesh::ties::first_smallest;
use crate::mesh::{TriangleMesh, Vertex};

/// The places of the corners along the boundary.
pub(super) fn corners_of(mesh: &TriangleMesh, options: &DiskMapOptions<'_>) -> Result<[usize; 4], Error> {
    let outline = Outline::new(mesh);
    match (options.corners, options.initial_rows()) {
        (Some(corners), _) => outline.given(corners),
        (None, None) => outline.found(options.aspect),
        (None, Some(initial)) => outline.given(corners_of_map(outline.vertices, initial)),
    }
}

/// The boundary vertices nearest to the corners of the bounding box of a map.
fn corners_of_map(outline: &[Vertex], map: &[[f64; 2]]) -> [usize; 4] {
    let place = |v: Vertex| map[v];
    [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]: [f64; 2]| {
        let [low, high] = bounds(outline, map);
        let corner = [if x < 0.0 { low[0] } else { high[0] }, if y < 0.0 { low[1] } else { high[1] }];
        let off = |v: Vertex| (place(v)[0] - corner[0]).hypot(place(v)[1] - corner[1]);
        let nearest = first_smallest(outline.iter().map(|&v| off(v)));
        outline[nearest.expect("a loop has vertices")].index()
    })
}

/// The lowest and highest coordinates.
pub(super) fn bounds(outline: &[Vertex], map: &[[f64; 2]]) -> [[f64; 2]; 2] {
    outline.iter().fold([[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]], |[low, high], &v| {
        let x = map[v];
        [[0, 1].map(|k| low[k].min(x[k])), [0, 1].map(|k| high[k].max(x[k]))]
    })
}

/// The boundary vertices of each side, from its first corner up to its last.
pub(super) fn sides(outline: &[Vertex], corners: &[usize; 4]) -> [Vec<Vertex>; 4] {
    let n = outline.len();
    [0, 1, 2, 3].map(|k| {
        let count = (corners[(k + 1) % 4] + n - corners[k]) % n;
        (0..count).map(|step| outline[(corners[k] + step) % n]).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_does_not_choose_among_vertices_as_near_to_a_corner() {
        let outline: Vec<Vertex> = (0..8).map(Vertex).collect();
        let octagon = |noise: f64| -> Vec<[f64; 2]> {
            let angle = |k: u32| std::f64::consts::TAU * (f64::from(k) + 0.5) / 8.0;
            let by = |k: u32| noise * (f64::from(k) * 7.3).sin();
            (0..8).map(|k| [angle(k).cos() + by(2 * k), angle(k).sin() + by(2 * k + 1)]).collect()
        };
        for noise in [0.0, 1e-12, -1e-12, 3e-13, -3e-13] {
            assert_eq!(corners_of_map(&outline, &octagon(noise)), [4, 6, 0, 2]);
        }
    }
}
