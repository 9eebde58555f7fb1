// SPDX-License-Identifier: MIT OR Apache-2.0
//! Maps onto a rectangle: four boundary vertices at its corners, the others sliding along its sides.
//!
//! The rectangle is convex, so a map without folded faces whose boundary vertices keep their order is one-to-one. As on
//! the disk a guarded Gauss–Newton descent lowers the energy of the areas with a share of the angles; a vertex on a
//! side has one unknown.
//!
//! A free aspect is found along with the map. Stretching the rectangle one way and pressing it the other by the same
//! factor changes no area and folds no face, so only the angles tell one aspect from another: after each descent the
//! aspect of least angle energy is taken ([`aspect`]), until it moves no more.
//!
//! Inside, rectangles are centered on (0, 0) and have the area of the unit disk; results have their lower left corner
//! in (0, 0) and a longer side of 1.
//!
//! Cost: that of a disk map, and a few iterations for each correction of the aspect.

mod aspect;
mod checks;
mod corners;
mod problem;
mod sides;
mod start;

use super::options::DiskMapOptions;
use super::run::Run;
use crate::codomain::planar::PlanarMap;
use crate::codomain::{Codomain, SpatialMap};
use crate::control::{History, Observer, Phase, Status};
use crate::error::Error;
use crate::optimize::gauss_newton::area_tolerance::descend;
use crate::optimize::gauss_newton::{GaussNewtonOptions, Problem, minimize, target_floors};
use crate::sparse::Order;
use aspect::{MOST_ASPECT, with_best_aspect};
pub(super) use checks::{check, check_initial};
use corners::Outline;
use problem::Rectangle;
use sides::{bounds, corners_of, sides};

/// Guarded iterations that suffice where they leave a small area deviation.
const USUAL_ITERATIONS: usize = 27;

/// Limit of the corrections of a free aspect where angles count.
const MOST_CORRECTIONS: usize = 30;

/// Over-relaxation: factor of every correction but the first and the last, which saves about half of them.
const RELAXATION: f64 = 1.5;

/// The aspect is settled when the correction of its logarithm is below this.
const SETTLED: f64 = 1e-4;

/// Maps a surface onto a rectangle with its lower left corner at (0, 0) and a longer side of 1.
///
/// # Errors
/// [`NumericsError::NoEmbedding`](crate::NumericsError::NoEmbedding) where every start folds, [`Error::CancelledEarly`]
/// where the observer ended the run before there was a map without folds.
pub(super) fn solve(
    run: &Run<'_>,
    history: &mut History,
    observer: &mut dyn Observer,
) -> Result<(PlanarMap, Status), Error> {
    let corners = corners_of(run.mesh, run.options)?;
    run.in_elimination_order(observer, |run, is_cancelled, observer| {
        // 1. The rectangle
        let outline = Outline::new(run.mesh);
        let sides = sides(outline.vertices, &corners);
        let rectangle = Rectangle { run: *run, sides, aspect: run.options.aspect };
        let of_initial = run.options.initial_rows().map(|map| {
            let [low, high] = bounds(outline.vertices, map);
            (high[0] - low[0]) / (high[1] - low[1])
        });
        let likely = of_initial.unwrap_or_else(|| outline.aspect(&corners));
        let aspect = run.options.aspect.unwrap_or(likely.clamp(1.0 / MOST_ASPECT, MOST_ASPECT));
        // 2. The map
        let boundary = rectangle.boundary(aspect, &corners, &outline);
        let (map, status) = rectangle.solve(boundary, is_cancelled, history, observer)?;
        // 3. Lower left corner in (0, 0), longer side 1
        let (map, scale) = rectangle.laid_out(&map);
        history.rescale(scale * scale);
        Ok((map, status))
    })
}

impl Rectangle<'_> {
    /// A map without folds onto the rectangle around (0, 0) with the area of the unit disk.
    fn solve(
        &self,
        boundary: PlanarMap,
        is_cancelled: bool,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> Result<(SpatialMap, Status), Error> {
        let floor = target_floors::floors(self.run.targets)[0];
        let energy = target_floors::energy(self.run.mesh, self.run.targets, Codomain::Plane, floor);
        let problem = Problem::new(energy, self.motions(), Order::AsGiven)?;
        // 1. A map without folds
        let mut phase = Phase { whole: observer, from: 0.0, to: 0.4 };
        let (map, status) =
            self.start(&problem, boundary, self.options(), is_cancelled, history, &mut phase)?;
        let map = self.with_best_aspect(&problem, &map, 1.0).0;
        if status == Status::Cancelled {
            return Ok((map, status));
        }
        // 2. Guarded descents and corrections of the aspect by turns
        let mut phase = Phase { whole: observer, from: 0.4, to: 0.8 };
        let begun = history.iterations();
        let surface = target_floors::MappedSurface {
            mesh: self.run.mesh,
            targets: self.run.targets,
            codomain: Codomain::Plane,
        };
        let (tolerance, options) = (self.run.options.area_tolerance, self.options());
        let (problem, map, status) =
            descend(&surface, problem, map, tolerance, &options, history, &mut phase);
        if tolerance.is_some() {
            // a stretch of the whole changes no area ratio
            return Ok((self.with_best_aspect(&problem, &map, 1.0).0, status));
        }
        let mut phase = Phase { whole: observer, from: 0.8, to: 1.0 };
        Ok(self.settled(&problem, map, status, begun, history, &mut phase))
    }

    /// Corrects a free aspect until it and the map are best for each other.
    fn settled(
        &self,
        problem: &Problem,
        mut map: SpatialMap,
        mut status: Status,
        begun: usize,
        history: &mut History,
        observer: &mut dyn Observer,
    ) -> (SpatialMap, Status) {
        let mut options = self.options();
        for round in 0..MOST_CORRECTIONS {
            // 1. The best aspect, over-relaxed on the way
            let (stretched, change) = self.with_best_aspect(problem, &map, 1.0);
            let counts_angles = self.run.options.angle_weight > 0.0;
            let done = history.iterations() - begun;
            let left = self.run.options.max_iterations.map_or(usize::MAX, |most| most.saturating_sub(done));
            options.most_iterations = options.most_iterations.min(left);
            if status == Status::Cancelled
                || change.abs() < SETTLED
                || !counts_angles
                || options.most_iterations == 0
            {
                return (stretched, status);
            }
            map = if round == 0 { stretched } else { self.with_best_aspect(problem, &map, RELAXATION).0 };
            // 2. The map for this aspect
            let from = 1.0 - 0.8f64.powi(round as i32);
            let to = 1.0 - 0.8f64.powi(round as i32 + 1);
            let mut phase = Phase { whole: observer, from, to };
            (map, status) = minimize(problem, map, &options, history, &mut phase);
        }
        (self.with_best_aspect(problem, &map, 1.0).0, status)
    }

    /// The map stretched toward the best aspect, and the logarithm by which it was off; as it is where the aspect is
    /// given.
    fn with_best_aspect(&self, problem: &Problem, map: &SpatialMap, relaxation: f64) -> (SpatialMap, f64) {
        match self.aspect {
            Some(_) => (map.clone(), 0.0),
            None => with_best_aspect(&problem.energy, map, [self.sides[0][0], self.sides[2][0]], relaxation),
        }
    }

    fn options(&self) -> GaussNewtonOptions {
        let DiskMapOptions { angle_weight, max_iterations, tolerance, .. } = *self.run.options;
        GaussNewtonOptions::guarded(angle_weight, max_iterations, tolerance, USUAL_ITERATIONS)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arrays::rows;
    use crate::control::Silent;
    use crate::disk::map_disk;
    use crate::disk::options::Boundary;
    use crate::mesh::TriangleMesh;

    /// A flat grid of `rows` × `columns` vertices of these sides.
    pub(super) fn grid(rows: u32, columns: u32, [width, height]: [f64; 2]) -> TriangleMesh {
        let place = |i: u32| {
            let (row, column) = (i / columns, i % columns);
            [
                width * f64::from(column) / f64::from(columns - 1),
                height * f64::from(row) / f64::from(rows - 1),
                0.0,
            ]
        };
        let vertices: Vec<[f64; 3]> = (0..rows * columns).map(place).collect();
        let cells = (0..rows - 1).flat_map(|row| (0..columns - 1).map(move |column| row * columns + column));
        let faces: Vec<[u32; 3]> =
            cells.flat_map(|a| [[a, a + 1, a + columns + 1], [a, a + columns + 1, a + columns]]).collect();
        TriangleMesh::new(&vertices, &faces).unwrap()
    }

    fn mapped(mesh: &TriangleMesh, corners: Option<[usize; 4]>, aspect: Option<f64>) -> crate::disk::DiskMap {
        let options =
            DiskMapOptions { boundary: Boundary::Rectangle, corners, aspect, ..DiskMapOptions::default() };
        map_disk(mesh, &options, &mut Silent).unwrap()
    }

    #[test]
    fn a_flat_rectangle_is_mapped_by_a_similarity() {
        let mesh = grid(7, 12, [3.0, 2.0]);
        let map = mapped(&mesh, None, None);
        assert!(map.distortion.area_ratio_std < 1e-9 && map.distortion.angle_distortion_max < 1.0 + 1e-9);
        let uv: &[[f64; 2]] = rows(map.uv.view());
        assert_eq!([uv[0], uv[11]], [[0.0, 0.0], [1.0, 0.0]]);
        assert!((uv[83][1] - 2.0 / 3.0).abs() < 1e-9);
    }

    #[test]
    fn given_corners_and_aspect_are_kept_and_vertices_slide_on_their_sides() {
        let mesh = grid(7, 7, [1.0, 1.0]);
        // a quarter turn, and half as high as wide
        let map = mapped(&mesh, Some([6, 48, 42, 0]), Some(2.0));
        let uv: &[[f64; 2]] = rows(map.uv.view());
        let expected = [(6, [0.0, 0.0]), (48, [1.0, 0.0]), (42, [1.0, 0.5]), (0, [0.0, 0.5])];
        expected.iter().for_each(|&(v, x): &(usize, [f64; 2])| assert_eq!(uv[v], x));
        (0..7).for_each(|k| assert_eq!(uv[6 + 7 * k][1], 0.0));
        assert!(map.distortion.folded.is_empty());
    }

    #[test]
    fn corners_that_press_a_face_flat_or_run_backwards_are_refused() {
        let mesh = grid(4, 4, [1.0, 1.0]);
        let refused = |corners: [usize; 4]| {
            let options = DiskMapOptions {
                boundary: Boundary::Rectangle,
                corners: Some(corners),
                ..DiskMapOptions::default()
            };
            map_disk(&mesh, &options, &mut Silent).unwrap_err().to_string()
        };
        // 3 and 12 are the only corners of a face each
        assert!(refused([0, 2, 15, 12]).contains("2 vertices (2, 7): an edge inside the surface joins them"));
        assert!(refused([0, 12, 15, 3]).contains("clockwise"));
        assert!(refused([0, 15, 3, 12]).contains("order"));
        assert!(refused([0, 3, 3, 12]).contains("different"));
        assert!(refused([0, 3, 15, 5]).contains("longest boundary loop"));
    }
}
